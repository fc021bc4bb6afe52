//! `plane`: a square that receives light from one point. Nothing reflects it back.

use super::mesh::Mesh;
use super::{Parameter, SceneInfo, Values, accept, assemble};
use crate::scene::{Light, Material, Scene};
use glam::Vec3;

pub(super) const INFO: SceneInfo = SceneInfo {
    name: "plane",
    character: "a flat square of one albedo, a light above its middle",
    parameters: &[
        Parameter::triangles(2_000, 200),
        Parameter { name: "albedo", meaning: "albedo of the surface in percent", default: 50, min: 0, max: 100 },
    ],
    check: accept,
    build,
};

/// Edge length, in metres; the middle is the origin.
const SIDE: f32 = 4.0;

fn build(values: &Values) -> Scene {
    let cells = ((values.triangles() as f32 / 2.0).sqrt().floor() as usize).max(1);
    let mut mesh = Mesh::plain();
    let material = mesh.material(Material::matt(Vec3::splat(values.get("albedo") as f32 / 100.0)));
    let corner = Vec3::new(-0.5, 0.0, -0.5) * SIDE;
    mesh.quad(material, corner, Vec3::Z * SIDE, Vec3::X * SIDE, [cells, cells]);
    let light = Light::new(Vec3::new(0.0, 1.0, 0.0), Vec3::ONE);
    assemble(mesh, vec![light], Vec3::ZERO, Some("plane"))
}
