//! Loading a scene for a command.

use super::output;
use crate::error::Result;
use crate::scene::{self, Scene};

/// Loads a scene, its geometry frozen at a time if one is given, and tells its warnings.
///
/// # Errors
/// The scene's.
pub fn scene(what: &str, time: Option<f64>) -> Result<Scene> {
    let scene = match time {
        None => scene::load(what)?,
        Some(time) => scene::load(&scene::at_time(what, time))?,
    };
    for warning in &scene.warnings {
        output::note(&format!("{}: {warning}", scene.name));
    }
    Ok(scene)
}
