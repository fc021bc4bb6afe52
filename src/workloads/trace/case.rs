//! A case of ray tracing, typed; the harness knows it as axes.

use super::Selection;
use super::backend::Size;
use super::rays::{self, AMBIENT_RAYS, Config};
use crate::error::{Error, Result};
use crate::harness::workload::Case;
use crate::workloads::size::parse_size;

/// What one row measures.
#[derive(Clone, Debug, PartialEq)]
pub struct TraceCase {
    /// Structure and traversal with their options.
    pub selection: Selection,
    /// Ray configuration.
    pub config: Config,
    /// Image size.
    pub size: Size,
    /// Frames that the camera path is thinned to; all where absent.
    pub frames: Option<usize>,
    /// Name or file of the camera path; empty for the scene's own.
    pub camera_path: String,
    /// Lanes of the warps whose work is counted as well; none is where absent.
    pub warp_width: Option<u32>,
}

/// Lanes that a warp can have.
pub const WARP_WIDTHS: [u32; 4] = [8, 16, 32, 64];

/// Reads a value of the axis `warp_width`.
///
/// # Errors
/// [`Error::Input`] for anything but 8, 16, 32 and 64.
pub fn parse_warp_width(text: &str) -> Result<u32> {
    let known = text.parse().ok().filter(|width| WARP_WIDTHS.contains(width));
    known.ok_or_else(|| Error::argument("--warp-width", format!("{text:?} is no width"), "give 8, 16, 32 or 64"))
}

/// The value of the axis `frames` for all frames of a path, until the path is read.
const ALL_FRAMES: &str = "all";

impl TraceCase {
    /// For the harness.
    pub fn to_case(&self, scene: &str) -> Case {
        let TraceCase { selection, config, size, frames, camera_path, warp_width } = self;
        let resolution = format!("{}x{}", size.width, size.height);
        let frames_text = frames.map_or(ALL_FRAMES.to_owned(), |frames| frames.to_string());
        let mut axes: std::collections::BTreeMap<String, String> = [
            ("scene", scene.to_owned()),
            ("camera_path", camera_path.clone()),
            ("structure", selection.name().to_owned()),
            ("config", format!("{config:?}")),
            ("resolution", resolution.clone()),
            ("frames", frames_text.clone()),
        ]
        .map(|(axis, value)| (axis.to_owned(), value))
        .into();
        axes.extend(warp_width.map(|width| ("warp_width".to_owned(), width.to_string())));
        axes.extend(selection.option_axes().map(|(axis, options)| (axis.to_owned(), options)));
        // A ray per pixel and ray type; half of the points are taken to be seen by a light
        let rays_per_pixel = match config {
            Config::P => 2,
            Config::PS => 3,
            Config::PSR => 4,
            Config::AO => 1 + u64::from(AMBIENT_RAYS),
            Config::DIFFUSE => 2,
        };
        Case {
            axes,
            input: scene.to_owned(),
            group: selection.full_name(),
            turn: format!("{config:?} {resolution} {frames_text} {camera_path}").trim_end().to_owned(),
            device: 0,
            work: size.pixels() as u64 * frames.unwrap_or(1) as u64 * rays_per_pixel,
        }
    }

    /// Reads what [`TraceCase::to_case`] wrote.
    ///
    /// # Errors
    /// [`Error::Input`] for a case of another origin.
    pub fn parse(case: &Case) -> Result<TraceCase> {
        let frames = match case.axis("frames") {
            ALL_FRAMES => None,
            number => Some(number.parse().map_err(|_| Error::argument("--frames", format!("{number:?}"), ""))?),
        };
        Ok(TraceCase {
            selection: Selection::parse(&case.group)?,
            config: rays::parse_config(case.axis("config"))?,
            size: parse_size(case.axis("resolution"))?,
            frames,
            camera_path: case.axis("camera_path").to_owned(),
            warp_width: match case.axis("warp_width") {
                "" => None,
                width => Some(parse_warp_width(width)?),
            },
        })
    }
}
