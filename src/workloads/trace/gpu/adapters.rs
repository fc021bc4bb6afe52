//! Which devices there are, and which one is taken.

use crate::error::{Error, Result};
use crate::workloads::trace::backend::{DeviceInfo, DeviceType};

/// Which adapter the user wants.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Selector {
    /// The best one: a discrete GPU before an integrated one before a virtual one before anything else before a
    /// software rasteriser.
    #[default]
    Best,
    /// By its place in [`adapters`], from 0; a number beyond that is a part of its name.
    Index(usize),
    /// By a part of its name, in any case.
    Name(String),
}

impl std::str::FromStr for Selector {
    type Err = std::convert::Infallible;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Ok(text.parse().map_or_else(|_| Selector::Name(text.to_string()), Selector::Index))
    }
}

pub(super) fn enumerate() -> Vec<wgpu::Adapter> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends: wgpu::Backends::VULKAN,
        // No validation layer: it would be measured. Non-conformant drivers are somebody's development drivers.
        flags: wgpu::InstanceFlags::ALLOW_UNDERLYING_NONCOMPLIANT_ADAPTER,
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    pollster::block_on(instance.enumerate_adapters(wgpu::Backends::VULKAN))
}

/// All Vulkan adapters, without opening one. Empty where there is no loader or no driver.
pub fn adapters() -> Vec<DeviceInfo> {
    enumerate().iter().map(describe).collect()
}

/// Features that are used where they exist.
pub(super) fn wanted_features(adapter: &wgpu::Adapter) -> wgpu::Features {
    adapter.features() & wgpu::Features::TIMESTAMP_QUERY
}

pub(super) fn describe(adapter: &wgpu::Adapter) -> DeviceInfo {
    let info = adapter.get_info();
    let limits = adapter.limits();
    let device_type = match info.device_type {
        wgpu::DeviceType::DiscreteGpu => DeviceType::DiscreteGpu,
        wgpu::DeviceType::IntegratedGpu => DeviceType::IntegratedGpu,
        wgpu::DeviceType::VirtualGpu => DeviceType::VirtualGpu,
        wgpu::DeviceType::Cpu => DeviceType::SoftwareRasteriser,
        wgpu::DeviceType::Other => DeviceType::Other,
    };
    let limits = [
        ("max_storage_buffer_binding_size", limits.max_storage_buffer_binding_size),
        ("max_buffer_size", limits.max_buffer_size),
        ("max_storage_buffers_per_shader_stage", limits.max_storage_buffers_per_shader_stage.into()),
        ("max_compute_workgroup_storage_size", limits.max_compute_workgroup_storage_size.into()),
        ("max_compute_invocations_per_workgroup", limits.max_compute_invocations_per_workgroup.into()),
        ("max_compute_workgroups_per_dimension", limits.max_compute_workgroups_per_dimension.into()),
        ("subgroup_min_size", info.subgroup_min_size.into()),
        ("subgroup_max_size", info.subgroup_max_size.into()),
    ];
    let software = device_type == DeviceType::SoftwareRasteriser;
    DeviceInfo {
        name: info.name,
        device_type,
        backend: info.backend.to_str().to_string(),
        driver: format!("{} {}", info.driver, info.driver_info).trim().to_string(),
        timestamp_period_ns: None,
        checked: false,
        features: wanted_features(adapter).iter_names().map(|(name, _)| name.to_string()).collect(),
        limits: limits.map(|(name, value)| (name.to_string(), value)).into(),
        threads: software.then(software_threads),
    }
}

/// Threads of lavapipe: LP_NUM_THREADS, or one per processor.
fn software_threads() -> usize {
    let asked = std::env::var("LP_NUM_THREADS").ok().and_then(|text| text.parse().ok());
    // 0 makes it compute on the thread that submits
    asked.map_or_else(|| std::thread::available_parallelism().map_or(1, usize::from), |threads: usize| threads.max(1))
}

/// Index of the adapter to take.
///
/// # Errors
/// [`Error::Input`] if none fits; the message lists what there is.
pub fn choose(adapters: &[DeviceInfo], selector: &Selector) -> Result<usize> {
    let rank = |info: &DeviceInfo| match info.device_type {
        DeviceType::DiscreteGpu => 0,
        DeviceType::IntegratedGpu => 1,
        DeviceType::VirtualGpu => 2,
        DeviceType::Other => 3,
        DeviceType::SoftwareRasteriser => 4,
        DeviceType::CpuTwin => 5,
    };
    let named = |part: &str| {
        let part = part.to_lowercase();
        adapters.iter().position(|info| info.name.to_lowercase().contains(&part))
    };
    let found = match selector {
        Selector::Best => (0..adapters.len()).min_by_key(|&index| rank(&adapters[index])),
        Selector::Index(index) if *index < adapters.len() => Some(*index),
        Selector::Index(number) => named(&number.to_string()),
        Selector::Name(part) => named(part),
    };
    found.ok_or_else(|| {
        let list: Vec<_> = adapters.iter().enumerate().map(|(i, info)| format!("{i}: {}", info.name)).collect();
        if list.is_empty() {
            return Error::argument(
                "--backend vulkan",
                "there is no Vulkan adapter",
                "install a driver (./setup.sh installs lavapipe), or use --backend cpu",
            );
        }
        Error::argument("--adapter", "no adapter fits", format!("there are: {}", list.join(", ")))
    })
}
