//! `rtbench devices`: lists the devices that can run kernels.

use super::output;
use crate::device::{CpuDevice, DeviceInfo, vulkan};
use crate::error::Result;
use clap::Args;

/// List Vulkan adapters with features and limits, and the CPU
///
/// --adapter accepts the number of an adapter, or a part of its name.
#[derive(Args, Debug)]
pub struct Arguments {}

/// Runs the command.
///
/// # Errors
/// Standard output cannot be written.
pub fn run(_: &Arguments) -> Result<()> {
    let adapters = vulkan::adapters();
    let mut text = String::new();
    if adapters.is_empty() {
        text += "no Vulkan adapter (./setup.sh installs a software one)\n\n";
    }
    for (index, adapter) in adapters.iter().enumerate() {
        text += &describe(&format!("--backend vulkan --adapter {index}"), adapter.info());
    }
    text += &describe("--backend cpu", CpuDevice::new(0)?.info());
    output::print(&text)
}

fn describe(flags: &str, device: &DeviceInfo) -> String {
    let mut text = format!("{}\n", device.name);
    let mut line = |name: &str, value: String| text += &format!("  {name:<12}{value}\n");
    line("choose", flags.to_owned());
    line("kind", device.device_type.in_words().to_owned());
    if !device.driver.is_empty() {
        line("driver", device.driver.clone());
    }
    if let Some(threads) = device.threads {
        line("threads", threads.to_string());
    }
    if device.backend != "cpu" {
        let none = "none: frame times are wall time".to_owned();
        line("features", if device.features.is_empty() { none } else { device.features.join(", ") });
        for (limit, value) in &device.limits {
            line("limit", format!("{limit} = {value}"));
        }
    }
    text.push('\n');
    text
}
