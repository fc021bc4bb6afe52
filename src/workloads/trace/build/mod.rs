//! BVHs whose builders consist of passes over all triangles, or all nodes, at once: for devices, by the kernels of
//! `kernels/trace/build/`. The twins here make the same bytes on the CPU.

pub mod codes;
pub mod gpu;
pub mod lbvh;
pub mod ploc;
pub mod tree;

use crate::error::Result;
use crate::math::Aabb;
use crate::scene::Scene;
use crate::workloads::trace::bvh::build::check_number;
use crate::workloads::trace::bvh::{Bvh, BvhNode};
use crate::workloads::trace::common::prims::{self, Prim};

/// Where a builder has nothing to do: the tree over at most `max_leaf` triangles is a leaf, in the order of the scene.
pub(crate) enum Input {
    /// The tree.
    Leaf(Bvh),
    /// Boxes of more triangles than that, and the box around them.
    Prims(Vec<Prim>, Aabb),
}

impl Input {
    /// The triangles of a scene that can be hit.
    ///
    /// # Errors
    /// [`crate::Error::Refused`] for more triangles than a BVH can hold.
    pub fn of(scene: &Scene, max_leaf: u32) -> Result<Input> {
        let (prims, bounds) = prims::prims(scene)?;
        check_number(scene, prims.len())?;
        if prims.len() > max_leaf as usize {
            return Ok(Input::Prims(prims, bounds));
        }
        let root = match prims.len() {
            0 => BvhNode::NONE,
            count => BvhNode { min: bounds.min.into(), first: 0, max: bounds.max.into(), count: count as u32 },
        };
        let nodes = vec![root, BvhNode::NONE];
        let triangle_refs = prims::triangle_refs(scene, &prims);
        Ok(Input::Leaf(Bvh { bounds, nodes, triangle_refs, depth: 0, spatial: None }))
    }
}
