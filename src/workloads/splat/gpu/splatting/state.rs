//! What a frame tells of its photons, and what all frames needed.

use super::buffers::{SplatBuffers, SplatSizes};
use crate::device::VulkanDevice;
use crate::device::vulkan::Buffer;
use crate::error::{Error, Result};
use crate::workloads::splat::splatting::buckets::WORDS;
use crate::workloads::splat::splatting::{Buckets, Lists};

/// Words on the device that are no arrays.
pub struct SplatState {
    /// Eight words: photons, the bits of the scale of buckets, 0, 0, then work-groups (x, y, z) of one invocation for
    /// each photon, and 0.
    pub photons: Buffer,
    /// After the lists' offsets: the sum of all counts, and 1 if it is 2^32 or more. Absent without lists.
    pub(super) total: Option<Buffer>,
    pub(super) needs: Buffer,
    zeros: Buffer,
}

/// The most that frames needed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Needs {
    /// Entries of lists.
    pub entries: u32,
    /// True if the entries of a frame were 2^32 or more.
    pub wrapped: bool,
    /// Clusters with buckets.
    pub clusters: u32,
}

impl Needs {
    /// True if there was no room for all.
    pub fn exceed(&self, sizes: &SplatSizes) -> bool {
        self.wrapped || self.entries > sizes.entries || self.clusters > sizes.buckets
    }
}

impl SplatState {
    /// Before any frame.
    ///
    /// # Errors
    /// The device's.
    pub(super) fn new(device: &VulkanDevice) -> Result<SplatState> {
        let state = SplatState {
            photons: device.zeroed("the number of photons", 32)?,
            total: None,
            needs: device.poisoned("the needs of frames", 16)?,
            zeros: device.zeroed("zeros", 16)?,
        };
        state.reset(device);
        Ok(state)
    }

    /// Forgets the needs of the frames before.
    pub fn reset(&self, device: &VulkanDevice) {
        device.copy(&self.zeros, &self.needs);
    }

    /// The most that frames needed since [`SplatState::reset`].
    ///
    /// # Errors
    /// The device's.
    pub fn needs(&self, device: &VulkanDevice) -> Result<Needs> {
        let words: Vec<u32> = device.read(&self.needs, 3)?;
        Ok(Needs { entries: words[0], wrapped: words[1] != 0, clusters: words[2] })
    }

    /// The lists of the last frame, which has so many clusters; entries beyond the capacity are missing.
    ///
    /// # Errors
    /// [`Error::Refused`] if there are 2^32 entries or more, and the device's.
    pub fn lists(
        &self,
        device: &VulkanDevice,
        sizes: &SplatSizes,
        buffers: &SplatBuffers,
        clusters: u32,
    ) -> Result<Lists> {
        let total = self.total.as_ref().ok_or_else(|| Error::Device("a frame without lists".into()))?;
        let total: Vec<u32> = device.read(total, 2)?;
        if total[1] != 0 {
            let hint = "give a smaller --radius, or fewer --paths";
            return Err(Error::too_large("the photons of clusters", "they are 2^32 or more", hint));
        }
        let lists = (clusters + 1).min(sizes.lists) as usize;
        Ok(Lists {
            offsets: device.read(&buffers.offsets, lists)?,
            entries: device.read(&buffers.entries, total[0].min(sizes.entries) as usize)?,
        })
    }

    /// The buckets of the last frame, of so many clusters or nodes at most; `is_fixed` if words are whole numbers.
    ///
    /// # Errors
    /// The device's.
    pub fn buckets(
        &self,
        device: &VulkanDevice,
        sizes: &SplatSizes,
        buffers: &SplatBuffers,
        (count, is_fixed): (u32, bool),
    ) -> Result<Buckets> {
        let state: Vec<u32> = device.read(&self.photons, 2)?;
        let scale = if is_fixed { f32::from_bits(state[1]) } else { 0.0 };
        Ok(Buckets { scale, words: device.read(&buffers.words, count.min(sizes.buckets) as usize * WORDS)? })
    }
}
