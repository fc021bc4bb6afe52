//! Sizes of images, which all workloads take in the same form.

use crate::error::{Error, Result};
use crate::record::row::{Metric, Value};

/// An image's size in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Size {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Size {
    /// Number of pixels.
    pub fn pixels(self) -> usize {
        self.width as usize * self.height as usize
    }

    /// Pixels of the longer side.
    pub fn longer_side(self) -> u32 {
        self.width.max(self.height)
    }

    /// A size of the same shape whose longer side has so many pixels.
    #[must_use]
    pub fn with_longer_side(self, pixels: u32) -> Size {
        let longer = u64::from(self.longer_side().max(1));
        let side = |length: u32| ((u64::from(length) * u64::from(pixels) / longer) as u32).max(1);
        Size { width: side(self.width), height: side(self.height) }
    }
}

/// Most pixels of an image on any device: a frame's pixels are also held in main memory.
pub const MAX_PIXELS: u64 = 1 << 26;

/// `N` or `WxH`.
///
/// # Errors
/// [`Error::Input`].
pub fn parse_size(text: &str) -> Result<Size> {
    let wrong =
        |problem: String| Error::argument("--resolution", problem, "give N or WxH in pixels, as 512 or 640x480");
    let (width, height) = text.split_once(['x', 'X']).unwrap_or((text, text));
    match (width.trim().parse::<u32>(), height.trim().parse::<u32>()) {
        (Ok(0), _) | (_, Ok(0)) => Err(wrong(format!("{text} has no pixels"))),
        (Ok(width), Ok(height)) => {
            if u64::from(width) * u64::from(height) > MAX_PIXELS {
                return Err(wrong(format!("{text} has more than {MAX_PIXELS} pixels")));
            }
            Ok(Size { width, height })
        }
        _ => Err(wrong(format!("{text:?} is no image size"))),
    }
}

/// The metrics `width` and `height` of a row's resolution, `WxH`; none for anything else.
pub fn metrics(resolution: &str) -> Vec<Metric> {
    let Some((width, height)) = resolution.split_once('x') else { return Vec::new() };
    let metric = |(name, side): (&str, &str)| {
        Metric::new(name, side.parse().map_or_else(|_| Value::from(side), |n: u64| Value::from(n)))
    };
    [("width", width), ("height", height)].map(metric).into()
}
