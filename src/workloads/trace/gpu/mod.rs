//! The GPU side: devices, kernel assembly, uploads, timers. Only here stands a wgpu type.

mod adapters;
mod device;
pub mod kernels;
mod prepared;
mod shared;
mod timing;
mod tokens;
mod upload;
mod words;

pub use adapters::{Selector, adapters, choose};
pub use device::{GpuBackend, GpuOptions};
pub use shared::{FrameUniform, StructureUniform, TraceRay};
