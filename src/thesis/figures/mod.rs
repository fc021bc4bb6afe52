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
        for device in 0..data.devices.len() {
            for (suffix, caption, picture) in (kind.pictures)(data, device) {
                // The first device's figures have the plain names
                let number = if device > 0 { format!("-device{}", device + 1) } else { String::new() };
                let name = format!("{}{suffix}{number}", kind.file);
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
