//! Triangulates polygons by the same rule for every format: a polygon becomes the fan (0, k + 1, k + 2) of its corners
//! in file order if that fan covers it, which is the case if the polygon is convex or star-shaped around its first
//! corner. Otherwise its ears are clipped by the crate `earcut`.

use earcut::Earcut;
use glam::{DVec2, DVec3};

/// Polygons with more corners always become fans: the time of ear clipping can grow with the square of their number.
pub const MAX_CORNERS: usize = 4096;

/// The limit of ear clipping per scene, as the sum of the squared numbers of corners: a base and a share per byte of
/// the files. A corner takes several bytes, so polygons of a few hundred corners never exceed it.
const WORK: usize = 1 << 27;
const WORK_PER_BYTE: usize = 128;

/// Newell's normal of a polygon, which need not be planar. Its length is twice the area; seen from its side, the
/// corners are counter-clockwise. It is zero if the polygon has no area, or intersects itself such that areas cancel
/// out.
pub fn newell(corners: &[DVec3]) -> DVec3 {
    let origin = corners.first().copied().unwrap_or_default();
    let pairs = corners.windows(2).skip(1);
    pairs.fold(DVec3::ZERO, |sum, pair| sum + (pair[0] - origin).cross(pair[1] - origin))
}

/// Triangulates polygons; reuses its memory between polygons.
#[derive(Default)]
pub struct Triangulator {
    flat: Vec<[f64; 2]>,
    earcut: Option<Earcut<f64>>,
    indices: Vec<u32>,
    triangles: Vec<[u32; 3]>,
    /// Sum of the squared numbers of corners so far.
    spent: usize,
    /// Size of the files so far.
    bytes: usize,
}

impl Triangulator {
    /// Adds the size of a file, which raises the limit of ear clipping.
    pub fn read(&mut self, bytes: usize) {
        self.bytes = self.bytes.saturating_add(bytes);
    }

    /// The triangles of a polygon, as indices of its corners, with the polygon's orientation. `holes` has the index of
    /// the first corner of each hole; `normal` is Newell's normal of the outer corners, of which there are at least
    /// three.
    ///
    /// Without holes there are always `corners.len() - 2` triangles, so that they can be counted from the file. A
    /// polygon that cannot be clipped (it intersects itself, has too many corners, or the limit is exceeded) becomes
    /// the fan of its outer corners.
    pub fn triangles(&mut self, corners: &[DVec3], holes: &[u32], normal: DVec3) -> &[[u32; 3]] {
        self.triangles.clear();
        let fan = corners.len() == 3 || corners.len() > MAX_CORNERS || holes.is_empty() && fan_covers(corners, normal);
        if fan || !self.cut(corners, holes, normal) {
            let outer = holes.first().map_or(corners.len(), |&first| first as usize) as u32;
            self.triangles.extend((1..outer - 1).map(|i| [0, i, i + 1]));
        }
        &self.triangles
    }

    /// Clips ears; returns false if that does not give the expected number of triangles.
    fn cut(&mut self, corners: &[DVec3], holes: &[u32], normal: DVec3) -> bool {
        if self.spent > WORK.saturating_add(WORK_PER_BYTE.saturating_mul(self.bytes)) {
            return false;
        }
        self.spent += corners.len() * corners.len();
        self.flatten(corners, normal);
        self.indices.clear();
        let earcut = self.earcut.get_or_insert_with(Earcut::new);
        earcut.earcut_slice(&self.flat, holes, &mut self.indices);
        let complete = self.indices.len() == 3 * (corners.len() - 2);
        if self.indices.is_empty() || holes.is_empty() && !complete {
            return false;
        }
        let point = |i: u32| DVec2::from(self.flat[i as usize]);
        self.triangles.extend(self.indices.chunks_exact(3).map(|t| {
            let (a, b, c) = (point(t[0]), point(t[1]), point(t[2]));
            let clockwise = (b - a).perp_dot(c - a) < 0.0;
            if clockwise { [t[0], t[2], t[1]] } else { [t[0], t[1], t[2]] }
        }));
        true
    }

    /// Projects the polygon along the largest component of its normal, such that it is counter-clockwise.
    fn flatten(&mut self, corners: &[DVec3], normal: DVec3) {
        let axis = (0..3).max_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs())).unwrap_or(2);
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let (u, v) = if normal[axis] < 0.0 { (v, u) } else { (u, v) };
        self.flat.clear();
        self.flat.extend(corners.iter().map(|c| [c[u], c[v]]));
    }
}

/// True if no triangle of the fan is oriented against the normal by more than rounding errors. The triangles then do
/// not overlap, since their signed areas sum up to the polygon's.
fn fan_covers(corners: &[DVec3], normal: DVec3) -> bool {
    let slack = 1e-6 * normal.length_squared();
    corners[1..].windows(2).all(|p| (p[0] - corners[0]).cross(p[1] - corners[0]).dot(normal) >= -slack)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangles(points: &[[f64; 2]], plane: fn([f64; 2]) -> DVec3) -> Vec<[usize; 3]> {
        let corners: Vec<DVec3> = points.iter().map(|&p| plane(p)).collect();
        let mut triangulator = Triangulator::default();
        let found = triangulator.triangles(&corners, &[], newell(&corners));
        found.iter().map(|t| t.map(|i| i as usize)).collect()
    }

    const PLANES: [fn([f64; 2]) -> DVec3; 4] = [
        |[x, y]| DVec3::new(x, y, 5.0),
        |[x, y]| DVec3::new(5.0, x, y),
        |[x, y]| DVec3::new(y, 5.0, x),
        |[x, y]| DVec3::new(-x, y, x),
    ];

    #[test]
    fn convex_polygons_are_fans() {
        for plane in PLANES {
            let hexagon = [[0.0, 0.0], [1.0, -1.0], [2.0, 0.0], [2.0, 1.0], [1.0, 2.0], [0.0, 1.0]];
            assert_eq!(triangles(&hexagon, plane), [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]]);
            // An arrow that starts at its notch: all of it is visible from there.
            let arrow = [[0.0, 1.0], [-2.0, 2.0], [0.0, -1.0], [2.0, 2.0]];
            assert_eq!(triangles(&arrow, plane), [[0, 1, 2], [0, 2, 3]]);
        }
    }

    /// An L that starts at each of its corners, in both orientations: the areas sum up, and all triangles have the
    /// polygon's orientation.
    #[test]
    fn concave_polygons_are_covered_once() {
        let shape = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
        for plane in PLANES {
            for start in 0..12 {
                let mut points: Vec<[f64; 2]> = (0..6).map(|i| shape[(start + i) % 6]).collect();
                if start >= 6 {
                    points.reverse();
                }
                let corners: Vec<DVec3> = points.iter().map(|&p| plane(p)).collect();
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

    /// Clips a comb of 4000 corners repeatedly: a small file could otherwise repeat an expensive polygon many times.
    #[test]
    fn the_limit_of_ear_clipping_grows_with_the_file() {
        let upper = (0..2000).map(|i| [f64::from(i), f64::from(1000 * (i % 2) + 1)]);
        let lower = (0..2000).rev().map(|i| [f64::from(i), f64::from(1000 * (i % 2))]);
        let corners: Vec<DVec3> = upper.chain(lower).map(PLANES[0]).collect();
        let normal = newell(&corners);
        let mut triangulator = Triangulator::default();
        let mut cut = || {
            let found = triangulator.triangles(&corners, &[], normal);
            assert_eq!(found.len(), 3998);
            found.iter().any(|triangle| triangle[0] != 0)
        };
        assert_eq!((0..15).filter(|_| cut()).count(), 9, "9 squares of 4000 are more than 2^27");
        triangulator.read(200_000);
        let found = triangulator.triangles(&corners, &[], normal);
        assert!(found.iter().any(|triangle| triangle[0] != 0), "a larger file may have more");
    }

    #[test]
    fn polygons_that_cannot_be_clipped_are_fans() {
        let bow_tie = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
        let point = [[1.0, 1.0]; 5];
        let line = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [1.0, 0.0]];
        for (points, count) in [(&bow_tie[..], 2), (&point[..], 3), (&line[..], 2)] {
            assert_eq!(triangles(points, PLANES[0]).len(), count);
        }
    }
}
