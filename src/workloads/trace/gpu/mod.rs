//! Ray tracing on a Vulkan device: kernel variants, uploads, frames.

mod caster;
pub mod kernels;
mod path;
mod prepared;
mod rendering;
mod shared;
mod upload;

pub use caster::{Cast, HIT_BYTES, RayCaster};
pub use shared::{CastJob, FrameUniform, LeafTriangle, WaitingPath};

use crate::device::{DeviceInfo, VulkanDevice};
use crate::error::Result;
use crate::scene::Scene;
use crate::workloads::trace::backend::{Backend, Prepared};
use crate::workloads::trace::{Method, Structure};

impl Backend for VulkanDevice {
    fn info(&self) -> &DeviceInfo {
        VulkanDevice::info(self)
    }

    fn prepare<'a>(
        &'a self,
        scene: &'a Scene,
        structure: &'a dyn Structure,
        method: Method,
    ) -> Result<Box<dyn Prepared + 'a>> {
        Ok(Box::new(prepared::GpuPrepared::new(self, scene, structure, method)?))
    }
}

/// Milliseconds until the nodes and triangle references of a structure are on a device, by the host's clock.
///
/// # Errors
/// [`crate::Error::Refused`] if it does not fit the device's limits, or the device's.
pub fn upload_ms(device: &VulkanDevice, scene: &Scene, structure: &dyn Structure, method: Method) -> Result<f64> {
    Ok(upload::Uploaded::new(device, scene, structure, method)?.structure_time.as_secs_f64() * 1e3)
}
