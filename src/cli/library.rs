//! The folder of scenes: a flag that every command with `--scene` has.

use super::output;
use crate::error::Result;
use crate::scene::{self, Scene};
use clap::Args;
use std::path::PathBuf;

/// Where the catalogue's scenes lie.
#[derive(Args, Debug)]
pub struct LibraryArguments {
    /// Folder with the files of the catalogue's scenes [default: the variable RTBENCH_SCENES]
    #[arg(long, value_name = "FOLDER")]
    scenes_dir: Option<PathBuf>,
}

impl LibraryArguments {
    /// The folder, if there is one.
    pub fn folder(&self) -> Option<PathBuf> {
        self.scenes_dir.clone().or_else(|| std::env::var_os("RTBENCH_SCENES").map(PathBuf::from))
    }

    /// Loads a scene and says on standard error what its reader wants the user to know.
    ///
    /// # Errors
    /// The scene's.
    pub fn load(&self, what: &str) -> Result<Scene> {
        let scene = scene::load_in(what, self.folder().as_deref())?;
        for warning in &scene.warnings {
            output::note(&format!("{}: {warning}", scene.name));
        }
        Ok(scene)
    }
}
