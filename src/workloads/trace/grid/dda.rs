//! Uniform grid: 3D-DDA after Fujimoto et al. 1986 and Amanatides and Woo 1987. Twin of `kernels/trace/grid/dda.wgsl`,
//! which says why borders are computed and not summed up.

use crate::error::Result;
use crate::math::{MISS, Ray, T_MAX, ray_box};
use crate::workloads::trace::algorithm::{Algorithm, Traversal};
use crate::workloads::trace::count::Count;
use crate::workloads::trace::cpu::TwinInput;
use crate::workloads::trace::grid::octants::{Octant, octants};
use crate::workloads::trace::grid::{self, BUILDER, KIND};
use crate::workloads::trace::options::GROUP;
use crate::workloads::trace::simt::{
    Event::{Step, Test},
    Lockstep,
    Part::One,
    Read, repeat,
};
use crate::workloads::trace::traverse::{Best, TraverseIndependent, Triangles};
use glam::{IVec3, Vec3A};

/// The grid of the thesis.
pub static GRID: Algorithm = Algorithm {
    name: "grid",
    alias: "",
    summary: "uniform grid, walked by a 3D-DDA",
    paper: "Fujimoto et al. 1986; Amanatides and Woo 1987",
    builder: &BUILDER,
    traversal: |_| &DDA,
    options: &[GROUP],
};

/// From cell to cell.
pub static DDA: Traversal = Traversal {
    kernel: "trace/grid/dda.wgsl",
    structure: &KIND,
    twin: Some(|input| Ok(input.with(Grid::of(&input)?))),
    lockstep: Some(|_| LOCKSTEP),
    ..Traversal::INDEPENDENT
};

/// How its lanes wait for each other.
const LOCKSTEP: Lockstep =
    Lockstep::apart(&[repeat(&[One(Step), repeat(&[One(Test)])])]).reading(&[Read::one::<grid::Cell>(Step)]);

/// See the module.
pub struct Grid<'a> {
    /// Triangle references and vertices.
    pub triangles: Triangles<'a>,
    pub(crate) grid: &'a grid::Grid,
    pub(crate) min: Vec3A,
    pub(crate) max: Vec3A,
    pub(crate) resolution: IVec3,
    octants: [Octant; 8],
}

pub(crate) struct Walk {
    pub cell: IVec3,
    step: IVec3,
    end: IVec3,
    ahead: IVec3,
    pub t_next: Vec3A,
}

impl<'a> Grid<'a> {
    /// A traversal of a built grid.
    pub(crate) fn of(input: &TwinInput<'a>) -> Result<Self> {
        let grid: &grid::Grid = input.structure()?;
        Ok(Grid {
            triangles: input.triangles(),
            grid,
            min: grid.bounds.min.into(),
            max: grid.bounds.max.into(),
            resolution: IVec3::from_array(grid.resolution.map(|n| n as i32)),
            octants: octants(grid.resolution),
        })
    }

    /// Distance of the plane below cell `index` of an axis.
    #[inline]
    fn border_distance(&self, ray: &Ray, axis: usize, index: i32) -> f32 {
        let plane = self.min[axis] + index as f32 * self.grid.cell_size;
        (plane - ray.origin[axis]) * ray.inv_direction[axis]
    }

    #[inline]
    pub(crate) fn start_walk(&self, ray: &Ray, limit: f32) -> Option<Walk> {
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

        // Guess the first cell by the ray's position, and find it by the distances of borders: the first one that the
        // ray touches at `t_start`. Where the direction is zero, the ray stays in the cell whose lower plane is the
        // last at or below it, which holds the triangles on both sides of that plane.
        let guess = ((ray.origin + ray.direction * t_start - self.min) / self.grid.cell_size).floor();
        let mut cell = guess.max(Vec3A::ZERO).min(self.resolution.as_vec3a() - 1.0).as_ivec3();
        let mut t_next = Vec3A::ZERO;
        for axis in 0..3 {
            let parallel = ray.slack[axis] > 0.0;
            let border = |index: i32| self.border_distance(ray, axis, index);
            let (step, ahead, last) = (step[axis], ahead[axis], end[axis] - step[axis]);
            let first = self.resolution[axis] - 1 - last;
            let c = &mut cell[axis];
            let is_behind = |c: i32| {
                let t = border(c + ahead);
                if parallel { t <= 0.0 } else { t < t_start }
            };
            let is_beyond = |c: i32| {
                let t = border(c + 1 - ahead);
                if parallel { t > 0.0 } else { t >= t_start }
            };
            while *c != last && is_behind(*c) {
                *c += step;
            }
            while *c != first && is_beyond(*c) {
                *c -= step;
            }
            t_next[axis] = if parallel { T_MAX } else { border(*c + ahead) };
        }
        Some(Walk { cell, step, end, ahead, t_next })
    }

    /// The index of a cell, and its content.
    #[inline]
    pub(crate) fn cell(&self, cell: IVec3) -> (u32, grid::Cell) {
        let index = cell.x as usize
            + self.resolution.x as usize * (cell.y as usize + self.resolution.y as usize * cell.z as usize);
        (index as u32, self.grid.cells[index])
    }

    /// Go to the neighbour behind the nearest border; false if that leaves the grid. Where several borders are at that
    /// distance, the ray touches all cells between them: those before the last one are tested here.
    #[inline]
    pub(crate) fn advance<C: Count>(&self, ray: &Ray, walk: &mut Walk, best: &mut Best, count: &mut C) -> bool {
        let t = walk.t_next;
        let axis = if t.x <= t.y && t.x <= t.z {
            0
        } else if t.y <= t.z {
            1
        } else {
            2
        };
        let t_border = t[axis];
        let next = walk.cell[axis] + walk.step[axis];
        walk.t_next[axis] = self.border_distance(ray, axis, next + walk.ahead[axis]);
        if walk.t_next.min_element() <= t_border {
            walk.t_next = t;
            return self.cross_borders(ray, walk, t_border, best, count);
        }
        walk.cell[axis] = next;
        next != walk.end[axis]
    }

    /// Crosses all borders at distance `t`. From far away, that may be those of many cells.
    #[cold]
    fn cross_borders<C: Count>(&self, ray: &Ray, walk: &mut Walk, t: f32, best: &mut Best, count: &mut C) -> bool {
        let mut last = walk.cell;
        let mut leaves = false;
        for axis in 0..3 {
            while walk.t_next[axis] <= t && last[axis] + walk.step[axis] != walk.end[axis] {
                last[axis] += walk.step[axis];
                walk.t_next[axis] = self.border_distance(ray, axis, last[axis] + walk.ahead[axis]);
            }
            leaves |= walk.t_next[axis] <= t;
        }
        let (low, high) = (walk.cell.min(last), walk.cell.max(last));
        for z in low.z..=high.z {
            for y in low.y..=high.y {
                for x in low.x..=high.x {
                    let place = IVec3::new(x, y, z);
                    if place != walk.cell && (place != last || leaves) {
                        count.inner();
                        let (index, cell) = self.cell(place);
                        count.read(index);
                        self.triangles.test::<false, C>(ray, cell.first, cell.count, best, count);
                    }
                }
            }
        }
        walk.cell = last;
        !leaves
    }
}

impl TraverseIndependent for Grid<'_> {
    fn traverse<const ANY: bool, C: Count>(&self, ray: &Ray, limit: f32, count: &mut C) -> u32 {
        let mut best = Best::before(limit);
        let Some(mut walk) = self.start_walk(ray, limit) else {
            return MISS;
        };
        loop {
            count.inner();
            let (index, cell) = self.cell(walk.cell);
            count.read(index);
            if self.triangles.test::<ANY, C>(ray, cell.first, cell.count, &mut best, count) {
                return best.triangle_ref;
            }
            // A hit ends the search only inside this cell: in front of a farther one something nearer may lie. At the
            // very border the next cell may hold a triangle at the same distance with a lower index.
            if best.t < walk.t_next.min_element() || !self.advance(ray, &mut walk, &mut best, count) {
                return best.triangle_ref;
            }
            if ANY && best.triangle_ref != MISS {
                return best.triangle_ref;
            }
        }
    }
}
