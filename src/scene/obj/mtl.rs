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
    /// Reads a property; unknown ones are ignored.
    ///
    /// # Errors
    /// The property has no numbers, or they are not finite.
    fn read(&mut self, keyword: &[u8], lines: &mut Lines) -> Result<(), Fault> {
        match keyword {
            b"Kd" => self.diffuse = colour(lines, "Kd")?.or(self.diffuse),
            b"Ka" => self.ambient = colour(lines, "Ka")?.or(self.ambient),
            b"Ks" => self.specular = colour(lines, "Ks")?.unwrap_or(self.specular),
            b"Ke" => self.emission = colour(lines, "Ke")?.unwrap_or(self.emission),
            b"Ns" => self.exponent = Some(lines.number("Ns")?),
            b"illum" => self.illumination = Some(lines.number("illum")?),
            _ => {}
        }
        Ok(())
    }

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

/// Parses a library. A line with an error leaves its property unchanged; `warn` is called with the error.
pub(super) fn parse(bytes: &[u8], mut warn: impl FnMut(Fault)) -> Library {
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
            if keyword.starts_with(b"map_K") {
                library.textures = true;
            } else if let Err(fault) = values.read(keyword, &mut lines) {
                warn(fault);
            }
        }
        lines.end_statement();
    }
    close(current, &mut library);
    library
}

/// Reads a colour; `None` for a spectrum in another file or a CIE XYZ colour, which are ignored.
fn colour(lines: &mut Lines, context: &str) -> Result<Option<Vec3>, Fault> {
    let mut ahead = lines.clone();
    match ahead.word() {
        Some(b"spectral" | b"xyz") => Ok(None),
        _ => lines.colour(context).map(Some),
    }
}
