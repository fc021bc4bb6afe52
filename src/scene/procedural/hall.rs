//! `hall`: an enclosed museum hall, similar to BART's museum, with two rows of fluted columns under a barrel vault, a
//! polished floor, mirrors on the walls and polished exhibits. The lamps hang inside, and no ray leaves the hall.

use super::mesh::{MaterialId, Mesh, fit, segments};
use super::shapes::{profile, turn};
use super::{Parameter, SceneInfo, Values, accept, assemble};
use crate::scene::{Light, Material, Scene};
use glam::{Affine3A, Vec3};
use std::f32::consts::{PI, TAU};

pub(super) const INFO: SceneInfo = SceneInfo {
    name: "hall",
    character: "enclosed: a museum hall with columns, four lights, many mirrors",
    parameters: &[Parameter::triangles(60_000, 15_000)],
    check: accept,
    build,
};

/// Half the width of the hall.
const WIDTH: f32 = 8.0;
/// Half the length of the hall.
const LENGTH: f32 = 18.0;
/// Height of the lower edge of the vault and of the aisles' ceilings.
const HEIGHT: f32 = 6.0;
/// Half the distance between the two rows of columns, which is half the width of the nave under the vault.
const NAVE: f32 = 4.6;
/// Number of equally spaced columns per row.
const COLUMNS: usize = 7;

fn build(values: &Values) -> Scene {
    let mesh = fit(values.triangles(), geometry);
    let lights = lamps().map(|p| Light::new(p - Vec3::Y * 0.35, Vec3::new(0.34, 0.32, 0.29))).to_vec();
    assemble(mesh, lights, Vec3::ZERO, Some("hall"))
}

/// The positions of the lamps.
fn lamps() -> [Vec3; 4] {
    [-13.0f32, -4.5, 4.5, 13.0].map(|z| Vec3::new(0.0, 6.6, z))
}

/// The z coordinate of column `i` of a row.
fn column_z(i: usize) -> f32 {
    (i as f32 - (COLUMNS - 1) as f32 * 0.5) * 5.2
}

struct Materials {
    tiles: [MaterialId; 2],
    plaster: MaterialId,
    vault: MaterialId,
    stone: MaterialId,
    marble: MaterialId,
    mirror: MaterialId,
    gold: MaterialId,
    chrome: MaterialId,
    dark: MaterialId,
    paintings: [MaterialId; 3],
    glow: MaterialId,
}

fn materials(mesh: &mut Mesh) -> Materials {
    // The ambient light is higher than usual, as a substitute for indirect light from walls and floor.
    let matt = |r, g, b| Material { ambient: Vec3::new(r, g, b) * 0.22, ..Material::matt(Vec3::new(r, g, b)) };
    let mut add = |material| mesh.material(material);
    Materials {
        tiles: [
            add(matt(0.58, 0.54, 0.47).shiny(Vec3::splat(0.4), 80.0, 0.22)),
            add(matt(0.13, 0.12, 0.13).shiny(Vec3::splat(0.4), 80.0, 0.28)),
        ],
        plaster: add(matt(0.66, 0.58, 0.47)),
        vault: add(Material { ambient: Vec3::new(0.25, 0.24, 0.22), ..matt(0.70, 0.68, 0.64) }),
        stone: add(matt(0.60, 0.56, 0.50).shiny(Vec3::splat(0.12), 20.0, 0.0)),
        marble: add(matt(0.52, 0.40, 0.36).shiny(Vec3::splat(0.5), 70.0, 0.12)),
        mirror: add(matt(0.06, 0.06, 0.07).shiny(Vec3::splat(0.6), 200.0, 0.80)),
        gold: add(matt(0.50, 0.36, 0.11).shiny(Vec3::new(0.9, 0.75, 0.4), 50.0, 0.30)),
        chrome: add(matt(0.08, 0.08, 0.09).shiny(Vec3::splat(0.9), 150.0, 0.72)),
        dark: add(matt(0.16, 0.11, 0.08).shiny(Vec3::splat(0.2), 30.0, 0.0)),
        paintings: [add(matt(0.18, 0.28, 0.48)), add(matt(0.55, 0.22, 0.14)), add(matt(0.24, 0.38, 0.20))],
        glow: add(Material { ambient: Vec3::new(1.0, 0.93, 0.80), ..matt(0.4, 0.4, 0.4) }),
    }
}

fn geometry(mesh: &mut Mesh, detail: f32) {
    let m = materials(mesh);
    shell(mesh, &m, detail);
    for i in 0..COLUMNS {
        for x in [-NAVE, NAVE] {
            mesh.place = Affine3A::from_translation(Vec3::new(x, 0.0, column_z(i)));
            column(mesh, &m, detail);
        }
    }
    mesh.place = Affine3A::IDENTITY;
    walls(mesh, &m, detail);
    exhibits(mesh, &m, detail);
    for p in lamps() {
        mesh.place = Affine3A::from_translation(p);
        lamp(mesh, &m, detail);
    }
    mesh.place = Affine3A::IDENTITY;
}

/// Adds floor, walls, ceilings and vault. All of them face inwards and form a closed surface.
fn shell(mesh: &mut Mesh, m: &Materials, detail: f32) {
    for j in 0..36 {
        for i in 0..16 {
            let corner = Vec3::new(i as f32 - WIDTH, 0.0, j as f32 - LENGTH);
            mesh.quad(m.tiles[(i + j) % 2], corner, Vec3::Z, Vec3::X, [1, 1]);
        }
    }
    let (along, up) = (Vec3::Z * (2.0 * LENGTH), Vec3::Y * HEIGHT);
    mesh.quad(m.plaster, Vec3::new(-WIDTH, 0.0, LENGTH), -along, up, [7, 2]);
    mesh.quad(m.plaster, Vec3::new(WIDTH, 0.0, -LENGTH), along, up, [7, 2]);
    let across = Vec3::X * (2.0 * WIDTH);
    mesh.quad(m.plaster, Vec3::new(-WIDTH, 0.0, -LENGTH), across, up, [4, 2]);
    mesh.quad(m.plaster, Vec3::new(WIDTH, 0.0, LENGTH), -across, up, [4, 2]);
    // The ceilings of the aisles extend from the wall to the centre of the beams that carry the vault.
    let aisle = Vec3::X * (WIDTH - NAVE);
    mesh.quad(m.vault, Vec3::new(-WIDTH, HEIGHT, -LENGTH), aisle, along, [2, 14]);
    mesh.quad(m.vault, Vec3::new(NAVE, HEIGHT, -LENGTH), aisle, along, [2, 14]);
    for x in [-NAVE, NAVE] {
        mesh.cuboid(m.stone, Vec3::new(x - 0.55, HEIGHT - 0.75, -LENGTH), Vec3::new(x + 0.55, HEIGHT + 0.12, LENGTH));
        mesh.cuboid(m.marble, Vec3::new(x - 0.62, HEIGHT - 0.12, -LENGTH), Vec3::new(x + 0.62, HEIGHT + 0.02, LENGTH));
    }
    let arch = |u: f32| Vec3::new(NAVE * (PI * u).cos(), HEIGHT + NAVE * (PI * u).sin(), 0.0);
    let cells = [segments(32.0, detail, 8), segments(28.0, detail, 7)];
    mesh.surface(m.vault, cells, [false; 2], |u, v| arch(u) + Vec3::Z * (LENGTH * (1.0 - 2.0 * v)));
    // Ribs over the columns
    for i in 0..COLUMNS {
        let path: Vec<Vec3> =
            (0..=cells[0]).map(|k| arch(k as f32 / cells[0] as f32) + Vec3::Z * column_z(i)).collect();
        mesh.tube(m.stone, &path, |_| 0.16, segments(10.0, detail, 5));
    }
    // The ends of the vault
    let rim: Vec<Vec3> = (0..=cells[0]).map(|k| arch(k as f32 / cells[0] as f32)).collect();
    let front: Vec<Vec3> = rim.iter().map(|p| *p - Vec3::Z * LENGTH).collect();
    let back: Vec<Vec3> = rim.iter().rev().map(|p| *p + Vec3::Z * LENGTH).collect();
    mesh.polygon(m.plaster, &front);
    mesh.polygon(m.plaster, &back);
}

/// Adds a column with an Attic base: plinth, two tori with a scotia, fluted shaft, capital, abacus.
fn column(mesh: &mut Mesh, m: &Materials, detail: f32) {
    let around = segments(40.0, detail, 10);
    mesh.cuboid(m.marble, Vec3::new(-0.52, -0.01, -0.52), Vec3::new(0.52, 0.16, 0.52));
    let base = [
        (0.47, 0.15),
        (0.51, 0.20),
        (0.51, 0.25),
        (0.46, 0.30),
        (0.41, 0.34),
        (0.40, 0.39),
        (0.45, 0.43),
        (0.44, 0.48),
        (0.38, 0.52),
    ];
    mesh.lathe(m.marble, &profile(&base, segments(20.0, detail, 8)), around);
    // The shaft has twelve flutes, and tapers with a slight entasis.
    let flutes = 12.0;
    mesh.surface(m.stone, [segments(96.0, detail, 24), segments(8.0, detail, 3)], [false; 2], |u, v| {
        let swelling = 0.37 - 0.05 * v + 0.02 * (PI * v).sin();
        let (c, s) = turn(u);
        let flute = 0.022 * (0.5 + 0.5 * (u * flutes * TAU).cos());
        Vec3::new(c, 0.0, -s) * (swelling - flute) + Vec3::Y * (0.50 + 4.22 * v)
    });
    let capital = [(0.33, 4.68), (0.36, 4.72), (0.34, 4.78), (0.35, 4.88), (0.42, 4.98), (0.49, 5.06), (0.50, 5.10)];
    mesh.lathe(m.gold, &profile(&capital, segments(16.0, detail, 6)), around);
    mesh.cuboid(m.marble, Vec3::new(-0.54, 5.09, -0.54), Vec3::new(0.54, 5.27, 0.54));
}

/// Adds alternating mirrors and paintings in gilt frames on both walls between the columns, skirting boards, and doors
/// at the ends.
fn walls(mesh: &mut Mesh, m: &Materials, detail: f32) {
    for side in [-1.0f32, 1.0] {
        for i in 0..COLUMNS - 1 {
            let z = (column_z(i) + column_z(i + 1)) * 0.5;
            let picture = match (i + usize::from(side > 0.0)) % 2 {
                0 => m.mirror,
                _ => m.paintings[(i + usize::from(side > 0.0)) % 3],
            };
            // In local coordinates x is along the wall, and z points into the hall.
            let facing = glam::Quat::from_rotation_y(-side * PI * 0.5);
            mesh.place = Affine3A::from_rotation_translation(facing, Vec3::new(side * WIDTH, 2.6, z));
            framed(mesh, m, picture, 3.0, 2.8, detail);
        }
        mesh.place = Affine3A::IDENTITY;
        let x = side * (WIDTH - 0.03);
        mesh.block(m.dark, Vec3::new(x, 0.12, 0.0), Vec3::new(0.08, 0.25, 2.0 * LENGTH - 0.01));
        mesh.place = Affine3A::from_rotation_translation(
            glam::Quat::from_rotation_y(if side < 0.0 { 0.0 } else { PI }),
            Vec3::new(0.0, 2.0, side * LENGTH),
        );
        door(mesh, m, detail);
    }
    mesh.place = Affine3A::IDENTITY;
}

/// Adds a picture with a rounded frame, on the wall z = 0.
fn framed(mesh: &mut Mesh, m: &Materials, picture: MaterialId, width: f32, height: f32, detail: f32) {
    let (w, h) = (width * 0.5, height * 0.5);
    mesh.quad(picture, Vec3::new(-w, -h, 0.05), Vec3::X * width, Vec3::Y * height, [1, 1]);
    let corners = [(-w, -h), (w, -h), (w, h), (-w, h)].map(|(x, y)| Vec3::new(x, y, 0.06));
    for i in 0..4 {
        let (a, b) = (corners[i], corners[(i + 1) % 4]);
        let along = (b - a).normalize() * 0.09;
        mesh.bar(m.gold, a - along, b + along, 0.09, segments(14.0, detail, 6));
    }
}

/// Adds a double door on the wall z = 0, with its centre 2 m above the floor.
fn door(mesh: &mut Mesh, m: &Materials, detail: f32) {
    mesh.block(m.dark, Vec3::new(0.0, -0.2, 0.02), Vec3::new(2.8, 3.6, 0.12));
    for x in [-0.68, 0.68] {
        for (y, h) in [(-1.15, 1.2), (0.45, 1.6)] {
            mesh.block(m.dark, Vec3::new(x, y, 0.09), Vec3::new(0.95, h, 0.08));
        }
        mesh.sphere(m.gold, Vec3::new(x * 0.18, -0.35, 0.16), 0.06, segments(6.0, detail, 2));
    }
    for x in [-1.55, 1.55] {
        mesh.block(m.marble, Vec3::new(x, -0.1, 0.08), Vec3::new(0.30, 3.8, 0.24));
    }
    mesh.block(m.marble, Vec3::new(0.0, 1.95, 0.10), Vec3::new(3.6, 0.32, 0.32));
}

/// Adds exhibits on pedestals along the centre line.
fn exhibits(mesh: &mut Mesh, m: &Materials, detail: f32) {
    for (i, z) in [-10.4f32, -5.2, 0.0, 5.2, 10.4].into_iter().enumerate() {
        mesh.place = Affine3A::from_translation(Vec3::new(0.0, 0.0, z));
        mesh.cuboid(m.stone, Vec3::new(-0.60, -0.01, -0.60), Vec3::new(0.60, 0.14, 0.60));
        mesh.cuboid(m.marble, Vec3::new(-0.48, 0.13, -0.48), Vec3::new(0.48, 0.95, 0.48));
        mesh.cuboid(m.stone, Vec3::new(-0.55, 0.94, -0.55), Vec3::new(0.55, 1.04, 0.55));
        match i {
            1 | 3 => knot(mesh, if i == 1 { m.gold } else { m.chrome }, detail),
            2 => {
                mesh.place = Affine3A::from_scale_rotation_translation(
                    Vec3::splat(0.5),
                    glam::Quat::from_rotation_y(0.7),
                    Vec3::new(0.0, 1.04, z),
                );
                mesh.teapot(m.chrome, m.gold, detail * 0.35);
            }
            _ => mesh.sphere(m.chrome, Vec3::new(0.0, 1.56, 0.0), 0.53, segments(22.0, detail, 4)),
        }
    }
    mesh.place = Affine3A::IDENTITY;
}

/// Adds a trefoil knot of thick wire.
fn knot(mesh: &mut Mesh, material: MaterialId, detail: f32) {
    let rows = segments(160.0, detail, 36);
    let points: Vec<Vec3> = (0..=rows)
        .map(|i| {
            let a = i as f32 / rows as f32 * TAU;
            let (x, y) = (a.sin() + 2.0 * (2.0 * a).sin(), a.cos() - 2.0 * (2.0 * a).cos());
            Vec3::new(x * 0.19, y * 0.19 + 1.62, -(3.0 * a).sin() * 0.19)
        })
        .collect();
    mesh.tube(material, &points, |_| 0.10, segments(16.0, detail, 6));
}

/// Adds a lampshade on a rod from the vault; the light is below it.
fn lamp(mesh: &mut Mesh, m: &Materials, detail: f32) {
    let around = segments(32.0, detail, 8);
    let top = HEIGHT + NAVE - 6.6;
    mesh.bar(m.gold, Vec3::new(0.0, 0.2, 0.0), Vec3::new(0.0, top, 0.0), 0.025, segments(8.0, detail, 4));
    let shade = [(0.60, 0.0), (0.56, 0.09), (0.40, 0.18), (0.16, 0.24), (0.0, 0.25)];
    mesh.lathe(m.gold, &profile(&shade, segments(12.0, detail, 4)), around);
    mesh.disc(m.glow, Vec3::new(0.0, -0.045, 0.0), -Vec3::Y, 0.60, around);
    mesh.lathe_sharp(m.gold, &[(0.60, -0.05), (0.60, 0.0)], around);
}
