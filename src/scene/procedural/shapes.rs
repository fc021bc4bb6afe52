//! Shapes for the built-in scenes. All of them face outwards and are transformed by [`Mesh::place`].

use super::mesh::{MaterialId, Mesh};
use glam::{Vec2, Vec3};
use std::f32::consts::TAU;

/// Cosine and sine of a share of a full turn. A full turn gives the same bits as none, so that seams have no cracks.
pub fn turn(share: f32) -> (f32, f32) {
    let angle = (share - share.floor()) * TAU;
    (angle.cos(), angle.sin())
}

/// A Catmull-Rom spline through points, sampled in `steps` segments.
pub fn curve(points: &[Vec3], steps: usize) -> Vec<Vec3> {
    let last = points.len() - 1;
    let at = |i: isize| points[i.clamp(0, last as isize) as usize];
    let sample = |s: usize| {
        // The last point is exact, because a profile that ends on the axis must end exactly there.
        if s == steps {
            return points[last];
        }
        let x = s as f32 / steps as f32 * last as f32;
        let i = (x.floor() as isize).min(last as isize - 1);
        let t = x - i as f32;
        let [a, b, c, d] = [at(i - 1), at(i), at(i + 1), at(i + 2)];
        b + ((c - a) + ((a * 2.0 - b * 5.0 + c * 4.0 - d) + (b * 3.0 - a - c * 3.0 + d) * t) * t) * (t * 0.5)
    };
    (0..=steps).map(sample).collect()
}

/// Like [`curve`], for a profile of (radius, y).
pub fn profile(points: &[(f32, f32)], steps: usize) -> Vec<Vec2> {
    let points: Vec<Vec3> = points.iter().map(|&(r, y)| Vec3::new(r, y, 0.0)).collect();
    curve(&points, steps).into_iter().map(|p| Vec2::new(p.x.max(0.0), p.y)).collect()
}

impl Mesh {
    /// Adds a flat parallelogram of `cells`, which faces along `u` cross `v`.
    pub fn quad(&mut self, material: MaterialId, corner: Vec3, u: Vec3, v: Vec3, cells: [usize; 2]) {
        let normal = u.cross(v).normalize_or_zero();
        self.patch(material, cells, [false; 2], |s, t| (corner + u * s + v * t, normal));
    }

    /// Adds an axis-aligned box.
    pub fn cuboid(&mut self, material: MaterialId, min: Vec3, max: Vec3) {
        let e = max - min;
        let (x, y, z) = (Vec3::X * e.x, Vec3::Y * e.y, Vec3::Z * e.z);
        for (corner, u, v) in [(min, z, y), (min, x, z), (min, y, x), (max, -y, -z), (max, -z, -x), (max, -x, -y)] {
            self.quad(material, corner, u, v, [1, 1]);
        }
    }

    /// Adds an axis-aligned box with this centre and these edge lengths.
    pub fn block(&mut self, material: MaterialId, center: Vec3, size: Vec3) {
        self.cuboid(material, center - size * 0.5, center + size * 0.5);
    }

    /// Like [`Mesh::patch`], with normals from differences of positions. `position` is also evaluated slightly outside
    /// of 0..=1.
    pub fn surface(
        &mut self,
        material: MaterialId,
        cells: [usize; 2],
        poles: [bool; 2],
        position: impl Fn(f32, f32) -> Vec3,
    ) {
        const STEP: f32 = 1.0 / 1024.0;
        self.patch(material, cells, poles, |u, v| {
            // The normal at a pole is computed slightly away from it.
            let v_inside = v.clamp(if poles[0] { STEP } else { 0.0 }, if poles[1] { 1.0 - STEP } else { 1.0 });
            let du = position(u + STEP, v_inside) - position(u - STEP, v_inside);
            let dv = position(u, v_inside + STEP) - position(u, v_inside - STEP);
            (position(u, v), crate::scene::normals::unit(du.cross(dv)))
        });
    }

    /// Adds a smooth surface of revolution around y. `profile` has (radius, y); if it runs from bottom to top, the
    /// surface faces away from the axis.
    pub fn lathe(&mut self, material: MaterialId, profile: &[Vec2], around: usize) {
        let rows = profile.len() - 1;
        let poles = [profile[0].x == 0.0, profile[rows].x == 0.0];
        self.patch(material, [around, rows], poles, |u, v| {
            let row = (v * rows as f32).round() as usize;
            let p = profile[row];
            let mut tangent = profile[(row + 1).min(rows)] - profile[row.saturating_sub(1)];
            // At the axis the surface is horizontal.
            if p.x == 0.0 {
                tangent = Vec2::new(if row == 0 { 1.0 } else { -1.0 }, 0.0);
            }
            let (c, s) = turn(u);
            (Vec3::new(p.x * c, p.y, -p.x * s), Vec3::new(tangent.y * c, -tangent.x, -tangent.y * s))
        });
    }

    /// Adds a surface of revolution with a sharp edge at every point of the profile.
    pub fn lathe_sharp(&mut self, material: MaterialId, profile: &[(f32, f32)], around: usize) {
        for pair in profile.windows(2) {
            let segment = [Vec2::from(pair[0]), Vec2::from(pair[1])];
            let mut tangent = segment[1] - segment[0];
            tangent = tangent.normalize_or_zero();
            let poles = segment.map(|p| p.x == 0.0);
            self.patch(material, [around, 1], poles, |u, v| {
                let p = segment[usize::from(v > 0.5)];
                let (c, s) = turn(u);
                (Vec3::new(p.x * c, p.y, -p.x * s), Vec3::new(tangent.y * c, -tangent.x, -tangent.y * s))
            });
        }
    }

    /// Adds a sphere of `8 n^2` triangles: an octahedron with subdivided faces, projected to the sphere.
    pub fn sphere(&mut self, material: MaterialId, center: Vec3, radius: f32, n: usize) {
        if !self.announce(8 * n * n) {
            return;
        }
        for octant in 0..8u32 {
            let sign = |bit: u32| if octant >> bit & 1 == 0 { 1.0 } else { -1.0 };
            let flip = octant.count_ones() % 2 == 1;
            let first = self.vertices.len() as u32;
            for j in 0..=n {
                for i in 0..=n - j {
                    let p = Vec3::new(i as f32, j as f32, (n - i - j) as f32);
                    let direction = (p * Vec3::new(sign(0), sign(1), sign(2))).normalize();
                    self.vertex(center + direction * radius, direction);
                }
            }
            // Row j begins after rows of n + 1, n, ... vertices.
            let at = |i: usize, j: usize| first + (j * (2 * n + 3 - j) / 2 + i) as u32;
            for j in 0..n {
                for i in 0..n - j {
                    let mut face = |a: u32, b: u32, c: u32| {
                        self.triangle(material, if flip { [a, c, b] } else { [a, b, c] });
                    };
                    face(at(i, j), at(i + 1, j), at(i, j + 1));
                    if i + 1 < n - j {
                        face(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
                    }
                }
            }
        }
    }

    /// Adds a tube along `path` with a radius per point. It is closed at an end with radius 0.
    pub fn tube(&mut self, material: MaterialId, path: &[Vec3], radii: impl Fn(f32) -> f32, around: usize) {
        let rows = path.len() - 1;
        let radius = |row: usize| radii(row as f32 / rows as f32);
        let poles = [radius(0) == 0.0, radius(rows) == 0.0];
        // Frames by parallel transport: the first axis of a ring is that of the previous one, made perpendicular to the
        // path.
        let mut axis = (path[1] - path[0]).any_orthogonal_vector().normalize();
        let frames: Vec<[Vec3; 3]> = (0..=rows)
            .map(|row| {
                let tangent = (path[(row + 1).min(rows)] - path[row.saturating_sub(1)]).normalize();
                axis = (axis - tangent * axis.dot(tangent)).normalize();
                [axis, tangent.cross(axis), tangent]
            })
            .collect();
        self.patch(material, [around, rows], poles, |u, v| {
            let row = (v * rows as f32).round() as usize;
            let [n, b, t] = frames[row];
            let (c, s) = turn(u);
            let outward = n * c + b * s;
            let (before, after) = (row.saturating_sub(1), (row + 1).min(rows));
            let slope = (radius(after) - radius(before)) / path[after].distance(path[before]);
            let normal = match row {
                0 if poles[0] => -t,
                _ if row == rows && poles[1] => t,
                _ => outward - t * slope,
            };
            (path[row] + outward * radius(row), normal)
        });
    }

    /// Adds a straight cylinder with flat ends.
    pub fn bar(&mut self, material: MaterialId, from: Vec3, to: Vec3, radius: f32, around: usize) {
        self.rod(material, &[from, to], radius, around);
    }

    /// Adds a tube of constant radius with flat ends.
    pub fn rod(&mut self, material: MaterialId, path: &[Vec3], radius: f32, around: usize) {
        self.tube(material, path, |_| radius, around);
        let last = path.len() - 1;
        self.disc(material, path[0], (path[0] - path[1]).normalize(), radius, around);
        self.disc(material, path[last], (path[last] - path[last - 1]).normalize(), radius, around);
    }

    /// Adds a flat disc that faces along `normal`.
    pub fn disc(&mut self, material: MaterialId, center: Vec3, normal: Vec3, radius: f32, around: usize) {
        let x = normal.any_orthogonal_vector().normalize() * radius;
        let y = normal.cross(x);
        let outline: Vec<Vec3> = (0..around)
            .map(|i| {
                let (c, s) = turn(i as f32 / around as f32);
                center + x * c + y * s
            })
            .collect();
        self.polygon(material, &outline);
    }

    /// Adds a flat convex polygon, counter-clockwise seen from outside, as a fan.
    pub fn polygon(&mut self, material: MaterialId, outline: &[Vec3]) {
        if !self.announce(outline.len() - 2) {
            return;
        }
        // Newell's normal
        let next = outline.iter().cycle().skip(1);
        let normal: Vec3 = outline.iter().zip(next).map(|(a, b)| (*a - outline[0]).cross(*b - outline[0])).sum();
        let corners: Vec<u32> = outline.iter().map(|&p| self.vertex(p, normal)).collect();
        for pair in corners[1..].windows(2) {
            self.triangle(material, [corners[0], pair[0], pair[1]]);
        }
    }

    /// Adds a slab from height `low` to `high` with a smooth rim. `outline` is convex, in (x, z), and counter-clockwise
    /// seen from above.
    pub fn slab(&mut self, material: MaterialId, outline: &[Vec2], low: f32, high: f32) {
        let at = |p: Vec2, y: f32| Vec3::new(p.x, y, p.y);
        let n = outline.len();
        let corner = |i: usize| outline[i % n];
        self.patch(material, [n, 1], [false; 2], |u, v| {
            let i = (u * n as f32).round() as usize;
            let along = corner(i + 1) - corner(i + n - 1);
            let y = if v > 0.5 { high } else { low };
            (at(corner(i), y), Vec3::new(-along.y, 0.0, along.x))
        });
        let top: Vec<Vec3> = outline.iter().map(|&p| at(p, high)).collect();
        let bottom: Vec<Vec3> = outline.iter().rev().map(|&p| at(p, low)).collect();
        self.polygon(material, &top);
        self.polygon(material, &bottom);
    }
}
