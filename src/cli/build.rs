//! `rtbench build`: structures alone.

use super::library::LibraryArguments;
use super::output;
use crate::accel::Selection;
use crate::bench::plan::{self, parse_list};
use crate::bench::sweep;
use crate::error::{Error, Result};
use crate::results::record::StructureRecord;
use crate::results::statistics;
use crate::results::summary::{self, StructureRow};
use crate::results::{files, table};
use clap::Args;
use std::path::PathBuf;
use std::process::ExitCode;

/// Build structures and report their properties, sizes and build times
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// Scene file, or name of a scene with options; may be repeated
    #[arg(long, required = true, value_name = "FILE|NAME[:KEY=VALUE,..]")]
    scene: Vec<String>,
    /// Structures with options; comma list, may be repeated
    #[arg(long, value_name = "NAME[:KEY=VALUE,..]", default_value = "grid,kdtree,bvh,ploc-stack")]
    structure: Vec<String>,
    /// Build each structure this often; the median of the build times is reported
    #[arg(long, value_name = "N", default_value_t = 1)]
    runs: usize,
    /// Threads; 0 for all
    #[arg(long, value_name = "N", default_value_t = 0)]
    threads: usize,
    /// Check every invariant of each structure; what breaks one makes the exit code 1
    #[arg(long)]
    validate: bool,
    /// Also write the table as a CSV file, with the columns of a sweep's structures.csv
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    #[command(flatten)]
    library: LibraryArguments,
}

const EXAMPLES: &str = "\
Examples:
  rtbench build --scene bunny.ply
  rtbench build --scene bunny.ply --structure bvh --threads 1 --runs 9
      a build time to hold against another builder's
  rtbench build --scene stadium --structure grid,grid:factor=8 --validate --csv grids.csv";

/// Runs the command.
///
/// # Errors
/// Of scene, structure or output.
pub fn run(arguments: &Arguments) -> Result<ExitCode> {
    let selections = parse_list(&arguments.structure, Selection::parse)?;
    if !(1..=1000).contains(&arguments.runs) {
        return Err(Error::argument("--runs", format!("{} runs", arguments.runs), "give 1 to 1000"));
    }
    let mut rows = Vec::new();
    let mut broken = 0;
    for what in &arguments.scene {
        let scene = arguments.library.load(what)?;
        let scene_record = plan::scene_record(&scene);
        for selection in &selections {
            let mut built = selection.build(&scene, arguments.threads)?;
            let mut times = vec![built.build_ms];
            for _ in 1..arguments.runs {
                built = selection.build(&scene, arguments.threads)?;
                times.push(built.build_ms);
            }
            if !built.note.is_empty() {
                output::note(&format!("{} {}: {}", scene.name, selection.name(), built.note));
            }
            if arguments.validate {
                match built.structure.validate(&scene) {
                    Ok(()) => output::note(&format!("{} {}: valid", scene.name, selection.name())),
                    Err(problem) => {
                        broken += 1;
                        output::complain(&format!("{} {}: {problem}", scene.name, selection.name()));
                    }
                }
            }
            rows.push(StructureRow::new(&StructureRecord {
                scene: scene_record.clone(),
                structure: selection.name().to_string(),
                variant: selection.variant(),
                properties: built.structure.properties(&scene),
                build_ms: statistics::median(&times).unwrap_or(built.build_ms),
                build_threads: built.build_threads,
                memory: sweep::memory(&built, &scene, None),
                note: built.note.clone(),
            }));
        }
    }
    output::print(&table::structures(&rows))?;
    if let Some(path) = &arguments.csv {
        files::replace(path, &summary::structures_csv(&rows)?)?;
    }
    Ok(ExitCode::from(u8::from(broken > 0)))
}
