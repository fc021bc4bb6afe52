//! Which device: flags that several commands share, and the choice that `auto` makes.

use super::output;
use crate::device::Device;
use crate::device::vulkan::{self, Selector, VulkanOptions};
use crate::device::{CpuDevice, VulkanDevice};
use crate::error::{Error, Result};
use crate::harness::run::Opened;
use crate::harness::workload::Devices;
use crate::threads;
use clap::{Args, ValueEnum};

/// Which device, and how it is used.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Device")]
pub struct DeviceArguments {
    /// What computes: the best Vulkan adapter or else the CPU (auto), a Vulkan adapter, or the CPU twins of the kernels
    #[arg(long, value_enum, default_value_t = BackendName::Auto)]
    pub backend: BackendName,
    /// Vulkan adapter by its number in `rtbench devices`, or by a part of its name
    #[arg(long, value_name = "N|NAME")]
    pub adapter: Option<String>,
    /// Compile kernels with wgpu's bounds checks and loop bounds: slower, and every record says so
    #[arg(long)]
    pub checked: bool,
    /// Threads that build structures and run the CPU twins; 0 for all
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub threads: usize,
}

/// What computes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum BackendName {
    /// The best Vulkan adapter, or the CPU where there is none
    Auto,
    /// A Vulkan adapter
    Vulkan,
    /// The CPU twins of the kernels
    Cpu,
}

impl DeviceArguments {
    /// Refuses values that make no sense, before anything runs.
    ///
    /// # Errors
    /// [`Error::Input`].
    pub fn check(&self) -> Result<()> {
        threads::check(self.threads)?;
        if self.backend == BackendName::Cpu && self.adapter.is_some() {
            return Err(Error::argument("--adapter", "there are no adapters with --backend cpu", "leave one out"));
        }
        Ok(())
    }

    /// Opens the device and says why it is this one.
    ///
    /// # Errors
    /// [`Error::Input`] if there is no such adapter, or the device's.
    pub fn open(&self) -> Result<Opened> {
        self.check()?;
        if self.backend == BackendName::Cpu {
            return self.cpu("asked for by --backend cpu".into());
        }
        let adapters = vulkan::adapters();
        let free_choice = self.backend == BackendName::Auto && self.adapter.is_none();
        if free_choice && adapters.is_empty() {
            return self.cpu("there is no Vulkan adapter".into());
        }
        let selector: Selector = match &self.adapter {
            Some(wanted) => wanted.parse().unwrap_or_default(),
            None => Selector::Best,
        };
        let adapter = vulkan::choose(&adapters, &selector)?;
        let names: Vec<&str> = adapters.iter().map(|adapter| adapter.info().name.as_str()).collect();
        let reason = match &self.adapter {
            Some(wanted) => match vulkan::fitting(&names, &selector).as_slice() {
                [] | [_] => format!("asked for by --adapter {wanted}"),
                several => {
                    let list: Vec<String> = several.iter().map(|&index| format!("{index} {}", names[index])).collect();
                    format!("the first of those that fit --adapter {wanted}: {}", list.join(", "))
                }
            },
            None if adapters.len() == 1 => "the only Vulkan adapter".into(),
            None => format!("the best of {} Vulkan adapters: {}", adapters.len(), names.join(", ")),
        };
        let options = VulkanOptions { checked: self.checked, ..VulkanOptions::default() };
        match VulkanDevice::open(adapter, options) {
            Ok(backend) => Ok(Opened { device: Device::Vulkan(backend), reason }),
            // Only a free choice may fall back.
            Err(error) if free_choice => self.cpu(format!("{} cannot be used: {error}", adapter.info().name)),
            Err(error) => Err(error),
        }
    }

    /// Opens the devices of a workload, in the order of their indices. The CPU alone where there is no Vulkan device
    /// and none was asked for.
    ///
    /// # Errors
    /// Those of [`DeviceArguments::open`].
    pub fn open_all(&self, devices: Devices) -> Result<Vec<Opened>> {
        let chosen = self.open()?;
        let is_vulkan = matches!(chosen.device, Device::Vulkan(_));
        match devices {
            Devices::CpuAndVulkan if is_vulkan => Ok(vec![self.cpu("for what runs on the CPU".into())?, chosen]),
            _ => Ok(vec![chosen]),
        }
    }

    /// Opens a device again by its index in [`DeviceArguments::open_all`].
    ///
    /// # Errors
    /// Those of [`DeviceArguments::open`].
    pub fn open_again(&self, devices: Devices, index: usize) -> Result<Opened> {
        match (devices, index) {
            (Devices::CpuAndVulkan, 0) => self.cpu("for what runs on the CPU".into()),
            _ => self.open(),
        }
    }

    fn cpu(&self, reason: String) -> Result<Opened> {
        Ok(Opened { device: Device::Cpu(CpuDevice::new(self.threads)?), reason })
    }
}

/// Tells the user which device it is, and why.
pub fn announce(device: &Opened) {
    let info = device.device.info();
    let driver = if info.driver.is_empty() { String::new() } else { format!(", {}", info.driver) };
    output::note(&format!("device: {}{driver} ({}; {})", info.name, info.device_type.in_words(), device.reason));
}
