//! Every triangle: ground truth. Twin of `kernels/trace/brute/scan.wgsl`.

use crate::math::Ray;
use crate::workloads::trace::count::Count;
use crate::workloads::trace::traverse::{Best, TraverseIndependent, Triangles};

/// See the module.
pub struct Brute<'a> {
    /// All of them.
    pub triangles: Triangles<'a>,
}

impl TraverseIndependent for Brute<'_> {
    fn nearest_hit<C: Count>(&self, ray: &Ray, count: &mut C) -> u32 {
        let mut best = Best::NONE;
        self.triangles.test_triangles(ray, 0, self.triangles.triangle_refs.len() as u32, &mut best, count);
        best.triangle_ref
    }

    fn any_hit<C: Count>(&self, ray: &Ray, limit: f32, count: &mut C) -> bool {
        self.triangles.any_triangle_occludes(ray, 0, self.triangles.triangle_refs.len() as u32, limit, count)
    }
}
