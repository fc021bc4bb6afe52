//! Polygons into triangles.

use earcut::Earcut;
use glam::{DVec2, DVec3, Vec3};

/// Larger polygons are not examined: ear clipping may take the square of the number of corners.
const MAX_CORNERS: usize = 4096;

/// Triangles of a polygon, as indices of its corners: always `corners - 2`, so that triangles can be counted from the file.
/// A polygon becomes the fan (0, k + 1, k + 2) wherever the fan covers it, as it does if it is convex, and if all of it can
/// be seen from its first corner. Others are clipped ear by ear in the plane that shows the most of them; if that fails
/// (they cut themselves) they become the fan as well.
pub fn triangulate(corners: usize, point: impl Fn(usize) -> Vec3, mut emit: impl FnMut([usize; 3])) {
    if corners > 3 && corners <= MAX_CORNERS {
        let points: Vec<DVec3> = (0..corners).map(|i| point(i).as_dvec3()).collect();
        let normal = newell(&points);
        if !fan_covers(&points, normal)
            && let Some(ears) = ears(&points, normal)
        {
            ears.into_iter().for_each(emit);
            return;
        }
    }
    (2..corners).for_each(|k| emit([0, k - 1, k]));
}

/// The polygon's normal, twice its area long (Newell's method); zero for one that cuts itself into equal halves.
fn newell(points: &[DVec3]) -> DVec3 {
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(|(a, b)| (*a - points[0]).cross(*b - points[0])).sum()
}

/// True if no triangle of the fan turns against the normal, beyond what rounding of coordinates may do: then the triangles
/// do not overlap, since their signed areas add up to the polygon's.
fn fan_covers(points: &[DVec3], normal: DVec3) -> bool {
    let slack = 1e-6 * normal.length_squared();
    points[1..].windows(2).all(|p| (p[0] - points[0]).cross(p[1] - points[0]).dot(normal) >= -slack)
}

/// The triangles of ear clipping, if there are as many as there should be; wound as the polygon is.
fn ears(points: &[DVec3], normal: DVec3) -> Option<Vec<[usize; 3]>> {
    let n = normal.abs();
    // Onto the plane of two axes, so that the projected polygon turns counter-clockwise.
    let flat = |p: &DVec3| match () {
        () if n.x >= n.y && n.x >= n.z => DVec2::new(p.y * normal.x.signum(), p.z),
        () if n.y >= n.z => DVec2::new(p.z * normal.y.signum(), p.x),
        () => DVec2::new(p.x * normal.z.signum(), p.y),
    };
    let projected: Vec<DVec2> = points.iter().map(flat).collect();
    let mut indices: Vec<u32> = Vec::new();
    Earcut::new().earcut(projected.iter().map(|p| p.to_array()), &[] as &[u32], &mut indices);
    if indices.len() != 3 * (points.len() - 2) {
        return None;
    }
    let wound = |t: &[u32]| {
        let [a, b, c] = [t[0], t[1], t[2]].map(|i| i as usize);
        let turns = (projected[b] - projected[a]).perp_dot(projected[c] - projected[a]);
        if turns < 0.0 { [a, c, b] } else { [a, b, c] }
    };
    Some(indices.chunks_exact(3).map(wound).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangles(points: &[[f32; 2]], plane: fn([f32; 2]) -> Vec3) -> Vec<[usize; 3]> {
        let mut found = Vec::new();
        triangulate(points.len(), |i| plane(points[i]), |t| found.push(t));
        found
    }

    const PLANES: [fn([f32; 2]) -> Vec3; 4] = [
        |[x, y]| Vec3::new(x, y, 5.0),
        |[x, y]| Vec3::new(5.0, x, y),
        |[x, y]| Vec3::new(y, 5.0, x),
        |[x, y]| Vec3::new(-x, y, x),
    ];

    #[test]
    fn convex_polygons_are_fans() {
        for plane in PLANES {
            let hexagon = [[0.0, 0.0], [1.0, -1.0], [2.0, 0.0], [2.0, 1.0], [1.0, 2.0], [0.0, 1.0]];
            assert_eq!(triangles(&hexagon, plane), [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]]);
            // An arrow from its notch, and from its tip: all of it can be seen.
            let arrow = [[0.0, 1.0], [-2.0, 2.0], [0.0, -1.0], [2.0, 2.0]];
            assert_eq!(triangles(&arrow, plane), [[0, 1, 2], [0, 2, 3]]);
        }
    }

    /// An L, from every corner on, both ways around: the areas add up, and all triangles turn as the polygon does.
    #[test]
    fn concave_polygons_are_covered_once() {
        let shape = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
        for plane in PLANES {
            for start in 0..12 {
                let mut points: Vec<[f32; 2]> = (0..6).map(|i| shape[(start + i) % 6]).collect();
                if start >= 6 {
                    points.reverse();
                }
                let corners: Vec<DVec3> = points.iter().map(|&p| plane(p).as_dvec3()).collect();
                let normal = newell(&corners);
                let found = triangles(&points, plane);
                assert_eq!(found.len(), 4);
                let mut sum = 0.0;
                for [a, b, c] in found {
                    let area = (corners[b] - corners[a]).cross(corners[c] - corners[a]);
                    assert!(area.dot(normal) > 0.0, "start {start}");
                    sum += area.length();
                }
                assert!((sum - normal.length()).abs() < 1e-9 * sum, "start {start}: {sum}");
            }
        }
    }

    #[test]
    fn hopeless_ones_are_fans_too() {
        let bow_tie = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
        let point = [[1.0, 1.0]; 5];
        let line = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [1.0, 0.0]];
        for (points, count) in [(&bow_tie[..], 2), (&point[..], 3), (&line[..], 2)] {
            assert_eq!(triangles(points, PLANES[0]).len(), count);
        }
    }
}
