//! Descriptions of devices and kernels, as a run's provenance holds them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Device kinds. They decide how times may be read and how exactly results must agree with the twins'.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DeviceType {
    /// The CPU itself: code of this program, such as the twins of kernels.
    CpuTwin,
    /// A Vulkan driver that computes on the CPU (lavapipe).
    SoftwareRasteriser,
    /// A GPU that shares the CPU's memory.
    IntegratedGpu,
    /// A discrete GPU.
    DiscreteGpu,
    /// A GPU behind a hypervisor.
    VirtualGpu,
    /// The driver says nothing about the kind.
    Other,
}

impl DeviceType {
    /// The kind in words, for listings and tables.
    pub fn in_words(self) -> &'static str {
        match self {
            DeviceType::CpuTwin => "CPU without a driver",
            DeviceType::SoftwareRasteriser => "software rasteriser",
            DeviceType::IntegratedGpu => "integrated GPU",
            DeviceType::DiscreteGpu => "discrete GPU",
            DeviceType::VirtualGpu => "virtual GPU",
            DeviceType::Other => "unknown kind",
        }
    }

    /// True if no GPU computes: such times do not rank algorithms for a GPU.
    pub fn computes_on_cpu(self) -> bool {
        matches!(self, DeviceType::CpuTwin | DeviceType::SoftwareRasteriser)
    }
}

/// The description of a device in a run's provenance.
#[derive(Clone, Debug, Serialize, Deserialize, PartialEq, JsonSchema)]
pub struct DeviceInfo {
    /// Adapter name, or the processor's name for the twins.
    pub name: String,
    /// Kind.
    pub device_type: DeviceType,
    /// `vulkan`, or `cpu` for the twins.
    pub backend: String,
    /// Driver name and version; empty for the twins.
    pub driver: String,
    /// Nanoseconds per timestamp tick; `None` without timestamps.
    pub timestamp_period_ns: Option<f32>,
    /// True if kernels are compiled with wgpu's bounds checks and loop bounds.
    pub checked: bool,
    /// Optional features that are in use, by their names in wgpu.
    pub features: Vec<String>,
    /// Limits that decide what fits, by name.
    pub limits: BTreeMap<String, u64>,
    /// Threads of the twins, or of a software rasteriser.
    pub threads: Option<usize>,
}

impl DeviceInfo {
    /// `NAME DRIVER`.
    pub fn with_driver(&self) -> String {
        format!("{} {}", self.name, self.driver).trim().to_owned()
    }

    /// True if kernels on this device agree with their twins to the bit. The twins themselves do, and lavapipe does:
    /// both compute every operation on the CPU with IEEE rounding.
    pub fn agrees_with_twins(&self) -> bool {
        self.device_type.computes_on_cpu()
    }

    /// Threads of a Vulkan driver that computes on the CPU; 0 for other devices.
    pub fn software_threads(&self) -> u32 {
        match self.device_type {
            DeviceType::SoftwareRasteriser => self.threads.unwrap_or(1) as u32,
            _ => 0,
        }
    }
}

/// The identity of a compiled kernel.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct KernelInfo {
    /// First 16 digits of BLAKE3 of the text's tokens, without constants that only describe the machine: equal for
    /// equal kernels.
    pub hash: String,
    /// Where the kernel reads its input from: `buffers` or `textures`.
    pub fetch: String,
    /// True if the kernel is compiled with wgpu's bounds checks and loop bounds.
    #[serde(default)]
    pub checked: bool,
}
