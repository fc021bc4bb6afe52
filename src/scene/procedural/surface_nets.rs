//! Surface nets (Gibson 1998): triangles of uniform size on the zero set of a distance-like function. There is a vertex
//! per cell that the surface intersects, and a quad per edge that it crosses.
//!
//! Only blocks near the surface are evaluated, so the work is proportional to the surface, not to the volume.

use glam::{IVec3, Vec3};
use rayon::prelude::*;

/// A mesh; its triangles are counter-clockwise, seen from the side on which the function is positive.
pub struct Net {
    pub positions: Vec<Vec3>,
    pub triangles: Vec<[u32; 3]>,
}

/// Number of cells per edge of a block.
const BLOCK: i32 = 4;

/// Upper bound of the gradient's length of the function without relief.
const STEEPNESS: f32 = 1.3;
/// Upper bound of the gradient's length of the function with relief.
const STEEPNESS_WITH_RELIEF: f32 = 1.8;

/// A cell that the surface intersects.
struct Crossed {
    cell: IVec3,
    position: Vec3,
    /// Crossings of the edges from the cell's lowest corner along x, y, z: 0 for none, 1 from inside to outside, -1
    /// from outside to inside.
    edges: [i8; 3],
}

/// The key by which cells are sorted and searched.
fn key(cell: IVec3) -> (i32, i32, i32) {
    (cell.z, cell.y, cell.x)
}

/// Meshes the zero set of `function` with cells of edge length `cell`. The cube with the lowest corner `min` and edge
/// length `size` must contain the zero set. `function` is the sum of a smooth distance and a relief of at most
/// `relief`.
pub fn surface_net(min: Vec3, size: f32, cell: f32, relief: f32, function: impl Fn(Vec3) -> f32 + Sync) -> Net {
    let blocks = (size / (cell * BLOCK as f32)).ceil().max(1.0) as u32;
    let mut near = Vec::new();
    descend(IVec3::ZERO, blocks.next_power_of_two() as i32, &mut near, &|corner: IVec3, edge: i32| {
        let half = (edge * BLOCK) as f32 * cell * 0.5;
        let center = min + (corner * BLOCK).as_vec3() * cell + Vec3::splat(half);
        // Half the diagonal. The relief adds at most its height; in small blocks its gradient gives a smaller bound.
        let reach = half * 1.7321;
        function(center).abs() <= reach * STEEPNESS + (2.0 * relief).min(reach * (STEEPNESS_WITH_RELIEF - STEEPNESS))
    });
    let mut crossed: Vec<Crossed> =
        near.par_iter().flat_map_iter(|&block| block_cells(block * BLOCK, min, cell, &function)).collect();
    crossed.par_sort_unstable_by_key(|c| key(c.cell));

    let find = |cell: IVec3| crossed.binary_search_by_key(&key(cell), |c| key(c.cell)).ok().map(|i| i as u32);
    let triangles = crossed
        .par_iter()
        .enumerate()
        .flat_map_iter(|(index, c)| {
            let find = &find;
            let crossed = &crossed;
            (0..3).filter(|&axis| c.edges[axis] != 0).flat_map(move |axis| {
                let mut step = [IVec3::ZERO; 2];
                step[0][(axis + 1) % 3] = 1;
                step[1][(axis + 2) % 3] = 1;
                let around = [
                    find(c.cell - step[0] - step[1]),
                    find(c.cell - step[1]),
                    Some(index as u32),
                    find(c.cell - step[0]),
                ];
                // All four cells exist, because the surface crosses their common edge and does not touch the cube's
                // border.
                let Some([a, mut b, c2, mut d]) = all(around) else { return [[0; 3]; 2].into_iter().take(0) };
                if c.edges[axis] < 0 {
                    std::mem::swap(&mut b, &mut d);
                }
                let at = |i: u32| crossed[i as usize].position;
                // The shorter diagonal gives triangles of better shape.
                if at(a).distance_squared(at(c2)) <= at(b).distance_squared(at(d)) {
                    [[a, b, c2], [a, c2, d]].into_iter().take(2)
                } else {
                    [[a, b, d], [b, c2, d]].into_iter().take(2)
                }
            })
        })
        .collect();
    Net { positions: crossed.iter().map(|c| c.position).collect(), triangles }
}

fn all(options: [Option<u32>; 4]) -> Option<[u32; 4]> {
    let [a, b, c, d] = options;
    Some([a?, b?, c?, d?])
}

/// Collects the blocks that may contain the surface, by recursive bisection.
fn descend(corner: IVec3, edge: i32, near: &mut Vec<IVec3>, may_hold: &impl Fn(IVec3, i32) -> bool) {
    if !may_hold(corner, edge) {
        return;
    }
    if edge == 1 {
        near.push(corner);
        return;
    }
    let half = edge / 2;
    for child in 0..8 {
        let offset = IVec3::new(child & 1, child >> 1 & 1, child >> 2) * half;
        descend(corner + offset, half, near, may_hold);
    }
}

/// The cells of a block that the surface intersects.
fn block_cells(first: IVec3, min: Vec3, cell: f32, function: &impl Fn(Vec3) -> f32) -> Vec<Crossed> {
    const SIDE: usize = BLOCK as usize + 1;
    let point = |c: IVec3| min + (first + c).as_vec3() * cell;
    let slot = |c: IVec3| c.x as usize + SIDE * (c.y as usize + SIDE * c.z as usize);
    let mut values = [0.0; SIDE * SIDE * SIDE];
    // Every other point is evaluated first: for most blocks these prove that the surface does not intersect the block.
    let sparse = (0..27).map(|i| {
        let c = IVec3::new(i % 3, i / 3 % 3, i / 9) * (BLOCK / 2);
        function(point(c)).abs()
    });
    if sparse.fold(f32::INFINITY, f32::min) > cell * (BLOCK / 4) as f32 * 1.7321 * STEEPNESS_WITH_RELIEF {
        return Vec::new();
    }
    for z in 0..=BLOCK {
        for y in 0..=BLOCK {
            for x in 0..=BLOCK {
                let c = IVec3::new(x, y, z);
                values[slot(c)] = function(point(c));
            }
        }
    }
    let mut crossed = Vec::new();
    for z in 0..BLOCK {
        for y in 0..BLOCK {
            for x in 0..BLOCK {
                let c = IVec3::new(x, y, z);
                let corner = |i: i32| c + IVec3::new(i & 1, i >> 1 & 1, i >> 2);
                let value = |i: i32| values[slot(corner(i))];
                let (mut sum, mut count) = (Vec3::ZERO, 0.0);
                for (a, b) in EDGES {
                    let (va, vb) = (value(a), value(b));
                    if (va < 0.0) != (vb < 0.0) {
                        let (pa, pb) = (point(corner(a)), point(corner(b)));
                        sum += pa + (pb - pa) * (va / (va - vb));
                        count += 1.0;
                    }
                }
                if count > 0.0 {
                    let edges = [1, 2, 4].map(|far| (value(far) >= 0.0) as i8 - (value(0) >= 0.0) as i8);
                    crossed.push(Crossed { cell: first + c, position: sum / count, edges });
                }
            }
        }
    }
    crossed
}

/// The twelve edges of a cell as pairs of corners; bit 0 of a corner is x, bit 1 is y, bit 2 is z.
const EDGES: [(i32, i32); 12] =
    [(0, 1), (2, 3), (4, 5), (6, 7), (0, 2), (1, 3), (4, 6), (5, 7), (0, 4), (1, 5), (2, 6), (3, 7)];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sphere_is_closed_and_faces_outwards() {
        let net = surface_net(Vec3::splat(-1.5), 3.0, 0.11, 0.0, |p| p.length() - 1.0);
        // Euler's formula V - E + F = 2, with 3 F = 2 E
        assert_eq!(net.positions.len() as i64 - net.triangles.len() as i64 / 2, 2);
        assert!(net.triangles.len() > 1000);
        for t in &net.triangles {
            let [a, b, c] = t.map(|i| net.positions[i as usize]);
            assert!((b - a).cross(c - a).dot(a) > 0.0);
        }
        assert!(net.positions.iter().all(|p| (p.length() - 1.0).abs() < 0.02));
    }
}
