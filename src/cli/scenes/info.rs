//! `rtbench scenes info`: describes a scene.

use super::super::library::LibraryArguments;
use super::super::output;
use crate::camera::CameraPath;
use crate::error::Result;
use crate::scene::catalogue::{self, Class};
use crate::scene::{Scene, load_in, placement};
use crate::workloads::trace::Selection;
use crate::workloads::trace::backend::Config;
use crate::workloads::trace::common::estimate;

/// Loads a scene and prints its properties.
pub fn run(name: &str, library: &LibraryArguments) -> Result<()> {
    let scene = load_in(&library.at_time(name), library.folder().as_deref())?;
    let entry = catalogue::find(name.split(':').next().unwrap_or(name));
    let mut text = format!("{}\n", scene.name);
    let mut line = |name: &str, value: String| text += &format!("  {name:<22}{value}\n");
    let compared = |count: usize, expected: Option<usize>| match expected {
        Some(expected) if expected == count => format!("{count} (as the catalogue expects)"),
        Some(expected) => format!("{count} (the catalogue expects {expected})"),
        None => count.to_string(),
    };
    line("triangles", compared(scene.triangles.len(), entry.map(|e| e.triangles)));
    line("without area", scene.degenerate_triangles.to_string());
    line("vertices", compared(scene.vertices.len(), entry.and_then(|e| e.vertices)));
    line("materials", scene.materials.len().to_string());
    line("mirror surface", format!("{:.1} %", 100.0 * scene.mirror_share()));
    line("lights", lights(&scene, entry));
    let bounds = scene.bounds();
    let placement = scene.placement;
    line("smallest corner", placement.point(bounds.min));
    line("largest corner", placement.point(bounds.max));
    let length = |placed: f32| placement::number(placement.exact(placed));
    let [x, y, z] = bounds.extent().to_array().map(length);
    line("extent", format!("[{x}, {y}, {z}], diagonal {}", length(bounds.diagonal())));
    if !placement.is_identity() {
        let [x, y, z] = placement.offset.to_array().map(placement::number);
        let scale = if placement.exponent == 0 { String::new() } else { format!(", 2^{} times", placement.exponent) };
        line("in memory", format!("[{x}, {y}, {z}] is the origin{scale}"));
    }
    line("camera of the file", camera(&scene));
    for config in Config::ALL {
        line(&format!("camera path for {config:?}"), CameraPath::for_scene(&scene, config.shadows()).name);
    }
    if let Some(entry) = entry {
        let class = match entry.class {
            Class::Object => "a single object: the camera or the light orbits around it",
            Class::Walk => "an environment: the camera moves through it",
        };
        line("class", class.to_owned());
        line("grid of the thesis", entry.grid.clone().unwrap_or_else(|| "by the rule".to_owned()));
        line("source", entry.source.clone());
        line("licence", entry.licence.clone());
        line("credit", entry.credit.clone());
    }
    let options = entry.and_then(|entry| entry.grid.as_deref()).map_or(String::new(), |grid| format!(":{grid}"));
    let selections =
        [Selection::parse(&format!("grid{options}"))?, Selection::parse("kdtree")?, Selection::parse("bvh")?];
    for estimate in estimate::estimates(&scene, &selections)? {
        let mib = |bytes: u64| format!("{:.2} MiB", bytes as f64 / f64::from(1 << 20));
        let (device, thesis, factor) = (mib(estimate.structure_bytes), mib(estimate.thesis_bytes), estimate.factor);
        let options = if estimate.structure == "grid" { options.as_str() } else { "" };
        let name = format!("{}{options}, estimated", estimate.structure);
        line(
            &name,
            format!("{device} without the vertices; {thesis} by the thesis's definition; within a factor of {factor}"),
        );
    }
    line("content hash", scene.content_hash());
    for warning in &scene.warnings {
        line("warning", warning.clone());
    }
    output::print(&text)
}

fn lights(scene: &Scene, entry: Option<&catalogue::Entry>) -> String {
    let own = match scene.lights.len() {
        0 => "none: the camera path provides them".to_owned(),
        n => n.to_string(),
    };
    match entry.and_then(|e| e.lights) {
        Some(expected) if expected != scene.lights.len() => format!("{own} (the thesis has {expected})"),
        _ => own,
    }
}

fn camera(scene: &Scene) -> String {
    match &scene.camera {
        None => "none".to_owned(),
        Some(camera) => match camera.frames.as_slice() {
            [] => "none".to_owned(),
            [pose] => format!("at {}, {} degrees", scene.placement.point(pose.position), camera.field_of_view),
            frames => format!("{} frames, {} degrees", frames.len(), camera.field_of_view),
        },
    }
}
