//! Metallic-roughness materials as Phong materials.
//!
//! | glTF | Phong |
//! |---|---|
//! | base colour c, metallic m | diffuse `c (1 - m)`, specular `F = 0.04 (1 - m) + c m`, ambient a tenth of c |
//! | roughness r | exponent `2 / r^4 - 2`, 1 to 10,000 (the Blinn lobe as wide as a microfacet lobe of `alpha = r^2`) |
//! | both | reflectivity `F (1 - r)^2`, largest component, if m >= 0.5 and r <= 0.3; otherwise 0 |
//! | emissive factor | ambient at least as bright; without other lights, [`crate::scene::lamps`] converts it to lights
//! |

use super::json::{Loose, Present};
use super::schema::Text;
use crate::scene::Material;
use glam::Vec3;
use serde::Deserialize;

/// A material of the JSON.
#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct GltfMaterial<'a> {
    pbr_metallic_roughness: Option<Surface>,
    emissive_factor: Option<[f32; 3]>,
    #[serde(default, borrow)]
    alpha_mode: Loose<Text<'a>>,
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "camelCase")]
struct Surface {
    base_color_factor: Option<[f32; 4]>,
    metallic_factor: Option<f32>,
    roughness_factor: Option<f32>,
    #[serde(default)]
    base_color_texture: Present,
    #[serde(default)]
    metallic_roughness_texture: Present,
}

impl GltfMaterial<'_> {
    /// The Phong material and the emission.
    pub fn convert(&self) -> (Material, Vec3) {
        let neutral = Surface::default();
        let pbr = self.pbr_metallic_roughness.as_ref().unwrap_or(&neutral);
        let [r, g, b, _] = pbr.base_color_factor.unwrap_or([1.0; 4]);
        let one = |v: Vec3| if v.is_finite() { v.clamp(Vec3::ZERO, Vec3::ONE) } else { Vec3::ZERO };
        let unit = |x: Option<f32>| x.filter(|x| x.is_finite()).map_or(1.0, |x| x.clamp(0.0, 1.0));
        let (colour, metallic, roughness) =
            (one(Vec3::new(r, g, b)), unit(pbr.metallic_factor), unit(pbr.roughness_factor));
        let emission = one(Vec3::from(self.emissive_factor.unwrap_or_default()));
        let specular = Vec3::splat(0.04 * (1.0 - metallic)) + colour * metallic;
        let exponent = (2.0 / roughness.powi(4).max(1e-6) - 2.0).clamp(1.0, 10_000.0);
        let mirror = metallic >= 0.5 && roughness <= 0.3;
        let reflectivity = if mirror { specular.max_element() * (1.0 - roughness).powi(2) } else { 0.0 };
        let matt = Material { ambient: (colour * 0.1).max(emission), ..Material::matt(colour * (1.0 - metallic)) };
        (matt.shiny(specular, exponent, reflectivity), emission)
    }

    /// True if the material is transparent. The alpha mode alone does not decide, because exporters also write it for
    /// opaque materials.
    pub fn is_transparent(&self) -> bool {
        let through = self.pbr_metallic_roughness.as_ref().is_some_and(|pbr| {
            pbr.base_color_texture.0 || pbr.base_color_factor.is_some_and(|[.., alpha]| alpha < 1.0)
        });
        let opaque = match &self.alpha_mode {
            Loose::Given(Text(mode)) => !matches!(&**mode, "MASK" | "BLEND"),
            Loose::Absent | Loose::Malformed => true,
        };
        through && !opaque
    }

    /// True if the material's colour depends on a texture.
    pub fn has_texture(&self) -> bool {
        let textures = |pbr: &Surface| pbr.base_color_texture.0 || pbr.metallic_roughness_texture.0;
        self.pbr_metallic_roughness.as_ref().is_some_and(textures)
    }
}
