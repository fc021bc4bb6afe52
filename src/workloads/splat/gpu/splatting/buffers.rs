//! The buffers of lists, buckets, tasks and the blur.

use crate::device::VulkanDevice;
use crate::device::vulkan::Buffer;
use crate::error::Result;
use crate::workloads::splat::clusters::KeyLayout;
use crate::workloads::splat::clusters::layout::LEVELS;
use crate::workloads::splat::gpu::buffers::{PIXELS, buffers};
use crate::workloads::splat::splatting::buckets::WORDS;
use crate::workloads::splat::splatting::setting::{BucketSetting, Gather, Tasks};

/// How many elements the buffers have; what a technique does not have is 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SplatSizes {
    /// Pixels.
    pub pixels: u32,
    /// Lists: most clusters, and one for the end of the last.
    pub lists: u32,
    /// Entries of all lists together.
    pub entries: u32,
    /// Tasks of the queue: one for each pixel, and one for the end of the last.
    pub tasks: u32,
    /// Clusters or nodes with buckets.
    pub buckets: u32,
    /// Pixels whose irradiance is blurred.
    pub blurred: u32,
}

impl SplatSizes {
    /// The sizes of a technique. `most_clusters` are possible
    /// ([`super::super::clusters::ClusterSizes::clusters`]), lists have room for `entries`, and `bucket_clusters` may
    /// have buckets where those belong to clusters.
    pub fn new(
        gather: Gather,
        layout: Option<&KeyLayout>,
        pixels: u32,
        (most_clusters, entries, bucket_clusters): (u32, u32, u32),
    ) -> SplatSizes {
        let none = SplatSizes { pixels, ..SplatSizes::default() };
        match gather {
            Gather::PerSample { tasks, .. } => {
                let tasks = if tasks == Tasks::Queue { pixels + 1 } else { 0 };
                SplatSizes { lists: most_clusters + 1, entries, tasks, ..none }
            }
            Gather::Buckets(BucketSetting { blur, level, .. }) => {
                let nodes = layout.filter(|_| level < LEVELS).map(|layout| layout.level_nodes(level));
                let buckets = nodes.unwrap_or(bucket_clusters.min(most_clusters));
                SplatSizes { buckets, blurred: if blur > 0 { pixels } else { 0 }, ..none }
            }
            _ => none,
        }
    }
}

const LISTS: &str = "give a smaller --capacity";
const BUCKETS: &str = "give a smaller level";

buffers! {
    /// The buffers of splatting.
    SplatBuffers of SplatSizes;
    /// Counts the photons of each cluster; 0 after the lists are filled.
    counts, "counts of photons": |sizes: &SplatSizes| u64::from(sizes.lists) * 4, PIXELS;
    /// Tells where each list begins.
    offsets, "offsets of lists": |sizes: &SplatSizes| u64::from(sizes.lists) * 4, PIXELS;
    /// Holds the lists.
    entries, "entries of lists": |sizes: &SplatSizes| u64::from(sizes.entries) * 4, LISTS;
    /// Tells the tasks before each pixel's, and how many there are.
    tasks, "tasks of samples": |sizes: &SplatSizes| u64::from(sizes.tasks) * 4, PIXELS;
    /// Holds the number of the next task.
    next, "next task": |sizes: &SplatSizes| if sizes.tasks > 0 { 4 } else { 0 }, PIXELS;
    /// Holds sums of flux by direction.
    words, "buckets": |sizes: &SplatSizes| u64::from(sizes.buckets) * 4 * WORDS as u64, BUCKETS;
    /// Holds irradiance that is blurred along rows.
    blurred, "blurred irradiance": |sizes: &SplatSizes| u64::from(sizes.blurred) * 16, PIXELS;
}
