//! Verification before timing: what a kernel finds is compared with a reference that brute force has checked.

use crate::accel::{Structure, Traversal, bvh::Bvh};
use crate::backend::{Config, Prepared, Size};
use crate::camera::View;
use crate::error::Result;
use crate::scene::Scene;

/// The outcome of verifying one configuration at one size.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// True if everything agrees within the stated limits.
    pub ok: bool,
    /// One line: what was compared, or what disagrees.
    pub message: String,
    /// Primary rays compared.
    pub rays: u64,
    /// Of these, how many of the reference's answers brute force has confirmed.
    pub brute_checked: u64,
    /// Primary rays whose triangle or distance differs.
    pub hits_differing: u64,
    /// Pixels whose steps, tests or restarts differ from the CPU twin's (0 where they were not compared).
    pub counters_differing: u64,
    /// Pixels whose colour differs by more than the stated amount.
    pub colours_differing: u64,
    /// Largest difference of a colour channel, of 255.
    pub max_colour_difference: u8,
    /// BLAKE3 of the shaded image (RGBA8, rows from the top), hexadecimal.
    pub image_hash: String,
    /// The shaded image, RGBA8.
    pub image: Vec<u8>,
    /// Where `ok` is false: an RGBA8 image of the same size, red where a hit differs, yellow where a counter, blue
    /// where only the colour differs, over the darkened image.
    pub difference: Option<Vec<u8>>,
}

/// Verifies all configurations of one scene; keeps the references it has computed.
pub struct Verifier<'a> {
    scene: &'a Scene,
    bvh: &'a Bvh,
}

impl<'a> Verifier<'a> {
    /// A verifier whose reference is traced through `bvh` by the CPU twin and checked by brute force.
    pub fn new(scene: &'a Scene, bvh: &'a Bvh) -> Self {
        Verifier { scene, bvh }
    }

    /// Verifies one frame. With `twin`, hits and counters are also compared with the CPU twin of the same structure and
    /// traversal, pixel by pixel (for small images); without, only with the reference image. `exact` demands agreement
    /// to the bit (see [`crate::backend::DeviceInfo::is_exact`]).
    #[allow(clippy::too_many_arguments)]
    pub fn check(
        &mut self,
        _prepared: &mut dyn Prepared,
        _twin: Option<(&Structure, Traversal)>,
        _config: Config,
        _view: &View,
        _size: Size,
        _exact: bool,
    ) -> Result<Verdict> {
        let _ = (self.scene, self.bvh);
        unimplemented!()
    }
}
