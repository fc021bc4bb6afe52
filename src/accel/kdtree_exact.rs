//! Where to split a small kd-tree cell: the exact sweep over sorted events.
//!
//! I. Wald and V. Havran: On building fast kd-trees for Ray Tracing, and on doing that in O(N log N), 2006. Without
//! clipping ("perfect splits") no plane is ever new, so events are sorted once, where a subtree begins, and filtered
//! into the children, which keeps their order.

use super::kdtree::KdNode;
use super::kdtree_bins::Sides;
use super::kdtree_build::{Builder, Split, Subtree, halves};
use super::prims::Prim;
use crate::math::Aabb;
use std::ops::Range;

/// A triangle's box begins, lies or ends in a plane. Sorts by coordinate, then in the order in which a sweep needs them.
///
/// `coordinate (ordered bits) << 32 | kind << 30 | number of the triangle in this subtree`.
type Event = u64;

const END: u32 = 0;
const PLANAR: u32 = 1;
const START: u32 = 2;

fn event(x: f32, kind: u32, local: u32) -> Event {
    u64::from(ordered(x)) << 32 | u64::from(kind << 30 | local)
}

/// Bits that compare as the float does.
fn ordered(x: f32) -> u32 {
    let bits = x.to_bits();
    if bits >> 31 == 0 { bits | 1 << 31 } else { !bits }
}

fn coordinate(event: Event) -> f32 {
    let bits = (event >> 32) as u32;
    f32::from_bits(if bits >> 31 == 1 { bits & !(1 << 31) } else { !bits })
}

fn kind(event: Event) -> u32 {
    (event as u32) >> 30
}

fn local(event: Event) -> usize {
    (event as u32 & 0x3fff_ffff) as usize
}

/// Sides that a triangle goes to, as bits.
const LEFT: u8 = 1;
const RIGHT: u8 = 2;

/// Builds the subtree of a cell.
pub(super) fn build(builder: &Builder, prims: &[Prim], cell: Aabb, depth: u32) -> Subtree {
    let mut sweep = Sweep {
        builder,
        prims,
        locals: (0..prims.len() as u32).collect(),
        events: Default::default(),
        side: vec![0; prims.len()],
        local_scratch: Vec::new(),
        event_scratch: Vec::new(),
        out: Subtree::default(),
    };
    for axis in 0..3 {
        let inside = cell.min[axis]..cell.max[axis];
        let events = &mut sweep.events[axis];
        events.reserve(2 * prims.len());
        for (local, prim) in prims.iter().enumerate() {
            let (min, max, local) = (prim.min[axis], prim.max[axis], local as u32);
            if min == max {
                events.push(event(min, PLANAR, local));
                continue;
            }
            // Events on or outside the cell's border are never candidates, and the counts know them without: a
            // triangle that has not begun inside has begun before, one that has not ended inside never ends.
            if min > inside.start {
                events.push(event(min, START, local));
            }
            if max < inside.end {
                events.push(event(max, END, local));
            }
        }
        events.sort_unstable();
    }
    let depth_below = sweep.grow(Node { locals: 0, events: [0; 3], cell, depth });
    sweep.out.depth = depth_below;
    sweep.out
}

/// A cell to be split. Its triangles and events are the tops of the stacks, from these positions on.
struct Node {
    locals: usize,
    events: [usize; 3],
    cell: Aabb,
    depth: u32,
}

struct Sweep<'a> {
    builder: &'a Builder,
    prims: &'a [Prim],
    /// Stack of triangle lists (numbers in `prims`, ascending).
    locals: Vec<u32>,
    /// Stacks of event lists: those strictly inside the cell, and all of planar triangles.
    events: [Vec<Event>; 3],
    /// Where a triangle goes, while its node is being split.
    side: Vec<u8>,
    local_scratch: Vec<u32>,
    event_scratch: Vec<Event>,
    out: Subtree,
}

impl Sweep<'_> {
    /// Builds the subtree of the topmost node and takes its lists off the stacks; returns its depth.
    fn grow(&mut self, node: Node) -> u32 {
        let count = self.locals.len() - node.locals;
        let split = if self.builder.must_stop(count, node.depth) {
            None
        } else {
            self.find(&node).filter(|split| self.builder.pays(&node.cell, count, split))
        };
        let depth = match split {
            None => {
                self.leaf(&node);
                0
            }
            Some(split) => {
                let index = self.out.nodes.len();
                self.out.nodes.push(KdNode::leaf(0, 0));
                let (left, right) = self.divide(&node, &split);
                let left_depth = self.grow(left);
                let right_index = self.out.nodes.len() as u32;
                let right_depth = self.grow(right);
                self.out.nodes[index] = KdNode::inner(split.axis as u32, split.plane, right_index);
                1 + left_depth.max(right_depth)
            }
        };
        self.locals.truncate(node.locals);
        for axis in 0..3 {
            self.events[axis].truncate(node.events[axis]);
        }
        depth
    }

    fn leaf(&mut self, node: &Node) {
        let locals = &self.locals[node.locals..];
        self.builder.spend(locals.len());
        self.out.nodes.push(KdNode::leaf(self.out.triangles.len() as u32, locals.len() as u32));
        self.out.triangles.extend(locals.iter().map(|&l| self.prims[l as usize].triangle()));
    }

    /// Sweeps all three axes for the cheapest plane.
    fn find(&self, node: &Node) -> Option<Split> {
        let count = self.locals.len() - node.locals;
        let mut best = None;
        for axis in 0..3 {
            let events = &self.events[axis][node.events[axis]..];
            let sides = Sides::new(&node.cell, axis);
            let begun_inside = events.iter().filter(|&&e| kind(e) != END).count();
            let planar = events.iter().filter(|&&e| kind(e) == PLANAR).count();
            let begun_before = count - begun_inside;
            if planar == 0 {
                sweep(events, &sides, begun_before, count, &mut best);
            } else {
                sweep_with_planar(events, &sides, begun_before, count, &mut best);
            }
        }
        best
    }

    /// Puts the children's lists on the stacks, the left one on top.
    fn divide(&mut self, node: &Node, split: &Split) -> (Node, Node) {
        let own = &self.events[split.axis][node.events[split.axis]..];
        let plane = u64::from(ordered(split.plane));
        let below = own.partition_point(|&e| e >> 32 < plane);
        let here = below + own[below..].partition_point(|&e| e >> 32 == plane);
        self.classify(node, split, below, here);

        let right_locals = self.locals.len();
        let side = &self.side;
        fork(&mut self.locals, node.locals, &mut self.local_scratch, |l| side[l as usize]);
        let left_locals = right_locals + split.right;
        debug_assert_eq!(self.locals.len(), left_locals + split.left);

        let right_events = [0, 1, 2].map(|a| self.events[a].len());
        let left_events = [0, 1, 2].map(|axis| {
            let own = node.events[axis];
            if axis == split.axis {
                Self::cut(&mut self.events[axis], own, split, own + below..own + here)
            } else {
                fork(&mut self.events[axis], own, &mut self.event_scratch, |e| side[local(e)])
            }
        });
        let (left_cell, right_cell) = halves(&node.cell, split);
        (
            Node { locals: left_locals, events: left_events, cell: left_cell, depth: node.depth + 1 },
            Node { locals: right_locals, events: right_events, cell: right_cell, depth: node.depth + 1 },
        )
    }

    /// Decides where every triangle of the node goes: to both sides unless an event says otherwise. The node's events
    /// on the split axis lie below, in (`below..here`), and above the plane.
    fn classify(&mut self, node: &Node, split: &Split, below: usize, here: usize) {
        for &l in &self.locals[node.locals..] {
            self.side[l as usize] = LEFT | RIGHT;
        }
        let own = &self.events[split.axis][node.events[split.axis]..];
        // What has ended below does not reach the right; what begins above does not reach the left.
        for &e in &own[..below] {
            self.side[local(e)] &= LEFT | if kind(e) == START { RIGHT } else { 0 };
        }
        for &e in &own[here..] {
            self.side[local(e)] &= RIGHT | if kind(e) == END { LEFT } else { 0 };
        }
        for &e in &own[below..here] {
            let left = kind(e) == END || (kind(e) == PLANAR && split.planar_left);
            self.side[local(e)] = if left { LEFT } else { RIGHT };
        }
    }

    /// Events of the split axis: those below the plane go left, those above go right, and those in the plane (`here`)
    /// are on the border now, where only planar triangles are remembered. Returns where the left list begins.
    fn cut(events: &mut Vec<Event>, own: usize, split: &Split, here: Range<usize>) -> usize {
        let end = events.len();
        let planar_from = here.start + events[here.clone()].partition_point(|&e| kind(e) < PLANAR);
        let planar_to = here.start + events[here.clone()].partition_point(|&e| kind(e) <= PLANAR);
        if !split.planar_left {
            events.extend_from_within(planar_from..planar_to);
        }
        events.extend_from_within(here.end..end);
        let left = events.len();
        events.extend_from_within(own..here.start);
        if split.planar_left {
            events.extend_from_within(planar_from..planar_to);
        }
        left
    }
}

/// The sweep where no triangle lies in a plane of its axis: every event is a candidate by itself.
///
/// Of several events in one plane, all but the last end and the first start see too many triangles on one side, and so
/// cost more than the plane does; they need no care.
#[inline(always)]
fn sweep(events: &[Event], sides: &Sides, begun_before: usize, count: usize, best: &mut Option<Split>) {
    let (mut left, mut right) = (begun_before as f64, count as f64);
    let mut cheapest = (best.map_or(f64::INFINITY, |b| b.weighted), 0.0, 0.0, 0);
    for &e in events {
        let start = (e >> 31 & 1) as f64;
        right -= 1.0 - start;
        let (left_area, right_area) = sides.areas(coordinate(e));
        let weighted = left_area * left + right_area * right;
        if weighted < cheapest.0 {
            cheapest = (weighted, left, right, e);
        }
        left += start;
    }
    let (weighted, left, right, e) = cheapest;
    if best.is_none_or(|b| weighted < b.weighted) && weighted < f64::INFINITY {
        let (left, right) = (left as usize, right as usize);
        *best = Some(Split { axis: sides.axis, plane: coordinate(e), planar_left: true, left, right, weighted });
    }
}

/// The sweep by groups of events in one plane: ends and planar triangles leave the right before the plane is judged,
/// planar ones and starts enter the left after it.
#[cold]
fn sweep_with_planar(events: &[Event], sides: &Sides, begun_before: usize, count: usize, best: &mut Option<Split>) {
    let (mut left, mut right) = (begun_before, count);
    for group in events.chunk_by(|a, b| a >> 32 == b >> 32) {
        let of_kind = |k| group.iter().filter(|&&e| kind(e) == k).count();
        let planar = of_kind(PLANAR);
        right -= of_kind(END) + planar;
        sides.offer(coordinate(group[0]), left, planar, right, best);
        left += planar + of_kind(START);
    }
}

/// Puts two lists on a stack, made from the one that begins at `own`: what goes right, and above it what goes left.
/// Every item is written to both, and only the lists that it belongs to advance: no branch to mispredict. Returns where
/// the left list begins.
#[inline(always)]
fn fork<T: Copy + Default>(stack: &mut Vec<T>, own: usize, scratch: &mut Vec<T>, side: impl Fn(T) -> u8) -> usize {
    let start = stack.len();
    let count = start - own;
    stack.resize(start + count, T::default());
    if scratch.len() < count {
        scratch.resize(count, T::default());
    }
    let (source, right_out) = stack[own..].split_at_mut(count);
    let left_out = &mut scratch[..count];
    let (mut left, mut right) = (0, 0);
    for &item in source.iter() {
        let side = side(item);
        left_out[left] = item;
        right_out[right] = item;
        left += usize::from(side & LEFT);
        right += usize::from(side >> 1);
    }
    stack.truncate(start + right);
    stack.extend_from_slice(&scratch[..left]);
    start + right
}
