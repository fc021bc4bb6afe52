//! Two builds: whole processes.

use super::{Arguments, Measured, Recorder, kept};
use crate::compare::rounds::{CellTimes, LEAST_ROUNDS, rounds_needed};
use crate::error::{Error, Result};
use crate::harness::ab::SIDES;
use crate::names;
use crate::record::statistics::interleaved_order;
use crate::record::stream::{LeanRun, Names};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The two programs.
///
/// # Errors
/// [`Error::Input`]: there are not two, or one of them is no file.
pub(super) fn programs(exe: &[PathBuf]) -> Result<[&Path; 2]> {
    let [a, b] = exe else {
        let problem = format!("{} programs are given", exe.len());
        return Err(Error::argument("--exe", problem, "give it twice: --exe OLD --exe NEW"));
    };
    for program in [a, b] {
        if !program.is_file() {
            return Err(Error::file(program, None, "there is no such program", "give the file of a build of rtbench"));
        }
    }
    Ok([a, b])
}

/// Measures both programs.
pub(super) fn measure(arguments: &Arguments, [a, b]: [&Path; 2]) -> Result<Measured> {
    let refused = ["--out", "--resume"];
    if let Some(flag) = arguments.flags.iter().find(|flag| refused.contains(&flag.split('=').next().unwrap_or(""))) {
        return Err(Error::argument("--", format!("{flag} has no meaning here"), "give --out before --"));
    }
    let names = [a, b].map(|program| program.display().to_string());
    let (out, mut recorder) = Recorder::create(arguments, [&names[0], &names[1]], Value::Null)?;
    let measured = rounds(arguments, [a, b, a], &out, &mut recorder);
    kept(&out, measured).map(|cells| (out, cells))
}

fn rounds(arguments: &Arguments, programs: [&Path; 3], out: &Path, recorder: &mut Recorder) -> Result<Vec<CellTimes>> {
    let mut cells: Vec<CellTimes> = Vec::new();
    let mut count = arguments.rounds.unwrap_or(LEAST_ROUNDS);
    let mut round = 0;
    while round < count {
        let mut times: [BTreeMap<String, f64>; 3] = Default::default();
        for side in interleaved_order(SIDES.len(), round) {
            let folder = out.join(format!("round-{:02}-{}", round + 1, SIDES[side]));
            times[side] = process(arguments, programs[side], &folder)
                .map_err(|error| named(error, round + 1, SIDES[side], programs[side]))?;
        }
        let [a, b, null] = &times;
        if round == 0 {
            let both = a.keys().filter(|case| b.contains_key(*case) && null.contains_key(*case));
            cells = both.map(|case| CellTimes { label: case.clone(), ..CellTimes::default() }).collect();
            count = arguments.rounds.unwrap_or_else(|| rounds_needed(cells.len()));
        }
        for cell in &mut cells {
            let found = [a, b, null].map(|times| times.get(&cell.label).copied());
            let [Some(a), Some(b), Some(null)] = found else {
                let problem = format!("round {}: {} has no time on every side", round + 1, cell.label);
                return Err(Error::argument("--exe", problem, "see the journals of the round"));
            };
            cell.a.push(a);
            cell.b.push(b);
            cell.null.push(null);
            recorder.round(&cell.label, round + 1, [a, b, null])?;
        }
        round += 1;
    }
    Ok(cells)
}

/// Runs one process, and returns the mean frame time of each row.
fn process(arguments: &Arguments, program: &Path, folder: &Path) -> Result<BTreeMap<String, f64>> {
    // A relative name without a folder would be looked for in PATH
    let program = std::fs::canonicalize(program).unwrap_or_else(|_| program.to_owned());
    let mut command = Command::new(&program);
    command
        .arg(&arguments.workload)
        .args(arguments.flags.iter().map(|flag| names::file(flag)))
        .arg("--quiet")
        .arg("--out")
        .arg(folder);
    let output = command
        .stdin(std::process::Stdio::null())
        .output()
        .map_err(|e| Error::file(&program, None, format!("cannot be started: {e}"), "give an executable file"))?;
    if output.status.code() == Some(130) {
        return Err(Error::Interrupted);
    }
    if !output.status.success() {
        let text = String::from_utf8_lossy(&output.stderr);
        let last = text.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or("it printed nothing").to_owned();
        let last = last.trim_start_matches("rtbench: ").trim_start_matches("error: ").to_owned();
        let problem = format!("it ended with {}: {last}", output.status);
        return Err(Error::file(&program, None, problem, "what was measured until then is kept"));
    }
    let mut names = Names::default();
    let run = LeanRun::read(folder, &mut names)?;
    let time = |row: &crate::record::stream::LeanRow| {
        let axes: Vec<String> = row
            .axes
            .iter()
            .filter(|(_, value)| !names.text(*value).is_empty())
            .map(|(axis, value)| format!("{}={}", names.text(*axis), names.text(*value)))
            .collect();
        Some((axes.join(" "), row.times.as_ref()?.mean_ms))
    };
    Ok(run.rows.iter().filter_map(time).collect())
}

/// An error with its round and side.
fn named(error: Error, round: usize, side: &str, program: &Path) -> Error {
    match error {
        Error::Input(mut input) => {
            input.place = format!("round {round}, side {side}, {}", program.display());
            Error::Input(input)
        }
        other => other,
    }
}
