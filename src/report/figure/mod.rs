//! Figures as SVG: panels with lines, bars or stacked bands, a legend, colours for paper and for a dark page.

mod axis;
mod draw;
mod theme;

pub use axis::{Axis, spreads};
pub use draw::{Band, Bar, Mark, Panel, Picture, Series};
pub use theme::STYLES;

use crate::error::{Error, Result};
use std::path::Path;

/// A drawn figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// The figure's number or name in its source.
    pub id: &'static str,
    /// File name without `.svg`.
    pub name: String,
    /// What the figure shows, for the page around it.
    pub caption: String,
    /// The SVG document.
    pub svg: String,
}

/// A figure without data.
#[derive(Clone, Debug, PartialEq)]
pub struct Missing {
    /// The figure's number or name in its source.
    pub id: &'static str,
    /// The figure in words: `figure 5.1`.
    pub what: String,
    /// What has to be measured for it.
    pub needs: &'static str,
}

impl Figure {
    /// Draws a picture.
    ///
    /// # Errors
    /// None in practice: drawing goes to memory.
    pub fn draw(id: &'static str, name: String, caption: String, picture: &Picture) -> Result<Figure> {
        let failed = |e| Error::output(Path::new(&name), std::io::Error::other(format!("{e}")));
        let svg = draw::svg(picture).map_err(failed)?;
        Ok(Figure { id, name, caption, svg })
    }
}

/// The rules that exchange the figures' colours on a dark page.
pub(crate) fn style_sheet() -> String {
    theme::style_sheet()
}
