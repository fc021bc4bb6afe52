//! Checks a scene's name without reading its file.

use super::load::{is_built_in, split_settings};
use super::{Options, catalogue, load, procedural};
use crate::error::Result;
use std::path::Path;

/// Refuses a name that [`super::load_in`] would refuse before it reads a file: an unknown name, a wrong option, a file
/// that does not exist or has no known format.
///
/// # Errors
/// [`Error::Input`], as [`super::load_in`].
pub fn probe(what: &str, folder: Option<&Path>) -> Result<()> {
    let (name, settings) = split_settings(what);
    if let Some(entry) = catalogue::find(name) {
        entry.path_in(folder)?;
        return Options::parse(what, &format!("{},{settings}", entry.options)).map(drop);
    }
    if is_built_in(what) {
        return procedural::check(what);
    }
    load::check_file(what, name, settings)
}
