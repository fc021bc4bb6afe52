//! Whether the leaves of a tree of boxes hold every triangle, and whether some boxes together hold every point of one.
//!
//! A builder may divide a triangle into several references. The leaf of each holds a part of the triangle's box, which
//! a builder enlarges so that no hit is lost; what is asked of all of them together is that they cover the triangle.

use crate::math::Aabb;
use crate::workloads::trace::TriangleRef;
use crate::workloads::trace::common::check::{Expected, Verdict, ensure, same};
use glam::DVec3;

/// What leaves hold of the triangles.
pub(crate) struct Cover<'a> {
    expected: &'a Expected<'a>,
    /// Box around the parts of every triangle's box; empty for a triangle of no leaf.
    spans: Vec<Aabb>,
    /// Triangle and part of its box of every reference.
    parts: Vec<(u32, Aabb)>,
}

impl<'a> Cover<'a> {
    pub fn new(expected: &'a Expected<'a>) -> Cover<'a> {
        Cover { expected, spans: vec![Aabb::EMPTY; expected.boxes.len()], parts: Vec::new() }
    }

    /// Adds a leaf of this box, named `what`; returns the box around its triangles, each clipped to the leaf.
    pub fn leaf(&mut self, what: &str, leaf: Aabb, triangle_refs: &[TriangleRef]) -> Result<Aabb, String> {
        let mut tight = Aabb::EMPTY;
        for (i, triangle_ref) in triangle_refs.iter().enumerate() {
            let triangle = triangle_ref.triangle;
            let is_new = triangle_refs[..i].iter().all(|r| r.triangle != triangle);
            ensure!(is_new, "{what} has triangle {triangle} twice");
            let whole = self.expected.aabb(triangle);
            let part = Aabb { min: whole.min.max(leaf.min), max: whole.max.min(leaf.max) };
            ensure!(!part.is_empty(), "triangle {triangle} lies outside its leaf, {what}");
            let span = &mut self.spans[triangle as usize];
            *span = span.union(part);
            self.parts.push((triangle, part));
            tight = tight.union(part);
        }
        Ok(tight)
    }

    /// Checks that every triangle is in a leaf, and that the leaves of those that are divided hold all of them.
    pub fn check(mut self) -> Verdict {
        for &triangle in &self.expected.hittable {
            let (span, whole) = (self.spans[triangle as usize], self.expected.aabb(triangle));
            ensure!(!span.is_empty(), "triangle {triangle} is in no leaf");
            ensure!(same(span, whole), "the leaves of triangle {triangle} span {span:?} of its box {whole:?}");
        }
        self.parts.sort_by_key(|(triangle, _)| *triangle);
        for parts in self.parts.chunk_by(|(a, _), (b, _)| a == b).filter(|parts| parts.len() > 1) {
            let triangle = parts[0].0;
            let is_whole = is_covered(self.expected.corners(triangle), parts.iter().map(|(_, part)| *part));
            ensure!(is_whole, "the {} leaves of triangle {triangle} do not cover it", parts.len());
        }
        Ok(())
    }
}

/// A convex part of a triangle: its corners in order.
type Polygon = Vec<DVec3>;

/// True if the boxes cover the triangle. Exact but for the corners of parts, which are computed in f64; a part that
/// ends at a plane ends exactly there.
pub(crate) fn is_covered(corners: [DVec3; 3], boxes: impl Iterator<Item = Aabb>) -> bool {
    let mut rest = vec![corners.to_vec()];
    for b in boxes {
        rest = rest.into_iter().flat_map(|part| outside(part, &b)).collect();
    }
    rest.is_empty()
}

/// The parts of a polygon that lie outside of a box.
fn outside(mut polygon: Polygon, b: &Aabb) -> Vec<Polygon> {
    let mut parts = Vec::new();
    for axis in 0..3 {
        for (plane, beyond) in [(f64::from(b.min[axis]), -1.0), (f64::from(b.max[axis]), 1.0)] {
            let is_beyond = |corner: &DVec3| (corner[axis] - plane) * beyond > 0.0;
            if !polygon.iter().any(is_beyond) {
                continue;
            }
            parts.push(side(&polygon, axis, plane, beyond));
            if polygon.iter().all(is_beyond) {
                return parts;
            }
            polygon = side(&polygon, axis, plane, -beyond);
        }
    }
    parts
}

/// The part of a polygon on one side of a plane, the plane included.
fn side(polygon: &Polygon, axis: usize, plane: f64, sign: f64) -> Polygon {
    let mut part = Vec::with_capacity(polygon.len() + 1);
    for (i, &to) in polygon.iter().enumerate() {
        let from = polygon[(i + polygon.len() - 1) % polygon.len()];
        let (a, b) = ((from[axis] - plane) * sign, (to[axis] - plane) * sign);
        if (a < 0.0 && b > 0.0) || (a > 0.0 && b < 0.0) {
            let mut crossing = from + (to - from) * (a / (a - b));
            crossing = crossing.clamp(from.min(to), from.max(to));
            crossing[axis] = plane;
            part.push(crossing);
        }
        if b >= 0.0 {
            part.push(to);
        }
    }
    part
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    const CORNERS: [DVec3; 3] = [DVec3::ZERO, DVec3::new(4.0, 0.0, 0.0), DVec3::new(0.0, 4.0, 0.0)];

    fn boxes(boxes: &[(Vec3, Vec3)]) -> impl Iterator<Item = Aabb> {
        boxes.iter().map(|&(min, max)| Aabb { min, max })
    }

    #[test]
    fn what_boxes_leave_uncovered_is_found() {
        let flat = |x0: f32, y0: f32, x1: f32, y1: f32| (Vec3::new(x0, y0, 0.0), Vec3::new(x1, y1, 0.0));
        assert!(is_covered(CORNERS, boxes(&[flat(0.0, 0.0, 4.0, 4.0)])));
        assert!(is_covered(CORNERS, boxes(&[flat(0.0, 0.0, 1.0, 4.0), flat(1.0, 0.0, 4.0, 3.0)])));
        // A gap, a box that is too low, and a corner of the triangle between the boxes
        assert!(!is_covered(CORNERS, boxes(&[flat(0.0, 0.0, 1.0, 4.0), flat(1.001, 0.0, 4.0, 3.0)])));
        assert!(!is_covered(CORNERS, boxes(&[flat(0.0, 0.0, 1.0, 4.0), flat(1.0, 0.0, 4.0, 2.999)])));
        assert!(!is_covered(CORNERS, boxes(&[flat(0.0, 0.0, 2.0, 2.0), flat(2.0, 0.0, 4.0, 2.0)])));
        assert!(!is_covered(CORNERS, boxes(&[])));
    }
}
