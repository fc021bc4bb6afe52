//! Photons as they lie in memory: three arrays of vec4, so that a device binds up to 8,388,608 of them in 128 MiB.

use super::setting::Setting;
use crate::error::{Error, Result};
use glam::Vec4;

/// Photons, or slots for photons. All arrays are equally long.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Photons {
    /// Position, lifted off the surface by the epsilon; `w` is the number of the hit along its path (the light's first
    /// hit is 1), as a float. 0 in a slot without a photon.
    pub positions: Vec<Vec4>,
    /// Unit direction of travel of the ray that brought it; `w` is the number of its path, below 2^24, as a float.
    pub directions: Vec<Vec4>,
    /// Arriving flux per channel, before this hit's albedo; `w` is 0.
    pub fluxes: Vec<Vec4>,
}

/// Bytes of a photon.
pub const PHOTON_BYTES: u64 = 48;

/// Most slots: as many as a vec4 each fits into 128 MiB.
pub const MAX_SLOTS: u64 = 1 << 23;

/// What paths of light left behind.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Traced {
    /// A slot for each hit but the first of each path: slot `path * (hits - 1) + hit - 2`.
    pub slots: Photons,
    /// Paths that reached hit 1, 2, .. `hits`.
    pub arrived: Vec<u32>,
}

/// Refuses more slots than [`MAX_SLOTS`].
///
/// # Errors
/// [`Error::Refused`] with the numbers.
pub fn check_slots(setting: &Setting) -> Result<()> {
    let (slots, Setting { paths, hits, .. }) = (setting.slots(), setting);
    if slots <= MAX_SLOTS {
        return Ok(());
    }
    let need = format!("{paths} paths with {hits} hits need {slots} slots, and there are {MAX_SLOTS} at most");
    Err(Error::too_large("the photons", need, "give fewer --paths or --hits"))
}

impl Photons {
    /// As many empty slots.
    pub fn empty(slots: usize) -> Photons {
        let zeros = || vec![Vec4::ZERO; slots];
        Photons { positions: zeros(), directions: zeros(), fluxes: zeros() }
    }

    /// Photons or slots.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// True if there is none.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// The photons without the empty slots, in the same order.
    #[must_use]
    pub fn compacted(&self) -> Photons {
        let kept = |index: &usize| self.positions[*index].w > 0.0;
        let of = |all: &[Vec4]| (0..self.len()).filter(kept).map(|index| all[index]).collect();
        Photons { positions: of(&self.positions), directions: of(&self.directions), fluxes: of(&self.fluxes) }
    }
}
