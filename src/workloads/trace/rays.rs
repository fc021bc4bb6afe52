//! Ray configurations: which rays a frame casts.

use crate::error::{Error, Result};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Ray configuration.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
pub enum Config {
    /// Primary rays, shaded.
    P,
    /// And for each light one shadow ray.
    PS,
    /// And reflected rays from shiny surfaces, at most [`MAX_BOUNCES`].
    PSR,
    /// Primary rays, and [`AMBIENT_RAYS`] any-hit rays from what they hit, distributed as the cosine, a tenth of the
    /// scene's diagonal long.
    AO,
    /// Primary rays, and one nearest-hit ray from what they hit, distributed as the cosine.
    DIFFUSE,
}

/// Most reflections that a primary ray may have.
pub const MAX_BOUNCES: u32 = 2;

/// Ambient rays of a pixel.
pub const AMBIENT_RAYS: u32 = 4;

impl Config {
    /// All, in the order of the ray types that they add.
    pub const ALL: [Config; 5] = [Config::P, Config::PS, Config::PSR, Config::AO, Config::DIFFUSE];

    /// True if shadow rays are cast.
    pub fn shadows(self) -> bool {
        matches!(self, Config::PS | Config::PSR)
    }

    /// Reflections followed.
    pub fn bounces(self) -> u32 {
        if self == Config::PSR { MAX_BOUNCES } else { 0 }
    }

    /// A ray configuration by its name, as it is written.
    pub fn named(name: &str) -> Option<Config> {
        Config::ALL.into_iter().find(|config| format!("{config:?}") == name)
    }

    /// Index of the ray type that is this configuration's own: [`super::count::RAY_TYPES`] are in the order of
    /// [`Config::ALL`].
    pub fn added_ray_type(self) -> usize {
        Config::ALL.iter().position(|&config| config == self).unwrap_or_default()
    }
}

/// A ray configuration by name, in any case.
///
/// # Errors
/// [`Error::Input`].
pub fn parse_config(text: &str) -> Result<Config> {
    let found = Config::named(&text.to_uppercase());
    let problem = || format!("unknown configuration {text:?}");
    found.ok_or_else(|| Error::argument("--config", problem(), "give P, PS, PSR, AO or DIFFUSE"))
}
