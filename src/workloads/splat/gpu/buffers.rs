//! The buffers of a frame: their sizes are known before anything is allocated.

use crate::device::VulkanDevice;
use crate::device::vulkan::Buffer;
use crate::error::Result;
use crate::workloads::size::Size;
use crate::workloads::splat::photons::check_slots;
use crate::workloads::splat::setting::{MAX_HITS, Setting};
use crate::workloads::trace::gpu::HIT_BYTES;

const RAY_BYTES: u64 = 32;
const VEC4_BYTES: u64 = 16;

/// How many elements the buffers have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sizes {
    /// Paths, in batches whose rays fit a binding.
    pub paths: u32,
    /// Paths of a batch.
    pub batch: u32,
    /// Slots for photons.
    pub slots: u32,
    /// Pixels.
    pub pixels: u32,
}

impl Sizes {
    /// The sizes of a frame on a device that binds at most `max_binding` bytes.
    ///
    /// # Errors
    /// [`crate::Error::Refused`] for more slots than photons can have.
    pub fn new(setting: &Setting, size: Size, max_binding: u64) -> Result<Sizes> {
        check_slots(setting)?;
        let batch = u64::from(setting.paths).min(max_binding / RAY_BYTES).max(1) as u32;
        Ok(Sizes { paths: setting.paths, batch, slots: setting.slots() as u32, pixels: size.pixels() as u32 })
    }

    /// First path and paths of each batch.
    pub fn batches(&self) -> impl Iterator<Item = (u32, u32)> + use<> {
        let Sizes { paths, batch, .. } = *self;
        (0..paths).step_by(batch as usize).map(move |first| (first, batch.min(paths - first)))
    }
}

/// Makes a struct of buffers that passes of a frame write, each with its bytes by the sizes of a frame.
macro_rules! buffers {
    ($(#[doc = $about:literal])+ $buffers:ident of $sizes:ty;
     $($(#[doc = $meaning:literal])+ $field:ident, $name:literal: $bytes:expr, $hint:expr;)+) => {
        $(#[doc = $about])+
        pub struct $buffers {
            $($(#[doc = $meaning])+ pub $field: Buffer,)+
        }

        impl $buffers {
            /// Name and bytes of each buffer.
            pub fn bytes(sizes: &$sizes) -> Vec<(&'static str, u64)> {
                vec![$(($name, ($bytes)(sizes))),+]
            }

            /// Refuses what the device cannot bind.
            ///
            /// # Errors
            /// [`crate::Error::Refused`].
            pub fn check(device: &VulkanDevice, sizes: &$sizes) -> Result<()> {
                $(device.check_size(concat!("the ", $name), ($bytes)(sizes), $hint)?;)+
                Ok(())
            }

            /// Allocates and poisons the buffers.
            ///
            /// # Errors
            /// The device's.
            pub fn new(device: &VulkanDevice, sizes: &$sizes) -> Result<$buffers> {
                Ok($buffers { $($field: device.poisoned(concat!("the ", $name), ($bytes)(sizes))?,)+ })
            }

            /// Poisons everything.
            pub fn poison(&self, device: &VulkanDevice) {
                $(device.poison(&self.$field);)+
            }
        }
    };
}

pub(super) use buffers;

const PATHS: &str = "give fewer --paths or --hits";
pub(super) const PIXELS: &str = "use a smaller image";

buffers! {
    /// The buffers of all techniques.
    Buffers of Sizes;
    /// Holds the rays of the paths of a batch.
    rays, "rays of paths": |sizes: &Sizes| u64::from(sizes.batch) * RAY_BYTES, PATHS;
    /// Holds what those rays hit.
    hits, "hits of paths": |sizes: &Sizes| u64::from(sizes.batch) * HIT_BYTES, PATHS;
    /// Holds the flux of each path of a batch.
    carried, "flux of paths": |sizes: &Sizes| u64::from(sizes.batch) * VEC4_BYTES, PATHS;
    /// Counts the paths that reached each hit.
    arrived, "counts of hits": |_: &Sizes| u64::from(MAX_HITS) * 4, PATHS;
    /// Holds positions as [`crate::workloads::splat::photons::Photons`] does, of all slots.
    slot_positions, "positions of slots": |sizes: &Sizes| u64::from(sizes.slots) * VEC4_BYTES, PATHS;
    /// Holds directions and paths of all slots.
    slot_directions, "directions of slots": |sizes: &Sizes| u64::from(sizes.slots) * VEC4_BYTES, PATHS;
    /// Holds fluxes of all slots.
    slot_fluxes, "fluxes of slots": |sizes: &Sizes| u64::from(sizes.slots) * VEC4_BYTES, PATHS;
    /// Tells whether each slot holds a photon, then how many do before it.
    places, "places of photons": |sizes: &Sizes| u64::from(sizes.slots) * 4, PATHS;
    /// Holds positions of the photons, without empty slots.
    positions, "positions of photons": |sizes: &Sizes| u64::from(sizes.slots) * VEC4_BYTES, PATHS;
    /// Holds their directions.
    directions, "directions of photons": |sizes: &Sizes| u64::from(sizes.slots) * VEC4_BYTES, PATHS;
    /// Holds their fluxes.
    fluxes, "fluxes of photons": |sizes: &Sizes| u64::from(sizes.slots) * VEC4_BYTES, PATHS;
    /// Holds the camera's rays.
    view_rays, "rays of the camera": |sizes: &Sizes| u64::from(sizes.pixels) * RAY_BYTES, PIXELS;
    /// Holds what these rays hit.
    view_hits, "hits of the camera": |sizes: &Sizes| u64::from(sizes.pixels) * HIT_BYTES, PIXELS;
    /// Holds rays from the light at hand.
    shadow_rays, "shadow rays": |sizes: &Sizes| u64::from(sizes.pixels) * RAY_BYTES, PIXELS;
    /// Holds what these rays hit.
    shadow_hits, "hits of shadow rays": |sizes: &Sizes| u64::from(sizes.pixels) * HIT_BYTES, PIXELS;
    /// Holds positions as [`crate::workloads::splat::samples::Samples`] does.
    samples, "positions of samples": |sizes: &Sizes| u64::from(sizes.pixels) * VEC4_BYTES, PIXELS;
    /// Holds normals of samples.
    normals, "normals of samples": |sizes: &Sizes| u64::from(sizes.pixels) * VEC4_BYTES, PIXELS;
    /// Holds albedos of samples.
    albedos, "albedos of samples": |sizes: &Sizes| u64::from(sizes.pixels) * VEC4_BYTES, PIXELS;
    /// Holds the radiance of each pixel by direct light.
    direct, "direct light": |sizes: &Sizes| u64::from(sizes.pixels) * VEC4_BYTES, PIXELS;
    /// Holds the irradiance of each sample by indirect light.
    irradiance, "irradiance": |sizes: &Sizes| u64::from(sizes.pixels) * VEC4_BYTES, PIXELS;
    /// Holds the radiance of each pixel.
    picture, "picture": |sizes: &Sizes| u64::from(sizes.pixels) * VEC4_BYTES, PIXELS;
}
