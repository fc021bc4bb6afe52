//! Rows of earlier sessions of the same run. Rows of different programs, devices or inputs must never be in one table:
//! a run is resumed only if nothing of that differs.

use super::workload::{Case, Info};
use crate::error::{Error, Result};
use crate::record::journal::{FILE_NAME, Journal};
use crate::record::row::{Input, Key, Row};
use crate::record::run::Provenance;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// What to do where a run cannot be resumed.
const HINT: &str = "begin a new run: rows of both must not be in one table";

/// The rows of earlier sessions; none for a run that begins.
#[derive(Default)]
pub struct PreviousRun {
    path: PathBuf,
    journal: Option<Journal>,
    /// Index of each row that need not be measured again, by key and device of the plan.
    done: HashMap<(Key, usize), usize>,
    /// For each device of the plan, its index among the recorded ones; empty where both are the same.
    devices: Vec<usize>,
}

impl PreviousRun {
    /// Reads the journal of the run in `folder`.
    ///
    /// # Errors
    /// Those of [`Journal::read`].
    pub fn read(folder: &Path) -> Result<PreviousRun> {
        let path = folder.join(FILE_NAME);
        let journal = Journal::read(&path)?;
        let done = journal.rows.iter().enumerate().filter(|(_, row)| row.status.is_final());
        let role = |row: &Row| journal.provenance.role(row.device);
        let done = done.map(|(index, row)| ((row.key.clone(), role(row)), index)).collect();
        Ok(PreviousRun { path, journal: Some(journal), done, devices: Vec::new() })
    }

    /// Its journal.
    pub fn journal(&self) -> Option<&Journal> {
        self.journal.as_ref()
    }

    /// The first line of its journal.
    pub fn provenance(&self) -> Option<&Provenance> {
        Some(&self.journal.as_ref()?.provenance)
    }

    /// Bytes that have been read of its journal.
    pub fn length(&self) -> u64 {
        self.journal.as_ref().map_or(0, |journal| journal.length)
    }

    /// Number of rows that need not be measured again.
    pub fn done(&self) -> usize {
        self.done.len()
    }

    /// True if the run ended in order and no row is worth another attempt.
    pub fn is_complete(&self) -> bool {
        self.journal.as_ref().is_some_and(|journal| {
            journal.end.as_ref().is_some_and(|end| end.complete) && journal.rows.len() == self.done.len()
        })
    }

    /// Refuses to go on with another program, device, machine or plan.
    ///
    /// # Errors
    /// [`Error::Input`] that names what differs.
    pub fn check(&mut self, now: &Provenance) -> Result<()> {
        let Some(before) = self.provenance() else { return Ok(()) };
        let part = before.merged.iter().find(|run| {
            let devices =
                run.devices.iter().filter_map(|&device| before.devices.get(device)).map(|device| &device.info);
            run.environment.machine() == now.environment.machine()
                && devices.eq(now.devices.iter().map(|device| &device.info))
                && run.executable_hash == now.program.executable_hash
        });
        let own_devices = part.map(|run| run.devices.clone());
        let is_merged = !before.merged.is_empty();
        let revision = |p: &Provenance| format!("{}, built from {}", p.program.version, p.program.git_revision);
        let devices = |p: &Provenance| p.devices.iter().map(|device| device.info.clone()).collect::<Vec<_>>();
        let what = if is_merged && own_devices.is_none() {
            "it was merged from runs of other machines, devices or builds than this one".into()
        } else if !is_merged && before.program != now.program {
            let (before, now) = (revision(before), revision(now));
            let difference = if before == now { "with other sources or settings, " } else { "" };
            format!("another build of the program ({difference}{before}) than this one ({now}) measured it")
        } else if !is_merged && devices(before) != devices(now) {
            let names = |p: &Provenance| {
                let names = p.devices.iter().map(|device| device.info.with_driver());
                names.collect::<Vec<_>>().join(", ")
            };
            format!("it was measured on {}, not on {}, or with other switches", names(before), names(now))
        } else if !is_merged && before.environment.machine() != now.environment.machine() {
            "the machine or its variables (RTBENCH_*, VK_*, LP_*, ...) have changed since".into()
        } else if before.workload != now.workload || !before.plan.is_same(&now.plan) {
            "inputs, axes or the preset's file are not the same any more".into()
        } else {
            self.devices = own_devices.unwrap_or_default();
            return Ok(());
        };
        Err(self.refusal(what))
    }

    /// The index among the recorded devices of a device of the plan.
    pub fn device(&self, of_plan: usize) -> usize {
        self.devices.get(of_plan).copied().unwrap_or(of_plan)
    }

    /// Refuses to go on with an input whose content has changed under its name.
    ///
    /// # Errors
    /// [`Error::Input`] that names it.
    pub fn check_inputs(&self, inputs: &[Input]) -> Result<()> {
        for input in inputs {
            let known = || self.inputs().iter().filter(|known| known.kind == input.kind && known.name == input.name);
            if known().next().is_some() && known().all(|known| known.hash != input.hash) {
                let kind = input.kind.replace('_', " ");
                return Err(self.refusal(format!("{} is not the {kind} that it was", input.name)));
            }
        }
        Ok(())
    }

    fn refusal(&self, problem: String) -> Error {
        Error::file(&self.path, None, problem, HINT)
    }

    fn inputs(&self) -> &[Input] {
        self.journal.as_ref().map_or(&[], |journal| &journal.inputs)
    }

    /// The row of a key, if it need not be measured again.
    pub fn row(&self, key: &Key, device: usize) -> Option<&Row> {
        let index = *self.done.get(&(key.clone(), device))?;
        self.journal.as_ref()?.rows.get(index)
    }

    /// True if an input has been recorded.
    pub fn has_input(&self, input: &Input) -> bool {
        self.inputs()
            .iter()
            .any(|known| (&known.kind, &known.name, &known.hash) == (&input.kind, &input.name, &input.hash))
    }

    /// True if there is a row whose input was the one that a case needs, and could be opened.
    pub fn has_opened(&self, info: &Info, case: &Case) -> bool {
        let subject = info.axes.first().map_or("", |axis| axis.name);
        let mut rows = self.journal.iter().flat_map(|journal| &journal.rows);
        rows.any(|row| !row.key.inputs.is_empty() && row.key.axis(subject) == case.axis(subject))
    }

    /// Keys of the artifacts that have been recorded.
    pub fn artifacts(&self) -> Vec<Key> {
        let artifacts = self.journal.iter().flat_map(|journal| &journal.artifacts);
        artifacts.map(|artifact| artifact.key.clone()).collect()
    }
}
