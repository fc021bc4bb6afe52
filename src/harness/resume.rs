//! What an earlier session of the same run left to build on. Rows of different programs, devices or scenes must never
//! stand in one table: whatever differs is refused.

use crate::error::{Error, Result};
use crate::harness::plan::Path;
use crate::record::journal::{FILE_NAME, Journal};
use crate::record::schema::{ConfigurationRecord, Identity, Provenance, SceneRecord, StructureRecord};
use std::collections::HashMap;
use std::path::PathBuf;

/// What can be done where a run cannot be taken up again.
const HINT: &str = "begin a new run: rows of both must not stand in one table";

/// The rows of an earlier session; none for a run that begins.
#[derive(Default)]
pub struct Earlier {
    path: PathBuf,
    journal: Option<Journal>,
    /// Rows that need not be measured again, by what was asked for.
    settled: HashMap<Identity, usize>,
}

impl Earlier {
    /// Reads the journal of the run in `folder`.
    ///
    /// # Errors
    /// Those of [`Journal::read`].
    pub fn read(folder: &std::path::Path) -> Result<Earlier> {
        let path = folder.join(FILE_NAME);
        let journal = Journal::read(&path)?;
        let settled = journal.configurations.iter().enumerate().filter(|(_, row)| row.is_settled());
        let settled = settled.map(|(place, row)| (row.identity(), place)).collect();
        Ok(Earlier { path, journal: Some(journal), settled })
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
    pub fn settled(&self) -> usize {
        self.settled.len()
    }

    /// True if the run ended in order and every row is settled.
    pub fn is_complete(&self) -> bool {
        self.journal.as_ref().is_some_and(|journal| {
            journal.end.as_ref().is_some_and(|end| end.complete) && journal.configurations.len() == self.settled.len()
        })
    }

    /// Refuses to go on with another program, device, machine or plan.
    ///
    /// # Errors
    /// [`Error::Input`] that names what differs.
    pub fn check(&self, now: &Provenance) -> Result<()> {
        let Some(before) = self.provenance() else { return Ok(()) };
        let machine = |p: &Provenance| {
            let e = &p.environment;
            (e.architecture.clone(), e.cpu.clone(), e.logical_cpus, e.variables.clone())
        };
        let revision = |p: &Provenance| format!("{}, built from {}", p.program.version, p.program.git_revision);
        let what = if before.program != now.program {
            let (before, now) = (revision(before), revision(now));
            format!("another build of the program ({before}) than this one ({now}) measured it")
        } else if before.device != now.device {
            let device = |p: &Provenance| format!("{} {}", p.device.name, p.device.driver);
            format!("it was measured on {}, not on {}, or with other switches", device(before), device(now))
        } else if machine(before) != machine(now) {
            "the machine or its variables (RTBENCH_*, VK_*, LP_*, ...) have changed since".into()
        } else if before.plan != now.plan {
            "scenes, structures or the preset's file are not the same any more".into()
        } else {
            return Ok(());
        };
        Err(self.refusal(what))
    }

    /// Refuses to go on with a scene, or a camera path through it, whose content has changed under its name.
    ///
    /// # Errors
    /// [`Error::Input`] that names it.
    pub fn check_scene<'p>(&self, scene: &SceneRecord, paths: impl Iterator<Item = &'p Path>) -> Result<()> {
        let rows = self.journal.iter().flat_map(|journal| &journal.configurations);
        let of_scene: Vec<&ConfigurationRecord> = rows.filter(|row| row.scene.name == scene.name).collect();
        if of_scene.first().is_some_and(|_| of_scene.iter().all(|row| row.scene.hash != scene.hash)) {
            return Err(self.refusal(format!("{} is not the scene that it was", scene.name)));
        }
        for path in paths {
            let of_path = || of_scene.iter().filter(|row| row.camera_path.name == path.record.name);
            if of_path().next().is_some() && of_path().all(|row| row.camera_path.hash != path.record.hash) {
                let name = &path.record.name;
                return Err(self.refusal(format!("{name} is not the camera path that it was")));
            }
        }
        Ok(())
    }

    fn refusal(&self, problem: String) -> Error {
        Error::file(&self.path, None, problem, HINT)
    }

    /// The row that has been asked for, if it need not be measured again.
    pub fn row(&self, asked_for: &ConfigurationRecord) -> Option<&ConfigurationRecord> {
        let place = *self.settled.get(&asked_for.identity())?;
        self.journal.as_ref()?.configurations.get(place)
    }

    /// True if the structure has its record.
    pub fn has_structure(&self, asked_for: &StructureRecord) -> bool {
        let key = |s: &StructureRecord| (s.scene.hash.clone(), s.structure.clone(), s.variant.clone());
        self.journal.iter().flat_map(|journal| &journal.structures).any(|known| key(known) == key(asked_for))
    }
}
