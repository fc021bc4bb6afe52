//! Flags of a workload on the command line of another command, after `--`.

use super::workload::Given;
use crate::error::{Error, Result};
use crate::names;
use crate::workloads;
use std::collections::BTreeMap;
use std::process::ExitCode;

/// Measures with a workload, by flags that come from another command.
///
/// # Errors
/// Flags that the workload does not know; what could not run.
pub fn measure(workload: &str, flags: &[String]) -> Result<ExitCode> {
    Given::from_flags(workload, flags, &[])?.run()
}

impl Given {
    /// Flags of a workload that follow after `--` in another command, as [`names::text`] writes them.
    ///
    /// # Errors
    /// There is no such workload, or it does not know a flag.
    pub(super) fn from_flags(workload: &str, flags: &[String], refused: &[&str]) -> Result<Given> {
        let Some(found) = workloads::find(workload) else {
            let names: Vec<&str> = workloads::ALL.iter().map(|workload| workload.info().name).collect();
            let problem = format!("there is no workload '{workload}'");
            return Err(Error::argument("--workload", problem, format!("one of {}", names.join(", "))));
        };
        if let Some(flag) = flags.iter().find(|flag| refused.contains(&flag.split('=').next().unwrap_or(""))) {
            return Err(Error::argument("--", format!("{flag} has no meaning here"), "leave it out"));
        }
        let command: Vec<String> =
            ["rtbench", workload].map(str::to_owned).into_iter().chain(flags.iter().cloned()).collect();
        let matches = super::cli().try_get_matches_from(command.iter().map(|argument| names::file(argument))).map_err(
            |error| {
                let text = error.render().to_string();
                let first = text.lines().next().unwrap_or_default().trim_start_matches("error: ").to_owned();
                Error::argument("--", first, format!("give flags of `rtbench {workload}`"))
            },
        )?;
        match matches.subcommand() {
            Some((_, matches)) => Ok(Given { arguments: command, ..Given::read(found, matches)? }),
            None => Err(Error::argument("--", "no workload is named", "")),
        }
    }

    /// The same with other values on some axes.
    pub(super) fn with(&self, values: &BTreeMap<String, Vec<String>>) -> Given {
        let mut all = self.values.clone();
        all.extend(values.clone());
        Given { values: all, common: self.common.clone(), arguments: self.arguments.clone(), ..*self }
    }
}
