//! `rtbench scenes`: lists, describes, converts and downloads scenes.

mod fetch;
mod info;
mod list;

use super::library::{LibraryArguments, file_name};
use super::output;
use crate::error::{Error, Result};
use crate::guard;
use crate::scene::cache;
use clap::Subcommand;
use std::path::PathBuf;

/// List, describe, convert and fetch scenes
#[derive(Subcommand, Debug)]
#[command(after_help = EXAMPLES)]
pub enum Command {
    /// List the built-in scenes, the scenes of the catalogue and where to get them, and the camera paths
    List {
        #[command(flatten)]
        library: LibraryArguments,
    },
    /// Load a scene and describe it
    Info {
        /// Scene file, or name of a scene, with options
        #[arg(value_name = "FILE|NAME[:KEY=VALUE,..]", value_parser = file_name())]
        scene: String,
        #[command(flatten)]
        library: LibraryArguments,
    },
    /// Write a loaded scene to a binary cache, which loads faster
    Convert {
        /// Scene file, or name of a scene, with options
        #[arg(value_name = "FILE|NAME[:KEY=VALUE,..]", value_parser = file_name())]
        scene: String,
        /// Cache file to write
        #[arg(value_name = "OUT.rtb")]
        out: PathBuf,
        #[command(flatten)]
        library: LibraryArguments,
    },
    /// Download a scene of the catalogue from its official source into the folder of scenes, and check its hash
    Fetch {
        /// Name of a scene of the catalogue
        #[arg(value_name = "NAME")]
        scene: String,
        #[command(flatten)]
        library: LibraryArguments,
    },
}

const EXAMPLES: &str = "\
Examples:
  rtbench scenes list --scenes-dir ~/scenes
  rtbench scenes info bunny.ply
  rtbench scenes info hall:triangles=200000
  rtbench scenes convert dragon_vrip.ply dragon.rtb
  rtbench scenes fetch bunny --scenes-dir ~/scenes
      a partial download is continued; no file is overwritten";

/// Runs the command.
///
/// # Errors
/// Those of loading or downloading the scene, and of the output.
pub fn run(command: &Command) -> Result<()> {
    match command {
        Command::List { library } => list::run(library),
        Command::Info { scene, library } => info::run(scene, library),
        Command::Fetch { scene, library } => fetch::run(scene, library),
        Command::Convert { scene, out, library } => convert(scene, out, library),
    }
}

fn convert(name: &str, out: &std::path::Path, library: &LibraryArguments) -> Result<()> {
    if out.extension().is_none_or(|e| !e.eq_ignore_ascii_case(cache::EXTENSION)) {
        let problem = "the cache's name does not end in .rtb";
        return Err(Error::argument(out.display().to_string(), problem, "the file's extension decides its format"));
    }
    let (scene, sources) = library.load_with_sources(name)?;
    guard::check_output(out)?;
    cache::write(&scene, &sources, out)?;
    let (triangles, vertices) = (scene.triangles.len(), scene.vertices.len());
    output::print(&format!("{}: {}, {triangles} triangles, {vertices} vertices\n", out.display(), scene.name))
}
