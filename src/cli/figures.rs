//! `rtbench figures`: the figures of sources as SVG.

use super::output;
use super::runs::RunArguments;
use crate::error::{Error, Result};
use crate::record::files;
use clap::Args;
use std::path::PathBuf;

/// Draw the figures of the thesis (or another source) from recorded runs, as SVG
///
/// The thesis has figures 5.1 to 5.4 and bars of frame times, rt2 has 4.4 to 4.6 and bars of steps per ray, spheres has
/// bars of times and speed-ups, and how both scale, structures has scatter plots of rays per second. Without a run, the
/// published numbers are drawn. A figure without data is not drawn, and named.
#[derive(Args, Debug)]
pub struct Arguments {
    #[command(flatten)]
    runs: RunArguments,
    /// Folder for the figures, with a folder for each of several sources; files of the same names are replaced
    #[arg(long, short, value_name = "FOLDER")]
    output: PathBuf,
}

/// Runs the command.
///
/// # Errors
/// A run that cannot be read, an unknown source, a folder that cannot be written to.
pub fn run(arguments: &Arguments) -> Result<()> {
    let opened = arguments.runs.read()?;
    let mut text = String::new();
    for (source, results) in opened.each() {
        let (figures, missing) = results.figures()?;
        for absent in missing {
            output::note(&format!("{} is not drawn: it needs {}", absent.what, absent.needs));
        }
        let several = opened.sources.len() > 1;
        let folder = if several { arguments.output.join(source.name) } else { arguments.output.clone() };
        std::fs::create_dir_all(&folder).map_err(|source| Error::output(&folder, source))?;
        for figure in figures {
            let path = folder.join(format!("{}.svg", figure.name));
            files::replace(&path, figure.svg.as_bytes())?;
            text += &format!("{}\n", path.display());
        }
    }
    output::print(&text)
}
