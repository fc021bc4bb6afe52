//! Builders on a Vulkan device.

mod curve;
mod kernels;
pub mod lbvh;
mod passes;
pub mod ploc;

pub use kernels::kernels;
pub use passes::Job;

use crate::device::{FrameTime, Stage};

/// What a build takes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BuildTimes {
    /// Milliseconds from the triangles on the device to the finished tree there: by the device's timestamps, or without
    /// them by the host's clock.
    pub total_ms: f64,
    /// Milliseconds of each stage by the device's timestamps; empty without them.
    pub stages: Vec<(&'static str, f64)>,
    /// Milliseconds until vertices and triangle references are on the device.
    pub upload_ms: f64,
}

impl BuildTimes {
    fn add(&mut self, (stages, time): (Vec<Stage>, FrameTime)) {
        let ms = |ns: u64| ns as f64 / 1e6;
        self.total_ms += ms(time.device_ns.unwrap_or(time.wall_ns));
        for (stage, ns) in stages.iter().zip(time.stages) {
            match self.stages.iter_mut().find(|(name, _)| *name == stage.0) {
                Some((_, sum)) => *sum += ms(ns),
                None => self.stages.push((stage.0, ms(ns))),
            }
        }
    }
}
