//! Half precision: how far its picture is from single precision's, and its speed where the device has it.
//!
//! On the CPU every operation is computed in single precision and rounded, which takes longer than single precision
//! alone, so that there is no speed to measure.

use super::case::SpheresCase;
use super::gpu::GpuRenderer;
use super::input::SpheresInput;
use super::options::Precision;
use super::references::{Shot, in_bands};
use super::render::{compare, half};
use super::view::View;
use super::{memory, pictures, verify};
use crate::device::{FrameTime, KernelInfo, VulkanDevice};
use crate::error::{Error, Result};
use crate::harness::workload::{Case, Run, Verdict};
use crate::names;
use crate::record::picture::FOLDER;
use crate::record::row::Metric;

/// The differences of the picture are shown so many times as bright.
const BRIGHTER: f32 = 4.0;

/// See the module.
pub(super) struct HalfRun<'a> {
    input: &'a SpheresInput<'a>,
    /// Absent on the CPU.
    device: Option<&'a VulkanDevice>,
    /// The renderer of the case that is verified or timed, and its case.
    renderer: Option<(SpheresCase, GpuRenderer<'a>)>,
}

impl<'a> HalfRun<'a> {
    pub fn new(input: &'a SpheresInput<'a>, device: Option<&'a VulkanDevice>) -> HalfRun<'a> {
        HalfRun { input, device, renderer: None }
    }

    /// The renderer of a case.
    fn gpu(&mut self, device: &'a VulkanDevice, case: SpheresCase) -> Result<&mut GpuRenderer<'a>> {
        let SpheresCase { size, trips, options, .. } = case;
        if self.renderer.as_ref().is_none_or(|(known, _)| *known != case) {
            let spheres = &self.input.spheres;
            let renderer = GpuRenderer::in_precision(Precision::F16, device, spheres, options, size, trips)?;
            self.renderer = Some((case, renderer));
        }
        match &mut self.renderer {
            Some((_, renderer)) => Ok(renderer),
            None => Err(Error::Device("the renderer is gone".into())),
        }
    }

    /// Writes the picture and its difference from single precision, those of the scene's first row of half precision.
    fn write(&self, case: &SpheresCase, image: &[[f32; 4]], single: &[[f32; 4]]) -> Result<()> {
        let file = |suffix: &str| {
            let name = format!("{}-half{suffix}", self.input.name);
            self.input.context.out.join(FOLDER).join(format!("{}.png", names::distinct_slug(&name)))
        };
        if file("").is_file() {
            return Ok(());
        }
        pictures::write(&file(""), case.size, image)?;
        pictures::write(&file("-difference"), case.size, &compare::difference(image, single, BRIGHTER))
    }
}

/// Shots of a case's frames.
fn shot(case: &SpheresCase, frame: usize) -> Shot {
    Shot { size: case.size, trips: case.trips, frame: frame % case.frames, frames: case.frames }
}

impl Run for HalfRun<'_> {
    fn kernels(&self, case: &Case) -> Result<Vec<KernelInfo>> {
        let (case, Some(device)) = (SpheresCase::parse(case)?, self.device) else { return Ok(Vec::new()) };
        let SpheresCase { size, trips, options, .. } = case;
        let spheres = &self.input.spheres;
        Ok(vec![GpuRenderer::in_precision(Precision::F16, device, spheres, options, size, trips)?.kernel()])
    }

    fn verify(&mut self, case: &Case) -> Result<Verdict> {
        let case = SpheresCase::parse(case)?;
        memory::check(case.size)?;
        let SpheresInput { scene, spheres, references, context, .. } = self.input;
        context.check_interrupt()?;
        let (algorithm, shot) = (case.options.algorithm, shot(&case, 0));
        let single = references.borrow_mut().of(scene, spheres, (algorithm, shot), context.interrupted)?;
        let view = shot.view(scene);
        let rows = |rows| half::rows(spheres, &view, algorithm, rows);
        let rounded = in_bands(view.height, context.interrupted, rows)?.concat();
        let (image, check) = match self.device {
            None => {
                let check = verify::half(&rounded, None, &single.image);
                (rounded, check)
            }
            Some(device) => {
                let image = self.gpu(device, case)?.render(&view)?;
                let check = verify::half(&image, Some(&rounded), &single.image);
                (image, check)
            }
        };
        self.write(&case, &image, &single.image)?;
        let rmse = compare::rmse(&image, &single.image);
        let largest = compare::largest_difference(&image, &single.image);
        Ok(Verdict {
            problem: (!check.ok).then(|| check.message.clone()),
            checks: vec![check],
            metrics: vec![Metric::new("rmse", rmse), Metric::new("largest_difference", largest)],
            ..Verdict::default()
        })
    }

    fn pass(&mut self, case: &Case, warm_up: Option<usize>) -> Result<Vec<FrameTime>> {
        let case = SpheresCase::parse(case)?;
        let Some(device) = self.device else {
            return Err(Error::unsupported(
                "speed not measured: half precision is single precision with rounding on this processor",
            ));
        };
        let SpheresInput { scene, context, .. } = self.input;
        let views: Vec<View> =
            (0..warm_up.unwrap_or(case.frames)).map(|frame| shot(&case, frame).view(scene)).collect();
        self.gpu(device, case)?.time(&views, context.interrupted)
    }

    fn recheck(&mut self, case: &Case) -> Result<Verdict> {
        let (case, Some(device)) = (SpheresCase::parse(case)?, self.device) else { return Ok(Verdict::default()) };
        let view = shot(&case, case.frames - 1).view(&self.input.scene);
        let renderer = self.gpu(device, case)?;
        let timed = renderer.last()?;
        let again = renderer.render(&view)?;
        let first = compare::compare(&timed, &again, case.size.width as usize);
        let problem = first.map(|first| {
            format!("the last timed frame differs in {} pixels from the same frame rendered again", first.count)
        });
        Ok(Verdict { problem, ..Verdict::default() })
    }
}
