//! Main memory that a case takes.

use super::accounting::BUCKETS_BYTES;
use super::cluster_axes::Clustering;
use super::clusters::layout::MAX_KEY_BITS;
use super::gathering::BUCKET_CLUSTERS;
use super::photons::PHOTON_BYTES;
use super::setting::Setting;
use crate::error::{Error, Result};
use crate::scene::budget;
use crate::workloads::size::Size;

/// Copies of photons that are held at once: slots and compacted ones of a device and of the twin, and a comparison's.
const COPIES: u64 = 6;

/// Bytes of a pixel in all arrays of a frame.
const PIXEL_BYTES: u64 = 6 * 16;

/// Copies of images that are held at once.
const IMAGES: u64 = 3;

/// Bytes of a pixel in the arrays of clusters: position, key, identifier, and the cluster that it may be.
const CLUSTERED_PIXEL_BYTES: u64 = 16 + 4 + 4 + 4 + 28;

/// Bytes of photons and images of a case.
pub fn bytes(setting: Setting, size: Size, clustering: Option<&Clustering>) -> u64 {
    let photons = setting.slots().saturating_mul(COPIES * PHOTON_BYTES);
    let pixels = size.pixels() as u64;
    let clusters = clustering.filter(|clustering| clustering.has_clusters).map_or(0, |clustering| {
        let keys = 4_u64 << MAX_KEY_BITS;
        let gathered = match clustering.capacity {
            // Every photon may touch every cluster, but no more
            Some(capacity) => 4 * u64::from(capacity).min(setting.slots().saturating_mul(pixels)),
            None => BUCKETS_BYTES * u64::from(BUCKET_CLUSTERS).min(pixels),
        };
        keys + IMAGES * (CLUSTERED_PIXEL_BYTES * pixels + gathered)
    });
    photons.saturating_add(IMAGES * PIXEL_BYTES * pixels).saturating_add(clusters)
}

/// Refuses photons and images that take more than half of the memory that the process may use.
///
/// # Errors
/// [`Error::Refused`], with need and limit.
pub fn check(setting: Setting, size: Size, clustering: Option<&Clustering>) -> Result<()> {
    check_limit(setting, size, clustering, budget::process_bytes() as u64 / 2)
}

fn check_limit(setting: Setting, size: Size, clustering: Option<&Clustering>, limit: u64) -> Result<()> {
    let need = bytes(setting, size, clustering);
    if need <= limit {
        return Ok(());
    }
    let problem = format!("{} MiB are needed, half of the memory is {} MiB", need >> 20, limit >> 20);
    Err(Error::too_large(
        "the photons, images and clusters",
        problem,
        "give fewer --paths or --hits, or a smaller --resolution",
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn photons_and_images_above_the_limit_are_refused() {
        let setting =
            Setting { paths: 1 << 20, hits: 2, seed: 0, falloff: Default::default(), energy: Default::default() };
        let size = Size { width: 1024, height: 1024 };
        check_limit(setting, size, None, 576 << 20).unwrap();
        let error = check_limit(setting, size, None, (576 << 20) - 1).unwrap_err().to_string();
        assert!(error.contains("576 MiB are needed, half of the memory is 575 MiB"), "{error}");
    }
}
