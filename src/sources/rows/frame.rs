//! Frame times of a configuration, and configurations without any.

#![allow(missing_docs)] // The names of most fields say what they are

use super::Variant;
use crate::compare::pair::Conditions;
use crate::device::{DeviceInfo, DeviceType};
use crate::record::row::Status;
use crate::report::Number;
use crate::workloads::trace::backend::Config;
use crate::workloads::trace::record::ConfigurationRecord;
use crate::workloads::trace::simt::model::{Gpu, Modelled};
use std::fmt::Display;

/// Frame times of one configuration, in milliseconds.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame<S> {
    /// Index of the device.
    pub device: usize,
    pub scene: S,
    pub structure: String,
    pub variant: Variant,
    pub config: Config,
    pub width: u32,
    pub height: u32,
    pub conditions: Conditions,
    pub min_ms: f64,
    pub max_ms: f64,
    pub mean_ms: f64,
    /// Decimals of the three times, if they were printed.
    pub places: Option<[usize; 3]>,
    /// Spread over passes in percent; `None` after a single pass.
    pub noise_pct: Option<f64>,
    /// True if this measurement replaced an earlier one of the same.
    pub repeated: bool,
}

/// A configuration without a number.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure<S> {
    pub scene: S,
    /// Index of the device.
    pub device: usize,
    /// Scene, structure with its options, rays and size, in words.
    pub what: String,
    pub structure: String,
    pub variant: Variant,
    pub config: Config,
    pub width: u32,
    pub height: u32,
    pub message: String,
}

impl<S> Frame<S> {
    /// The fastest, the slowest and the mean frame, with their printed decimals.
    pub fn times(&self) -> [Number; 3] {
        let of = |index: usize, value| Number { value, places: self.places.map(|places| places[index]) };
        [of(0, self.min_ms), of(1, self.max_ms), of(2, self.mean_ms)]
    }

    /// A measurement's times, if it has usable ones.
    pub fn of(device: usize, scene: S, info: &DeviceInfo, record: &ConfigurationRecord) -> Option<Frame<S>> {
        let times = record.frame_statistics()?;
        let usable = record.status == Status::Ok && record.verified;
        // The CPU twins always have Rust's checks, which are not wgpu's
        let checked = info.checked && info.device_type != DeviceType::CpuTwin;
        let of_frames = [times.min_ms, times.max_ms, times.mean_ms];
        usable.then(|| Frame::new(device, scene, record, checked, of_frames, times.noise_pct))
    }

    /// A measurement's work on a GPU by the SIMT model, if its warps were counted: in place of each time, millions of
    /// instructions over resident warps.
    pub fn modelled(scene: S, record: &ConfigurationRecord, gpu: &Gpu) -> Option<Frame<S>> {
        // A structure that this program no longer has is not modelled
        let modelled = Modelled::of(record, gpu).ok().flatten()?;
        Some(Frame::new(0, scene, record, false, [modelled.work() / 1e6; 3], None))
    }

    fn new(
        device: usize,
        scene: S,
        record: &ConfigurationRecord,
        checked: bool,
        [min_ms, max_ms, mean_ms]: [f64; 3],
        noise_pct: Option<f64>,
    ) -> Frame<S> {
        Frame {
            device,
            scene,
            structure: record.structure.clone(),
            variant: Variant::parse(&record.variant),
            config: record.config,
            width: record.width,
            height: record.height,
            conditions: conditions_of(record, checked),
            min_ms,
            max_ms,
            mean_ms,
            places: None,
            noise_pct,
            repeated: false,
        }
    }
}

impl<S: Display> Failure<S> {
    /// A measurement without usable times, with the reason.
    pub fn of(device: usize, scene: S, record: &ConfigurationRecord) -> Failure<S> {
        let name = if record.variant == "default" { String::new() } else { format!(":{}", record.variant) };
        let size = format!("{}x{}", record.width, record.height);
        let message = match record.status {
            Status::Skipped | Status::Wrong | Status::Failed => record.message.clone(),
            Status::Ok if !record.verified => "not verified".into(),
            Status::Ok => "no times".into(),
        };
        Failure {
            device,
            what: format!("{scene} {}{name} {:?} {size}", record.structure, record.config),
            structure: record.structure.clone(),
            variant: Variant::parse(&record.variant),
            config: record.config,
            width: record.width,
            height: record.height,
            scene,
            message,
        }
    }
}

fn conditions_of(record: &ConfigurationRecord, checked: bool) -> Conditions {
    Conditions {
        scene: record.scene.hash.clone(),
        path: record.camera_path.name.clone(),
        path_hash: record.camera_path.hash.clone(),
        frames: record.frames,
        checked,
    }
}
