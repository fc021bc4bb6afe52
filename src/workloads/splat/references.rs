//! Path-traced references of a run: how far an estimate is from them. They judge an estimate and decide no row: an
//! estimate with a large radius is biased, and still right.

use super::Stages;
use super::case::SplatCase;
use super::count::digits;
use super::input::{REFERENCE_TREE, SplatInput};
use super::reference;
use super::reference::path_traced::{Effort, PathTraced};
use super::reference::pixels::fixed_pixels;
use super::setting::Energy;
use crate::camera::Camera;
use crate::error::Result;
use crate::harness::workload::{Event, Verdict};
use crate::record::row::Metric;
use crate::record::statistics::round;
use crate::workloads::trace::Selection;
use crate::workloads::trace::backend::Backend;
use glam::DVec3;
use std::collections::HashMap;
use std::path::PathBuf;
use std::rc::Rc;

/// Pixels of an image that are path-traced.
pub const PIXELS: u32 = 1000;

/// References by what decides them.
#[derive(Default)]
pub struct References(HashMap<String, Rc<PathTraced>>);

/// The folder in which references are kept from run to run: `RTBENCH_CACHE`, or the user's folder for caches.
pub fn folder() -> Option<PathBuf> {
    let variable = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let own = || Some(variable("XDG_CACHE_HOME").or_else(|| Some(variable("HOME")?.join(".cache")))?.join("rtbench"));
    variable("RTBENCH_CACHE").or_else(own)
}

/// Adds means and errors of a frame's estimate against the path-traced reference of the same pixels.
///
/// # Errors
/// [`crate::Error::Interrupted`].
pub fn compare(
    input: &SplatInput,
    case: &SplatCase,
    camera: &Camera,
    stages: &Stages,
    verdict: &mut Verdict,
) -> Result<()> {
    // With shared energy an estimate is no solution of the rendering equation
    if case.setting.energy != Energy::Flux {
        return Ok(());
    }
    let pixels = fixed_pixels(case.size, PIXELS);
    let traced = of(input, case, camera, &pixels, verdict)?;
    let estimate: Vec<DVec3> = pixels.iter().map(|&at| stages.irradiance[at as usize].truncate().as_dvec3()).collect();
    let [own, exact] = [&estimate, &traced.irradiance].map(|all| all.iter().sum::<DVec3>().element_sum());
    let count = (3 * pixels.len()).max(1) as f64;
    let squares = estimate.iter().zip(&traced.irradiance).map(|(a, b)| (*a - *b).length_squared()).sum::<f64>();
    let (scale, scaled) = best_scale(&estimate, &traced.irradiance);
    let error = traced.sum_error / 3.0;
    let relative = traced.relative_error();
    verdict.metrics.extend([
        Metric::new("path_traced_mean", digits(exact / count)),
        Metric::new("path_traced_error", digits(error)),
        Metric::new("path_traced_error_pct", round(100.0 * relative, 3)),
        Metric::new("path_traced_paths", traced.paths),
        Metric::new("rmse", digits((squares / count).sqrt())),
        Metric::new("best_scale", digits(scale)),
        Metric::new("rmse_scaled", digits((scaled / count).sqrt())),
    ]);
    if exact > 0.0 {
        verdict.metrics.push(Metric::new("ratio_to_path_traced", round(own / exact, 6)));
    }
    if relative >= Effort::default().error {
        verdict.warnings.push(format!(
            "after {} paths a pixel the standard error of the path-traced mean is still {:.2} % of it",
            traced.paths,
            100.0 * relative
        ));
    }
    Ok(())
}

/// The factor that brings values nearest to others, 0 where the values are, and the sum of the squared differences that
/// are left.
pub fn best_scale(values: &[DVec3], others: &[DVec3]) -> (f64, f64) {
    let own = values.iter().map(|value| value.length_squared()).sum::<f64>();
    let common = values.iter().zip(others).map(|(value, other)| value.dot(*other)).sum::<f64>();
    let scale = if own > 0.0 { common / own } else { 0.0 };
    let left = values.iter().zip(others).map(|(value, other)| (*value * scale - *other).length_squared()).sum();
    (scale, left)
}

/// The reference of a frame.
fn of(
    input: &SplatInput,
    case: &SplatCase,
    camera: &Camera,
    pixels: &[u32],
    verdict: &mut Verdict,
) -> Result<Rc<PathTraced>> {
    let lit = input.lit(case)?;
    let key = format!("{} {camera:?} {:?} {}", lit.hash, case.size, case.setting.hits);
    if let Some(known) = input.references.borrow().0.get(&key) {
        return Ok(known.clone());
    }
    let context = input.context;
    context.emit(Event::Doing(format!("path-tracing {}", lit.scene.scene.name)));
    let method = Selection::parse(REFERENCE_TREE)?.method();
    let mut caster = Backend::prepare(&input.cpu, &lit.scene.scene, &*input.reference.structure, method)?;
    let hits = case.setting.hits;
    let (traced, warnings) = reference::of(
        input.cpu.pool(),
        &mut *caster,
        &lit.scene,
        camera,
        case.size,
        pixels,
        hits,
        input.cache.as_deref(),
        context.interrupted,
    )?;
    verdict.warnings.extend(warnings);
    let traced = Rc::new(traced);
    input.references.borrow_mut().0.insert(key, traced.clone());
    Ok(traced)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_scale_leaves_least() {
        let values = [DVec3::new(1.0, 2.0, 0.5), DVec3::new(0.0, 4.0, 1.0)];
        let others = values.map(|value| value * 2.5);
        let (scale, left) = best_scale(&values, &others);
        assert!((scale - 2.5).abs() < 1e-12 && left < 1e-20);
        let others = [DVec3::new(1.0, 1.0, 1.0), DVec3::new(2.0, 0.0, 1.0)];
        let (scale, left) = best_scale(&values, &others);
        let at = |scale: f64| {
            values.iter().zip(&others).map(|(value, other)| (*value * scale - *other).length_squared()).sum::<f64>()
        };
        assert!(left < at(scale * 1.01) && left < at(scale * 0.99));
        assert_eq!(best_scale(&[DVec3::ZERO], &[DVec3::ONE]), (0.0, 3.0));
    }
}
