//! Timing a path frame by frame, with frames split as far as a watchdog asks for it.

use super::prepared::GpuPrepared;
use super::rendering::Part;
use crate::camera::View;
use crate::device::VulkanDevice;
use crate::device::vulkan::Buffer;
use crate::error::Result;
use crate::workloads::trace::backend::*;
use std::time::Duration;

/// Most dispatches with uniforms on the device at a time.
const MAX_DISPATCHES: usize = 16_384;

/// The slowest frame of a path may take this many times as long as its first one (the thesis's slowest took 4.1 times
/// the mean); the watchdog must not see it either.
const SLOWEST: u32 = 5;

/// The image of the last timed frame, on the device.
pub(super) struct LastFrame {
    output: Buffer,
    pixels: usize,
    dispatches: u32,
}

impl LastFrame {
    pub fn read(&self, device: &VulkanDevice) -> Result<Timed> {
        Ok(Timed { pixels: device.read(&self.output, self.pixels)?, dispatches: self.dispatches })
    }
}

impl GpuPrepared<'_> {
    /// See [`Prepared::time_path`].
    pub(super) fn time(
        &mut self,
        config: Config,
        views: &[View],
        size: Size,
        interrupted: Interrupted,
    ) -> Result<Vec<FrameTime>> {
        let Some(first_view) = views.first() else {
            return Ok(Vec::new());
        };
        let parts = self.timing_parts(config, first_view, size)?;
        let pipelines = self.pipelines(config, false)?;
        let output = self.image_buffer(size)?;
        let mut times = Vec::with_capacity(views.len());
        for views in views.chunks((MAX_DISPATCHES / parts.len()).max(1)) {
            let rendering = self.rendering(&pipelines, (views, size), &parts, &output)?;
            times.extend(self.device.run_frames(&rendering.frames(), interrupted)?);
        }
        let dispatches = (parts.len() * pipelines.len()) as u32;
        self.last_frame = Some(LastFrame { output, pixels: size.pixels(), dispatches });
        Ok(times)
    }

    /// Parts of a frame for timing: the method's tiles, more of them where a watchdog asks for it.
    fn timing_parts(&mut self, config: Config, view: &View, size: Size) -> Result<Vec<Part>> {
        let bands = self.timing_bands(config, view, size)?;
        let tiles = self.method.tiles;
        Ok(self.parts(size, tiles, tiles.max(bands.div_ceil(tiles))))
    }

    /// Bands per frame for timing: one, unless the frame would keep the device busy for longer than a watchdog likes.
    fn timing_bands(&mut self, config: Config, view: &View, size: Size) -> Result<u32> {
        // A driver that computes on the CPU has no watchdog
        if self.device.info().software_threads() > 0 {
            return Ok(1);
        }
        if let Some(&bands) = self.bands.get(&(config, size)) {
            return Ok(bands);
        }
        let pipelines = self.pipelines(config, false)?;
        let output = self.image_buffer(size)?;
        let narrow = self.parts(size, 1, size.height.div_ceil(64));
        let rendering = self.rendering(&pipelines, (std::slice::from_ref(view), size), &narrow, &output)?;
        // Narrow bands together take longer than the whole, never shorter: they leave more of the device idle
        let mut time = Duration::ZERO;
        for frame in rendering.frames() {
            time += self.device.run(&frame)?;
        }
        let bands = bands_for(time, self.device.options().max_dispatch);
        self.bands.insert((config, size), bands);
        Ok(bands)
    }
}

/// Bands for a path whose first frame takes `frame`, so that none of its dispatches is longer than `most`.
fn bands_for(frame: Duration, most: Duration) -> u32 {
    let bands = (frame * SLOWEST).as_nanos().div_ceil(most.as_nanos().max(1));
    u32::try_from(bands).unwrap_or(u32::MAX).max(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_long_frames_are_cut() {
        let ms = Duration::from_millis;
        assert_eq!(bands_for(ms(0), ms(500)), 1);
        assert_eq!(bands_for(ms(100), ms(500)), 1);
        assert_eq!(bands_for(ms(101), ms(500)), 2);
        assert_eq!(bands_for(ms(1000), ms(500)), 10);
    }
}
