//! The passes of a frame with their bindings, as they are made and as they run.

use super::kernels::GROUP_SIZE;
use super::uniforms::View;
use crate::device::vulkan::{Binding, Bindings, Buffer, Dispatch, Groups, Pipeline, PipelineDescription, Resource};
use crate::device::{KernelInfo, Pass, Source, Stage, VulkanDevice};
use crate::error::Result;
use crate::workloads::scan::Scan;
use crate::workloads::trace::gpu::Cast;
use bytemuck::Pod;
use std::sync::Arc;

/// A kernel of a frame, one of its variants.
pub trait Variant {
    /// A name for labels and messages.
    fn label(&self) -> String;
    /// Its WGSL.
    ///
    /// # Errors
    /// [`crate::Error::Device`] for an include that does not exist (a mistake in `kernels/`).
    fn assemble(&self) -> Result<Source>;
    /// The bindings that its text declares.
    fn layout(&self) -> Vec<Binding>;
}

/// How many work-groups a pass has.
#[derive(Clone, Copy)]
pub enum Count<'a> {
    /// An invocation for each of so many elements.
    Elements(u32),
    /// So many work-groups.
    Groups(u32),
    /// Three words of a buffer, from this byte on.
    Indirect(&'a Buffer, u64),
}

/// A pass, or passes of other modules.
enum Step {
    Own(Stage, OwnPass),
    Cast(Stage, Cast),
    Scan(Stage, Scan),
}

struct OwnPass {
    pipeline: Arc<Pipeline>,
    bound: Bound,
    groups: OwnGroups,
}

enum Bound {
    /// The same in every frame.
    Fixed(Bindings),
    /// The camera of the frame, and these buffers; as the last one the borders of slices, if so.
    View(Vec<Buffer>, bool),
}

enum OwnGroups {
    Fixed(u32, u32),
    Indirect(Buffer, u64),
}

/// The passes of a frame, in their order, with their bindings but for the camera's.
pub struct Steps<'d> {
    device: &'d VulkanDevice,
    steps: Vec<Step>,
    kernels: Vec<KernelInfo>,
}

/// The bindings of the passes that read the camera, in their order.
pub struct ViewBindings(Vec<Bindings>);

impl<'d> Steps<'d> {
    /// No pass yet.
    pub fn new(device: &'d VulkanDevice) -> Steps<'d> {
        Steps { device, steps: Vec::new(), kernels: Vec::new() }
    }

    /// Adds a pass with its uniform and its buffers, which have the numbers from 1.
    ///
    /// # Errors
    /// The device's.
    pub fn add<J: Pod>(
        &mut self,
        stage: Stage,
        kernel: &dyn Variant,
        count: Count,
        job: J,
        buffers: &[&Buffer],
    ) -> Result<()> {
        let pipeline = self.pipeline(kernel)?;
        let job = self.device.uniform("the job", &[job])?;
        let bound = Bound::Fixed(bind(self.device, &pipeline, Resource::from(&job), buffers.iter().copied()));
        self.push(stage, pipeline, count, bound)
    }

    /// Adds a pass that reads the camera of the frame, and buffers with the numbers from 1. It has an invocation for
    /// each element.
    ///
    /// # Errors
    /// The device's.
    pub fn add_view(&mut self, stage: Stage, kernel: &dyn Variant, elements: u32, buffers: &[&Buffer]) -> Result<()> {
        let pipeline = self.pipeline(kernel)?;
        let bound = Bound::View(buffers.iter().map(|&buffer| buffer.clone()).collect(), false);
        self.push(stage, pipeline, Count::Elements(elements), bound)
    }

    /// The same for a kernel whose last buffer holds the borders of slices.
    ///
    /// # Errors
    /// The device's.
    pub fn add_sliced(&mut self, stage: Stage, kernel: &dyn Variant, elements: u32, buffers: &[&Buffer]) -> Result<()> {
        let pipeline = self.pipeline(kernel)?;
        let bound = Bound::View(buffers.iter().map(|&buffer| buffer.clone()).collect(), true);
        self.push(stage, pipeline, Count::Elements(elements), bound)
    }

    /// Adds a pass that casts rays.
    pub fn cast(&mut self, stage: Stage, cast: Cast) {
        self.steps.push(Step::Cast(stage, cast));
    }

    /// Adds the passes of a prefix sum.
    pub fn scan(&mut self, stage: Stage, scan: Scan) {
        scan.kernels().iter().for_each(|info| self.know(info.clone()));
        self.steps.push(Step::Scan(stage, scan));
    }

    /// Adds a kernel to those that the frame runs.
    pub fn know(&mut self, info: KernelInfo) {
        if !self.kernels.contains(&info) {
            self.kernels.push(info);
        }
    }

    fn pipeline(&mut self, kernel: &dyn Variant) -> Result<Arc<Pipeline>> {
        let source = kernel.assemble()?;
        let checked = self.device.options().checked;
        self.know(KernelInfo { hash: source.hash(), fetch: "buffers".to_owned(), checked });
        self.device.pipeline(&PipelineDescription {
            label: &kernel.label(),
            text: &source.text,
            layout: &kernel.layout(),
            checked: false,
            zero_workgroup_memory: false,
        })
    }

    fn push(&mut self, stage: Stage, pipeline: Arc<Pipeline>, count: Count, bound: Bound) -> Result<()> {
        let groups = |invocations: u64| self.device.groups_for(invocations, GROUP_SIZE);
        let groups = match count {
            Count::Elements(count) => groups(count.into()).map(|(x, y)| OwnGroups::Fixed(x, y))?,
            Count::Groups(count) => {
                groups(u64::from(count) * u64::from(GROUP_SIZE)).map(|(x, y)| OwnGroups::Fixed(x, y))?
            }
            Count::Indirect(buffer, offset) => OwnGroups::Indirect(buffer.clone(), offset),
        };
        self.steps.push(Step::Own(stage, OwnPass { pipeline, bound, groups }));
        Ok(())
    }

    /// Binds the cameras of a run, of which `views` has a window for each, and their borders of slices.
    pub fn bind_views(&self, views: &Buffer, borders: &Buffer) -> ViewBindings {
        let bound = |step: &Step| match step {
            Step::Own(_, OwnPass { pipeline, bound: Bound::View(buffers, is_sliced), .. }) => {
                let view = Resource::Window(views, size_of::<View>() as u64);
                Some(bind(self.device, pipeline, view, buffers.iter().chain(is_sliced.then_some(borders))))
            }
            _ => None,
        };
        ViewBindings(self.steps.iter().filter_map(bound).collect())
    }

    /// The passes of a frame whose camera is at `offset` of the views.
    pub fn frame<'s>(&'s self, views: &'s ViewBindings, offset: u32) -> Vec<Pass<Dispatch<'s>>> {
        let mut views = views.0.iter();
        let mut passes = Vec::with_capacity(self.steps.len());
        for step in &self.steps {
            match step {
                Step::Own(stage, OwnPass { pipeline, bound, groups }) => {
                    let (bindings, offset) = match bound {
                        Bound::Fixed(bindings) => (Some(bindings), None),
                        Bound::View(..) => (views.next(), Some(offset)),
                    };
                    let groups = match groups {
                        OwnGroups::Fixed(x, y) => Groups::Fixed(*x, *y, 1),
                        OwnGroups::Indirect(buffer, offset) => Groups::Indirect { buffer, offset: *offset },
                    };
                    let Some(bindings) = bindings else { continue };
                    passes.push(Pass { stage: *stage, work: Dispatch { pipeline, bindings, offset, groups } });
                }
                Step::Cast(stage, cast) => passes.push(Pass { stage: *stage, work: cast.dispatch() }),
                Step::Scan(stage, scan) => passes.extend(scan.passes(*stage)),
            }
        }
        passes
    }

    /// The kernels, each once.
    pub fn kernels(&self) -> &[KernelInfo] {
        &self.kernels
    }

    /// The prefix sums of a stage, in their order.
    pub fn scans(&self, of: Stage) -> impl Iterator<Item = &Scan> {
        self.steps.iter().filter_map(move |step| match step {
            Step::Scan(stage, scan) if *stage == of => Some(scan),
            _ => None,
        })
    }

    /// Bytes that prefix sums allocate.
    pub fn scan_bytes(&self) -> u64 {
        self.steps.iter().map(|step| if let Step::Scan(_, scan) = step { scan.allocated() } else { 0 }).sum()
    }

    /// Passes of a stage.
    pub fn count(&self, of: Stage) -> usize {
        self.steps.iter().filter(|step| matches!(step, Step::Own(stage, _) if *stage == of)).count()
    }
}

fn bind<'b>(
    device: &VulkanDevice,
    pipeline: &Pipeline,
    first: Resource,
    buffers: impl Iterator<Item = &'b Buffer>,
) -> Bindings {
    let mut resources = vec![(0, first)];
    resources.extend((1..).zip(buffers).map(|(number, buffer)| (number, Resource::from(buffer))));
    device.bind(pipeline, &resources)
}
