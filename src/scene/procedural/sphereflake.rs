//! `sphereflake` (Haines 1987, Standard Procedural Databases): recursive spheres, each with a third of its parent's
//! radius, on a chequered floor. The two largest generations are mirrors.

use super::mesh::{MaterialId, Mesh, fit, segments};
use super::{Parameter, SceneInfo, Values, accept, assemble};
use crate::scene::{Light, Material, Scene};
use glam::{Quat, Vec3};

pub(super) const INFO: SceneInfo = SceneInfo {
    name: "sphereflake",
    character: "clusters at every scale: spheres on spheres, the largest are mirrors, three lights",
    parameters: &[Parameter::triangles(160_000, 2_000)],
    check: accept,
    build,
};

/// Height of the floor; it does not touch the root sphere of radius 1.
const FLOOR: f32 = -1.02;

fn build(values: &Values) -> Scene {
    let target = values.triangles();
    // A further generation has nine times as many spheres. It is added if there are at least 150 triangles per sphere.
    let generations = [1, 10, 91, 820, 7_381, 66_430].iter().rposition(|spheres| spheres * 150 <= target).unwrap_or(0);
    let mesh = fit(target, |mesh, detail| geometry(mesh, detail, generations));
    let lights = vec![
        Light::new(Vec3::new(4.0, 5.0, 3.0), Vec3::splat(0.55)),
        Light::new(Vec3::new(-4.5, 6.0, 2.5), Vec3::new(0.42, 0.40, 0.36)),
        Light::new(Vec3::new(0.5, 5.0, -6.0), Vec3::new(0.26, 0.28, 0.34)),
    ];
    assemble(mesh, lights, Vec3::new(0.18, 0.26, 0.40), Some("sphereflake"))
}

fn geometry(mesh: &mut Mesh, detail: f32, generations: usize) {
    let glossy = |r, g, b, mirror| Material::matt(Vec3::new(r, g, b)).shiny(Vec3::splat(0.5), 60.0, mirror);
    let materials = [
        mesh.material(glossy(0.12, 0.13, 0.16, 0.55)),
        mesh.material(glossy(0.55, 0.38, 0.12, 0.35)),
        mesh.material(glossy(0.55, 0.13, 0.10, 0.0)),
        mesh.material(glossy(0.20, 0.42, 0.35, 0.0)),
        mesh.material(glossy(0.62, 0.58, 0.50, 0.0)),
    ];
    let tiles = [Vec3::new(0.62, 0.60, 0.55), Vec3::new(0.30, 0.30, 0.31)].map(|c| mesh.material(Material::matt(c)));
    for j in 0..12 {
        for i in 0..12 {
            let corner = Vec3::new(i as f32 - 6.0, FLOOR, j as f32 - 6.0);
            mesh.quad(tiles[(i + j) % 2], corner, Vec3::Z, Vec3::X, [1, 1]);
        }
    }
    let flake = Flake { materials, detail, generations };
    flake.grow(mesh, Vec3::ZERO, 1.0, Vec3::Y, 0);
}

struct Flake {
    materials: [MaterialId; 5],
    detail: f32,
    generations: usize,
}

impl Flake {
    /// Adds a sphere and its children: six around its equator, three around its pole, which points away from the
    /// parent.
    fn grow(&self, mesh: &mut Mesh, center: Vec3, radius: f32, pole: Vec3, generation: usize) {
        // A child has a third of the radius and half of the segments.
        let n = segments(32.0 * 0.5f32.powi(generation as i32), self.detail, 1);
        mesh.sphere(self.materials[generation.min(4)], center, radius, n);
        if generation == self.generations {
            return;
        }
        let upright = Quat::from_rotation_arc(Vec3::Y, pole);
        for child in 0..9 {
            let (turn, elevation) =
                if child < 6 { (child as f32 * 60.0, 0.0f32) } else { (child as f32 * 120.0 + 30.0, 54.7) };
            let (turn, elevation) = (turn.to_radians(), elevation.to_radians());
            let local = Vec3::new(turn.cos() * elevation.cos(), elevation.sin(), turn.sin() * elevation.cos());
            let direction = (upright * local).normalize();
            // A small gap ensures that no two surfaces touch.
            self.grow(mesh, center + direction * (radius * 4.002 / 3.0), radius / 3.0, direction, generation + 1);
        }
    }
}
