//! Polygons into triangles: fans where that is right, ears (by the crate earcut) where it is not. One rule for every
//! format: a polygon is the fan (0, k + 1, k + 2) of its corners in file order wherever that fan covers it, as it does if
//! the polygon is convex, or all of it can be seen from its first corner.

use earcut::Earcut;
use glam::{DVec2, DVec3};

/// Larger polygons are not examined: ear clipping may take the square of the number of corners.
pub const MAX_CORNERS: usize = 4096;

/// What may be cut in all, as the sum of the squares of numbers of corners: so much in any case, and so much more per byte of
/// the file. (A corner needs some bytes: polygons of a few hundred corners may be as many as there is room for.)
const WORK: usize = 1 << 27;
const WORK_PER_BYTE: usize = 128;

/// Newell's normal of a polygon, also of one that is not quite planar: its length is twice the area, its direction the
/// side on which the corners turn counter-clockwise. Zero if there is no area, or if it cuts itself into equal halves.
pub fn newell(corners: &[DVec3]) -> DVec3 {
    let origin = corners.first().copied().unwrap_or_default();
    let pairs = corners.windows(2).skip(1);
    pairs.fold(DVec3::ZERO, |sum, pair| sum + (pair[0] - origin).cross(pair[1] - origin))
}

/// Cuts polygons into triangles; keeps its memory between polygons.
#[derive(Default)]
pub struct Triangulator {
    flat: Vec<[f64; 2]>,
    earcut: Option<Earcut<f64>>,
    indices: Vec<u32>,
    triangles: Vec<[u32; 3]>,
    /// Of [`WORK`].
    spent: usize,
    /// Of the file.
    bytes: usize,
}

impl Triangulator {
    /// Tells the size of a file that is being read: more may be cut.
    pub fn read(&mut self, bytes: usize) {
        self.bytes = self.bytes.saturating_add(bytes);
    }

    /// Triangles of corner indices, turning as the polygon does. `holes` has the index at which each hole begins;
    /// `normal` is Newell's of the outer corners, of which there are three at least.
    ///
    /// Without holes these are always `corners.len() - 2`, so that triangles can be counted from the file. What cannot
    /// be cut (it cuts itself, has too many corners, or comes behind too many of that kind) is the fan of its outer corners.
    pub fn triangles(&mut self, corners: &[DVec3], holes: &[u32], normal: DVec3) -> &[[u32; 3]] {
        self.triangles.clear();
        let fan = corners.len() == 3 || corners.len() > MAX_CORNERS || holes.is_empty() && fan_covers(corners, normal);
        if fan || !self.cut(corners, holes, normal) {
            let outer = holes.first().map_or(corners.len(), |&first| first as usize) as u32;
            self.triangles.extend((1..outer - 1).map(|i| [0, i, i + 1]));
        }
        &self.triangles
    }

    /// Cuts ears; false if there are not as many as there should be.
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

    /// Drops the coordinate along which the normal is longest, so that the polygon turns counter-clockwise.
    fn flatten(&mut self, corners: &[DVec3], normal: DVec3) {
        let axis = (0..3).max_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs())).unwrap_or(2);
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let (u, v) = if normal[axis] < 0.0 { (v, u) } else { (u, v) };
        self.flat.clear();
        self.flat.extend(corners.iter().map(|c| [c[u], c[v]]));
    }
}

/// True if no triangle of the fan turns against the normal, beyond what rounding of coordinates may do: then the triangles
/// do not overlap, since their signed areas add up to the polygon's.
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

    /// A comb of 4000 corners: what it costs to cut could be asked for again and again, in a few bytes.
    #[test]
    fn what_may_be_cut_has_an_end_that_grows_with_the_file() {
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
    fn hopeless_ones_are_fans_too() {
        let bow_tie = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
        let point = [[1.0, 1.0]; 5];
        let line = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [1.0, 0.0]];
        for (points, count) in [(&bow_tie[..], 2), (&point[..], 3), (&line[..], 2)] {
            assert_eq!(triangles(points, PLANES[0]).len(), count);
        }
    }
}
