//! Passes that put samples into clusters.

mod buffers;

pub use buffers::{BOX_BYTES, ClusterBuffers, ClusterSizes};

use crate::device::vulkan::Buffer;

/// The number of clusters on the device, as passes write it.
pub struct ClusterCount {
    /// Eight words: clusters, 0, 0, 0, then work-groups (x, y, z) of one invocation for each cluster, for indirect
    /// dispatches from byte 16 on, and 0.
    pub state: Buffer,
}
