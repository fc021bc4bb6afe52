//! Half precision on the CPU: how far its picture is from single precision's. Every operation is computed in single
//! precision and rounded, which takes longer than single precision alone, so that there is no speed to measure.

use super::case::SpheresCase;
use super::input::SpheresInput;
use super::references::Shot;
use super::render::{compare, half};
use super::{memory, pictures};
use crate::device::FrameTime;
use crate::error::{Error, Result};
use crate::harness::workload::{Case, Run, Verdict};
use crate::names;
use crate::record::picture::FOLDER;
use crate::record::row::{Check, Metric};

/// Why a row of a device without half precision has no times.
pub const NO_DEVICE: &str = "speed not measured: no kernel for half precision runs on this device";

/// The differences of the picture are shown so many times as bright.
const BRIGHTER: f32 = 4.0;

/// See the module.
pub(super) struct HalfRun<'a> {
    input: &'a SpheresInput<'a>,
}

impl<'a> HalfRun<'a> {
    pub fn new(input: &'a SpheresInput<'a>) -> HalfRun<'a> {
        HalfRun { input }
    }
}

impl Run for HalfRun<'_> {
    fn verify(&mut self, case: &Case) -> Result<Verdict> {
        let SpheresCase { size, trips, frames, options, .. } = SpheresCase::parse(case)?;
        memory::check(size)?;
        let SpheresInput { scene, spheres, references, context, name, .. } = self.input;
        context.check_interrupt()?;
        let shot = Shot { size, trips, frame: 0, frames };
        let reference = references.borrow_mut().of(scene, spheres, options.algorithm, shot);
        let image = half::render(spheres, &shot.view(scene), options.algorithm);
        let rmse = compare::rmse(&image, &reference.image);
        let largest = compare::largest_difference(&image, &reference.image);
        let file = |suffix: &str| {
            let name = format!("{name}-half{suffix}");
            context.out.join(FOLDER).join(format!("{}.png", names::distinct_slug(&name)))
        };
        pictures::write(&file(""), size, &image)?;
        let difference = compare::difference(&image, &reference.image, BRIGHTER);
        pictures::write(&file("-difference"), size, &difference)?;
        let message = format!("half precision differs by {rmse:.4} (RMSE) from single precision");
        Ok(Verdict {
            checks: vec![Check { ok: true, message, metrics: Vec::new() }],
            metrics: vec![Metric::new("rmse", rmse), Metric::new("largest_difference", largest)],
            ..Verdict::default()
        })
    }

    fn pass(&mut self, _: &Case, _: Option<usize>) -> Result<Vec<FrameTime>> {
        Err(Error::unsupported(
            "speed not measured: half precision is single precision with rounding on this processor",
        ))
    }
}
