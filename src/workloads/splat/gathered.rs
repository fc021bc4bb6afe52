//! From samples and photons to irradiance by the twins: clusters, lists or buckets, estimates.

use super::clusters::{self, Clusters};
use super::estimate;
use super::gathering::{BUCKET_CLUSTERS, Gathering};
use super::lit::LitScene;
use super::photons::Photons;
use super::samples::Samples;
use super::splatting::setting::{BucketSetting, Gather};
use super::splatting::walk::Walk;
use super::splatting::{Buckets, Lists, blur, buckets, counts, lists, per_sample, tiled};
use crate::camera::Camera;
use crate::device::Interrupted;
use crate::error::{Error, Result};
use crate::workloads::size::Size;
use glam::Vec4;
use rayon::ThreadPool;

/// What lies between samples and irradiance.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Gathered {
    /// The clusters of the samples.
    pub clusters: Option<Clusters>,
    /// The photons of each cluster.
    pub lists: Option<Lists>,
    /// The flux of each cluster by direction.
    pub buckets: Option<Buckets>,
}

/// A view with its samples and the photons around them.
#[derive(Clone, Copy)]
pub struct Scenery<'a> {
    /// The scene.
    pub lit: &'a LitScene,
    /// Looks at it.
    pub camera: &'a Camera,
    /// Of the image.
    pub size: Size,
    /// What the camera sees.
    pub samples: &'a Samples,
    /// In the scene.
    pub photons: &'a Photons,
}

/// Clusters that can have buckets on the CPU, of a level of the hierarchy.
fn bucket_room(gathering: &Gathering, setting: &BucketSetting) -> u64 {
    match &gathering.layout {
        Some(layout) if setting.level < clusters::layout::LEVELS => layout.level_nodes(setting.level).into(),
        _ => BUCKET_CLUSTERS.into(),
    }
}

/// Most pairs of a photon and a cluster from which the twin makes buckets: it holds them as lists.
const TWIN_ENTRIES: u64 = 1 << 27;

/// Refuses what the twin of buckets would need too much memory for.
///
/// # Errors
/// [`Error::Refused`].
pub(super) fn check_twin(entries: u64) -> Result<()> {
    if entries <= TWIN_ENTRIES {
        return Ok(());
    }
    let problem = format!("{entries} pairs of photon and cluster, {TWIN_ENTRIES} are the most that can be verified");
    Err(Error::too_large("the buckets", problem, "give a smaller --radius, a larger --tile, or fewer --paths"))
}

/// The clusters of a view.
///
/// # Errors
/// [`Error::Device`] for a gathering without keys.
pub fn clustered(pool: &ThreadPool, gathering: &Gathering, view: &Scenery) -> Result<Clusters> {
    let Some(layout) = &gathering.layout else { return Err(Error::Device("clusters without keys".into())) };
    let placement = gathering.placement(view.lit, view.camera);
    let field_of_view = view.camera.field_of_view;
    Ok(clusters::build(pool, &gathering.clusters, layout, &placement, field_of_view, view.samples))
}

/// Irradiance of each sample per channel, `w` is 0, and what it came from. The threads are those of `pool`.
///
/// # Errors
/// [`Error::Device`] for lists and buckets above their capacity, [`Error::Refused`] for buckets of nodes without a
/// hierarchy, [`Error::Interrupted`] between stages.
pub fn gather(
    pool: &ThreadPool,
    gathering: &Gathering,
    view: &Scenery,
    interrupted: Interrupted,
) -> Result<(Gathered, Vec<Vec4>)> {
    let &Scenery { lit, camera, size, samples, photons } = view;
    let estimate = &gathering.estimate;
    match gathering.gather {
        Gather::Reference => {
            let irradiance = estimate::irradiance(pool, samples, photons, estimate, interrupted)?;
            Ok((Gathered::default(), irradiance))
        }
        Gather::Tiled => {
            let (tile, placement) = (gathering.clusters.tile, gathering.placement(lit, camera));
            let irradiance =
                tiled::irradiance(pool, samples, (size, tile), &placement, photons, estimate, interrupted)?;
            Ok((Gathered::default(), irradiance))
        }
        Gather::PerSample { .. } => {
            let clusters = clustered(pool, gathering, view)?;
            let lists = of_walk(gathering, view, &clusters, clusters::layout::LEVELS, |walk| {
                // Lists that have no room are not built
                gathering.check_entries(counts::walked(pool, walk, photons).assignments())?;
                lists::lists(pool, walk, photons)
            })?;
            let identifiers = &clusters.identifiers;
            let irradiance =
                per_sample::irradiance(pool, (samples, identifiers), &lists, photons, estimate, interrupted)?;
            Ok((Gathered { clusters: Some(clusters), lists: Some(lists), ..Gathered::default() }, irradiance))
        }
        Gather::Buckets(setting) => {
            let clusters = clustered(pool, gathering, view)?;
            let filled = of_walk(gathering, view, &clusters, setting.level, |walk| {
                gathering.check_bucket_clusters(walk.targets() as u64, bucket_room(gathering, &setting))?;
                check_twin(counts::walked(pool, walk, photons).assignments())?;
                let lists = lists::lists(pool, walk, photons)?;
                Ok(buckets::fill(pool, walk, &lists, photons, &setting, estimate))
            })?;
            let options = (&setting, estimate);
            let mut irradiance = buckets::irradiance(pool, samples, &clusters, &filled, options, interrupted)?;
            if setting.blur > 0 {
                irradiance = blur::blurred(pool, samples, size, &irradiance, setting.blur, interrupted)?;
            }
            Ok((Gathered { clusters: Some(clusters), lists: None, buckets: Some(filled) }, irradiance))
        }
    }
}

/// What `work` makes of a walk to the clusters, or to the nodes of a level.
///
/// # Errors
/// Those of [`Walk::new`] and of `work`.
pub fn of_walk<T>(
    gathering: &Gathering,
    view: &Scenery,
    clusters: &Clusters,
    level: u32,
    work: impl FnOnce(&Walk) -> Result<T>,
) -> Result<T> {
    let Some(layout) = &gathering.layout else { return Err(Error::Device("clusters without keys".into())) };
    let placement = gathering.placement(view.lit, view.camera);
    work(&Walk::new(clusters, layout, &placement, gathering.estimate.radius, level)?)
}
