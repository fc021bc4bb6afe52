//! What the counters say: the same rays and hits by every renderer, and how often each exit was taken.

use super::support::{self, Frame, frame, sphere, switches, view};
use rtbench::workloads::spheres::options::{Algorithm, HitRecord, Lanes, Options, Renderer};
use rtbench::workloads::spheres::render::{self, CpuRenderer, reference};

const NO_EXITS: Options = Options {
    algorithm: Algorithm::OnePass,
    exit_on_miss: false,
    skip_no_hit: false,
    skip_no_discriminant: false,
    hit: HitRecord::Index,
};

fn best(lanes: Lanes) -> Renderer {
    Renderer::Simd(lanes, None)
}

#[test]
fn searches_vectors_and_exits_add_up() {
    let scene = support::random(20, 3);
    let (width, height, trips) = (37, 21, 4);
    let view = view(&scene, width, height, trips);
    let expected = reference::render(&scene.spheres, &view, Algorithm::OnePass).counts;
    let rays: u64 = expected.rays.iter().sum();
    let pixels = u64::from(width * height);
    assert_eq!(expected.rays[0], pixels);
    for trip in 1..trips as usize {
        assert_eq!(expected.rays[trip], expected.hits[trip - 1], "each hit makes a ray");
    }

    let off = frame(Renderer::Sequential, NO_EXITS, None, &scene.spheres, &view).counts;
    assert_eq!((off.searches, off.vectors, off.exits_on_miss), (pixels * u64::from(trips), 0, 0));
    let exits = Options { exit_on_miss: true, ..NO_EXITS };
    let on = frame(Renderer::Sequential, exits, None, &scene.spheres, &view).counts;
    assert_eq!((on.searches, on.vectors), (rays, 0), "no search is wasted");
    // Each path that does not use all its trips ends at its miss; in the last trip there is nothing to be left out
    let all_trips = expected.rays[trips as usize - 1];
    assert_eq!(on.exits_on_miss, pixels - all_trips);

    for lanes in support::LANES {
        let count = lanes.count() as u64;
        let vectors = u64::from(width).div_ceil(count) * u64::from(height);
        let off = frame(best(lanes), NO_EXITS, None, &scene.spheres, &view).counts;
        assert_eq!((off.vectors, off.searches), (vectors * u64::from(trips), vectors * u64::from(trips) * count));
        let on = frame(best(lanes), exits, None, &scene.spheres, &view).counts;
        assert_eq!(on.searches, on.vectors * count);
        let occupancy = rays as f64 / on.searches as f64;
        assert!(occupancy > 0.0 && occupancy <= 1.0, "{occupancy}");
        assert!(on.searches < off.searches && on.searches >= rays);
        assert!(on.exits_on_miss > 0 && on.exits_on_miss <= vectors);
        assert_eq!((off.skips_no_hit, off.skips_no_discriminant), (0, 0));
    }
}

#[test]
fn skips_are_counted_for_each_switch() {
    let scene = support::random(20, 3);
    let view = view(&scene, 40, 20, 3);
    let of = |skip_no_hit, skip_no_discriminant, lanes| {
        let options = Options { skip_no_hit, skip_no_discriminant, ..NO_EXITS };
        let counts = frame(best(lanes), options, None, &scene.spheres, &view).counts;
        (counts.skips_no_hit, counts.skips_no_discriminant, counts.vectors * 20)
    };
    for lanes in support::LANES {
        let (hit, discriminant, tests) = of(true, true, lanes);
        assert!(0 < discriminant && discriminant < hit && hit < tests, "{discriminant} {hit} {tests}");
        assert_eq!(of(true, false, lanes), (hit, 0, tests), "no hit without a discriminant");
        assert_eq!(of(false, true, lanes), (0, discriminant, tests));
    }
    // The wider a vector, the fewer of its searches can be skipped
    let share = |lanes| of(true, true, lanes).1 as f64 / of(true, true, lanes).2 as f64;
    assert!(share(Lanes::Four) > share(Lanes::Eight) && share(Lanes::Eight) > share(Lanes::Sixteen));
}

#[test]
fn one_sphere_in_the_middle_is_counted_by_hand() {
    // Four pixels; the sphere covers all of the picture, and its reflections leave it
    let spheres = vec![sphere([0.0, 0.0, 0.0], 5.0, [0.5; 3])];
    let scene = support::Scene { spheres, position: glam::DVec3::new(0.0, 0.0, 8.0), fov: 10.0, ..support::empty() };
    let view = view(&scene, 2, 2, 5);
    let all = Options { exit_on_miss: true, skip_no_hit: true, skip_no_discriminant: true, ..NO_EXITS };
    let Frame { counts, hits, .. } = frame(best(Lanes::Four), all, None, &scene.spheres, &view);
    assert_eq!(hits, [1; 4]);
    assert_eq!((counts.rays, counts.hits), (vec![4, 4, 0, 0, 0], vec![4, 0, 0, 0, 0]));
    // Two rows of one vector, two lanes of each beyond the row's end
    assert_eq!((counts.vectors, counts.searches, counts.exits_on_miss), (4, 16, 2));
    // In the second search all four discriminants may be positive: the sphere lies behind
    assert_eq!(counts.skips_no_hit, 2);
}

#[test]
fn counts_are_equal_over_threads_and_levels() {
    let scene = support::random(20, 9);
    let view = view(&scene, 33, 17, 5);
    for options in switches(Algorithm::TwoPass, true) {
        for lanes in support::LANES {
            let of = |renderer| frame(renderer, options, None, &scene.spheres, &view).counts;
            let one = of(best(lanes));
            for level in render::levels() {
                assert_eq!(of(Renderer::Simd(lanes, Some(level))), one, "{level:?}");
            }
            assert_eq!(of(Renderer::SimdThreads(lanes, None, 3)), one);
        }
    }
    for options in switches(Algorithm::TwoPass, false) {
        let of = |renderer| frame(renderer, options, None, &scene.spheres, &view).counts;
        assert_eq!(of(Renderer::Threads(3)), of(Renderer::Sequential));
    }
}

#[test]
fn a_renderer_says_what_it_runs_on_and_refuses_what_is_absent() {
    use rtbench::workloads::spheres::options::Level;
    let pool = rtbench::threads::pool(2).unwrap();
    let made = |renderer| CpuRenderer::new(renderer, NO_EXITS, &pool);
    let scalar = made(Renderer::Sequential).unwrap();
    assert!(scalar.instructions().starts_with(std::env::consts::ARCH), "{}", scalar.instructions());
    assert_eq!(scalar.threads(), 1);
    assert_eq!(made(Renderer::Threads(0)).unwrap().threads(), 2);
    assert_eq!(made(Renderer::Threads(5)).unwrap().threads(), 5);
    assert_eq!(made(Renderer::SimdThreads(Lanes::Four, None, 1)).unwrap().threads(), 1);
    let best = render::best_level().unwrap();
    assert_eq!(made(Renderer::Simd(Lanes::Four, None)).unwrap().instructions(), best.name());
    for (name, level) in Level::ALL {
        let made = made(Renderer::Simd(Lanes::Eight, Some(level)));
        if render::levels().contains(&level) {
            assert_eq!(made.unwrap().instructions(), name);
        } else {
            let error = made.err().unwrap().to_string();
            assert!(error.starts_with(&format!("unsupported: level {name}")) && error.contains(best.name()), "{error}");
            assert_eq!(level == Level::Neon, error.contains("untested"), "{error}");
        }
    }
    assert!(made(Renderer::Gpu).is_err());
}
