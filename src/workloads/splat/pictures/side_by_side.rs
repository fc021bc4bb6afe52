//! Indirect light of techniques and of the path-traced reference, side by side.

use super::{encoded, white};
use crate::camera::Camera;
use crate::device::Device;
use crate::error::{Error, Result};
use crate::harness::workload::Event;
use crate::record::picture;
use crate::workloads::size::Size;
use crate::workloads::splat::case::SplatCase;
use crate::workloads::splat::input::{REFERENCE_TREE, SplatInput};
use crate::workloads::splat::reference::path_traced::{self, Effort, View};
use crate::workloads::splat::{Stages, mix, run};
use crate::workloads::trace::Selection;
use crate::workloads::trace::backend::Backend;
use glam::Vec4;
use std::path::Path;

/// Paths of each pixel of the reference: enough to see what is bias.
const PATHS: u32 = 64;

/// The longer side of each part at most, in pixels: with fewer, clusters would have another size than the rows'.
const SIDE: u32 = 480;

/// Black pixels between parts.
const GAP: usize = 4;

/// Writes the indirect light of these cases and of the reference, from left to right.
///
/// # Errors
/// [`Error::Output`], or a lost device.
pub fn write(path: &Path, input: &SplatInput, device: &Device, cases: &[&SplatCase], camera: &Camera) -> Result<()> {
    let Some(first) = cases.first() else { return Ok(()) };
    let size = first.size.with_longer_side(SIDE.min(first.size.longer_side()));
    let mut parts = Vec::new();
    let mut last: Option<Stages> = None;
    for case in cases {
        let stages = match run::once(input, device, case, size, camera) {
            Ok(stages) => stages,
            Err(error @ (Error::Device(_) | Error::Refused(_) | Error::Input(_))) => {
                let technique = case.technique;
                input.context.emit(Event::Note(format!("{technique} is not in the pictures side by side: {error}")));
                continue;
            }
            Err(other) => return Err(other),
        };
        parts.push(indirect(&stages, &stages.irradiance));
        last = Some(stages);
    }
    let Some(stages) = last else { return Ok(()) };
    parts.push(indirect(&stages, &reference(input, first, size, camera)?));
    // One white for all: what is too bright or too dark shows
    let white = parts.last().map_or(1.0, |reference| white(reference));
    let pictures: Vec<Vec<u8>> = parts.iter().map(|part| encoded(part, white)).collect();
    let (width, rgba) = joined(&pictures, size);
    picture::write_png(path, width, size.height, &rgba)
}

/// Radiance by irradiance, without direct light.
fn indirect(stages: &Stages, irradiance: &[Vec4]) -> Vec<Vec4> {
    mix::picture(&stages.samples, &vec![Vec4::ZERO; irradiance.len()], irradiance)
}

/// Irradiance of every pixel by path tracing.
fn reference(input: &SplatInput, case: &SplatCase, size: Size, camera: &Camera) -> Result<Vec<Vec4>> {
    let lit = input.lit(case)?;
    let method = Selection::parse(REFERENCE_TREE)?.method();
    let mut caster = Backend::prepare(&input.cpu, &lit.scene.scene, &*input.reference.structure, method)?;
    let pixels: Vec<u32> = (0..size.pixels() as u32).collect();
    let view = View { lit: &lit.scene, camera: *camera, size, pixels: &pixels, hits: case.setting.hits };
    let effort = Effort { least: PATHS, most: PATHS, ..Effort::default() };
    let traced = path_traced::trace(input.cpu.pool(), &mut *caster, &view, effort, input.context.interrupted)?;
    Ok(traced.irradiance.iter().map(|irradiance| irradiance.as_vec3().extend(0.0)).collect())
}

/// Pictures in a row, with their width in pixels.
fn joined(pictures: &[Vec<u8>], size: Size) -> (u32, Vec<u8>) {
    let row = size.width as usize * 4;
    let mut rgba = Vec::new();
    for y in 0..size.height as usize {
        for (index, picture) in pictures.iter().enumerate() {
            if index > 0 {
                rgba.extend([0, 0, 0, 255].repeat(GAP));
            }
            rgba.extend_from_slice(&picture[y * row..(y + 1) * row]);
        }
    }
    let gaps = pictures.len().saturating_sub(1) * GAP;
    ((pictures.len() * size.width as usize + gaps) as u32, rgba)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_joined_row_by_row() {
        let size = Size { width: 2, height: 2 };
        let picture = |value: u8| vec![value; 16];
        let (width, rgba) = joined(&[picture(1), picture(2)], size);
        assert_eq!(width, 8);
        assert_eq!(rgba.len(), 8 * 2 * 4);
        assert_eq!(rgba[..8], [1; 8]);
        assert_eq!(rgba[8..12], [0, 0, 0, 255]);
        assert_eq!(rgba[24..32], [2; 8]);
    }
}
