//! `.rtb`: a cache of a loaded scene, in one binary file.
//!
//! The file is a header of fixed size, then vertices, triangles, materials, lights and the camera's poses as they are
//! in memory, then the texts as JSON. All numbers are little-endian. A checksum (XXH3, 128 bits) covers the whole file.
//! It detects damage, not forgery, so the content is checked like that of any other scene file.
//!
//! A cache that cannot be used is refused, never repaired. It is *foreign* without the magic bytes, *truncated* or
//! *corrupt* if its length or its checksum is wrong, and **stale** if loading its source files again might give another
//! scene:
//! - the layout has another version ([`FORMAT`]);
//! - it was written by a program with other readers, of which `build/main.rs` hashes the source code;
//! - one of its source files, includes and material libraries among them, has changed (`stale.rs`). Source files are
//!   searched at their paths relative to the cache; if none of them exists, the cache is accepted without this check.

mod layout;
mod pages;
mod parts;
mod stale;

use super::extent::Extent;
use super::sources::{self, SourceFile, SourceKind};
use super::{Light, Material, Options, Placement, Pose, Scene, SceneCamera, Triangle, load_in};
use crate::error::{Error, Result};
use crate::guard;
use crate::math::Vertex;
use bytemuck::Zeroable;
use glam::{DVec3, Vec3};
use layout::FORMAT;
use layout::{Header, MAGIC, RawPose, pose, raw_pose, readers};
use parts::{Checksum, Parts};
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::io::{ErrorKind, Read, Write};
use std::path::Path;

/// The file extension of caches.
pub const EXTENSION: &str = "rtb";

/// The last part of a cache, stored as JSON.
#[derive(Serialize, Deserialize)]
struct Texts {
    name: String,
    camera_path: Option<String>,
    warnings: Vec<String>,
    /// The files that the scene was read from.
    sources: Vec<stale::Stored>,
}

/// The files that a scene was read from; empty for a built-in scene.
#[derive(Clone, Debug, Default)]
pub struct Sources(Vec<SourceFile>);

impl Sources {
    /// The paths of all files, including those that were searched and did not exist.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        self.0.iter().map(|source| source.path.as_path())
    }
}

/// Loads a scene as [`load_in`] does, and records its source files.
///
/// # Errors
/// Those of [`load_in`].
pub fn load(spec: &str, folder: Option<&Path>) -> Result<(Scene, Sources)> {
    let (scene, sources) = sources::record(true, || load_in(spec, folder));
    Ok((scene?, Sources(sources)))
}

/// Writes a scene and its source files' states to a cache. The file is replaced atomically.
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
        // The partial file is useless; an error while removing it adds nothing to the first one.
        let _ = std::fs::remove_file(&part);
        Error::output(path, e)
    })
}

/// Index of the texts among the parts; they are the last.
const TEXTS: usize = 5;

/// [`Header::content`]: the hash of name, background, field of view, placement, and all parts except the texts.
fn content(checksum: &Checksum, header: &Header, name: &str) -> [u8; 16] {
    let mut instead = bytemuck::bytes_of(&header.background).to_vec();
    instead.extend(header.field_of_view.to_le_bytes());
    instead.extend(bytemuck::bytes_of(&header.offset));
    instead.extend(header.exponent.to_le_bytes());
    instead.extend(name.as_bytes());
    checksum.with(&instead)
}

/// Sets the checksum and [`Header::readers`] of a modified cache to valid values, so that tests reach the checks that
/// follow. Bytes of which the length does not fit their header are left unchanged.
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

/// Reads a cache and checks the scene. The scene keeps the placement that it was written with, unless `options.offset`
/// asks for another.
///
/// # Errors
/// [`Error::Input`] if the file is not a cache, or is stale, truncated or corrupt.
pub fn read(path: &Path, options: &Options) -> Result<Scene> {
    let fault = |problem: &str, hint: &str| Error::file(path, None, problem, hint);
    let again = "make it again with `rtbench scenes convert`";
    let unreadable = |e: std::io::Error| match e.kind() {
        ErrorKind::NotFound => fault("no such file", "check the path"),
        ErrorKind::UnexpectedEof => fault("the cache is truncated", again),
        _ => fault(&format!("cannot be read: {e}"), "check the path and its permissions"),
    };
    // This is checked before opening, because opening a pipe waits for a writer.
    if !std::fs::metadata(path).map_err(unreadable)?.is_file() {
        return Err(fault("not a regular file", "name a file that holds a scene"));
    }
    let mut file = File::open(path).map_err(unreadable)?;
    guard::read(path);
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
        return Err(fault("the cache is stale: it was written by another version of rtbench's readers", again));
    }
    // Lengths are compared with the file's size before memory is allocated for them.
    match header.total() {
        None => return Err(fault("the cache is corrupt: its header exceeds the limits of a scene", again)),
        Some(total) if total > metadata.len() => return Err(fault("the cache is truncated", again)),
        Some(total) if total < metadata.len() => {
            return Err(fault("the cache is corrupt: there are bytes after its end", again));
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
        .ok_or_else(|| fault("the cache is corrupt: the path of a source file is not relative", again))?;
    if let Some((source, fate)) = stale::changed(&sources) {
        return Err(fault(&format!("the cache is stale: {} {fate}", source.display()), again));
    }
    let field_of_view = header.field_of_view;
    let frames: Vec<Pose> = poses.iter().map(pose).collect();
    let sound = |pose: &Pose| pose.time.is_finite() && pose.position.is_finite() && pose.direction.is_normalized();
    let camera_works = field_of_view > 0.0 && field_of_view < 180.0 && frames.iter().all(sound);
    if !(frames.is_empty() || camera_works) {
        return Err(fault("the cache is corrupt: its camera is not valid", again));
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
        material_names: Vec::new(),
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
    // A scene that is read from this cache depends on the cache's source files as well.
    sources.iter().for_each(|source| guard::read(&source.path));
    sources.into_iter().for_each(|source| sources::add(|_| source));
    sources::add(|_| SourceFile {
        path: sources::resolve_folder(path),
        kind: SourceKind::Cache,
        bytes: metadata.len(),
        modified: None,
        changed: None,
        hash: stale::hexadecimal(&header),
    });
    Ok(scene)
}
