//! Comparisons of pictures, as checks of a row. Each says what it compared, how much differs, and the limit.

use super::render::compare::{compare, rgba8, rmse};
use crate::record::row::{Check, Metric};
use crate::workloads::size::Size;

/// Pixels of the reference that may differ from the model in double precision by more than [`LEVELS`]: 1 in 100. They
/// are at edges, where a ray passes or hits by rounding.
const EXACT_SHARE: usize = 100;

/// With more spheres than this, which are smaller, edges are everywhere in the small image: 1 pixel in 10 may differ.
const MANY_SPHERES: usize = 2000;
const EXACT_SHARE_OF_MANY: usize = 10;

/// Pixels that may differ by more than [`LEVELS`] on a GPU, which contracts and approximates: 1 in 100.
const GPU_SHARE: usize = 100;

/// Differences of a channel of so many of 255 levels are rounding.
const LEVELS: u8 = 2;

/// The largest difference of a channel of at most 1 between the two algorithms, which multiply the same factors in
/// another order. Brighter channels may differ by more, in proportion, and so may long paths, which have more factors.
pub const ALGORITHMS_DIFFER: f32 = 1e-6;

/// Rays along a path for which [`ALGORITHMS_DIFFER`] is meant.
const USUAL_TRIPS: u32 = 8;

/// Whether a renderer must make the reference's bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exactness {
    /// The CPU, and drivers that compute on it.
    Bits,
    /// A GPU.
    Levels,
}

/// Pixels of which a channel differs by more than [`LEVELS`] of 255 levels; a pixel that is missing on one side counts.
fn beyond_levels(left: &[[u8; 4]], right: &[[u8; 4]]) -> usize {
    let differs = |(a, b): &(&[u8; 4], &[u8; 4])| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > LEVELS);
    left.iter().zip(right).filter(differs).count() + left.len().abs_diff(right.len())
}

/// A renderer's picture against the reference's.
pub fn picture(rendered: &[[f32; 4]], reference: &[[f32; 4]], size: Size, frame: usize, exactness: Exactness) -> Check {
    let Size { width, height } = size;
    let place = format!("frame {frame} at {width}x{height}");
    let first = compare(rendered, reference, width as usize);
    let differing = first.map_or(0, |first| first.count);
    let found = first.map(|first| {
        let [is, should] = [first.left, first.right].map(|pixel| format!("{:?}", &pixel[..3]));
        format!("{differing} pixels differ; the first is ({}, {}): {is} instead of {should}", first.x, first.y)
    });
    let (ok, message) = match (found, exactness) {
        (None, _) => (true, format!("{place}: every bit is the reference's")),
        (Some(found), Exactness::Bits) => (false, format!("{place}: {found}")),
        (Some(found), Exactness::Levels) => {
            let beyond = beyond_levels(&rgba8(rendered), &rgba8(reference));
            let most = reference.len() / GPU_SHARE;
            let levels = format!("{beyond} of them by more than {LEVELS} levels (at most {most})");
            (beyond <= most, format!("{place}: {found}, {levels}"))
        }
    };
    let metrics = vec![Metric::new("pixels", reference.len()), Metric::new("pixels_differing", differing)];
    Check { ok, message, metrics }
}

/// The reference's picture against that of the model in double precision.
pub fn exact(reference: &[[f32; 4]], exact: &[[f64; 3]], trips: u32, spheres: usize) -> Check {
    let exact: Vec<[f32; 4]> = exact.iter().map(|&[r, g, b]| [r as f32, g as f32, b as f32, 1.0]).collect();
    let (pixels, beyond) = (reference.len(), beyond_levels(&rgba8(reference), &rgba8(&exact)));
    let most = pixels / if spheres > MANY_SPHERES { EXACT_SHARE_OF_MANY } else { EXACT_SHARE };
    let message = format!(
        "the reference differs from the model in double precision in {beyond} of {pixels} pixels by more than {LEVELS} \
         levels (at most {most}, at edges), with {trips} rays a path"
    );
    Check { ok: beyond <= most, message, metrics: vec![Metric::new("pixels_differing", beyond)] }
}

/// The pictures of both algorithms against each other. What is no number in both of them agrees.
pub fn algorithms(one_pass: &[[f32; 4]], two_pass: &[[f32; 4]], trips: u32) -> Check {
    let longer = trips.max(USUAL_TRIPS) as f32 / USUAL_TRIPS as f32;
    let (mut largest, mut beyond) = (0.0_f32, one_pass.len().abs_diff(two_pass.len()));
    for (a, b) in one_pass.iter().flatten().zip(two_pass.iter().flatten()) {
        if a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan()) {
            continue;
        }
        let share = (a - b).abs() / a.abs().max(b.abs()).max(1.0);
        largest = largest.max(share);
        // Not a number on one side is a difference as well
        beyond += usize::from(!(share <= ALGORITHMS_DIFFER * longer));
    }
    let limit = ALGORITHMS_DIFFER * longer;
    let message = format!(
        "{beyond} channels of both algorithms' references differ by more than {limit:e}, the largest by {largest:e} \
         (of the channel where it is above 1)"
    );
    Check { ok: beyond == 0, message, metrics: Vec::new() }
}

/// A picture in half precision against single precision's: how far it is. A device's, which may round in other places,
/// may be no farther from the one that is rounded after every operation than that one is from single precision.
pub fn half(image: &[[f32; 4]], rounded: Option<&[[f32; 4]]>, single: &[[f32; 4]]) -> Check {
    let from_single = rmse(image, single);
    let mut message = format!("half precision differs by {from_single:.4} (RMSE) from single precision");
    let mut ok = image.len() == single.len();
    if let Some(rounded) = rounded {
        let (from_rounded, limit) = (rmse(image, rounded), rmse(rounded, single));
        message += &format!(", and by {from_rounded:.4} from half precision on the CPU (at most {limit:.4})");
        ok &= from_rounded <= limit;
    }
    Check { ok, message, metrics: Vec::new() }
}

/// Live hits of each pixel against the reference's; on a GPU, where edges differ, only their number.
pub fn hits(counted: &[u32], reference: &[u32], size: Size, frame: usize, exactness: Exactness) -> Check {
    let place = format!("frame {frame} at {}x{}", size.width, size.height);
    let differing = counted.iter().zip(reference).filter(|(a, b)| a != b).count();
    let differing = differing + counted.len().abs_diff(reference.len());
    let first = counted.iter().zip(reference).position(|(a, b)| a != b).map_or(String::new(), |at| {
        let (x, y) = (at % size.width.max(1) as usize, at / size.width.max(1) as usize);
        format!("; the first is ({x}, {y}): {} instead of {}", counted[at], reference[at])
    });
    let most = if exactness == Exactness::Bits { 0 } else { reference.len() / GPU_SHARE };
    let message = format!("{place}: {differing} pixels count other hits than the reference (at most {most}){first}");
    Check { ok: differing <= most, message, metrics: vec![Metric::new("hits_differing", differing)] }
}
