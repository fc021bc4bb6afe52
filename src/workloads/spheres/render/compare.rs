//! How two pictures differ. A picture is linear RGBA, rows from the top.

/// The first pixel, in the order of the rows, at which two pictures have different bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstDifference {
    /// Column.
    pub x: usize,
    /// Row, from the top.
    pub y: usize,
    /// What the first picture has there.
    pub left: [f32; 4],
    /// What the second picture has there.
    pub right: [f32; 4],
    /// Number of pixels that differ.
    pub count: usize,
}

/// Compares bits: 0 and -0 differ. Where a picture has more pixels than the other one, those differ from zeros.
pub fn compare(left: &[[f32; 4]], right: &[[f32; 4]], width: usize) -> Option<FirstDifference> {
    let pixel = |picture: &[[f32; 4]], at: usize| picture.get(at).copied();
    let bits = |pixel: Option<[f32; 4]>| pixel.map(|channels| channels.map(f32::to_bits));
    let differs = |&at: &usize| bits(pixel(left, at)) != bits(pixel(right, at));
    let mut differences = (0..left.len().max(right.len())).filter(differs);
    let first = differences.next()?;
    let at = |picture| pixel(picture, first).unwrap_or_default();
    let width = width.max(1);
    let count = 1 + differences.count();
    Some(FirstDifference { x: first % width, y: first / width, left: at(left), right: at(right), count })
}

/// Differences of the colour channels, clamped to 0 to 1.
fn differences<'a>(left: &'a [[f32; 4]], right: &'a [[f32; 4]]) -> impl Iterator<Item = f64> + 'a {
    let channels = |picture: &'a [[f32; 4]]| picture.iter().flat_map(|pixel| &pixel[..3]).map(|&c| clamped(c));
    channels(left).zip(channels(right)).map(|(a, b)| a - b)
}

/// NaN counts as 0, as it does in a picture of bytes.
fn clamped(channel: f32) -> f64 {
    if channel.is_nan() { 0.0 } else { f64::from(channel).clamp(0.0, 1.0) }
}

/// Root of the mean squared difference of the clamped colour channels, 0 to 1.
pub fn rmse(left: &[[f32; 4]], right: &[[f32; 4]]) -> f64 {
    let sum: f64 = differences(left, right).map(|d| d * d).sum();
    (sum / (3 * left.len()).max(1) as f64).sqrt()
}

/// Largest difference of the clamped colour channels, 0 to 1.
pub fn largest_difference(left: &[[f32; 4]], right: &[[f32; 4]]) -> f64 {
    differences(left, right).map(f64::abs).fold(0.0, f64::max)
}

/// The picture in bytes: channels clamped and rounded to the nearest of 255 steps.
pub fn rgba8(picture: &[[f32; 4]]) -> Vec<[u8; 4]> {
    picture.iter().map(|pixel| pixel.map(|c| (clamped(c) * 255.0).round() as u8)).collect()
}

/// A picture of the absolute differences of the clamped colour channels, times `factor`; alpha is 1.
pub fn difference(left: &[[f32; 4]], right: &[[f32; 4]], factor: f32) -> Vec<[f32; 4]> {
    let channel = |a: f32, b: f32| ((clamped(a) - clamped(b)).abs() as f32) * factor;
    let pixel = |(a, b): (&[f32; 4], &[f32; 4])| [channel(a[0], b[0]), channel(a[1], b[1]), channel(a[2], b[2]), 1.0];
    left.iter().zip(right).map(pixel).collect()
}
