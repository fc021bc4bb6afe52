//! The furniture of the room: a table with objects on it, chairs, bookshelves.

use super::super::mesh::{MaterialId, Mesh, segments};
use super::super::noise::random;
use super::super::shapes::{curve, profile, turn};
use super::{Materials, X};
use glam::{Affine3A, Quat, Vec2, Vec3};
use std::f32::consts::{FRAC_PI_2, PI};

/// The outline of the table: a rectangle with half circles at the ends.
fn table_outline(half: f32, radius: f32, around: usize) -> Vec<Vec2> {
    let end = |from: f32, center: f32| {
        (0..=around).map(move |i| {
            let (c, s) = turn(from + 0.5 * i as f32 / around as f32);
            Vec2::new(center + radius * c, -radius * s)
        })
    };
    end(-0.25, half).chain(end(0.25, -half)).collect()
}

pub(super) fn table(mesh: &mut Mesh, m: &Materials, detail: f32) {
    let around = segments(40.0, detail, 8);
    mesh.slab(m.table, &table_outline(2.1, 0.85, around), 0.715, 0.76);
    mesh.slab(m.metal, &table_outline(2.1, 0.80, around), 0.68, 0.716);
    for x in [-1.7, 1.7] {
        let foot = [
            (0.46, 0.0),
            (0.46, 0.02),
            (0.30, 0.05),
            (0.12, 0.09),
            (0.075, 0.20),
            (0.07, 0.45),
            (0.10, 0.64),
            (0.22, 0.70),
        ];
        mesh.place = Affine3A::from_translation(Vec3::new(x, 0.0, 0.0));
        mesh.lathe(m.metal, &profile(&foot, segments(24.0, detail, 8)), segments(36.0, detail, 8));
    }
    // A jug and a bowl at the centre of the table
    mesh.place = Affine3A::from_translation(Vec3::new(-0.5, 0.7605, 0.05));
    let jug = [
        (0.0, 0.0),
        (0.05, 0.0),
        (0.085, 0.03),
        (0.09, 0.10),
        (0.06, 0.18),
        (0.05, 0.23),
        (0.065, 0.26),
        (0.06, 0.26),
        (0.04, 0.22),
    ];
    mesh.lathe(m.metal, &profile(&jug, segments(32.0, detail, 10)), segments(32.0, detail, 8));
    mesh.place = Affine3A::from_translation(Vec3::new(0.45, 0.7605, -0.05));
    let bowl = [
        (0.0, 0.0),
        (0.07, 0.0),
        (0.08, 0.02),
        (0.16, 0.07),
        (0.21, 0.12),
        (0.205, 0.125),
        (0.15, 0.075),
        (0.06, 0.03),
        (0.0, 0.025),
    ];
    mesh.lathe(m.china, &profile(&bowl, segments(32.0, detail, 10)), segments(40.0, detail, 8));
    for i in 0..5 {
        let (c, s) = turn(i as f32 / 5.0);
        mesh.sphere(
            m.books[if i % 2 == 0 { 0 } else { 3 }],
            Vec3::new(c * 0.085, 0.085, s * 0.085),
            0.042,
            segments(8.0, detail, 2),
        );
    }
    mesh.place = Affine3A::IDENTITY;
}

/// The transforms of the chairs around the table, with their numbers. Each chair is rotated slightly; it faces its
/// local +z.
pub(super) fn chair_places() -> Vec<(Affine3A, u32)> {
    let mut places = Vec::new();
    for i in 0..5 {
        for side in [-1.0f32, 1.0] {
            places.push((Vec3::new(i as f32 * 1.0 - 2.0, 0.0, side * 1.22), if side < 0.0 { 0.0 } else { PI }));
        }
    }
    places.push((Vec3::new(-3.35, 0.0, 0.0), FRAC_PI_2));
    places.push((Vec3::new(3.35, 0.0, 0.0), -FRAC_PI_2));
    let turned = |(seed, (at, angle)): (usize, (Vec3, f32))| {
        let angle = angle + (random(seed as u32, 3) - 0.5) * 0.5;
        (Affine3A::from_rotation_translation(Quat::from_rotation_y(angle), at), seed as u32)
    };
    places.into_iter().enumerate().map(turned).collect()
}

/// Adds a cantilever chair of bent tube with a padded seat and back.
pub(super) fn chair(mesh: &mut Mesh, m: &Materials, detail: f32) {
    let rows = segments(40.0, detail, 12);
    let around = segments(10.0, detail, 5);
    for side in [-0.24, 0.24f32] {
        let tube = [
            (0.92, -0.25),
            (0.60, -0.22),
            (0.46, -0.20),
            (0.45, 0.0),
            (0.44, 0.22),
            (0.36, 0.26),
            (0.10, 0.25),
            (0.02, 0.20),
            (0.013, 0.0),
            (0.013, -0.22),
        ];
        let path: Vec<Vec3> = tube.iter().map(|&(y, z)| Vec3::new(side, y, z)).collect();
        mesh.rod(m.metal, &curve(&path, rows), 0.012, around);
        let rest = [(0.62, -0.215), (0.66, -0.12), (0.665, 0.05), (0.64, 0.14), (0.46, 0.20)];
        let out = side.signum() * 0.03;
        let path: Vec<Vec3> = rest.iter().map(|&(y, z)| Vec3::new(side + out, y, z)).collect();
        mesh.rod(m.metal, &curve(&path, rows / 2), 0.010, around);
        mesh.block(m.wood, Vec3::new(side + out, 0.677, 0.0), Vec3::new(0.045, 0.02, 0.22));
    }
    mesh.bar(m.metal, Vec3::new(-0.24, 0.013, -0.22), Vec3::new(0.24, 0.013, -0.22), 0.012, around);
    let place = mesh.place;
    mesh.place = place * Affine3A::from_translation(Vec3::new(0.0, 0.475, 0.0));
    cushion(mesh, m.cloth, Vec3::new(0.225, 0.035, 0.22), detail);
    mesh.place =
        place * Affine3A::from_rotation_translation(Quat::from_rotation_x(-1.48), Vec3::new(0.0, 0.76, -0.222));
    cushion(mesh, m.cloth, Vec3::new(0.225, 0.028, 0.17), detail);
    mesh.place = place;
}

/// Adds a cushion: a superellipsoid with the semi-axes `half`.
fn cushion(mesh: &mut Mesh, material: MaterialId, half: Vec3, detail: f32) {
    let power = |x: f32, e: f32| x.signum() * x.abs().powf(e);
    let cells = [segments(48.0, detail, 12), segments(20.0, detail, 6)];
    mesh.surface(material, cells, [true; 2], |u, v| {
        let ((c, s), polar) = (turn(u), (v - 0.5) * PI);
        let ring = power(polar.cos().max(0.0), 0.45);
        half * Vec3::new(ring * power(c, 0.35), power(polar.sin(), 0.8), -ring * power(s, 0.35))
    });
}

/// Adds a cup with a handle on a saucer, in front of a chair.
pub(super) fn cup(mesh: &mut Mesh, m: &Materials, detail: f32) {
    let place = mesh.place;
    mesh.place = place * Affine3A::from_translation(Vec3::new(0.22, 0.001, 0.62));
    let around = segments(28.0, detail, 8);
    let saucer = [(0.0, 0.0), (0.04, 0.0), (0.075, 0.012), (0.073, 0.015), (0.04, 0.005), (0.0, 0.005)];
    mesh.lathe(m.china, &profile(&saucer, segments(16.0, detail, 6)), around);
    let cup = [
        (0.0, 0.008),
        (0.022, 0.009),
        (0.034, 0.03),
        (0.040, 0.07),
        (0.038, 0.071),
        (0.031, 0.035),
        (0.02, 0.015),
        (0.0, 0.014),
    ];
    mesh.lathe(m.china, &profile(&cup, segments(24.0, detail, 8)), around);
    let handle = [
        Vec3::new(0.036, 0.060, 0.0),
        Vec3::new(0.060, 0.058, 0.0),
        Vec3::new(0.060, 0.036, 0.0),
        Vec3::new(0.034, 0.028, 0.0),
    ];
    mesh.tube(m.china, &curve(&handle, segments(12.0, detail, 5)), |_| 0.0045, segments(8.0, detail, 4));
    mesh.place = place;
}

/// Adds bookshelves on the wall x = -X.
pub(super) fn shelf(mesh: &mut Mesh, m: &Materials) {
    let (depth, width, height) = (0.32, 3.2, 2.1);
    let x = -X + depth * 0.5 + 0.025;
    for i in 0..5 {
        let z = (i as f32 - 2.0) * width / 4.0;
        mesh.block(m.wood, Vec3::new(x, height * 0.5, z), Vec3::new(depth, height, 0.03));
    }
    for level in 0..6 {
        let y = 0.08 + level as f32 * (height - 0.10) / 5.0;
        mesh.block(m.wood, Vec3::new(x, y, 0.0), Vec3::new(depth - 0.01, 0.024, width + 0.028));
        if level == 5 {
            continue;
        }
        for bay in 0..4u32 {
            let mut z = (bay as f32 - 2.0) * width / 4.0 + 0.03;
            let end = z + width / 4.0 - 0.10 - 0.25 * random(bay + 4 * level, 5);
            let mut book = 0;
            while z < end {
                let chance = |seed| random(book + 64 * (bay + 4 * level), seed);
                let (thick, tall, deep) = (0.022 + 0.03 * chance(6), 0.22 + 0.11 * chance(7), 0.17 + 0.06 * chance(8));
                let corner = Vec3::new(-X + 0.06, y + 0.012, z);
                let cover = m.books[(chance(9) * 4.0) as usize % 4];
                mesh.cuboid(cover, corner, corner + Vec3::new(deep, tall, thick));
                z += thick + 0.002;
                book += 1;
            }
        }
    }
    mesh.block(m.wood, Vec3::new(-X + 0.035, height * 0.5, 0.0), Vec3::new(0.02, height - 0.02, width));
}
