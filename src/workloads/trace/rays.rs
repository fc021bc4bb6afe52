//! Ray configurations: which rays a frame casts.

use serde::{Deserialize, Serialize};

/// Ray configuration (SPEC section 5).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Config {
    /// Primary rays, shaded.
    P,
    /// And for each light one shadow ray.
    PS,
    /// And reflected rays from shiny surfaces, at most [`MAX_BOUNCES`].
    PSR,
}

/// Most reflections that a primary ray may have (SPEC section 5).
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
}
