//! Where to split a small kd-tree cell: the exact sweep over sorted events.
//!
//! I. Wald and V. Havran: On building fast kd-trees for Ray Tracing, and on doing that in O(N log N), 2006. Without
//! clipping ("perfect splits") no plane is ever new, so events are sorted once, where a subtree begins, and filtered
//! into the children, which keeps their order.

use crate::math::Aabb;
use crate::workloads::trace::common::prims::Prim;
use crate::workloads::trace::common::sah::unit;
use crate::workloads::trace::kdtree::KdNode;
use crate::workloads::trace::kdtree::bins::Areas;
use crate::workloads::trace::kdtree::build::{Builder, Subtree, halves};
use crate::workloads::trace::kdtree::events::{
    END, Event, PLANAR, SPARE, START, begun, coordinate, event, kind, local, ordered, restored, starts, sweep,
    sweep_with_planar,
};

/// Sides that a triangle goes to, as bits.
const LEFT: u8 = 1;
const RIGHT: u8 = 2;

/// Builds the subtree of a cell.
pub(crate) fn build(builder: &Builder, prims: &[Prim], cell: Aabb, depth: u32) -> Subtree {
    let mut sweep = Sweep {
        builder,
        prims,
        locals: (0..prims.len() as u32).collect(),
        events: Default::default(),
        any_planar: [false; 3],
        unit: 1.0,
        over_budget: builder.over_budget(),
        side: vec![LEFT | RIGHT; prims.len()],
        out: Subtree::default(),
    };
    let locals = Span::new(0, prims.len());
    let mut root = Node { cell, depth, locals, events: [locals; 3], top: [locals.to; 4] };
    for axis in 0..3 {
        let mut events = sweep.first_events(axis, &cell);
        root.events[axis] = Span::new(0, events.len());
        root.top[axis] = root.events[axis].to;
        events.resize(events.len() + SPARE, 0);
        sweep.events[axis] = events;
    }
    sweep.unit = unit(&cell);
    sweep.out.depth = sweep.grow(&root);
    builder.charge(sweep.size());
    sweep.out
}

/// Part of a list. 32 bits: nodes are copied all the time.
#[derive(Clone, Copy)]
struct Span {
    from: u32,
    to: u32,
}

impl Span {
    fn new(from: usize, to: usize) -> Span {
        Span { from: from as u32, to: to as u32 }
    }

    fn len(self) -> usize {
        (self.to - self.from) as usize
    }

    fn of<T>(self, list: &[T]) -> &[T] {
        &list[self.from as usize..self.to as usize]
    }
}

/// A cell to be split.
#[derive(Clone, Copy)]
struct Node {
    cell: Aabb,
    depth: u32,
    /// Its triangles.
    locals: Span,
    /// Its events by axis: those strictly inside the cell, and all of planar triangles.
    events: [Span; 3],
    /// Where free space begins in the three lists of events and in that of triangles.
    top: [u32; 4],
}

/// Triangles' numbers are in `top[LOCALS]`.
const LOCALS: usize = 3;

/// A plane that pays.
struct Cut {
    axis: usize,
    plane: f32,
    /// Side of the triangles that lie in the plane.
    planar_left: bool,
    /// The events of the axis that lie in the plane.
    here: Span,
}

struct Sweep<'a> {
    builder: &'a Builder,
    prims: &'a [Prim],
    /// Lists of triangles (numbers in `prims`, ascending), used like a stack: children's lists lie above their
    /// parent's.
    locals: Vec<u32>,
    /// Lists of events, likewise.
    events: [Vec<Event>; 3],
    /// About 1 over the extent of the subtree's cell.
    unit: f32,
    /// The tree has become too large.
    over_budget: bool,
    /// Axes with triangles that lie in a plane.
    any_planar: [bool; 3],
    /// Where a triangle goes while its node is being split; to both sides at all other times.
    side: Vec<u8>,
    out: Subtree,
}

impl Sweep<'_> {
    /// The events of all triangles on an axis, in order.
    ///
    /// Those on or outside the cell's border are never candidates, and the counts know them without: a triangle that
    /// does not begin inside has begun before, one that does not end inside never ends.
    fn first_events(&mut self, axis: usize, cell: &Aabb) -> Vec<Event> {
        let mut events = Vec::with_capacity(2 * self.prims.len() + SPARE);
        for (local, prim) in self.prims.iter().enumerate() {
            let (min, max, local) = (prim.min[axis], prim.max[axis], local as u32);
            if min == max {
                events.push(ordered(event(min, PLANAR, local)));
                self.any_planar[axis] = true;
                continue;
            }
            if min > cell.min[axis] {
                events.push(ordered(event(min, START, local)));
            }
            if max < cell.max[axis] {
                events.push(ordered(event(max, END, local)));
            }
        }
        events.sort_unstable();
        events.iter_mut().for_each(|e| *e = restored(*e));
        events
    }

    /// Builds the subtree of a node; returns its depth.
    fn grow(&mut self, node: &Node) -> u32 {
        let stop = self.over_budget || self.builder.must_stop(node.locals.len(), node.depth);
        let Some(cut) = (if stop { None } else { self.find(node) }) else {
            self.leaf(node);
            return 0;
        };
        let index = self.out.nodes.len();
        self.out.nodes.push(KdNode::leaf(0, 0));
        let [left, right] = self.partition(node, &cut);
        let left_depth = self.grow(&left);
        let right_index = self.out.nodes.len() as u32;
        let right_depth = self.grow(&right);
        self.out.nodes[index] = KdNode::inner(cut.axis as u32, cut.plane, right_index);
        1 + left_depth.max(right_depth)
    }

    /// Leaves and triangle references so far, or a little more.
    fn size(&self) -> usize {
        self.out.nodes.len() + self.out.triangles.len()
    }

    fn leaf(&mut self, node: &Node) {
        self.over_budget |= self.size() > self.builder.limit;
        let locals = node.locals.of(&self.locals);
        self.out.nodes.push(KdNode::leaf(self.out.triangles.len() as u32, locals.len() as u32));
        self.out.triangles.extend(locals.iter().map(|&l| self.prims[l as usize].triangle()));
    }

    /// Sweeps all three axes for the cheapest plane; `None` if it does not pay.
    fn find(&self, node: &Node) -> Option<Cut> {
        let count = node.locals.len();
        let (mut cheapest, mut axis, mut planar_left) = (u64::MAX, 0, true);
        let (areas, area) = Areas::new(&node.cell, self.unit, self.builder.thin)?;
        for (a, areas) in areas.iter().enumerate() {
            let events = node.events[a].of(&self.events[a]);
            let planar = self.any_planar[a] && events.iter().any(|&e| kind(e) == PLANAR);
            let (mut found, mut left) = (u64::MAX, true);
            if !planar {
                found = sweep(&self.events[a][node.events[a].from as usize..], events.len(), areas, count);
            }
            // Seldom is the cheapest plane one that would cut off too thin a slice: then again, without such.
            if planar || (found != u64::MAX && !areas.allows(coordinate(events[found as u32 as usize]))) {
                (found, left) = sweep_with_planar(events, areas, count);
            }
            if found < cheapest {
                (cheapest, axis, planar_left) = (found, a, left);
            }
        }
        let cost = f32::from_bits((cheapest >> 32) as u32);
        if cheapest == u64::MAX || !self.builder.pays(count, f64::from(cost), f64::from(area)) {
            return None;
        }
        let events = node.events[axis].of(&self.events[axis]);
        let at = cheapest as u32 as usize;
        let plane = coordinate(events[at]);
        let before = events[..at].iter().rev().take_while(|&&e| coordinate(e) == plane).count();
        let after = events[at..].iter().take_while(|&&e| coordinate(e) == plane).count();
        let first = node.events[axis].from as usize + at;
        Some(Cut { axis, plane, planar_left, here: Span::new(first - before, first + after) })
    }

    /// Makes the children's lists; returns the left and the right child.
    fn partition(&mut self, node: &Node, cut: &Cut) -> [Node; 2] {
        self.classify(node, cut);
        let (left_cell, right_cell) = halves(&node.cell, cut.axis, cut.plane);
        let child = |cell| Node { cell, depth: node.depth + 1, ..*node };
        let (mut left, mut right) = (child(left_cell), child(right_cell));
        for axis in 0..3 {
            if axis == cut.axis {
                self.part(cut, node, &mut left, &mut right);
                continue;
            }
            let side = self.side.as_slice();
            let [a, b] = fork(&mut self.events[axis], node.events[axis], node.top[axis], |e| side[local(e)]);
            (left.events[axis], right.events[axis]) = (a, b);
            (left.top[axis], right.top[axis]) = (a.to, b.to);
        }
        let side = self.side.as_mut_slice();
        let both = |l: u32| std::mem::replace(&mut side[l as usize], LEFT | RIGHT);
        [left.locals, right.locals] = fork(&mut self.locals, node.locals, node.top[LOCALS], both);
        (left.top[LOCALS], right.top[LOCALS]) = (left.locals.to, right.locals.to);
        [left, right]
    }

    /// Decides where every triangle of the node goes: to both sides unless an event says otherwise.
    fn classify(&mut self, node: &Node, cut: &Cut) {
        let (events, side) = (self.events[cut.axis].as_slice(), self.side.as_mut_slice());
        // What ends here or below does not reach the right; what begins here or above does not reach the left.
        for &e in (Span { to: cut.here.to, ..node.events[cut.axis] }).of(events) {
            side[local(e)] &= LEFT | (starts(e) << 1) as u8;
        }
        for &e in (Span { from: cut.here.from, ..node.events[cut.axis] }).of(events) {
            side[local(e)] &= RIGHT | (1 - begun(e)) as u8;
        }
        if self.any_planar[cut.axis] {
            let own = if cut.planar_left { LEFT } else { RIGHT };
            cut.here.of(events).iter().filter(|&&e| kind(e) == PLANAR).for_each(|&e| side[local(e)] = own);
        }
    }

    /// The children's events on the split axis are parts of their parent's list: those below and those above the plane.
    /// What lies in the plane is on the border now, where only planar triangles are remembered.
    fn part(&mut self, cut: &Cut, node: &Node, left: &mut Node, right: &mut Node) {
        let axis = cut.axis;
        left.events[axis].to = cut.here.from;
        right.events[axis].from = cut.here.to;
        if !self.any_planar[axis] {
            return;
        }
        let events = &mut self.events[axis];
        let planar: Vec<Event> = cut.here.of(events).iter().copied().filter(|&e| kind(e) == PLANAR).collect();
        if planar.is_empty() {
            return;
        }
        let (child, list) = if cut.planar_left {
            let list = [left.events[axis].of(events), &planar].concat();
            (&mut *left, list)
        } else {
            let list = [&planar, right.events[axis].of(events)].concat();
            (&mut *right, list)
        };
        let top = node.top[axis] as usize;
        child.events[axis] = Span::new(top, top + list.len());
        events.truncate(top);
        events.extend(&list);
        events.extend([0; SPARE]);
        let free = (top + list.len()) as u32;
        (left.top[axis], right.top[axis]) = (free, free);
    }
}

/// Makes two lists from one, in the free space from `top` on: the left one above the right one, which is used last.
/// Every item is written to both, and only the lists that it belongs to advance: no branch to mispredict.
#[inline(always)]
fn fork<T: Copy + Default>(list: &mut Vec<T>, own: Span, top: u32, mut side: impl FnMut(T) -> u8) -> [Span; 2] {
    let (count, top) = (own.len(), top as usize);
    if list.len() < top + 2 * count + SPARE {
        list.resize(2 * (top + 2 * count) + SPARE, T::default());
    }
    let (used, free) = list.split_at_mut(top);
    let (right_out, left_out) = free[..2 * count].split_at_mut(count);
    let (mut left, mut right) = (0, 0);
    for &item in own.of(used) {
        let side = side(item);
        left_out[left] = item;
        right_out[right] = item;
        left += usize::from(side & LEFT);
        right += usize::from(side >> 1);
    }
    [Span::new(top + count, top + count + left), Span::new(top, top + right)]
}
