//! The passes of clusters, in their order.

use super::kernels::{ClusterKernel, FILLED};
use super::uniforms::{CountJob, FillJob, KeyJob, NodeJob, TileJob, UniqueJob};
use super::{ClusterBuffers, ClusterCount, ClusterSizes};
use crate::device::vulkan::Buffer;
use crate::device::{Stage, VulkanDevice};
use crate::error::Result;
use crate::workloads::scan::{self, Scan};
use crate::workloads::size::Size;
use crate::workloads::splat::clusters::KeyLayout;
use crate::workloads::splat::clusters::layout::LEVELS;
use crate::workloads::splat::clusters::setting::{BoundsBy, ClusterSetting, HierarchyBy, Unique};
use crate::workloads::splat::gpu::kernels::GROUP_SIZE;
use crate::workloads::splat::gpu::steps::{Count, Steps};

/// Positions along the axes, and keys.
pub const KEYS: Stage = Stage("keys");
/// The set of keys, and identifiers.
pub const UNIQUE: Stage = Stage("unique");
/// Boxes of clusters.
pub const BOUNDS: Stage = Stage("bounds");
/// Masks and boxes of nodes.
pub const HIERARCHY: Stage = Stage("hierarchy");

/// Adds the passes that put samples into clusters; `samples` and `normals` hold what
/// [`crate::workloads::splat::samples::Samples`] does.
///
/// # Errors
/// The device's.
#[allow(clippy::too_many_arguments)]
pub fn steps(
    steps: &mut Steps,
    device: &VulkanDevice,
    setting: &ClusterSetting,
    layout: &KeyLayout,
    size: Size,
    samples: &Buffer,
    normals: &Buffer,
    buffers: &ClusterBuffers,
) -> Result<ClusterCount> {
    let sizes = ClusterSizes::new(setting, layout, size.pixels() as u32);
    let state = device.zeroed("the number of clusters", 32)?;
    let maker = Maker { device, setting, layout, size, sizes: &sizes, buffers, state: &state };
    maker.keys(steps, samples, normals)?;
    maker.unique(steps)?;
    maker.bounds(steps)?;
    if setting.hierarchy == HierarchyBy::Masks {
        maker.hierarchy(steps)?;
    }
    Ok(ClusterCount { state })
}

/// What passes are made of.
struct Maker<'a> {
    device: &'a VulkanDevice,
    setting: &'a ClusterSetting,
    layout: &'a KeyLayout,
    size: Size,
    sizes: &'a ClusterSizes,
    buffers: &'a ClusterBuffers,
    state: &'a Buffer,
}

impl Maker<'_> {
    fn keys(&self, steps: &mut Steps, samples: &Buffer, normals: &Buffer) -> Result<()> {
        let &KeyLayout { tile, columns, rows, slices, .. } = self.layout;
        let job = self.device.uniform("the tiles and slices", &[KeyJob { tile, columns, rows, slices }])?;
        let spread = self.device.storage("the bits of columns, rows and slices", &self.layout.spread())?;
        let ClusterBuffers { placement, positions, keys, .. } = self.buffers;
        let bound = [&job, samples, normals, &spread, placement, positions, keys];
        steps.add_sliced(KEYS, &ClusterKernel::Keys(self.setting.normals), self.sizes.pixels, &bound)
    }

    fn unique(&self, steps: &mut Steps) -> Result<()> {
        let ClusterBuffers { keys, identifiers, places, tiles, cluster_keys, masks, .. } = self.buffers;
        let (pixels, key_bits) = (self.sizes.pixels, self.sizes.key_bits);
        let (scanned, words) = match self.setting.unique {
            Unique::Flags => {
                self.fill(steps, UNIQUE, places, 0, 1 << key_bits)?;
                self.add(steps, UNIQUE, ClusterKernel::Flag, pixels, &[keys, places])?;
                (places, 1 << key_bits)
            }
            Unique::Bits => {
                let words = 1 << (key_bits - 5);
                self.fill(steps, UNIQUE, masks, self.first_word(), words)?;
                self.add(steps, UNIQUE, ClusterKernel::Bit, pixels, &[keys, masks])?;
                self.add(steps, UNIQUE, ClusterKernel::Popcount, words, &[masks, places])?;
                (places, words)
            }
            Unique::Sort => {
                let (count, job) = (Count::Groups(self.sizes.tiles), self.tile_job(self.tile_groups()?));
                steps.add(UNIQUE, &ClusterKernel::Sort(self.side()), count, job, &[keys, tiles, identifiers])?;
                (tiles, self.sizes.tiles)
            }
        };
        let scan = Scan::in_place(self.device, scan::Options { subgroups: false }, scanned, words)?;
        let total = scan.total().clone();
        steps.scan(UNIQUE, scan);
        if self.setting.unique == Unique::Sort {
            let job = self.tile_job(self.row_groups(pixels)?);
            let bound = [keys, tiles, identifiers, cluster_keys, places];
            steps.add(UNIQUE, &ClusterKernel::Number, Count::Elements(pixels), job, &bound)?;
        } else {
            let bound = [keys, places, masks, identifiers, cluster_keys];
            self.add(steps, UNIQUE, ClusterKernel::Assign(self.has_bits()), pixels, &bound)?;
        }
        let job = CountJob { clusters: self.sizes.clusters(), row_groups: self.device.max_groups(), pad0: 0, pad1: 0 };
        steps.add(UNIQUE, &ClusterKernel::Count, Count::Groups(1), job, &[&total, self.state])
    }

    fn bounds(&self, steps: &mut Steps) -> Result<()> {
        let ClusterBuffers { positions, identifiers, boxes, .. } = self.buffers;
        match self.setting.bounds {
            BoundsBy::Direct => {
                self.add_for_clusters(steps, BOUNDS, ClusterKernel::Clear, &[self.state, boxes])?;
                let bound = [positions, identifiers, boxes];
                self.add(steps, BOUNDS, ClusterKernel::Direct, self.sizes.pixels, &bound)
            }
            BoundsBy::TwoStep => {
                let (count, job) = (Count::Groups(self.sizes.tiles), self.tile_job(self.tile_groups()?));
                let bound = [positions, identifiers, boxes];
                steps.add(BOUNDS, &ClusterKernel::TwoStep(self.side()), count, job, &bound)
            }
        }
    }

    fn hierarchy(&self, steps: &mut Steps) -> Result<()> {
        let ClusterBuffers { places, cluster_keys, boxes, masks, node_boxes, .. } = self.buffers;
        // With bits the last level is there
        let cleared = if self.has_bits() { self.first_word() } else { self.layout.nodes() };
        self.fill(steps, HIERARCHY, masks, 0, cleared)?;
        if !self.has_bits() {
            let bound = [self.state, cluster_keys, masks];
            self.add_for_clusters(steps, HIERARCHY, ClusterKernel::Leaves, &bound)?;
        }
        for level in (0..LEVELS).rev() {
            let nodes = self.layout.level_nodes(level);
            let job = NodeJob {
                nodes,
                row_groups: self.row_groups(nodes)?,
                first: self.layout.level_offset(level),
                first_child: self.layout.level_offset(level + 1),
                first_parent: self.layout.level_offset(level.saturating_sub(1)),
                clusters: self.sizes.clusters(),
                is_root: u32::from(level == 0),
                pad: 0,
            };
            let is_last = level + 1 == LEVELS;
            let kernel = ClusterKernel::Nodes(is_last, is_last && self.has_bits());
            steps.add(HIERARCHY, &kernel, Count::Elements(nodes), job, &[places, boxes, masks, node_boxes])?;
        }
        Ok(())
    }

    /// Adds a pass over pixels or words.
    fn add(
        &self,
        steps: &mut Steps,
        stage: Stage,
        kernel: ClusterKernel,
        count: u32,
        buffers: &[&Buffer],
    ) -> Result<()> {
        let job = self.unique_job(count, self.row_groups(count)?);
        steps.add(stage, &kernel, Count::Elements(count), job, buffers)
    }

    /// Adds a pass over clusters.
    fn add_for_clusters(
        &self,
        steps: &mut Steps,
        stage: Stage,
        kernel: ClusterKernel,
        buffers: &[&Buffer],
    ) -> Result<()> {
        let job = self.unique_job(self.sizes.clusters(), self.device.max_groups());
        steps.add(stage, &kernel, Count::Indirect(self.state, 16), job, buffers)
    }

    /// Adds a pass that clears words.
    fn fill(&self, steps: &mut Steps, stage: Stage, words: &Buffer, first: u32, count: u32) -> Result<()> {
        let invocations = count.div_ceil(FILLED);
        let job = FillJob { first, count, value: 0, row_groups: self.row_groups(invocations)? };
        steps.add(stage, &ClusterKernel::Fill, Count::Elements(invocations), job, &[words])
    }

    fn unique_job(&self, count: u32, row_groups: u32) -> UniqueJob {
        UniqueJob { count, row_groups, first_word: self.first_word(), clusters: self.sizes.clusters() }
    }

    fn tile_job(&self, row_groups: u32) -> TileJob {
        let &KeyLayout { tile, columns, .. } = self.layout;
        let Size { width, height } = self.size;
        let (tiles, clusters) = (self.sizes.tiles, self.sizes.clusters());
        TileJob { tile, columns, tiles, row_groups, width, height, within: self.layout.within_tile(), clusters }
    }

    /// Where the bits of keys begin in the masks.
    fn first_word(&self) -> u32 {
        self.layout.level_offset(LEVELS - 1)
    }

    fn has_bits(&self) -> bool {
        self.setting.unique == Unique::Bits
    }

    /// The side of a tile, or the next power of two.
    fn side(&self) -> u32 {
        self.layout.tile.next_power_of_two()
    }

    fn row_groups(&self, invocations: u32) -> Result<u32> {
        Ok(self.device.groups_for(invocations.into(), GROUP_SIZE)?.0)
    }

    fn tile_groups(&self) -> Result<u32> {
        Ok(self.device.groups_for(u64::from(self.sizes.tiles) * u64::from(GROUP_SIZE), GROUP_SIZE)?.0)
    }
}
