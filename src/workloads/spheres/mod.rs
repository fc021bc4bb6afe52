//! A sphere tracer without an acceleration structure: every ray is tested against every sphere. One picture, made by
//! several renderers, tells how much each kind of parallelism gains.
//!
//! All renderers do the same operations in the same order, so that they make the same bits: no fused multiply-add, IEEE
//! division and square root, and no literal constant in a sum of the shader. `tests/it/spheres/` compares them.

pub mod case;
pub mod count;
pub mod gpu;
mod half;
mod input;
mod memory;
pub mod options;
pub mod pictures;
mod references;
pub mod render;
pub mod renderer;
mod run;
pub mod scene;
pub mod verify;
pub mod view;
pub mod work;
mod workload;

pub use input::SpheresInput;
pub use workload::{SPHERES, Spheres, WORKLOAD};
