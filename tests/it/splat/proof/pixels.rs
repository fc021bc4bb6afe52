//! The fixed pixels.

use rtbench::workloads::size::Size;
use rtbench::workloads::splat::reference::pixels::fixed_pixels;

#[test]
fn fixed_pixels_are_different_and_even() {
    let size = Size { width: 320, height: 240 };
    let pixels = fixed_pixels(size, 2000);
    assert_eq!(pixels.len(), 2000);
    assert!(pixels.windows(2).all(|pair| pair[0] < pair[1]));
    assert!(pixels.iter().all(|&pixel| (pixel as usize) < size.pixels()));
    // Of 64 parts of the image each has its 31 or so
    let mut parts = [0; 64];
    pixels.iter().for_each(|pixel| parts[(pixel / 320 / 30 * 8 + pixel % 320 / 40) as usize] += 1);
    assert!(parts.iter().all(|part| (15..=48).contains(part)), "{parts:?}");

    let small = Size { width: 7, height: 3 };
    assert_eq!(fixed_pixels(small, 2000), (0..21).collect::<Vec<_>>());
    assert!(fixed_pixels(small, 0).is_empty());
    assert_eq!(fixed_pixels(small, 1).len(), 1);
}
