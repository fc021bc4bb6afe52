//! Pictures: PNG files, and a colour map for heat maps.

use crate::error::{Error, Result};
use crate::record::files;
use image::{ExtendedColorType, ImageEncoder, codecs::png::PngEncoder};
use std::path::Path;

/// Where a run's folder has the pictures of its scenes: `SCENE.png`, and `SCENE` + [`STEPS`] + `.png` with each pixel's
/// steps.
pub const FOLDER: &str = "pictures";
/// Behind the scene's name in the heat map's.
pub const STEPS: &str = "-steps";

/// Writes RGBA8 rows from the top as a PNG.
///
/// # Errors
/// [`Error::Output`].
pub fn write_png(path: &Path, width: u32, height: u32, rgba: &[u8]) -> Result<()> {
    let mut bytes = Vec::new();
    PngEncoder::new(&mut bytes)
        .write_image(rgba, width, height, ExtendedColorType::Rgba8)
        .map_err(|e| Error::output(path, std::io::Error::other(e)))?;
    files::replace(path, &bytes)
}

/// A colour for a value from 0 (nothing) to 1 (most): RGBA8.
///
/// Lightness rises evenly in OKLab, so that the order of two values can be seen, also in print and by people who do not
/// see all hues, while the hue turns from blue by way of red to yellow. Where a colour leaves sRGB, its chroma gives
/// way, never its lightness.
pub fn heat(value: f32) -> [u8; 4] {
    let value = if value.is_finite() { value.clamp(0.0, 1.0) } else { 1.0 };
    let lightness = 0.10 + 0.87 * value;
    let hue = (270.0 + 200.0 * value).to_radians();
    let mut chroma = 0.04 + 0.19 * (std::f32::consts::PI * (0.08 + 0.84 * value)).sin();
    loop {
        let linear = from_oklab(lightness, chroma * hue.cos(), chroma * hue.sin());
        if linear.iter().all(|c| (0.0..=1.0).contains(c)) {
            let [r, g, b] = linear.map(to_srgb);
            return [r, g, b, 255];
        }
        if chroma < 0.001 {
            let grey = to_srgb(linear[1].clamp(0.0, 1.0));
            return [grey, grey, grey, 255];
        }
        chroma *= 0.96;
    }
}

/// Values as colours, `top` and everything above it in the brightest: RGBA8.
pub fn heat_map(values: &[u32], top: u32) -> Vec<u8> {
    let top = top.max(1) as f32;
    values.iter().flat_map(|&value| heat(value as f32 / top)).collect()
}

/// The value that one in two hundred exceeds: a few extreme pixels shall not darken all the others. 0 for no values.
pub fn percentile_99_5(values: &[u32]) -> u32 {
    let mut sorted = values.to_vec();
    let place = values.len().saturating_sub(1) - values.len() / 200;
    match sorted.is_empty() {
        true => 0,
        false => *sorted.select_nth_unstable(place).1,
    }
}

/// OKLab to linear sRGB (B. Ottosson, "A perceptual color space for image processing", 2020).
fn from_oklab(lightness: f32, a: f32, b: f32) -> [f32; 3] {
    let l = (lightness + 0.396_337_8 * a + 0.215_803_76 * b).powi(3);
    let m = (lightness - 0.105_561_346 * a - 0.063_854_17 * b).powi(3);
    let s = (lightness - 0.089_484_18 * a - 1.291_485_5 * b).powi(3);
    [
        4.076_741_7 * l - 3.307_711_6 * m + 0.230_969_94 * s,
        -1.268_438 * l + 2.609_757_4 * m - 0.341_319_4 * s,
        -0.004_196_086_3 * l - 0.703_418_6 * m + 1.707_614_7 * s,
    ]
}

/// A linear channel as an sRGB byte; what is above 1 is white.
pub fn to_srgb(linear: f32) -> u8 {
    let encoded = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    (encoded * 255.0).round() as u8
}
