//! Checks of version and required extensions before the crate `gltf` reads a file: its errors for other versions and
//! for compressed meshes do not name these reasons.

use super::Problem;
use serde::Deserialize;

/// The largest supported minor version of glTF 2.
const MINOR: u32 = 0;

#[derive(Deserialize)]
struct Head {
    asset: Asset,
    #[serde(default, rename = "extensionsRequired")]
    required: Vec<String>,
}

#[derive(Deserialize)]
struct Asset {
    version: String,
    #[serde(rename = "minVersion")]
    least: Option<String>,
}

/// Refuses a GLB that is truncated or has another version. The crate (1.4.1) subtracts the header's twelve bytes from
/// the length in the header, which overflows if the length is smaller.
pub fn check_container(bytes: &[u8]) -> Result<(), Problem> {
    let Some(rest) = bytes.strip_prefix(b"glTF") else { return Ok(()) };
    let word = |at: usize| rest.get(at..at + 4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    match (word(0), word(4)) {
        (Some(version), Some(_)) if version != 2 => {
            Err((format!("this is a GLB of version {version}, only 2 is supported"), "export it as glTF 2.0"))
        }
        (_, Some(length)) if length < 12 => {
            Err((format!("this is not a GLB: its header gives the length {length}"), "export it again"))
        }
        (_, Some(length)) if length as usize > bytes.len() => {
            let problem = format!("the file is truncated: it has {} bytes of {length}", bytes.len());
            Err((problem, "copy the whole file"))
        }
        (_, None) => Err(("the file is truncated within its header".into(), "copy the whole file")),
        _ => Ok(()),
    }
}

/// Refuses versions other than 2.0, and required extensions that are not supported. JSON that is not glTF is left to
/// the crate's checks.
pub fn check(json: &[u8]) -> Result<(), Problem> {
    let Ok(head) = Head::deserialize(&mut serde_json::Deserializer::from_slice(json)) else { return Ok(()) };
    let Asset { version, least } = &head.asset;
    let minor = |text: &str| {
        let (major, minor) = text.split_once('.')?;
        let digits = [major, minor].iter().all(|part| !part.is_empty() && part.bytes().all(|b| b.is_ascii_digit()));
        (digits && major == "2").then(|| minor.parse().unwrap_or(u32::MAX))
    };
    let shown = |text: &str| text.chars().filter(|c| !c.is_control()).take(20).collect::<String>();
    const HINT: &str = "export it as glTF 2.0";
    if minor(version).is_none() {
        return Err((format!("this is glTF of version {}, only 2.0 is supported", shown(version)), HINT));
    }
    if let Some(least) = least.as_ref().filter(|least| minor(least).is_none_or(|minor| minor > MINOR)) {
        return Err((format!("the file needs a reader of glTF {}, only 2.0 is supported", shown(least)), HINT));
    }
    let read = gltf::json::extensions::ENABLED_EXTENSIONS;
    match head.required.iter().find(|name| !read.contains(&name.as_str())) {
        Some(name) => {
            let name: String = name.chars().filter(|c| !c.is_control()).take(80).collect();
            let hint = "remove it with gltf-transform (gltf-transform.dev), or export the file without it";
            Err((format!("the file requires the extension {name}, which is not supported"), hint))
        }
        None => Ok(()),
    }
}
