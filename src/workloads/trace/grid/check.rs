//! Invariants of a grid.

use crate::workloads::trace::common::check::{Expected, Verdict, ensure};
use crate::workloads::trace::grid::Grid;

pub(crate) fn check(grid: &Grid, expected: &Expected) -> Verdict {
    let [rx, ry, rz] = grid.resolution;
    ensure!(rx > 0 && ry > 0 && rz > 0, "resolution {:?}", grid.resolution);
    let cells = u64::from(rx) * u64::from(ry) * u64::from(rz);
    ensure!(cells == grid.cells.len() as u64, "{} cells instead of {cells}", grid.cells.len());
    ensure!(grid.cell_size > 0.0 && grid.cell_size.is_finite(), "cells of size {}", grid.cell_size);

    let mut next = 0_u64;
    for (i, cell) in grid.cells.iter().enumerate() {
        ensure!(u64::from(cell.first) == next, "cell {i} begins at triangle reference {}, not at {next}", cell.first);
        next += u64::from(cell.count);
        ensure!(next <= grid.triangle_refs.len() as u64, "cell {i} reaches behind the last triangle reference");
        let triangle_refs = &grid.triangle_refs[cell.first as usize..next as usize];
        ensure!(
            triangle_refs.is_sorted_by(|a, b| a.triangle < b.triangle),
            "the triangles of cell {i} are not in ascending order"
        );
    }
    ensure!(
        next == grid.triangle_refs.len() as u64,
        "{} triangle references, {next} in cells",
        grid.triangle_refs.len()
    );
    if expected.hittable.is_empty() {
        return Ok(());
    }
    for axis in 0..3 {
        let last = grid.plane(axis, grid.resolution[axis]);
        ensure!(last >= grid.bounds.max[axis], "the cells end at {last} on axis {axis}, inside the bounds");
    }

    // Every triangle is in each of its cells, and nowhere else: as many triangle references as cells, so none is left
    // over.
    let mut triangle_refs = 0_u64;
    for &triangle in &expected.hittable {
        let aabb = expected.aabb(triangle);
        let [xs, ys, zs] = [0, 1, 2].map(|a| cell_of(grid, a, aabb.min[a])..=cell_of(grid, a, aabb.max[a]));
        for z in zs {
            for y in ys.clone() {
                for x in xs.clone() {
                    let cell = grid.cells[x as usize + rx as usize * (y as usize + ry as usize * z as usize)];
                    let content = &grid.triangle_refs[cell.first as usize..(cell.first + cell.count) as usize];
                    ensure!(
                        content.binary_search_by_key(&triangle, |r| r.triangle).is_ok(),
                        "triangle {triangle} is missing in cell {x}, {y}, {z}"
                    );
                    triangle_refs += 1;
                }
            }
        }
    }
    ensure!(triangle_refs == grid.triangle_refs.len() as u64, "a triangle is in a cell that its box does not overlap");
    Ok(())
}

/// The last cell whose lower plane is at or below `x`, found without any of the builder's code.
fn cell_of(grid: &Grid, axis: usize, x: f32) -> u32 {
    let (mut lo, mut hi) = (0, grid.resolution[axis]);
    while hi - lo > 1 {
        let mid = lo + (hi - lo) / 2;
        if grid.plane(axis, mid) <= x { lo = mid } else { hi = mid }
    }
    lo
}
