//! How photons reach samples in frames of a case, with everything that it depends on but the scene.

use super::case::SplatCase;
use super::cluster_axes::{MAX_CAPACITY, Sync};
use super::clusters::setting::ClusterSetting;
use super::clusters::{KeyLayout, Placement};
use super::lit::LitScene;
use super::setting::Estimate;
use super::splatting::setting::Gather;
use crate::camera::Camera;
use crate::error::{Error, Result};
use crate::workloads::size::Size;

/// Clusters that have buckets at most: 648 bytes each are 41 MiB.
pub const BUCKET_CLUSTERS: u32 = 1 << 16;

/// See the module.
#[derive(Clone, Debug, PartialEq)]
pub struct Gathering {
    /// Which photons a sample gets.
    pub gather: Gather,
    /// What they add.
    pub estimate: Estimate,
    /// Clusters, or tiles alone.
    pub clusters: ClusterSetting,
    /// Keys of clusters, for techniques that have clusters.
    pub layout: Option<KeyLayout>,
    /// Entries of the lists of all clusters at most.
    pub capacity: u32,
    /// Who knows how many clusters and entries there are.
    pub sync: Sync,
}

impl From<Estimate> for Gathering {
    /// Each sample over all photons.
    fn from(estimate: Estimate) -> Gathering {
        Gathering {
            gather: Gather::Reference,
            estimate,
            clusters: ClusterSetting::default(),
            layout: None,
            capacity: MAX_CAPACITY,
            sync: Sync::default(),
        }
    }
}

impl Gathering {
    /// What a case asks for, in images of this size by these cameras.
    ///
    /// # Errors
    /// [`Error::Refused`] for keys of too many bits, and for a radius out of range.
    pub fn new(case: &SplatCase, lit: &LitScene, cameras: &[Camera], size: Size) -> Result<Gathering> {
        let radius = case.radius.length(lit.diagonal(), &lit.scene.placement)?;
        let gather = case.technique.gather;
        let mut gathering = Gathering { gather, ..Gathering::from(case.technique.estimate(radius)) };
        let Some(clustering) = case.clustering else { return Ok(gathering) };
        gathering.clusters = clustering.setting;
        gathering.capacity = clustering.capacity.unwrap_or(MAX_CAPACITY);
        gathering.sync = clustering.sync;
        if gather.has_clusters() {
            let narrowest = cameras.iter().map(|camera| camera.field_of_view).fold(180.0, f32::min);
            let depths = (lit.near(), lit.far());
            gathering.layout = Some(KeyLayout::new(&clustering.setting, size, narrowest, depths)?);
        }
        Ok(gathering)
    }

    /// The axes of boxes in a view.
    pub fn placement(&self, lit: &LitScene, camera: &Camera) -> Placement {
        Placement::new(self.clusters.space, camera, lit.extent)
    }

    /// Refuses lists that are longer than their room.
    ///
    /// # Errors
    /// [`Error::Device`] with need and capacity: such a frame has no answer.
    pub fn check_entries(&self, need: u64) -> Result<()> {
        overflow(
            "the lists of clusters",
            "entries",
            need,
            self.capacity.into(),
            "a larger --capacity, of which a device binds no more than its limit, or a smaller --radius",
        )
    }

    /// Refuses more clusters than there are buckets for.
    ///
    /// # Errors
    /// As [`Gathering::check_entries`].
    pub fn check_bucket_clusters(&self, need: u64, capacity: u64) -> Result<()> {
        overflow("the buckets", "clusters", need, capacity, "a larger --tile")
    }
}

fn overflow(what: &str, of: &str, need: u64, capacity: u64, hint: &str) -> Result<()> {
    if need <= capacity {
        return Ok(());
    }
    Err(Error::Device(format!(
        "overflow: in a frame {what} need room for {need} {of}, their capacity is {capacity} (give {hint})"
    )))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workloads::splat::technique::Technique;

    #[test]
    fn an_overflow_names_need_and_capacity() {
        let gathering = Gathering { capacity: 10, ..Gathering::from(Technique::default().estimate(1.0)) };
        gathering.check_entries(10).unwrap();
        let error = gathering.check_entries(11).unwrap_err().to_string();
        assert!(error.starts_with("overflow: ") && error.contains("11 entries") && error.contains("is 10"), "{error}");
    }
}
