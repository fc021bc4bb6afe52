//! What can compute: the CPU on a pool of threads, or a Vulkan device. Nothing here knows what is computed.

mod cpu;
mod description;
mod features;
mod frame;
mod info;
mod kernel;
mod tokens;
pub mod vulkan;

pub use cpu::CpuDevice;
pub use features::{Feature, Features};
pub use frame::{Frame, FrameTime, Interrupted, Pass, Stage, Submissions};
pub use info::{DeviceInfo, DeviceType, KernelInfo};
pub use kernel::{Constants, KernelFile, Source, assemble};
pub use vulkan::VulkanDevice;

/// An opened device.
#[allow(clippy::large_enum_variant)] // a run opens a handful
pub enum Device {
    /// The CPU, which runs twins of kernels.
    Cpu(CpuDevice),
    /// A Vulkan adapter, which runs kernels.
    Vulkan(VulkanDevice),
}

impl Device {
    /// The description for a run's provenance.
    pub fn info(&self) -> &DeviceInfo {
        match self {
            Device::Cpu(device) => device.info(),
            Device::Vulkan(device) => device.info(),
        }
    }
}

/// Output buffers are filled with this word before a kernel runs, so that a word that no kernel wrote is noticed.
pub const POISON: u32 = 0xDEAD_BEEF;

/// A poisoned lock only means that some thread panicked while it held plain data.
fn lock<T>(mutex: &std::sync::Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}
