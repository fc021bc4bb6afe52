//! Frames by the SIMT model.

use super::{Device, Frame, choose_frames};
use crate::sources::runs::{RecordedRun, with_traces};
use crate::workloads::trace::record::ConfigurationRecord;
use crate::workloads::trace::simt::model::Gpu;
use std::fmt::Display;
use std::hash::Hash;

/// The work of recorded frames on a GPU.
pub struct ModelledRows<'a, S> {
    /// The GPU.
    pub device: Device,
    /// In place of times, millions of instructions over resident warps.
    pub frames: Vec<Frame<S>>,
    /// The runs that they are from.
    pub runs: Vec<&'a RecordedRun>,
    /// On frames that are left out.
    pub notes: Vec<String>,
}

/// The frames of these rows whose warps were counted with the GPU's width; `None` without any.
pub fn modelled<'a, S: Clone + Eq + Hash + Display>(
    runs: &'a [RecordedRun],
    gpu: &Gpu,
    is_wanted: impl Fn(&ConfigurationRecord) -> bool,
    scene: impl Fn(&ConfigurationRecord) -> S,
) -> Option<ModelledRows<'a, S>> {
    let (mut frames, mut with_frames) = (Vec::new(), Vec::new());
    for run in with_traces(runs) {
        let before = frames.len();
        let wanted = run.journal.configurations.iter().filter(|record| is_wanted(record));
        frames.extend(wanted.filter_map(|record| Some((Frame::modelled(scene(record), record, gpu)?, ()))));
        with_frames.extend((frames.len() > before).then_some(run));
    }
    if frames.is_empty() {
        return None;
    }
    let device = Device { label: gpu.name.clone(), ..Device::default() };
    let (frames, notes) = choose_frames(frames, std::slice::from_ref(&device));
    let frames = frames.into_iter().map(|(frame, ())| frame).collect();
    Some(ModelledRows { device, frames, runs: with_frames, notes })
}
