//! A structure with a traversal on a device: its cases verified, counted and run.

use super::backend::{Backend, Pixel, Prepared, Size, Warps};
use super::case::TraceCase;
use super::counting;
use super::input::TraceInput;
use super::rays::Config;
use super::record::{ByRayType, RAY_TYPES, Verification, counter_metrics};
use super::simt::Sums;
use super::verify;
use super::{Agreement, Built, Selection};
use crate::camera::View;
use crate::device::{DeviceInfo, FrameTime, KernelInfo};
use crate::error::{Error, Result};
use crate::harness::workload::{Case, Event, Run, Verdict};
use crate::names;
use crate::record::picture;
use crate::record::row::{Artifact, Metric};
use std::collections::HashMap;

/// The small image on which kernels are compared with their twins: not a multiple of the 8x8 pixels of a work-group, so
/// that groups at its edges are not full.
pub const SMALL: Size = Size { width: 68, height: 60 };

/// Where the device does not compute to the bit, at most one pixel in this many may differ between the timed and the
/// counting kernel: two builds of one kernel may be contracted differently, which shows at edges.
const COUNTING_TOLERANCE: usize = 1000;

/// See the module.
pub(super) struct TraceRun<'a> {
    input: &'a TraceInput<'a>,
    /// True if the device agrees with the twins to the bit.
    exact: bool,
    selection: Selection,
    built: &'a Built,
    tracer: Box<dyn Prepared + 'a>,
    /// The comparison with the twin on the small image, by configuration.
    small: HashMap<(Config, Option<usize>, String), Checked>,
    /// The first image by the timed kernel, RGBA8: what the counting kernel must make as well.
    first_image: Vec<u8>,
}

/// Comparisons, up to the first that failed.
#[derive(Clone, Default)]
struct Checked {
    verification: Vec<Verification>,
    difference: Option<String>,
}

impl Checked {
    /// What disagrees.
    fn problem(&self) -> Option<String> {
        let failed = self.verification.iter().find(|v| !v.ok)?;
        Some(format!("frame {} at {}x{}: {}", failed.frame, failed.width, failed.height, failed.message))
    }
}

impl<'a> TraceRun<'a> {
    pub fn new(
        input: &'a TraceInput<'a>,
        device: &DeviceInfo,
        selection: Selection,
        built: &'a Built,
        tracer: Box<dyn Prepared + 'a>,
    ) -> TraceRun<'a> {
        let exact = selection.method().is_exact_on(device);
        TraceRun { input, exact, selection, built, tracer, small: HashMap::new(), first_image: Vec::new() }
    }

    /// Compares one frame with the reference, on the small image also with the twin, and keeps a picture of what
    /// differs.
    fn check(&mut self, case: &TraceCase, frame: usize, size: Size, checked: &mut Checked) -> Result<verify::Verdict> {
        let context = self.input.context;
        context.check_interrupt()?;
        let view = &self.input.path(case)?.views[frame];
        let has_twin = self.selection.method().traversal.twin.is_some();
        let twin = (size == SMALL && has_twin).then_some(&*self.built.structure);
        let mut verifier = self.input.verifier.borrow_mut();
        let tracer = self.tracer.as_mut();
        let verdict = verifier.check(tracer, self.selection.method(), twin, (case.config, view, size), self.exact)?;
        checked.verification.push(Verification {
            frame,
            width: size.width,
            height: size.height,
            ok: verdict.ok,
            twin: twin.is_some(),
            rays: verdict.rays,
            brute_checked: verdict.brute_checked,
            hits_differing: verdict.hits_differing,
            hits_lost: verdict.hits_lost,
            counters_differing: verdict.counters_differing,
            colours_differing: verdict.colours_differing,
            max_colour_difference: verdict.max_colour_difference,
            image_hash: verdict.image_hash.clone(),
            message: verdict.message.clone(),
        });
        if let Some(difference) = verdict.difference.as_ref().filter(|_| !verdict.ok) {
            let Size { width, height } = size;
            let (scene, structure) = (&self.input.record.name, self.selection.full_name());
            let (config, path) = (case.config, &case.camera_path);
            let name = format!("{scene}-{structure}-{config:?}-{width}x{height}-frame{frame}-{path}");
            let file = format!("differences/{}.png", names::distinct_slug(&name));
            let folder = context.out.join("differences");
            std::fs::create_dir_all(&folder).map_err(|source| Error::output(&folder, source))?;
            picture::write_png(&context.out.join(&file), width, height, difference)?;
            checked.difference = Some(file);
        }
        Ok(verdict)
    }

    /// Adds what warps of `width` lanes issue; a warning where that is not modelled.
    fn count_warps(&self, case: &TraceCase, width: u32, verdict: &mut Verdict) -> Result<()> {
        let sums = match self.warps(case, width) {
            Err(Error::Refused(refusal)) => {
                verdict.warnings.push(format!("warps are not counted: {refusal}"));
                return Ok(());
            }
            sums => sums?,
        };
        for (ray, sums) in RAY_TYPES.iter().zip(&sums).filter(|(_, sums)| sums.warps > 0) {
            verdict.metrics.extend(sums.values().into_iter().map(|(name, value)| Metric::of(ray, &name, value)));
        }
        Ok(())
    }

    /// What warps issue for all frames, by the twin.
    fn warps(&self, case: &TraceCase, width: u32) -> Result<ByRayType<Sums>> {
        let verifier = self.input.verifier.borrow();
        let mut twin = verifier.cpu.prepare(&verifier.scene, &*self.built.structure, self.selection.method())?;
        let mut sums = ByRayType::<Sums>::default();
        for view in &self.input.path(case)?.views {
            self.input.context.check_interrupt()?;
            let of_frame = twin.in_warps(case.config, view, case.size, Warps::all(width))?;
            sums.iter_mut().zip(&of_frame).for_each(|(sum, frame)| *sum = sum.with(frame));
        }
        Ok(sums)
    }

    /// All structures must make the same picture, to the bit where the device computes to the bit. Returns the
    /// reference hash, and the structure that it is of if it differs.
    fn compare_structures(&self, case: &TraceCase, hash: &str) -> (String, Option<String>) {
        let mut images = self.input.images.borrow_mut();
        let own = (self.selection.name().to_owned(), hash.to_owned());
        let key = self.input.image_key(case);
        // What is not exact is compared with nothing, and nothing is compared with it
        if !self.exact {
            return (images.get(&key).unwrap_or(&own).1.clone(), None);
        }
        let (first, reference) = images.entry(key).or_insert(own);
        (reference.clone(), (reference != hash).then(|| first.clone()))
    }
}

impl Run for TraceRun<'_> {
    fn artifact(&self) -> Option<Artifact> {
        let mut artifact = self.input.artifact_of(&self.selection, Some(self.tracer.allocated()))?;
        artifact.metrics.extend(self.tracer.artifact_metrics());
        Some(artifact)
    }

    fn kernels(&self, case: &Case) -> Result<Vec<KernelInfo>> {
        self.tracer.kernels(TraceCase::parse(case)?.config)
    }

    fn stages(&self, case: &Case) -> Vec<String> {
        let stages = TraceCase::parse(case).map(|case| self.tracer.stages(case.config)).unwrap_or_default();
        stages.into_iter().map(str::to_owned).collect()
    }

    fn verify(&mut self, case: &Case) -> Result<Verdict> {
        let case = TraceCase::parse(case)?;
        let key = (case.config, case.frames, case.camera_path.clone());
        // On the small image, with the twin, once for all sizes
        if !self.small.contains_key(&key) {
            let middle = self.input.path(&case)?.views.len() / 2;
            let frames = if middle == 0 { vec![0] } else { vec![0, middle] };
            let mut checked = Checked::default();
            for frame in frames {
                if checked.problem().is_none() {
                    self.check(&case, frame, SMALL, &mut checked)?;
                }
            }
            self.small.insert(key.clone(), checked);
        }
        let mut checked = self.small[&key].clone();
        let mut verdict = Verdict::default();
        if checked.problem().is_none() {
            let image = self.check(&case, 0, case.size, &mut checked)?;
            if checked.problem().is_none() {
                verdict.outputs.insert("image".into(), image.image_hash.clone());
                let (reference, other) = self.compare_structures(&case, &image.image_hash);
                verdict.outputs.insert("reference_image".into(), reference);
                verdict.problem = other.map(|other| format!("the image differs from that of {other}"));
                self.first_image = image.image;
            }
        }
        verdict.problem = checked.problem().or(verdict.problem);
        verdict.checks = checked.verification.iter().map(Verification::to_check).collect();
        verdict.difference = checked.difference;
        Ok(verdict)
    }

    fn count(&mut self, case: &Case) -> Result<Verdict> {
        let (context, work) = (self.input.context, case.work / (self.input.context.settings.passes as u64 + 1));
        let case = TraceCase::parse(case)?;
        let views = &self.input.path(&case)?.views;
        let shape = (case.size, self.input.epsilon);
        let counted = counting::count(self.tracer.as_mut(), case.config, views, shape, &mut || {
            context.emit(Event::Work(work / views.len() as u64));
            context.check_interrupt()
        })?;
        let mut metrics = counter_metrics(&counted.sums);
        if self.selection.method().traversal.agreement == Agreement::HitsOnly {
            metrics.retain(|metric| metric.name == "rays"); // nothing else is known
        }
        let mut verdict = Verdict { metrics, ..Verdict::default() };
        if let Some(width) = case.warp_width {
            self.count_warps(&case, width, &mut verdict)?;
        }
        compare_kernels(self.exact, &std::mem::take(&mut self.first_image), &counted.first_image, &mut verdict);
        verdict.warnings.extend(counted.warnings(views.len()));
        Ok(verdict)
    }

    fn pass(&mut self, case: &Case, warm_up: Option<usize>) -> Result<Vec<FrameTime>> {
        let case = TraceCase::parse(case)?;
        let views = &self.input.path(&case)?.views;
        let first: Vec<View>;
        let views = match warm_up {
            Some(frames) => {
                first = views.iter().cycle().take(frames).cloned().collect();
                &first
            }
            None => views,
        };
        let times = self.tracer.time_path(case.config, views, case.size, self.input.context.interrupted)?;
        if times.len() != views.len() {
            return Err(Error::Device(format!("{} of {} frames came back", times.len(), views.len())));
        }
        Ok(times)
    }

    fn recheck(&mut self, case: &Case) -> Result<Verdict> {
        let case = TraceCase::parse(case)?;
        let timed = self.tracer.timed()?;
        let mut verdict = Verdict::default();
        if timed.dispatches > 0 {
            verdict.metrics.push(Metric::new("dispatches", timed.dispatches));
        }
        // What was timed is not what was verified (whole frames, in flight): its last picture must be the same
        if let Some(view) = self.input.path(&case)?.views.last() {
            let differing = differing_pixels(&timed.pixels, &self.tracer.image(case.config, view, case.size)?);
            verdict.problem = (differing > 0).then(|| {
                format!("the last timed frame has {differing} pixels that are not those of the verified kernel")
            });
        }
        Ok(verdict)
    }
}

/// Pixels in which two images by one kernel differ; all of them if one image is incomplete. One kernel gives the same
/// bits each time, on every device.
fn differing_pixels(a: &[Pixel], b: &[Pixel]) -> usize {
    if a.len() != b.len() {
        return a.len().max(b.len());
    }
    a.iter().zip(b).filter(|(a, b)| a != b).count()
}

/// The counting kernel must make the timed kernel's picture.
fn compare_kernels(exact: bool, timed: &[u8], counting: &[u8], verdict: &mut Verdict) {
    let pixels = timed.len() / 4;
    if timed.len() != counting.len() {
        let problem = format!("the counting kernel's image has {} pixels instead of {pixels}", counting.len() / 4);
        verdict.problem = Some(problem);
        return;
    }
    let differing = timed.chunks_exact(4).zip(counting.chunks_exact(4)).filter(|(a, b)| a != b).count();
    let message = format!("the counting kernel's image differs from the timed kernel's in {differing} pixels");
    if differing * COUNTING_TOLERANCE > pixels || (exact && differing > 0) {
        verdict.problem = Some(message);
    } else if differing > 0 {
        verdict.warnings.push(message);
    }
}
