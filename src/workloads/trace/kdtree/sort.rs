//! kd-tree builder: top down, greedy SAH on boxes, with the exact sweep at all sizes.
//!
//! I. Wald and V. Havran: On building fast kd-trees for Ray Tracing, and on doing that in O(N log N), 2006. Without
//! clipping. Large nodes have lists of their own, which several threads filter; a child's triangles are numbered anew,
//! so that what a thread looks up in its lists lies close together. Small nodes are left to [`super::exact`].

use crate::math::Aabb;
use crate::workloads::trace::common::prims::Prim;
use crate::workloads::trace::common::sah::unit;
use crate::workloads::trace::kdtree::build::{Builder, Part, Sorting, Subtree, both, halves};
use crate::workloads::trace::kdtree::cut::{Cut, LEFT, List, RIGHT, find};
use crate::workloads::trace::kdtree::events::{Event, PLANAR, SPARE, Sorted, kind, local, renumbered};
use crate::workloads::trace::kdtree::exact::{self, Begin};

/// Nodes of more triangles have lists of their own.
const LARGE: usize = 4096;

/// A triangle's number among those of a side that it does not go to.
const NONE: u32 = u32::MAX;

/// Builds the tree.
pub(crate) fn grow(builder: &Builder, prims: &[Prim], sorting: Sorting, bounds: Aabb) -> Part {
    let sorter = Sorter { builder, prims, once: sorting == Sorting::Once, unit: unit(&bounds) };
    let own: Vec<u32> = (0..prims.len() as u32).collect();
    let events = sorter.once.then(|| sorter.sorted(&own, &bounds));
    sorter.grow(Node { own, events, cell: bounds, depth: 0 })
}

struct Sorter<'a> {
    builder: &'a Builder,
    prims: &'a [Prim],
    /// Events are sorted once and filtered into the children; else they are sorted anew in each node.
    once: bool,
    /// About 1 over the extent of the scene.
    unit: f32,
}

/// A cell to be split.
struct Node {
    /// Its triangles: numbers in the list of all, ascending.
    own: Vec<u32>,
    /// By axis, their events, each triangle known by its place in `own`. `None` if they are not sorted yet.
    events: Option<[Sorted; 3]>,
    cell: Aabb,
    depth: u32,
}

impl Sorter<'_> {
    /// The events of a cell by axis, sorted.
    fn sorted(&self, own: &[u32], cell: &Aabb) -> [Sorted; 3] {
        let on = |axis: usize| {
            let mut sorted = Sorted::default();
            sorted.fill((0..).zip(own.iter().map(|&i| &self.prims[i as usize])), axis, cell);
            sorted
        };
        let (x, (y, z)) = both(own.len() > LARGE, || on(0), || both(own.len() > LARGE, || on(1), || on(2)));
        [x, y, z]
    }

    /// Builds the subtree of a node.
    fn grow(&self, node: Node) -> Part {
        let Node { own, events, cell, depth } = node;
        if own.len() <= LARGE {
            let prims: Vec<Prim> = own.iter().map(|&i| self.prims[i as usize]).collect();
            let begin = Begin { prims: &prims, events, cell, depth, unit: self.unit };
            return Part::Subtree(exact::build(self.builder, begin));
        }
        let stop = self.builder.must_stop(own.len(), depth) || self.builder.over_budget();
        let split = if stop { None } else { self.split(&own, events, &cell) };
        let Some(Split { axis, plane, children }) = split else {
            self.builder.charge(1 + own.len());
            return Part::Subtree(Subtree::leaf(self.prims, &own));
        };
        drop(own);
        let (left_cell, right_cell) = halves(&cell, axis, plane);
        let [(left, left_events), (right, right_events)] = children;
        let depth = depth + 1;
        let a = || self.grow(Node { own: left, events: left_events, cell: left_cell, depth });
        let b = || self.grow(Node { own: right, events: right_events, cell: right_cell, depth });
        Part::Inner(axis, plane, Box::new(both(true, a, b)))
    }

    /// Looks for the cheapest plane and divides the lists; `None` if it does not pay.
    fn split(&self, own: &[u32], events: Option<[Sorted; 3]>, cell: &Aabb) -> Option<Split> {
        let events = events.unwrap_or_else(|| self.sorted(own, cell));
        let lists = [0, 1, 2].map(|axis| events[axis].list());
        let cut = find(self.builder, cell, self.unit, own.len(), &lists)?;
        let mut side = vec![LEFT | RIGHT; own.len()];
        cut.classify(&lists[cut.axis], &mut side);
        let (owns, ranks) = divide(own, &side);
        let [left, right] = owns;
        let children = if self.once {
            let on = |axis: usize| {
                if axis == cut.axis { part(&lists[axis], &cut, &ranks) } else { fork(&lists[axis], &ranks) }
            };
            let (x, (y, z)) = both(true, || on(0), || both(true, || on(1), || on(2)));
            let ([x0, x1], [y0, y1], [z0, z1]) = (x, y, z);
            [(left, Some([x0, y0, z0])), (right, Some([x1, y1, z1]))]
        } else {
            [(left, None), (right, None)]
        };
        Some(Split { axis: cut.axis, plane: cut.plane, children })
    }
}

/// A plane, and the lists of both sides.
struct Split {
    axis: usize,
    plane: f32,
    children: [(Vec<u32>, Option<[Sorted; 3]>); 2],
}

/// Both sides' triangles, and the places of each triangle in them.
fn divide(own: &[u32], side: &[u8]) -> ([Vec<u32>; 2], Vec<[u32; 2]>) {
    let (mut left, mut right) = (Vec::with_capacity(own.len()), Vec::with_capacity(own.len()));
    let add = |list: &mut Vec<u32>, number: u32, goes: bool| {
        let place = list.len() as u32;
        list.extend(goes.then_some(number));
        if goes { place } else { NONE }
    };
    let rank = |(&number, side): (&u32, &u8)| {
        [add(&mut left, number, side & LEFT != 0), add(&mut right, number, side & RIGHT != 0)]
    };
    let ranks = own.iter().zip(side).map(rank).collect();
    ([left, right], ranks)
}

/// Both sides' events on an axis other than that of the plane. Every event is written to both, and only the lists that
/// it belongs to advance (each has room for one more): no branch to mispredict.
fn fork(list: &List, ranks: &[[u32; 2]]) -> [Sorted; 2] {
    let (mut left, mut right) = (vec![0; list.own + SPARE], vec![0; list.own + SPARE]);
    let (mut left_count, mut right_count) = (0, 0);
    for &event in list.events() {
        let [in_left, in_right] = ranks[local(event)];
        left[left_count] = renumbered(event, in_left);
        right[right_count] = renumbered(event, in_right);
        left_count += usize::from(in_left != NONE);
        right_count += usize::from(in_right != NONE);
    }
    [(left, left_count), (right, right_count)].map(|(mut events, own)| {
        events.truncate(own + SPARE);
        Sorted { planar: list.planar && events[..own].iter().any(|&e| kind(e) == PLANAR), events, own }
    })
}

/// Both sides' events on the axis of the plane: those below and those above it. What lies in the plane is on the border
/// now, where only planar triangles are remembered.
fn part(list: &List, cut: &Cut, ranks: &[[u32; 2]]) -> [Sorted; 2] {
    let events = list.events();
    let planar: Vec<Event> = if list.planar { cut.planar(events).collect() } else { Vec::new() };
    let (below, above) = (&events[..cut.here.start], &events[cut.here.end..]);
    let (to_left, to_right): (&[Event], &[Event]) = if cut.planar_left { (&planar, &[]) } else { (&[], &planar) };
    [(0, [below, to_left]), (1, [to_right, above])].map(|(side, lists)| {
        let own = lists[0].len() + lists[1].len();
        let mut events = Vec::with_capacity(own + SPARE);
        events.extend(lists.into_iter().flatten().map(|&e| renumbered(e, ranks[local(e)][side])));
        events.extend([0; SPARE]);
        Sorted { planar: list.planar && events[..own].iter().any(|&e| kind(e) == PLANAR), events, own }
    })
}
