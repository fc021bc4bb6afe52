//! One configuration before it is timed, verified and counted, and after it. What disagrees is not timed; timing itself is in
//! [`super::batch`].

use crate::camera::View;
use crate::error::{Error, Result};
use crate::harness::measure;
use crate::harness::plan::{Path, Plan};
use crate::harness::sweep::Event;
use crate::harness::verify::{Verdict, Verifier};
use crate::record::schema::{
    ConfigurationRecord, Failure, Memory, Samples, SceneRecord, Status, StructureRecord, Verification,
};
use crate::record::{files, picture};
use crate::scene::Scene;
use crate::workloads::trace::backend::{Config, Interrupted, Pixel, Prepared, Size};
use crate::workloads::trace::method::Rays;
use crate::workloads::trace::{Built, Selection};
use std::collections::HashMap;
use std::sync::Arc;
use std::time::Instant;

/// The small image on which kernels are compared with their twins: not a multiple of the 8x8 pixels of a work-group, so
/// that groups at its edges are not full.
pub const SMALL: Size = Size { width: 68, height: 60 };

/// Where the device does not compute to the bit, at most one pixel in this many may differ between the timed and the
/// counting kernel: two builds of one kernel may be contracted differently, which shows at edges.
const COUNTING_TOLERANCE: usize = 1000;

/// What is the same for all configurations of a sweep.
pub struct Context<'a> {
    /// The plan.
    pub plan: &'a Plan,
    /// The run's folder.
    pub out: &'a std::path::Path,
    /// True if the device agrees with the twins to the bit.
    pub exact: bool,
    /// Ctrl-C.
    pub interrupted: Interrupted<'a>,
    /// Who is watching.
    pub watch: &'a mut dyn FnMut(Event),
}

impl Context<'_> {
    /// Ends the sweep after Ctrl-C.
    ///
    /// # Errors
    /// [`Error::Interrupted`].
    pub fn check_interrupt(&self) -> Result<()> {
        if (self.interrupted)() { Err(Error::Interrupted) } else { Ok(()) }
    }
}

/// A scene and what belongs to it.
pub struct Subject<'s> {
    /// The scene.
    pub scene: &'s Arc<Scene>,
    /// For the record.
    pub record: SceneRecord,
    /// As the plan names it.
    pub what: String,
    /// By configuration and number of frames.
    pub paths: Vec<(Config, Option<usize>, Path)>,
    /// Knows the right answers.
    pub verifier: Verifier<'s>,
    /// Image of the first structure that was measured, by configuration, size and rays: its name and hash.
    pub images: HashMap<(Config, Size, Rays), (String, String)>,
}

/// A structure and a traversal on their way through the configurations.
pub struct Candidate<'b> {
    /// What was asked for.
    pub selection: &'b Selection,
    /// What was built.
    pub built: &'b Built,
    /// Its sizes.
    pub memory: Memory,
    /// How the comparison with the twin on the small image went, by configuration.
    pub small: HashMap<Config, Checked>,
}

/// Comparisons, up to the first that failed.
#[derive(Clone, Default)]
pub struct Checked {
    verification: Vec<Verification>,
    difference: Option<String>,
    seconds: f64,
}

impl Checked {
    /// What disagrees.
    fn failure(&self) -> Option<String> {
        let failed = self.verification.iter().find(|v| !v.ok)?;
        Some(format!("frame {} at {}x{}: {}", failed.frame, failed.width, failed.height, failed.message))
    }
}

/// A record with everything that is known before anything is measured.
pub fn blank(plan: &Plan, subject: &Subject, selection: &Selection, path: usize, size: Size) -> ConfigurationRecord {
    let (config, _, path) = &subject.paths[path];
    ConfigurationRecord {
        scene: subject.record.clone(),
        camera_path: path.record.clone(),
        structure: selection.name().to_string(),
        variant: selection.variant(),
        width: size.width,
        height: size.height,
        frames: path.views.len(),
        passes: plan.passes,
        ..ConfigurationRecord::new(*config)
    }
}

/// Makes an error row of a record.
pub fn fail(record: &mut ConfigurationRecord, failure: Failure, message: String) {
    record.status = Status::Error;
    record.failure = Some(failure);
    // One line, whatever a driver says.
    record.message = message.split_whitespace().collect::<Vec<_>>().join(" ");
    record.samples = None;
    record.timing_source = None;
}

/// Fills in what is known of a built structure.
pub fn describe(record: &mut ConfigurationRecord, candidate: &Candidate) {
    record.memory = candidate.memory;
    record.build_ms = candidate.built.build_ms;
    record.build_threads = candidate.built.build_threads;
}

/// The record of a structure as its rows name it.
pub fn structure_record(subject: &Subject, selection: &Selection, built: &Built) -> StructureRecord {
    StructureRecord {
        scene: subject.record.clone(),
        structure: selection.name().to_string(),
        variant: selection.variant(),
        properties: built.structure.properties(subject.scene),
        build_ms: built.build_ms,
        build_threads: built.build_threads,
        memory: Memory::default(),
        note: built.note.clone(),
    }
}

/// Verify and count one configuration. The record is `verified` if it may be timed.
///
/// # Errors
/// The device's, [`Error::Interrupted`], [`Error::Output`] of a difference image. A wrong answer is no error but a
/// record that says so.
pub fn examine(
    context: &mut Context,
    subject: &mut Subject,
    candidate: &mut Candidate,
    prepared: &mut dyn Prepared,
    path: usize,
    size: Size,
) -> Result<ConfigurationRecord> {
    let config = subject.paths[path].0;
    let mut record = blank(context.plan, subject, candidate.selection, path, size);
    describe(&mut record, candidate);
    record.kernel = prepared.kernel(config)?;

    // On the small image, with the twin, once for all sizes.
    if !candidate.small.contains_key(&config) {
        let last = subject.paths[path].2.views.len() / 2;
        let frames = if last == 0 { vec![0] } else { vec![0, last] };
        let mut checked = Checked::default();
        for frame in frames {
            if checked.failure().is_none() {
                check(context, subject, candidate, prepared, path, frame, SMALL, &mut checked)?;
            }
        }
        record.verification_s = checked.seconds;
        candidate.small.insert(config, checked);
    }
    let mut checked = Checked { seconds: 0.0, ..candidate.small[&config].clone() };
    let image = if checked.failure().is_none() {
        Some(check(context, subject, candidate, prepared, path, 0, size, &mut checked)?)
    } else {
        None
    };
    let failure = checked.failure();
    record.verification = checked.verification;
    record.difference = checked.difference;
    record.verification_s += checked.seconds;
    let image = match (image, failure) {
        (Some(image), None) => image,
        (_, failure) => {
            fail(&mut record, Failure::Verification, failure.unwrap_or_default());
            return Ok(record);
        }
    };
    record.image_hash = Some(image.image_hash.clone());
    if let Some(message) =
        compare_structures(context, subject, &mut record, candidate.selection.method().rays(), &image)
    {
        fail(&mut record, Failure::Verification, message);
        return Ok(record);
    }

    // Count.
    let views = &subject.paths[path].2.views;
    let work = context.plan.work(config, size, views) / (context.plan.passes as u64 + 1);
    let start = Instant::now();
    let per_frame = work / views.len() as u64;
    let watch = &mut *context.watch;
    let counted = measure::count(prepared, config, views, size, context.interrupted, &mut || {
        watch(Event::Work(per_frame));
    })?;
    record.counting_s = start.elapsed().as_secs_f64();
    record.counters = Some(counted.sums);
    if let Some(message) = compare_kernels(context.exact, &image.image, &counted.first_image, &mut record.warnings) {
        fail(&mut record, Failure::Verification, message);
        return Ok(record);
    }
    record.verified = true;
    Ok(record)
}

/// Completes the record of a configuration that has been timed.
///
/// # Errors
/// The device's, while what it wrote is read back.
pub fn conclude(
    record: &mut ConfigurationRecord,
    prepared: &mut dyn Prepared,
    views: &[View],
    samples: Samples,
) -> Result<()> {
    let size = Size { width: record.width, height: record.height };
    // What has been timed is not what has been verified (whole frames, in flight): its last picture must be the same.
    let timed = prepared.timed()?;
    record.dispatches = (timed.dispatches > 0).then_some(timed.dispatches);
    if let Some(view) = views.last()
        && let differing = differing_pixels(&timed.pixels, &prepared.image(record.config, view, size)?)
        && differing > 0
    {
        let message = format!("the last timed frame has {differing} pixels that are not those of the verified kernel");
        fail(record, Failure::Verification, message);
        record.verified = false;
        return Ok(());
    }
    let (source, warnings) = measure::choose_source(&samples);
    record.timing_source = Some(source);
    record.warnings.extend(warnings);
    record.samples = Some(samples);
    record.status = Status::Ok;
    Ok(())
}

/// Compare one frame with the reference, on the small image also with the twin, and keep a picture of what differs.
#[allow(clippy::too_many_arguments)]
fn check(
    context: &Context,
    subject: &mut Subject,
    candidate: &Candidate,
    prepared: &mut dyn Prepared,
    path: usize,
    frame: usize,
    size: Size,
    checked: &mut Checked,
) -> Result<Verdict> {
    context.check_interrupt()?;
    let (config, _, path) = &subject.paths[path];
    let twin = (size == SMALL).then_some(&candidate.built.structure);
    let method = candidate.selection.method();
    let start = Instant::now();
    let verdict = subject.verifier.check(prepared, method, twin, (*config, &path.views[frame], size), context.exact)?;
    checked.seconds += start.elapsed().as_secs_f64();
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
        let structure = format!("{}-{}", candidate.selection.name(), candidate.selection.variant());
        let Size { width, height } = size;
        let name = format!("{}-{structure}-{config:?}-{width}x{height}-frame{frame}", subject.record.name);
        let file = format!("differences/{}.png", files::slug(&name));
        let folder = context.out.join("differences");
        std::fs::create_dir_all(&folder).map_err(|source| Error::output(&folder, source))?;
        picture::write_png(&context.out.join(&file), width, height, difference)?;
        checked.difference = Some(file);
    }
    Ok(verdict)
}

/// All structures must make the same picture, to the bit where the device computes to the bit.
fn compare_structures(
    context: &Context,
    subject: &mut Subject,
    record: &mut ConfigurationRecord,
    rays: Rays,
    image: &Verdict,
) -> Option<String> {
    let key = (record.config, Size { width: record.width, height: record.height }, rays);
    let own = (record.structure.clone(), image.image_hash.clone());
    let (first, hash) = subject.images.entry(key).or_insert(own);
    record.reference_image_hash = Some(hash.clone());
    (context.exact && *hash != image.image_hash).then(|| format!("the image differs from that of {first}"))
}

/// Pixels in which two images by one kernel differ; all of them if one image is incomplete. One kernel gives the same bits
/// each time, on every device.
fn differing_pixels(a: &[Pixel], b: &[Pixel]) -> usize {
    if a.len() != b.len() {
        return a.len().max(b.len());
    }
    a.iter().zip(b).filter(|(a, b)| a != b).count()
}

/// The counting kernel must make the timed kernel's picture.
fn compare_kernels(exact: bool, timed: &[u8], counting: &[u8], warnings: &mut Vec<String>) -> Option<String> {
    let pixels = timed.len() / 4;
    if timed.len() != counting.len() {
        return Some(format!("the counting kernel's image has {} pixels instead of {pixels}", counting.len() / 4));
    }
    let differing = timed.chunks_exact(4).zip(counting.chunks_exact(4)).filter(|(a, b)| a != b).count();
    let message = format!("the counting kernel's image differs from the timed kernel's in {differing} pixels");
    if differing * COUNTING_TOLERANCE > pixels || (exact && differing > 0) {
        return Some(message);
    }
    if differing > 0 {
        warnings.push(message);
    }
    None
}
