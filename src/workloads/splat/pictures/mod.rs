//! PNG files of a run: each scene's light, direct, indirect and together, its photons and its clusters, and the
//! indirect light of each technique next to a path-traced reference.

mod clusters;
mod side_by_side;

use super::Stages;
use super::case::SplatCase;
use super::gathered::Scenery;
use super::input::SplatInput;
use super::run;
use super::setting::Energy;
use super::splatting::setting::Gather;
use crate::camera::Camera;
use crate::device::Device;
use crate::error::{Error, Result};
use crate::harness::workload::Event;
use crate::names;
use crate::record::picture::{self, FOLDER};
use crate::workloads::size::Size;
use glam::{Vec3, Vec4};
use std::path::{Path, PathBuf};

/// The longer side of a picture, in pixels.
const SIDE: u32 = 640;

/// Ends of the files' names: all light, and its parts.
const ENDS: [&str; 4] = ["", "-direct", "-indirect", "-photons"];

/// Ends of the names of what clusters are seen by: clusters and levels in false colours, and photons of a cluster.
const CLUSTERS: [&str; 3] = ["-clusters", "-levels", "-photons-per-cluster"];

/// End of the name of the techniques' pictures.
const SIDE_BY_SIDE: &str = "-side-by-side";

/// Of the pixels of the whole light, one in this many may be brighter than white.
const BRIGHTER: usize = 50;

/// Most distance tests of a picture.
const MAX_TESTS: u64 = 1 << 33;

fn place(out: &Path, scene: &str, end: &str) -> PathBuf {
    out.join(FOLDER).join(format!("{}{end}.png", names::distinct_slug(scene)))
}

/// True if all pictures of a scene are there, from an earlier session of the run.
pub fn are_there(out: &Path, scene: &str, cases: &[SplatCase]) -> bool {
    let is_there = |end: &str| place(out, scene, end).is_file();
    let has_clusters = cases.iter().any(|case| case.technique.gather.has_clusters());
    let mut with_clusters = CLUSTERS.iter().chain([&SIDE_BY_SIDE]);
    ENDS.iter().all(|end| is_there(end)) && (!has_clusters || with_clusters.all(|end| is_there(end)))
}

/// Renders the middle frame of the path: the first case on the device, the first one with clusters, and the first one
/// of each technique.
///
/// # Errors
/// [`Error::Output`], or a lost device.
pub fn take(input: &SplatInput, device: &Device) -> Result<()> {
    let (Some(first), context) = (input.pictured.first(), input.context) else { return Ok(()) };
    let folder = context.out.join(FOLDER);
    std::fs::create_dir_all(&folder).map_err(|source| Error::output(&folder, source))?;
    let scene = &input.lit(first)?.scene.scene.name;
    let light = |stages: &Stages, camera: &Camera, size: Size| {
        let white = white(&stages.picture);
        let indirect: Vec<Vec4> =
            stages.picture.iter().zip(&stages.direct).map(|(all, direct)| *all - *direct).collect();
        let pictures = [
            encoded(&stages.picture, white),
            encoded(&stages.direct, white),
            encoded(&indirect, white),
            photons(stages, camera, size, white),
        ];
        ENDS.iter().zip(pictures).try_for_each(|(end, pixels)| {
            picture::write_png(&place(context.out, scene, end), size.width, size.height, &pixels)
        })
    };
    // Tiles keep the sides that the row measures, and keys their bits
    let side = match first.technique.gather {
        Gather::Reference => SIDE,
        _ => SIDE.min(first.size.longer_side()),
    };
    of(input, device, first, side, light)?;
    if let Some(case) = input.pictured.iter().find(|case| case.technique.gather.has_clusters()) {
        // In the row's own size, as far as it goes: tiles have the sides that it measures
        let side = SIDE.min(case.size.longer_side());
        of(input, device, case, side, |stages, camera, size| clustered(input, case, stages, camera, size))?;
    }
    let mut techniques: Vec<&SplatCase> = Vec::new();
    let is_splatted = |case: &&SplatCase| case.setting.energy == Energy::Flux && case.technique.gather.has_clusters();
    for case in input.pictured.iter().filter(is_splatted) {
        let is_like = |known: &&SplatCase| {
            let way = |case: &SplatCase| case.clustering.map(|clustering| clustering.setting);
            (known.radius, known.setting, known.size) == (case.radius, case.setting, case.size)
                && (&known.light, way(known)) == (&case.light, way(case))
        };
        let is_new = !techniques.iter().any(|known| known.technique == case.technique);
        if is_new && techniques.first().is_none_or(is_like) {
            techniques.push(case);
        }
    }
    techniques.truncate(MAX_TECHNIQUES);
    let cameras = &input.path(first)?.cameras;
    match cameras.get(cameras.len() / 2) {
        Some(camera) if !techniques.is_empty() => {
            side_by_side::write(&place(context.out, scene, SIDE_BY_SIDE), input, device, &techniques, camera)
        }
        _ => Ok(()),
    }
}

/// Techniques that are put side by side at most.
const MAX_TECHNIQUES: usize = 4;

/// Renders the middle frame of a case's path, so many pixels long, and hands it over; a note says why there is none.
fn of(
    input: &SplatInput,
    device: &Device,
    case: &SplatCase,
    side: u32,
    write: impl FnOnce(&Stages, &Camera, Size) -> Result<()>,
) -> Result<()> {
    let (scene, cameras) = (&input.lit(case)?.scene.scene.name, &input.path(case)?.cameras);
    let Some(camera) = cameras.get(cameras.len() / 2) else { return Ok(()) };
    let size = case.size.with_longer_side(side);
    let tests = case.setting.slots().saturating_mul(size.pixels() as u64);
    if !case.technique.gather.has_clusters() && tests > MAX_TESTS {
        input.context.emit(Event::Note(format!("no pictures of {scene}: {tests} distance tests are needed for one")));
        return Ok(());
    }
    match run::once(input, device, case, size, camera) {
        Ok(stages) => write(&stages, camera, size),
        Err(error @ (Error::Device(_) | Error::Refused(_) | Error::Input(_))) => {
            input.context.emit(Event::Note(format!("no pictures of {scene}: {error}")));
            Ok(())
        }
        Err(other) => Err(other),
    }
}

/// Pictures of what a frame's samples are put into.
fn clustered(input: &SplatInput, case: &SplatCase, stages: &Stages, camera: &Camera, size: Size) -> Result<()> {
    let gathering = input.gathering(case, size)?;
    let (Some(own), Some(layout)) = (&stages.gathered.clusters, &gathering.layout) else { return Ok(()) };
    let lit = input.lit(case)?;
    let view = Scenery { lit: &lit.scene, camera, size, samples: &stages.samples, photons: &stages.photons };
    let pictures = [
        clusters::clusters(own, size),
        clusters::levels(own, layout, size),
        clusters::photons(input.cpu.pool(), &gathering, &view, own)?,
    ];
    let scene = &lit.scene.scene.name;
    CLUSTERS.iter().zip(pictures).try_for_each(|(end, pixels)| {
        picture::write_png(&place(input.context.out, scene, end), size.width, size.height, &pixels)
    })
}

/// The radiance that is shown as white: all but one pixel in [`BRIGHTER`] are darker.
fn white(image: &[Vec4]) -> f32 {
    let mut values: Vec<f32> = image.iter().map(|v| v.truncate().max_element()).filter(|v| *v > 0.0).collect();
    values.sort_by(f32::total_cmp);
    values.get(values.len().saturating_sub(1 + values.len() / BRIGHTER)).copied().unwrap_or(1.0)
}

/// Linear radiance as sRGB, RGBA8.
fn encoded(image: &[Vec4], white: f32) -> Vec<u8> {
    image.iter().flat_map(|radiance| rgba(radiance.truncate() / white)).collect()
}

fn rgba(linear: Vec3) -> [u8; 4] {
    let [r, g, b] = linear.to_array().map(picture::to_srgb);
    [r, g, b, 255]
}

/// Photons as dots over the darkened view: those that no nearer surface hides, in the colour of their flux.
fn photons(stages: &Stages, camera: &Camera, size: Size, white: f32) -> Vec<u8> {
    let mut image: Vec<Vec3> = stages.picture.iter().map(|v| v.truncate() / white * 0.15).collect();
    let grid = camera.pixel_grid(size.width, size.height);
    for (position, flux) in stages.photons.positions.iter().zip(&stages.photons.fluxes) {
        let to = position.truncate() - grid.origin;
        let depth = to.dot(camera.direction);
        if depth <= 0.0 {
            continue;
        }
        let on_plane = to / depth - grid.corner;
        let [x, y] = [grid.right, grid.down].map(|axis| on_plane.dot(axis) / axis.length_squared());
        if !(x >= 0.0 && y >= 0.0 && x < size.width as f32 && y < size.height as f32) {
            continue;
        }
        let pixel = y as usize * size.width as usize + x as usize;
        // Surfaces are oblique: a photon a little behind the pixel's depth lies on the same one
        let seen = stages.samples.positions[pixel].w;
        if seen > 0.0 && depth <= seen * 1.02 {
            let colour = flux.truncate();
            image[pixel] = colour / colour.max_element().max(f32::MIN_POSITIVE);
        }
    }
    image.into_iter().flat_map(rgba).collect()
}
