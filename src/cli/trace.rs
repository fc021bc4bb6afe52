//! `rtbench trace`: given rays, so that rtbench can be held against another engine.

use super::device::{self, DeviceArguments};
use super::interrupt;
use super::library::{LibraryArguments, file_name};
use super::output;
use crate::error::Result;
use crate::guard;
use crate::math::MISS;
use crate::workloads::trace::backend::GivenRay;
use crate::workloads::trace::{Selection, rays_csv, tracer};
use clap::Args;
use std::path::PathBuf;

/// Trace rays from a CSV file and write their hits
///
/// The file's first line names its columns: origin_x, origin_y, origin_z, direction_x, direction_y, direction_z, in any
/// order; others are ignored. Origins are in the coordinates of the scene's file, up to 1e18, and directions have any
/// length. The result has a line t,triangle for each ray: the distance in units of the direction's
/// length and the triangle's index in the file, polygons counted as fans; empty and -1 for a miss. With --any-hit it
/// only says whether something is hit: 0,0 or a miss.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// Scene file, or name of a scene with options
    #[arg(long, value_name = "FILE|NAME[:KEY=VALUE,..]", value_parser = file_name())]
    scene: String,
    /// CSV file of rays
    #[arg(long, value_name = "FILE")]
    rays: PathBuf,
    /// Structure with options
    #[arg(long, value_name = "NAME[:KEY=VALUE,..]", default_value = "bvh-stack")]
    structure: String,
    /// Only whether anything is hit, as a shadow ray asks
    #[arg(long)]
    any_hit: bool,
    /// CSV file of hits
    #[arg(long, short, value_name = "FILE")]
    out: PathBuf,
    #[command(flatten)]
    library: LibraryArguments,
    #[command(flatten)]
    device: DeviceArguments,
}

const EXAMPLES: &str = "\
Examples:
  rtbench trace --scene bunny.ply --rays rays.csv --structure kdtree --backend cpu -o hits.csv
  rtbench trace --scene hall --rays rays.csv --any-hit -o shadows.csv";

/// Runs the command.
///
/// # Errors
/// Those of reading, of building, of the device and of the output.
pub fn run(arguments: &Arguments) -> Result<()> {
    let selection = Selection::parse(&arguments.structure)?;
    interrupt::at_once()?;
    arguments.device.check()?;
    let exact = rays_csv::read_exact(&arguments.rays)?;
    let scene = arguments.library.load(&arguments.scene)?;
    guard::check_output(&arguments.out)?;
    let rays: Vec<_> = exact.iter().map(|ray| ray.place(&scene.placement)).collect();
    let device = arguments.device.open()?;
    device::announce(&device);
    let built = selection.build(&scene, arguments.device.threads)?;
    let mut prepared = tracer::prepare(&device.device, &scene, &*built.structure, selection.method())?;
    let given: Vec<GivenRay> = rays.iter().map(|ray| ray.ray).collect();
    let hits = prepared.trace(&given, arguments.any_hit)?;
    rays_csv::write(&arguments.out, &rays, &hits)?;
    let found = hits.iter().filter(|hit| hit.triangle != MISS).count();
    output::print(&format!("{}: {found} of {} rays hit\n", arguments.out.display(), hits.len()))
}
