//! `rtbench build`: builds structures without tracing rays.

use super::interrupt;
use super::library::{LibraryArguments, file_name};
use super::output;
use super::progress::Building;
use crate::error::{Error, Result};
use crate::guard;
use crate::harness::parse_list;
use crate::record::files;
use crate::record::row::{Artifact, Input};
use crate::scene::Scene;
use crate::workloads::trace::record::SceneRecord;
use crate::workloads::trace::{Selection, artifacts, building, input};
use clap::Args;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::Ordering;

/// Build structures and report their properties, sizes and build times
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// Scene file, or name of a scene, with options; may be repeated
    #[arg(long, required = true, value_name = "FILE|NAME[:KEY=VALUE,..]", value_parser = file_name())]
    scene: Vec<String>,
    /// Structures with options; comma list, may be repeated
    #[arg(long, value_name = "NAME[:KEY=VALUE,..]", default_value = "grid,kdtree,bvh,ploc-stack")]
    structure: Vec<String>,
    /// Build each structure N times and report the median build time
    #[arg(long, value_name = "N", default_value_t = 1)]
    runs: usize,
    /// Number of threads; 0 for one per processor
    #[arg(long, value_name = "N", default_value_t = 0)]
    threads: usize,
    /// Check every invariant of each structure; the exit code is 1 if one is violated
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
      a build time to compare with another builder's
  rtbench build --scene stadium --structure grid,grid:factor=8 --validate --csv grids.csv";

/// Runs the command. Ctrl-C does not wait for the running build; the structures built until then are reported.
///
/// # Errors
/// Those of loading a scene, of building, and of the output; [`Error::Interrupted`] after Ctrl-C.
pub fn run(arguments: &Arguments) -> Result<ExitCode> {
    let selections = parse_list(&arguments.structure, Selection::parse_all)?.concat();
    if !(1..=1000).contains(&arguments.runs) {
        return Err(Error::argument("--runs", format!("{} runs", arguments.runs), "give 1 to 1000"));
    }
    let stop = interrupt::flag(|| output::note("stopping; Ctrl-C again ends the program at once"))?;
    let mut job =
        Job { arguments, interrupted: &|| stop.load(Ordering::Relaxed), rows: Vec::new(), broken: 0, refused: None };
    let ended = arguments.scene.iter().try_for_each(|name| job.scene(name, &selections));
    if matches!(ended, Ok(()) | Err(Error::Interrupted)) && !(ended.is_err() && job.rows.is_empty()) {
        let rows: Vec<artifacts::Row> = job.rows.iter().map(|(artifact, scene)| (artifact, scene)).collect();
        output::print(&artifacts::table(&rows))?;
        if let Some(path) = &arguments.csv {
            files::replace(path, &artifacts::csv(&rows)?)?;
        }
    }
    match job.refused.filter(|_| job.rows.is_empty()) {
        Some(refused) if ended.is_ok() => Err(refused),
        _ => ended.map(|()| ExitCode::from(u8::from(job.broken > 0))),
    }
}

/// The command's arguments and the results so far.
struct Job<'a> {
    arguments: &'a Arguments,
    interrupted: &'a dyn Fn() -> bool,
    rows: Vec<(Artifact, Input)>,
    /// How many structures are not valid.
    broken: usize,
    /// Why the last structure was not built that cannot be.
    refused: Option<Error>,
}

impl Job<'_> {
    fn scene(&mut self, name: &str, selections: &[Selection]) -> Result<()> {
        let scene = Arc::new(self.arguments.library.load(name)?);
        self.arguments.csv.as_deref().map_or(Ok(()), guard::check_output)?;
        if (self.interrupted)() {
            return Err(Error::Interrupted);
        }
        let record = input::scene_record(&scene);
        selections.iter().try_for_each(|selection| self.structure(&scene, &record, selection))
    }

    fn structure(&mut self, scene: &Arc<Scene>, record: &SceneRecord, selection: &Selection) -> Result<()> {
        let name = format!("{} {}", scene.name, selection.full_name());
        let running = Building::begin(&format!("{} of {}", selection.full_name(), scene.name));
        let Arguments { runs, threads, .. } = self.arguments;
        let built = building::build_repeatedly(selection, scene, *threads, *runs, self.interrupted);
        drop(running);
        let built = match built {
            Ok(built) => built,
            // What one structure cannot do costs no other one
            Err(error @ Error::Refused(_)) => {
                output::note(&format!("{name}: skipped: {error}"));
                self.refused = Some(error);
                return Ok(());
            }
            Err(error) => return Err(error),
        };
        if !built.note.is_empty() {
            output::note(&format!("{name}: {}", built.note));
        }
        if self.arguments.validate {
            match built.structure.validate(scene) {
                Ok(()) => output::note(&format!("{name}: valid")),
                Err(problem) => {
                    self.broken += 1;
                    output::complain(&format!("{name}: {problem}"));
                }
            }
        }
        self.rows.push((input::artifact(record, selection, &built, scene, None), record.to_input()));
        Ok(())
    }
}
