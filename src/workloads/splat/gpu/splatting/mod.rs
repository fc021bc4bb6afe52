//! Passes that bring photons to clusters and samples.

mod buffers;
pub mod kernels;
mod state;
mod steps;
pub mod uniforms;

pub use buffers::{SplatBuffers, SplatSizes};
pub use kernels::kernels;
pub use state::{Needs, SplatState};
pub use steps::{Clustered, Inputs, stages, steps};
