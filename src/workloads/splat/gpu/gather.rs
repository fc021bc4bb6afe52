//! From samples and photons to irradiance on a device: clusters, and what brings photons to them.

use super::buffers::{Buffers, Sizes};
use super::clusters::{self, ClusterBuffers, ClusterCount, ClusterSizes};
use super::splatting::{self, Inputs, SplatBuffers, SplatSizes, SplatState};
use super::steps::Steps;
use crate::device::VulkanDevice;
use crate::device::vulkan::Buffer;
use crate::error::{Error, Result};
use crate::workloads::size::Size;
use crate::workloads::splat::clusters::layout::LEVELS;
use crate::workloads::splat::clusters::setting::{ClusterSetting, Unique};
use crate::workloads::splat::clusters::{Clusters, KeyLayout};
use crate::workloads::splat::estimate::BLOCK;
use crate::workloads::splat::gathered::Gathered;
use crate::workloads::splat::gathering::{BUCKET_CLUSTERS, Gathering};
use crate::workloads::splat::splatting::setting::{Atomics, Gather};

/// What a technique but `reference` has on the device.
pub(super) struct Gatherer {
    gathering: Gathering,
    clusters: Option<Clustered>,
    sizes: SplatSizes,
    buffers: SplatBuffers,
    state: SplatState,
}

/// Clusters on the device.
struct Clustered {
    layout: KeyLayout,
    sizes: ClusterSizes,
    buffers: ClusterBuffers,
    count: ClusterCount,
    pixels: usize,
}

impl Clustered {
    fn new(
        device: &VulkanDevice,
        steps: &mut Steps,
        gathering: &Gathering,
        size: Size,
        buffers: &Buffers,
    ) -> Result<Option<Clustered>> {
        let Some(layout) = gathering.layout.clone() else { return Ok(None) };
        let (setting, pixels) = (&gathering.clusters, size.pixels());
        let sizes = ClusterSizes::new(setting, &layout, pixels as u32);
        ClusterBuffers::check(device, &sizes)?;
        check_sort(device, setting)?;
        let own = ClusterBuffers::new(device, &sizes)?;
        let (samples, normals) = (&buffers.samples, &buffers.normals);
        let count = clusters::steps(steps, device, setting, &layout, size, samples, normals, &own)?;
        Ok(Some(Clustered { layout, sizes, buffers: own, count, pixels }))
    }
}

/// Refuses a queue whose tasks a word cannot count.
fn check_queue(sizes: &SplatSizes, slots: u32) -> Result<()> {
    let most = u64::from(sizes.tasks) * u64::from(slots.min(sizes.entries)).div_ceil(BLOCK as u64);
    if most < 1 << 32 {
        return Ok(());
    }
    let problem = format!("{most} blocks of photons are possible, a word counts 4294967295");
    Err(Error::too_large("the queue of tasks", problem, "give fewer --paths or a smaller image, or tasks=sample"))
}

/// Refuses a sort that needs more work-group memory than the device has.
fn check_sort(device: &VulkanDevice, setting: &ClusterSetting) -> Result<()> {
    // Two words for each sample of a tile, whose side is a power of two
    let side = u64::from(setting.tile.next_power_of_two());
    let (need, limit) = (side * side * 8, device.max_workgroup_memory());
    if setting.unique != Unique::Sort || need <= limit {
        return Ok(());
    }
    let problem = format!("{need} bytes are needed, this device has {limit}");
    Err(Error::too_large("the work-group memory of a tile", problem, "give a smaller --tile, or another --unique"))
}

impl Gatherer {
    /// Allocates buffers and adds passes; the first word of `photons` is their number.
    ///
    /// # Errors
    /// [`Error::Refused`] for what the device cannot bind or do; the device's.
    pub fn new(
        device: &VulkanDevice,
        steps: &mut Steps,
        gathering: &Gathering,
        (frame_sizes, size): (&Sizes, Size),
        frame: &Buffers,
        photons: &Buffer,
    ) -> Result<Gatherer> {
        let clusters = Clustered::new(device, steps, gathering, size, frame)?;
        let most = clusters.as_ref().map_or(0, |clusters| clusters.sizes.clusters());
        let pairs = u64::from(most) * u64::from(frame_sizes.slots);
        let entries = u64::from(gathering.capacity).min(device.max_binding() / 4).min(pairs).max(1) as u32;
        let bounds = (most, entries, BUCKET_CLUSTERS);
        let sizes = SplatSizes::new(gathering.gather, gathering.layout.as_ref(), frame_sizes.pixels, bounds);
        SplatBuffers::check(device, &sizes)?;
        check_queue(&sizes, frame_sizes.slots)?;
        let buffers = SplatBuffers::new(device, &sizes)?;
        let inputs = Inputs {
            samples: &frame.samples,
            normals: &frame.normals,
            positions: &frame.positions,
            directions: &frame.directions,
            fluxes: &frame.fluxes,
            photons,
            irradiance: &frame.irradiance,
            clusters: clusters.as_ref().map(|clusters| splatting::Clustered {
                buffers: &clusters.buffers,
                count: &clusters.count,
                layout: &clusters.layout,
                setting: &gathering.clusters,
            }),
            slots: frame_sizes.slots,
            size,
            tile: gathering.clusters.tile,
            gather: gathering.gather,
            estimate: gathering.estimate,
        };
        let state = splatting::steps(steps, device, &inputs, (&sizes, &buffers))?;
        Ok(Gatherer { gathering: gathering.clone(), clusters, sizes, buffers, state })
    }

    /// Name and bytes of each buffer.
    pub fn bytes(&self) -> Vec<(&'static str, u64)> {
        let clusters = self.clusters.as_ref().map_or(Vec::new(), |clusters| ClusterBuffers::bytes(&clusters.sizes));
        clusters.into_iter().chain(SplatBuffers::bytes(&self.sizes)).filter(|(_, bytes)| *bytes > 0).collect()
    }

    /// Poisons all buffers, and forgets what earlier frames needed.
    pub fn reset(&self, device: &VulkanDevice) {
        if let Some(clusters) = &self.clusters {
            clusters.buffers.poison(device);
        }
        self.buffers.poison(device);
        self.state.reset(device);
    }

    /// Refuses frames since the last reset that had no room for their lists or buckets.
    ///
    /// # Errors
    /// [`Error::Device`] with need and capacity; the device's.
    pub fn check(&self, device: &VulkanDevice) -> Result<()> {
        let needs = self.state.needs(device)?;
        if needs.wrapped {
            return Err(Error::Device("overflow: the lists of clusters need room for 2^32 entries or more".into()));
        }
        match self.gathering.gather {
            Gather::PerSample { .. } => {
                let gathering = Gathering { capacity: self.sizes.entries, ..self.gathering.clone() };
                gathering.check_entries(needs.entries.into())
            }
            Gather::Buckets(setting) if setting.level == LEVELS => {
                self.gathering.check_bucket_clusters(needs.clusters.into(), self.sizes.buckets.into())
            }
            _ => Ok(()),
        }
    }

    /// The clusters of the last frame.
    ///
    /// # Errors
    /// The device's.
    pub fn clusters(&self, device: &VulkanDevice) -> Result<Option<Clusters>> {
        let Some(Clustered { layout, buffers, count, pixels, .. }) = &self.clusters else { return Ok(None) };
        clusters::read(device, buffers, count, layout, &self.gathering.clusters, *pixels).map(Some)
    }

    /// What lies between samples and irradiance of the last frame.
    ///
    /// # Errors
    /// Those of [`Gatherer::check`].
    pub fn read(&self, device: &VulkanDevice) -> Result<Gathered> {
        self.check(device)?;
        let clusters = self.clusters(device)?;
        let count = clusters.as_ref().map_or(0, |clusters| clusters.len() as u32);
        let mut gathered = Gathered { clusters, ..Gathered::default() };
        match self.gathering.gather {
            Gather::PerSample { .. } => {
                gathered.lists = Some(self.state.lists(device, &self.sizes, &self.buffers, count)?);
            }
            Gather::Buckets(setting) => {
                let layout = self.gathering.layout.as_ref().filter(|_| setting.level < LEVELS);
                let targets = layout.map_or(count, |layout| layout.level_nodes(setting.level));
                let is_fixed = setting.atomics == Atomics::Fixed;
                let buckets = self.state.buckets(device, &self.sizes, &self.buffers, (targets, is_fixed))?;
                gathered.buckets = Some(buckets);
            }
            _ => {}
        }
        Ok(gathered)
    }
}
