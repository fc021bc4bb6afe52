//! A sphere and a room by hand, with light; what casts rays in them, and their photons.

use glam::Vec3;
use rtbench::camera::Camera;
use rtbench::device::{CpuDevice, Device};
use rtbench::math::Vertex;
use rtbench::scene::{Material, Scene, Triangle};
use rtbench::workloads::size::Size;
use rtbench::workloads::splat::cpu;
use rtbench::workloads::splat::lit::{LitScene, PointLight};
use rtbench::workloads::splat::photons::{Photons, Traced};
use rtbench::workloads::splat::setting::{Energy, Falloff, Setting};
use rtbench::workloads::trace::backend::Prepared;
use rtbench::workloads::trace::{Selection, tracer};
use std::sync::{Arc, LazyLock};

/// Threads of all proofs.
static DEVICE: LazyLock<Device> = LazyLock::new(|| Device::Cpu(CpuDevice::new(0).unwrap()));

/// Never.
pub const ON: &dyn Fn() -> bool = &|| false;

pub fn pool() -> &'static rayon::ThreadPool {
    match &*DEVICE {
        Device::Cpu(device) => device.pool(),
        Device::Vulkan(_) => unreachable!(),
    }
}

/// Calls `use_it` with a caster of the scene; rays of a bounce do not go together, so no packets.
pub fn cast_in<R>(lit: &LitScene, use_it: impl FnOnce(&mut dyn Prepared) -> R) -> R {
    let selection = Selection::parse("bvh-stack").unwrap();
    let built = selection.build(&lit.scene, 0).unwrap();
    let mut caster = tracer::prepare(&DEVICE, &lit.scene, &*built.structure, selection.method()).unwrap();
    use_it(&mut *caster)
}

pub fn setting(paths: u32, hits: u32, seed: u32) -> Setting {
    Setting { paths, hits, seed, falloff: Falloff::Square, energy: Energy::Flux }
}

pub fn traced(caster: &mut dyn Prepared, lit: &LitScene, setting: Setting) -> Traced {
    let shares = lit.shares(setting.paths).unwrap();
    cpu::trace(pool(), caster, lit, &shares, &setting, ON).unwrap()
}

/// Those of one hit number, or of any set of them.
pub fn of_hits(photons: &Photons, hits: impl Fn(u32) -> bool) -> Photons {
    let mut kept = photons.clone();
    kept.positions.iter_mut().filter(|position| !hits(position.w as u32)).for_each(|position| position.w = 0.0);
    kept.compacted()
}

fn lit(scene: Scene, position: Vec3, flux: Vec3) -> LitScene {
    scene.check().unwrap();
    let extent = scene.bounds();
    let lights = vec![PointLight { position, flux }];
    LitScene { scene: Arc::new(scene), lights, extent, warnings: Vec::new() }
}

fn add(scene: &mut Scene, corners: [Vec3; 3], material: u32) {
    let first = scene.vertices.len() as u32;
    scene.vertices.extend(corners.map(|corner| Vertex::new(corner, Vec3::ZERO)));
    scene.triangles.push(Triangle { vertices: [first, first + 1, first + 2], material });
}

/// A parallelogram from a corner along two edges.
fn add_quad(scene: &mut Scene, corner: Vec3, [u, v]: [Vec3; 2], material: u32) {
    add(scene, [corner, corner + u, corner + u + v], material);
    add(scene, [corner, corner + u + v, corner + v], material);
}

/// Light of the sphere, three fifths of the radius off its centre.
pub const SPHERE_LIGHT: Vec3 = Vec3::new(0.36, -0.48, 0.0);

/// The sphere of radius 1 around the origin, 83,232 triangles: an octahedron's faces in a lattice, lifted.
pub fn sphere(albedo: f32, flux: Vec3) -> LitScene {
    const SIDE: i32 = 102;
    let mut scene = Scene { name: "integrating sphere".into(), ..Scene::default() };
    scene.materials.push(Material::matt(Vec3::splat(albedo)));
    for signs in (0..8).map(|n| Vec3::new([1.0, -1.0][n & 1], [1.0, -1.0][n >> 1 & 1], [1.0, -1.0][n >> 2])) {
        // Integers before the division: both faces at an edge have the same bits
        let point = |i: i32, j: i32| (Vec3::new(i as f32, j as f32, (SIDE - i - j) as f32) * signs).normalize();
        for i in 0..SIDE {
            for j in 0..SIDE - i {
                add(&mut scene, [point(i, j), point(i + 1, j), point(i, j + 1)], 0);
                if i + j + 2 <= SIDE {
                    add(&mut scene, [point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)], 0);
                }
            }
        }
    }
    assert!(scene.triangles.len() >= 80_000);
    lit(scene, SPHERE_LIGHT, flux)
}

/// The room's sides.
pub const ROOM: Vec3 = Vec3::new(4.0, 3.0, 5.0);

/// Its light.
pub const ROOM_LIGHT: Vec3 = Vec3::new(1.6, 2.1, 2.2);

/// A closed room, left wall red and right wall green, the others grey, and a block that floats in it.
pub fn room() -> LitScene {
    let mut scene = walls([[0.7, 0.2, 0.15], [0.2, 0.6, 0.2], [0.7, 0.7, 0.65]], None);
    let (low, high) = (Vec3::new(2.3, 0.4, 1.4), Vec3::new(3.3, 1.4, 2.2));
    let [x, y, z] = [Vec3::X * (high.x - low.x), Vec3::Y * (high.y - low.y), Vec3::Z * (high.z - low.z)];
    for (corner, edges) in
        [(low, [x, y]), (low + z, [x, y]), (low, [y, z]), (low + x, [y, z]), (low, [x, z]), (low + y, [x, z])]
    {
        add_quad(&mut scene, corner, edges, 2);
    }
    lit(scene, ROOM_LIGHT, Vec3::new(60.0, 55.0, 50.0))
}

/// An empty room of one albedo, with the same light.
pub fn bare_room(albedo: Vec3) -> LitScene {
    lit(walls([albedo.into(); 3], None), ROOM_LIGHT, Vec3::new(60.0, 55.0, 50.0))
}

/// An empty room with a hole in its ceiling: from and to, in x and z.
pub fn open_room(hole: [[f32; 2]; 2]) -> LitScene {
    lit(walls([[0.5; 3]; 3], Some(hole)), ROOM_LIGHT, Vec3::ONE)
}

fn walls([left, right, other]: [[f32; 3]; 3], hole: Option<[[f32; 2]; 2]>) -> Scene {
    let mut scene = Scene { name: "room".into(), ..Scene::default() };
    scene.materials.extend([left, right, other].map(|colour| Material::matt(colour.into())));
    let [x, y, z] = [Vec3::X * ROOM.x, Vec3::Y * ROOM.y, Vec3::Z * ROOM.z];
    for (corner, edges, material) in
        [(Vec3::ZERO, [y, z], 0), (x, [y, z], 1), (Vec3::ZERO, [x, z], 2), (Vec3::ZERO, [x, y], 2), (z, [x, y], 2)]
    {
        add_quad(&mut scene, corner, edges, material);
    }
    let Some([[x0, z0], [x1, z1]]) = hole else {
        add_quad(&mut scene, y, [x, z], 2);
        return scene;
    };
    // Four strips around the hole; their seams need not be watertight for what it is used for
    for [[from_x, from_z], [to_x, to_z]] in
        [[[0.0, 0.0], [x0, ROOM.z]], [[x1, 0.0], [ROOM.x, ROOM.z]], [[x0, 0.0], [x1, z0]], [[x0, z1], [x1, ROOM.z]]]
    {
        let edges = [Vec3::X * (to_x - from_x), Vec3::Z * (to_z - from_z)];
        add_quad(&mut scene, Vec3::new(from_x, ROOM.y, from_z), edges, 2);
    }
    scene
}

/// Of the room's views.
pub const ROOM_SIZE: Size = Size { width: 320, height: 240 };

/// From the front of the room to its back.
pub fn room_camera() -> Camera {
    let direction = Vec3::new(0.05, -0.1, -1.0).normalize();
    Camera { position: Vec3::new(1.9, 1.6, 4.8), direction, up: Vec3::Y, field_of_view: 60.0 }
}
