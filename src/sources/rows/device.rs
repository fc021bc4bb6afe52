//! Devices of runs: which rows of several runs are of the same one, and what it is called.

use crate::device::{DeviceInfo, DeviceType};
use crate::record::run::{Environment, Provenance};

/// A device that was measured.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Device {
    /// The name in titles and columns; unique.
    pub label: String,
    /// The kind; `None` for the devices of published values.
    pub kind: Option<DeviceType>,
    /// Driver, processor, system and the like, by heading; empty where unknown.
    pub facts: Vec<(&'static str, String)>,
    /// True if kernels had wgpu's checks in at least one of the rows that are used.
    pub checked: bool,
}

impl Device {
    /// True if its times say nothing about a GPU: the CPU twins and software rasterisers.
    pub fn is_software(&self) -> bool {
        matches!(self.kind, Some(DeviceType::CpuTwin | DeviceType::SoftwareRasteriser))
    }

    fn new(device: &DeviceInfo, environment: &Environment) -> Device {
        let kind = match device.device_type {
            DeviceType::CpuTwin => "CPU without a driver",
            DeviceType::SoftwareRasteriser => "software rasteriser",
            DeviceType::IntegratedGpu => "integrated GPU",
            DeviceType::DiscreteGpu => "discrete GPU",
            DeviceType::VirtualGpu => "virtual GPU",
            DeviceType::Other => "unknown",
        };
        let threads = device.threads.map_or(String::new(), |n| n.to_string());
        let memory = format!("{:.1} GiB", environment.memory_bytes as f64 / f64::from(1 << 30));
        Device {
            label: device.name.clone(),
            kind: Some(device.device_type),
            facts: vec![
                ("kind", kind.into()),
                ("driver", [device.backend.as_str(), device.driver.as_str()].join(" ").trim().to_owned()),
                ("threads", threads),
                ("processor", environment.cpu.clone()),
                ("main memory", if environment.memory_bytes > 0 { memory } else { String::new() }),
                ("system", environment.os.clone()),
            ],
            checked: false,
        }
    }
}

/// The devices of several runs, each once.
#[derive(Clone, Debug, Default)]
pub struct Devices {
    devices: Vec<Device>,
    identities: Vec<Vec<String>>,
}

impl Devices {
    /// Adds the devices of a run; the index and the record of each, in the run's order.
    pub fn add<'a>(&mut self, provenance: &'a Provenance) -> Vec<(usize, &'a DeviceInfo)> {
        let mut index_of = |info: &DeviceInfo| {
            let identity = identity(info, &provenance.environment);
            self.identities.iter().position(|known| *known == identity).unwrap_or_else(|| {
                self.identities.push(identity);
                self.devices.push(Device::new(info, &provenance.environment));
                self.identities.len() - 1
            })
        };
        provenance.devices.iter().map(|device| (index_of(&device.info), &device.info)).collect()
    }

    /// The devices in the order of their runs. Those of the same name get a number.
    pub fn named(mut self) -> Vec<Device> {
        let names: Vec<String> = self.devices.iter().map(|d| d.label.clone()).collect();
        for (index, device) in self.devices.iter_mut().enumerate() {
            let before = names[..index].iter().filter(|name| **name == device.label).count();
            if before > 0 {
                device.label = format!("{} #{}", device.label, before + 1);
            }
        }
        self.devices
    }
}

/// Two runs are of the same device if this is equal. A device that computes on the CPU is another one on another CPU.
fn identity(device: &DeviceInfo, environment: &Environment) -> Vec<String> {
    let mut identity = vec![device.name.clone(), device.backend.clone(), device.driver.clone()];
    if matches!(device.device_type, DeviceType::CpuTwin | DeviceType::SoftwareRasteriser) {
        identity.extend([environment.cpu.clone(), format!("{:?}", device.threads)]);
    }
    identity
}
