//! Trees of two, four or eight children a node, whose boxes are quantised: 16 bits a plane, in units of the scene.

use super::check;
use super::octants;
use super::quantise::Planes;
use crate::math::Aabb;
use crate::scene::Scene;
use crate::workloads::trace::bvh::stack::{EMPTY, LEAF, leaf_triangle_refs};
use crate::workloads::trace::common::check::{Expected, Verdict};
use crate::workloads::trace::common::properties::Leaves;
use crate::workloads::trace::common::sah::{CostModel, half_area};
use crate::workloads::trace::structure::finite;
use crate::workloads::trace::{Properties, Structure, StructureKind, TriangleRef};
use bytemuck::{Pod, Zeroable};
use glam::{Vec3, Vec3A};
use std::any::Any;
use std::borrow::Cow;

/// A child of a node: 16 bytes, which kernels read as one texel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Slot {
    /// Numbers of the lower planes.
    pub min: [u16; 3],
    /// Numbers of the upper planes.
    pub max: [u16; 3],
    /// Where it leads to: the index of a node, a leaf as [`crate::workloads::trace::bvh::BvhNode::reference`] packs it,
    /// or [`EMPTY`].
    pub reference: u32,
}

impl Slot {
    /// No child.
    pub const EMPTY: Slot = Slot { min: [0; 3], max: [0; 3], reference: EMPTY };

    /// True for a leaf, and for an empty slot.
    pub fn is_leaf(&self) -> bool {
        self.reference & LEAF != 0
    }

    /// True if it holds no child.
    pub fn is_empty(&self) -> bool {
        self.reference == EMPTY
    }

    /// A child with the smallest box around this one.
    pub fn around(content: Aabb, reference: u32, planes: &Planes) -> Slot {
        let (min, max) = planes.numbers(content);
        assert!(planes.aabb((min, max)).contains(content), "planes do not reach around {content:?}");
        Slot { min, max, reference }
    }

    /// Its box, as traversals see it.
    #[inline(always)]
    pub fn corners(&self, planes: &Planes) -> (Vec3A, Vec3A) {
        planes.corners(self.min, self.max)
    }

    /// The same.
    pub fn aabb(&self, planes: &Planes) -> Aabb {
        planes.aabb((self.min, self.max))
    }
}

/// A built tree. Node `i` is `slots[i * width..][..width]`; node 0 is the root. A scene with one leaf has it in the
/// root's first slot, an empty one has a root without children.
///
/// One grid of planes for the whole scene, where the literature has one for each node (Ylitie et al. 2017): nothing of
/// the grid is read with a node, and a box inside a box stays inside it.
#[derive(Clone, Debug)]
pub struct Wide {
    /// Box around everything.
    pub bounds: Aabb,
    /// Children of a node, at most: 2, 4 or 8.
    pub width: usize,
    /// Nodes. The children of one are its first slots, or with `octants` at places that tell their order.
    pub slots: Vec<Slot>,
    /// Children lie as [`super::octants`] says.
    pub octants: bool,
    /// Leaf by leaf.
    pub triangle_refs: Vec<TriangleRef>,
    /// Levels of nodes on the longest way from the root to a leaf; 0 for an empty scene.
    pub depth: u32,
    /// Children on one way from the root that can wait while another one is visited: what a stack must hold.
    pub stack: u32,
    /// The planes of boxes.
    pub planes: Planes,
}

/// `Wide` of `kernels/trace/wide/node.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)]
pub struct WideUniform {
    pub bounds_min: Vec3,
    pub root: u32,
    pub bounds_max: Vec3,
    pub axes: u32,
    pub lo: Vec3,
    pub pad1: u32,
    pub step: Vec3,
    pub pad2: u32,
}

impl Wide {
    /// The slots of a node.
    pub fn node(&self, index: u32) -> &[Slot] {
        &self.slots[index as usize * self.width..][..self.width]
    }

    /// What a traversal begins with: the box around everything, and the reference of node 0, or of the one leaf, or
    /// [`EMPTY`].
    pub fn root(&self) -> (Vec3A, Vec3A, u32) {
        let Aabb { min, max } = finite(self.bounds);
        let mut filled = self.node(0).iter().filter(|slot| !slot.is_empty());
        let root = match (filled.next(), filled.next()) {
            (None, _) => EMPTY,
            (Some(leaf), None) => leaf.reference,
            _ => 0,
        };
        (min.into(), max.into(), root)
    }

    /// The axes of the bits of a place, lowest bit first.
    pub fn axes(&self) -> Vec<usize> {
        octants::axes(self.width, self.bounds)
    }

    /// Number of nodes and of children.
    fn filled(&self) -> (usize, usize) {
        let nodes = self.slots.len() / self.width;
        (nodes, self.slots.iter().filter(|slot| !slot.is_empty()).count())
    }

    /// Expected cost of a ray: a step for every node, and the tests of leaves; `None` if the root has no area.
    fn sah_cost(&self) -> Option<f64> {
        let model = CostModel::default();
        let root = half_area(&self.bounds);
        let of_slot = |slot: &Slot| {
            let own = if slot.is_leaf() { model.leaf(leaf_triangle_refs(slot.reference).1) } else { model.traversal };
            own * half_area(&slot.aabb(&self.planes)) / root
        };
        let below: f64 = self.slots.iter().filter(|slot| !slot.is_empty()).map(of_slot).sum();
        let is_inner = self.root().2 & LEAF == 0;
        (root > 0.0).then_some(below + if is_inner { model.traversal } else { 0.0 })
    }
}

impl Structure for Wide {
    fn kind(&self) -> &'static StructureKind {
        super::kind(self.width)
    }

    fn as_any(&self) -> &dyn Any {
        self
    }

    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn triangle_refs(&self) -> &[TriangleRef] {
        &self.triangle_refs
    }

    fn node_bytes(&self) -> usize {
        size_of_val(self.slots.as_slice())
    }

    fn nodes(&self) -> Cow<'_, [u8]> {
        Cow::Borrowed(bytemuck::cast_slice(&self.slots))
    }

    fn uniform(&self) -> Vec<u8> {
        let Aabb { min: bounds_min, max: bounds_max } = finite(self.bounds);
        let (root, lo, step) = (self.root().2, self.planes.lo.into(), self.planes.step.into());
        let axes = self.axes().iter().rev().fold(0, |axes, &axis| axes << 2 | axis as u32);
        bytemuck::bytes_of(&WideUniform { bounds_min, root, bounds_max, axes, lo, pad1: 0, step, pad2: 0 }).to_vec()
    }

    fn stack_depth(&self) -> u32 {
        self.stack
    }

    fn properties(&self, scene: &Scene) -> Properties {
        let (nodes, children) = self.filled();
        let leaves = self.slots.iter().filter(|slot| slot.is_leaf() && !slot.is_empty());
        let leaves = Leaves::of(leaves.map(|slot| leaf_triangle_refs(slot.reference).1));
        let common = Properties {
            children_per_node: Some(children as f64 / nodes as f64),
            ..Properties::of_references(&self.triangle_refs, scene)
        };
        leaves.into_properties(nodes, self.depth, self.sah_cost(), common)
    }

    fn check(&self, expected: &Expected) -> Verdict {
        check::check(self, expected)
    }
}
