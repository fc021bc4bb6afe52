//! `terrain`: a fractal heightfield of triangles of uniform size, with lakes (mirrors) in its valleys.

use super::mesh::Mesh;
use super::noise::{fractal, noise2, ridged};
use super::{Parameter, SceneInfo, Values, accept, assemble};
use crate::math::Vertex;
use crate::scene::{Light, Material, Scene, Triangle, normals};
use glam::{Vec2, Vec3};
use rayon::prelude::*;

pub(super) const INFO: SceneInfo = SceneInfo {
    name: "terrain",
    character: "heightfield: fractal mountains with lakes, flat bounds, one light",
    parameters: &[Parameter::triangles(130_000, 1_000)],
    check: accept,
    build,
};

/// Edge length of the square, in kilometres.
const SIDE: f32 = 10.0;
/// Height of the lakes, in kilometres.
const LAKE: f32 = 0.38;

/// Height at (x, z), in kilometres.
fn height(p: Vec2) -> f32 {
    let bend = Vec2::new(noise2(p * 0.5, 101), noise2(p * 0.5, 102));
    let crests = ridged((p + bend * 0.5) * 0.42, 9, 7);
    let broad = 0.5 + 0.7 * noise2(p * 0.19 + Vec2::splat(3.1), 55);
    let rough = fractal(6, |scale, i| noise2(p * (1.7 * scale), 31 + i));
    2.2 * crests * crests * broad.clamp(0.12, 1.0) + 0.10 * rough + 0.12
}

fn build(values: &Values) -> Scene {
    let target = values.triangles() as f32;
    // There are two triangles per cell; the lakes consist of a few cells that are eight times as wide.
    let n = ((target * 0.995 / 2.0).sqrt().floor() as usize).max(8);
    let mut mesh = Mesh::plain();
    // The ambient light is bluish, as a substitute for light of the sky in shadows.
    let ground = |r, g, b| {
        let colour = Vec3::new(r, g, b);
        Material { ambient: colour * Vec3::new(0.20, 0.23, 0.28), ..Material::matt(colour) }
    };
    let grass = mesh.material(ground(0.27, 0.36, 0.13));
    let rock = mesh.material(ground(0.42, 0.38, 0.34).shiny(Vec3::splat(0.06), 8.0, 0.0));
    let snow = mesh.material(ground(0.88, 0.90, 0.95).shiny(Vec3::splat(0.15), 20.0, 0.0));
    let sand = mesh.material(ground(0.60, 0.53, 0.38));
    let lake = mesh.material(Material::matt(Vec3::new(0.05, 0.12, 0.17)).shiny(Vec3::splat(0.6), 120.0, 0.5));

    let row = n as u32 + 1;
    let place = |i: usize, n: usize| (i as f32 / n as f32 - 0.5) * SIDE;
    let vertex = |k: usize| {
        let p = Vec2::new(place(k % (n + 1), n), place(k / (n + 1), n));
        Vertex::new(Vec3::new(p.x, height(p), p.y), Vec3::ZERO)
    };
    mesh.vertices = (0..(n + 1) * (n + 1)).into_par_iter().map(vertex).collect();
    for j in 0..n as u32 {
        for i in 0..n as u32 {
            let a = j * row + i;
            let (b, c, d) = (a + 1, a + row + 1, a + row);
            // The diagonal alternates from cell to cell, so that no direction is preferred.
            let pair = if (i + j) % 2 == 0 { [[a, d, c], [a, c, b]] } else { [[a, d, b], [b, d, c]] };
            for vertices in pair {
                let [p, q, r] = vertices.map(|v| mesh.vertices[v as usize].position);
                let middle = (p + q + r) / 3.0;
                let level = (q - p).cross(r - p).normalize().y;
                let border = 0.12 * noise2(Vec2::new(middle.x, middle.z) * 3.0, 77);
                let material = if middle.y < LAKE + 0.02 {
                    sand
                } else if middle.y + border > 0.98 && level > 0.60 {
                    snow
                } else if level < 0.72 || middle.y + border > 0.85 {
                    rock
                } else {
                    grass
                };
                mesh.triangles.push(Triangle { vertices, material });
            }
        }
    }
    normals::smooth(&mut mesh.vertices, &mesh.triangles);
    lakes(&mut mesh, lake, n);
    let sun = Light::new(Vec3::new(-9.0, 15.0, 7.0), Vec3::new(1.0, 0.96, 0.88));
    assemble(mesh, vec![sun], Vec3::new(0.55, 0.70, 0.90), Some("terrain"))
}

/// Adds water to each wide cell in which a vertex of the ground is below the height of the lakes.
fn lakes(mesh: &mut Mesh, material: u32, n: usize) {
    let wide = (n / 8).max(4);
    let edge = SIDE / wide as f32;
    for j in 0..wide {
        for i in 0..wide {
            // The vertices of the ground on and around the wide cell
            let span = |k: usize| k * n / wide..=((k + 1) * n).div_ceil(wide);
            let is_low = |k: usize| mesh.vertices[k].position.y < LAKE;
            if span(j).any(|row| span(i).any(|column| is_low(row * (n + 1) + column))) {
                let corner = Vec2::new(i as f32, j as f32) * edge - Vec2::splat(SIDE * 0.5);
                mesh.quad(material, Vec3::new(corner.x, LAKE, corner.y), Vec3::Z * edge, Vec3::X * edge, [1, 1]);
            }
        }
    }
}
