//! Grid whose work-group shares out the triangle tests of all its rays. Twin of `kernels/trace/grid/coop.wgsl`.
//!
//! Who does a test changes neither what it finds nor to which ray it counts: what the kernel shares out among 64
//! invocations is a plain loop here. All tests of a cell are done, also after one that occludes a shadow ray.

use crate::math::{MISS, Ray};
use crate::workloads::trace::algorithm::{Algorithm, Traversal};
use crate::workloads::trace::count::Count;
use crate::workloads::trace::grid::Cell;
use crate::workloads::trace::grid::dda::Grid;
use crate::workloads::trace::grid::{BUILDER, KIND};
use crate::workloads::trace::options::PACKET;
use crate::workloads::trace::simt::{
    Event::{Step, Test},
    Lockstep,
    Part::{One, Shared},
    Read, repeat,
};
use crate::workloads::trace::traverse::{Best, TraverseIndependent};

/// The grid with shared triangle tests.
pub static GRID_COOP: Algorithm = Algorithm {
    name: "grid-coop",
    alias: "",
    summary: "the same grid; the 64 threads of a group share out all triangle tests of the group",
    paper: "",
    builder: &BUILDER,
    traversal: |_| &COOP,
    options: &[PACKET],
};

/// From cell to cell, with shared triangle tests.
pub static COOP: Traversal = Traversal {
    kernel: "trace/grid/coop.wgsl",
    structure: &KIND,
    twin: Some(|input| Ok(input.with(GridCoop { grid: Grid::of(&input)? }))),
    lockstep: Some(|_| LOCKSTEP),
    ..Traversal::COOPERATIVE
};

/// How its lanes wait for each other.
const LOCKSTEP: Lockstep =
    Lockstep::together(&[repeat(&[repeat(&[One(Step)]), Shared(Test)])]).reading(&[Read::one::<Cell>(Step)]);

/// See the module.
pub struct GridCoop<'a> {
    /// The plain traversal, of which this takes the walk.
    pub grid: Grid<'a>,
}

impl TraverseIndependent for GridCoop<'_> {
    fn traverse<const ANY: bool, C: Count>(&self, ray: &Ray, limit: f32, count: &mut C) -> u32 {
        let mut best = Best::before(limit);
        let Some(mut walk) = self.grid.start_walk(ray, limit) else {
            return MISS;
        };
        loop {
            count.inner();
            let (index, cell) = self.grid.cell(walk.cell);
            count.read(index);
            self.grid.triangles.test::<false, C>(ray, cell.first, cell.count, &mut best, count);
            let found = best.t < walk.t_next.min_element() || (ANY && best.t < limit);
            if found || !self.grid.advance(ray, &mut walk, &mut best, count) {
                return best.triangle_ref;
            }
        }
    }
}
