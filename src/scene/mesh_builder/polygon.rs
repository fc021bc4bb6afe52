//! Polygons into triangles: fans where that is right, ears (by the crate earcut) where it is not.

use earcut::Earcut;
use glam::{DVec2, DVec3};

/// Newell's normal of a polygon, also of one that is not quite planar: its length is twice the area, its direction the
/// side on which the corners turn counter-clockwise. Zero if there is no area.
pub fn newell(corners: &[DVec3]) -> DVec3 {
    let origin = corners.first().copied().unwrap_or_default();
    let pairs = corners.windows(2).skip(1);
    pairs.fold(DVec3::ZERO, |sum, pair| sum + (pair[0] - origin).cross(pair[1] - origin))
}

/// Sine of the angle by which a corner may turn the wrong way and the polygon still count as convex: coordinates in text
/// are rounded.
const STRAIGHT: f64 = 1e-5;

/// Cuts polygons into triangles; keeps its memory between polygons.
#[derive(Default)]
pub struct Triangulator {
    flat: Vec<[f64; 2]>,
    earcut: Option<Earcut<f64>>,
    indices: Vec<u32>,
    triangles: Vec<[u32; 3]>,
}

impl Triangulator {
    /// Triangles of corner indices, turning as the polygon does. `holes` has the index at which each hole begins;
    /// `normal` is Newell's of the outer corners. There are three outer corners at least.
    pub fn triangles(&mut self, corners: &[DVec3], holes: &[u32], normal: DVec3) -> &[[u32; 3]] {
        self.triangles.clear();
        if corners.len() == 3 {
            self.triangles.push([0, 1, 2]);
            return &self.triangles;
        }
        self.flatten(corners, normal);
        let cut = !(holes.is_empty() && self.convex()) && self.cut(holes);
        if !cut {
            let outer = holes.first().map_or(corners.len(), |&first| first as usize) as u32;
            self.triangles.extend((1..outer - 1).map(|i| [0, i, i + 1]));
        }
        &self.triangles
    }

    /// Drops the coordinate along which the normal is longest, so that the polygon turns counter-clockwise.
    fn flatten(&mut self, corners: &[DVec3], normal: DVec3) {
        let axis = (0..3).max_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs())).unwrap_or(2);
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let (u, v) = if normal[axis] < 0.0 { (v, u) } else { (u, v) };
        self.flat.clear();
        self.flat.extend(corners.iter().map(|c| [c[u], c[v]]));
    }

    /// True if no corner turns clockwise.
    fn convex(&self) -> bool {
        let n = self.flat.len();
        let edge = |i: usize| DVec2::from(self.flat[(i + 1) % n]) - DVec2::from(self.flat[i % n]);
        (0..n).all(|i| {
            let (a, b) = (edge(i), edge(i + 1));
            a.perp_dot(b) >= -STRAIGHT * a.length() * b.length()
        })
    }

    /// Cuts ears; false if that finds nothing (no area, or edges that cross).
    fn cut(&mut self, holes: &[u32]) -> bool {
        self.indices.clear();
        let earcut = self.earcut.get_or_insert_with(Earcut::new);
        earcut.earcut_slice(&self.flat, holes, &mut self.indices);
        let point = |i: u32| DVec2::from(self.flat[i as usize]);
        self.triangles.extend(self.indices.chunks_exact(3).map(|t| {
            let (a, b, c) = (point(t[0]), point(t[1]), point(t[2]));
            let clockwise = (b - a).perp_dot(c - a) < 0.0;
            if clockwise { [t[0], t[2], t[1]] } else { [t[0], t[1], t[2]] }
        }));
        !self.triangles.is_empty()
    }
}
