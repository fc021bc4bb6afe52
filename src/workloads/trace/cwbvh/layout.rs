//! Compressed wide BVH: eight children a node of 80 bytes, with boxes of 8 bits a plane.

use super::check;
use crate::math::Aabb;
use crate::scene::Scene;
use crate::workloads::trace::bvh::stack::EMPTY;
use crate::workloads::trace::common::check::{Expected, Verdict};
use crate::workloads::trace::common::properties::Leaves;
use crate::workloads::trace::common::sah::{CostModel, half_area};
use crate::workloads::trace::structure::finite;
use crate::workloads::trace::wide::{Numbers, Planes};
use crate::workloads::trace::{Properties, Structure, StructureKind, TriangleRef};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use std::any::Any;
use std::borrow::Cow;

/// Children of a node, at most.
pub const WIDTH: usize = 8;

/// Most triangle references of a leaf.
pub const MAX_LEAF: usize = 3;

/// Added to the place of an inner child in `meta`: no triangle of a leaf has such an offset.
pub const INNER: u8 = 24;

/// A node: 80 bytes, which kernels read as five texels.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct CwNode {
    /// Plane 0 of each axis.
    pub origin: [f32; 3],
    /// Biased exponents of the steps between planes.
    pub exponents: [u8; 3],
    /// A bit for each child that is a node, by its place.
    pub inner: u8,
    /// The node of the first such child; the others follow it in the order of their places.
    pub first_child: u32,
    /// The first triangle reference of its leaves.
    pub first_ref: u32,
    /// By place: 0 for no child. A node has 24 plus its place, and bit 5. A leaf has the offset of its first triangle
    /// reference from `first_ref`, and as many of the bits 5 to 7, from the lowest on, as it has references.
    pub meta: [u8; WIDTH],
    /// By axis, lower and upper planes, by place.
    pub planes: [[[u8; WIDTH]; 2]; 3],
}

/// What a child is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CwChild {
    /// This node.
    Node(u32),
    /// So many triangle references from the first one on.
    Leaf(u32, u32),
}

impl CwNode {
    /// A node without children.
    pub const EMPTY: CwNode = CwNode {
        origin: [0.0; 3],
        exponents: [127; 3],
        inner: 0,
        first_child: 0,
        first_ref: 0,
        meta: [0; WIDTH],
        planes: [[[0; WIDTH]; 2]; 3],
    };

    /// The planes of its children.
    #[inline(always)]
    pub fn grid(&self) -> Planes {
        let step = self.exponents.map(|exponent| f32::from_bits(u32::from(exponent) << 23));
        Planes { lo: self.origin.into(), step: step.into(), last: u16::from(u8::MAX) }
    }

    /// The numbers of a child's planes.
    #[inline(always)]
    pub fn numbers(&self, place: usize) -> Numbers {
        let of = |side: usize| [0, 1, 2].map(|axis: usize| u16::from(self.planes[axis][side][place]));
        (of(0), of(1))
    }

    /// Sets them.
    pub(super) fn set_numbers(&mut self, place: usize, (min, max): Numbers) {
        for axis in 0..3 {
            self.planes[axis][0][place] = min[axis] as u8;
            self.planes[axis][1][place] = max[axis] as u8;
        }
    }

    /// The child at a place.
    #[inline(always)]
    pub fn child(&self, place: usize) -> Option<CwChild> {
        let meta = self.meta[place];
        match meta {
            0 => None,
            _ if self.inner >> place & 1 == 1 => {
                Some(CwChild::Node(self.first_child + (self.inner & ((1 << place) - 1)).count_ones()))
            }
            _ => Some(CwChild::Leaf(self.first_ref + u32::from(meta & 31), (meta >> 5).count_ones())),
        }
    }
}

/// A built tree. Node 0 is the root; without triangles it has no children.
#[derive(Clone, Debug)]
pub struct Cwbvh {
    /// Box around everything.
    pub bounds: Aabb,
    /// Nodes.
    pub nodes: Vec<CwNode>,
    /// Leaf by leaf.
    pub triangle_refs: Vec<TriangleRef>,
    /// Levels of nodes on the longest way from the root to a leaf; 0 for an empty scene.
    pub depth: u32,
}

/// `Cwbvh` of `kernels/trace/cwbvh/node.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)]
pub struct CwbvhUniform {
    pub bounds_min: Vec3,
    pub root: u32,
    pub bounds_max: Vec3,
    pub pad: u32,
}

impl Cwbvh {
    /// Node 0, or nothing.
    pub fn root(&self) -> u32 {
        if self.triangle_refs.is_empty() { EMPTY } else { 0 }
    }

    /// Every child with its box, as traversals see it.
    fn children(&self) -> impl Iterator<Item = (CwChild, Aabb)> + '_ {
        let of_node = |node: &CwNode| {
            let (node, grid) = (*node, node.grid());
            (0..WIDTH).filter_map(move |place| Some((node.child(place)?, grid.aabb(node.numbers(place)))))
        };
        self.nodes.iter().flat_map(of_node)
    }

    /// Expected cost of a ray: a step for every node, and the tests of leaves; `None` if the root has no area.
    fn sah_cost(&self) -> Option<f64> {
        let model = CostModel::default();
        let root = half_area(&self.bounds);
        let below = self.children().map(|(child, aabb)| match child {
            CwChild::Node(_) => model.traversal * half_area(&aabb) / root,
            CwChild::Leaf(_, count) => model.leaf(count) * half_area(&aabb) / root,
        });
        (root > 0.0).then(|| model.traversal + below.sum::<f64>())
    }
}

impl Structure for Cwbvh {
    fn kind(&self) -> &'static StructureKind {
        &super::KIND
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
        size_of_val(self.nodes.as_slice())
    }

    fn nodes(&self) -> Cow<'_, [u8]> {
        Cow::Borrowed(bytemuck::cast_slice(&self.nodes))
    }

    fn uniform(&self) -> Vec<u8> {
        let Aabb { min: bounds_min, max: bounds_max } = finite(self.bounds);
        bytemuck::bytes_of(&CwbvhUniform { bounds_min, root: self.root(), bounds_max, pad: 0 }).to_vec()
    }

    fn stack_depth(&self) -> u32 {
        self.depth
    }

    fn properties(&self, scene: &Scene) -> Properties {
        let leaves = Leaves::of(self.children().filter_map(|(child, _)| match child {
            CwChild::Leaf(_, count) => Some(count),
            CwChild::Node(_) => None,
        }));
        let common = Properties {
            children_per_node: Some(self.children().count() as f64 / self.nodes.len() as f64),
            ..Properties::of_references(&self.triangle_refs, scene)
        };
        leaves.into_properties(self.nodes.len(), self.depth, self.sah_cost(), common)
    }

    fn check(&self, expected: &Expected) -> Verdict {
        check::check(self, expected)
    }
}
