//! Reader of MTL, the material libraries of OBJ; converts materials to Phong materials.
//!
//! | MTL | Phong |
//! |---|---|
//! | `Kd` | diffuse colour; 0.8 if it is missing |
//! | `Ka` | ambient is a tenth of the smaller of `Ka` and `Kd`: most exporters write `Ka` either as `Kd` or as white |
//! | `Ks`, `Ns` | highlight, unless `illum` is 0 or 1; the exponent is 10 if it is missing |
//! | `illum` 3 to 9 | mirror: the reflectivity is the largest component of `Ks` |
//! | `illum` 0 | constant colour: the ambient colour is `Kd`, the diffuse colour is zero |
//! | `Ke` | emission: the ambient colour is at least `Ke`, and [`crate::scene::lamps`] converts the surface to lights |
//!
//! Colours are interpreted as linear. Transparency, textures and all other properties are ignored.

use super::Fault;
use super::lines::Lines;
use crate::scene::Material;
use glam::Vec3;

/// The content of a library.
#[derive(Debug, Default)]
pub(super) struct Library {
    /// Name, material, and emission.
    pub materials: Vec<(Vec<u8>, Material, Vec3)>,
    /// True if there are textures.
    pub textures: bool,
}

/// The properties of a material in the file.
#[derive(Default)]
struct Values {
    diffuse: Option<Vec3>,
    ambient: Option<Vec3>,
    specular: Vec3,
    emission: Vec3,
    exponent: Option<f32>,
    illumination: Option<f32>,
}

impl Values {
    fn material(&self) -> Material {
        let one = |colour: Vec3| colour.min(Vec3::ONE);
        let diffuse = one(self.diffuse.unwrap_or(Vec3::splat(0.8)));
        let ambient = self.ambient.map_or(diffuse, |ambient| diffuse.min(ambient)) * 0.1;
        let model = self.illumination.unwrap_or(2.0);
        let specular = if model < 2.0 { Vec3::ZERO } else { one(self.specular) };
        let reflectivity = if (3.0..10.0).contains(&model) { specular.max_element() } else { 0.0 };
        let exponent = self.exponent.unwrap_or(10.0).clamp(0.0, 10_000.0);
        let material = if model < 1.0 {
            Material { ambient: diffuse, diffuse: Vec3::ZERO, ..Material::matt(Vec3::ZERO) }
        } else {
            Material { ambient, ..Material::matt(diffuse) }
        };
        material.shiny(specular, exponent, reflectivity)
    }
}

/// Parses a library.
pub(super) fn parse(bytes: &[u8]) -> Result<Library, Fault> {
    let mut library = Library::default();
    let mut current: Option<(Vec<u8>, Values)> = None;
    let mut lines = Lines::new(bytes);
    let close = |current: Option<(Vec<u8>, Values)>, library: &mut Library| {
        if let Some((name, values)) = current {
            library.materials.push((name, values.material(), values.emission));
        }
    };
    while let Some(keyword) = lines.keyword() {
        if keyword == b"newmtl" {
            close(current.take(), &mut library);
            current = Some((lines.rest().into_owned(), Values::default()));
        } else if let Some((_, values)) = &mut current {
            match keyword {
                b"Kd" => values.diffuse = colour(&mut lines, "Kd")?.or(values.diffuse),
                b"Ka" => values.ambient = colour(&mut lines, "Ka")?.or(values.ambient),
                b"Ks" => values.specular = colour(&mut lines, "Ks")?.unwrap_or(values.specular),
                b"Ke" => values.emission = colour(&mut lines, "Ke")?.unwrap_or(values.emission),
                b"Ns" => values.exponent = Some(lines.number("Ns")?),
                b"illum" => values.illumination = Some(lines.number("illum")?),
                other => library.textures |= other.starts_with(b"map_K"),
            }
        }
        lines.end_statement();
    }
    close(current, &mut library);
    Ok(library)
}

/// Reads a colour; `None` for a spectrum in another file or a CIE XYZ colour, which are ignored.
fn colour(lines: &mut Lines, context: &str) -> Result<Option<Vec3>, Fault> {
    let mut ahead = lines.clone();
    match ahead.word() {
        Some(b"spectral" | b"xyz") => Ok(None),
        _ => lines.colour(context).map(Some),
    }
}
