//! Preparing a scene and a structure on a device.

use super::backend::{Backend, Prepared};
use super::structure::Structure;
use super::{Method, Selection};
use crate::device::Device;
use crate::error::Result;
use crate::scene::Scene;

/// Wraps what was prepared for a selection, so that a test can inject a fault.
pub type Decorate = dyn for<'a> Fn(Box<dyn Prepared + 'a>, &Selection) -> Result<Box<dyn Prepared + 'a>> + Send + Sync;

/// Uploads scene and structure to a device and makes ready to send rays through it by `method`.
///
/// # Errors
/// [`crate::Error::Refused`] if it does not fit the device's limits, or the device's.
pub fn prepare<'a>(
    device: &'a Device,
    scene: &'a Scene,
    structure: &'a dyn Structure,
    method: Method,
) -> Result<Box<dyn Prepared + 'a>> {
    match device {
        Device::Cpu(cpu) => cpu.prepare(scene, structure, method),
        Device::Vulkan(vulkan) => vulkan.prepare(scene, structure, method),
    }
}
