//! Where to split a small kd-tree cell: the exact sweep over sorted events.
//!
//! I. Wald and V. Havran: On building fast kd-trees for Ray Tracing, and on doing that in O(N log N), 2006. Without
//! clipping ("perfect splits") no plane is ever new, so events are sorted once, where a subtree begins, and filtered
//! into the children, which keeps their order. Sorting them anew in each node, which takes O(N log^2 N), gives the same
//! tree.

use crate::math::Aabb;
use crate::workloads::trace::common::prims::Prim;
use crate::workloads::trace::kdtree::KdNode;
use crate::workloads::trace::kdtree::build::{Builder, Subtree, halves};
use crate::workloads::trace::kdtree::cut::{Cut, LEFT, List, RIGHT, find};
use crate::workloads::trace::kdtree::events::{Event, SPARE, Sorted, local};

/// What there is of a subtree.
pub(crate) struct Begin<'a> {
    /// Its triangles.
    pub prims: &'a [Prim],
    /// By axis, their events, each triangle known by its number in `prims`; `None`: they are sorted anew in each node.
    pub events: Option<[Sorted; 3]>,
    pub cell: Aabb,
    pub depth: u32,
    /// About 1 over the extent of the cell, or of a larger one.
    pub unit: f32,
}

/// Builds the subtree of a cell.
pub(crate) fn build(builder: &Builder, begin: Begin) -> Subtree {
    let Begin { prims, events, cell, depth, unit } = begin;
    let mut sweep = Sweep {
        builder,
        prims,
        locals: (0..prims.len() as u32).collect(),
        every_node: events.is_none(),
        events: events.unwrap_or_default(),
        unit,
        over_budget: builder.over_budget(),
        side: vec![LEFT | RIGHT; prims.len()],
        out: Subtree::default(),
    };
    let locals = Span::new(0, prims.len());
    let mut root = Node { cell, depth, locals, events: [locals; 3], top: [locals.to; 4] };
    for axis in 0..3 {
        root.events[axis] = Span::new(0, sweep.events[axis].own);
        root.top[axis] = root.events[axis].to;
    }
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

struct Sweep<'a> {
    builder: &'a Builder,
    prims: &'a [Prim],
    /// Lists of triangles (numbers in `prims`, ascending), used like a stack: children's lists lie above their
    /// parent's.
    locals: Vec<u32>,
    /// Lists of events, likewise; where they are sorted in each node, those of the present one.
    events: [Sorted; 3],
    every_node: bool,
    /// About 1 over the extent of a cell around the subtree's.
    unit: f32,
    /// The tree has become too large.
    over_budget: bool,
    /// Where a triangle goes while its node is being split; to both sides at all other times.
    side: Vec<u8>,
    out: Subtree,
}

impl Sweep<'_> {
    /// Builds the subtree of a node; returns its depth.
    fn grow(&mut self, node: &Node) -> u32 {
        let stop = self.over_budget || self.builder.must_stop(node.locals.len(), node.depth);
        let mut node = *node;
        let Some(cut) = (if stop { None } else { self.find(&mut node) }) else {
            self.leaf(&node);
            return 0;
        };
        let index = self.out.nodes.len();
        self.out.nodes.push(KdNode::leaf(0, 0));
        let [left, right] = self.partition(&node, &cut);
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

    /// The cheapest plane; `None` if it does not pay.
    #[inline(always)]
    fn find(&mut self, node: &mut Node) -> Option<Cut> {
        if self.every_node {
            self.sort(node);
        }
        let lists = [0, 1, 2].map(|axis| list(&self.events, node, axis));
        find(self.builder, &node.cell, self.unit, node.locals.len(), &lists)
    }

    /// Sorts the events of a node, in the place of those of its parent.
    fn sort(&mut self, node: &mut Node) {
        let locals = node.locals.of(&self.locals);
        for axis in 0..3 {
            let own = locals.iter().map(|&local| (local, &self.prims[local as usize]));
            self.events[axis].fill(own, axis, &node.cell);
            node.events[axis] = Span::new(0, self.events[axis].own);
        }
    }

    /// Makes the children's lists; returns the left and the right child.
    fn partition(&mut self, node: &Node, cut: &Cut) -> [Node; 2] {
        cut.classify(&list(&self.events, node, cut.axis), &mut self.side);
        let (left_cell, right_cell) = halves(&node.cell, cut.axis, cut.plane);
        let child = |cell| Node { cell, depth: node.depth + 1, ..*node };
        let (mut left, mut right) = (child(left_cell), child(right_cell));
        let passed_on = if self.every_node { 0..0 } else { 0..3 };
        for axis in passed_on {
            if axis == cut.axis {
                self.part(cut, node, &mut left, &mut right);
                continue;
            }
            let side = self.side.as_slice();
            let list = &mut self.events[axis].events;
            let [a, b] = fork(list, node.events[axis], node.top[axis], |e| side[local(e)]);
            (left.events[axis], right.events[axis]) = (a, b);
            (left.top[axis], right.top[axis]) = (a.to, b.to);
        }
        let side = self.side.as_mut_slice();
        let both = |l: u32| std::mem::replace(&mut side[l as usize], LEFT | RIGHT);
        [left.locals, right.locals] = fork(&mut self.locals, node.locals, node.top[LOCALS], both);
        (left.top[LOCALS], right.top[LOCALS]) = (left.locals.to, right.locals.to);
        [left, right]
    }

    /// The children's events on the split axis are parts of their parent's list: those below and those above the plane.
    /// What lies in the plane is on the border now, where only planar triangles are remembered.
    fn part(&mut self, cut: &Cut, node: &Node, left: &mut Node, right: &mut Node) {
        let axis = cut.axis;
        let from = node.events[axis].from;
        left.events[axis].to = from + cut.here.start as u32;
        right.events[axis].from = from + cut.here.end as u32;
        let Sorted { events, planar, .. } = &mut self.events[axis];
        if !*planar {
            return;
        }
        let planar: Vec<Event> = cut.planar(node.events[axis].of(events)).collect();
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

/// A node's events on an axis.
#[inline(always)]
fn list<'a>(events: &'a [Sorted; 3], node: &Node, axis: usize) -> List<'a> {
    let own = node.events[axis];
    let Sorted { events, planar, .. } = &events[axis];
    List { padded: &events[own.from as usize..], own: own.len(), planar: *planar }
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
