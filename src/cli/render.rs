//! `rtbench render`: one frame as a picture.

use super::device::{self, DeviceArguments};
use super::interrupt;
use super::library::{LibraryArguments, file_name};
use super::output;
use crate::camera::CameraPath;
use crate::device::CpuDevice;
use crate::error::{Error, Result};
use crate::guard;
use crate::record::picture;
use crate::workloads::size::parse_size;
use crate::workloads::trace::backend::{Backend, Counters, surface_epsilon};
use crate::workloads::trace::{Agreement, Selection, counting, pictures, rays, tracer};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Write a PNG of one frame, or a heat map of what its rays cost
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// Scene file, or name of a scene with options
    #[arg(long, value_name = "FILE|NAME[:KEY=VALUE,..]", value_parser = file_name())]
    scene: String,
    /// Camera path, instead of the scene's own
    #[arg(long, value_name = "FILE|NAME", value_parser = file_name())]
    camera_path: Option<String>,
    /// Structure with options
    #[arg(long, value_name = "NAME[:KEY=VALUE,..]", default_value = "bvh-stack")]
    structure: String,
    /// Ray configuration
    #[arg(long, value_name = "P|PS|PSR|AO|DIFFUSE", default_value = "PSR")]
    config: String,
    /// Image size in pixels
    #[arg(long, value_name = "N|WxH", default_value = "512")]
    resolution: String,
    /// Frame of the path, counted from 0
    #[arg(long, value_name = "N", default_value_t = 0)]
    frame: usize,
    /// Colour each pixel by what its rays cost, all ray types together
    #[arg(long, value_enum)]
    heatmap: Option<Heatmap>,
    /// Value that gets the brightest colour, to compare heat maps [default: the largest of the image]
    #[arg(long, value_name = "N", requires = "heatmap")]
    scale_max: Option<u32>,
    /// Picture
    #[arg(long, short, value_name = "FILE", default_value = "render.png")]
    out: PathBuf,
    #[command(flatten)]
    library: LibraryArguments,
    #[command(flatten)]
    device: DeviceArguments,
}

const EXAMPLES: &str = "\
Examples:
  rtbench render --scene hall --resolution 1280x720 -o hall.png
      the first frame of the scene's own camera path
  rtbench render --scene bunny.ply --frame 100 --config PS
      a quarter of the way around
  rtbench render --scene stadium --structure grid --config P --heatmap steps -o grid.png
      where a grid wastes its steps: dark is none, yellow the most of the image";

/// Lanes of the warps of a heat map.
const WARP: u32 = 32;

/// What a heat map shows.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Heatmap {
    /// Nodes or cells visited
    Steps,
    /// Ray/triangle tests
    Tests,
    /// Restarts at or below the root
    Restarts,
    /// Ropes, or links to parents, followed
    Ropes,
    /// Percentage of the lanes of warps of 32 that take part in what these issue, by work-groups, counted on the CPU
    Utilisation,
}

impl Heatmap {
    fn of(self, counters: &Counters) -> u32 {
        match self {
            Heatmap::Steps => counters.steps(),
            Heatmap::Tests => counters.tests,
            Heatmap::Restarts => counters.restarts,
            Heatmap::Ropes => counters.ropes,
            Heatmap::Utilisation => 0, // of no single pixel
        }
    }

    fn name(self) -> &'static str {
        match self {
            Heatmap::Steps => "steps",
            Heatmap::Tests => "triangle tests",
            Heatmap::Restarts => "restarts",
            Heatmap::Ropes => "ropes",
            Heatmap::Utilisation => "lanes of warps that take part [%]",
        }
    }
}

/// Runs the command.
///
/// # Errors
/// Those of loading, of building, of the device and of the output.
pub fn run(arguments: &Arguments) -> Result<()> {
    let selection = Selection::parse(&arguments.structure)?;
    if arguments.heatmap.is_some() && selection.method().traversal.agreement == Agreement::HitsOnly {
        let problem = format!("nothing but rays is counted for {}", selection.name());
        return Err(Error::argument("--heatmap", problem, "leave it out, or choose another structure"));
    }
    interrupt::at_once()?;
    let config = rays::parse_config(&arguments.config)?;
    let size = parse_size(&arguments.resolution)?;
    arguments.device.check()?;
    let scene = arguments.library.load(&arguments.scene)?;
    let path = CameraPath::named_or_fitting(arguments.camera_path.as_deref(), &scene, config.shadows())?;
    guard::check_output(&arguments.out)?;
    let views = path.views(&scene, None)?;
    let view = views.get(arguments.frame).ok_or_else(|| {
        let problem = format!("the path {} has no frame {}", path.name, arguments.frame);
        Error::argument("--frame", problem, format!("give 0 to {}", views.len().saturating_sub(1)))
    })?;
    let device = arguments.device.open()?;
    device::announce(&device);
    let built = selection.build(&scene, arguments.device.threads)?;
    let mut prepared = tracer::prepare(&device.device, &scene, &*built.structure, selection.method())?;
    let rgba = match arguments.heatmap {
        None => pictures::image(&mut *prepared, config, view, size)?,
        Some(heatmap) => {
            let values = match heatmap {
                Heatmap::Utilisation => {
                    let cpu = CpuDevice::new(arguments.device.threads)?;
                    cpu.prepare(&scene, &*built.structure, selection.method())?.utilisation(config, view, size, WARP)?
                }
                _ => pictures::per_pixel(&mut *prepared, config, view, size, &|counters| heatmap.of(counters))?,
            };
            paint(heatmap, arguments.scale_max, &values)?
        }
    };
    let one = std::slice::from_ref(view);
    let counted =
        counting::count(&mut *prepared, config, one, (size, surface_epsilon(scene.bounds())), &mut || Ok(()))?;
    counted.warnings(1).iter().for_each(|warning| output::note(&format!("warning: {warning}")));
    picture::write_png(&arguments.out, size.width, size.height, &rgba)?;
    output::print(&format!(
        "{}: {} {} {config:?}, {}x{}, frame {} of {} on {}\n",
        arguments.out.display(),
        scene.name,
        selection.full_name(),
        size.width,
        size.height,
        arguments.frame,
        views.len(),
        path.name,
    ))
}

/// Colours counts and prints what the colours mean.
fn paint(heatmap: Heatmap, scale_max: Option<u32>, values: &[u32]) -> Result<Vec<u8>> {
    let min = values.iter().copied().min().unwrap_or(0);
    let max = values.iter().copied().max().unwrap_or(0);
    let mean = values.iter().map(|&v| f64::from(v)).sum::<f64>() / values.len().max(1) as f64;
    let top = scale_max.unwrap_or(max).max(1);
    output::print(&format!(
        "{} per pixel: min {min}, mean {mean:.2}, max {max}; colours from dark blue (0) by way of red to yellow ({top})\n",
        heatmap.name(),
    ))?;
    Ok(picture::heat_map(values, top))
}
