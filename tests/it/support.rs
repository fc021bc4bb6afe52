//! What several modules need: small scenes, random numbers, the GPU if there is one, files of others.

use glam::Vec3;
use rtbench::camera::{Camera, View};
use rtbench::device::vulkan::{Selector, VulkanOptions, adapters, adapters_with, choose};
use rtbench::device::{Features, VulkanDevice};
use rtbench::math::Vertex;
use rtbench::scene::{Light, Material, Scene, Triangle};
use rtbench::workloads::trace::backend::GivenRay;
use std::path::PathBuf;
use std::sync::OnceLock;

/// A scene's name with the stems of its files only: folders of tests have other names each time.
pub fn short(name: &str) -> String {
    let (files, options) = name.split_at(name.find(':').unwrap_or(name.len()));
    files.split('+').map(rtbench::names::stem).collect::<Vec<_>>().join("+") + options
}

/// Numbers between -1 and 1 from a small generator of our own: the same on every machine.
pub fn random(seed: u32) -> impl FnMut() -> f32 {
    let mut state = seed.wrapping_mul(0x9e37_79b9) ^ 0x85eb_ca6b;
    move || {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        (state >> 8) as f32 / 8_388_608.0 - 1.0
    }
}

/// Random triangles in the box from -1 to 1, some of them without area or twice the same. Flat ones lie in the planes
/// of a lattice, many at exactly equal distances from a ray; some are off their plane by a few units in the last place.
pub fn soup(triangles: usize, seed: u32, flat: bool) -> Scene {
    let mut random = random(seed);
    let mut scene = Scene { name: format!("soup-{triangles}-{seed}"), ..Scene::default() };
    let size = (8.0 / (triangles as f32).sqrt()).clamp(0.02, 0.8);
    for index in 0..triangles {
        let mut point = |scale: f32| Vec3::new(random(), random(), random()) * scale;
        let center = point(1.0);
        let mut corners = [center, center + point(size), center + point(size)];
        if flat {
            corners = corners.map(|p| (p * 4.0).round() / 4.0);
            let axis = index % 3;
            let off = (index % 5) as i32 - 2;
            let plane = corners[0][axis] + off as f32 * 6.0e-8;
            corners.iter_mut().for_each(|corner| corner[axis] = plane);
        }
        if index % 29 == 7 {
            corners[2] = corners[1];
        }
        let first = scene.vertices.len() as u32;
        scene.vertices.extend(corners.map(|p| Vertex::new(p, Vec3::ZERO)));
        scene.triangles.push(Triangle { vertices: [first, first + 1, first + 2], material: 0 });
        if index % 31 == 11 {
            scene.triangles.push(Triangle { vertices: [first + 2, first, first + 1], material: 0 });
        }
    }
    scene.materials.push(Material::matt(Vec3::splat(0.7)));
    scene.lights.push(Light::new(Vec3::new(2.0, 3.0, 1.0), Vec3::ONE));
    scene.background = Vec3::new(0.1, 0.1, 0.2);
    scene
}

/// A view whose middle looks along a ray, almost as narrow as the ray.
pub fn view_along(ray: &GivenRay) -> View {
    let (position, direction) = (ray.origin, ray.direction.normalize());
    View {
        camera: Camera { position, direction, up: direction.any_orthonormal_vector(), field_of_view: 0.01 },
        lights: Vec::new(),
    }
}

fn open(options: VulkanOptions) -> Option<VulkanDevice> {
    match choose(&adapters(), &Selector::Best).and_then(|best| VulkanDevice::open(best, options)) {
        Ok(gpu) => Some(gpu),
        // .ci/run sets RTBENCH_REQUIRE_GPU, so that a missing driver cannot pass for a passed test
        Err(error) if std::env::var_os("RTBENCH_REQUIRE_GPU").is_none() => {
            eprintln!("not run: {error}");
            None
        }
        Err(error) => panic!("RTBENCH_REQUIRE_GPU is set, but {error}"),
    }
}

/// The best Vulkan device, one for all tests so that kernels are compiled once; without one, says so and returns
/// nothing.
pub fn gpu() -> Option<&'static VulkanDevice> {
    static GPU: OnceLock<Option<VulkanDevice>> = OnceLock::new();
    let gpu = GPU.get_or_init(|| open(VulkanOptions::default())).as_ref();
    if gpu.is_none() {
        eprintln!("not run: needs a Vulkan device");
    }
    gpu
}

/// A device of one's own that was opened with these features and no others; without a device that has them, says so and
/// returns nothing.
pub fn gpu_with(features: Features) -> Option<VulkanDevice> {
    let all = adapters_with(features);
    let gpu = match choose(&all, &Selector::Best).and_then(|best| VulkanDevice::open(best, VulkanOptions::default())) {
        Ok(gpu) => gpu,
        Err(error) if std::env::var_os("RTBENCH_REQUIRE_GPU").is_none() => {
            eprintln!("not run: {error}");
            return None;
        }
        Err(error) => panic!("RTBENCH_REQUIRE_GPU is set, but {error}"),
    };
    if !features.missing_in(gpu.features()).is_empty() {
        eprintln!("not run: {} lacks one of {:?}", gpu.info().name, features.iter().collect::<Vec<_>>());
        return None;
    }
    Some(gpu)
}

/// A device of one's own, with or without wgpu's shader checks.
pub fn own_gpu(checked: bool) -> Option<VulkanDevice> {
    open(VulkanOptions { checked, ..VulkanOptions::default() })
}

/// A device of one's own.
pub fn gpu_of(options: VulkanOptions) -> Option<VulkanDevice> {
    open(options)
}

/// A file below the folder named by an environment variable; without it, says so and returns nothing.
pub fn file_below(variable: &str, path: &str) -> Option<PathBuf> {
    let Some(folder) = std::env::var_os(variable) else {
        eprintln!("not run: {variable} is not set; it names the folder with {path}");
        return None;
    };
    let file = PathBuf::from(folder).join(path);
    assert!(file.exists(), "{variable} is set, but {} does not exist", file.display());
    Some(file)
}

/// A file of `tests/data`.
pub fn data(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)
}

/// The rows of a CSV file by column.
pub fn csv_rows(path: &std::path::Path) -> Vec<std::collections::BTreeMap<String, String>> {
    csv::Reader::from_path(path).unwrap().deserialize().collect::<Result<_, _>>().unwrap()
}
