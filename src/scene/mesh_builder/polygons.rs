//! Adds polygons to the mesh.

use super::MeshBuilder;
use crate::scene::polygon::newell;
use crate::scene::text::Fault;
use glam::DVec3;
use std::cell::LazyCell;

/// The largest polygon of which the corners are compared with each other instead of searched in the tables.
const FEW: usize = 4;

impl MeshBuilder {
    /// Adds a polygon; its corners are counter-clockwise, seen from outside. `normals` has a normal per corner, or is
    /// empty for flat shading. A polygon with fewer than three corners is ignored, with a warning; one with a corner
    /// that is not finite is dropped and counted.
    ///
    /// # Errors
    /// A corner exceeds single precision, or the geometry exceeds the limits.
    pub fn polygon(&mut self, corners: &[DVec3], normals: &[DVec3]) -> Result<(), Fault> {
        self.any_polygon(corners, normals, &[], &[])
    }

    /// Like [`MeshBuilder::polygon`], for a mesh with indices: by the indices of position and normal of each corner, a
    /// vertex of this shape is found without comparing positions and normals.
    ///
    /// # Errors
    /// As [`MeshBuilder::polygon`].
    pub fn indexed_polygon(
        &mut self,
        corners: &[DVec3],
        normals: &[DVec3],
        indices: &[Option<[u32; 2]>],
    ) -> Result<(), Fault> {
        self.any_polygon(corners, normals, indices, &[])
    }

    /// Like [`MeshBuilder::polygon`], with holes. The outer corners come first; `holes` has the index of the first
    /// corner of each hole.
    ///
    /// # Errors
    /// As [`MeshBuilder::polygon`].
    pub fn polygon_with_holes(&mut self, corners: &[DVec3], normals: &[DVec3], holes: &[u32]) -> Result<(), Fault> {
        self.any_polygon(corners, normals, &[], holes)
    }

    fn any_polygon(
        &mut self,
        corners: &[DVec3],
        normals: &[DVec3],
        indices: &[Option<[u32; 2]>],
        holes: &[u32],
    ) -> Result<(), Fault> {
        let outer = holes.first().map_or(corners.len(), |&first| first as usize);
        if self.is_too_small(outer) || !self.keep_if(corners.iter().all(|corner| corner.is_finite())) {
            return Ok(());
        }
        // It is computed lazily, because triangles with normals do not need it.
        let flat = LazyCell::new(|| newell(&corners[..outer]));
        let mut own = None;
        let mut vertices = std::mem::take(&mut self.corners);
        vertices.clear();
        for (i, &corner) in corners.iter().enumerate() {
            let indices = indices.get(i).copied().flatten();
            if let Some(known) = indices.and_then(|indices| self.shared.find_indices(indices)) {
                vertices.push(known);
                continue;
            }
            let given = normals.get(i).copied().unwrap_or(DVec3::ZERO);
            let has_length = has_direction(given);
            if !normals.is_empty() && !has_length {
                self.warnings.add("normal that is zero or not finite: replaced by the polygon's");
            }
            vertices.push(match indices {
                _ if !has_length => {
                    let normal = *own.get_or_insert_with(|| self.direction(*flat));
                    self.shared_vertex(corner, normal)?
                }
                Some(indices) => {
                    let vertex = self.shared_vertex(corner, self.direction(given))?;
                    self.shared.insert_indices(indices, vertex);
                    vertex
                }
                None => self.shared_vertex(corner, self.direction(given))?,
            });
        }
        self.fill(corners, holes, vertices, || *flat)
    }

    /// Adds a flat polygon of a mesh with flat shading. Only consecutive polygons in one plane share vertices: in such
    /// a mesh few vertices can be shared, and a search in the whole shape would take most of the time.
    ///
    /// # Errors
    /// As [`MeshBuilder::polygon`].
    pub fn flat_polygon(&mut self, corners: &[DVec3]) -> Result<(), Fault> {
        if self.is_too_small(corners.len()) || !self.keep_if(corners.iter().all(|corner| corner.is_finite())) {
            return Ok(());
        }
        let flat = newell(corners);
        let normal = self.direction(flat);
        let begins = normal != self.flat;
        if begins {
            self.new_shape();
            self.flat = normal;
        }
        let mut vertices = std::mem::take(&mut self.corners);
        vertices.clear();
        for &corner in corners {
            // Comparing a few corners is faster than a table, and most planes have one triangle.
            vertices.push(match begins && corners.len() <= FEW {
                true => self.unlisted_vertex(corner, normal)?,
                false => self.shared_vertex(corner, normal)?,
            });
        }
        self.fill(corners, &[], vertices, || flat)
    }

    /// True for a polygon with fewer than three corners; adds the warning.
    fn is_too_small(&mut self, corners: usize) -> bool {
        let too_few = corners < 3;
        if too_few {
            self.warnings.add("polygon with fewer than three corners ignored");
        }
        too_few
    }

    /// Adds the triangles of a polygon with these corners and vertices. `flat` is Newell's normal.
    fn fill(
        &mut self,
        corners: &[DVec3],
        holes: &[u32],
        vertices: Vec<u32>,
        flat: impl FnOnce() -> DVec3,
    ) -> Result<(), Fault> {
        if let [a, b, c] = vertices[..] {
            self.triangle([a, b, c])?;
        } else {
            let mut triangulator = std::mem::take(&mut self.triangulator);
            for &[a, b, c] in triangulator.triangles(corners, holes, flat()) {
                self.triangle([a, b, c].map(|i| vertices[i as usize]))?;
            }
            self.triangulator = triangulator;
        }
        self.corners = vertices;
        Ok(())
    }
}

/// True for a finite vector that is not zero.
#[inline]
pub fn has_direction(v: DVec3) -> bool {
    let largest = v.abs().max_element();
    v.is_finite() && largest > 0.0
}
