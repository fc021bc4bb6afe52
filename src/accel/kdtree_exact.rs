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
        scratch: Vec::new(),
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
    scratch: Vec<Event>,
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
            let (mut left, mut right) = (count - begun_inside, count);
            let mut i = 0;
            while i < events.len() {
                let here = events[i] >> 32;
                let mut kinds = [0_usize; 4];
                while i < events.len() && events[i] >> 32 == here {
                    kinds[kind(events[i]) as usize] += 1;
                    i += 1;
                }
                let [ended, planar, begun, _] = kinds;
                right -= ended + planar;
                sides.offer(coordinate(here << 32), left, planar, right, &mut best);
                left += planar + begun;
            }
        }
        best
    }

    /// Puts the children's lists on the stacks, the left one on top.
    fn divide(&mut self, node: &Node, split: &Split) -> (Node, Node) {
        self.classify(node, split);
        let (left_cell, right_cell) = halves(&node.cell, split);
        let right_locals = self.locals.len();
        let own = node.locals..right_locals;
        for side in [RIGHT, LEFT] {
            for i in own.clone() {
                let l = self.locals[i];
                if self.side[l as usize] & side != 0 {
                    self.locals.push(l);
                }
            }
        }
        let left_locals = right_locals + split.right;
        debug_assert_eq!(self.locals.len(), left_locals + split.left);

        let right_events = [0, 1, 2].map(|a| self.events[a].len());
        let mut left_events = right_events;
        for axis in 0..3 {
            let own = node.events[axis];
            left_events[axis] = if axis == split.axis { self.cut(own, split) } else { self.filter(axis, own) };
        }
        (
            Node { locals: left_locals, events: left_events, cell: left_cell, depth: node.depth + 1 },
            Node { locals: right_locals, events: right_events, cell: right_cell, depth: node.depth + 1 },
        )
    }

    /// Decides where every triangle of the node goes: to both sides unless an event says otherwise.
    fn classify(&mut self, node: &Node, split: &Split) {
        for &l in &self.locals[node.locals..] {
            self.side[l as usize] = LEFT | RIGHT;
        }
        let plane = ordered(split.plane);
        for &e in &self.events[split.axis][node.events[split.axis]..] {
            let x = (e >> 32) as u32;
            let side = &mut self.side[local(e)];
            match kind(e) {
                END if x <= plane => *side = LEFT,
                START if x >= plane => *side = RIGHT,
                PLANAR if x < plane || (x == plane && split.planar_left) => *side = LEFT,
                PLANAR => *side = RIGHT,
                _ => {}
            }
        }
    }

    /// Events of the split axis: those below the plane go left, those above go right, and those in the plane are now
    /// on the border, where only planar triangles are remembered. Returns where the left list begins.
    fn cut(&mut self, own: usize, split: &Split) -> usize {
        let events = &mut self.events[split.axis];
        let plane = u64::from(ordered(split.plane));
        let end = events.len();
        let below = own + events[own..].partition_point(|&e| e >> 32 < plane);
        let above = own + events[own..].partition_point(|&e| e >> 32 <= plane);
        let planar_from = below + events[below..above].partition_point(|&e| kind(e) < PLANAR);
        let planar_to = below + events[below..above].partition_point(|&e| kind(e) <= PLANAR);
        let planar = planar_from..planar_to;
        if !split.planar_left {
            events.extend_from_within(planar.clone());
        }
        events.extend_from_within(above..end);
        let left = events.len();
        events.extend_from_within(own..below);
        if split.planar_left {
            events.extend_from_within(planar);
        }
        left
    }

    /// Events of another axis: each goes where its triangle goes. Every event is written to both lists, and only the
    /// lists that it belongs to advance: no branch to mispredict. Returns where the left list begins.
    fn filter(&mut self, axis: usize, own: usize) -> usize {
        let events = &mut self.events[axis];
        let start = events.len();
        let count = start - own;
        events.resize(start + count, 0);
        if self.scratch.len() < count {
            self.scratch.resize(count, 0);
        }
        let (source, right_out) = events[own..].split_at_mut(count);
        let left_out = &mut self.scratch[..count];
        let (mut left, mut right) = (0, 0);
        for &e in source.iter() {
            let side = self.side[local(e)];
            left_out[left] = e;
            right_out[right] = e;
            left += usize::from(side & LEFT);
            right += usize::from(side >> 1);
        }
        events.truncate(start + right);
        events.extend_from_slice(&self.scratch[..left]);
        start + right
    }
}
