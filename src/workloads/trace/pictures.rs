//! What a scene looks like and where its rays take long: two small pictures per scene in the run's folder, for readers
//! of the numbers. Nothing here is measured.

use super::backend::{Counters, Prepared, Size};
use super::case::TraceCase;
use super::input::TraceInput;
use super::rays::Config;
use super::{Selection, tracer};
use crate::camera::View;
use crate::device::Device;
use crate::error::{Error, Result};
use crate::harness::workload::Event;
use crate::names;
use crate::record::picture::{self, FOLDER, STEPS};
use std::path::{Path, PathBuf};

/// The longer side of a picture, in pixels.
const SIDE: u32 = 448;

/// How the pictured rays go: one ray per thread, on the tree that the references are traced through.
const STRUCTURE: &str = "bvh-stack";

/// Renders both pictures on the measured device: the middle frame of the path with most ray types, or the first one if
/// the camera does not move. A device that cannot make them is mentioned; the run goes on.
///
/// # Errors
/// [`Error::Output`], or a lost device.
pub(super) fn take(input: &TraceInput, device: &Device) -> Result<()> {
    let Some(path) = input.paths.iter().max_by_key(|path| config_rank(path.config)) else { return Ok(()) };
    let (context, scene) = (input.context, &input.record.name);
    context.emit(Event::Doing(format!("picturing {scene}")));
    // In a light orbit the middle frame is lit from behind: the first one is better
    let middle = &path.views[path.views.len() / 2];
    let moving = middle.camera.position != path.views[0].camera.position;
    let view = if moving { middle } else { &path.views[0] };
    let size = TraceCase::parse(&input.first)?.size.with_longer_side(SIDE);
    let Size { width, height } = size;
    let render = || -> Result<(Vec<u8>, Vec<u8>)> {
        let method = Selection::parse(STRUCTURE)?.method();
        let mut tracer = tracer::prepare(device, &input.scene, &*input.reference.structure, method)?;
        let image = image(&mut *tracer, path.config, view, size)?;
        let steps = per_pixel(&mut *tracer, path.config, view, size, &|counters| counters.steps())?;
        Ok((image, picture::heat_map(&steps, picture::percentile_99_5(&steps))))
    };
    let (image, steps) = match render() {
        Ok(pictures) => pictures,
        Err(error @ (Error::Device(_) | Error::Refused(_))) => {
            context.emit(Event::Note(format!("no pictures of {scene}: {error}")));
            return Ok(());
        }
        Err(other) => return Err(other),
    };
    let folder = context.out.join(FOLDER);
    std::fs::create_dir_all(&folder).map_err(|source| Error::output(&folder, source))?;
    let [image_file, steps_file] = places(context.out, scene);
    picture::write_png(&image_file, width, height, &image)?;
    picture::write_png(&steps_file, width, height, &steps)
}

/// Paths of a scene's pictures in a run's folder: the image, and the heat map of its steps.
fn places(out: &Path, scene: &str) -> [PathBuf; 2] {
    let name = names::distinct_slug(scene);
    ["", STEPS].map(|end| out.join(FOLDER).join(format!("{name}{end}.png")))
}

/// True if both pictures of a scene are there, from an earlier session of the run.
pub fn are_there(out: &Path, scene: &str) -> bool {
    places(out, scene).iter().all(|path| path.is_file())
}

/// One frame by the timed kernel, RGBA8.
///
/// # Errors
/// The device's.
pub fn image(prepared: &mut dyn Prepared, config: Config, view: &View, size: Size) -> Result<Vec<u8>> {
    Ok(prepared.image(config, view, size)?.iter().flat_map(|pixel| pixel.rgba.to_le_bytes()).collect())
}

/// What each pixel's rays cost, all ray types together, by the counting kernel.
///
/// # Errors
/// The device's.
pub fn per_pixel(
    prepared: &mut dyn Prepared,
    config: Config,
    view: &View,
    size: Size,
    cost: &dyn Fn(&Counters) -> u32,
) -> Result<Vec<u32>> {
    let mut values = Vec::with_capacity(size.pixels());
    prepared.counted(config, view, size, &mut |_, pixels| {
        values.extend(pixels.iter().map(|p| p.counters.iter().map(cost).sum::<u32>()));
    })?;
    Ok(values)
}

/// The more kinds of rays, the richer.
fn config_rank(config: Config) -> (u32, bool) {
    (config.bounces(), config.shadows())
}
