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
}

/// Most reflections that a primary ray may have.
pub const MAX_BOUNCES: u32 = 2;

impl Config {
    /// All, in the thesis's order.
    pub const ALL: [Config; 3] = [Config::P, Config::PS, Config::PSR];

    /// True if shadow rays are cast.
    pub fn shadows(self) -> bool {
        self != Config::P
    }

    /// Reflections followed.
    pub fn bounces(self) -> u32 {
        if self == Config::PSR { MAX_BOUNCES } else { 0 }
    }

    /// A ray configuration by its name, as it is written.
    pub fn named(name: &str) -> Option<Config> {
        Config::ALL.into_iter().find(|config| format!("{config:?}") == name)
    }

    /// Index of the ray type that this configuration adds to the one before it: of primary, shadow, reflected.
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
    found.ok_or_else(|| Error::argument("--config", format!("unknown configuration {text:?}"), "give P, PS or PSR"))
}
