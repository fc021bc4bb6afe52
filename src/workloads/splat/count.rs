//! What a frame consists of: paths, photons, samples, flux.

use super::Stages;
use super::lit::LitScene;
use super::setting::Setting;
use super::splatting::setting::Gather;
use super::verify::mean;
use crate::record::row::Metric;
use crate::record::statistics::round;
use glam::DVec3;

/// Paths that arrive at each hit and that are lost before it, photons, samples, distance tests, stored flux as a share
/// of what the lights emit, and the means of irradiance and direct light over all pixels.
pub fn metrics(stages: &Stages, lit: &LitScene, setting: Setting, gather: Gather) -> Vec<Metric> {
    let mut metrics = Vec::new();
    let mut before = setting.paths;
    for (hit, &arrived) in (1..).zip(&stages.traced.arrived) {
        let of = format!("hit-{hit}");
        let lost = before.saturating_sub(arrived);
        metrics.push(Metric::of(&of, "arrived", arrived));
        metrics.push(Metric::of(&of, "lost_pct", round(100.0 * f64::from(lost) / f64::from(before.max(1)), 4)));
        before = arrived;
    }
    let photons = stages.photons.len() as u64;
    let samples = stages.samples.positions.iter().filter(|position| position.w > 0.0).count() as u64;
    let sum = |all: &mut dyn Iterator<Item = DVec3>| all.sum::<DVec3>().element_sum();
    let emitted = sum(&mut lit.lights.iter().map(|light| light.flux.as_dvec3()));
    let stored = sum(&mut stages.photons.fluxes.iter().map(|flux| flux.truncate().as_dvec3()));
    metrics.push(Metric::new("photons", photons));
    metrics.push(Metric::new("samples", samples));
    if gather == Gather::Reference {
        metrics.push(Metric::new("distance_tests", photons * samples));
    }
    if emitted > 0.0 {
        metrics.push(Metric::new("stored_flux_share", round(stored / emitted, 6)));
    }
    let channel_mean = |image| digits(mean(image).element_sum() / 3.0);
    metrics.push(Metric::new("irradiance_mean", channel_mean(&stages.irradiance)));
    metrics.push(Metric::new("direct_mean", channel_mean(&stages.direct)));
    metrics
}

/// A number with nine significant digits: single precision has no more.
pub fn digits(number: f64) -> f64 {
    format!("{number:.8e}").parse().unwrap_or(number)
}

#[cfg(test)]
mod tests {
    use super::digits;

    #[test]
    fn nine_digits_are_kept_at_every_size() {
        assert_eq!(digits(1.234_567_890_12e-12), 1.234_567_89e-12);
        assert_eq!(digits(98_765_432_109.0), 98_765_432_100.0);
        assert_eq!(digits(0.0), 0.0);
    }
}
