//! Uniform grid.

use super::octants::{Octant, octants};
use super::{KIND, check};
use crate::math::Aabb;
use crate::scene::Scene;
use crate::workloads::trace::common::check::{Expected, Verdict};
use crate::workloads::trace::common::memory;
use crate::workloads::trace::structure::finite;
use crate::workloads::trace::{Properties, Structure, StructureKind, TriangleRef};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use std::any::Any;
use std::borrow::Cow;

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
    /// which builder and traversals place cell borders (`kernels/trace/grid/walk.wgsl`), so that both agree to the bit.
    #[inline]
    pub fn plane(&self, axis: usize, index: u32) -> f32 {
        plane(self.bounds.min, self.cell_size, axis, index)
    }
}

/// `Grid` of `kernels/trace/grid/walk.wgsl`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)]
pub struct GridUniform {
    pub bounds_min: Vec3,
    pub cell_size: f32,
    pub bounds_max: Vec3,
    pub pad0: u32,
    pub resolution: [u32; 3],
    pub pad1: u32,
    pub octants: [Octant; 8],
}

impl Structure for Grid {
    fn kind(&self) -> &'static StructureKind {
        &KIND
    }

    fn as_any(&self) -> &dyn Any {
        self
    }

    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn triangle_refs(&self) -> &[TriangleRef] {
        &self.triangle_refs
    }

    fn node_bytes(&self) -> usize {
        size_of_val(self.cells.as_slice())
    }

    fn nodes(&self) -> Cow<'_, [u8]> {
        Cow::Borrowed(bytemuck::cast_slice(&self.cells))
    }

    fn uniform(&self) -> Vec<u8> {
        let Aabb { min: bounds_min, max: bounds_max } = finite(self.bounds);
        let (resolution, cell_size, octants) = (self.resolution, self.cell_size, octants(self.resolution));
        let uniform = GridUniform { bounds_min, cell_size, bounds_max, pad0: 0, resolution, pad1: 0, octants };
        bytemuck::bytes_of(&uniform).to_vec()
    }

    fn properties(&self, scene: &Scene) -> Properties {
        let [x, y, z] = self.resolution.map(Some);
        Properties {
            cells_x: x,
            cells_y: y,
            cells_z: z,
            max_cell_triangles: self.cells.iter().map(|c| c.count).max(),
            ..Properties::of_references(&self.triangle_refs, scene)
        }
    }

    fn thesis_bytes(&self, scene: &Scene) -> u64 {
        let (cells, vertices) = (self.cells.len() as u64, scene.vertices.len() as u64);
        memory::grid_bytes(cells, self.triangle_refs.len() as u64, vertices)
    }

    fn check(&self, expected: &Expected) -> Verdict {
        check::check(self, expected)
    }
}

/// See [`Grid::plane`].
#[inline]
pub fn plane(min: Vec3, cell_size: f32, axis: usize, index: u32) -> f32 {
    min[axis] + index as f32 * cell_size
}
