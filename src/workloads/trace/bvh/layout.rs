//! Bounding volume hierarchy (SPEC section 4).

use crate::math::Aabb;
use crate::workloads::trace::TriangleRef;
use bytemuck::{Pod, Zeroable};
use glam::{Vec3A, Vec4};

/// A node: 32 bytes, so that two siblings are one 64-byte read.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct BvhNode {
    /// Smallest corner.
    pub min: [f32; 3],
    /// Inner node: index of the left child, always even; the right child follows it. Leaf: first triangle reference.
    pub first: u32,
    /// Largest corner.
    pub max: [f32; 3],
    /// Leaf: number of triangle references, 1 to [`MAX_LEAF`]. Inner node: 0.
    pub count: u32,
}

/// Most triangle references a leaf may have: traversals pack a leaf into one word, four bits of it are the count.
pub const MAX_LEAF: u32 = 15;

/// No builder makes a tree deeper than this, whatever it is given: traversals size their stacks by [`Bvh::depth`].
pub const MAX_DEPTH: u32 = 60;

impl BvhNode {
    /// An empty leaf: the dummy sibling of the root, and the root of an empty scene. Its box contains nothing.
    pub const NONE: BvhNode = BvhNode { min: [f32::MAX; 3], first: 0, max: [f32::MIN; 3], count: 0 };

    /// The node's box.
    pub fn aabb(&self) -> Aabb {
        Aabb { min: self.min.into(), max: self.max.into() }
    }

    /// What the node leads to in one word, as traversals and their stacks hold it (`kernels/trace/bvh/node.wgsl`): the left child
    /// of an inner node; of a leaf the top bit, four bits of count and 27 bits of first triangle reference. The root of an empty
    /// scene is a leaf without triangle references.
    #[inline(always)]
    pub fn reference(&self) -> u32 {
        if self.count > 0 || self.first == 0 { 1 << 31 | self.count << 27 | self.first } else { self.first }
    }

    /// Both corners, loaded as 16-byte rows (see [`crate::math::Ray`] on the hidden fourth lane).
    #[inline(always)]
    pub fn corners(&self) -> (Vec3A, Vec3A) {
        let rows: &[Vec4; 2] = bytemuck::cast_ref(self);
        (Vec3A::from_vec4(rows[0]), Vec3A::from_vec4(rows[1]))
    }
}

/// A built BVH. `nodes[0]` is the root, `nodes[1]` its dummy sibling (a copy of an empty leaf that no traversal visits),
/// so siblings always lie at an even index and the next. A root that is a leaf has `count > 0`; an empty scene has
/// `nodes[0].count == 0` with `first == 0`, which no inner node can have.
#[derive(Clone, Debug)]
pub struct Bvh {
    /// Box around everything.
    pub bounds: Aabb,
    /// Nodes, pairs together.
    pub nodes: Vec<BvhNode>,
    /// Leaf by leaf.
    pub triangle_refs: Vec<TriangleRef>,
    /// Levels of inner nodes on the longest way from the root to a leaf: what a stack must hold.
    pub depth: u32,
}
