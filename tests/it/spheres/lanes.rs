//! A broken lane is found: each kind of mistake in every lane of every width changes the picture, and the comparison
//! names a pixel of that lane.

use super::support::{self, frame, view};
use rtbench::workloads::spheres::options::{Algorithm, HitRecord, Options, Renderer};
use rtbench::workloads::spheres::render::compare::{FirstDifference, compare};
use rtbench::workloads::spheres::render::reference::{self, Reference};
use rtbench::workloads::spheres::render::{Exit, Fault, FaultKind};
use rtbench::workloads::spheres::scene::PackedSphere;
use rtbench::workloads::spheres::view::View;

const OPTIONS: Options = Options {
    algorithm: Algorithm::OnePass,
    exit_on_miss: true,
    skip_no_hit: true,
    skip_no_discriminant: true,
    hit: HitRecord::Index,
};

/// What is rendered, and what should come of it.
struct Setting {
    spheres: Vec<PackedSphere>,
    view: View,
    references: [Reference; 2],
}

impl Setting {
    /// An odd width: the last vector of a row is partial.
    fn new(scene: &support::Scene, (width, height): (u32, u32), trips: u32) -> Setting {
        let view = view(scene, width, height, trips);
        let spheres = scene.spheres.clone();
        let references =
            [Algorithm::TwoPass, Algorithm::OnePass].map(|algorithm| reference::render(&spheres, &view, algorithm));
        Setting { spheres, view, references }
    }

    /// Every lane hits something, and everywhere some lanes hit while others do not.
    fn usual() -> Setting {
        Setting::new(&support::random(20, 7), (37, 21), 5)
    }

    /// The spheres are so large that many paths are long, and the picture so large that each lane of sixteen is
    /// somewhere the only one of its vector that goes on hitting.
    fn with_long_paths() -> Setting {
        let mut scene = support::random(60, 5);
        scene.spheres.iter_mut().for_each(|sphere| sphere.radius2 *= 4.84);
        Setting::new(&scene, (197, 120), 8)
    }
}

/// The first pixel at which a renderer with a fault has other bits than the reference, as verification finds it; and
/// whether its counts differ.
fn found(setting: &Setting, renderer: Renderer, options: Options, fault: Fault) -> (Option<FirstDifference>, bool) {
    let expected = &setting.references[usize::from(options.algorithm == Algorithm::OnePass)];
    let frame = frame(renderer, options, Some(fault), &setting.spheres, &setting.view);
    let width = setting.view.width as usize;
    assert_eq!(compare(&frame.timed, &frame.counted, width), None, "both are watched");
    let counts = (&frame.counts.rays, &frame.counts.hits) != (&expected.counts.rays, &expected.counts.hits);
    (compare(&frame.timed, &expected.image, width), counts)
}

#[test]
fn a_broken_lane_is_found_at_one_of_its_pixels() {
    let setting = Setting::usual();
    for renderer in support::simd() {
        let Renderer::Simd(lanes, _) = renderer else { unreachable!() };
        for lane in 0..lanes.count() {
            for algorithm in [Algorithm::TwoPass, Algorithm::OnePass] {
                for hit in [HitRecord::InLoop, HitRecord::Index] {
                    let options = Options { algorithm, hit, ..OPTIONS };
                    for kind in [FaultKind::ShiftDistance, FaultKind::DropMask] {
                        let (difference, counts) = found(&setting, renderer, options, Fault { lane, kind });
                        let what = format!("{renderer:?} {options:?} lane {lane} {kind:?}");
                        let difference = difference.unwrap_or_else(|| panic!("not found: {what}"));
                        assert_eq!(difference.x % lanes.count(), lane, "{what}: {difference:?}");
                        assert!(difference.count < 37 * 21 / 2, "{what}: {difference:?}");
                        // A lane that never hits has no reflected rays either
                        assert!(counts || kind == FaultKind::ShiftDistance, "{what}");
                    }
                }
            }
        }
    }
}

/// Where the exit is off, nothing asks.
fn without(exit: Exit, options: Options) -> Options {
    match exit {
        Exit::Miss => Options { exit_on_miss: false, ..options },
        Exit::NoHit => Options { skip_no_hit: false, ..options },
        Exit::NoDiscriminant => Options { skip_no_discriminant: false, ..options },
    }
}

/// Every exit with both algorithms and both kinds of hits.
fn exits() -> Vec<(Exit, Options)> {
    let mut all = Vec::new();
    for exit in [Exit::Miss, Exit::NoHit, Exit::NoDiscriminant] {
        for algorithm in [Algorithm::TwoPass, Algorithm::OnePass] {
            all.extend([HitRecord::InLoop, HitRecord::Index].map(|hit| (exit, Options { algorithm, hit, ..OPTIONS })));
        }
    }
    all
}

#[test]
fn all_for_any_in_an_exit_is_found() {
    let setting = Setting::usual();
    for renderer in support::simd() {
        for (exit, options) in exits() {
            let fault = Fault { lane: 0, kind: FaultKind::AllForAny(exit) };
            let (difference, counts) = found(&setting, renderer, options, fault);
            let what = format!("{renderer:?} {options:?} {exit:?}");
            assert!(difference.is_some() && counts, "not found: {what}");
            assert_eq!(found(&setting, renderer, without(exit, options), fault), (None, false), "{what}");
        }
    }
}

/// An exit that one lane alone needs, of every lane of every width: what differs are pixels of that lane and no others.
#[test]
fn an_exit_that_overlooks_a_lane_is_found_at_its_pixels() {
    let setting = Setting::with_long_paths();
    for renderer in support::simd() {
        let Renderer::Simd(lanes, _) = renderer else { unreachable!() };
        for lane in 0..lanes.count() {
            for (exit, options) in exits() {
                let fault = Fault { lane, kind: FaultKind::Overlook(exit) };
                let (difference, counts) = found(&setting, renderer, options, fault);
                let what = format!("{renderer:?} {options:?} lane {lane} {exit:?}");
                let difference = difference.unwrap_or_else(|| panic!("not found: {what}"));
                assert_eq!(difference.x % lanes.count(), lane, "{what}: {difference:?}");
                // Paths that end too early have fewer rays; a sphere that is left out may uncover another one
                assert!(counts || exit != Exit::Miss, "{what}");
                if lane == 0 {
                    assert_eq!(found(&setting, renderer, without(exit, options), fault), (None, false), "{what}");
                }
            }
        }
    }
}

#[test]
fn the_comparison_names_the_first_pixel_and_counts() {
    let picture = vec![[0.25, 0.5, 0.75, 1.0]; 12];
    assert_eq!(compare(&picture, &picture, 4), None);
    let mut other = picture.clone();
    other[6][1] = f32::from_bits(0.5f32.to_bits() + 1);
    other[11][3] = 0.0;
    let expected = FirstDifference { x: 2, y: 1, left: picture[6], right: other[6], count: 2 };
    assert_eq!(compare(&picture, &other, 4), Some(expected));
    // Bits, not numbers: the signs of zeros count, and equal NaNs are equal
    let (zero, minus, nan) = ([[0.0; 4]; 1], [[-0.0; 4]; 1], [[f32::NAN; 4]; 1]);
    assert!(compare(&zero, &minus, 1).is_some());
    assert_eq!(compare(&nan, &nan, 1), None);
    // A missing pixel is a difference
    assert_eq!(compare(&picture, &picture[..11], 4).map(|d| (d.x, d.y, d.count)), Some((3, 2, 1)));
}
