//! Scenes by hand, views in double precision, and all renderers.

use glam::{DVec3, Vec3};
use rtbench::workloads::spheres::count::Counts;
use rtbench::workloads::spheres::options::{Algorithm, HitRecord, Lanes, Options, Renderer};
use rtbench::workloads::spheres::render::{self, CpuRenderer, Fault};
use rtbench::workloads::spheres::scene::PackedSphere;
use rtbench::workloads::spheres::view::View;

/// No renderer writes these bits.
pub const POISON: [f32; 4] = [f32::from_bits(0xDEAD_BEEF); 4];

/// Spheres and where they are seen from.
pub struct Scene {
    pub spheres: Vec<PackedSphere>,
    pub position: DVec3,
    pub target: DVec3,
    /// Vertical, in degrees.
    pub fov: f64,
    /// Where the light shines.
    pub light: DVec3,
}

pub fn sphere(center: [f32; 3], radius: f32, color: [f32; 3]) -> PackedSphere {
    PackedSphere { center: center.into(), radius2: radius * radius, color: color.into(), pad: 0.0 }
}

/// Numbers from 0 to 1 by a linear congruential generator.
pub fn numbers(seed: u64) -> impl FnMut() -> f32 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / (1u64 << 24) as f32
    }
}

/// Spheres in a box of 20 x 8 x 20; the more there are, the smaller they are. Some of them overlap.
pub fn random(count: usize, seed: u64) -> Scene {
    let mut number = numbers(seed);
    let size = (20.0 / count as f32).cbrt() * 1.2;
    let mut one = |_| {
        let center = [number() * 20.0 - 10.0, number() * 8.0 - 4.0, number() * 20.0 - 10.0];
        sphere(center, size * (0.5 + number()), [number(), number(), number()])
    };
    let spheres = (0..count).map(&mut one).collect();
    Scene { spheres, ..empty() }
}

pub fn empty() -> Scene {
    Scene {
        spheres: Vec::new(),
        position: DVec3::new(4.0, 6.0, 22.0),
        target: DVec3::ZERO,
        fov: 50.0,
        light: DVec3::new(-0.5, -1.0, -0.75),
    }
}

/// A view of `scene`, as the program makes it: in double precision, rounded once.
pub fn view(scene: &Scene, width: u32, height: u32, trips: u32) -> View {
    let forward = (scene.target - scene.position).normalize();
    let right = forward.cross(DVec3::Y).normalize();
    let up = right.cross(forward);
    let pixel = 2.0 * (scene.fov.to_radians() / 2.0).tan() / f64::from(height);
    let (right, down) = (right * pixel, -up * pixel);
    let corner = forward - right * f64::from(width) / 2.0 - down * f64::from(height) / 2.0;
    View {
        origin: scene.position.as_vec3(),
        epsilon: 1e-3,
        corner: corner.as_vec3(),
        intensity: 0.5,
        right: right.as_vec3(),
        half: 0.5,
        down: down.as_vec3(),
        one: 1.0,
        light: (-scene.light.normalize()).as_vec3(),
        two: 2.0,
        light_color: Vec3::new(0.8, 0.75, 0.7),
        far: rtbench::math::T_MAX,
        ambient: Vec3::new(0.1, 0.12, 0.15),
        spheres: scene.spheres.len() as u32,
        width,
        height,
        trips,
        pad: 0,
    }
}

/// What a renderer makes of a frame, both ways.
pub struct Frame {
    pub timed: Vec<[f32; 4]>,
    pub counted: Vec<[f32; 4]>,
    pub hits: Vec<u32>,
    pub counts: Counts,
}

pub fn frame(
    renderer: Renderer,
    options: Options,
    fault: Option<Fault>,
    spheres: &[PackedSphere],
    view: &View,
) -> Frame {
    let pool = rtbench::threads::pool(2).unwrap();
    let made = CpuRenderer::new(renderer, options, &pool).unwrap();
    let made = match fault {
        Some(fault) => made.with_fault(fault),
        None => made,
    };
    let pixels = (view.width * view.height) as usize;
    let (mut timed, mut counted) = (vec![POISON; pixels], vec![POISON; pixels]);
    let mut hits = vec![u32::MAX; pixels];
    made.render(spheres, view, &mut timed);
    let counts = made.count(spheres, view, &mut counted, &mut hits);
    Frame { timed, counted, hits, counts }
}

pub const LANES: [Lanes; 3] = [Lanes::Four, Lanes::Eight, Lanes::Sixteen];

/// SIMD renderers of one thread, of every width at every level of this processor.
pub fn simd() -> Vec<Renderer> {
    let levels = render::levels();
    assert!(!levels.is_empty(), "this processor has no level");
    let at = |lanes| levels.iter().map(move |&level| Renderer::Simd(lanes, Some(level))).collect::<Vec<_>>();
    LANES.into_iter().flat_map(at).collect()
}

/// Options of one algorithm in every combination of the switches; for scalar renderers without those of SIMD.
pub fn switches(algorithm: Algorithm, simd: bool) -> Vec<Options> {
    let both = [false, true];
    let mut all = Vec::new();
    for exit_on_miss in both {
        for skip_no_hit in both {
            for skip_no_discriminant in both {
                for hit in [HitRecord::InLoop, HitRecord::Index] {
                    if simd || !(skip_no_hit || skip_no_discriminant) {
                        all.push(Options { algorithm, exit_on_miss, skip_no_hit, skip_no_discriminant, hit });
                    }
                }
            }
        }
    }
    all
}
