//! Trees of four or eight children a node, one ray at a time with a private stack, nearest child first. Twin of
//! `kernels/trace/wide/stack.wgsl`.
//!
//! Of the children that a ray meets, the nearest is next; the others are sorted into the stack, the nearest on top. Of
//! equal distances the earlier slot comes first.

use super::octants_stack::{OCTANTS4, OCTANTS8};
use super::short_stack::{MAX_ENTRIES, SHORT4, SHORT8};
use super::{BVH4_BUILDER, BVH8_BUILDER, EIGHT, FOUR, Wide, has_octants};
use crate::math::{Ray, ray_box};
use crate::workloads::trace::algorithm::{Algorithm, Parameter, Traversal};
use crate::workloads::trace::bvh::loops::WHILE_WHILE;
use crate::workloads::trace::bvh::stack::{CULL, Down, EMPTY, LEAF, Stack, StackSearch, overlaps, parameters};
use crate::workloads::trace::count::Count;
use crate::workloads::trace::cpu::Twin;
use crate::workloads::trace::options::{Axis, GROUP, Kind, OptionInfo};
use crate::workloads::trace::selection::Selection;
use crate::workloads::trace::simt::{Event::Step, Lockstep, Read};
use crate::workloads::trace::wide::layout::Slot;
use glam::Vec3A;

const PAPER: &str = "Wald, Benthin and Boulos 2008; Ylitie, Karras and Laine 2017";

/// Four children a node.
pub static BVH4: Algorithm = Algorithm {
    name: "bvh4",
    alias: "",
    summary: "the BVH of bvh-stack collapsed to four children a node, 16 bits a plane, a stack per ray",
    paper: PAPER,
    builder: &BVH4_BUILDER,
    traversal: |s| traversal(s, [&STACK4, &SHORT4, &OCTANTS4]),
    options: OPTIONS,
};

/// Eight children a node.
pub static BVH8: Algorithm = Algorithm {
    name: "bvh8",
    alias: "",
    summary: "the BVH of bvh-stack collapsed to eight children a node, 16 bits a plane, a stack per ray",
    paper: PAPER,
    builder: &BVH8_BUILDER,
    traversal: |s| traversal(s, [&STACK8, &SHORT8, &OCTANTS8]),
    options: OPTIONS,
};

fn traversal(s: &Selection, [full, short, octants]: [&'static Traversal; 3]) -> &'static Traversal {
    match (has_octants(s), has_short_stack(s)) {
        (true, _) => octants,
        (false, true) => short,
        (false, false) => full,
    }
}

fn has_short_stack(s: &Selection) -> bool {
    s.value("stack") == "short"
}

const OPTIONS: &[OptionInfo] = &[
    OptionInfo::new(
        Axis::Traversal,
        "order",
        "distance",
        "which of the children that a ray meets is next: the nearest, or the first by the signs of its direction",
        Kind::Word(&["distance", "octant"]),
    ),
    OptionInfo::new(
        Axis::Traversal,
        "stack",
        "full",
        "room for all children that a ray meets, or for a few of them, with a trail from the root",
        Kind::Word(&["full", "short"]),
    )
    .idle_if(keeps_no_distances),
    OptionInfo::new(Axis::Traversal, "entries", "8", "entries of the short stack", Kind::Count(1, MAX_ENTRIES))
        .idle_if(|s| keeps_no_distances(s).or((!has_short_stack(s)).then(|| "stack=full has room for all".to_owned()))),
    CULL.idle_if(|s| keeps_no_distances(s).or(has_short_stack(s).then(|| "stack=short always culls".to_owned()))),
    GROUP,
];

fn keeps_no_distances(s: &Selection) -> Option<String> {
    has_octants(s).then(|| "order=octant keeps no distances".to_owned())
}

/// Depth first, nearest child first, in trees of four children a node.
pub static STACK4: Traversal = Traversal {
    kernel: "trace/wide/stack.wgsl",
    structure: &FOUR,
    parameters: |s| parameters(s).and("WIDTH", Parameter::Word(4)),
    twin: Some(TWIN),
    leaf_order: true,
    lockstep: Some(|_| LOCKSTEP4),
    ..Traversal::INDEPENDENT
};

/// The same in trees of eight.
pub static STACK8: Traversal = Traversal {
    structure: &EIGHT,
    parameters: |s| parameters(s).and("WIDTH", Parameter::Word(8)),
    lockstep: Some(|_| LOCKSTEP8),
    ..STACK4
};

/// How their lanes wait for each other.
const LOCKSTEP4: Lockstep = WHILE_WHILE.reading(&[Read::one::<[Slot; 4]>(Step)]);

const LOCKSTEP8: Lockstep = WHILE_WHILE.reading(&[Read::one::<[Slot; 8]>(Step)]);

const TWIN: Twin = |input| {
    let tree: &Wide = input.structure()?;
    Ok(input.with(StackSearch::new(&input, Sorted(tree))))
};

/// Puts a child on the stack, below those from entry `base` on that are nearer or equally near.
#[inline(always)]
fn insert(reference: u32, t: f32, base: usize, stack: &mut Stack) {
    let mut place = stack.depth;
    while place > base && stack.t[place - 1] <= t {
        stack.node[place] = stack.node[place - 1];
        stack.t[place] = stack.t[place - 1];
        place -= 1;
    }
    stack.node[place] = reference;
    stack.t[place] = t;
    stack.depth += 1;
}

/// Nodes of several children, in order of distance.
pub(in crate::workloads::trace) struct Sorted<'a>(pub &'a Wide);

impl Down for Sorted<'_> {
    fn root(&self) -> (Vec3A, Vec3A, u32) {
        self.0.root()
    }

    #[inline(always)]
    fn walk_to_leaf<C: Count>(&self, ray: &Ray, t: f32, from: u32, stack: &mut Stack, count: &mut C) -> u32 {
        let tree = self.0;
        let mut reference = from;
        while reference & LEAF == 0 {
            count.inner();
            count.read(reference);
            let base = stack.depth;
            let (mut next, mut next_t) = (EMPTY, 0.0);
            for child in tree.node(reference).iter().take_while(|child| !child.is_empty()) {
                count.box_test();
                let (min, max) = child.corners(&tree.planes);
                let interval = ray_box(ray, min, max);
                if !overlaps(interval, t) {
                    continue;
                }
                if next == EMPTY {
                    (next, next_t) = (child.reference, interval.0);
                } else if interval.0 < next_t {
                    stack.push(next, next_t);
                    (next, next_t) = (child.reference, interval.0);
                } else {
                    insert(child.reference, interval.0, base, stack);
                }
            }
            reference = if next == EMPTY { stack.pop(t, count) } else { next };
        }
        reference
    }
}
