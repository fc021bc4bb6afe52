//! The passes of splatting, in their order.

use super::buffers::{SplatBuffers, SplatSizes};
use super::kernels::{Action, Finder, Kernel, Walk};
use super::state::SplatState;
use super::uniforms::*;
use crate::device::vulkan::Buffer;
use crate::device::{Feature, Stage, VulkanDevice};
use crate::error::{Error, Result};
use crate::workloads::scan::{self, Scan};
use crate::workloads::size::Size;
use crate::workloads::splat::clusters::KeyLayout;
use crate::workloads::splat::clusters::layout::LEVELS;
use crate::workloads::splat::clusters::setting::{ClusterSetting, HierarchyBy};
use crate::workloads::splat::directions::direction;
use crate::workloads::splat::gpu::clusters::{ClusterBuffers, ClusterCount};
use crate::workloads::splat::gpu::{Count, GROUP_SIZE, List, Steps};
use crate::workloads::splat::setting::Estimate;
use crate::workloads::splat::splatting::setting::{Atomics, BucketSetting, Gather, Order, Share, Tasks};
use crate::workloads::splat::splatting::{blur, buckets, facets::facets, walk};
use glam::Vec4;

const COUNT: Stage = Stage("count");
const OFFSETS: Stage = Stage("offsets");
const FILL: Stage = Stage("fill");
const ORDER: Stage = Stage("order");
const SCALE: Stage = Stage("scale");
const BUCKETS: Stage = Stage("buckets");
const ESTIMATE: Stage = Stage("estimate");
const BLUR: Stage = Stage("blur");

/// Most work-groups that take tasks from the queue.
const QUEUE_GROUPS: u32 = 1024;

/// The stages of a technique but `reference`, in their order.
pub fn stages(gather: Gather) -> Vec<&'static str> {
    match gather {
        Gather::PerSample { order: Order::Sorted, .. } => vec!["count", "offsets", "fill", "order", "estimate"],
        Gather::PerSample { .. } => vec!["count", "offsets", "fill", "estimate"],
        Gather::Buckets(BucketSetting { blur: 0, .. }) => vec!["scale", "buckets", "estimate"],
        Gather::Buckets(_) => vec!["scale", "buckets", "estimate", "blur"],
        Gather::Reference | Gather::Tiled => vec!["estimate"],
    }
}

/// Clusters as passes read them.
#[derive(Clone, Copy)]
pub struct Clustered<'a> {
    /// What the passes of clusters wrote.
    pub buffers: &'a ClusterBuffers,
    /// How many there are.
    pub count: &'a ClusterCount,
    /// Of their keys.
    pub layout: &'a KeyLayout,
    /// How they were made.
    pub setting: &'a ClusterSetting,
}

/// What passes are made of.
pub struct Inputs<'a> {
    /// Positions of samples.
    pub samples: &'a Buffer,
    /// Normals of samples.
    pub normals: &'a Buffer,
    /// Positions of photons.
    pub positions: &'a Buffer,
    /// Directions of photons.
    pub directions: &'a Buffer,
    /// Fluxes of photons.
    pub fluxes: &'a Buffer,
    /// The first word is the number of photons.
    pub photons: &'a Buffer,
    /// Where the irradiance of samples goes.
    pub irradiance: &'a Buffer,
    /// Absent for the tiled baseline.
    pub clusters: Option<Clustered<'a>>,
    /// Most photons, at least 1.
    pub slots: u32,
    /// Of the image.
    pub size: Size,
    /// Side of the tiles of the tiled baseline, in pixels.
    pub tile: u32,
    /// Which photons a sample gets; not [`Gather::Reference`].
    pub gather: Gather,
    /// The density estimate.
    pub estimate: Estimate,
}

/// Adds the passes of a technique but `reference`.
///
/// # Errors
/// [`Error::Refused`] for atomic operations that the device has not and for buckets of nodes without a hierarchy; the
/// device's.
pub fn steps(
    steps: &mut Steps,
    device: &VulkanDevice,
    inputs: &Inputs,
    (sizes, buffers): (&SplatSizes, &SplatBuffers),
) -> Result<SplatState> {
    let mut state = SplatState::new(device)?;
    let missing = || Error::Device("a technique without what it gathers from".into());
    let mut maker = Maker { device, steps, inputs, sizes, buffers, state: &mut state };
    match inputs.gather {
        Gather::PerSample { order, tasks } => {
            let clusters = inputs.clusters.ok_or_else(missing)?;
            maker.lists(&clusters, order)?;
            match tasks {
                Tasks::Sample => maker.per_sample(&clusters)?,
                Tasks::Queue => maker.queue(&clusters)?,
            }
        }
        Gather::Buckets(setting) => {
            let clusters = inputs.clusters.ok_or_else(missing)?;
            if setting.level < LEVELS && clusters.setting.hierarchy == HierarchyBy::None {
                return Err(walk::no_nodes(setting.level));
            }
            if setting.atomics == Atomics::Float && !device.features().has(Feature::FloatAtomics) {
                return Err(Error::unsupported("atomic additions of floats, which this device has not"));
            }
            maker.buckets(&clusters, &setting)?;
            maker.blur(setting.blur)?;
        }
        Gather::Tiled => maker.tiled()?,
        Gather::Reference => return Err(missing()),
    }
    Ok(state)
}

struct Maker<'m, 'a, 'd> {
    device: &'m VulkanDevice,
    steps: &'m mut Steps<'d>,
    inputs: &'m Inputs<'a>,
    sizes: &'m SplatSizes,
    buffers: &'m SplatBuffers,
    state: &'m mut SplatState,
}

impl Maker<'_, '_, '_> {
    fn row_groups(&self, elements: u32) -> Result<u32> {
        Ok(self.device.groups_for(elements.into(), GROUP_SIZE)?.0)
    }

    fn list(&self, count: u32) -> Result<List> {
        Ok(List { count, row_groups: self.row_groups(count)?, inverse_pi: 0.0, pad: 0 })
    }

    /// Counts photons, so that passes over them have as many invocations.
    fn photon_groups(&mut self, stage: Stage) -> Result<()> {
        let job = PhotonGroupsJob { slots: self.inputs.slots, row_groups: self.device.max_groups(), pad0: 0, pad1: 0 };
        let bound = [self.inputs.photons, &self.state.photons];
        self.steps.add(stage, &Kernel::PhotonGroups, Count::Groups(1), job, &bound)
    }

    fn needs(&mut self, stage: Stage, found: &Buffer, of_lists: bool) -> Result<()> {
        let job = NeedsJob { of_lists: of_lists.into(), pad0: 0, pad1: 0, pad2: 0 };
        self.steps.add(stage, &Kernel::Needs, Count::Groups(1), job, &[found, &self.state.needs])
    }

    /// A pass over all photons.
    fn splat(
        &mut self,
        stage: Stage,
        clusters: &Clustered,
        action: Action,
        (level, capacity): (u32, u32),
        bound: &[&Buffer],
    ) -> Result<()> {
        let (layout, estimate, walk) = (clusters.layout, &self.inputs.estimate, Walk::new(clusters.setting));
        let mut cones = facets(layout.bits[3]);
        cones.resize(54, Vec4::ZERO);
        let mut job = SplatJob {
            level_offsets: [1, 2, 3, 4].map(|level| layout.level_offset(level)),
            slots: self.inputs.slots,
            capacity,
            level,
            normal_mask: (1 << layout.bits[3]) - 1,
            radius: estimate.radius,
            radius2: estimate.radius2(),
            peak: estimate.peak(),
            one: 1.0,
            facets: [Vec4::ZERO; 54],
        };
        job.facets.copy_from_slice(&cones);
        let (state, of) = (self.state.photons.clone(), clusters.buffers);
        let mut all = vec![self.inputs.positions, self.inputs.directions, &state, &of.placement, &of.boxes];
        match walk.finder {
            Finder::All => all.extend([&clusters.count.state, &of.cluster_keys]),
            _ => all.extend([&of.masks, &of.node_boxes, &of.places]),
        }
        all.extend_from_slice(bound);
        self.steps.add(stage, &Kernel::Splat(walk, action), Count::Indirect(&state, 16), job, &all)
    }

    fn lists(&mut self, clusters: &Clustered, order: Order) -> Result<()> {
        let (sizes, buffers) = (self.sizes, self.buffers);
        let lists = sizes.lists;
        let list = self.list(lists)?;
        self.photon_groups(COUNT)?;
        self.steps.add(COUNT, &Kernel::ClearCounts, Count::Elements(lists), list, &[&buffers.counts])?;
        let job = (LEVELS, sizes.entries);
        self.splat(COUNT, clusters, Action::Count, job, &[&buffers.counts])?;
        let options = scan::Options { subgroups: false };
        let scan = Scan::new(self.device, options, &buffers.counts, &buffers.offsets, lists)?;
        let total = scan.total().clone();
        self.steps.scan(OFFSETS, scan);
        self.needs(OFFSETS, &total, true)?;
        self.state.total = Some(total);
        self.splat(FILL, clusters, Action::Fill, job, &[&buffers.counts, &buffers.offsets, &buffers.entries])?;
        if order == Order::Sorted {
            let state = &clusters.count.state;
            let job = List { count: sizes.entries, ..list };
            let bound = [state, &buffers.offsets, &buffers.entries];
            self.steps.add(ORDER, &Kernel::Order, Count::Indirect(state, 16), job, &bound)?;
        }
        Ok(())
    }

    fn gather_job(&self) -> Result<GatherJob> {
        let (pixels, estimate) = (self.sizes.pixels, &self.inputs.estimate);
        Ok(GatherJob {
            pixels,
            row_groups: self.row_groups(pixels)?,
            slots: self.inputs.slots,
            capacity: self.sizes.entries,
            radius2: estimate.radius2(),
            peak: estimate.peak(),
            one: 1.0,
            pad: 0,
        })
    }

    /// What samples read of their clusters' lists.
    fn gathered(&self, clusters: &Clustered) -> Vec<Buffer> {
        let Inputs { samples, normals, positions, directions, fluxes, .. } = *self.inputs;
        let (buffers, identifiers) = (self.buffers, &clusters.buffers.identifiers);
        [samples, normals, identifiers, &buffers.offsets, &buffers.entries, positions, directions, fluxes]
            .map(Buffer::clone)
            .into()
    }

    fn per_sample(&mut self, clusters: &Clustered) -> Result<()> {
        let Estimate { kernel, weight, .. } = self.inputs.estimate;
        let (job, gathered) = (self.gather_job()?, self.gathered(clusters));
        let mut bound: Vec<&Buffer> = gathered.iter().collect();
        bound.push(self.inputs.irradiance);
        self.steps.add(ESTIMATE, &Kernel::PerSample(kernel, weight), Count::Elements(job.pixels), job, &bound)
    }

    fn queue(&mut self, clusters: &Clustered) -> Result<()> {
        let Estimate { kernel, weight, .. } = self.inputs.estimate;
        let (job, buffers, irradiance) = (self.gather_job()?, self.buffers, self.inputs.irradiance);
        let row_groups = self.row_groups(job.pixels + 1)?;
        let tasks = TasksJob { pixels: job.pixels, row_groups, capacity: job.capacity, pad: 0 };
        let bound = [&clusters.buffers.identifiers, &buffers.offsets, &buffers.tasks, &buffers.next, irradiance];
        self.steps.add(ESTIMATE, &Kernel::Tasks, Count::Elements(job.pixels + 1), tasks, &bound)?;
        let options = scan::Options { subgroups: false };
        let scan = Scan::in_place(self.device, options, &buffers.tasks, job.pixels + 1)?;
        self.steps.scan(ESTIMATE, scan);
        let gathered = self.gathered(clusters);
        let mut bound: Vec<&Buffer> = gathered.iter().collect();
        bound.extend([&buffers.tasks, &buffers.next, irradiance]);
        let groups = job.pixels.div_ceil(GROUP_SIZE).min(QUEUE_GROUPS);
        self.steps.add(ESTIMATE, &Kernel::Queue(kernel, weight), Count::Groups(groups), job, &bound)
    }

    fn buckets(&mut self, clusters: &Clustered, setting: &BucketSetting) -> Result<()> {
        let (inputs, sizes, buffers) = (self.inputs, self.sizes, self.buffers);
        let (is_fixed, nodes) = (setting.atomics == Atomics::Fixed, setting.level < LEVELS);
        self.photon_groups(SCALE)?;
        if is_fixed {
            let peak = buckets::peak(setting, &inputs.estimate);
            let job = ScaleJob { slots: inputs.slots, peak, full: buckets::FULL, faintest: buckets::FAINTEST };
            let bound = [inputs.fluxes, &self.state.photons];
            self.steps.add(SCALE, &Kernel::Scale, Count::Groups(1), job, &bound)?;
        }
        let state = &clusters.count.state;
        if !nodes {
            self.needs(BUCKETS, state, false)?;
        }
        let list = self.list(sizes.buckets)?;
        let count = if nodes { Count::Elements(sizes.buckets) } else { Count::Indirect(state, 16) };
        self.steps.add(BUCKETS, &Kernel::ClearWords { nodes }, count, list, &[state, &buffers.words])?;
        // The kernel has no effect where all flux counts
        let kernel = if setting.share == Share::All { Default::default() } else { inputs.estimate.kernel };
        let action = Action::Add(setting.atomics, setting.share, kernel);
        let bound = [inputs.fluxes, &buffers.words];
        self.splat(BUCKETS, clusters, action, (setting.level, sizes.buckets), &bound)?;
        let mut directions = [Vec4::ZERO; 54];
        directions.iter_mut().zip(0..).for_each(|(vector, index)| *vector = direction(index).extend(0.0));
        let job = ReadJob {
            pixels: sizes.pixels,
            row_groups: self.row_groups(sizes.pixels)?,
            capacity: sizes.buckets,
            shift: 25 - 5 * setting.level,
            factor: buckets::factor(setting, &inputs.estimate),
            pad0: 0,
            pad1: 0,
            pad2: 0,
            directions,
        };
        let bound = [
            inputs.normals,
            &clusters.buffers.identifiers,
            &clusters.buffers.cluster_keys,
            &buffers.words,
            &self.state.photons,
            inputs.irradiance,
        ];
        let kernel = Kernel::ReadBuckets { fixed: is_fixed, nodes };
        self.steps.add(ESTIMATE, &kernel, Count::Elements(sizes.pixels), job, &bound)
    }

    fn blur(&mut self, deviation: u32) -> Result<()> {
        if deviation == 0 {
            return Ok(());
        }
        let Inputs { samples, normals, irradiance, size: Size { width, height }, .. } = *self.inputs;
        let mut weights = [Vec4::ZERO; 9];
        for (distance, weight) in blur::weights(deviation).into_iter().enumerate() {
            weights[distance / 4][distance % 4] = weight;
        }
        let (pixels, blurred) = (self.sizes.pixels, &self.buffers.blurred);
        for (is_vertical, from, to) in [(0, irradiance, blurred), (1, blurred, irradiance)] {
            let job = BlurJob {
                width,
                height,
                row_groups: self.row_groups(pixels)?,
                reach: 2 * deviation,
                is_vertical,
                depths: blur::DEPTHS,
                one: 1.0,
                pad: 0,
                weights,
            };
            let bound = [samples, normals, from, to];
            self.steps.add(BLUR, &Kernel::Blur, Count::Elements(pixels), job, &bound)?;
        }
        Ok(())
    }

    fn tiled(&mut self) -> Result<()> {
        let Inputs { samples, normals, positions, directions, fluxes, photons, irradiance, .. } = *self.inputs;
        let (estimate, size, tile) = (&self.inputs.estimate, self.inputs.size, self.inputs.tile);
        let job = TiledJob {
            tile,
            slots: self.inputs.slots,
            radius: estimate.radius,
            radius2: estimate.radius2(),
            peak: estimate.peak(),
            one: 1.0,
            pad0: 0,
            pad1: 0,
        };
        let job = self.device.uniform("the job", &[job])?;
        let bound = [&job, samples, normals, positions, directions, fluxes, photons, irradiance];
        // A work-group for each tile
        let elements = size.width.div_ceil(tile) * size.height.div_ceil(tile) * GROUP_SIZE;
        self.steps.add_view(ESTIMATE, &Kernel::Tiled(estimate.kernel, estimate.weight), elements, &bound)
    }
}
