//! `scan`: one closed surface of triangles of uniform size, similar to the scanned bunny and dragon: a cat on a plinth,
//! meshed by surface nets. With spikes it is the shape with points: there a kd-tree has more nodes and references than
//! for a smooth one.

use super::mesh::Mesh;
use super::noise::{fractal, noise3};
use super::shapes::curve;
use super::surface_nets::surface_net;
use super::{Parameter, SceneInfo, Values, assemble, spikes};
use crate::math::Vertex;
use crate::scene::{Light, Material, Scene, Triangle, normals};
use glam::Vec3;

pub(super) const INFO: SceneInfo = SceneInfo {
    name: "scan",
    character: "uniform: one statue, similar to a scan, with triangles of uniform size, one light",
    parameters: &[Parameter::triangles(70_000, 1_000), SPIKES],
    check,
    build,
};

const SPIKES: Parameter = Parameter {
    name: "spikes",
    meaning: "long thin spikes that grow out of the statue; their triangles are part of the number above",
    default: 0,
    min: 0,
    max: 100_000,
};

/// Refuses spikes that leave too little to the statue.
fn check(values: &Values) -> Result<(), String> {
    let most = values.triangles() * 3 / 4 / spikes::TRIANGLES;
    match values.get(SPIKES.name) as usize {
        count if count <= most => Ok(()),
        _ => Err(format!("with {} triangles there are at most {most} spikes", values.triangles())),
    }
}

/// The lowest corner and the edge length of a cube around the statue.
const MIN: Vec3 = Vec3::new(-1.15, -0.1, -1.15);
const SIZE: f32 = 2.3;

fn build(values: &Values) -> Scene {
    let count = values.get(SPIKES.name) as usize;
    let target = values.triangles() - count * spikes::TRIANGLES;
    let statue = Statue::new();
    let net = |cell: f32| surface_net(MIN, SIZE, cell, RELIEF, |p| statue.distance(p));
    // The number of triangles grows slightly faster than the inverse square of the cell size, because smaller cells
    // resolve more of the relief. Nets with a sixteenth and a quarter of the triangles measure this.
    let cell_for = |cell: f32, found: usize, wanted: usize| cell * (found as f32 / wanted as f32).sqrt();
    let mut cell = SIZE / 24.0;
    for share in [16, 4] {
        cell = cell_for(cell, net(cell).triangles.len(), target / share);
    }
    let mut found = net(cell);
    for _ in 0..3 {
        let off = found.triangles.len() as f32 / target as f32;
        if (0.95..=1.05).contains(&off) {
            break;
        }
        cell = cell_for(cell, found.triangles.len(), target);
        found = net(cell);
    }
    let mut mesh = Mesh::plain();
    let colour = Vec3::new(0.78, 0.68, 0.56);
    let stone = Material { ambient: colour * 0.16, ..Material::matt(colour) };
    let stone = mesh.material(stone.shiny(Vec3::splat(0.25), 30.0, 0.0));
    mesh.vertices = found.positions.iter().map(|&p| Vertex::new(p, Vec3::ZERO)).collect();
    mesh.triangles = found.triangles.iter().map(|&vertices| Triangle { vertices, material: stone }).collect();
    normals::smooth(&mut mesh.vertices, &mesh.triangles);
    if count > 0 {
        spikes::grow(&mut mesh, count, stone);
        normals::smooth(&mut mesh.vertices, &mesh.triangles);
    }
    let light = Light::new(Vec3::new(1.4, 6.2, 2.7), Vec3::splat(1.0));
    assemble(mesh, vec![light], Vec3::new(0.10, 0.11, 0.13), None)
}

/// Upper bound of the height of fur and grain.
const RELIEF: f32 = 0.025;

/// Precomputed parts of the statue.
struct Statue {
    /// Points on the centre line of the tail, from its root.
    tail: Vec<Vec3>,
}

impl Statue {
    fn new() -> Statue {
        let tail =
            [(0.0, 0.34, -0.50), (0.30, 0.29, -0.53), (0.56, 0.28, -0.26), (0.60, 0.28, 0.10), (0.44, 0.28, 0.42)];
        Statue { tail: curve(&tail.map(Vec3::from), 8) }
    }

    /// The approximate signed distance to the surface, negative inside.
    fn distance(&self, p: Vec3) -> f32 {
        let plinth = rounded_cylinder(p, 0.74, 0.2, 0.03);
        let mut cat = torso(p);
        // A part is evaluated only if it can be nearer than the parts so far, including the radius of blending.
        let may_count = |cat: f32, center: Vec3, radius: f32| p.distance(center) - radius < cat.min(plinth) + 0.1;
        if may_count(cat, Vec3::new(0.0, 0.5, 0.3), 0.62) {
            cat = legs(p, cat);
        }
        if may_count(cat, Vec3::new(0.0, 1.60, 0.30), 0.48) {
            cat = head(p, cat);
        }
        if (p.y - 0.31).abs() - 0.14 < cat.min(plinth) + 0.1 && may_count(cat, Vec3::new(0.26, 0.3, -0.05), 0.72) {
            let radius = |i: usize| 0.10 - 0.004 * i as f32;
            let piece = |(i, pair): (usize, &[Vec3])| cone(p, pair[0], pair[1], radius(i), radius(i + 1));
            let tail = self.tail.windows(2).enumerate().map(piece).fold(f32::INFINITY, f32::min);
            cat = blend(cat, tail, 0.05);
        }
        let whole = blend(cat, plinth, 0.015);
        // The relief matters only near the surface.
        if whole.abs() > RELIEF {
            return whole;
        }
        let grain = noise3(p * 34.0, 23) * 0.0025;
        let hair = Vec3::new(p.x * 16.0, p.y * 7.0, p.z * 16.0);
        let fur = if cat < plinth { fractal(3, |scale, i| noise3(hair * scale, 11 + i)) * 0.016 } else { 0.0 };
        whole + fur + grain
    }
}

/// Mirrors a point to the right half, because parts of the cat are symmetric.
fn mirrored(p: Vec3) -> Vec3 {
    Vec3::new(p.x.abs(), p.y, p.z)
}

/// Signed distance to the torso, from the hips to the neck.
fn torso(p: Vec3) -> f32 {
    let mut cat = cone(p, Vec3::new(0.0, 0.58, -0.20), Vec3::new(0.0, 1.02, 0.10), 0.40, 0.29);
    cat = blend(cat, ellipsoid(mirrored(p), Vec3::new(0.27, 0.45, -0.10), Vec3::new(0.20, 0.28, 0.36)), 0.10);
    cat = blend(cat, ellipsoid(p, Vec3::new(0.0, 0.92, 0.20), Vec3::new(0.24, 0.30, 0.20)), 0.10);
    blend(cat, cone(p, Vec3::new(0.0, 1.10, 0.14), Vec3::new(0.0, 1.42, 0.24), 0.22, 0.19), 0.10)
}

/// Adds fore legs and paws to the distance `cat`.
fn legs(p: Vec3, mut cat: f32) -> f32 {
    let m = mirrored(p);
    cat = blend(cat, cone(m, Vec3::new(0.15, 0.90, 0.26), Vec3::new(0.13, 0.28, 0.38), 0.12, 0.085), 0.06);
    cat = blend(cat, ellipsoid(m, Vec3::new(0.13, 0.25, 0.45), Vec3::new(0.105, 0.075, 0.15)), 0.05);
    blend(cat, ellipsoid(m, Vec3::new(0.34, 0.25, 0.20), Vec3::new(0.11, 0.075, 0.20)), 0.05)
}

/// Adds skull, cheeks, chin, nose, ears and eyes to the distance `cat`.
fn head(p: Vec3, mut cat: f32) -> f32 {
    let m = mirrored(p);
    cat = blend(cat, ellipsoid(p, Vec3::new(0.0, 1.54, 0.28), Vec3::new(0.27, 0.235, 0.25)), 0.07);
    cat = blend(cat, ellipsoid(m, Vec3::new(0.06, 1.47, 0.50), Vec3::new(0.085, 0.065, 0.075)), 0.04);
    cat = blend(cat, ellipsoid(p, Vec3::new(0.0, 1.41, 0.47), Vec3::new(0.07, 0.06, 0.07)), 0.03);
    cat = blend(cat, ellipsoid(p, Vec3::new(0.0, 1.515, 0.56), Vec3::new(0.03, 0.022, 0.025)), 0.01);
    cat = blend(cat, cone(m, Vec3::new(0.145, 1.68, 0.25), Vec3::new(0.205, 1.93, 0.23), 0.095, 0.02), 0.04);
    // The hollows of the ears, and the eyes in their sockets
    cat = carve(cat, cone(m, Vec3::new(0.155, 1.70, 0.345), Vec3::new(0.205, 1.87, 0.275), 0.055, 0.02), 0.02);
    cat = carve(cat, ellipsoid(m, Vec3::new(0.105, 1.58, 0.51), Vec3::new(0.055, 0.04, 0.05)), 0.02);
    blend(cat, ellipsoid(m, Vec3::new(0.10, 1.58, 0.475), Vec3::new(0.045, 0.038, 0.04)), 0.005)
}

/// The polynomial smooth union of two distances with radius `k`.
fn blend(a: f32, b: f32, k: f32) -> f32 {
    let h = (k - (a - b).abs()).max(0.0) / k;
    a.min(b) - h * h * k * 0.25
}

/// The smooth difference of `a` and `b` with radius `k`.
fn carve(a: f32, b: f32, k: f32) -> f32 {
    -blend(-a, b, k)
}

/// The approximate signed distance to an ellipsoid; it is zero exactly on the surface.
fn ellipsoid(p: Vec3, center: Vec3, radii: Vec3) -> f32 {
    let q = (p - center) / radii;
    let k0 = q.length();
    let k1 = (q / radii).length();
    if k1 > 0.0 { k0 * (k0 - 1.0) / k1 } else { -radii.min_element() }
}

/// The approximate signed distance to a capsule with the radius `ra` at `a` and `rb` at `b`.
fn cone(p: Vec3, a: Vec3, b: Vec3, ra: f32, rb: f32) -> f32 {
    let ab = b - a;
    let t = ((p - a).dot(ab) / ab.length_squared()).clamp(0.0, 1.0);
    p.distance(a + ab * t) - (ra + (rb - ra) * t)
}

/// The signed distance to a cylinder around the y axis, from 0 to `height`, with rounded edges.
fn rounded_cylinder(p: Vec3, radius: f32, height: f32, rounding: f32) -> f32 {
    let d = glam::Vec2::new((p.x * p.x + p.z * p.z).sqrt() - radius, (p.y - height * 0.5).abs() - height * 0.5)
        + glam::Vec2::splat(rounding);
    d.max_element().min(0.0) + d.max(glam::Vec2::ZERO).length() - rounding
}
