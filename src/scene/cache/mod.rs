//! `.rtb`: a scene as loaded, in one binary file that is read in one go.
//!
//! A header of fixed size, then vertices, triangles, materials, lights and the camera's poses as they lie in memory, then
//! the texts as JSON. All numbers are little-endian. A checksum (XXH3, 128 bits) covers all of it: against damage, not
//! against forgers, who could hash as well, so that what was read is checked like any other file's content.
//!
//! A cache is refused, never repaired. It is *foreign* without the magic bytes, *truncated* or *corrupt* where lengths or
//! the checksum do not fit, and **stale** where loading the source again might give another scene:
//! - the layout has another version ([`FORMAT`]);
//! - it was written by a program with other readers: `build/main.rs` hashes their source, so nobody has to remember to raise a
//!   number;
//! - one of the files that it was made from, includes and libraries among them, is no longer what it was (`stale.rs`). They
//!   are looked for where they lay as seen from the cache; if none of them is there, the cache stands for itself.

mod layout;
mod pages;
mod parts;
mod stale;

use super::extent::Extent;
use super::sources::{self, Kind, Source};
use super::{Light, Material, Options, Placement, Pose, Scene, SceneCamera, Triangle, load_in};
use crate::error::{Error, Result};
use crate::math::Vertex;
use bytemuck::Zeroable;
use glam::{DVec3, Vec3};
pub use layout::FORMAT;
use layout::{Header, MAGIC, RawPose, pose, raw_pose, readers};
use parts::{Checksum, Parts};
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::io::{ErrorKind, Read, Write};
use std::path::Path;

/// The extension of caches.
pub const EXTENSION: &str = "rtb";

/// The texts of a scene.
#[derive(Serialize, Deserialize)]
struct Texts {
    name: String,
    camera_path: Option<String>,
    warnings: Vec<String>,
    /// What the scene was made from.
    sources: Vec<stale::Stored>,
}

/// What a scene was made from; nothing for a built-in scene.
#[derive(Clone, Debug, Default)]
pub struct Sources(Vec<Source>);

impl Sources {
    /// The files, and names where none was found.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        self.0.iter().map(|source| source.path.as_path())
    }
}

/// Loads a scene as [`load_in`] does, and notes what it is made from.
///
/// # Errors
/// Those of [`load_in`].
pub fn load(what: &str, folder: Option<&Path>) -> Result<(Scene, Sources)> {
    let (scene, sources) = sources::record(true, || load_in(what, folder));
    Ok((scene?, Sources(sources)))
}

/// Writes a scene and what it came from. The file is there as a whole or not at all.
///
/// # Errors
/// [`Error::Output`] if the cache cannot be written.
pub fn write(scene: &Scene, sources: &Sources, path: &Path) -> Result<()> {
    let texts = Texts {
        name: scene.name.clone(),
        camera_path: scene.camera_path.clone(),
        warnings: scene.warnings.clone(),
        sources: stale::store(&sources.0, path),
    };
    let text = serde_json::to_vec(&texts).map_err(|e| Error::output(path, e.into()))?;
    let poses: Vec<RawPose> = scene.camera.iter().flat_map(|camera| &camera.frames).map(raw_pose).collect();
    let mut header = Header {
        magic: MAGIC,
        format: FORMAT,
        field_of_view: scene.camera.as_ref().map_or(0.0, |camera| camera.field_of_view),
        readers: readers(),
        checksum: [0; 16],
        content: [0; 16],
        vertices: scene.vertices.len() as u64,
        triangles: scene.triangles.len() as u64,
        materials: scene.materials.len() as u64,
        lights: scene.lights.len() as u64,
        poses: poses.len() as u64,
        text: text.len() as u64,
        background: scene.background.to_array(),
        exponent: scene.placement.exponent,
        offset: scene.placement.offset.to_array(),
        degenerate: scene.degenerate_triangles as u64,
    };
    let parts: [&[u8]; 6] = [
        bytemuck::cast_slice(&scene.vertices),
        bytemuck::cast_slice(&scene.triangles),
        bytemuck::cast_slice(&scene.materials),
        bytemuck::cast_slice(&scene.lights),
        bytemuck::cast_slice(&poses),
        &text,
    ];
    let mut checksum = Checksum::default();
    for (i, ((_, size), part)) in header.parts().into_iter().zip(parts).enumerate() {
        if i == TEXTS {
            header.content = content(&checksum, &header, &scene.name);
        }
        checksum.add(part, size);
    }
    header.checksum = checksum.with(bytemuck::bytes_of(&header));

    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}.part", std::process::id()));
    let part = path.with_file_name(name);
    let written = (|| {
        let mut file = File::create(&part)?;
        file.write_all(bytemuck::bytes_of(&header))?;
        parts.iter().try_for_each(|bytes| file.write_all(bytes))?;
        file.sync_all()?;
        std::fs::rename(&part, path)
    })();
    written.map_err(|e| {
        // What was begun is of no use; that it could not be removed either says nothing new.
        let _ = std::fs::remove_file(&part);
        Error::output(path, e)
    })
}

/// Which of the parts the texts are: the last.
const TEXTS: usize = 5;

/// The hash of a scene: of its name, background, field of view and placement, and of all parts but the texts.
fn content(checksum: &Checksum, header: &Header, name: &str) -> [u8; 16] {
    let mut instead = bytemuck::bytes_of(&header.background).to_vec();
    instead.extend(header.field_of_view.to_le_bytes());
    instead.extend(bytemuck::bytes_of(&header.offset));
    instead.extend(header.exponent.to_le_bytes());
    instead.extend(name.as_bytes());
    checksum.with(&instead)
}

/// Makes the checksum right, and the readers ours, of a cache that somebody has changed: for tests of what lies behind
/// those checks. What is no cache, by its lengths, stays as it is.
pub fn reseal(bytes: &mut [u8]) {
    let Some((start, parts)) = bytes.split_at_mut_checked(size_of::<Header>()) else { return };
    let mut header: Header = bytemuck::pod_read_unaligned(start);
    if header.total() != Some((start.len() + parts.len()) as u64) {
        return;
    }
    (header.readers, header.checksum) = (readers(), [0; 16]);
    let mut checksum = Checksum::default();
    let mut rest: &[u8] = parts;
    for (count, size) in header.parts() {
        let (part, behind) = rest.split_at(count as usize * size);
        checksum.add(part, size);
        rest = behind;
    }
    header.checksum = checksum.with(bytemuck::bytes_of(&header));
    start.copy_from_slice(bytemuck::bytes_of(&header));
}

/// Reads a cache: a scene that has gone through all checks. It has the placement that it was written with, or the one
/// that is wanted.
///
/// # Errors
/// [`Error::Input`]: no cache, or one that is stale, truncated or corrupt.
pub fn read(path: &Path, options: &Options) -> Result<Scene> {
    let fault = |problem: &str, hint: &str| Error::file(path, None, problem, hint);
    let again = "make it again with `rtbench scenes convert`";
    let unreadable = |e: std::io::Error| match e.kind() {
        ErrorKind::NotFound => fault("no such file", "check the path"),
        ErrorKind::UnexpectedEof => fault("the cache is truncated", again),
        _ => fault(&format!("cannot be read: {e}"), "check the path and its permissions"),
    };
    // Before it is opened: a pipe would wait for whoever writes into it.
    if !std::fs::metadata(path).map_err(unreadable)?.is_file() {
        return Err(fault("not a regular file", "name a file that holds a scene"));
    }
    let mut file = File::open(path).map_err(unreadable)?;
    let metadata = file.metadata().map_err(unreadable)?;
    let mut header = Header::zeroed();
    let start = &mut bytemuck::bytes_of_mut(&mut header)[..metadata.len().min(size_of::<Header>() as u64) as usize];
    file.read_exact(start).map_err(unreadable)?;
    let known = start.len().min(MAGIC.len());
    if start[..known] != MAGIC[..known] || known == 0 {
        return Err(fault("this is not a cache of rtbench", "name a file that `rtbench scenes convert` has written"));
    }
    if metadata.len() < size_of::<Header>() as u64 {
        return Err(fault("the cache is truncated", again));
    }
    if header.format != FORMAT {
        let problem = format!("the cache is stale: its layout has version {}, not {FORMAT}", header.format);
        return Err(fault(&problem, again));
    }
    if header.readers != readers() {
        return Err(fault("the cache is stale: it was made by another version of rtbench's readers", again));
    }
    // Lengths are held against the file before anything is allocated from them.
    match header.total() {
        None => return Err(fault("the cache is corrupt: its header asks for more than a scene may have", again)),
        Some(total) if total > metadata.len() => return Err(fault("the cache is truncated", again)),
        Some(total) if total < metadata.len() => {
            return Err(fault("the cache is corrupt: there are bytes behind its end", again));
        }
        Some(_) => {}
    }
    let mut parts =
        Parts { file: &file, at: size_of::<Header>() as u64, checksum: Checksum::default(), extent: Extent::EMPTY };
    let vertices: Vec<Vertex> = parts.next(header.vertices, Extent::of_vertices).map_err(unreadable)?;
    let triangles: Vec<Triangle> = parts.next(header.triangles, Extent::of_triangles).map_err(unreadable)?;
    let materials: Vec<Material> = parts.next(header.materials, |_| Extent::EMPTY).map_err(unreadable)?;
    let lights: Vec<Light> = parts.next(header.lights, |_| Extent::EMPTY).map_err(unreadable)?;
    let poses: Vec<RawPose> = parts.next(header.poses, |_| Extent::EMPTY).map_err(unreadable)?;
    let text: Vec<u8> = parts.next(header.text, |_| Extent::EMPTY).map_err(unreadable)?;
    let unsigned = Header { checksum: [0; 16], ..header };
    if parts.checksum.with(bytemuck::bytes_of(&unsigned)) != header.checksum {
        return Err(fault("the cache is corrupt: its checksum is wrong", again));
    }
    let texts: Texts =
        serde_json::from_slice(&text).map_err(|_| fault("the cache is corrupt: its texts cannot be read", again))?;
    let sources = stale::restore(texts.sources, &stale::folder_of(path))
        .ok_or_else(|| fault("the cache is corrupt: it names its sources in a way that it should not", again))?;
    if let Some((source, fate)) = stale::changed(&sources) {
        return Err(fault(&format!("the cache is stale: {} {fate}", source.display()), again));
    }
    let field_of_view = header.field_of_view;
    let frames: Vec<Pose> = poses.iter().map(pose).collect();
    let sound = |pose: &Pose| pose.time.is_finite() && pose.position.is_finite() && pose.direction.is_normalized();
    let camera_works = field_of_view > 0.0 && field_of_view < 180.0 && frames.iter().all(sound);
    if !(frames.is_empty() || camera_works) {
        return Err(fault("the cache is corrupt: its camera is none", again));
    }
    let placement = Placement { offset: DVec3::from(header.offset), exponent: header.exponent };
    if !placement.is_sound() {
        return Err(fault("the cache is corrupt: its placement is not valid", again));
    }
    let mut scene = Scene {
        name: texts.name,
        vertices,
        triangles,
        materials,
        lights,
        background: Vec3::from(header.background),
        camera_path: texts.camera_path,
        camera: (!frames.is_empty()).then_some(SceneCamera { field_of_view, frames }),
        degenerate_triangles: header.degenerate as usize,
        warnings: texts.warnings,
        placement,
    };
    scene.complete(parts.extent).map_err(|(problem, hint)| fault(&problem, hint))?;
    if let Some(offset) = options.offset {
        scene.move_to(Placement { offset, exponent: 0 });
    }
    // Whoever makes something from this cache makes it from the cache's sources as well.
    sources.into_iter().for_each(|source| sources::add(|_| source));
    sources::add(|_| Source {
        path: sources::whole(path),
        kind: Kind::Cache,
        bytes: metadata.len(),
        modified: None,
        changed: None,
        hash: stale::hexadecimal(&header),
    });
    Ok(scene)
}
