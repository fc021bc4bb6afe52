//! A branchless pass over a mesh that detects whether any index or coordinate is invalid. Almost all files are valid,
//! so the invalid element is searched only after this pass has found that there is one.

use super::{Scene, Triangle};
use crate::math::{Aabb, Vertex};
use glam::{UVec4, Vec4};

/// The largest indices and the bounds of a mesh.
#[derive(Clone, Copy)]
pub(super) struct Extent {
    /// Largest index of each of the three corners, and of the material.
    indices: UVec4,
    /// Zero, unless a coordinate is infinite or NaN.
    zero: Vec4,
    min: Vec4,
    max: Vec4,
}

impl Extent {
    /// The extent of an empty mesh; it is neutral for [`Extent::union`].
    pub const EMPTY: Extent =
        Extent { indices: UVec4::ZERO, zero: Vec4::ZERO, min: Vec4::INFINITY, max: Vec4::NEG_INFINITY };

    /// The extent of a whole scene.
    pub fn of(scene: &Scene) -> Extent {
        let (a, b) = rayon::join(|| Extent::of_triangles(&scene.triangles), || Extent::of_vertices(&scene.vertices));
        a.union(b)
    }

    /// The largest indices; the bounds are empty.
    pub fn of_triangles(triangles: &[Triangle]) -> Extent {
        let rows: &[UVec4] = bytemuck::cast_slice(triangles);
        Extent { indices: rows.iter().fold(UVec4::ZERO, |most, &row| most.max(row)), ..Extent::EMPTY }
    }

    /// The bounds; the indices are zero.
    pub fn of_vertices(vertices: &[Vertex]) -> Extent {
        let rows: &[[Vec4; 2]] = bytemuck::cast_slice(vertices);
        rows.iter().fold(Extent::EMPTY, |so_far, &[position, normal]| Extent {
            zero: so_far.zero + position * 0.0 + normal * 0.0,
            min: so_far.min.min(position),
            max: so_far.max.max(position),
            ..so_far
        })
    }

    pub fn union(self, other: Extent) -> Extent {
        Extent {
            indices: self.indices.max(other.indices),
            zero: self.zero + other.zero,
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// The largest index of a vertex.
    pub fn vertex(&self) -> u32 {
        self.indices.truncate().max_element()
    }

    /// The largest index of a material.
    pub fn material(&self) -> u32 {
        self.indices.w
    }

    /// True if all positions and normals are finite.
    pub fn is_finite(&self) -> bool {
        self.zero.truncate() == glam::Vec3::ZERO
    }

    /// The box around all vertices, used or not.
    pub fn bounds(&self) -> Aabb {
        Aabb { min: self.min.truncate(), max: self.max.truncate() }
    }
}
