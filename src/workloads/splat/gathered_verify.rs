//! What lies between samples and irradiance, against the twins: each stage is computed again from what the device made
//! of the stages before.

use super::clusters;
use super::estimate;
use super::gathered::{Gathered, Scenery, check_twin, of_walk};
use super::gathering::Gathering;
use super::splatting::setting::Gather;
use super::splatting::{blur, buckets, counts, lists, per_sample, tiled, verify};
use super::verify::Exactness;
use crate::device::Interrupted;
use crate::error::{Error, Result};
use crate::record::row::Check;
use glam::Vec4;
use rayon::ThreadPool;

/// Compares clusters, then lists or buckets. What follows something that is wrong is not compared.
///
/// # Errors
/// Those of the twins.
pub fn check(
    pool: &ThreadPool,
    gathering: &Gathering,
    view: &Scenery,
    found: &Gathered,
    exactness: Exactness,
) -> Result<Vec<Check>> {
    let Some(layout) = &gathering.layout else { return Ok(Vec::new()) };
    let Some(own) = &found.clusters else { return Ok(vec![missing("clusters")]) };
    let placement = gathering.placement(view.lit, view.camera);
    let way = (&gathering.clusters, layout, &placement);
    let mut checks = clusters::verify::check(pool, own, view.samples, way, view.camera.field_of_view, exactness);
    if checks.iter().any(|check| !check.ok) {
        return Ok(checks);
    }
    let photons = view.photons;
    match gathering.gather {
        Gather::PerSample { order, .. } => {
            let Some(own_lists) = &found.lists else { return Ok(vec![missing("lists")]) };
            let twin =
                of_walk(gathering, view, own, clusters::layout::LEVELS, |walk| lists::lists(pool, walk, photons))?;
            checks.extend(verify::lists(own_lists, &twin, order, exactness));
        }
        Gather::Buckets(setting) => {
            let Some(own_buckets) = &found.buckets else { return Ok(vec![missing("buckets")]) };
            let twin = of_walk(gathering, view, own, setting.level, |walk| {
                check_twin(counts::walked(pool, walk, photons).assignments())?;
                let lists = lists::lists(pool, walk, photons)?;
                Ok(buckets::fill(pool, walk, &lists, photons, &setting, &gathering.estimate))
            })?;
            checks.extend(verify::buckets(own_buckets, &twin, setting.atomics, exactness));
        }
        _ => {}
    }
    Ok(checks)
}

fn missing(what: &str) -> Check {
    Check { ok: false, message: format!("there are no {what}"), metrics: Vec::new() }
}

/// Irradiance of each sample from what the device made.
///
/// # Errors
/// [`Error::Interrupted`] between bands of samples, [`Error::Device`] where something is missing.
pub fn irradiance(
    pool: &ThreadPool,
    gathering: &Gathering,
    view: &Scenery,
    found: &Gathered,
    interrupted: Interrupted,
) -> Result<Vec<Vec4>> {
    let &Scenery { lit, camera, size, samples, photons } = view;
    let estimate = &gathering.estimate;
    let absent = || Error::Device("a frame without what its estimate reads".into());
    let irradiance = match gathering.gather {
        Gather::Reference => estimate::irradiance(pool, samples, photons, estimate, interrupted)?,
        Gather::Tiled => {
            let (tile, placement) = (gathering.clusters.tile, gathering.placement(lit, camera));
            tiled::irradiance(pool, samples, (size, tile), &placement, photons, estimate, interrupted)?
        }
        Gather::PerSample { .. } => {
            let (clusters, lists) = found.clusters.as_ref().zip(found.lists.as_ref()).ok_or_else(absent)?;
            let identifiers = &clusters.identifiers;
            per_sample::irradiance(pool, (samples, identifiers), lists, photons, estimate, interrupted)?
        }
        Gather::Buckets(setting) => {
            let (clusters, buckets) = found.clusters.as_ref().zip(found.buckets.as_ref()).ok_or_else(absent)?;
            let options = (&setting, estimate);
            let mut irradiance = buckets::irradiance(pool, samples, clusters, buckets, options, interrupted)?;
            if setting.blur > 0 {
                irradiance = blur::blurred(pool, samples, size, &irradiance, setting.blur, interrupted)?;
            }
            irradiance
        }
    };
    Ok(irradiance)
}
