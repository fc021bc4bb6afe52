//! Closed meshes, and rays that aim at their vertices, edges and faces.

use crate::support::random;
use glam::Vec3;
use rtbench::math::Vertex;
use rtbench::scene::{Light, Material, Scene, Triangle};
use rtbench::workloads::trace::backend::GivenRay;
use std::collections::HashMap;

/// A scene of one matt material and one light.
pub fn scene(name: &str, positions: &[Vec3], triangles: &[[u32; 3]]) -> Scene {
    Scene {
        name: name.to_owned(),
        vertices: positions.iter().map(|&p| Vertex::new(p, Vec3::ZERO)).collect(),
        triangles: triangles.iter().map(|&vertices| Triangle { vertices, material: 0 }).collect(),
        materials: vec![Material::matt(Vec3::splat(0.7))],
        lights: vec![Light::new(Vec3::new(0.1, 0.2, 0.3), Vec3::ONE)],
        background: Vec3::new(0.1, 0.1, 0.2),
        ..Scene::default()
    }
}

/// A sphere of 20 * 4^levels triangles around `center`.
pub fn icosphere(levels: u32, center: Vec3, radius: f32) -> Scene {
    let g = (1.0 + 5.0_f32.sqrt()) / 2.0;
    let corners = [(-1.0, g), (1.0, g), (-1.0, -g), (1.0, -g)];
    let mut points: Vec<Vec3> = corners.iter().map(|&(x, y)| Vec3::new(x, y, 0.0)).collect();
    points.extend(corners.iter().map(|&(y, z)| Vec3::new(0.0, y, z)));
    points.extend(corners.iter().map(|&(z, x)| Vec3::new(x, 0.0, z)));
    points.iter_mut().for_each(|p| *p = p.normalize());
    // The faces are the triples of mutually nearest corners
    let near = |a: usize, b: usize| points[a].distance(points[b]) < 1.1;
    let mut faces = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            faces.extend((b + 1..12).filter(|&c| near(a, b) && near(b, c) && near(a, c)).map(|c| [a, b, c]));
        }
    }
    let mut faces: Vec<[u32; 3]> = faces.iter().map(|face| face.map(|corner| corner as u32)).collect();
    for _ in 0..levels {
        let mut middles = HashMap::new();
        let mut middle = |a: u32, b: u32, points: &mut Vec<Vec3>| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                points.push((points[a as usize] + points[b as usize]).normalize());
                points.len() as u32 - 1
            })
        };
        faces = faces
            .iter()
            .flat_map(|&[a, b, c]| {
                let (ab, bc, ca) = (middle(a, b, &mut points), middle(b, c, &mut points), middle(c, a, &mut points));
                [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
            })
            .collect();
    }
    let points: Vec<Vec3> = points.iter().map(|&p| center + p * radius).collect();
    scene(&format!("icosphere-{levels}"), &points, &faces)
}

/// A closed box from -size to size whose walls are n x n squares of two triangles.
pub fn room(n: u32, size: Vec3) -> Scene {
    let mut index = HashMap::new();
    let (mut points, mut faces) = (Vec::new(), Vec::new());
    for axis in 0..3 {
        for side in [0, n] {
            let corner = |i: u32, j: u32| {
                let mut place = [side; 3];
                (place[(axis + 1) % 3], place[(axis + 2) % 3]) = (i, j);
                place
            };
            for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                let corners = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
                let [a, b, c, d] = corners.map(|place| {
                    *index.entry(place).or_insert_with(|| {
                        points.push((Vec3::from(place.map(|p| p as f32)) * (2.0 / n as f32) - 1.0) * size);
                        points.len() as u32 - 1
                    })
                });
                faces.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
    scene(&format!("room-{n}"), &points, &faces)
}

/// Random triangles with integer corners, many of them in planes of the lattice or without area.
pub fn lattice(triangles: usize, size: u32, seed: u32) -> Scene {
    let mut random = random(seed);
    let mut whole = |size: u32| ((random() * 0.5 + 0.5) * (size + 1) as f32).floor().min(size as f32);
    let mut points = Vec::new();
    for index in 0..triangles {
        let corner = Vec3::new(whole(size), whole(size), whole(size));
        for _ in 0..3 {
            let mut point = corner + Vec3::new(whole(2), whole(2), whole(2)) - 1.0;
            if index % 2 == 0 {
                point[index / 2 % 3] = corner[index / 2 % 3];
            }
            points.push(point);
        }
    }
    let faces: Vec<[u32; 3]> = (0..triangles as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    scene(&format!("lattice-{triangles}-{seed}"), &points, &faces)
}

/// What a ray aims at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Aim {
    /// A vertex.
    Vertex,
    /// A point of an edge, as near as floats come.
    Edge,
    /// A point of a face.
    Face,
}

/// Rays at a mesh from random points at `distance` from `center`, directions not normalised.
pub fn aimed(scene: &Scene, aim: Aim, (center, distance): (Vec3, f32), count: usize, seed: u32) -> Vec<GivenRay> {
    let mut random = random(seed);
    let mut unit = || random() * 0.5 + 0.5;
    let mut rays = Vec::with_capacity(count);
    while rays.len() < count {
        let triangle = ((unit() * scene.triangles.len() as f32) as u32).min(scene.triangles.len() as u32 - 1);
        let [a, b, c] = scene.corners(triangle).map(Vec3::from);
        let (u, v) = (unit(), unit());
        let target = match aim {
            Aim::Vertex => a,
            Aim::Edge => a + (b - a) * u,
            Aim::Face => a + (b - a) * (u * 0.5) + (c - a) * (v * 0.5),
        };
        let direction = Vec3::new(unit(), unit(), unit()) * 2.0 - 1.0;
        let origin = center + direction.normalize_or(Vec3::X) * distance;
        if target != origin {
            rays.push(GivenRay { origin, direction: target - origin });
        }
    }
    rays
}
