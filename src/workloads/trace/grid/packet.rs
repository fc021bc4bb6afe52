//! Grid walked by packets, slice by slice (Wald et al. 2006). Twin of `kernels/trace/grid/packet.wgsl`.
//!
//! The packet's major axis is the one along which most of its rays run fastest. In every slice of cells across it, each
//! ray has a rectangle of cells that it may touch; all rays test the triangles of all cells in the rectangle around
//! these, again if they meet them in several cells (no mailboxing).

use crate::math::{Ray, ray_box};
use crate::workloads::trace::algorithm::{Algorithm, Traversal};
use crate::workloads::trace::count::Count;
use crate::workloads::trace::grid::Cell;
use crate::workloads::trace::grid::dda::Grid;
use crate::workloads::trace::grid::{BUILDER, KIND};
use crate::workloads::trace::options::PACKET;
use crate::workloads::trace::simt::{
    Event::{Step, Test, Turn},
    Lockstep, Mark,
    Part::{All, One},
    Read, repeat,
};
use crate::workloads::trace::traverse::{Best, GROUP, Lanes, Traverse, bits, set_of};
use glam::{IVec3, Vec3A};

/// The grid with packets.
pub static GRID_PACKET: Algorithm = Algorithm {
    name: "grid-packet",
    alias: "",
    summary: "the same grid; packets march through it slice by slice along their major axis",
    paper: "Wald et al. 2006",
    builder: &BUILDER,
    traversal: |_| &SLICES,
    options: &[PACKET],
};

/// From slice to slice.
pub static SLICES: Traversal = Traversal {
    kernel: "trace/grid/packet.wgsl",
    structure: &KIND,
    twin: Some(|input| Ok(input.with(GridPacket { grid: Grid::of(&input)? }))),
    lockstep: Some(|_| LOCKSTEP),
    ..Traversal::COOPERATIVE
};

/// How its lanes wait for each other.
const LOCKSTEP: Lockstep = Lockstep::together(&[repeat(&[All(Turn), repeat(&[One(Step), repeat(&[One(Test)])])])])
    .reading(&[Read::one::<Cell>(Step)]);

/// See the module.
pub struct GridPacket<'a> {
    /// The plain traversal, of which this takes the cells.
    pub grid: Grid<'a>,
}

/// Cells from .. to, both included; empty if to < from.
type Range = (i32, i32);

/// Where the packet goes.
struct March {
    /// Major axis, and the two across.
    axes: [usize; 3],
    /// True if it runs towards larger coordinates.
    forward: bool,
    /// Slices.
    slices: Range,
}

/// The distances between which a ray is in the grid and before its limit.
struct Interval {
    near: f32,
    far: f32,
}

/// The major axis of a ray, on which it moves fastest, the first of equals; plus 3 if it runs towards
/// smaller coordinates.
fn major_axis(ray: &Ray) -> usize {
    let d = ray.direction.abs();
    let axis = if d.x >= d.y && d.x >= d.z {
        0
    } else if d.y >= d.z {
        1
    } else {
        2
    };
    axis + 3 * usize::from(ray.inv_direction[axis] < 0.0)
}

fn union(a: Range, b: Range) -> Range {
    (a.0.min(b.0), a.1.max(b.1))
}

const NO_CELLS: Range = (i32::MAX, -1);

impl GridPacket<'_> {
    /// Distance of the plane below cell `index`.
    #[inline]
    fn border(&self, ray: &Ray, axis: usize, index: i32, origin: Vec3A) -> f32 {
        (self.grid.min[axis] + index as f32 * self.grid.grid.cell_size - origin[axis]) * ray.inv_direction[axis]
    }

    /// Distances at which the ray is in the slab of cell `index`. A ray in the plane between two slabs is in both.
    #[inline]
    fn slab(&self, ray: &Ray, axis: usize, index: i32) -> (f32, f32) {
        let a = self.border(ray, axis, index, ray.origin_min);
        let b = self.border(ray, axis, index + 1, ray.origin_max);
        (a.min(b), a.max(b))
    }

    /// Distance at which the ray leaves the slab of a slice; it is behind a ray in the upper plane, which is in the
    /// next slice as well.
    #[inline]
    fn leave_slice(&self, ray: &Ray, major: usize, index: i32) -> f32 {
        self.border(ray, major, index, ray.origin).max(self.border(ray, major, index + 1, ray.origin_min))
    }

    /// All cells of an axis whose slab the ray is in at any distance from `lo` to `hi`.
    ///
    /// By the same distances as everywhere, so that no cell is missed in which a triangle is hit. The position is only
    /// where the search begins.
    fn cells_between(&self, ray: &Ray, axis: usize, lo: f32, hi: f32) -> Range {
        let last = self.grid.resolution[axis] - 1;
        let guess = |t: f32| {
            let place = (ray.origin[axis] + ray.direction[axis] * t - self.grid.min[axis]) / self.grid.grid.cell_size;
            place.floor().max(0.0).min(last as f32) as i32
        };
        let downwards = ray.inv_direction[axis] < 0.0;
        // Upwards, cells are left behind first and entered last at the high end; downwards the other way round
        let meets = |index: i32, low_end: bool| {
            let (enter, leave) = self.slab(ray, axis, index);
            if low_end != downwards { leave >= lo } else { enter <= hi }
        };
        let (mut from, mut to) = if downwards { (guess(hi), guess(lo)) } else { (guess(lo), guess(hi)) };
        while from < last && !meets(from, true) {
            from += 1;
        }
        while from > 0 && meets(from - 1, true) {
            from -= 1;
        }
        while to > 0 && !meets(to, false) {
            to -= 1;
        }
        while to < last && meets(to + 1, false) {
            to += 1;
        }
        (from, to)
    }

    /// Chooses the packet's major axis and slices by all rays that take part.
    fn plan(&self, rays: &Lanes<Ray>, intervals: &Lanes<Interval>, searching: u64) -> March {
        let mut axis_votes = [0; 6];
        bits(searching).for_each(|lane| axis_votes[major_axis(&rays[lane])] += 1);
        let best = (0..6).fold(0, |best, i| if axis_votes[i] > axis_votes[best] { i } else { best });
        let major = best % 3;
        let axes = [major, (major + 1) % 3, (major + 2) % 3];
        let own = |lane: usize| self.cells_between(&rays[lane], major, intervals[lane].near, intervals[lane].far);
        let slices = bits(searching).map(own).fold(NO_CELLS, union);
        March { axes, forward: best < 3, slices }
    }
}

impl Traverse for GridPacket<'_> {
    /// With `ANY`, all tests of the first slice that has a hit are done.
    fn traverse<const ANY: bool, C: Count>(
        &self,
        rays: &Lanes<Ray>,
        limit: f32,
        alive: u64,
        counters: &mut Lanes<C>,
    ) -> Lanes<u32> {
        let mut best = [Best::before(limit); GROUP];
        let intervals: Lanes<Interval> = std::array::from_fn(|lane| {
            let (near, far) = ray_box(&rays[lane], self.grid.min, self.grid.max);
            Interval { near: near.max(0.0), far: far.min(limit) }
        });
        let mut searching = set_of(bits(alive).filter(|&lane| intervals[lane].near <= intervals[lane].far));
        if searching == 0 {
            return best.map(|best| best.triangle_ref);
        }
        let March { axes: [major, u, v], forward, slices: (first, last) } = self.plan(rays, &intervals, searching);
        for step in 0..=last - first {
            let slice = if forward { first + step } else { last - step };
            bits(searching).for_each(|lane| counters[lane].mark(Mark::Turn));
            // Which cells of the slice the rays touch
            let (mut across, mut along) = (NO_CELLS, NO_CELLS);
            let mut touching = 0u64;
            for lane in bits(searching) {
                let ray = &rays[lane];
                let (enter, leave) = self.slab(ray, major, slice);
                let (lo, hi) = (enter.max(intervals[lane].near), leave.min(intervals[lane].far));
                if lo <= hi {
                    touching |= 1 << lane;
                    across = union(across, self.cells_between(ray, u, lo, hi));
                    along = union(along, self.cells_between(ray, v, lo, hi));
                }
            }
            // All of them test everything in all of these
            for j in along.0..=along.1 {
                for i in across.0..=across.1 {
                    let mut place = IVec3::ZERO;
                    (place[major], place[u], place[v]) = (slice, i, j);
                    let (index, cell) = self.grid.cell(place);
                    for lane in bits(touching) {
                        let (counted, best) = (&mut counters[lane], &mut best[lane]);
                        counted.inner();
                        counted.read(index);
                        self.grid.triangles.test::<false, C>(&rays[lane], cell.first, cell.count, best, counted);
                    }
                }
            }
            // A ray that runs with the packet is done with a hit before the slice's end; another may find a nearer one
            // later
            for lane in bits(searching) {
                let ray = &rays[lane];
                let leave = self.leave_slice(ray, major, slice);
                let with_packet = (ray.inv_direction[major] >= 0.0) == forward;
                let behind = with_packet && leave > intervals[lane].far;
                let found = if ANY { best[lane].t < limit } else { with_packet && best[lane].t < leave };
                if behind || found {
                    searching &= !(1 << lane);
                }
            }
            if searching == 0 {
                break;
            }
        }
        best.map(|best| best.triangle_ref)
    }
}
