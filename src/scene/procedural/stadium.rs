//! `stadium`: the proverbial teapot in a stadium. Half of all triangles are in a teapot of 30 cm, on a pedestal at the
//! centre of a stadium 230 m wide, so that one cell of a uniform grid holds them all. BART's robots have a similar
//! distribution.

use super::mesh::{Mesh, fit, segments};
use super::shapes::{profile, turn};
use super::{Parameter, SceneInfo, Values, accept, assemble};
use crate::scene::{Light, Material, Scene};
use glam::{Affine3A, Quat, Vec2, Vec3};

pub(super) const INFO: SceneInfo = SceneInfo {
    name: "stadium",
    character: "teapot in a stadium: half of the triangles in a thousandth of the width, four lights",
    parameters: &[Parameter::triangles(100_000, 8_000)],
    check: accept,
    build,
};

/// Height of the top of the pedestal, in metres.
const TABLE: f32 = 1.0;
/// Semi-axes of the edge of the field, in metres.
const FIELD: Vec2 = Vec2::new(58.0, 40.0);
/// Number of rows of seats.
const ROWS: usize = 26;

fn build(values: &Values) -> Scene {
    let mesh = fit(values.triangles(), geometry);
    // Lights are in front of the lamps, so that no mast casts a shadow of its own light.
    let before = |p: Vec3| p * 0.97 + Vec3::Y * 4.0;
    let lights = masts().map(|p| Light::new(before(p), Vec3::new(0.34, 0.335, 0.32))).to_vec();
    assemble(mesh, lights, Vec3::new(0.36, 0.52, 0.78), Some("stadium"))
}

/// The positions of the lamps.
fn masts() -> [Vec3; 4] {
    [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)].map(|(x, z)| Vec3::new(x * 88.0, 46.0, z * 72.0))
}

/// A point on the oval `out` metres outside of the edge of the field, at a share of the full turn.
fn oval(share: f32, out: f32, y: f32) -> Vec3 {
    let (c, s) = turn(share);
    Vec3::new((FIELD.x + out) * c, y, -(FIELD.y + out) * s)
}

fn geometry(mesh: &mut Mesh, detail: f32) {
    pedestal(mesh, detail);
    field(mesh, detail);
    stands(mesh, detail);
    roof(mesh, detail);
    floodlights(mesh, detail);
}

fn pedestal(mesh: &mut Mesh, detail: f32) {
    let marble = mesh.material(Material::matt(Vec3::new(0.80, 0.78, 0.74)).shiny(Vec3::splat(0.4), 60.0, 0.08));
    let china = mesh.material(Material::matt(Vec3::new(0.72, 0.16, 0.10)).shiny(Vec3::splat(0.8), 90.0, 0.18));
    let gold = mesh.material(Material::matt(Vec3::new(0.62, 0.46, 0.16)).shiny(Vec3::new(0.9, 0.8, 0.5), 60.0, 0.3));
    mesh.place = Affine3A::from_scale_rotation_translation(
        Vec3::splat(0.1),
        Quat::from_rotation_y(0.6),
        Vec3::new(0.0, TABLE, 0.0),
    );
    mesh.teapot(china, gold, detail);
    mesh.place = Affine3A::IDENTITY;
    let around = segments(48.0, detail, 8);
    mesh.lathe_sharp(marble, &[(0.42, 0.0), (0.42, 0.10), (0.29, 0.10)], around);
    let shaft = [(0.30, 0.10), (0.22, 0.18), (0.17, 0.45), (0.18, 0.75), (0.26, 0.90), (0.30, 0.94)];
    mesh.lathe(marble, &profile(&shaft, segments(24.0, detail, 4)), around);
    mesh.lathe_sharp(marble, &[(0.30, 0.94), (0.34, 0.94), (0.34, TABLE), (0.0, TABLE)], around);
}

fn field(mesh: &mut Mesh, detail: f32) {
    let grass = [Vec3::new(0.17, 0.36, 0.10), Vec3::new(0.21, 0.42, 0.13)].map(|c| mesh.material(Material::matt(c)));
    let track = mesh.material(Material::matt(Vec3::new(0.52, 0.22, 0.14)));
    let chalk = mesh.material(Material::matt(Vec3::splat(0.9)));
    // Ten mown stripes; the track around them extends to the stands, slightly lower
    let stripe = 76.0 / 10.0;
    for i in 0..10 {
        let corner = Vec3::new(-38.0 + i as f32 * stripe, 0.0, -24.0);
        mesh.quad(grass[i % 2], corner, Vec3::Z * 48.0, Vec3::X * stripe, [1, 1]);
    }
    let around = segments(96.0, detail, 24);
    let rim: Vec<Vec3> = (0..around).map(|i| oval(i as f32 / around as f32, 0.2, -0.05)).collect();
    mesh.polygon(track, &rim);
    // Chalk lines are thin slabs of long triangles.
    let mut line = |x0: f32, z0: f32, x1: f32, z1: f32| {
        mesh.cuboid(chalk, Vec3::new(x0, -0.01, z0), Vec3::new(x1, 0.012, z1));
    };
    for z in [-23.0, 22.9] {
        line(-37.0, z, 37.0, z + 0.1);
    }
    for x in [-37.0, -0.05, 36.9] {
        line(x, -22.9, x + 0.1, 22.9);
    }
    // The centre circle
    let cells = segments(96.0, detail, 24);
    mesh.surface(chalk, [cells, 1], [false; 2], |u, v| {
        let (c, s) = turn(u);
        Vec3::new(c, 0.0, -s) * (9.2 - 0.12 * v) + Vec3::Y * 0.006
    });
    // The goals
    for x in [-37.0, 37.0] {
        let corners =
            [Vec3::new(x, 0.0, -3.66), Vec3::new(x, 2.44, -3.66), Vec3::new(x, 2.44, 3.66), Vec3::new(x, 0.0, 3.66)];
        for pair in corners.windows(2) {
            mesh.bar(chalk, pair[0], pair[1], 0.06, segments(12.0, detail, 6));
        }
    }
}

/// Adds the stands: a riser, a tread and seats per row, and the wall behind them.
fn stands(mesh: &mut Mesh, detail: f32) {
    let concrete = mesh.material(Material::matt(Vec3::splat(0.55)));
    let seats = [Vec3::new(0.12, 0.22, 0.45), Vec3::new(0.45, 0.12, 0.12), Vec3::new(0.75, 0.75, 0.78)];
    let seats = seats.map(|c| mesh.material(Material::matt(c).shiny(Vec3::splat(0.1), 20.0, 0.0)));
    let around = segments(112.0, detail, 24);
    let (depth, rise) = (0.85, 0.48);
    let place = |row: usize| (2.0 + row as f32 * depth, 1.2 + row as f32 * rise);
    let mut ring = |material, from: (f32, f32), to: (f32, f32)| {
        mesh.surface(material, [around, 1], [false; 2], |u, v| {
            let (out, y) = (from.0 + (to.0 - from.0) * v, from.1 + (to.1 - from.1) * v);
            oval(u, out, y)
        });
    };
    // Rings are ordered such that the cross product of the derivatives by u and v points to the field or upwards.
    ring(concrete, (2.0, 1.2), (2.0, -0.05));
    ring(concrete, (2.0, -0.05), (0.2, -0.05));
    for row in 0..ROWS {
        let (out, y) = place(row);
        ring(concrete, (out + depth, y), (out, y));
        // The seats of a row are one band; the colour changes every five rows.
        let band = seats[(row / 5) % 3];
        ring(band, (out + 0.62, y + 0.40), (out + 0.28, y + 0.40));
        ring(band, (out + 0.28, y + 0.40), (out + 0.28, y + 0.02));
        ring(concrete, (out + depth, y + rise), (out + depth, y));
    }
    let (out, y) = place(ROWS);
    ring(concrete, (out + 3.0, y), (out, y));
    ring(concrete, (out + 3.0, -0.2), (out + 3.0, y));
    ring(concrete, (out + 80.0, -0.2), (out + 3.0, -0.2));
}

/// Adds a roof over the upper rows on slender posts.
fn roof(mesh: &mut Mesh, detail: f32) {
    let sheet = Material { ambient: Vec3::splat(0.22), ..Material::matt(Vec3::new(0.70, 0.72, 0.76)) };
    let sheet = mesh.material(sheet.shiny(Vec3::splat(0.3), 30.0, 0.0));
    let steel = mesh.material(Material::matt(Vec3::splat(0.35)).shiny(Vec3::splat(0.4), 30.0, 0.0));
    let [around, across] = [segments(112.0, detail, 24), segments(6.0, detail, 2)];
    let arch = |v: f32| (11.0 + 17.5 * v, 20.5 + 2.2 * (1.0 - (2.0 * v - 1.0) * (2.0 * v - 1.0)) - 2.5 * v);
    mesh.surface(sheet, [around, across], [false; 2], |u, v| {
        let (out, y) = arch(1.0 - v);
        oval(u, out, y)
    });
    mesh.surface(sheet, [around, across], [false; 2], |u, v| {
        let (out, y) = arch(v);
        oval(u, out, y - 0.35)
    });
    // The edges between the two sheets
    for (edge, down) in [(0.0, true), (1.0, false)] {
        mesh.surface(sheet, [around, 1], [false; 2], |u, v| {
            let (out, y) = arch(edge);
            oval(u, out, y - 0.35 * if down { v } else { 1.0 - v })
        });
    }
    for i in 0..32 {
        let share = (i as f32 + 0.5) / 32.0;
        let foot = oval(share, 26.0, 13.5);
        mesh.bar(steel, foot, oval(share, 26.0, 18.6), 0.22, segments(10.0, detail, 4));
        mesh.bar(steel, oval(share, 26.0, 14.5), oval(share, 13.0, 20.9), 0.12, segments(8.0, detail, 4));
    }
}

fn floodlights(mesh: &mut Mesh, detail: f32) {
    let steel = mesh.material(Material::matt(Vec3::splat(0.5)).shiny(Vec3::splat(0.3), 30.0, 0.0));
    let lamp = mesh.material(Material { ambient: Vec3::splat(0.95), ..Material::matt(Vec3::splat(0.3)) });
    for top in masts() {
        let foot = Vec3::new(top.x, -0.2, top.z);
        mesh.bar(steel, foot, top, 0.6, segments(12.0, detail, 5));
        // The panel faces the field; its lamps protrude from it.
        let facing = Quat::from_rotation_y((-top.x).atan2(-top.z));
        mesh.place = Affine3A::from_rotation_translation(facing, top + Vec3::Y * 2.5);
        mesh.block(steel, Vec3::ZERO, Vec3::new(9.0, 5.0, 0.6));
        for i in 0..15 {
            let at = Vec3::new((i % 5) as f32 * 1.6 - 3.2, (i / 5) as f32 * 1.5 - 1.5, 0.35);
            mesh.block(lamp, at, Vec3::new(1.2, 1.1, 0.3));
        }
        mesh.place = Affine3A::IDENTITY;
    }
}
