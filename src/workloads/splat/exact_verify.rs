//! Estimates at fixed pixels against sums in double precision over all photons.

use super::Stages;
use super::gathered::Scenery;
use super::gathering::Gathering;
use super::reference::by_direction::{self, Receivers};
use super::reference::exact::{self, Exact};
use super::reference::pixels::fixed_pixels;
use super::setting::Estimate;
use super::splatting::setting::{BucketSetting, Gather};
use crate::device::Interrupted;
use crate::error::Result;
use crate::record::row::{Check, Metric};
use crate::workloads::size::Size;
use glam::DVec3;
use rayon::ThreadPool;

/// Pixels whose estimate is computed again in double precision.
pub const EXACT_PIXELS: u32 = 300;

/// Largest difference of an estimate from the sum in double precision beyond [`Exact::allowance`], as a share of the
/// mean of these pixels.
pub const EXACT: f64 = 1e-5;

/// The estimate of a technique; nothing where a blur follows, or where photons that face away from normals are left
/// out of sums by direction.
///
/// # Errors
/// [`crate::Error::Interrupted`].
pub fn estimate(
    pool: &ThreadPool,
    found: &Stages,
    gathering: &Gathering,
    view: &Scenery,
    interrupted: Interrupted,
) -> Result<Option<Check>> {
    match gathering.gather {
        Gather::Buckets(setting) => by_buckets(pool, found, gathering, view, setting, interrupted),
        _ => over_photons(pool, found, gathering.estimate, view.size, interrupted).map(Some),
    }
}

/// An estimate over photons.
///
/// # Errors
/// [`crate::Error::Interrupted`].
pub fn over_photons(
    pool: &ThreadPool,
    found: &Stages,
    estimate: Estimate,
    size: Size,
    interrupted: Interrupted,
) -> Result<Check> {
    let pixels = fixed_pixels(size, EXACT_PIXELS);
    let exact = exact::irradiance(pool, &found.samples, &found.photons, &estimate, &pixels, interrupted)?;
    Ok(compared(found, &pixels, &exact))
}

fn by_buckets(
    pool: &ThreadPool,
    found: &Stages,
    gathering: &Gathering,
    view: &Scenery,
    setting: BucketSetting,
    interrupted: Interrupted,
) -> Result<Option<Check>> {
    let has_normals = gathering.layout.as_ref().is_some_and(|layout| layout.bits[3] > 0);
    let (Some(clusters), Some(buckets)) = (&found.gathered.clusters, &found.gathered.buckets) else { return Ok(None) };
    if setting.blur > 0 || has_normals {
        return Ok(None);
    }
    let placement = gathering.placement(view.lit, view.camera);
    let receivers = Receivers {
        samples: &found.samples,
        clusters,
        placement: &placement,
        photons: &found.photons,
        setting,
        estimate: gathering.estimate,
        quantum: if buckets.scale > 0.0 { 1.0 / f64::from(buckets.scale) } else { 0.0 },
    };
    let pixels = fixed_pixels(view.size, EXACT_PIXELS);
    let exact = by_direction::irradiance(pool, &receivers, &pixels, interrupted)?;
    Ok(Some(compared(found, &pixels, &exact)))
}

fn compared(found: &Stages, pixels: &[u32], exact: &[Exact]) -> Check {
    // Pixels without a surface have no light and do not count
    let lit: Vec<&Exact> = exact.iter().filter(|exact| exact.photons > 0).collect();
    let mean = lit.iter().map(|exact| exact.value).sum::<DVec3>().max_element() / lit.len().max(1) as f64;
    let excess = |(&pixel, exact): (&u32, &Exact)| {
        let own = found.irradiance[pixel as usize].truncate().as_dvec3();
        let excess = (own - exact.value).abs() - exact.allowance();
        if excess.is_nan() { f64::NAN } else { excess.max_element() }
    };
    let mut worst = f64::NEG_INFINITY;
    for excess in pixels.iter().zip(exact).map(excess) {
        // What is no number is the worst of all
        if !(excess <= worst || worst.is_nan()) {
            worst = excess;
        }
    }
    // Where nothing is to be found, everything is too much
    let share = if worst <= 0.0 { 0.0 } else { worst / mean };
    let message = format!(
        "the irradiance of {} pixels differs from sums in double precision by at most {share:.2e} of the mean more \
         than rounding allows (limit: {EXACT:.0e})",
        pixels.len()
    );
    Check { ok: share <= EXACT, message, metrics: vec![Metric::new("pixels", pixels.len())] }
}
