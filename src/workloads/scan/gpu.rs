//! The scan on a Vulkan device: passes for a frame of any workload.

use super::kernels::{Kernel, Step};
use super::{GROUP_ELEMENTS, GROUP_SIZE, Options, checked, levels};
use crate::device::vulkan::{Bindings, Buffer, Dispatch, Groups, Pipeline, PipelineDescription, Resource};
use crate::device::{Feature, KernelInfo, Pass, Stage, VulkanDevice};
use crate::error::{Error, Result};
use bytemuck::{Pod, Zeroable};
use std::sync::Arc;

/// A level as kernels read it.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub struct Job {
    /// Words.
    pub length: u32,
    /// Work-groups in a row of the dispatch.
    pub row_groups: u32,
    /// Groups, at least 1.
    pub groups: u32,
    /// Padding; always zero.
    pub pad: u32,
}

/// Scans of one length over the same buffers, ready to be a part of frames.
pub struct Scan {
    passes: Vec<ScanPass>,
    kernels: Vec<KernelInfo>,
    total: Buffer,
    allocated: u64,
}

struct ScanPass {
    pipeline: Arc<Pipeline>,
    bindings: Bindings,
    groups: (u32, u32),
}

/// What is bound to passes apart from their values.
struct Shared {
    /// The levels above the values: sums of groups.
    sums: Vec<Buffer>,
    wrapped: Buffer,
    total: Buffer,
}

impl Scan {
    /// Scans the first `length` words of `input` into the first of `output`, which is another buffer of at least as
    /// many words.
    ///
    /// # Errors
    /// [`Error::Refused`] for more words than the device binds or dispatches, and for subgroups that it has not; the
    /// device's.
    pub fn new(device: &VulkanDevice, options: Options, input: &Buffer, output: &Buffer, length: u32) -> Result<Scan> {
        Scan::over(device, options, input, Some(output), length)
    }

    /// Scans the first `length` words of a buffer over themselves.
    ///
    /// # Errors
    /// As [`Scan::new`].
    pub fn in_place(device: &VulkanDevice, options: Options, values: &Buffer, length: u32) -> Result<Scan> {
        Scan::over(device, options, values, None, length)
    }

    fn over(
        device: &VulkanDevice,
        options: Options,
        input: &Buffer,
        output: Option<&Buffer>,
        length: u32,
    ) -> Result<Scan> {
        if options.subgroups && !device.features().has(Feature::Subgroups) {
            return Err(Error::unsupported(
                "operations of subgroups, which this device has not or was not opened with",
            ));
        }
        let bytes = u64::from(length) * 4;
        device.check_size("the words of a prefix sum", bytes, "use a smaller input")?;
        if input.bytes().min(output.unwrap_or(input).bytes()) < bytes {
            return Err(Error::Device(format!("a prefix sum over {length} words has a buffer of fewer")));
        }
        let levels = levels(length);
        let above: u64 = levels[1..].iter().map(|&length| u64::from(length) * 4).sum();
        let sums = levels[1..].iter().map(|&length| device.zeroed("the sums of groups", u64::from(length) * 4));
        let shared = Shared {
            sums: sums.collect::<Result<_>>()?,
            wrapped: device.zeroed("the note of a wrapped sum", 4)?,
            total: device.zeroed("the total", 8)?,
        };
        let mut made = Passes { device, options, shared: &shared, passes: Vec::new(), kernels: Vec::new() };
        let top = levels.len() - 1;
        for (level, &length) in levels[..top].iter().enumerate() {
            let values = if level == 0 { input } else { &shared.sums[level - 1] };
            made.add(Step::Reduce, level, length, &[(1, values)])?;
        }
        for (level, &length) in levels.iter().enumerate().rev() {
            let (values, output) = if level == 0 { (input, output) } else { (&shared.sums[level - 1], None) };
            let step = Step::Exclusive { top: level == top, in_place: output.is_none() };
            let bound = output.map_or(vec![(2, values)], |output| vec![(1, values), (2, output)]);
            made.add(step, level, length, &bound)?;
        }
        device.check()?;
        let Passes { passes, kernels, .. } = made;
        Ok(Scan { passes, kernels, total: shared.total, allocated: above + 12 })
    }

    /// The passes of a scan, all of this stage. A frame may have them as often as it likes.
    pub fn passes(&self, stage: Stage) -> Vec<Pass<Dispatch<'_>>> {
        let passes = self.passes.iter().map(|ScanPass { pipeline, bindings, groups: (x, y) }| {
            let work = Dispatch { pipeline, bindings, offset: None, groups: Groups::Fixed(*x, *y, 1) };
            Pass { stage, work }
        });
        passes.collect()
    }

    /// After the passes two words: the sum of all words modulo 2^32, and 1 if it is 2^32 or more, otherwise 0.
    pub fn total(&self) -> &Buffer {
        &self.total
    }

    /// Reads the sum of all words of the last scan.
    ///
    /// # Errors
    /// [`Error::Refused`] if it is 2^32 or more, and the device's.
    pub fn check(&self, device: &VulkanDevice) -> Result<u32> {
        let total: Vec<u32> = device.read(&self.total, 2)?;
        checked(total[0], total[1] != 0)
    }

    /// The kernels of the passes, each once.
    pub fn kernels(&self) -> &[KernelInfo] {
        &self.kernels
    }

    /// Bytes on the device apart from the words.
    pub fn allocated(&self) -> u64 {
        self.allocated
    }
}

/// Passes that are being made.
struct Passes<'a> {
    device: &'a VulkanDevice,
    options: Options,
    shared: &'a Shared,
    passes: Vec<ScanPass>,
    kernels: Vec<KernelInfo>,
}

impl Passes<'_> {
    /// Adds a pass over a level; `values` are the bindings of its words.
    fn add(&mut self, step: Step, level: usize, length: u32, values: &[(u32, &Buffer)]) -> Result<()> {
        let kernel = Kernel { step, options: self.options };
        let (device, shared) = (self.device, self.shared);
        let source = kernel.assemble()?;
        let layout = kernel.layout();
        let pipeline = device.pipeline(&PipelineDescription {
            label: &kernel.label(),
            text: &source.text,
            layout: &layout,
            checked: false,
            zero_workgroup_memory: false,
        })?;
        let groups = length.div_ceil(GROUP_ELEMENTS).max(1);
        let dispatched = device.groups_for(u64::from(groups) * u64::from(GROUP_SIZE), GROUP_SIZE)?;
        let job = device.uniform("the level", &[Job { length, row_groups: dispatched.0, groups, pad: 0 }])?;
        let mut resources = vec![(0, Resource::from(&job))];
        resources.extend(values.iter().map(|&(number, buffer)| (number, Resource::from(buffer))));
        for binding in layout {
            match binding.number {
                3 => resources.push((3, Resource::from(&shared.sums[level]))),
                4 => resources.push((4, Resource::from(&shared.wrapped))),
                5 => resources.push((5, Resource::from(&shared.total))),
                _ => {}
            }
        }
        let bindings = device.bind(&pipeline, &resources);
        let info = KernelInfo { hash: source.hash(), fetch: "buffers".to_owned(), checked: device.options().checked };
        if !self.kernels.iter().any(|known| known.hash == info.hash) {
            self.kernels.push(info);
        }
        self.passes.push(ScanPass { pipeline, bindings, groups: dispatched });
        Ok(())
    }
}
