//! Which adapters there are, and which one is taken.

use crate::device::{DeviceInfo, DeviceType, Feature, Features};
use crate::error::{Error, Result};

/// Optional features that an opened device has wherever its adapter offers them. Others are never requested: a driver
/// may compile the same kernel otherwise with them. Half precision and ray queries only add types and subgroups add
/// operations, which few kernels use.
pub const WANTED: Features =
    Features::of(&[Feature::Timestamps, Feature::Half, Feature::FloatAtomics, Feature::Subgroups, Feature::RayQuery]);

/// A Vulkan adapter that was listed and can be opened.
pub struct Adapter {
    pub(super) adapter: wgpu::Adapter,
    pub(super) features: Features,
    info: DeviceInfo,
}

impl Adapter {
    /// The description of the device that opening it gives, as far as it is known before.
    pub fn info(&self) -> &DeviceInfo {
        &self.info
    }

    pub(super) fn with_features(adapter: wgpu::Adapter, wanted: Features) -> Adapter {
        let features = offered(&adapter).intersection(wanted);
        let info = describe(&adapter, features);
        Adapter { adapter, features, info }
    }
}

/// The user's choice of an adapter.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Selector {
    /// The best one: a discrete GPU before an integrated one before a virtual one before anything else before a
    /// software rasteriser.
    #[default]
    Best,
    /// By its position in [`adapters`], from 0; a number beyond that is a part of its name.
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

/// All Vulkan adapters, without opening one. Empty where there is no loader or no driver.
pub fn adapters() -> Vec<Adapter> {
    list(WANTED)
}

/// Like [`adapters`], whose devices have of these features those that their adapters offer, and no others.
pub fn adapters_with(features: Features) -> Vec<Adapter> {
    list(features)
}

pub(super) fn list(wanted: Features) -> Vec<Adapter> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends: wgpu::Backends::VULKAN,
        // A validation layer would be measured, and so would the validation of indirect dispatches. Drivers in
        // development are not yet conformant.
        flags: wgpu::InstanceFlags::ALLOW_UNDERLYING_NONCOMPLIANT_ADAPTER,
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::VULKAN));
    adapters.into_iter().map(|adapter| Adapter::with_features(adapter, wanted)).collect()
}

pub(super) fn wgpu_feature(feature: Feature) -> wgpu::Features {
    match feature {
        Feature::Timestamps => wgpu::Features::TIMESTAMP_QUERY,
        Feature::Subgroups => wgpu::Features::SUBGROUP,
        Feature::RayQuery => wgpu::Features::EXPERIMENTAL_RAY_QUERY,
        Feature::FloatAtomics => wgpu::Features::SHADER_FLOAT32_ATOMIC,
        Feature::Half => wgpu::Features::SHADER_F16,
    }
}

pub(super) fn wgpu_features(features: Features) -> wgpu::Features {
    features.iter().map(wgpu_feature).fold(wgpu::Features::empty(), |all, one| all | one)
}

fn offered(adapter: &wgpu::Adapter) -> Features {
    let offered = adapter.features();
    Feature::ALL.into_iter().filter(|&feature| offered.contains(wgpu_feature(feature))).collect()
}

fn describe(adapter: &wgpu::Adapter, features: Features) -> DeviceInfo {
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
        features: wgpu_features(features).iter_names().map(|(name, _)| name.to_string()).collect(),
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

/// The adapter to take.
///
/// # Errors
/// [`Error::Input`] if none fits; the message lists what there is.
pub fn choose<'a>(adapters: &'a [Adapter], selector: &Selector) -> Result<&'a Adapter> {
    let infos: Vec<&DeviceInfo> = adapters.iter().map(Adapter::info).collect();
    if let Some(index) = find(&infos, selector) {
        return Ok(&adapters[index]);
    }
    if adapters.is_empty() {
        return Err(Error::argument(
            "--backend vulkan",
            "there is no Vulkan adapter",
            "install a driver (./setup.sh installs lavapipe), or use --backend cpu",
        ));
    }
    let list: Vec<_> = infos.iter().enumerate().map(|(i, info)| format!("{i}: {}", info.name)).collect();
    Err(Error::argument("--adapter", "no adapter fits", format!("there are: {}", list.join(", "))))
}

/// Positions of the adapters whose names fit a choice by name, in any case; empty for other choices.
pub fn fitting(names: &[&str], selector: &Selector) -> Vec<usize> {
    let part = match selector {
        Selector::Name(part) => part.to_lowercase(),
        Selector::Index(number) if *number >= names.len() => number.to_string(),
        Selector::Best | Selector::Index(_) => return Vec::new(),
    };
    (0..names.len()).filter(|&index| names[index].to_lowercase().contains(&part)).collect()
}

fn find(infos: &[&DeviceInfo], selector: &Selector) -> Option<usize> {
    let rank = |info: &DeviceInfo| match info.device_type {
        DeviceType::DiscreteGpu => 0,
        DeviceType::IntegratedGpu => 1,
        DeviceType::VirtualGpu => 2,
        DeviceType::Other => 3,
        DeviceType::SoftwareRasteriser => 4,
        DeviceType::CpuTwin => 5,
    };
    match selector {
        Selector::Best => (0..infos.len()).min_by_key(|&index| rank(infos[index])),
        Selector::Index(index) if *index < infos.len() => Some(*index),
        Selector::Index(_) | Selector::Name(_) => {
            let names: Vec<&str> = infos.iter().map(|info| info.name.as_str()).collect();
            fitting(&names, selector).first().copied()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn adapters_are_found_by_rank_position_and_name() {
        let info = |name: &str, device_type| DeviceInfo {
            name: name.into(),
            device_type,
            backend: "vulkan".into(),
            driver: String::new(),
            timestamp_period_ns: None,
            checked: false,
            features: Vec::new(),
            limits: Default::default(),
            threads: None,
        };
        let infos = [
            info("llvmpipe", DeviceType::SoftwareRasteriser),
            info("Small 770", DeviceType::IntegratedGpu),
            info("Large 4090", DeviceType::DiscreteGpu),
        ];
        let infos: [&DeviceInfo; 3] = infos.each_ref();
        for (text, expected) in [("1", Some(1)), ("770", Some(1)), ("large", Some(2)), ("3", None), ("arc", None)] {
            assert_eq!(find(&infos, &text.parse().unwrap()), expected, "{text}");
        }
        assert_eq!(find(&infos, &Selector::Best), Some(2));
        assert_eq!(find(&infos[..1], &Selector::Best), Some(0));
        assert_eq!(find(&[], &Selector::Best), None);
        for (text, expected) in [("LL", &[0, 1][..]), ("0", &[]), ("4090", &[2]), ("arc", &[])] {
            let names = infos.each_ref().map(|info| info.name.as_str());
            assert_eq!(fitting(&names, &text.parse().unwrap()), expected, "{text}");
        }
    }
}
