//! Presets: sweeps as data files in `presets/`, part of the program. A file of one's own works as well.

use crate::error::{Error, Result};
use serde::Deserialize;
use std::path::Path;

/// Names and contents of the presets that the program brings.
const EMBEDDED: [(&str, &str); 3] = [
    ("quick", include_str!("../../presets/quick.toml")),
    ("thesis", include_str!("../../presets/thesis.toml")),
    ("thesis-lite", include_str!("../../presets/thesis-lite.toml")),
];

/// A sweep as a file describes it; every value as a user would type it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Preset {
    /// Name, or the file's path.
    #[serde(skip)]
    pub name: String,
    /// As for `--structure`.
    pub structures: Vec<String>,
    /// As for `--config`.
    pub configs: Vec<String>,
    /// As for `--resolution`.
    pub resolutions: Vec<String>,
    /// Frames that each path is thinned to; all where absent.
    pub frames: Option<usize>,
    /// Timed passes over each path.
    pub passes: usize,
    /// Untimed frames before each pass.
    pub warmup_frames: usize,
    /// Threads that build, where the command line does not say; 0 for all.
    #[serde(default)]
    pub build_threads: usize,
    /// How often each structure is built; the median counts.
    #[serde(default = "once")]
    pub builds: usize,
    /// Scenes.
    pub scene: Vec<PresetScene>,
}

fn once() -> usize {
    1
}

/// A scene of a preset; whatever it sets of its own goes before what the preset says. A scene may stand there several
/// times, for measurements that are not every structure x configuration x size: what is measured once is not repeated.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PresetScene {
    /// A built-in scene with its parameters, a scene of the catalogue, or a file.
    pub scene: String,
    /// As [`Preset::structures`].
    pub structures: Option<Vec<String>>,
    /// As [`Preset::configs`].
    pub configs: Option<Vec<String>>,
    /// As [`Preset::resolutions`].
    pub resolutions: Option<Vec<String>>,
    /// As [`Preset::frames`].
    pub frames: Option<usize>,
}

impl Preset {
    /// Finds a preset by name, or reads one from a file.
    ///
    /// # Errors
    /// [`Error::Input`]: no such preset, or a file that is none, with its line.
    pub fn load(name: &str) -> Result<Preset> {
        if let Some((_, text)) = EMBEDDED.iter().find(|(known, _)| *known == name) {
            return Preset::parse(name, text);
        }
        let path = Path::new(name);
        if path.extension().is_none() {
            let known = EMBEDDED.map(|(name, _)| name).join(", ");
            let hint = format!("there are {known}; or give a TOML file");
            return Err(Error::argument("--preset", format!("no preset {name:?}"), hint));
        }
        let text = std::fs::read_to_string(path)
            .map_err(|e| Error::file(path, None, format!("cannot read: {e}"), "give a preset's TOML file"))?;
        Preset::parse(name, &text)
    }

    fn parse(name: &str, text: &str) -> Result<Preset> {
        let mut preset: Preset = toml::from_str(text).map_err(|e| {
            let line = e.span().map(|span| 1 + text[..span.start].matches('\n').count());
            Error::file(Path::new(name), line, e.message().replace('\n', ", "), "see presets/quick.toml")
        })?;
        preset.name = name.to_owned();
        Ok(preset)
    }
}
