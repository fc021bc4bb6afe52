//! The rule about vertices that are not finite, for all text formats: one that no face uses is dropped; a face that
//! uses one is dropped and counted. Numbers that are none have many spellings, see [`crate::scene::text::odd`].
//!
//! A finite coordinate beyond [`MAX_COORDINATE`] is another case: a vertex that no face uses is dropped, a face that
//! uses one is an error.

use crate::math::Vertex;
use crate::scene::Triangle;
use crate::scene::placement::MAX_COORDINATE;
use glam::{DVec3, Vec3};

/// The largest valid position in single precision.
const LARGEST: Vec3 = Vec3::splat(MAX_COORDINATE as f32);

/// True for a position that a triangle may have.
#[inline(always)]
pub fn is_valid(position: Vec3) -> bool {
    position.abs().cmple(LARGEST).all()
}

/// Rounds a position such that a finite coordinate stays finite.
#[cold]
pub fn narrow(position: DVec3) -> Vec3 {
    Vec3::from(position.to_array().map(narrow_number))
}

/// Rounds a number such that it stays finite if it is.
#[cold]
pub fn narrow_number(number: f64) -> f32 {
    let most = f64::from(f32::MAX);
    if number.is_finite() { number.clamp(-most, most) as f32 } else { number as f32 }
}

/// The vertices and faces that are not finite.
#[derive(Debug, Default)]
pub struct NotFinite {
    /// Number of vertices; zero in formats that do not list vertices.
    vertices: usize,
    /// Number of faces, or surfaces, that were dropped.
    faces: usize,
    /// The place of the first vertex, or of the first dropped face in formats that do not list vertices.
    first: Option<String>,
}

impl NotFinite {
    /// Adds a vertex; `place` is its place for the user, such as `a.obj:7`.
    #[cold]
    pub fn add_vertex(&mut self, place: impl FnOnce() -> String) {
        self.vertices += 1;
        self.first.get_or_insert_with(place);
    }

    /// Adds a face that is dropped.
    #[cold]
    pub fn add_face(&mut self) {
        self.faces += 1;
    }

    /// Sets the place of the first dropped face, if it is not known yet.
    #[inline]
    pub fn set_place(&mut self, place: impl FnOnce() -> String) {
        if self.faces > 0 && self.first.is_none() {
            self.first = Some(place());
        }
    }

    /// The warning, if there is a reason for one.
    pub fn warning(&self) -> Option<String> {
        let first = self.first.as_deref().map_or(String::new(), |place| format!(" (first: {place})"));
        match (self.vertices, self.faces) {
            (0, 0) => None,
            (0, faces) => Some(format!("{faces} faces with vertices that are not finite are dropped{first}")),
            (vertices, 0) => Some(format!("{vertices} vertices are not finite{first}: they are unused and dropped")),
            (vertices, faces) => {
                Some(format!("{vertices} vertices are not finite{first}: {faces} faces that use them are dropped"))
            }
        }
    }
}

/// The index of a dropped triangle's vertices, see [`drop_invalid`].
pub const DROPPED: u32 = u32::MAX;

/// Removes all triangles with the vertex [`DROPPED`] and all vertices that are not valid ([`is_valid`]), which no other
/// triangle may use.
#[cold]
pub fn drop_invalid(vertices: &mut Vec<Vertex>, triangles: &mut Vec<Triangle>) {
    triangles.retain(|triangle| triangle.vertices[0] != DROPPED);
    // The new index of every vertex
    let mut next = 0;
    let indices: Vec<u32> = vertices
        .iter()
        .map(|vertex| {
            let index = next;
            next += u32::from(is_valid(vertex.position));
            index
        })
        .collect();
    vertices.retain(|vertex| is_valid(vertex.position));
    for triangle in triangles {
        triangle.vertices = triangle.vertices.map(|vertex| indices[vertex as usize]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertices_that_are_not_valid_are_removed_with_their_triangles() {
        let mut vertices: Vec<Vertex> = [0.0, f32::NAN, 2.0, f32::INFINITY, 1e19, 5.0]
            .map(|x| Vertex::new(Vec3::new(x, 1.0, 1.0), Vec3::ZERO))
            .into();
        let triangle = |vertices| Triangle { vertices, material: 3 };
        let mut triangles = vec![triangle([0, 2, 5]), triangle([DROPPED; 3]), triangle([5, 2, 0])];
        drop_invalid(&mut vertices, &mut triangles);
        assert_eq!(vertices.iter().map(|v| v.position.x).collect::<Vec<_>>(), [0.0, 2.0, 5.0]);
        assert_eq!(triangles, [triangle([0, 1, 2]), triangle([2, 1, 0])]);
    }

    #[test]
    fn the_warning_has_counts_and_the_first_place() {
        let mut found = NotFinite::default();
        assert_eq!(found.warning(), None);
        found.add_face();
        found.set_place(|| "a.mgf:3".into());
        found.set_place(|| "a.mgf:9".into());
        assert_eq!(
            found.warning().as_deref(),
            Some("1 faces with vertices that are not finite are dropped (first: a.mgf:3)")
        );
        let mut found = NotFinite::default();
        found.add_vertex(|| "line 7".into());
        found.add_vertex(|| "line 8".into());
        let text = found.warning().unwrap();
        assert_eq!(text, "2 vertices are not finite (first: line 7): they are unused and dropped");
        found.add_face();
        let text = found.warning().unwrap();
        assert_eq!(text, "2 vertices are not finite (first: line 7): 1 faces that use them are dropped");
        assert_eq!(narrow_number(1e39), f32::MAX);
        assert!(narrow_number(f64::NAN).is_nan() && narrow_number(-f64::INFINITY) == f32::NEG_INFINITY);
    }
}
