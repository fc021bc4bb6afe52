//! `rtbench scenes list`: lists built-in scenes and the catalogue.

use super::super::library::LibraryArguments;
use super::super::output;
use crate::camera;
use crate::error::Result;
use crate::scene::{self, catalogue};
use std::path::Path;

/// Prints built-in scenes, the catalogue and the camera paths.
pub fn run(library: &LibraryArguments) -> Result<()> {
    let mut text = String::from("Built-in scenes, as NAME or NAME:KEY=VALUE,...\n");
    for scene in scene::list() {
        text += &format!("\n  {}\n      {}\n", scene.name, scene.character);
        for parameter in scene.parameters {
            let range = format!("{} to {}, default {}", parameter.min, parameter.max, parameter.default);
            text += &format!("      {:<12} {} ({range})\n", parameter.name, parameter.meaning);
        }
    }
    let folder = library.folder();
    text += &catalogue_text(folder.as_deref());
    text += &format!("\nCamera paths: {}\n", camera::names().join(", "));
    output::print(&text)
}

fn catalogue_text(folder: Option<&Path>) -> String {
    let mut text = String::from("\nThe catalogue: real scenes, as NAME; * is a scene of the thesis");
    text += &match folder {
        Some(folder) => format!("\nin the folder {}\n", folder.display()),
        None => "; --scenes-dir or RTBENCH_SCENES names the folder of their files\n".to_owned(),
    };
    for entry in catalogue::entries() {
        let star = if entry.published { " *" } else { "" };
        text += &format!("\n  {}{star}\n      {}, {} triangles\n", entry.name, entry.title, entry.triangles);
        text += &match folder.and_then(|folder| catalogue::locate(entry, folder)) {
            Some(path) => format!("      present: {}\n", path.display()),
            None => match &entry.fetch {
                Some(_) => format!("      not present: `rtbench scenes fetch {}` downloads it\n", entry.name),
                None => format!("      not present: expected as {}\n", entry.file[0].path.display()),
            },
        };
        text += &format!("      from {}\n      licence: {}\n", entry.source, entry.licence);
    }
    text += "\n`present` means that a file of that name exists; `scenes info` and `scenes fetch` check its SHA-256\n";
    text
}
