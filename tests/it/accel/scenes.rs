//! Scenes for the builders' tests, made by hand.

use glam::Vec3;
use rtbench::math::Vertex;
use rtbench::scene::{Material, Scene, Triangle};

/// A scene of separate triangles.
pub fn soup(name: &str, triangles: impl IntoIterator<Item = [Vec3; 3]>) -> Scene {
    let mut scene = Scene { name: name.to_owned(), materials: vec![Material::matt(Vec3::ONE)], ..Scene::default() };
    for corners in triangles {
        let first = scene.vertices.len() as u32;
        scene.vertices.extend(corners.map(|c| Vertex::new(c, Vec3::Z)));
        scene.triangles.push(Triangle { vertices: [first, first + 1, first + 2], material: 0 });
    }
    scene
}

/// Reproducible numbers from 0 to 1 (xorshift).
pub fn numbers(seed: u64) -> impl FnMut() -> f32 {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 40) as f32 / (1 << 24) as f32
    }
}

fn point(next: &mut impl FnMut() -> f32) -> Vec3 {
    Vec3::new(next(), next(), next())
}

/// `count` triangles of about `edge`, anywhere in a cube.
pub fn random(name: &str, count: usize, cube: f32, edge: f32, seed: u64) -> Scene {
    let mut next = numbers(seed);
    soup(
        name,
        (0..count).map(|_| {
            let at = point(&mut next) * cube;
            [at, at + point(&mut next) * edge, at + point(&mut next) * edge]
        }),
    )
}

/// All corners of a random scene, changed.
fn changed(name: &str, count: usize, change: impl Fn(usize, Vec3) -> Vec3) -> Scene {
    let mut scene = random(name, count, 1.0, 0.1, 11);
    for (i, vertex) in scene.vertices.iter_mut().enumerate() {
        vertex.position = change(i, vertex.position);
    }
    scene
}

/// Every next triangle is ten times farther away: greedy splits take one triangle off at a time.
pub fn powers_of_ten() -> Scene {
    let corners = |i: i32| Vec3::splat(10_f32.powi(i / 8) * (1.0 + 0.1 * (i % 8) as f32));
    soup("powers of ten", (-240..240).map(|i| [corners(i), corners(i), corners(i)]))
}

/// Long thin triangles, whose boxes hold little of them, among many small ones: where spatial splits pay.
pub fn beams(count: usize, seed: u64) -> Scene {
    let mut next = numbers(seed);
    soup(
        "beams",
        (0..count).map(|i| {
            let at = point(&mut next);
            if i % 10 == 0 {
                let along = point(&mut next);
                [at * 0.3, at * 0.3 + along, at * 0.3 + along * 0.95 + point(&mut next) * 0.02]
            } else {
                [at, at + point(&mut next) * 0.03, at + point(&mut next) * 0.03]
            }
        }),
    )
}

pub fn ordinary() -> Vec<Scene> {
    let mut mixed = random("tiny ones in a huge one", 600, 0.01, 0.001, 5);
    let huge = soup("huge", [[Vec3::splat(-50.0), Vec3::new(100.0, -50.0, 3.0), Vec3::new(0.0, 100.0, 40.0)]]);
    let first = mixed.vertices.len() as u32;
    mixed.vertices.extend(huge.vertices);
    mixed.triangles.push(Triangle { vertices: [first, first + 1, first + 2], material: 0 });
    vec![
        random("small", 50, 1.0, 0.3, 1),
        random("medium", 6000, 1.0, 0.05, 2),
        random("overlapping", 700, 1.0, 1.0, 3),
        mixed,
        changed("long and thin", 500, |_, p| p * Vec3::new(1000.0, 1.0, 0.01)),
        changed("long thin triangles", 500, |i, p| if i % 3 == 2 { p + Vec3::X * 100.0 } else { p }),
    ]
}

pub fn degenerate() -> Vec<Scene> {
    let triangle = [Vec3::ZERO, Vec3::X, Vec3::Y + Vec3::Z];
    let not_finite = |name: &str, x: f32| {
        changed(name, 300, move |i, mut p| {
            if i % 7 == 0 {
                p[i % 3] = x;
            }
            p
        })
    };
    vec![
        soup("empty", []),
        soup("one triangle", [triangle]),
        soup("two equal triangles", [triangle; 2]),
        soup("five equal triangles", [triangle; 5]),
        soup("thousands of equal triangles", [triangle; 2000]),
        soup("thousands of equal flat triangles", [[Vec3::ZERO, Vec3::X, Vec3::Y]; 2000]),
        soup("one point", [[Vec3::splat(3.0); 3]; 100]),
        soup("one point far away", [[Vec3::splat(-1.0e30); 3]; 100]),
        soup("nothing finite", [[Vec3::NAN; 3], [Vec3::INFINITY; 3]]),
        not_finite("NaN", f32::NAN),
        not_finite("infinite", f32::INFINITY),
        not_finite("infinitely negative", f32::NEG_INFINITY),
        not_finite("the largest float", f32::MAX),
        changed("flat in x", 300, |_, p| p * Vec3::new(0.0, 1.0, 1.0)),
        changed("flat in y", 300, |_, p| Vec3::new(p.x, -7.0, p.z)),
        changed("flat in z", 300, |_, p| p * Vec3::new(1.0, 1.0, 0.0)),
        changed("nearly flat", 300, |_, p| p * Vec3::new(1.0, 1.0, 1.0e-9)),
        changed("collinear on x", 300, |_, p| Vec3::new(p.x, 1.0, 1.0)),
        changed("collinear on z", 300, |_, p| Vec3::new(0.0, 0.0, p.z)),
        changed("collinear on the diagonal", 300, |_, p| Vec3::splat(p.x)),
        soup("without area", (0..300).map(|i| [Vec3::X * i as f32, Vec3::X * i as f32, Vec3::Y])),
        changed("in many planes", 900, |i, p| (p * 5.0).floor() + Vec3::X * (i % 2) as f32),
        changed("negative zero", 300, |i, p| if i % 2 == 0 { -p * 0.0 } else { p.floor() }),
        changed("huge", 300, |_, p| (p - 0.5) * 1.0e30),
        changed("huge and flat", 300, |_, p| (p - 0.5) * Vec3::new(1.0e30, 1.0e30, 0.0)),
        changed("the whole range", 300, |_, p| (p * 2.0 - 1.0) * 3.0e38),
        changed("tiny", 300, |_, p| p * 1.0e-30),
        changed("denormal", 300, |_, p| p * 1.0e-40),
        changed("far away", 300, |_, p| p * 1.0e-3 + 1.0e6),
        changed("from tiny to huge", 300, |i, p| p * 10_f32.powi(i as i32 % 60 - 30)),
    ]
}
