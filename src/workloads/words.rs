//! Values of axes that are words: tables of the words and what they mean.

use crate::error::{Error, Result};

/// The flag of an axis.
pub fn flag(axis: &str) -> String {
    format!("--{}", axis.replace('_', "-"))
}

/// What a word of an axis means.
///
/// # Errors
/// [`Error::Input`] that lists the words.
pub fn word<T: Copy>(axis: &str, all: &[(&str, T)], text: &str) -> Result<T> {
    let found = all.iter().find(|(name, _)| *name == text).map(|(_, value)| *value);
    found.ok_or_else(|| {
        Error::argument(flag(axis), format!("there is no value '{text}'"), format!("one of {}", list(all)))
    })
}

/// The word for a value; empty if it has none.
pub fn name<T: PartialEq>(all: &[(&'static str, T)], value: T) -> &'static str {
    all.iter().find(|(_, known)| *known == value).map_or("", |(name, _)| name)
}

/// The words, separated by commas.
pub fn list<T>(all: &[(&str, T)]) -> String {
    all.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ")
}
