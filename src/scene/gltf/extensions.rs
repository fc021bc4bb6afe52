//! What the extensions that a file names mean for this reader.

use super::json::{Json, Loose};
use super::schema::{Root, Text};
use super::shown;
use crate::scene::text::Fault;

/// Extensions that are read.
const READ: [&str; 3] = ["KHR_lights_punctual", "KHR_mesh_quantization", "EXT_mesh_gpu_instancing"];

/// Beginnings of the names of extensions that touch no geometry. They are ignored, even if the file requires them.
const FAMILIES: [&str; 7] =
    ["KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_", "KHR_animation_", "KHR_xmp", "MSFT_texture_"];

/// Further extensions that touch no geometry. They are ignored, but a file that requires one is refused.
const HARMLESS: [&str; 13] = [
    "EXT_lights_ies",
    "EXT_lights_image_based",
    "EXT_feature_metadata",
    "EXT_instance_features",
    "EXT_mesh_features",
    "EXT_structural_metadata",
    "KHR_audio_emitter",
    "KHR_interactivity",
    "KHR_node_hoverability",
    "KHR_node_selectability",
    "KHR_techniques_webgl",
    "MSFT_packing_normalRoughnessMetallic",
    "MSFT_packing_occlusionRoughnessMetallic",
];

/// Compressed geometry with a fallback, which is read, unless the file requires the extension.
const WITH_FALLBACK: [&str; 3] = ["KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"];

/// What to do about compressed geometry.
pub const UNPACK: &str = "remove it with gltf-transform (gltf-transform.dev), or export the file without it";

fn of_family(name: &str) -> bool {
    FAMILIES.iter().any(|family| name.starts_with(family))
}

/// Returns the warnings about extensions that are not read.
///
/// # Errors
/// The file requires an extension that is not read and may touch geometry.
pub fn check<'a>(json: Json<'a>, root: &Root<'a>) -> Result<Vec<String>, Fault> {
    let mut warnings = Vec::new();
    let mut required = Vec::new();
    let listed = json.list("extensionsRequired", "extension", root.extensions_required)?;
    for index in 0..listed.len() {
        let Loose::Given(Text(name)) = listed.get(index, "")? else { continue };
        if of_family(&name) || READ.contains(&&*name) {
            if !READ.contains(&&*name) && !required.contains(&name) && required.len() < MOST {
                warnings.push(format!(
                    "the file requires the extension {}, which does not concern the geometry: ignored",
                    shown(&name, 80)
                ));
                required.push(name);
            }
            continue;
        }
        let problem = format!("the file requires the extension {}, which is not supported", shown(&name, 80));
        return Err(Fault::new(None, problem, UNPACK));
    }
    let mut unknown = Vec::new();
    let listed = match json.list("extensionsUsed", "extension", root.extensions_used) {
        Ok(listed) => listed,
        Err(fault) => {
            warnings.push(format!("{}: ignored", fault.problem));
            return Ok(warnings);
        }
    };
    for index in 0..listed.len() {
        let Loose::Given(Text(name)) = listed.get(index, "")? else { continue };
        let known = [&READ[..], &HARMLESS, &WITH_FALLBACK].iter().any(|list| list.contains(&&*name));
        if !known && !of_family(&name) && !unknown.contains(&name) && unknown.len() < MOST {
            warnings.push(format!(
                "the file uses the extension {}, which is not read: the geometry may differ",
                shown(&name, 80)
            ));
            unknown.push(name);
        }
    }
    Ok(warnings)
}

/// The largest number of warnings of one kind.
const MOST: usize = 16;
