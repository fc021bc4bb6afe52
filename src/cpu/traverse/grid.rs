//! Uniform grid: 3D-DDA after Fujimoto et al. 1986 and Amanatides and Woo 1987. Twin of `kernels/traverse/grid.wgsl`,
//! which says why borders are computed and not summed up.

use super::{Best, TraverseAlone, Triangles};
use crate::accel::grid;
use crate::accel::octants::{Octant, octants};
use crate::cpu::count::Count;
use crate::math::{MISS, Ray, T_MAX, ray_box};
use glam::{IVec3, Vec3A};

/// See the module.
pub struct Grid<'a> {
    /// Records and vertices.
    pub triangles: Triangles<'a>,
    pub(super) grid: &'a grid::Grid,
    pub(super) min: Vec3A,
    pub(super) max: Vec3A,
    pub(super) resolution: IVec3,
    octants: [Octant; 8],
}

pub(super) struct Walk {
    pub cell: IVec3,
    step: IVec3,
    end: IVec3,
    ahead: IVec3,
    pub t_next: Vec3A,
}

impl<'a> Grid<'a> {
    /// A traversal of a built grid.
    pub fn new(triangles: Triangles<'a>, grid: &'a grid::Grid) -> Self {
        Grid {
            triangles,
            grid,
            min: grid.bounds.min.into(),
            max: grid.bounds.max.into(),
            resolution: IVec3::from_array(grid.resolution.map(|n| n as i32)),
            octants: octants(grid.resolution),
        }
    }

    #[inline]
    fn border_distance(&self, ray: &Ray, index: IVec3) -> Vec3A {
        let plane = self.min + index.as_vec3a() * self.grid.cell_size;
        (plane - ray.origin) * ray.inv_direction
    }

    #[inline]
    pub(super) fn start_walk(&self, ray: &Ray, limit: f32) -> Option<Walk> {
        let (near, far) = ray_box(ray, self.min, self.max);
        let t_start = near.max(0.0);
        if !(near <= far && far >= 0.0 && t_start <= limit) {
            return None;
        }
        let negative = ray.inv_direction.cmplt(Vec3A::ZERO);
        let octant = &self.octants[(negative.bitmask() & 7) as usize];
        let step = IVec3::new(octant.step[0], octant.step[1], octant.step[2]);
        let end = IVec3::new(octant.end[0], octant.end[1], octant.end[2]);
        let ahead = step.cmpgt(IVec3::ZERO);
        let ahead = IVec3::select(ahead, IVec3::ONE, IVec3::ZERO);

        // Find the first cell; rounding may put it one too far along the ray, which would skip the one before
        let last = self.resolution.as_vec3a() - 1.0;
        let place = ((ray.origin + ray.direction * t_start - self.min) / self.grid.cell_size).floor();
        let cell = place.max(Vec3A::ZERO).min(last).as_ivec3();
        let behind = self.border_distance(ray, cell + IVec3::ONE - ahead);
        let back = cell - step;
        let mut cell = cell;
        for axis in 0..3 {
            if behind[axis] > t_start && back[axis] >= 0 && back[axis] < self.resolution[axis] {
                cell[axis] = back[axis];
            }
        }
        Some(Walk { cell, step, end, ahead, t_next: self.border_distance(ray, cell + ahead) })
    }

    #[inline]
    pub(super) fn cell(&self, cell: IVec3) -> grid::Cell {
        let index = cell.x as usize
            + self.resolution.x as usize * (cell.y as usize + self.resolution.y as usize * cell.z as usize);
        self.grid.cells[index]
    }

    /// Go to the neighbour behind the nearest border; false if that leaves the grid.
    #[inline]
    pub(super) fn advance(&self, ray: &Ray, walk: &mut Walk) -> bool {
        let t = walk.t_next;
        let axis = if t.x <= t.y && t.x <= t.z {
            0
        } else if t.y <= t.z {
            1
        } else {
            2
        };
        walk.cell[axis] += walk.step[axis];
        let plane = self.min[axis] + (walk.cell[axis] + walk.ahead[axis]) as f32 * self.grid.cell_size;
        walk.t_next[axis] = (plane - ray.origin[axis]) * ray.inv_direction[axis];
        walk.cell[axis] != walk.end[axis]
    }
}

impl TraverseAlone for Grid<'_> {
    fn nearest_hit<C: Count>(&self, ray: &Ray, count: &mut C) -> u32 {
        let mut best = Best::NONE;
        let Some(mut walk) = self.start_walk(ray, T_MAX) else {
            return MISS;
        };
        loop {
            // Test everything in this cell
            count.inner();
            let cell = self.cell(walk.cell);
            self.triangles.test_records(ray, cell.first, cell.count, &mut best, count);
            // A hit ends the search only inside this cell: in front of a farther one something nearer may lie. At the
            // very border the next cell may hold a triangle at the same distance with a lower index.
            if best.t < walk.t_next.min_element() || !self.advance(ray, &mut walk) {
                return best.record;
            }
        }
    }

    fn any_hit<C: Count>(&self, ray: &Ray, limit: f32, count: &mut C) -> bool {
        let Some(mut walk) = self.start_walk(ray, limit) else {
            return false;
        };
        loop {
            count.inner();
            let cell = self.cell(walk.cell);
            if self.triangles.any_record_blocks(ray, cell.first, cell.count, limit, count) {
                return true;
            }
            if walk.t_next.min_element() > limit || !self.advance(ray, &mut walk) {
                return false;
            }
        }
    }
}
