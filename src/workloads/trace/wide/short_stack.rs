//! Trees of four or eight children a node, one ray at a time with a short private stack, nearest child first. Twin of
//! `kernels/trace/wide/short_stack.wgsl`.
//!
//! K. Vaidyanathan, S. Woop and C. Benthin: Wide BVH Traversal with a Short Stack, 2019, after S. Laine: Restart Trail
//! for Stackless BVH Traversal, 2010. A trail tells, for each level of the way from the root, which child the ray is
//! in, by its place in the order of distances. An entry that finds no room takes that of the oldest one. Where the
//! stack is empty, the ray goes down from the root again along the trail. In the paper a counter is set to its greatest
//! value where the last child is visited. Ours: the trail has the number of children as well, since a hit takes
//! children off the end of that order, so that another one might be taken for the last.

use super::{EIGHT, FOUR, Wide};
use crate::math::{MISS, Ray, ray_box};
use crate::workloads::trace::algorithm::{Parameter, Parameters, Traversal};
use crate::workloads::trace::bvh::stack::{EMPTY, LEAF, leaf_triangle_refs, overlaps};
use crate::workloads::trace::bvh::widened::{self, Widening};
use crate::workloads::trace::count::Count;
use crate::workloads::trace::cpu::Twin;
use crate::workloads::trace::selection::Selection;
use crate::workloads::trace::simt::{
    Event::{Child, Leaf, Pop, Restart, Step, Test},
    Lockstep,
    Part::One,
    Read, choice, maybe, repeat,
};
use crate::workloads::trace::traverse::{Best, STACK_SIZE, TraverseIndependent, Triangles};
use crate::workloads::trace::wide::collapse::MAX_WIDTH;
use crate::workloads::trace::wide::layout::Slot;
use glam::Vec3A;

/// Most entries of the stack.
pub(super) const MAX_ENTRIES: u32 = 16;

/// In trees of four children a node.
pub static SHORT4: Traversal = Traversal {
    kernel: "trace/wide/short_stack.wgsl",
    structure: &FOUR,
    parameters: |s| parameters(s, 4),
    twin: Some(TWIN),
    leaf_order: true,
    lockstep: Some(|_| LOCKSTEP4),
    ..Traversal::INDEPENDENT
};

/// How its lanes wait for each other.
const LOCKSTEP: Lockstep = Lockstep::apart(&[repeat(&[
    choice(&[maybe(&[One(Leaf), repeat(&[One(Test)])]), maybe(&[One(Step), repeat(&[One(Child)])])]),
    repeat(&[choice(&[maybe(&[One(Pop)]), maybe(&[One(Restart)])])]),
])]);

const LOCKSTEP4: Lockstep = LOCKSTEP.reading(&[Read::one::<[Slot; 4]>(Step)]);

const LOCKSTEP8: Lockstep = LOCKSTEP.reading(&[Read::one::<[Slot; 8]>(Step)]);

/// In trees of eight.
pub static SHORT8: Traversal =
    Traversal { structure: &EIGHT, parameters: |s| parameters(s, 8), lockstep: Some(|_| LOCKSTEP8), ..SHORT4 };

fn parameters(s: &Selection, width: u32) -> Parameters {
    let entries = Parameter::Word(s.size("entries") as u32);
    Parameters::of(&[("WIDTH", Parameter::Word(width)), ("ENTRIES", entries), widened::parameter(s)])
}

const TWIN: Twin = |input| {
    let tree: &Wide = input.structure()?;
    let (min, max, root) = tree.root();
    let widening = Widening::around(&input, (min, max));
    let entries = input.method.parameters.word("ENTRIES") as usize;
    Ok(input.with(ShortStack { triangles: input.triangles(), tree, root: (min, max, root), widening, entries }))
};

struct ShortStack<'a> {
    triangles: Triangles<'a>,
    tree: &'a Wide,
    root: (Vec3A, Vec3A, u32),
    widening: Widening,
    /// Of the stack.
    entries: usize,
}

/// Nodes with the distances at which their boxes begin.
type Entry = (u32, f32);

/// A ring.
struct Stack {
    of: [Entry; MAX_ENTRIES as usize],
    /// The entry behind the newest one.
    top: usize,
    depth: usize,
}

impl Stack {
    fn push(&mut self, entry: Entry, entries: usize) {
        self.of[self.top] = entry;
        self.top = if self.top + 1 == entries { 0 } else { self.top + 1 };
        self.depth = (self.depth + 1).min(entries);
    }

    fn pop(&mut self, entries: usize) -> Entry {
        self.top = if self.top == 0 { entries } else { self.top } - 1;
        self.depth -= 1;
        self.of[self.top]
    }
}

impl ShortStack<'_> {
    /// Finds the children of a node that the ray meets before `t`, nearest first, and of equal distances by their
    /// places. Returns their number.
    #[inline(always)]
    fn visit<C: Count>(&self, ray: &Ray, node: u32, t: f32, met: &mut [Entry; MAX_WIDTH], count: &mut C) -> usize {
        count.inner();
        count.read(node);
        let mut number = 0;
        for child in self.tree.node(node).iter().take_while(|child| !child.is_empty()) {
            count.box_test();
            let (min, max) = child.corners(&self.tree.planes);
            let interval = ray_box(ray, min, max);
            if overlaps(interval, t) {
                let mut place = number;
                while place > 0 && interval.0 < met[place - 1].1 {
                    met[place] = met[place - 1];
                    place -= 1;
                }
                met[place] = (child.reference, interval.0);
                number += 1;
            }
        }
        number
    }
}

impl TraverseIndependent for ShortStack<'_> {
    fn traverse<const ANY: bool, C: Count>(&self, ray: &Ray, limit: f32, count: &mut C) -> u32 {
        let mut best = Best::before(limit);
        let wide = self.widening.widened(ray);
        let (min, max, root) = self.root;
        if root == EMPTY || !overlaps(ray_box(&wide, min, max), limit) {
            return MISS;
        }
        let mut stack = Stack { of: [(EMPTY, 0.0); MAX_ENTRIES as usize], top: 0, depth: 0 };
        let mut trail = [(0_usize, 0_usize); STACK_SIZE]; // the child, and their number
        let mut met = [(EMPTY, 0.0); MAX_WIDTH];
        let (mut node, mut level) = (root, 0);
        let mut known = 0; // levels of the trail that are valid
        loop {
            if node & LEAF != 0 {
                count.leaf();
                let (first, triangle_refs) = leaf_triangle_refs(node);
                if self.triangles.test::<ANY, C>(ray, first, triangle_refs, &mut best, count) {
                    return best.triangle_ref;
                }
            } else {
                let number = self.visit(&wide, node, best.t, &mut met, count);
                let child = if level < known { trail[level].0 } else { 0 };
                trail[level] = (child, number);
                known = known.max(level + 1);
                if child < number {
                    met[child + 1..number].iter().rev().for_each(|&entry| stack.push(entry, self.entries));
                    node = met[child].0;
                    level += 1;
                    continue;
                }
            }
            // The next node: another child on the deepest level that has one
            loop {
                if level == 0 {
                    return best.triangle_ref;
                }
                level -= 1;
                let (child, number) = trail[level];
                if child + 1 >= number {
                    continue;
                }
                trail[level].0 = child + 1;
                known = level + 1;
                if stack.depth == 0 {
                    count.restart();
                    (node, level) = (root, 0);
                    break;
                }
                count.pop();
                level += 1;
                let (next, t) = stack.pop(self.entries);
                node = next;
                if t <= best.t {
                    break;
                }
            }
        }
    }
}
