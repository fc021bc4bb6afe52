//! Whether some boxes together hold every point of a triangle.

use crate::math::Aabb;
use glam::DVec3;

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
