//! Grid builder: every triangle into every cell that its box overlaps, in two passes, O(n).

use crate::error::{Error, Result};
use crate::math::Aabb;
use crate::scene::Scene;
use crate::workloads::trace::common::prims::{self, Prim};
use crate::workloads::trace::grid::{Cell, Grid, plane};
use glam::Vec3;

/// What can be set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Config {
    /// Number of cells per axis set by hand (the thesis set robots to 128 on x, kitchen to 128 on y). The first axis
    /// that is set decides the edge length; the others follow from it unless they are set too.
    pub resolution: [Option<u32>; 3],
    /// The shortest axis gets `floor(factor * n^(1/4))` cells.
    pub factor: f64,
}

impl Default for Config {
    /// The thesis's rule.
    fn default() -> Self {
        Config { resolution: [None; 3], factor: 4.0 }
    }
}

/// Most cells of a grid whose resolution was set by hand: 1 GiB. More is an error.
pub const MAX_CELLS: u64 = 1 << 27;

/// Most triangle references of a grid whose resolution was set by hand: 4 GiB. More is an error.
pub const MAX_REFS: u64 = 1 << 28;

/// A grid that follows the rule is made coarser, edge by edge, until it has at most this many cells (per triangle, and
/// at least and at most in all) ...
fn cell_limit(triangles: usize) -> u64 {
    (512 * triangles as u64).clamp(1 << 16, 1 << 25)
}

/// ... and at most this many triangle references. The published scenes need at most 100 cells and 23 triangle
/// references per triangle; without the limits a nearly flat scene, or a thousand large triangles in the same place,
/// would take all memory.
pub(crate) fn triangle_ref_limit(triangles: usize) -> u64 {
    (256 * triangles as u64).clamp(1 << 16, 1 << 26).max(triangles as u64)
}

/// Builds a grid over all triangles that can be hit, on one thread.
pub fn build(scene: &Scene, config: &Config) -> Result<Grid> {
    let (prims, bounds) = prims::prims(scene)?;
    if prims.is_empty() {
        let cells = vec![Cell::default()];
        return Ok(Grid { bounds, resolution: [1; 3], cell_size: 1.0, cells, triangle_refs: Vec::new() });
    }
    let (layout, ranges, total) = lay_out(scene, config, &prims, &bounds)?;

    // Count, one place to the right, so that the prefix sum below leaves every cell's first triangle reference in its
    // place.
    let mut starts = vec![0_u32; layout.cell_count() as usize + 1];
    for range in &ranges {
        layout.for_cells(range, |cell| starts[cell + 1] += 1);
    }
    let mut sum = 0;
    for start in &mut starts {
        sum += *start;
        *start = sum;
    }

    // Fill in scene order: the triangles of a cell are in ascending order. Every start moves to its cell's end.
    let mut triangles = vec![0_u32; total as usize];
    for (prim, range) in prims.iter().zip(&ranges) {
        layout.for_cells(range, |cell| {
            triangles[starts[cell] as usize] = prim.triangle();
            starts[cell] += 1;
        });
    }
    let mut first = 0;
    let cells = starts[..starts.len() - 1]
        .iter()
        .map(|&end| {
            let cell = Cell { first, count: end - first };
            first = end;
            cell
        })
        .collect();
    let triangle_refs = triangles.into_iter().map(|t| prims::triangle_ref(scene, t)).collect();
    Ok(Grid { bounds, resolution: layout.resolution, cell_size: layout.cell_size, cells, triangle_refs })
}

/// The cells from `lo` to `hi`, both included, per axis.
type Range = [[u32; 2]; 3];

/// Chooses the resolution and finds every triangle's cells; returns how many triangle references that makes.
fn lay_out(scene: &Scene, config: &Config, prims: &[Prim], bounds: &Aabb) -> Result<(Layout, Vec<Range>, u64)> {
    let (mut layout, by_hand) = Layout::first(scene, config, prims.len(), bounds)?;
    loop {
        let mut total = 0_u64;
        let ranges: Vec<Range> = prims
            .iter()
            .map(|prim| {
                let range = layout.range(&prim.aabb());
                total += range.iter().map(|[lo, hi]| u64::from(hi - lo + 1)).product::<u64>();
                range
            })
            .collect();
        if by_hand && total > MAX_REFS {
            return Err(Error::too_large(
                format!("grid over {}", scene.name),
                format!("{:?} cells would take {total} triangle references, more than {MAX_REFS}", layout.resolution),
                "set fewer cells",
            ));
        }
        if by_hand || total <= triangle_ref_limit(prims.len()) {
            return Ok((layout, ranges, total));
        }
        layout = layout.coarser(bounds);
    }
}

/// Where the cells are.
pub(crate) struct Layout {
    min: Vec3,
    pub resolution: [u32; 3],
    pub cell_size: f32,
    /// For first guesses only.
    inverse: f64,
}

impl Layout {
    /// The one to begin with, and true if it was set by hand: then it is the last as well.
    pub fn first(scene: &Scene, config: &Config, triangles: usize, bounds: &Aabb) -> Result<(Layout, bool)> {
        if config.resolution.iter().any(Option::is_some) {
            return Ok((Layout::by_hand(&scene.name, bounds, config.resolution)?, true));
        }
        Ok((Layout::by_rule(bounds, triangles, config.factor), false))
    }

    /// `floor(factor n^(1/4))` cubes on the shortest axis that has any extent at all.
    fn by_rule(bounds: &Aabb, triangles: usize, factor: f64) -> Layout {
        let extent = extent(bounds);
        let cells = (factor * (triangles as f64).powf(0.25)).floor().clamp(1.0, 1e6) as u32;
        let shortest = (0..3).filter(|&a| extent[a] > 0.0).min_by(|&a, &b| extent[a].total_cmp(&extent[b]));
        let Some(shortest) = shortest else {
            return Layout::with_edge(bounds, 1.0, [Some(1); 3]);
        };
        let mut edge = extent[shortest] / f64::from(cells);
        let mut fixed = [None; 3];
        fixed[shortest] = Some(cells);
        while count(&extent, edge, fixed) > cell_limit(triangles) {
            edge *= 1.05;
            fixed = [None; 3];
        }
        Layout::with_edge(bounds, edge, fixed)
    }

    /// The next one to try where there are too many triangle references.
    pub fn coarser(&self, bounds: &Aabb) -> Layout {
        Layout::with_edge(bounds, f64::from(self.cell_size) * 1.25, [None; 3])
    }

    /// Cells set by hand: the first axis that is set (and has extent) gives the edge length.
    fn by_hand(scene: &str, bounds: &Aabb, resolution: [Option<u32>; 3]) -> Result<Layout> {
        let extent = extent(bounds);
        let edges = (0..3).filter_map(|a| resolution[a].map(|cells| extent[a] / f64::from(cells.max(1))));
        let Some(edge) = edges.into_iter().find(|&edge| edge > 0.0) else {
            return Ok(Layout::with_edge(bounds, extent.into_iter().fold(0.0, f64::max), resolution));
        };
        let cells = count(&extent, edge, resolution);
        if cells > MAX_CELLS {
            return Err(Error::too_large(
                format!("grid over {scene}"),
                format!("the resolution set by hand makes {cells} cells, more than {MAX_CELLS}"),
                "set fewer cells",
            ));
        }
        Ok(Layout::with_edge(bounds, edge, resolution))
    }

    /// Cubes of this edge length; as many per axis as are set, or as cover the bounds.
    fn with_edge(bounds: &Aabb, edge: f64, fixed: [Option<u32>; 3]) -> Layout {
        let extent = extent(bounds);
        let smallest = f64::from(f32::MIN_POSITIVE);
        let mut cell_size = edge.clamp(smallest, f64::from(f32::MAX)) as f32;
        let resolution: [u32; 3] = std::array::from_fn(|a| axis_cells(extent[a], f64::from(cell_size), fixed[a]));
        // Rounding may leave the last plane short of the bounds: no corner may lie outside all cells.
        let mut step = cell_size * f32::EPSILON;
        while (0..3).any(|a| plane(bounds.min, cell_size, a, resolution[a]) < bounds.max[a]) {
            cell_size += step.max(smallest as f32);
            step *= 2.0;
        }
        Layout { min: bounds.min, resolution, cell_size, inverse: 1.0 / f64::from(cell_size) }
    }

    pub fn cell_count(&self) -> u64 {
        self.resolution.iter().map(|&r| u64::from(r)).product()
    }

    /// The cells that a box overlaps: on each axis from the last cell whose lower plane is at or below the box's
    /// minimum to the last cell whose lower plane is at or below its maximum.
    fn range(&self, aabb: &Aabb) -> Range {
        std::array::from_fn(|a| [self.cell_of(a, aabb.min[a]), self.cell_of(a, aabb.max[a])])
    }

    /// The last cell on `axis` whose lower plane is at or below `x` (the first cell if none is).
    ///
    /// The division is only a first guess: what counts is [`plane`], which is how the traversals place the borders.
    #[inline(always)]
    fn cell_of(&self, axis: usize, x: f32) -> u32 {
        let last = self.resolution[axis] - 1;
        let guess = ((f64::from(x) - f64::from(self.min[axis])) * self.inverse) as u32;
        let cell = guess.min(last);
        let at_or_below = |index| plane(self.min, self.cell_size, axis, index) <= x;
        if (cell == 0 || at_or_below(cell)) && (cell == last || !at_or_below(cell + 1)) {
            return cell;
        }
        self.search(last, at_or_below)
    }

    /// Planes never decrease with their index, in spite of rounding, so the cell can be searched by halving. Rounding
    /// moves a guess by one at most in ordinary scenes, but by many cells where cells are finer than floats.
    #[cold]
    fn search(&self, last: u32, at_or_below: impl Fn(u32) -> bool) -> u32 {
        let (mut lo, mut hi) = (0, last + 1);
        while hi - lo > 1 {
            let mid = lo + (hi - lo) / 2;
            if at_or_below(mid) { lo = mid } else { hi = mid }
        }
        lo
    }

    #[inline(always)]
    fn for_cells(&self, range: &Range, mut visit: impl FnMut(usize)) {
        let [[x0, x1], [y0, y1], [z0, z1]] = *range;
        let [rx, ry, _] = self.resolution.map(|r| r as usize);
        for z in z0 as usize..=z1 as usize {
            for y in y0 as usize..=y1 as usize {
                let row = rx * (y + ry * z);
                (row + x0 as usize..=row + x1 as usize).for_each(&mut visit);
            }
        }
    }
}

/// Edge lengths in f64: those of huge scenes are no finite f32.
fn extent(bounds: &Aabb) -> [f64; 3] {
    (bounds.max.as_dvec3() - bounds.min.as_dvec3()).to_array()
}

fn axis_cells(extent: f64, edge: f64, fixed: Option<u32>) -> u32 {
    fixed.unwrap_or((extent / edge).ceil().min(f64::from(u32::MAX)) as u32).max(1)
}

fn count(extent: &[f64; 3], edge: f64, fixed: [Option<u32>; 3]) -> u64 {
    (0..3).fold(1, |n: u64, a| n.saturating_mul(u64::from(axis_cells(extent[a], edge, fixed[a]))))
}
