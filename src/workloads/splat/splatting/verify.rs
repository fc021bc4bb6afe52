//! Lists, buckets and the irradiance from both against the twins'.

use super::setting::{Atomics, Order};
use super::{Buckets, Lists};
use crate::record::row::{Check, Metric};
use crate::workloads::splat::verify::{CLOSE, Exactness, SHARE, mean, same};
use glam::Vec4;

/// Largest difference of sums in another order: of buckets as a share of the largest sum, of irradiance as a share of
/// the picture's mean.
pub const SUMS: f32 = 1e-5;

/// Lists against the twin's: where each begins, and its photons as a set, or in their order.
pub fn lists(found: &Lists, expected: &Lists, order: Order, exactness: Exactness) -> Vec<Check> {
    vec![offsets(found, expected, exactness), entries(found, expected, order, exactness)]
}

fn offsets(found: &Lists, expected: &Lists, exactness: Exactness) -> Check {
    let (own, twin) = (&found.offsets, &expected.offsets);
    if exactness == Exactness::Close {
        let ends = own.first() == Some(&0) && own.last().is_some_and(|&end| end as usize == found.entries.len());
        let ok = own.len() == twin.len() && ends && own.is_sorted();
        let message = format!("offsets of {} lists ascend to the end of the entries", found.len());
        return Check { ok, message, metrics: Vec::new() };
    }
    let differs = |index: &usize| own[*index] != twin[*index];
    let length = own.len().min(twin.len());
    let differing = (0..length).filter(differs).count() + own.len().abs_diff(twin.len());
    let message = match (0..length).find(differs) {
        Some(at) => {
            format!("{differing} offsets of lists differ; the first is {at}: {} instead of {}", own[at], twin[at])
        }
        None if differing > 0 => format!("there are {} offsets of lists instead of {}", own.len(), twin.len()),
        None => format!("offsets of {} lists are the twin's", found.len()),
    };
    Check { ok: differing == 0, message, metrics: vec![Metric::new("differing", differing)] }
}

/// Elements that two ascending lists do not have in common, doubled ones included.
fn strangers(a: &[u32], b: &[u32]) -> usize {
    let (mut i, mut j, mut common) = (0, 0, 0);
    while i < a.len() && j < b.len() {
        match a[i].cmp(&b[j]) {
            std::cmp::Ordering::Less => i += 1,
            std::cmp::Ordering::Greater => j += 1,
            std::cmp::Ordering::Equal => (i, j, common) = (i + 1, j + 1, common + 1),
        }
    }
    a.len() + b.len() - 2 * common
}

fn entries(found: &Lists, expected: &Lists, order: Order, exactness: Exactness) -> Check {
    let (mut wrong, mut unordered, mut first) = (found.entries.len().abs_diff(expected.entries.len()), 0, None);
    for cluster in 0..found.len().min(expected.len()) {
        let (own, twin) = (found.of(cluster), expected.of(cluster));
        if own == twin {
            continue;
        }
        let is_sorted = own.is_sorted();
        unordered += usize::from(order == Order::Sorted && !is_sorted);
        let mut ascending = own.to_vec();
        ascending.sort_unstable();
        let strangers = strangers(&ascending, twin);
        wrong += strangers;
        if strangers > 0 && first.is_none() {
            first = Some(cluster);
        }
    }
    // A photon at the border of the radius may be on its other side
    let most = if exactness == Exactness::Close { (expected.entries.len() / SHARE).max(2) } else { 0 };
    let place = first.map_or(String::new(), |cluster| format!("; the first in the list of cluster {cluster}"));
    let message = format!(
        "{wrong} entries of {} are too many or missing (at most {most}), {unordered} lists are not in order{place}",
        expected.entries.len()
    );
    Check { ok: wrong <= most && unordered == 0, message, metrics: vec![Metric::new("differing", wrong)] }
}

/// Buckets against the twin's: whole numbers to the bit, floats within [`SUMS`] of the largest.
pub fn buckets(found: &Buckets, expected: &Buckets, atomics: Atomics, exactness: Exactness) -> Vec<Check> {
    let is_exact = atomics == Atomics::Fixed && exactness == Exactness::Bits;
    let is_scaled = atomics == Atomics::Fixed;
    let (own, twin) = (found.scale, expected.scale);
    let close = (own - twin).abs() <= CLOSE * twin.abs();
    let scale = Check {
        ok: !is_scaled || own.to_bits() == twin.to_bits() || (!is_exact && close),
        message: format!("the scale of buckets is {own:e}, {twin:e} by the twin"),
        metrics: Vec::new(),
    };
    let count = expected.words.len();
    let missing = found.words.len().abs_diff(count);
    let flux = |buckets: &Buckets, word: u32| match (is_scaled, buckets.scale) {
        (false, _) => f32::from_bits(word),
        (true, scale) if scale > 0.0 => word as f32 / scale,
        _ => word as f32,
    };
    let largest = expected.words.iter().map(|&word| flux(expected, word)).fold(0.0, f32::max);
    let (limit, most) = match (is_exact, exactness) {
        (true, _) => (0.0, 0),
        (_, Exactness::Bits) => (SUMS, 0),
        (_, Exactness::Close) => (CLOSE, count / SHARE),
    };
    let differs = |index: &usize| {
        let (own, twin) = (found.words[*index], expected.words[*index]);
        match is_exact {
            true => own != twin,
            false => !((flux(found, own) - flux(expected, twin)).abs() <= largest * limit),
        }
    };
    let all = 0..found.words.len().min(count);
    let differing = all.clone().filter(differs).count() + missing;
    let place = all.clone().find(differs).map_or(String::new(), |at| {
        let [own, twin] = [(found, found.words[at]), (expected, expected.words[at])].map(|(of, word)| flux(of, word));
        format!(
            "; the first is channel {} of direction {} of {}: {own:e} instead of {twin:e}",
            at % 3,
            at / 3 % 54,
            at / 162
        )
    });
    let message = format!("{differing} of {count} sums of buckets differ by more than {limit:e} of the largest{place}");
    let sums = Check { ok: differing <= most, message, metrics: vec![Metric::new("differing", differing)] };
    vec![scale, sums]
}

/// Irradiance against the twin's: to the bit where nothing depends on timing, otherwise within [`SUMS`] of the
/// picture's mean. `is_repeatable` is the technique's.
pub fn irradiance(found: &[Vec4], expected: &[Vec4], is_repeatable: bool, exactness: Exactness, row: u32) -> Check {
    if is_repeatable && exactness == Exactness::Bits {
        return same("irradiance", "the twin's", found, expected, row);
    }
    let scale = mean(expected).max_element() as f32;
    let (limit, most) = match exactness {
        Exactness::Bits => (SUMS, 0),
        Exactness::Close => (CLOSE, expected.len() / SHARE),
    };
    let mut worst = 0.0_f32;
    let mut differing = found.len().abs_diff(expected.len());
    for (own, twin) in found.iter().zip(expected) {
        // The largest of three, of which not a number is the largest
        let far = (*own - *twin).truncate().abs();
        let far = if far.is_nan() { f32::NAN } else { far.max_element() };
        if !(far <= scale * limit) {
            differing += 1;
        }
        if !(far <= worst) {
            worst = far;
        }
    }
    let message = format!(
        "irradiance: {differing} elements differ by more than {limit:e} of the mean (at most {most}), the worst by {:.2e}",
        worst / scale.max(f32::MIN_POSITIVE)
    );
    Check { ok: differing <= most, message, metrics: vec![Metric::new("differing", differing)] }
}
