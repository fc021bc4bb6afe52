//! Sums of counters over the frames of a path.

use super::backend::{Prepared, Size};
use super::rays::Config;
use super::record::{ByRayType, CounterSums};
use crate::camera::View;
use crate::error::Result;
use crate::math::MISS;

/// The share of rays that ropes are given up for, in percent, from which a row has a warning.
const GIVEN_UP: f64 = 1.0;

/// What the counting kernel found along a path.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Counted {
    /// Sums by ray type.
    pub sums: ByRayType<CounterSums>,
    /// The first frame, RGBA8.
    pub first_image: Vec<u8>,
    /// Frames in which no primary ray hits anything.
    pub empty: Vec<usize>,
    /// Frames in which every primary ray hits something nearer than the surface epsilon.
    pub blocked: Vec<usize>,
}

impl Counted {
    /// What is odd about the frames: a camera that looks past the scene, or is inside of a surface.
    pub fn warnings(&self, frames: usize) -> Vec<String> {
        let what = "no primary ray hits the scene";
        let near = "every primary ray hits a surface directly at the camera";
        let of = |found: &[usize], what: &str| {
            let first = found.first()?;
            Some(format!("{what} in {} of {frames} frames (the first: {first}): check the camera path", found.len()))
        };
        [of(&self.empty, what), of(&self.blocked, near)].into_iter().flatten().chain(self.given_up()).collect()
    }

    /// Searches by ropes that are given up are exact, but they are not what a row about ropes is to show.
    fn given_up(&self) -> Option<String> {
        let sum = |of: fn(&CounterSums) -> u64| self.sums.iter().map(of).sum::<u64>();
        let (given_up, rays) = (sum(|sums| sums.fallbacks), sum(|sums| sums.rays));
        let percent = 100.0 * given_up as f64 / rays.max(1) as f64;
        (percent > GIVEN_UP).then(|| {
            format!(
                "{percent:.1} % of the rays are finished without ropes: they start in a plane of the tree, or pass edges \
                 of cells"
            )
        })
    }
}

/// Renders every frame once with the counting kernel. `epsilon` is the surface epsilon. `frame_done` is asked after
/// each frame whether to go on.
///
/// # Errors
/// The device's, or those of `frame_done`.
pub fn count(
    tracer: &mut dyn Prepared,
    config: Config,
    views: &[View],
    (size, epsilon): (Size, f32),
    frame_done: &mut dyn FnMut() -> Result<()>,
) -> Result<Counted> {
    let mut counted = Counted { first_image: Vec::with_capacity(size.pixels() * 4), ..Counted::default() };
    for (frame, view) in views.iter().enumerate() {
        let (mut hits, mut farthest) = (0, 0.0f32);
        tracer.counted(config, view, size, &mut |_, pixels| {
            for pixel in pixels {
                if pixel.pixel.triangle != MISS {
                    hits += 1;
                    farthest = farthest.max(f32::from_bits(pixel.t));
                }
                for (sum, counters) in counted.sums.iter_mut().zip(&pixel.counters) {
                    sum.add(counters);
                }
                if frame == 0 {
                    counted.first_image.extend_from_slice(&pixel.pixel.rgba.to_le_bytes());
                }
            }
        })?;
        if hits == 0 {
            counted.empty.push(frame);
        } else if hits == size.pixels() && farthest < epsilon {
            counted.blocked.push(frame);
        }
        frame_done()?;
    }
    Ok(counted)
}
