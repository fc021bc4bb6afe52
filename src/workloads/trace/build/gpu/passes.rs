//! The passes of a build with their bindings.

use super::kernels::Kernel;
use crate::device::vulkan::{Bindings, Dispatch, Groups, Pipeline, PipelineDescription, Resource};
use crate::device::{Frame, FrameTime, Interrupted, Pass, Stage, Submissions, VulkanDevice};
use crate::error::Result;
use crate::workloads::scan::Scan;
use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use std::sync::Arc;

/// `Job` of `kernels/trace/build/job.wgsl`.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
#[allow(missing_docs)] // the fields are described in the kernel
pub struct Job {
    pub count: u32,
    pub stride: u32,
    pub workers: u32,
    pub chunk: u32,
    pub shift: u32,
    pub level: u32,
    pub max_leaf: u32,
    pub first: u32,
    pub radius: u32,
    pub forced: u32,
    pub leaves: u32,
    pub unit: f32,
    pub lo: Vec3,
    pub pad0: f32,
    pub scale: Vec3,
    pub pad1: f32,
}

/// Passes in their order.
pub(super) struct Passes<'d> {
    device: &'d VulkanDevice,
    steps: Vec<(Stage, Step)>,
}

enum Step {
    Own { pipeline: Arc<Pipeline>, bindings: Bindings, groups: u32 },
    Scan(Scan),
}

impl<'d> Passes<'d> {
    pub fn new(device: &'d VulkanDevice) -> Passes<'d> {
        Passes { device, steps: Vec::new() }
    }

    /// Adds a pass of `groups` work-groups. The resources are bound to the numbers of the kernel's layout from the
    /// second one on.
    pub fn add(&mut self, stage: Stage, kernel: Kernel, groups: u32, job: Job, resources: &[Resource]) -> Result<()> {
        let layout = kernel.layout();
        let pipeline = self.device.pipeline(&PipelineDescription {
            label: &kernel.label(),
            text: &kernel.assemble()?.text,
            layout: &layout,
            checked: false,
            zero_workgroup_memory: false,
        })?;
        let job = self.device.uniform("the job", &[job])?;
        let resources = std::iter::once(Resource::from(&job)).chain(resources.iter().copied());
        let bound: Vec<(u32, Resource)> = layout.iter().map(|binding| binding.number).zip(resources).collect();
        let bindings = self.device.bind(&pipeline, &bound);
        self.steps.push((stage, Step::Own { pipeline, bindings, groups }));
        Ok(())
    }

    /// Adds a prefix sum.
    pub fn scan(&mut self, stage: Stage, scan: Scan) {
        self.steps.push((stage, Step::Scan(scan)));
    }

    /// The sum of the words of the last prefix sum, after the passes have run.
    pub fn total(&self) -> Result<u32> {
        let scans =
            self.steps.iter().rev().filter_map(|(_, step)| if let Step::Scan(scan) = step { Some(scan) } else { None });
        scans.take(1).map(|scan| scan.check(self.device)).sum()
    }

    /// Runs the passes; returns their stages with the time of each.
    pub fn run(&self, interrupted: Interrupted) -> Result<(Vec<Stage>, FrameTime)> {
        let mut passes = Vec::with_capacity(self.steps.len());
        for (stage, step) in &self.steps {
            match step {
                Step::Own { pipeline, bindings, groups } => {
                    let groups = Groups::Fixed(*groups, 1, 1);
                    passes.push(Pass { stage: *stage, work: Dispatch { pipeline, bindings, offset: None, groups } });
                }
                Step::Scan(scan) => passes.extend(scan.passes(*stage)),
            }
        }
        let submissions = match self.device.info().software_threads() {
            0 => Submissions::PerPass,
            _ => Submissions::PerFrame,
        };
        let frame = Frame { passes, submissions };
        let time = self.device.run_frames(std::slice::from_ref(&frame), interrupted)?.pop().unwrap_or_default();
        Ok((frame.stages(), time))
    }
}
