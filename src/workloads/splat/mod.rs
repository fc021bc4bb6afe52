//! Photon splatting: what makes photons, what sees them, and the estimates of indirect light.
//!
//! A frame has stages. Photons: paths leave the lights, one pass per hit, and every hit but the first is stored.
//! Samples: the camera's nearest hits, with their direct light. Estimate: the indirect light of each sample.
//! `docs/splat.md` says what of it is the source's.

mod accounting;
pub mod bounce;
pub mod camera;
mod case;
pub mod cluster_axes;
mod cluster_counts;
pub mod clusters;
mod count;
pub mod cpu;
pub mod direct;
pub mod directions;
pub mod emit;
pub mod estimate;
pub mod exact_verify;
pub mod gathered;
mod gathered_verify;
pub mod gathering;
pub mod gpu;
mod input;
pub mod lights;
pub mod lit;
mod memory;
pub mod mix;
mod path_counts;
pub mod photons;
mod pictures;
pub mod radius;
pub mod random;
pub mod reference;
mod references;
mod run;
pub mod samples;
pub mod setting;
pub mod shadow;
pub mod shares;
pub mod splatting;
pub mod surface;
pub mod technique;
pub mod verify;
mod workload;

use glam::Vec4;

pub use case::{SplatCase, light_choices};
pub use cpu::{CpuFrame, Stages};
pub use input::SplatInput;
pub use workload::{SPLAT, Splat, WORKLOAD};

/// What a test plants into the work of a device, to see it found.
#[derive(Clone, Copy, Debug)]
pub struct Fault {
    /// Changes what is verified and counted.
    pub stages: fn(&mut Stages),
    /// Changes the picture of the last timed frame.
    pub timed: fn(&mut Vec<Vec4>),
}
