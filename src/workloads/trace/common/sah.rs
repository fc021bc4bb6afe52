//! The surface area heuristic: what a tree costs a random ray that meets its root's box.
//!
//! J. D. MacDonald and K. S. Booth: Heuristics for Ray Tracing using Space Subdivision, 1990.

use crate::math::Aabb;
use crate::workloads::trace::bvh::Bvh;
use crate::workloads::trace::kdtree::KdTree;

/// Costs in any unit; only their ratio matters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CostModel {
    /// One step through an inner node.
    pub traversal: f64,
    /// One ray/triangle test.
    pub intersection: f64,
}

impl Default for CostModel {
    /// Both the same: the published kd-trees are explained by it (METHODOLOGY.md).
    fn default() -> Self {
        CostModel { traversal: 1.0, intersection: 1.0 }
    }
}

/// Half the surface area in f64: neither huge nor tiny boxes leave its range.
pub fn half_area(b: &Aabb) -> f64 {
    let e = (b.max.as_dvec3() - b.min.as_dvec3()).max(glam::DVec3::ZERO);
    e.x * e.y + e.y * e.z + e.z * e.x
}

/// A power of two near 1 over the largest extent: areas in this unit neither overflow nor vanish.
pub(crate) fn unit(bounds: &Aabb) -> f32 {
    let extent = (bounds.max.as_dvec3() - bounds.min.as_dvec3()).max_element();
    if extent > 0.0 { extent.log2().floor().clamp(-120.0, 120.0).exp2().recip() as f32 } else { 1.0 }
}

impl CostModel {
    /// Cost of a leaf.
    pub fn leaf(&self, triangles: u32) -> f64 {
        self.intersection * f64::from(triangles)
    }

    /// Expected cost of a ray through a BVH; `None` if the root has no area.
    pub fn bvh(&self, bvh: &Bvh) -> Option<f64> {
        let root = half_area(&bvh.bounds);
        let area = |node: usize| half_area(&bvh.nodes[node].aabb()) / root;
        // The root's dummy sibling costs nothing.
        let nodes = (0..bvh.nodes.len()).filter(|&i| i != 1);
        let cost = nodes.map(|i| match bvh.nodes[i].count {
            0 => self.traversal * area(i),
            count => self.leaf(count) * area(i),
        });
        (root > 0.0).then(|| cost.sum())
    }

    /// Expected cost of a ray through a kd-tree; `None` if the root has no area.
    pub fn kdtree(&self, tree: &KdTree) -> Option<f64> {
        let root = half_area(&tree.bounds);
        if root.is_nan() || root <= 0.0 {
            return None;
        }
        let mut cost = 0.0;
        tree.for_each_cell(|node, cell, _| {
            let own = if node.is_leaf() { self.leaf(node.count()) } else { self.traversal };
            cost += own * half_area(cell) / root;
        });
        Some(cost)
    }
}
