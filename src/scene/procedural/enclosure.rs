//! `box`: a closed room with coloured walls. No light leaves it.

use super::mesh::{MaterialId, Mesh, fit, segments};
use super::{Parameter, SceneInfo, Values, accept, assemble};
use crate::scene::{Light, Material, Scene};
use glam::Vec3;

pub(super) const INFO: SceneInfo = SceneInfo {
    name: "box",
    character: "closed room: a red and a green wall, two floating blocks, a light inside",
    parameters: &[
        Parameter::triangles(12_000, 400),
        Parameter {
            name: "albedo",
            meaning: "albedo of all surfaces in percent; 0: each has its own colour",
            default: 0,
            min: 0,
            max: 100,
        },
    ],
    check: accept,
    build,
};

/// Corners of room and blocks, in metres.
const ROOM: [Vec3; 2] = [Vec3::new(-2.0, 0.0, -2.5), Vec3::new(2.0, 3.0, 2.5)];
const BLOCKS: [[Vec3; 2]; 2] = [
    [Vec3::new(-1.3, 0.2, -1.6), Vec3::new(-0.3, 1.9, -0.7)],
    [Vec3::new(0.4, 0.15, -0.4), Vec3::new(1.3, 0.95, 0.55)],
];

fn build(values: &Values) -> Scene {
    let albedo = values.get("albedo");
    let mesh = fit(values.triangles(), |mesh, detail| {
        let mut matt = |r, g, b| {
            let colour = if albedo > 0 { Vec3::splat(albedo as f32 / 100.0) } else { Vec3::new(r, g, b) };
            mesh.material(Material::matt(colour))
        };
        let [red, green] = [matt(0.63, 0.07, 0.06), matt(0.14, 0.48, 0.10)];
        let [grey, first, second] = [matt(0.73, 0.73, 0.73), matt(0.70, 0.66, 0.55), matt(0.55, 0.62, 0.72)];
        let room = Cuboid { corners: ROOM, materials: [red, green, grey, grey, grey, grey], inwards: true };
        room.add(mesh, detail);
        for (corners, material) in BLOCKS.into_iter().zip([first, second]) {
            Cuboid { corners, materials: [material; 6], inwards: false }.add(mesh, detail * 1.3);
        }
    });
    let light = Light::new(Vec3::new(0.5, 2.4, 0.6), Vec3::ONE);
    assemble(mesh, vec![light], Vec3::ZERO, Some("box"))
}

/// A box whose faces meet in the same vertices' positions.
struct Cuboid {
    corners: [Vec3; 2],
    /// Of the lower and the upper face along x, y and z.
    materials: [MaterialId; 6],
    inwards: bool,
}

impl Cuboid {
    /// Adds it with about `detail` cells a metre.
    fn add(&self, mesh: &mut Mesh, detail: f32) {
        let size = self.corners[1] - self.corners[0];
        let cells = size.to_array().map(|length| segments(length, detail, 1));
        for (face, &material) in self.materials.iter().enumerate() {
            let (axis, upper) = (face / 2, face % 2);
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            if !mesh.announce(2 * cells[u] * cells[v]) {
                continue;
            }
            let mut normal = Vec3::ZERO;
            let ascends = (upper == 1) != self.inwards;
            normal[axis] = if ascends { 1.0 } else { -1.0 };
            let row = cells[u] as u32 + 1;
            let first = mesh.vertices.len() as u32;
            for j in 0..=cells[v] {
                for i in 0..=cells[u] {
                    let mut point = self.corners[upper];
                    point[u] = self.coordinate(u, i, cells[u]);
                    point[v] = self.coordinate(v, j, cells[v]);
                    mesh.vertex(point, normal);
                }
            }
            for j in 0..cells[v] as u32 {
                for i in 0..cells[u] as u32 {
                    let a = first + j * row + i;
                    let (b, c, d) = (a + 1, a + row + 1, a + row);
                    for [p, q, r] in [[a, b, c], [a, c, d]] {
                        mesh.triangle(material, if ascends { [p, q, r] } else { [p, r, q] });
                    }
                }
            }
        }
    }

    /// The same for every face that has it.
    fn coordinate(&self, axis: usize, cell: usize, cells: usize) -> f32 {
        let [low, high] = self.corners.map(|corner| corner[axis]);
        if cell == cells { high } else { low + (high - low) * (cell as f32 / cells as f32) }
    }
}
