//! Invariants of a tree with quantised boxes.

use super::layout::{Slot, Wide};
use crate::math::Aabb;
use crate::workloads::trace::bvh::stack::leaf_triangle_refs;
use crate::workloads::trace::common::check::{Expected, Verdict, ensure, same};
use crate::workloads::trace::wide::reached::Reached;

pub(crate) fn check(tree: &Wide, expected: &Expected) -> Verdict {
    let (width, slots) = (tree.width, tree.slots.len());
    ensure!([2, 4, 8].contains(&width), "{width} children a node");
    ensure!(slots >= width && slots.is_multiple_of(width), "{slots} slots: a multiple of {width} is needed");
    for axis in 0..3 {
        let step = tree.planes.step[axis];
        ensure!(step.is_normal() && step.to_bits() & 0x807f_ffff == 0, "a step of {step} is no power of two");
        let lo = tree.planes.lo[axis];
        ensure!(lo.is_finite(), "plane 0 lies at {lo}");
    }
    if expected.hittable.is_empty() {
        ensure!(slots == width && tree.slots.iter().all(|slot| *slot == Slot::EMPTY), "no triangles, but nodes");
        ensure!(tree.triangle_refs.is_empty(), "no triangles, but triangle references");
        ensure!(tree.depth == 0 && tree.stack == 0, "no triangles, but a depth");
        return Ok(());
    }
    let mut walk = Walk { tree, reached: Reached::new(slots / width, &tree.triangle_refs, expected), stack: 0 };
    walk.node(0, 1, 0)?;
    ensure!(walk.stack == tree.stack, "a stack needs {} entries, the field says {}", walk.stack, tree.stack);
    walk.reached.all(tree.depth)
}

struct Walk<'a> {
    tree: &'a Wide,
    reached: Reached<'a>,
    stack: u32,
}

impl Walk<'_> {
    /// Checks a node and all below it; returns the box around its children, as decoded. `pending` entries of a stack
    /// may wait below it.
    fn node(&mut self, index: usize, depth: u32, pending: u32) -> Result<Aabb, String> {
        self.reached.node(index, depth)?;
        let slots = self.tree.node(index as u32);
        let filled: Vec<(usize, &Slot)> = slots.iter().enumerate().filter(|(_, slot)| !slot.is_empty()).collect();
        let no_child = slots.iter().filter(|slot| slot.is_empty());
        ensure!(no_child.copied().all(|slot| slot == Slot::EMPTY), "node {index} has an empty slot with a box");
        let is_first = |(place, slot): (usize, &(usize, &Slot))| slot.0 == place;
        let are_first = filled.iter().enumerate().all(is_first);
        ensure!(self.tree.octants || are_first, "node {index} has children behind an empty slot");
        self.reached.children(index, filled.len())?;
        let pending = pending + filled.len() as u32 - 1;
        self.stack = self.stack.max(pending);
        let planes = &self.tree.planes;
        let mut around = Aabb::EMPTY;
        for (place, slot) in filled {
            let what = format!("child {place} of node {index}");
            let own = slot.aabb(planes);
            let content = if slot.is_leaf() {
                let (first, count) = leaf_triangle_refs(slot.reference);
                ensure!(count > 0, "{what} is a leaf without triangle references");
                self.reached.leaf(&what, (first, count), own)?
            } else {
                self.node(slot.reference as usize, depth + 1, pending)?
            };
            ensure!(own.contains(content), "{what} has box {own:?}, which does not hold its content {content:?}");
            let fitting = planes.aabb(planes.numbers(content));
            ensure!(same(own, fitting), "{what} has box {own:?}, around its content is {fitting:?}");
            around = around.union(own);
        }
        Ok(around)
    }
}
