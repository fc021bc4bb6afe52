//! Scenes with light, frames on both devices, and the comparison of all that frames make.

use glam::{Vec3, Vec4};
use rtbench::camera::{Camera, CameraPath};
use rtbench::device::{CpuDevice, VulkanDevice};
use rtbench::math::Vertex;
use rtbench::scene::{Material, Scene, Triangle};
use rtbench::workloads::size::Size;
use rtbench::workloads::splat::gpu::GpuFrame;
use rtbench::workloads::splat::lit::{LitScene, PointLight};
use rtbench::workloads::splat::photons::Photons;
use rtbench::workloads::splat::setting::{Energy, Estimate, EstimateKernel, Falloff, Setting, Weight};
use rtbench::workloads::splat::{CpuFrame, Stages};
use rtbench::workloads::trace::Selection;
use rtbench::workloads::trace::backend::Backend;
use std::sync::Arc;

pub const SETTING: Setting = Setting { paths: 700, hits: 4, seed: 1, falloff: Falloff::Square, energy: Energy::Flux };

/// A scene with lights; its extent is its bounds.
pub fn lit(scene: Scene, lights: &[PointLight]) -> LitScene {
    let extent = scene.bounds();
    LitScene { scene: Arc::new(scene), lights: lights.to_vec(), extent, warnings: Vec::new() }
}

/// A light inside a scene, at these shares of its bounds.
pub fn light_at(scene: &Scene, [x, y, z]: [f32; 3], flux: Vec3) -> PointLight {
    let bounds = scene.bounds();
    PointLight { position: bounds.min + bounds.extent() * Vec3::new(x, y, z), flux }
}

/// The first view of the scene's camera path.
pub fn camera_of(scene: &Scene) -> Camera {
    CameraPath::for_scene(scene, false).views(scene, None).unwrap()[0].camera
}

/// An estimate whose radius is this share of the extent's diagonal.
pub fn estimate(lit: &LitScene, share: f32) -> Estimate {
    Estimate {
        kernel: EstimateKernel::default(),
        weight: Weight::default(),
        form: Default::default(),
        radius: lit.diagonal() * share,
    }
}

/// Quadrilaterals of two triangles each, with a material each.
pub fn quads(quads: &[([Vec3; 4], Vec3)]) -> Scene {
    let mut scene = Scene { name: "quads".to_owned(), ..Scene::default() };
    for (corners, albedo) in quads {
        let first = scene.vertices.len() as u32;
        let material = scene.materials.len() as u32;
        scene.vertices.extend(corners.map(|corner| Vertex::new(corner, Vec3::ZERO)));
        for [b, c] in [[1, 2], [2, 3]] {
            scene.triangles.push(Triangle { vertices: [first, first + b, first + c], material });
        }
        scene.materials.push(Material::matt(*albedo));
    }
    scene
}

/// A closed box from -1 to 1 whose walls have different colours, with highlights of different exponents.
pub fn closed_box() -> Scene {
    let mut walls = Vec::new();
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let corner = |u: f32, v: f32| {
                let mut corner = Vec3::ZERO;
                (corner[axis], corner[(axis + 1) % 3], corner[(axis + 2) % 3]) = (side, u, v);
                corner
            };
            let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
            let albedo = Vec3::new(0.3 + 0.2 * axis as f32, 0.8, 0.45 + 0.1 * side);
            walls.push((corners, albedo));
        }
    }
    let mut scene = quads(&walls);
    for (index, material) in scene.materials.iter_mut().enumerate() {
        material.specular = Vec3::new(0.2, 0.1 * index as f32, 0.3);
        material.exponent = [0.0, 1.0, 2.5, 20.0, 60.3, 5000.0][index];
    }
    scene
}

/// The whole frame of the twins.
pub fn on_cpu(
    device: &CpuDevice,
    lit: &LitScene,
    structure: &str,
    (setting, estimate, size): (Setting, Estimate, Size),
    camera: &Camera,
) -> Stages {
    let selection = Selection::parse(structure).unwrap();
    let built = selection.build(&lit.scene, 1).unwrap();
    let caster = device.prepare(&lit.scene, &*built.structure, selection.method()).unwrap();
    CpuFrame::new(device, caster, lit, setting, estimate, size).render(camera, &|| false).unwrap()
}

/// The whole frame of a Vulkan device.
pub fn on_gpu(
    device: &VulkanDevice,
    lit: &LitScene,
    structure: &str,
    (setting, estimate, size): (Setting, Estimate, Size),
    camera: &Camera,
) -> Stages {
    let selection = Selection::parse(structure).unwrap();
    let built = selection.build(&lit.scene, 1).unwrap();
    let frame = GpuFrame::new(device, lit, &*built.structure, selection.method(), setting, estimate, size);
    frame.unwrap().render(camera, &|| false).unwrap()
}

/// The first element of two arrays that differs in a bit.
fn difference_of(name: &str, a: &[Vec4], b: &[Vec4]) -> Option<String> {
    if a.len() != b.len() {
        return Some(format!("{name}: {} and {} elements", a.len(), b.len()));
    }
    let bits = |v: &Vec4| v.to_array().map(f32::to_bits);
    let differ = |index: &usize| bits(&a[*index]) != bits(&b[*index]);
    let count = (0..a.len()).filter(differ).count();
    let first = (0..a.len()).find(differ)?;
    Some(format!("{name}: {count} of {}, first at {first}: {:?} and {:?}", a.len(), a[first], b[first]))
}

pub fn difference_of_photons(name: &str, a: &Photons, b: &Photons) -> Option<String> {
    difference_of(&format!("positions of {name}"), &a.positions, &b.positions)
        .or_else(|| difference_of(&format!("directions of {name}"), &a.directions, &b.directions))
        .or_else(|| difference_of(&format!("fluxes of {name}"), &a.fluxes, &b.fluxes))
}

/// The first difference between all that two frames made.
pub fn difference(a: &Stages, b: &Stages) -> Option<String> {
    let counts = (a.traced.arrived != b.traced.arrived)
        .then(|| format!("arrived: {:?} and {:?}", a.traced.arrived, b.traced.arrived));
    counts
        .or_else(|| difference_of_photons("slots", &a.traced.slots, &b.traced.slots))
        .or_else(|| difference_of_photons("photons", &a.photons, &b.photons))
        .or_else(|| difference_of("samples", &a.samples.positions, &b.samples.positions))
        .or_else(|| difference_of("normals", &a.samples.normals, &b.samples.normals))
        .or_else(|| difference_of("albedos", &a.samples.albedos, &b.samples.albedos))
        .or_else(|| difference_of("direct", &a.direct, &b.direct))
        .or_else(|| difference_of("irradiance", &a.irradiance, &b.irradiance))
        .or_else(|| difference_of("picture", &a.picture, &b.picture))
}
