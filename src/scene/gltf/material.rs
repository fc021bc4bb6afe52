//! Metallic-roughness materials as Phong materials.
//!
//! | glTF | Phong |
//! |---|---|
//! | base colour c, metallic m | diffuse `c (1 - m)`, specular `F = 0.04 (1 - m) + c m`, ambient a tenth of c |
//! | roughness r | exponent `2 / r^4 - 2`, 1 to 10,000 (the Blinn lobe as wide as a microfacet lobe of `alpha = r^2`) |
//! | both | reflectivity `F (1 - r)^2`, largest component, if m >= 0.5 and r <= 0.3; otherwise 0 |
//! | emissive factor | ambient at least as bright; without other lights, [`crate::scene::lamps`] converts it to lights
//! |

use crate::scene::Material;
use glam::Vec3;

/// The Phong material and the emission of a material.
pub fn convert(material: &gltf::Material) -> (Material, Vec3) {
    let pbr = material.pbr_metallic_roughness();
    let [r, g, b, _] = pbr.base_color_factor();
    let one = |v: Vec3| if v.is_finite() { v.clamp(Vec3::ZERO, Vec3::ONE) } else { Vec3::ZERO };
    let unit = |x: f32| if x.is_finite() { x.clamp(0.0, 1.0) } else { 1.0 };
    let (colour, metallic, roughness) =
        (one(Vec3::new(r, g, b)), unit(pbr.metallic_factor()), unit(pbr.roughness_factor()));
    let emission = one(Vec3::from(material.emissive_factor()));
    let specular = Vec3::splat(0.04 * (1.0 - metallic)) + colour * metallic;
    let exponent = (2.0 / roughness.powi(4).max(1e-6) - 2.0).clamp(1.0, 10_000.0);
    let mirror = metallic >= 0.5 && roughness <= 0.3;
    let reflectivity = if mirror { specular.max_element() * (1.0 - roughness).powi(2) } else { 0.0 };
    let matt = Material { ambient: (colour * 0.1).max(emission), ..Material::matt(colour * (1.0 - metallic)) };
    (matt.shiny(specular, exponent, reflectivity), emission)
}

/// True if the material is transparent. The alpha mode alone does not decide, because exporters also write it for
/// opaque materials.
pub fn is_transparent(material: &gltf::Material) -> bool {
    let pbr = material.pbr_metallic_roughness();
    let [.., alpha] = pbr.base_color_factor();
    let through = alpha < 1.0 || pbr.base_color_texture().is_some();
    through && material.alpha_mode() != gltf::material::AlphaMode::Opaque
}

/// True if the material's colour depends on a texture.
pub fn has_texture(material: &gltf::Material) -> bool {
    let pbr = material.pbr_metallic_roughness();
    pbr.base_color_texture().is_some() || pbr.metallic_roughness_texture().is_some()
}
