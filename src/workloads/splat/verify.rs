//! Comparisons of what a frame made: with the twins, array by array, and with sums in double precision.
//!
//! A twin computes each stage from what the device made of the stages before it. On a device that computes as the
//! twins do, the arrays are equal to the bit. Elsewhere a path that is reflected by a slightly other angle ends
//! somewhere else, so that photons are compared as a whole, and the other arrays by the share of their elements that
//! differ.

use super::cpu::CpuFrame;
use super::exact_verify;
use super::gathered_verify;
use super::photons::{Photons, Traced};
use super::samples::Samples;
use super::splatting;
use super::splatting::setting::{Gather, Tasks};
use super::splatting::verify::SUMS;
use super::{Stages, mix};
use crate::camera::Camera;
use crate::device::Interrupted;
use crate::error::Result;
use crate::record::row::{Check, Metric};
use crate::workloads::size::Size;
use glam::{DVec3, Vec4};

/// How exactly a device must agree with the twins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exactness {
    /// To the bit.
    Bits,
    /// At most one element in [`SHARE`] differs by more than [`CLOSE`], and photons agree as a whole.
    Close,
}

/// One element in this many may differ where a device rounds differently: at edges of triangles and of shadows.
pub const SHARE: usize = 500;

/// Largest difference of an element that counts as none, as a share of the array's largest component.
pub const CLOSE: f32 = 1e-3;

/// Where a device rounds differently, the flux that arrives at a hit may differ by this share, plus the standard
/// deviation of that many paths.
pub const FLUX: f64 = 0.01;

/// Where a device rounds differently, the mean position of the photons of a hit may differ by so many standard errors
/// of as many independent ones.
pub const MEANS: f64 = 4.0;

/// Two arrays to the bit; `of` says what the other one is.
pub fn same(what: &str, of: &str, found: &[Vec4], expected: &[Vec4], row: u32) -> Check {
    let bits = |v: &Vec4| v.to_array().map(f32::to_bits);
    let differs = |index: &usize| bits(&found[*index]) != bits(&expected[*index]);
    let length = found.len().min(expected.len());
    let differing = (0..length).filter(differs).count() + found.len().abs_diff(expected.len());
    let message = match (0..length).find(differs) {
        None if differing == 0 => format!("{what}: every bit is {of}"),
        None => format!("{what}: there are {} elements instead of {}", found.len(), expected.len()),
        Some(at) => {
            let place =
                if row > 0 { format!("({}, {})", at % row as usize, at / row as usize) } else { at.to_string() };
            let [is, should] = [found[at], expected[at]].map(|v| format!("{:?}", v.to_array()));
            format!("{what}: {differing} elements differ; the first is {place}: {is} instead of {should}")
        }
    };
    Check { ok: differing == 0, message, metrics: vec![Metric::new("differing", differing)] }
}

/// Two arrays, most of whose elements agree.
pub fn close(what: &str, found: &[Vec4], expected: &[Vec4]) -> Check {
    let largest = expected.iter().map(|v| v.abs().max_element()).fold(0.0, f32::max);
    let beyond = |(a, b): &(&Vec4, &Vec4)| !((**a - **b).abs().max_element() <= largest * CLOSE);
    let differing = found.iter().zip(expected).filter(beyond).count() + found.len().abs_diff(expected.len());
    let most = expected.len() / SHARE;
    let message = format!(
        "{what}: {differing} of {} elements differ by more than {CLOSE} of the largest (at most {most})",
        expected.len()
    );
    Check { ok: differing <= most, message, metrics: vec![Metric::new("differing", differing)] }
}

/// Two images that differ by no more than the order of sums explains.
pub fn near(what: &str, found: &[Vec4], expected: &[Vec4]) -> Check {
    let scale = mean(expected).max_element() as f32 * SUMS;
    // Brighter pixels are sums of more, and round more
    let allowed = |b: &Vec4| scale.max(b.max_element() * SUMS);
    let beyond = |(a, b): &(&Vec4, &Vec4)| !((**a - **b).abs().max_element() <= allowed(b));
    let differing = found.iter().zip(expected).filter(beyond).count() + found.len().abs_diff(expected.len());
    let message = format!("{what}: {differing} elements differ by more than {SUMS:.0e} of the mean");
    Check { ok: differing == 0, message, metrics: vec![Metric::new("differing", differing)] }
}

/// What arrays are compared with.
const TWIN: &str = "the twin's";

fn arrays(what: &str, found: &[Vec4], expected: &[Vec4], row: u32, exactness: Exactness) -> Check {
    match exactness {
        Exactness::Bits => same(what, TWIN, found, expected, row),
        Exactness::Close => close(what, found, expected),
    }
}

/// Sum of the fluxes of each hit.
fn flux_by_hit(photons: &Photons, hits: usize) -> Vec<DVec3> {
    let mut sums = vec![DVec3::ZERO; hits + 1];
    for (position, flux) in photons.positions.iter().zip(&photons.fluxes) {
        if let Some(sum) = sums.get_mut(position.w as usize) {
            *sum += flux.truncate().as_dvec3();
        }
    }
    sums
}

/// Slots and arrivals of a device against the twin's.
pub fn traced(found: &Traced, expected: &Traced, exactness: Exactness) -> Vec<Check> {
    if exactness == Exactness::Bits {
        let arrived = Check {
            ok: found.arrived == expected.arrived,
            message: format!("{:?} paths arrived at the hits, {:?} by the twin", found.arrived, expected.arrived),
            metrics: Vec::new(),
        };
        let (found, expected) = (&found.slots, &expected.slots);
        return vec![
            arrived,
            same("positions of photons", TWIN, &found.positions, &expected.positions, 0),
            same("directions of photons", TWIN, &found.directions, &expected.directions, 0),
            same("fluxes of photons", TWIN, &found.fluxes, &expected.fluxes, 0),
        ];
    }
    let hits = expected.arrived.len();
    let [own, twin] = [found, expected].map(|traced| flux_by_hit(&traced.slots, hits));
    let mut worst = (0.0_f64, 0);
    for hit in 2..=hits {
        let (own, twin) = (own[hit].element_sum(), twin[hit].element_sum());
        let noise = 1.0 / f64::from(expected.arrived[hit - 1].max(1)).sqrt();
        let excess = (own - twin).abs() / twin.abs().max(f64::MIN_POSITIVE) / (FLUX + noise);
        // Not a number is the worst of all
        if !(excess <= worst.0 || worst.0.is_nan()) {
            worst = (excess, hit);
        }
    }
    let (excess, hit) = worst;
    let message = format!("the flux of hit {hit} differs most, by {excess:.3} of what is allowed");
    let mut checks = positions(&found.slots, &expected.slots, hits);
    let first = found.arrived.first().copied().unwrap_or(0).abs_diff(expected.arrived.first().copied().unwrap_or(0));
    let most = expected.arrived.first().copied().unwrap_or(0) / SHARE as u32;
    let arrived = format!("{first} paths more or fewer arrive at the first hit than by the twin (at most {most})");
    checks.push(Check { ok: excess <= 1.0 && found.slots.len() == expected.slots.len(), message, metrics: Vec::new() });
    checks.push(Check { ok: first <= most, message: arrived, metrics: Vec::new() });
    checks
}

/// Photons where a device rounds differently: those of the second hit one by one, for one reflection changes little;
/// those of each hit by their mean position and direction.
fn positions(found: &Photons, expected: &Photons, hits: usize) -> Vec<Check> {
    let of_hit = |array: &[Vec4], hit: usize| -> Vec<Vec4> {
        array.iter().skip(hit - 2).step_by(hits.saturating_sub(1).max(1)).copied().collect()
    };
    let mut checks = Vec::new();
    for (what, found, expected) in
        [("positions", &found.positions, &expected.positions), ("directions", &found.directions, &expected.directions)]
    {
        // The fourth component is a number that has no error
        let places = |all: Vec<Vec4>| -> Vec<Vec4> { all.iter().map(|v| v.truncate().extend(0.0)).collect() };
        let [own, twin] = [found, expected].map(|all| places(of_hit(all, 2)));
        checks.push(close(&format!("{what} of photons at hit 2"), &own, &twin));
        for hit in 2..=hits {
            let [own, twin] = [found, expected].map(|all| of_hit(all, hit));
            let (centre, far) = (mean(&twin), (mean(&own) - mean(&twin)).length());
            let spread = twin.iter().map(|v| (v.truncate().as_dvec3() - centre).length_squared()).sum::<f64>();
            let count = twin.len().max(1) as f64;
            let most = MEANS * (spread / count).sqrt() / count.sqrt();
            let message = format!("{what} of photons at hit {hit}: their mean is {far:.3e} off (at most {most:.3e})");
            checks.push(Check { ok: far <= most, message, metrics: Vec::new() });
        }
    }
    checks
}

/// All arrays of a frame against the twins.
///
/// # Errors
/// [`crate::Error::Interrupted`].
pub fn stages(
    found: &Stages,
    mut twin: CpuFrame,
    camera: &Camera,
    exactness: Exactness,
    interrupted: Interrupted,
) -> Result<Vec<Check>> {
    let size = twin.size();
    let mut checks = traced(&found.traced, &twin.trace(interrupted)?, exactness);
    checks.push(compaction(found));
    checks.extend(seen(found, &mut twin, camera, exactness, interrupted)?);
    checks.extend(gathered(found, &twin, camera, exactness, interrupted)?);
    checks.push(mixed(found, size, exactness));
    Ok(checks)
}

/// What lies between samples and irradiance, and irradiance, against the twins.
fn gathered(
    found: &Stages,
    twin: &CpuFrame,
    camera: &Camera,
    exactness: Exactness,
    interrupted: Interrupted,
) -> Result<Vec<Check>> {
    let view = twin.scenery(camera, &found.samples, &found.photons);
    let (pool, gathering) = (twin.pool(), twin.gathering());
    let mut checks = gathered_verify::check(pool, gathering, &view, &found.gathered, exactness)?;
    // From something wrong nothing follows
    if checks.iter().all(|check| check.ok) {
        let irradiance = gathered_verify::irradiance(pool, gathering, &view, &found.gathered, interrupted)?;
        // Sums of given lists and buckets have an order; only a queue's have none
        let is_repeatable = !matches!(gathering.gather, Gather::PerSample { tasks: Tasks::Queue, .. });
        let row = view.size.width;
        checks.push(splatting::verify::irradiance(&found.irradiance, &irradiance, is_repeatable, exactness, row));
    }
    Ok(checks)
}

/// Samples and direct light against the twins.
fn seen(
    found: &Stages,
    twin: &mut CpuFrame,
    camera: &Camera,
    exactness: Exactness,
    interrupted: Interrupted,
) -> Result<Vec<Check>> {
    let row = twin.size().width;
    let Samples { positions, normals, albedos } = twin.samples(camera, interrupted)?;
    let mut checks = Vec::new();
    for (what, found, expected) in [
        ("positions of samples", &found.samples.positions, positions),
        ("normals of samples", &found.samples.normals, normals),
        ("albedos of samples", &found.samples.albedos, albedos),
    ] {
        checks.push(arrays(what, found, &expected, row, exactness));
    }
    let direct = twin.direct(camera, &found.samples, interrupted)?;
    checks.push(arrays("direct light", &found.direct, &direct, row, exactness));
    Ok(checks)
}

/// Checks of a whole image: compaction, samples and direct light against the twins, the estimate against sums in double
/// precision, those of buckets against the twins as well, and the mix.
///
/// # Errors
/// [`crate::Error::Interrupted`].
pub fn image(
    found: &Stages,
    mut twin: CpuFrame,
    camera: &Camera,
    exactness: Exactness,
    interrupted: Interrupted,
) -> Result<Vec<Check>> {
    let size = twin.size();
    let mut checks = vec![compaction(found), sound(found, size)];
    checks.extend(seen(found, &mut twin, camera, exactness, interrupted)?);
    if twin.gathering().gather.has_clusters() {
        checks.extend(gathered(found, &twin, camera, exactness, interrupted)?);
    }
    // From something wrong nothing follows
    if checks.iter().all(|check| check.ok) {
        let view = twin.scenery(camera, &found.samples, &found.photons);
        checks.extend(exact_verify::estimate(twin.pool(), found, twin.gathering(), &view, interrupted)?);
    }
    checks.push(mixed(found, size, exactness));
    Ok(checks)
}

/// No element of an image was left out, and none is negative or no number.
pub fn sound(found: &Stages, size: Size) -> Check {
    let arrays = [&found.samples.positions, &found.direct, &found.irradiance, &found.picture];
    let complete = arrays.iter().all(|array| array.len() == size.pixels());
    let light = |v: &&Vec4| !(v.is_finite() && v.min_element() >= 0.0);
    let broken = arrays[1..].iter().flat_map(|array| array.iter()).filter(light).count();
    let depths = found.samples.positions.iter().filter(|v| !(v.is_finite() && v.w >= 0.0)).count();
    let message = format!("{} elements of the image are negative or no numbers, or are missing", broken + depths);
    Check { ok: complete && broken + depths == 0, message, metrics: Vec::new() }
}

/// The compacted photons are those of the slots, in their order.
pub fn compaction(found: &Stages) -> Check {
    let expected = found.traced.slots.compacted();
    let of = |photons: &Photons| [&photons.positions[..], &photons.directions, &photons.fluxes].concat();
    same("compacted photons", "that of a slot, in their order", &of(&found.photons), &of(&expected), 0)
}

/// The picture is made of its parts.
fn mixed(found: &Stages, size: Size, exactness: Exactness) -> Check {
    let picture = mix::picture(&found.samples, &found.direct, &found.irradiance);
    arrays("the picture", &found.picture, &picture, size.width, exactness)
}

/// Mean by channel.
pub fn mean(image: &[Vec4]) -> DVec3 {
    image.iter().map(|v| v.truncate().as_dvec3()).sum::<DVec3>() / image.len().max(1) as f64
}

/// BLAKE3 of an image, hexadecimal.
pub fn hash(image: &[Vec4]) -> String {
    blake3::hash(bytemuck::cast_slice(image)).to_hex().to_string()
}

/// BLAKE3 of photons, hexadecimal.
pub fn photons_hash(photons: &Photons) -> String {
    let mut hasher = blake3::Hasher::new();
    for array in [&photons.positions, &photons.directions, &photons.fluxes] {
        hasher.update(bytemuck::cast_slice(array));
    }
    hasher.finalize().to_hex().to_string()
}
