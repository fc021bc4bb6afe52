//! Figures as SVG: 5.1 to 5.4 of the thesis, and bars of frame times.

mod content;

use super::data::Data;
use crate::error::Result;
use crate::report::figure::{Figure, Missing};

/// All figures that there is data for, and the others.
///
/// # Errors
/// None in practice: drawing goes to memory.
pub fn all(data: &Data) -> Result<(Vec<Figure>, Vec<Missing>)> {
    let (mut figures, mut missing) = (Vec::new(), Vec::new());
    for kind in &content::KINDS {
        let before = figures.len();
        for device in in_order(data, kind.device) {
            let end = end_of_names(data, kind.device, device);
            for (suffix, caption, picture) in (kind.pictures)(data, device) {
                let name = format!("{}{suffix}{end}", kind.file);
                figures.push(Figure::draw(kind.id, name, caption, &picture)?);
            }
        }
        if figures.len() == before {
            missing.push(Missing { id: kind.id, what: kind.what.into(), needs: kind.needs });
        }
    }
    Ok((figures, missing))
}

/// Devices in the order of their figures: of the thesis's devices the one that it shows comes first.
fn in_order(data: &Data, shown: &str) -> Vec<usize> {
    let mut devices: Vec<usize> = (0..data.devices.len()).collect();
    devices.sort_by_key(|device| data.published && data.devices[*device].label != shown);
    devices
}

/// The end of the names of a device's figures. It is empty for the first measured device and for the published device
/// that the thesis shows; otherwise it names the device.
fn end_of_names(data: &Data, shown: &str, device: usize) -> String {
    let label = &data.devices[device].label;
    match device {
        _ if data.published && label == shown => String::new(),
        _ if data.published => format!("-{}", label.to_lowercase()),
        0 => String::new(),
        further => format!("-device{}", further + 1),
    }
}
