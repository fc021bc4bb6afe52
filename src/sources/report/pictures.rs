//! Pictures of scenes and their step maps, from the runs' folders.

use crate::error::Result;
use crate::names;
use crate::record::journal::Journal;
use crate::record::picture::{FOLDER, STEPS};
use crate::report::embed::Pictures;
use crate::report::html::escape;
use crate::sources::runs::RecordedRun;
use std::collections::{BTreeMap, BTreeSet};

/// The caption of a step map, which only a sweep has: it renders all of them with the same structure.
const STEP_MAP: &str = "steps of bvh-stack (one ray per thread) per pixel, all ray types: the brighter, the more";

/// All pictures; if several runs have a scene, those of the last.
///
/// # Errors
/// [`crate::Error::Input`]: a folder or a file cannot be read.
pub fn write(runs: &[RecordedRun]) -> Result<String> {
    let mut pictures = Pictures::default();
    for run in runs {
        pictures.read(&run.folder.join(FOLDER))?;
    }
    let notes: String = pictures
        .remove_large()
        .iter()
        .map(|name| format!("<p class=\"note\">{} is left out: larger than 4 MiB.</p>\n", escape(name)))
        .collect();
    let recorded = || runs.iter().flat_map(|run| scenes_of(&run.general));
    let of_half: BTreeSet<String> = recorded().flat_map(half_of).map(|(file, _)| file).collect();
    let of_scene: BTreeMap<String, &str> = recorded().map(|name| (names::distinct_slug(name), name)).collect();
    // A set of whole names: `conference-obj` sorts between `conference` and `conference-steps`
    let names = pictures.names().filter(|name| !of_half.contains(*name));
    let scenes: BTreeSet<&str> = names.map(|name| name.strip_suffix(STEPS).unwrap_or(name)).collect();
    if scenes.is_empty() {
        return Ok(format!("<p class=\"note\">The runs' folders have no pictures.</p>\n{notes}"));
    }
    let pair = |file: &&str| {
        let scene = of_scene.get(*file).unwrap_or(file);
        let picture = pictures.figure(file, scene, "picture");
        let step_map = pictures.figure(&format!("{file}{STEPS}"), scene, STEP_MAP);
        let half: String = half_of(scene).iter().map(|(file, caption)| pictures.figure(file, scene, caption)).collect();
        format!("<h3>{}</h3>\n<div class=\"pair\">\n{picture}{step_map}{half}</div>\n", escape(scene))
    };
    Ok(scenes.iter().map(pair).collect::<String>() + &notes)
}

/// The names of the scenes that a run's rows and structures were measured on.
fn scenes_of(journal: &Journal) -> impl Iterator<Item = &str> {
    journal.inputs.iter().filter(|input| input.kind == "scene").map(|input| input.name.as_str())
}

/// The files of a scene's pictures in half precision without `.png`, each with what it shows.
fn half_of(scene: &str) -> [(String, &'static str); 2] {
    [("-half", "in half precision"), ("-half-difference", "difference of half from single precision, brightened")]
        .map(|(end, caption)| (names::distinct_slug(&format!("{scene}{end}")), caption))
}
