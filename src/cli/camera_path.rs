//! `rtbench camera-path`: lists the built-in camera paths and exports a scene's.

use super::library::{LibraryArguments, file_name};
use super::output;
use crate::camera::{self, CameraPath};
use crate::error::{Error, Result};
use crate::guard;
use crate::record::files;
use crate::workloads::trace::rays::Config;
use clap::Subcommand;
use std::path::PathBuf;

/// List the built-in camera paths, or write a scene's camera path to a file
#[derive(Subcommand, Debug)]
#[command(after_help = EXAMPLES)]
pub enum Command {
    /// List the built-in camera paths
    List,
    /// Write a scene's camera path, frame by frame
    ///
    /// A file that ends in .csv gets a row per frame: frame, time, position, direction, up. Any other file becomes a
    /// camera path file that gives the same views, to the bit. Positions are in the coordinates of the scene's file. A
    /// path with a moving light cannot be exported.
    Export {
        /// Scene file, or name of a scene, with options
        #[arg(value_name = "FILE|NAME[:KEY=VALUE,..]", value_parser = file_name())]
        scene: String,
        #[command(flatten)]
        library: LibraryArguments,
        /// Camera path to export instead of the scene's default
        #[arg(long, value_name = "FILE|NAME", value_parser = file_name())]
        camera_path: Option<String>,
        /// Export only N frames, evenly spaced
        #[arg(long, value_name = "N")]
        frames: Option<usize>,
        /// File to write, .toml or .csv
        #[arg(long, short, value_name = "FILE")]
        out: PathBuf,
    },
}

const EXAMPLES: &str = "\
Examples:
  rtbench camera-path list
  rtbench camera-path export museum6.aff -o museum.toml
  rtbench camera-path export museum6.aff -o museum.csv";

/// Runs the command.
///
/// # Errors
/// Those of loading the scene and the path, and of the output.
pub fn run(command: &Command) -> Result<()> {
    match command {
        Command::List => {
            let line = |(name, frames, description)| format!("{name:<14}{frames:>6} frames  {description}\n");
            output::print(&camera::descriptions().into_iter().map(line).collect::<String>())
        }
        Command::Export { scene, library, camera_path, frames, out } => {
            let scene = library.load(scene)?;
            let path = CameraPath::named_or_fitting(camera_path.as_deref(), &scene, Config::P.shadows())?;
            if path.moves_light() {
                let name = camera_path.as_deref().unwrap_or(&path.name);
                let problem = "its light moves, but an exported path holds only camera poses";
                return Err(Error::argument(name, problem, format!("use the path itself: --camera-path {name}")));
            }
            guard::check_output(out)?;
            let recorded = path.poses(&scene, *frames)?;
            let text = match out.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("csv")) {
                true => camera::to_placed_csv(&scene.placement, &recorded),
                false => {
                    let description = format!("{} in {}", path.name, scene.name);
                    camera::to_placed_toml(&scene.placement, &recorded, &path.lights(&scene), &description)
                }
            };
            files::replace(out, text.as_bytes())?;
            output::print(&format!("{}: {} frames of {}\n", out.display(), recorded.frames.len(), path.name))
        }
    }
}
