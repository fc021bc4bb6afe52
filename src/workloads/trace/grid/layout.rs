//! Uniform grid (SPEC section 2).

use crate::math::Aabb;
use crate::workloads::trace::TriangleRef;
use bytemuck::{Pod, Zeroable};
use glam::Vec3;

/// A cell: 8 bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Cell {
    /// First triangle reference.
    pub first: u32,
    /// Number of triangle references.
    pub count: u32,
}

/// A built grid of cubic cells, anchored at the scene's minimum corner.
#[derive(Clone, Debug)]
pub struct Grid {
    /// Box around all triangles (not the box of the cells, which may reach beyond `bounds.max`).
    pub bounds: Aabb,
    /// Number of cells per axis, at least 1 each.
    pub resolution: [u32; 3],
    /// Edge length of a cell.
    pub cell_size: f32,
    /// `x + resolution.x * (y + resolution.y * z)`.
    pub cells: Vec<Cell>,
    /// Cell by cell.
    pub triangle_refs: Vec<TriangleRef>,
}

impl Grid {
    /// The coordinate of the plane below cell `index` on `axis`, for `0 <= index <= resolution`: the one formula by
    /// which builder and traversals place cell borders (`kernels/trace/grid/dda.wgsl`), so that both agree to the bit.
    #[inline]
    pub fn plane(&self, axis: usize, index: u32) -> f32 {
        plane(self.bounds.min, self.cell_size, axis, index)
    }
}

/// See [`Grid::plane`].
#[inline]
pub fn plane(min: Vec3, cell_size: f32, axis: usize, index: u32) -> f32 {
    min[axis] + index as f32 * cell_size
}
