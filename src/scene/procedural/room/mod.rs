//! `room`: a furnished room, similar to the conference room. Blinds, window frames, ceiling bars, skirting boards and
//! chair legs are long thin triangles; chairs, cups and lamps are dense meshes between them.

mod furniture;

use super::mesh::{MaterialId, Mesh, fit, segments};
use super::shapes::curve;
use super::{Parameter, SceneInfo, Values, accept, assemble};
use crate::scene::{Light, Material, Scene};
use furniture::{chair, chair_places, cup, shelf, table};
use glam::{Affine3A, Quat, Vec2, Vec3};

pub(super) const INFO: SceneInfo = SceneInfo {
    name: "room",
    character: "furnished room: long thin triangles and dense chairs, six lights, few mirrors",
    parameters: &[Parameter::triangles(80_000, 20_000)],
    check: accept,
    build,
};

/// Half the length of the room.
const X: f32 = 6.0;
/// Half the width of the room.
const Z: f32 = 4.0;
/// Height of the room.
const Y: f32 = 3.1;
/// The x coordinates of the centres of the windows, on the wall z = -Z.
const WINDOWS: [f32; 3] = [-3.9, 0.0, 3.9];
/// Width and height of a window.
const WINDOW: Vec2 = Vec2::new(2.9, 1.7);
/// Height of the lower edge of the windows.
const SILL: f32 = 0.95;

fn build(values: &Values) -> Scene {
    let mesh = fit(values.triangles(), geometry);
    let lights = lamps().map(|p| Light::new(p - Vec3::Y * 0.30, Vec3::new(0.195, 0.19, 0.178))).to_vec();
    assemble(mesh, lights, Vec3::new(0.55, 0.70, 0.90), Some("room"))
}

/// The positions of the lamps on the ceiling.
fn lamps() -> [Vec3; 6] {
    [(-3.6, -1.8), (0.0, -1.8), (3.6, -1.8), (-3.6, 1.8), (0.0, 1.8), (3.6, 1.8)].map(|(x, z)| Vec3::new(x, Y, z))
}

struct Materials {
    wall: MaterialId,
    ceiling: MaterialId,
    carpet: MaterialId,
    wood: MaterialId,
    table: MaterialId,
    white: MaterialId,
    slat: MaterialId,
    metal: MaterialId,
    cloth: MaterialId,
    china: MaterialId,
    glass: MaterialId,
    glow: MaterialId,
    screen: MaterialId,
    books: [MaterialId; 4],
}

fn materials(mesh: &mut Mesh) -> Materials {
    // The ambient light is higher than usual, as a substitute for indirect light from walls and ceiling.
    let matt = |r, g, b| Material { ambient: Vec3::new(r, g, b) * 0.28, ..Material::matt(Vec3::new(r, g, b)) };
    let mut add = |material| mesh.material(material);
    Materials {
        wall: add(matt(0.68, 0.64, 0.56)),
        ceiling: add(Material { ambient: Vec3::splat(0.50), ..matt(0.80, 0.80, 0.78) }),
        carpet: add(matt(0.30, 0.35, 0.40)),
        wood: add(matt(0.40, 0.24, 0.12).shiny(Vec3::splat(0.15), 30.0, 0.0)),
        table: add(matt(0.34, 0.17, 0.08).shiny(Vec3::splat(0.4), 80.0, 0.14)),
        white: add(matt(0.86, 0.87, 0.88).shiny(Vec3::splat(0.2), 40.0, 0.0)),
        slat: add(matt(0.78, 0.76, 0.70).shiny(Vec3::splat(0.2), 30.0, 0.0)),
        metal: add(matt(0.22, 0.22, 0.24).shiny(Vec3::splat(0.8), 90.0, 0.35)),
        cloth: add(matt(0.18, 0.28, 0.48)),
        china: add(matt(0.82, 0.80, 0.76).shiny(Vec3::splat(0.5), 80.0, 0.0)),
        glass: add(matt(0.06, 0.09, 0.12).shiny(Vec3::splat(0.7), 150.0, 0.45)),
        glow: add(Material { ambient: Vec3::splat(0.98), ..matt(0.3, 0.3, 0.3) }),
        screen: add(matt(0.07, 0.08, 0.10).shiny(Vec3::splat(0.6), 100.0, 0.15)),
        books: [
            add(matt(0.45, 0.12, 0.10)),
            add(matt(0.12, 0.30, 0.22)),
            add(matt(0.15, 0.18, 0.40)),
            add(matt(0.62, 0.50, 0.25)),
        ],
    }
}

fn geometry(mesh: &mut Mesh, detail: f32) {
    let m = materials(mesh);
    shell(mesh, &m);
    for x in WINDOWS {
        mesh.place = Affine3A::from_translation(Vec3::new(x, SILL, -Z));
        window(mesh, &m, detail);
    }
    mesh.place = Affine3A::IDENTITY;
    table(mesh, &m, detail);
    for (place, seed) in chair_places() {
        mesh.place = place;
        chair(mesh, &m, detail);
        // There is a cup on the table in front of every other chair, and paper in front of all chairs.
        mesh.place = Affine3A::from_translation(Vec3::Y * 0.76) * mesh.place;
        if seed % 2 == 0 {
            cup(mesh, &m, detail);
        }
        mesh.block(m.white, Vec3::new(-0.02, 0.006, 0.62), Vec3::new(0.21, 0.008, 0.29));
    }
    mesh.place = Affine3A::IDENTITY;
    ceiling(mesh, &m, detail);
    shelf(mesh, &m);
    board_and_door(mesh, &m, detail);
}

fn shell(mesh: &mut Mesh, m: &Materials) {
    let (x, y, z) = (Vec3::X * (2.0 * X), Vec3::Y * Y, Vec3::Z * (2.0 * Z));
    mesh.quad(m.carpet, Vec3::new(-X, 0.0, -Z), z, x, [6, 9]);
    mesh.quad(m.ceiling, Vec3::new(-X, Y, -Z), x, z, [9, 6]);
    mesh.quad(m.wall, Vec3::new(X, 0.0, Z), -x, y, [4, 2]);
    mesh.quad(m.wall, Vec3::new(-X, 0.0, Z), -z, y, [3, 2]);
    mesh.quad(m.wall, Vec3::new(X, 0.0, -Z), z, y, [3, 2]);
    // The wall with the windows consists of the rectangles between and around them.
    let mut piece = |x0: f32, x1: f32, y0: f32, y1: f32| {
        mesh.quad(m.wall, Vec3::new(x0, y0, -Z), Vec3::X * (x1 - x0), Vec3::Y * (y1 - y0), [1, 1]);
    };
    let (low, high) = (SILL, SILL + WINDOW.y);
    piece(-X, X, 0.0, low);
    piece(-X, X, high, Y);
    let mut from = -X;
    for window in WINDOWS {
        piece(from, window - WINDOW.x * 0.5, low, high);
        from = window + WINDOW.x * 0.5;
    }
    piece(from, X, low, high);
    for (center, size) in [
        (Vec3::new(0.0, 0.06, Z), Vec3::new(2.0 * X - 0.01, 0.12, 0.04)),
        (Vec3::new(0.0, 0.06, -Z), Vec3::new(2.0 * X - 0.01, 0.12, 0.04)),
        (Vec3::new(-X, 0.06, 0.0), Vec3::new(0.04, 0.118, 2.0 * Z - 0.01)),
        (Vec3::new(X, 0.06, 0.0), Vec3::new(0.04, 0.118, 2.0 * Z - 0.01)),
    ] {
        mesh.block(m.wood, center, size);
    }
}

/// Adds a recessed window with frame, cross bars, panes, sill, and half-open blinds. The origin is the centre of its
/// lower edge.
fn window(mesh: &mut Mesh, m: &Materials, detail: f32) {
    let (w, h, depth) = (WINDOW.x, WINDOW.y, 0.22);
    let half = w * 0.5;
    let (across, up, back) = (Vec3::X * w, Vec3::Y * h, Vec3::Z * depth);
    // The reveal
    mesh.quad(m.white, Vec3::new(-half, 0.0, -depth), back, across, [1, 1]);
    mesh.quad(m.white, Vec3::new(-half, h, -depth), across, back, [1, 1]);
    mesh.quad(m.white, Vec3::new(-half, 0.0, -depth), up, back, [1, 1]);
    mesh.quad(m.white, Vec3::new(half, 0.0, -depth), back, up, [1, 1]);
    mesh.quad(m.glass, Vec3::new(-half, 0.0, -depth), across, up, [1, 1]);
    let at = -depth + 0.03;
    for x in [-half + 0.03, 0.0, half - 0.03] {
        mesh.block(m.white, Vec3::new(x, h * 0.5, at), Vec3::new(0.06, h - 0.002, 0.058));
    }
    for y in [0.03, h * 0.68, h - 0.03] {
        mesh.block(m.white, Vec3::new(0.0, y, at), Vec3::new(w - 0.002, 0.055, 0.05));
    }
    mesh.block(m.white, Vec3::new(0.0, -0.022, 0.07), Vec3::new(w + 0.2, 0.04, 0.30));
    // A slat has one segment along the window and a few along its curve; both of its sides are modelled.
    let slats = 34;
    let pitch = (h - 0.10) / slats as f32;
    let folds = segments(4.0, detail, 2);
    for i in 0..slats {
        let y = h - 0.08 - (i as f32 + 0.5) * pitch;
        let place = mesh.place;
        mesh.place = place * Affine3A::from_rotation_translation(Quat::from_rotation_x(0.55), Vec3::new(0.0, y, -0.05));
        let bow = |t: f32, lift: f32| Vec3::new(0.0, 0.004 * (1.0 - (2.0 * t - 1.0).powi(2)) + lift, (t - 0.5) * 0.05);
        let left = Vec3::X * (half - 0.02);
        mesh.surface(m.slat, [folds, 1], [false; 2], |u, v| bow(u, 0.0006) + left * (2.0 * v - 1.0));
        mesh.surface(m.slat, [folds, 1], [false; 2], |u, v| bow(u, -0.0006) + left * (1.0 - 2.0 * v));
        mesh.place = place;
    }
    mesh.block(m.slat, Vec3::new(0.0, h - 0.035, -0.05), Vec3::new(w - 0.03, 0.06, 0.06));
    for x in [-half * 0.7, half * 0.7] {
        mesh.bar(m.white, Vec3::new(x, 0.02, -0.015), Vec3::new(x, h - 0.06, -0.015), 0.003, 4);
    }
}

/// Adds bars that divide the ceiling, and flat lamps with a rim.
fn ceiling(mesh: &mut Mesh, m: &Materials, detail: f32) {
    for i in 1..10 {
        let x = -X + i as f32 * 1.2;
        mesh.block(m.white, Vec3::new(x, Y - 0.006, 0.0), Vec3::new(0.024, 0.016, 2.0 * Z - 0.01));
    }
    for j in 1..7 {
        let z = -Z + j as f32 * 8.0 / 7.0;
        mesh.block(m.white, Vec3::new(0.0, Y - 0.005, z), Vec3::new(2.0 * X - 0.01, 0.015, 0.024));
    }
    for p in lamps() {
        mesh.place = Affine3A::from_translation(p);
        let around = segments(40.0, detail, 10);
        mesh.lathe_sharp(m.metal, &[(0.30, -0.07), (0.34, -0.07), (0.34, 0.0)], around);
        mesh.disc(m.glow, Vec3::new(0.0, -0.065, 0.0), -Vec3::Y, 0.31, around);
    }
    mesh.place = Affine3A::IDENTITY;
}

/// Adds a whiteboard and a screen on the wall x = X, and a door on the wall z = Z.
fn board_and_door(mesh: &mut Mesh, m: &Materials, detail: f32) {
    mesh.block(m.white, Vec3::new(X - 0.015, 1.55, -1.2), Vec3::new(0.03, 1.3, 2.4));
    for (y, h) in [(0.90, 0.04), (2.20, 0.04)] {
        mesh.block(m.metal, Vec3::new(X - 0.02, y, -1.2), Vec3::new(0.06, h, 2.48));
    }
    for z in [-2.42, 0.02] {
        mesh.block(m.metal, Vec3::new(X - 0.02, 1.55, z), Vec3::new(0.055, 1.26, 0.04));
    }
    mesh.block(m.metal, Vec3::new(X - 0.07, 0.88, -1.2), Vec3::new(0.12, 0.012, 1.2));
    for i in 0..4 {
        let z = -1.5 + i as f32 * 0.16;
        let pen = [Vec3::new(X - 0.09, 0.895, z), Vec3::new(X - 0.09, 0.895, z + 0.12)];
        mesh.bar(m.books[i % 4], pen[0], pen[1], 0.009, segments(10.0, detail, 5));
    }
    mesh.block(m.metal, Vec3::new(X - 0.04, 1.6, 2.0), Vec3::new(0.07, 1.0, 1.7));
    mesh.block(m.screen, Vec3::new(X - 0.078, 1.6, 2.0), Vec3::new(0.01, 0.94, 1.64));

    mesh.block(m.wood, Vec3::new(-4.2, 1.03, Z - 0.01), Vec3::new(0.95, 2.05, 0.06));
    for x in [-4.72, -3.68] {
        mesh.block(m.white, Vec3::new(x, 1.06, Z - 0.02), Vec3::new(0.09, 2.12, 0.10));
    }
    mesh.block(m.white, Vec3::new(-4.2, 2.11, Z - 0.02), Vec3::new(1.13, 0.10, 0.104));
    let handle = [
        Vec3::new(-3.86, 1.05, Z - 0.03),
        Vec3::new(-3.86, 1.05, Z - 0.09),
        Vec3::new(-3.90, 1.05, Z - 0.10),
        Vec3::new(-4.00, 1.05, Z - 0.10),
    ];
    mesh.rod(m.metal, &curve(&handle, segments(16.0, detail, 6)), 0.011, segments(10.0, detail, 5));
}
