//! PNG files of a run: each scene, what differs, and half precision.

use super::input::SpheresInput;
use super::options::Algorithm;
use super::references::Shot;
use super::render::compare;
use super::render::reference;
use crate::error::{Error, Result};
use crate::harness::workload::Event;
use crate::names;
use crate::record::picture::{self, FOLDER};
use crate::workloads::size::Size;
use std::path::{Path, PathBuf};

/// Size of a scene's picture.
const SIZE: Size = Size { width: 640, height: 360 };

/// Rays along a path in a scene's picture.
const TRIPS: u32 = 5;

/// Spheres of a scene that is pictured at most: the picture is made by the plain reference.
const MOST_SPHERES: usize = 2000;

/// Bytes of a picture, RGBA.
fn bytes(image: &[[f32; 4]]) -> Vec<u8> {
    compare::rgba8(image).concat()
}

/// Where the picture of a scene is in a run's folder.
pub fn place(out: &Path, scene: &str) -> PathBuf {
    out.join(FOLDER).join(format!("{}.png", names::distinct_slug(scene)))
}

/// Writes a picture of the scene's first view.
///
/// # Errors
/// [`Error::Output`].
pub fn take(input: &SpheresInput) -> Result<()> {
    if input.spheres.len() > MOST_SPHERES {
        input
            .context
            .emit(Event::Note(format!("no picture of {}: it has more than {MOST_SPHERES} spheres", input.name)));
        return Ok(());
    }
    let shot = Shot { size: SIZE, trips: TRIPS, frame: 0, frames: 1 };
    let image = reference::render(&input.spheres, &shot.view(&input.scene), Algorithm::OnePass).image;
    write(&place(input.context.out, &input.name), SIZE, &image)
}

/// Writes a picture into a folder that may not be there yet.
///
/// # Errors
/// [`Error::Output`].
pub fn write(path: &Path, size: Size, image: &[[f32; 4]]) -> Result<()> {
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(|source| Error::output(folder, source))?;
    }
    picture::write_png(path, size.width, size.height, &bytes(image))
}

/// Writes a picture of what differs, white where it does, and returns its path inside the run's folder.
///
/// # Errors
/// [`Error::Output`].
pub fn difference(input: &SpheresInput, image: &[[f32; 4]], reference: &[[f32; 4]], shot: Shot) -> Result<String> {
    let Shot { size, frame, trips, .. } = shot;
    let name = format!("{}-{}x{}-{trips}-trips-frame{frame}-{}", input.name, size.width, size.height, blake(image));
    let file = format!("differences/{}.png", names::distinct_slug(&name));
    let differs = |(a, b): (&[f32; 4], &[f32; 4])| {
        let white = if a.map(f32::to_bits) == b.map(f32::to_bits) { 0.0 } else { 1.0 };
        [white, white, white, 1.0]
    };
    let pixels: Vec<[f32; 4]> = image.iter().zip(reference).map(differs).collect();
    write(&input.context.out.join(&file), size, &pixels)?;
    Ok(file)
}

/// A few digits that tell wrong pictures of one case apart.
fn blake(image: &[[f32; 4]]) -> String {
    blake3::hash(bytemuck::cast_slice(image)).to_hex()[..6].to_owned()
}
