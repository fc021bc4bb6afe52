//! Long thin cones that grow out of a surface.

use super::mesh::{MaterialId, Mesh};
use super::noise::random;
use crate::math::Vertex;
use crate::scene::Triangle;
use glam::Vec3;

/// Triangles of a spike: rings of quads, and a tip.
pub const TRIANGLES: usize = SIDES.len() * (2 * RINGS - 1);

/// Rings of corners along a spike.
const RINGS: usize = 5;

/// Corners of a ring, counter-clockwise: constants, since sines differ in their last bits between platforms.
const SIDES: [(f32, f32); 6] =
    [(1.0, 0.0), (0.5, 0.866_025_4), (-0.5, 0.866_025_4), (-1.0, 0.0), (-0.5, -0.866_025_4), (0.5, -0.866_025_4)];

/// Radius where a spike begins, below the surface, in metres, and how deep that is.
const RADIUS: f32 = 0.02;
const ROOT: f32 = 0.02;

/// Shortest and longest spike, in metres.
const LENGTH: (f32, f32) = (0.2, 0.6);

/// How far a spike leans away from the normal of the surface.
const LEAN: f32 = 0.4;

const SEED: u32 = 47;

/// Adds `count` spikes at vertices of the mesh, which has normals.
pub fn grow(mesh: &mut Mesh, count: usize, material: MaterialId) {
    let ground = mesh.vertices.len();
    for spike in 0..count as u32 {
        let number = |i: u32| random(spike * 8 + i, SEED);
        let Vertex { position, normal, .. } = mesh.vertices[(number(0) * ground as f32) as usize % ground];
        let lean = Vec3::new(number(1), number(2), number(3)) * 2.0 - 1.0;
        let along = (normal + lean * LEAN).normalize_or(normal);
        let length = LENGTH.0 + (LENGTH.1 - LENGTH.0) * number(4);
        add(mesh, position - along * ROOT, along, length, material);
    }
}

/// Adds one spike from `root`.
fn add(mesh: &mut Mesh, root: Vec3, along: Vec3, length: f32, material: MaterialId) {
    let (x, y) = (across(along), along.cross(across(along)));
    let first = mesh.vertices.len() as u32;
    for ring in 0..RINGS {
        let share = ring as f32 / RINGS as f32;
        let (centre, radius) = (root + along * (length * share), RADIUS * (1.0 - share));
        let corner = |(a, b): (f32, f32)| Vertex::new(centre + (x * a + y * b) * radius, Vec3::ZERO);
        mesh.vertices.extend(SIDES.map(corner));
    }
    let tip = mesh.vertices.len() as u32;
    mesh.vertices.push(Vertex::new(root + along * length, Vec3::ZERO));
    let sides = SIDES.len() as u32;
    let mut triangle = |vertices: [u32; 3]| mesh.triangles.push(Triangle { vertices, material });
    for ring in 0..RINGS as u32 {
        for side in 0..sides {
            let (a, b) = (first + ring * sides + side, first + ring * sides + (side + 1) % sides);
            if ring + 1 == RINGS as u32 {
                triangle([a, b, tip]);
            } else {
                triangle([a, b, b + sides]);
                triangle([a, b + sides, a + sides]);
            }
        }
    }
}

/// A unit vector at a right angle.
fn across(along: Vec3) -> Vec3 {
    let other = if along.y.abs() < 0.9 { Vec3::Y } else { Vec3::X };
    along.cross(other).normalize_or(Vec3::X)
}
