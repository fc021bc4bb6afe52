//! `sphere`: an integrating sphere, seen from inside. All of its points receive the same from each other, so that light
//! in it has an exact answer.

use super::mesh::Mesh;
use super::{Parameter, SceneInfo, Values, accept, assemble};
use crate::scene::{Light, Material, Scene};
use glam::Vec3;
use std::collections::HashMap;

pub(super) const INFO: SceneInfo = SceneInfo {
    name: "sphere",
    character: "integrating sphere: a closed sphere of one albedo, a light off its centre inside",
    parameters: &[
        Parameter::triangles(82_000, 500),
        Parameter { name: "albedo", meaning: "albedo of the surface in percent", default: 50, min: 0, max: 100 },
    ],
    check: accept,
    build,
};

/// Radius, in metres; the centre is the origin.
const RADIUS: f32 = 1.0;

/// The golden ratio.
const PHI: f32 = 1.618_034;

/// Corners of an icosahedron.
#[rustfmt::skip]
const CORNERS: [[f32; 3]; 12] = [
    [-1.0, PHI, 0.0], [1.0, PHI, 0.0], [-1.0, -PHI, 0.0], [1.0, -PHI, 0.0],
    [0.0, -1.0, PHI], [0.0, 1.0, PHI], [0.0, -1.0, -PHI], [0.0, 1.0, -PHI],
    [PHI, 0.0, -1.0], [PHI, 0.0, 1.0], [-PHI, 0.0, -1.0], [-PHI, 0.0, 1.0],
];

/// Its faces, counter-clockwise from outside.
#[rustfmt::skip]
const FACES: [[u32; 3]; 20] = [
    [0, 11, 5], [0, 5, 1], [0, 1, 7], [0, 7, 10], [0, 10, 11],
    [1, 5, 9], [5, 11, 4], [11, 10, 2], [10, 7, 6], [7, 1, 8],
    [3, 9, 4], [3, 4, 2], [3, 2, 6], [3, 6, 8], [3, 8, 9],
    [4, 9, 5], [2, 4, 11], [6, 2, 10], [8, 6, 7], [9, 8, 1],
];

fn build(values: &Values) -> Scene {
    // Each face has as many triangles as the square of the segments of an edge
    let segments = ((values.triangles() as f32 / 20.0).sqrt().floor() as u32).max(1);
    let mut mesh = Mesh::plain();
    let material = mesh.material(Material::matt(Vec3::splat(values.get("albedo") as f32 / 100.0)));
    let mut lattice = Lattice { segments, vertices: HashMap::new() };
    for face in FACES {
        // Points of a face by the steps away from its first corner, and among these from the second
        let mut point = |mesh: &mut Mesh, away: u32, across: u32| {
            lattice.vertex(mesh, [(face[0], segments - away), (face[1], away - across), (face[2], across)])
        };
        for away in 1..=segments {
            for across in 0..away {
                let [a, b] = [point(&mut mesh, away, across), point(&mut mesh, away, across + 1)];
                let above = point(&mut mesh, away - 1, across);
                // Clockwise from outside: the surface faces inwards
                mesh.triangle(material, [above, b, a]);
                if across + 1 < away {
                    let next = point(&mut mesh, away - 1, across + 1);
                    mesh.triangle(material, [above, next, b]);
                }
            }
        }
    }
    let light = Light::new(Vec3::new(0.35, 0.2, -0.25) * RADIUS, Vec3::ONE);
    assemble(mesh, vec![light], Vec3::ZERO, Some("sphere"))
}

/// Points of all faces, each once.
struct Lattice {
    /// Of an edge.
    segments: u32,
    /// By corners and their weights.
    vertices: HashMap<[(u32, u32); 3], u32>,
}

impl Lattice {
    /// The vertex that lies between corners with these weights, which add up to the segments.
    fn vertex(&mut self, mesh: &mut Mesh, mut weights: [(u32, u32); 3]) -> u32 {
        // A point of an edge is one of both faces, and a corner one of five
        weights.iter_mut().filter(|(_, weight)| *weight == 0).for_each(|corner| corner.0 = u32::MAX);
        weights.sort_unstable();
        let segments = self.segments;
        *self.vertices.entry(weights).or_insert_with(|| {
            let parts = weights.iter().filter(|(_, weight)| *weight > 0);
            let sum: Vec3 = parts.map(|&(corner, weight)| Vec3::from(CORNERS[corner as usize]) * weight as f32).sum();
            let direction = (sum / segments as f32).normalize();
            mesh.vertex(direction * RADIUS, -direction)
        })
    }
}
