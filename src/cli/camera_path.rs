//! `rtbench camera-path`: where cameras go.

use super::library::LibraryArguments;
use super::output;
use crate::camera::{self, CameraPath};
use crate::error::{Error, Result};
use crate::record::files;
use crate::workloads::trace::rays::Config;
use clap::Subcommand;
use std::path::{Path, PathBuf};

/// List the built-in camera paths, or write a scene's camera path to a file
#[derive(Subcommand, Debug)]
#[command(after_help = EXAMPLES)]
pub enum Command {
    /// List the built-in camera paths
    List,
    /// Write a scene's camera path, frame by frame
    ///
    /// A file that ends in .csv gets a row per frame: frame, time, position, direction, up. Any other becomes a camera
    /// path file that shows the same views again, to the bit. Positions are in the coordinates of the scene's file. A
    /// path whose light moves cannot be written.
    Export {
        /// Scene file, or built-in scene with parameters
        #[arg(value_name = "FILE|NAME[:KEY=VALUE,..]")]
        scene: String,
        #[command(flatten)]
        library: LibraryArguments,
        /// Camera path, instead of the scene's own
        #[arg(long, value_name = "FILE|NAME")]
        camera_path: Option<String>,
        /// Thin the path evenly to this many frames
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
/// Of scene, path or output.
pub fn run(command: &Command) -> Result<()> {
    match command {
        Command::List => {
            let line = |(name, frames, description)| format!("{name:<14}{frames:>6} frames  {description}\n");
            output::print(&camera::descriptions().into_iter().map(line).collect::<String>())
        }
        Command::Export { scene, library, camera_path, frames, out } => {
            let (scene, sources) = library.load_with_sources(scene)?;
            files::keep(out, sources.paths().chain(camera_path.as_deref().map(Path::new)))?;
            let path = CameraPath::named_or_fitting(camera_path.as_deref(), &scene, Config::P.shadows())?;
            if path.moves_light() {
                let name = camera_path.as_deref().unwrap_or(&path.name);
                let problem = "its light moves, and recorded frames have only a camera";
                return Err(Error::argument(name, problem, format!("use the path itself: --camera-path {name}")));
            }
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
