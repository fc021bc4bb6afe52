//! Flags of every command that loads scenes: the folder of the catalogue's files, and the time of animated scenes.

use super::output;
use crate::error::Result;
use crate::names;
use crate::scene::cache::{self, Sources};
use crate::scene::{self, Scene};
use clap::Args;
use clap::builder::{OsStringValueParser, TypedValueParser};
use std::path::PathBuf;

/// The folder of the catalogue's files, and the time at which animated scenes are loaded.
#[derive(Args, Clone, Debug)]
pub struct LibraryArguments {
    /// Folder with the files of the catalogue's scenes [default: environment variable RTBENCH_SCENES]
    #[arg(long, value_name = "FOLDER")]
    scenes_dir: Option<PathBuf>,
    /// Time at which animated scene files are loaded, as FILE:time=T
    #[arg(long, value_name = "T", allow_negative_numbers = true, value_parser = finite)]
    scene_time: Option<f64>,
}

impl LibraryArguments {
    /// The folder, if one is given. An empty variable counts as unset.
    pub fn folder(&self) -> Option<PathBuf> {
        let variable = || std::env::var_os("RTBENCH_SCENES").filter(|folder| !folder.is_empty());
        self.scenes_dir.clone().or_else(|| variable().map(PathBuf::from))
    }

    /// The moment that was asked for.
    pub fn time(&self) -> Option<f64> {
        self.scene_time
    }

    /// Writes a note to standard error where a moment was asked for and the scene has none.
    pub fn note_where_time_means_nothing(&self, what: &str) {
        if self.scene_time.is_some() && scene::has_no_time(what) {
            output::note(&format!("{what}: --scene-time changes nothing: nothing moves in this scene"));
        }
    }

    /// The scene at the moment that was asked for, if one was.
    pub fn at_time(&self, what: &str) -> String {
        self.note_where_time_means_nothing(what);
        self.scene_time.map_or_else(|| what.to_owned(), |time| scene::at_time(what, time))
    }

    /// Loads a scene and prints its warnings on standard error.
    ///
    /// # Errors
    /// Those of [`scene::load_in`].
    pub fn load(&self, name: &str) -> Result<Scene> {
        let scene = scene::load_in(&self.at_time(name), self.folder().as_deref())?;
        print_warnings(&scene);
        Ok(scene)
    }

    /// Like [`LibraryArguments::load`]; also returns the files that the scene was read from.
    ///
    /// # Errors
    /// Those of [`cache::load`].
    pub fn load_with_sources(&self, name: &str) -> Result<(Scene, Sources)> {
        let (scene, sources) = cache::load(&self.at_time(name), self.folder().as_deref())?;
        print_warnings(&scene);
        Ok((scene, sources))
    }
}

fn print_warnings(scene: &Scene) {
    for warning in &scene.warnings {
        output::note(&format!("{}: {warning}", scene.name));
    }
}

/// Reads an argument that may have a file name in it, see [`names::text`].
pub fn file_name() -> impl TypedValueParser<Value = String> {
    OsStringValueParser::new().map(|argument| names::text(&argument))
}

fn finite(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(time) if f64::is_finite(time) => Ok(time),
        _ => Err("give a finite number, a time of the file's animation".into()),
    }
}
