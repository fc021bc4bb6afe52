//! `rtbench scenes`: what can be traced.

use super::output;
use crate::backend::Config;
use crate::camera::{self, CameraPath};
use crate::error::Result;
use crate::scene;
use clap::Subcommand;

/// List the built-in scenes and camera paths, or describe a scene
#[derive(Subcommand, Debug)]
#[command(after_help = EXAMPLES)]
pub enum Command {
    /// List the built-in scenes with their parameters, and the camera paths
    List,
    /// Load a scene and describe it
    Info {
        /// Scene file, or built-in scene with parameters
        #[arg(value_name = "FILE|NAME[:KEY=VALUE,..]")]
        scene: String,
        /// Moment at which the moving geometry of scene files is frozen, as FILE:time=T
        #[arg(long, value_name = "T", allow_negative_numbers = true)]
        scene_time: Option<f64>,
    },
}

const EXAMPLES: &str = "\
Examples:
  rtbench scenes list
  rtbench scenes info bunny.ply
  rtbench scenes info hall:triangles=200000";

/// Runs the command.
///
/// # Errors
/// The scene's.
pub fn run(command: &Command) -> Result<()> {
    match command {
        Command::List => list(),
        Command::Info { scene, scene_time } => info(scene, *scene_time),
    }
}

fn list() -> Result<()> {
    let mut text = String::from("Built-in scenes, as NAME or NAME:KEY=VALUE,...\n");
    for scene in scene::list() {
        text += &format!("\n  {}\n      {}\n", scene.name, scene.character);
        for parameter in scene.parameters {
            let range = format!("{} to {}, default {}", parameter.min, parameter.max, parameter.default);
            text += &format!("      {:<12} {} ({range})\n", parameter.name, parameter.meaning);
        }
    }
    text += &format!("\nCamera paths: {}\n", camera::names().join(", "));
    output::print(&text)
}

fn info(what: &str, time: Option<f64>) -> Result<()> {
    let scene = scene::load(&time.map_or_else(|| what.to_owned(), |time| scene::at_time(what, time)))?;
    let bounds = scene.bounds();
    let extent = bounds.extent();
    let mut text = format!("{}\n", scene.name);
    let mut line = |name: &str, value: String| text += &format!("  {name:<22}{value}\n");
    line("triangles", scene.triangles.len().to_string());
    line("without area", scene.degenerate_triangles.to_string());
    line("vertices", scene.vertices.len().to_string());
    line("materials", scene.materials.len().to_string());
    line("mirroring surface", format!("{:.1} %", 100.0 * scene.mirror_share()));
    line("lights", scene.lights.len().to_string());
    line("smallest corner", bounds.min.to_string());
    line("largest corner", bounds.max.to_string());
    line("extent", format!("{extent}, diagonal {}", bounds.diagonal()));
    for config in Config::ALL {
        line(&format!("camera path for {config:?}"), CameraPath::for_scene(&scene, config).name);
    }
    line("content hash", scene.content_hash());
    for warning in &scene.warnings {
        line("warning", warning.clone());
    }
    output::print(&text)
}
