//! `rtbench scenes fetch`: downloads a scene of the catalogue.

use super::super::library::LibraryArguments;
use super::super::output;
use crate::error::{Error, Result};
use crate::fetch::{self, Event, Verified};
use crate::scene::catalogue;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;

/// Downloads a scene of the catalogue, unless its file exists.
pub fn run(name: &str, library: &LibraryArguments) -> Result<()> {
    let entry = catalogue::get(name)?;
    let Some(folder) = library.folder() else {
        let problem = "no folder of scenes is given";
        return Err(Error::argument("--scenes-dir", problem, "name the folder that the scene is to be put into"));
    };
    if let Some(path) = catalogue::locate(entry, &folder) {
        if let Some(found) = entry.other_hash(&path)? {
            let problem = format!("this is not the catalogue's {name}: its SHA-256 is {found}");
            return Err(Error::file(&path, None, problem, "nothing is overwritten: move it away, then fetch again"));
        }
        let checked = match entry.known_hash(&path) {
            Some(_) => "its SHA-256 is the catalogue's",
            None => "not verified: the catalogue has no hash",
        };
        return output::print(&format!("{name} is here: {}: {checked}\n", path.display()));
    }
    output::note(&format!("{}: {}; credit: {}", entry.title, entry.licence, entry.credit));
    let bar = std::io::stderr().is_terminal().then(|| {
        let style = ProgressStyle::with_template("{bar:24} {bytes}/{total_bytes}, {bytes_per_sec}, {eta} left");
        ProgressBar::new(0).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
    });
    let mut tenths = None;
    let fetched = fetch::fetch(entry, &folder, &mut |event| match (event, &bar) {
        (Event::Downloaded(done, total), Some(bar)) => {
            bar.set_length(total.unwrap_or(done));
            bar.set_position(done);
        }
        (Event::Downloaded(done, Some(total)), None) => {
            // Without a terminal, one line is printed per tenth.
            let now = done.checked_mul(10).and_then(|d| d.checked_div(total));
            if now != tenths {
                tenths = now;
                output::note(&format!("{done} of {total} bytes"));
            }
        }
        (Event::Downloaded(..), None) => {}
        (Event::Retry(reason), Some(bar)) => bar.println(format!("rtbench: {reason}; trying again")),
        (Event::Retry(reason), None) => output::note(&format!("{reason}; trying again")),
        (Event::Unpacking, _) => {}
    });
    if let Some(bar) = &bar {
        bar.finish_and_clear();
    }
    let (path, verified) = fetched?;
    let checked = match verified {
        Verified::Archive => "the archive's SHA-256 is the catalogue's".to_owned(),
        Verified::File => "the file's SHA-256 is the catalogue's (the archive's is not known)".to_owned(),
        Verified::Unknown(hash) => format!("not verified: the catalogue has no hash; the file's SHA-256 is {hash}"),
    };
    output::print(&format!("{}: {checked}\n", path.display()))
}
