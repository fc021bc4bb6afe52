//! Smooth vertex normals, and the test for triangles without area.
//!
//! A vertex normal is the sum of the normals of the adjacent triangles, weighted by their area. The area is the length
//! of the cross product, so it costs nothing extra. Weights by angle would need an arc cosine per corner, which differs
//! in its last bits between platforms; with areas, all machines compute the same scene and the same image hash.

use super::Triangle;
use crate::math::{Aabb, Vertex};
use glam::{DVec3, Vec3};

/// Computes the normals of all vertices. A vertex without an adjacent triangle that has an area gets a zero normal.
pub fn smooth(vertices: &mut [Vertex], triangles: &[Triangle]) {
    for vertex in vertices.iter_mut() {
        vertex.normal = Vec3::ZERO;
    }
    let scale = scale(vertices);
    for triangle in triangles {
        let [a, b, c] = triangle.vertices.map(|v| v as usize);
        let origin = vertices[a].position;
        let normal = ((vertices[b].position - origin) * scale).cross((vertices[c].position - origin) * scale);
        for corner in [a, b, c] {
            vertices[corner].normal += normal;
        }
    }
    for vertex in vertices {
        vertex.normal = unit(vertex.normal);
    }
}

/// Normalises the normals that the file gives, and computes those that are zero or not finite. Returns the number of
/// computed normals.
pub fn normalise_or_smooth(vertices: &mut [Vertex], triangles: &[Triangle]) -> usize {
    let mut repair = Vec::new();
    for (i, vertex) in vertices.iter_mut().enumerate() {
        vertex.normal = if vertex.normal.is_finite() { unit(vertex.normal) } else { Vec3::ZERO };
        if vertex.normal == Vec3::ZERO {
            repair.push(i);
        }
    }
    if !repair.is_empty() {
        let mut computed = vertices.to_vec();
        smooth(&mut computed, triangles);
        for &i in &repair {
            vertices[i].normal = computed[i].normal;
        }
    }
    repair.len()
}

/// The unit vector in the direction of `v`, or zero if `v` is zero or not finite. It is also correct if the square of
/// the length leaves the range of floats.
pub fn unit(v: Vec3) -> Vec3 {
    let largest = v.abs().max_element();
    if largest > 0.0 && largest.is_finite() {
        let v = (v / largest).normalize_or_zero();
        if v.is_finite() { v } else { Vec3::ZERO }
    } else {
        Vec3::ZERO
    }
}

/// A power of two that scales the scene to an extent of about one, so that products of edges neither overflow nor
/// underflow for any unit of length. A power of two rounds nothing.
fn scale(vertices: &[Vertex]) -> f32 {
    let extent = Aabb::from_points(vertices.iter().map(|v| v.position)).extent().max_element();
    // The biased exponent e means 2^(e - 127), and 254 - e means its inverse.
    let exponent = (extent.max(0.0).to_bits() >> 23).clamp(1, 253);
    f32::from_bits((254 - exponent) << 23)
}

/// True if the triangle has no area. Products of single-precision coordinates are exact in double precision unless
/// their magnitudes differ extremely, so the comparison is with zero and needs no tolerance.
pub fn is_degenerate(corners: [Vec3; 3]) -> bool {
    let [a, b, c]: [DVec3; 3] = corners.map(Vec3::as_dvec3);
    (b - a).cross(c - a) == DVec3::ZERO
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tetrahedron_in_any_unit_of_length_has_outward_normals() {
        for size in [1e-30f32, 1e-6, 1.0, 1e12, 1e18] {
            let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
            let mut vertices: Vec<Vertex> = corners.iter().map(|&p| Vertex::new(p * size, Vec3::ZERO)).collect();
            let triangles =
                [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].map(|vertices| Triangle { vertices, material: 0 });
            smooth(&mut vertices, &triangles);
            for vertex in &vertices {
                assert!((vertex.normal.length() - 1.0).abs() < 1e-5, "size {size}: {vertex:?}");
                assert!(vertex.normal.dot(vertex.position / size - Vec3::splat(0.25)) > 0.0, "size {size}: {vertex:?}");
            }
        }
    }

    #[test]
    fn only_bad_normals_are_replaced() {
        let mut vertices = [Vec3::ZERO, Vec3::X, Vec3::Y].map(|p| Vertex::new(p, Vec3::new(0.0, 0.0, -2.0)));
        vertices[1].normal = Vec3::NAN;
        vertices[2].normal = Vec3::ZERO;
        let triangles = [Triangle { vertices: [0, 1, 2], material: 0 }];
        assert_eq!(normalise_or_smooth(&mut vertices, &triangles), 2);
        assert_eq!(vertices.map(|v| v.normal), [Vec3::NEG_Z, Vec3::Z, Vec3::Z]);
    }

    #[test]
    fn only_triangles_of_exactly_zero_area_are_degenerate() {
        let sliver = [Vec3::ZERO, Vec3::X, Vec3::new(0.5, 1e-30, 0.0)];
        assert!(!is_degenerate(sliver));
        assert!(is_degenerate([Vec3::ZERO, Vec3::splat(0.1), Vec3::splat(0.2)]));
        assert!(is_degenerate([Vec3::X, Vec3::X, Vec3::Y]));
    }
}
