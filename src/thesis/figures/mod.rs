//! Figures as SVG: 5.1 to 5.4 of the thesis, and bars of frame times.

mod axis;
mod content;
mod draw;
mod theme;

pub use theme::style_sheet;

use super::data::Data;
use crate::error::{Error, Result};
use std::path::Path;

/// A drawn figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Number in the thesis, or `bars`.
    pub id: &'static str,
    /// File name without `.svg`.
    pub name: String,
    /// What it shows, for the page around it.
    pub caption: String,
    /// The document.
    pub svg: String,
}

/// A figure that has no data.
#[derive(Clone, Debug, PartialEq)]
pub struct Missing {
    /// Number in the thesis, or `bars`.
    pub id: &'static str,
    /// What would have to be measured.
    pub needs: &'static str,
}

/// All figures that there is data for, and the others.
///
/// # Errors
/// None in practice: drawing goes to memory.
pub fn all(data: &Data) -> Result<(Vec<Figure>, Vec<Missing>)> {
    let (mut figures, mut missing) = (Vec::new(), Vec::new());
    for kind in &content::KINDS {
        let before = figures.len();
        for device in in_order(data, kind.card) {
            let end = end_of_names(data, kind.card, device);
            for (suffix, caption, picture) in (kind.pictures)(data, device) {
                let name = format!("{}{suffix}{end}", kind.file);
                let failed = |e| Error::output(Path::new(&name), std::io::Error::other(format!("{e}")));
                let svg = draw::svg(&picture).map_err(failed)?;
                figures.push(Figure { id: kind.id, name, caption, svg });
            }
        }
        if figures.len() == before {
            missing.push(Missing { id: kind.id, needs: kind.needs });
        }
    }
    Ok((figures, missing))
}

/// Devices in the order of their figures: of the thesis's cards the one that it shows comes first.
fn in_order(data: &Data, card: &str) -> Vec<usize> {
    let mut devices: Vec<usize> = (0..data.devices.len()).collect();
    devices.sort_by_key(|device| data.published && data.devices[*device].label != card);
    devices
}

/// How the names of a device's figures end. Plain are those of the first measured device, and of what the thesis printed
/// those of the card that it shows; its other card's say which it is.
fn end_of_names(data: &Data, card: &str, device: usize) -> String {
    let label = &data.devices[device].label;
    match device {
        _ if data.published && label == card => String::new(),
        _ if data.published => format!("-{}", label.to_lowercase()),
        0 => String::new(),
        further => format!("-device{}", further + 1),
    }
}
