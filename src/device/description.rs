//! Devices in words, with what their times are good for.

use super::{DeviceInfo, DeviceType};

impl DeviceInfo {
    /// Name and kind, and whether its times rank algorithms for a GPU.
    pub fn description(&self) -> String {
        let name = &self.name;
        match self.device_type {
            DeviceType::CpuTwin => {
                format!("{name}: code of this program on the CPU; these times do not rank algorithms for a GPU")
            }
            DeviceType::SoftwareRasteriser => {
                format!(
                    "{name}: a software rasteriser, which computes on the CPU; these times do not rank algorithms for a GPU"
                )
            }
            DeviceType::IntegratedGpu => format!("{name}: a GPU that shares the CPU's memory"),
            DeviceType::DiscreteGpu => format!("{name}: a discrete GPU"),
            DeviceType::VirtualGpu => format!("{name}: a virtual GPU"),
            DeviceType::Other => format!("{name}: a device of unknown kind"),
        }
    }
}

impl DeviceType {
    /// As in records and CSV files.
    pub fn slug(self) -> String {
        serde_json::to_value(self).ok().and_then(|value| Some(value.as_str()?.to_owned())).unwrap_or_default()
    }
}
