//! Passes that put samples into clusters.

mod buffers;
mod kernels;
mod read;
mod steps;
mod uniforms;

pub use buffers::{BOX_BYTES, ClusterBuffers, ClusterSizes};
pub use kernels::{ClusterKernel, kernels};
pub use read::read;
pub use steps::{BOUNDS, HIERARCHY, KEYS, UNIQUE, steps};
pub use uniforms::{CountJob, FillJob, KeyJob, NodeJob, TileJob, UniqueJob};

use crate::device::vulkan::Buffer;

/// The number of clusters on the device, as passes write it.
pub struct ClusterCount {
    /// Eight words: clusters, 0, 0, 0, then work-groups (x, y, z) of one invocation for each cluster, for indirect
    /// dispatches from byte 16 on, and 0.
    pub state: Buffer,
}
