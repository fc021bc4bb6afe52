//! Grid whose work-group shares out the triangle tests of all its rays. Twin of `kernels/trace/grid/coop.wgsl`.
//!
//! Who does a test changes neither what it finds nor to which ray it counts: what the kernel shares out among 64
//! invocations is a plain loop here. A cell's tests are all done, also after one that blocks a shadow ray.

use crate::math::{Ray, T_MAX};
use crate::workloads::trace::count::Count;
use crate::workloads::trace::grid::dda::Grid;
use crate::workloads::trace::traverse::{Best, TraverseIndependent};

/// See the module.
pub struct GridCoop<'a> {
    /// The plain traversal, of which this takes the walk.
    pub grid: Grid<'a>,
}

impl GridCoop<'_> {
    /// The nearest hit before `limit`; with `any`, of the first cell that has one.
    #[inline]
    fn find<C: Count>(&self, ray: &Ray, limit: f32, any: bool, count: &mut C) -> Best {
        let mut best = Best::NONE;
        let Some(mut walk) = self.grid.start_walk(ray, limit) else {
            return best;
        };
        loop {
            count.inner();
            let cell = self.grid.cell(walk.cell);
            self.grid.triangles.test_triangles(ray, cell.first, cell.count, &mut best, count);
            let t_exit = walk.t_next.min_element();
            let found = if any { best.t < limit || t_exit > limit } else { best.t < t_exit };
            if found || !self.grid.advance(ray, &mut walk, &mut best, count) {
                return best;
            }
        }
    }
}

impl TraverseIndependent for GridCoop<'_> {
    fn nearest_hit<C: Count>(&self, ray: &Ray, count: &mut C) -> u32 {
        self.find(ray, T_MAX, false, count).triangle_ref
    }

    fn any_hit<C: Count>(&self, ray: &Ray, limit: f32, count: &mut C) -> bool {
        self.find(ray, limit, true, count).t < limit
    }
}
