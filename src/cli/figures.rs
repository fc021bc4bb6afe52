//! `rtbench figures`: the thesis's figures as SVG.

use super::output;
use super::runs::RunArguments;
use crate::error::{Error, Result};
use crate::record::files;
use crate::thesis::figures;
use clap::Args;
use std::path::PathBuf;

/// Draw the thesis's figures from recorded runs
///
/// SVG for figures 5.1 to 5.4, and bars of frame times. Without a run, what the thesis printed is drawn. A figure without
/// data is not drawn, and named.
#[derive(Args, Debug)]
pub struct Arguments {
    #[command(flatten)]
    runs: RunArguments,
    /// Folder for the figures; files of the same names are replaced
    #[arg(long, short, value_name = "FOLDER")]
    output: PathBuf,
}

/// Runs the command.
///
/// # Errors
/// A run that cannot be read, a folder that cannot be written to.
pub fn run(arguments: &Arguments) -> Result<()> {
    let sources = arguments.runs.read()?;
    let (figures, missing) = figures::all(&sources.data)?;
    for absent in missing {
        let what = if absent.id == "bars" { "bars of frame times".into() } else { format!("figure {}", absent.id) };
        output::note(&format!("{what} is not drawn: it needs {}", absent.needs));
    }
    std::fs::create_dir_all(&arguments.output).map_err(|source| Error::output(&arguments.output, source))?;
    let mut text = String::new();
    for figure in figures {
        let path = arguments.output.join(format!("{}.svg", figure.name));
        files::replace(&path, figure.svg.as_bytes())?;
        text += &format!("{}\n", path.display());
    }
    output::print(&text)
}
