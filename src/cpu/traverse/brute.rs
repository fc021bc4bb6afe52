//! Every triangle: ground truth. Twin of `kernels/traverse/brute.wgsl`.

use super::{Best, TraverseAlone, Triangles};
use crate::cpu::count::Count;
use crate::math::Ray;

/// See the module.
pub struct Brute<'a> {
    /// All of them.
    pub triangles: Triangles<'a>,
}

impl TraverseAlone for Brute<'_> {
    fn nearest_hit<C: Count>(&self, ray: &Ray, count: &mut C) -> u32 {
        let mut best = Best::NONE;
        self.triangles.test_records(ray, 0, self.triangles.records.len() as u32, &mut best, count);
        best.record
    }

    fn any_hit<C: Count>(&self, ray: &Ray, limit: f32, count: &mut C) -> bool {
        self.triangles.any_record_blocks(ray, 0, self.triangles.records.len() as u32, limit, count)
    }
}
