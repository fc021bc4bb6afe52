//! Sums of counters over the frames of a path.

use super::backend::{Prepared, Size};
use super::rays::Config;
use super::record::CounterSums;
use crate::camera::View;
use crate::error::Result;

/// Renders every frame once with the counting kernel. Returns the sums by ray type, and the first frame, RGBA8.
/// `frame_done` is asked after each frame whether to go on.
///
/// # Errors
/// The device's, or those of `frame_done`.
pub fn count(
    tracer: &mut dyn Prepared,
    config: Config,
    views: &[View],
    size: Size,
    frame_done: &mut dyn FnMut() -> Result<()>,
) -> Result<([CounterSums; 3], Vec<u8>)> {
    let mut sums = [CounterSums::default(); 3];
    let mut first_image = Vec::with_capacity(size.pixels() * 4);
    for (frame, view) in views.iter().enumerate() {
        tracer.counted(config, view, size, &mut |_, pixels| {
            for pixel in pixels {
                for (sum, counters) in sums.iter_mut().zip(&pixel.counters) {
                    sum.add(counters);
                }
                if frame == 0 {
                    first_image.extend_from_slice(&pixel.pixel.rgba.to_le_bytes());
                }
            }
        })?;
        frame_done()?;
    }
    Ok((sums, first_image))
}
