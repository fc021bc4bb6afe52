//! The folder of scenes and their time: flags that every command with `--scene` has.

use super::output;
use crate::error::Result;
use crate::scene::cache::{self, Sources};
use crate::scene::{self, Scene};
use clap::Args;
use std::path::PathBuf;

/// Where the catalogue's scenes lie, and when they are looked at.
#[derive(Args, Debug)]
pub struct LibraryArguments {
    /// Folder with the files of the catalogue's scenes [default: the variable RTBENCH_SCENES]
    #[arg(long, value_name = "FOLDER")]
    scenes_dir: Option<PathBuf>,
    /// Moment at which the moving geometry of scene files is frozen, as FILE:time=T
    #[arg(long, value_name = "T", allow_negative_numbers = true, value_parser = moment)]
    scene_time: Option<f64>,
}

impl LibraryArguments {
    /// The folder, if there is one. An empty variable is as good as none.
    pub fn folder(&self) -> Option<PathBuf> {
        let variable = || std::env::var_os("RTBENCH_SCENES").filter(|folder| !folder.is_empty());
        self.scenes_dir.clone().or_else(|| variable().map(PathBuf::from))
    }

    /// The scene at the moment that was asked for, if one was; a note on standard error where that means nothing.
    pub fn at_time(&self, what: &str) -> String {
        let Some(time) = self.scene_time else { return what.to_owned() };
        if scene::has_no_time(what) {
            output::note(&format!("{what}: --scene-time changes nothing: nothing moves in this scene"));
        }
        scene::at_time(what, time)
    }

    /// Loads a scene and says on standard error what its reader wants the user to know.
    ///
    /// # Errors
    /// The scene's.
    pub fn load(&self, what: &str) -> Result<Scene> {
        let scene = scene::load_in(&self.at_time(what), self.folder().as_deref())?;
        tell(&scene);
        Ok(scene)
    }

    /// The same, and what files the scene is made from.
    ///
    /// # Errors
    /// The scene's.
    pub fn load_with_sources(&self, what: &str) -> Result<(Scene, Sources)> {
        let (scene, sources) = cache::load(&self.at_time(what), self.folder().as_deref())?;
        tell(&scene);
        Ok((scene, sources))
    }
}

fn tell(scene: &Scene) {
    for warning in &scene.warnings {
        output::note(&format!("{}: {warning}", scene.name));
    }
}

fn moment(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(time) if f64::is_finite(time) => Ok(time),
        _ => Err("give a finite number, a moment of the file's animation".into()),
    }
}
