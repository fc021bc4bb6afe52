//! Polygons as triangles between vertices.

use super::MeshBuilder;
use crate::scene::polygon::newell;
use crate::scene::text::Fault;
use glam::DVec3;
use std::cell::LazyCell;

/// Corners of a polygon that are compared with each other.
const FEW: usize = 4;

impl MeshBuilder {
    /// A polygon with corners counter-clockwise where it is seen from outside: a fan if it is convex, otherwise cut into
    /// ears. `normals` has one per corner, or none at all for a flat polygon. One with fewer than three corners is left
    /// out, with a warning.
    ///
    /// # Errors
    /// A corner is beyond single precision, or there is too much.
    pub fn polygon(&mut self, corners: &[DVec3], normals: &[DVec3]) -> Result<(), Fault> {
        self.any_polygon(corners, normals, &[], &[])
    }

    /// The same for a mesh that has indices of its own: with a position's and a normal's for each corner, a vertex that
    /// comes again within this shape is found without looking at either.
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

    /// The same with holes: each begins at one of the indices in `holes` and ends before the next; the polygon's own
    /// corners come first.
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
        if self.is_no_polygon(outer) {
            return Ok(());
        }
        // Many need none: triangles whose corners have normals
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
                self.warnings.add("normal of no length: the polygon's own taken");
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

    /// A flat polygon of a mesh of many. Those that follow each other in one plane share their corners, and no others do:
    /// in a mesh of flat faces few have any to share, and a search among all of them takes longer than all else.
    ///
    /// # Errors
    /// As [`MeshBuilder::polygon`].
    pub fn flat_polygon(&mut self, corners: &[DVec3]) -> Result<(), Fault> {
        if self.is_no_polygon(corners.len()) {
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
            // Few are compared sooner than listed, and most planes have one triangle
            vertices.push(match begins && corners.len() <= FEW {
                true => self.unlisted_vertex(corner, normal)?,
                false => self.shared_vertex(corner, normal)?,
            });
        }
        self.fill(corners, &[], vertices, || flat)
    }

    /// True for a polygon of so few corners that it is left out.
    fn is_no_polygon(&mut self, corners: usize) -> bool {
        let too_few = corners < 3;
        if too_few {
            self.warnings.add("polygon with fewer than three corners left out");
        }
        too_few
    }

    /// Triangles between the corners of a polygon, which are these vertices. `flat` is Newell's normal.
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

/// False for a vector without length, and for one that is not finite.
#[inline]
pub fn has_direction(v: DVec3) -> bool {
    let largest = v.abs().max_element();
    v.is_finite() && largest > 0.0
}
