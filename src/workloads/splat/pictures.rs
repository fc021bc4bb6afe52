//! PNG files of a run: each scene's light, direct, indirect and together, and its photons.

use super::Stages;
use super::input::SplatInput;
use super::run;
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

/// Of the pixels of the whole light, one in this many may be brighter than white.
const BRIGHTER: usize = 50;

/// Most distance tests of a picture.
const MAX_TESTS: u64 = 1 << 33;

fn places(out: &Path, scene: &str) -> [PathBuf; 4] {
    let name = names::distinct_slug(scene);
    ENDS.map(|end| out.join(FOLDER).join(format!("{name}{end}.png")))
}

/// True if all pictures of a scene are there, from an earlier session of the run.
pub fn are_there(out: &Path, scene: &str) -> bool {
    places(out, scene).iter().all(|path| path.is_file())
}

/// Renders the first case on the device: the middle frame of its path.
///
/// # Errors
/// [`Error::Output`], or a lost device.
pub fn take(input: &SplatInput, device: &Device) -> Result<()> {
    let (case, context) = (&input.first, input.context);
    let (lit, cameras) = (input.lit(case)?, &input.path(case)?.cameras);
    let scene = &lit.scene.scene.name;
    let Some(camera) = cameras.get(cameras.len() / 2) else { return Ok(()) };
    let size = case.size.with_longer_side(SIDE);
    let tests = case.setting.slots().saturating_mul(size.pixels() as u64);
    if tests > MAX_TESTS {
        context.emit(Event::Note(format!("no pictures of {scene}: {tests} distance tests are needed for one")));
        return Ok(());
    }
    let stages = match run::once(input, device, case, size, camera) {
        Ok(stages) => stages,
        Err(error @ (Error::Device(_) | Error::Refused(_) | Error::Input(_))) => {
            context.emit(Event::Note(format!("no pictures of {scene}: {error}")));
            return Ok(());
        }
        Err(other) => return Err(other),
    };
    let folder = context.out.join(FOLDER);
    std::fs::create_dir_all(&folder).map_err(|source| Error::output(&folder, source))?;
    let white = white(&stages.picture);
    let indirect: Vec<Vec4> = stages.picture.iter().zip(&stages.direct).map(|(all, direct)| *all - *direct).collect();
    let pictures = [
        encoded(&stages.picture, white),
        encoded(&stages.direct, white),
        encoded(&indirect, white),
        photons(&stages, camera, size, white),
    ];
    for (path, pixels) in places(context.out, scene).iter().zip(pictures) {
        picture::write_png(path, size.width, size.height, &pixels)?;
    }
    Ok(())
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
