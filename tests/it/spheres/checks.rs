//! Comparisons of pictures: each is fed something wrong.

use rtbench::workloads::size::Size;
use rtbench::workloads::spheres::verify::{self, ALGORITHMS_DIFFER, Exactness};

const SIZE: Size = Size { width: 40, height: 25 };

/// A picture with other values in every pixel.
fn picture() -> Vec<[f32; 4]> {
    (0..SIZE.pixels()).map(|at| [at as f32 / 2000.0, 0.25, 1.0 - at as f32 / 4000.0, 1.0]).collect()
}

#[test]
fn one_bit_of_one_pixel_is_found_and_named() {
    let reference = picture();
    assert!(verify::picture(&reference, &reference, SIZE, 0, Exactness::Bits).ok);
    let mut wrong = reference.clone();
    let at = 7 * 40 + 13;
    wrong[at][1] = f32::from_bits(wrong[at][1].to_bits() + 1);
    let check = verify::picture(&wrong, &reference, SIZE, 3, Exactness::Bits);
    assert!(
        !check.ok && check.message.contains("frame 3 at 40x25: 1 pixels differ; the first is (13, 7)"),
        "{check:?}"
    );
    // A pixel that is missing, one that is not a number
    assert!(!verify::picture(&reference[1..], &reference, SIZE, 0, Exactness::Bits).ok);
    wrong[at][1] = f32::NAN;
    assert!(!verify::picture(&wrong, &reference, SIZE, 0, Exactness::Bits).ok);
}

/// On a GPU one pixel in a hundred may differ by more than two levels, and no more.
#[test]
fn a_gpu_may_differ_in_few_pixels() {
    let reference = picture();
    let changed = |pixels: usize, by: f32| {
        let mut wrong = reference.clone();
        wrong[..pixels].iter_mut().for_each(|pixel| pixel[1] += by / 255.0);
        verify::picture(&wrong, &reference, SIZE, 0, Exactness::Levels).ok
    };
    assert!(changed(1000, 2.0) && changed(10, 100.0));
    assert!(!changed(11, 3.0));
    assert!(!verify::picture(&reference[20..], &reference, SIZE, 0, Exactness::Levels).ok);
    let hits = vec![2; SIZE.pixels()];
    let with_wrong = |wrong: usize, exactness| {
        let mut counted = hits.clone();
        counted[..wrong].iter_mut().for_each(|hits| *hits += 1);
        verify::hits(&counted, &hits, SIZE, 0, exactness)
    };
    assert!(with_wrong(0, Exactness::Bits).ok && with_wrong(10, Exactness::Levels).ok);
    let check = with_wrong(1, Exactness::Bits);
    assert!(!check.ok && check.message.contains("the first is (0, 0): 3 instead of 2"), "{check:?}");
    assert!(!with_wrong(11, Exactness::Levels).ok);
    assert!(!verify::hits(&hits[1..], &hits, SIZE, 0, Exactness::Bits).ok);
}

#[test]
fn the_reference_is_held_to_the_exact_model() {
    let reference = picture();
    let exact = |wrong: usize| -> Vec<[f64; 3]> {
        let mut exact: Vec<[f64; 3]> = reference.iter().map(|p| [p[0], p[1], p[2]].map(f64::from)).collect();
        exact[..wrong].iter_mut().for_each(|pixel| pixel[2] = 0.5);
        exact
    };
    assert!(verify::exact(&reference, &exact(10), 2, 100).ok);
    let check = verify::exact(&reference, &exact(11), 2, 100);
    assert!(!check.ok && check.message.contains("in 11 of 1000 pixels"), "{check:?}");
    // Many small spheres have edges everywhere
    assert!(verify::exact(&reference, &exact(100), 2, 100_000).ok);
    assert!(!verify::exact(&reference, &exact(101), 2, 100_000).ok);
}

#[test]
fn the_algorithms_may_differ_by_rounding_only() {
    let one = picture();
    let mut two = one.clone();
    two[5][0] += 0.5 * ALGORITHMS_DIFFER;
    assert!(verify::algorithms(&one, &two, 5).ok);
    two[5][0] += 2.0 * ALGORITHMS_DIFFER;
    assert!(!verify::algorithms(&one, &two, 5).ok);
    // More factors along a long path, brighter light
    assert!(verify::algorithms(&one, &two, 64).ok);
    let bright = |picture: &[[f32; 4]]| picture.iter().map(|p| p.map(|c| 50.0 * c)).collect::<Vec<_>>();
    assert!(!verify::algorithms(&bright(&one), &two, 5).ok);
    let mut rounded = bright(&one);
    rounded[5][1] += 10.0 * ALGORITHMS_DIFFER;
    assert!(verify::algorithms(&bright(&one), &rounded, 5).ok);
    two[5][0] = f32::NAN;
    assert!(!verify::algorithms(&one, &two, 64).ok);
    assert!(!verify::algorithms(&one, &one[1..], 5).ok);
}

/// A device's half precision may round elsewhere, but must be half precision's picture.
#[test]
fn a_wrong_half_precision_is_found() {
    let single = picture();
    let moved = |by: f32| single.iter().map(|p| [p[0] + by, p[1], p[2], 1.0]).collect::<Vec<_>>();
    let rounded = moved(0.01);
    assert!(verify::half(&rounded, None, &single).ok);
    assert!(verify::half(&moved(0.015), Some(&rounded), &single).ok);
    let check = verify::half(&moved(0.03), Some(&rounded), &single);
    assert!(!check.ok && check.message.contains("half precision on the CPU"), "{check:?}");
    assert!(!verify::half(&rounded[1..], None, &single).ok);
}
