//! The scene: one indexed triangle mesh, materials, and point lights.
//!
//! [`Scene`] is the result of all readers; no other part of the crate depends on a file format. [`load_in`] finds a
//! reader by the file's extension, or a built-in scene or a scene of the catalogue by its name. A new format needs a
//! module and a line in [`FORMATS`].

mod aff;
pub(crate) mod budget;
pub mod cache;
pub mod catalogue;
mod extent;
pub mod gltf;
mod inventor;
pub mod lamps;
mod load;
mod mesh_builder;
mod mgf;
mod normals;
pub mod obj;
mod options;
pub mod placement;
pub mod ply;
pub mod polygon;
mod probe;
pub mod procedural;
pub mod radiometry;
mod sources;
mod suggest;
mod text;

use crate::error::{Error, Result};
use crate::guard;
use crate::math::{Aabb, Vertex};
use bytemuck::{Pod, Zeroable};
use extent::Extent;
use glam::{DVec3, Vec3, Vec3A};
pub use load::{at_time, has_no_time, load, load_in};
pub use options::{MAX_SEGMENTS, Options, Origin, Up};
pub use placement::Placement;
pub use probe::probe;
pub use procedural::{Parameter, SceneInfo, list};
use rayon::prelude::*;
use std::path::Path;
pub(crate) use suggest::did_you_mean;

/// The largest number of vertices, and of triangles, of a scene: 2^27. Indices, node links and sizes in bytes then fit
/// into 32 bits.
pub const MAX_ELEMENTS: usize = 1 << 27;

/// A reader of a file format. It subtracts [`Options::offset`] from every position in double precision before it rounds
/// to single precision, and stores the offset in [`Scene::placement`]. [`load`] sets the name, adds a material if there
/// is none, and counts degenerate triangles.
pub type ReadScene = fn(&Path, &Options) -> Result<Scene>;

/// The options that the reader of BART's files supports.
const AFF: &[&str] = &["time", "segments", "cones", "camera", "outside", "origin"];

/// Readers by file extension (lower case), with the options that each supports in addition to [`Options::COMMON`].
pub const FORMATS: &[(&str, ReadScene, &[&str])] = &[
    ("ply", ply::read, &["origin"]),
    ("aff", aff::read, AFF),
    ("nff", aff::read, AFF),
    ("mgf", mgf::read, &["segments", "outside", "origin"]),
    ("iv", inventor::read, &["segments", "outside", "origin"]),
    ("wrl", inventor::read, &["segments", "outside", "origin"]),
    ("obj", obj::read, &["lamp", "outside", "origin"]),
    ("gltf", gltf::read, &["camera", "outside", "origin"]),
    ("glb", gltf::read, &["camera", "outside", "origin"]),
    // A cache of a scene in any of these formats
    (cache::EXTENSION, cache::read, &[]),
];

/// A triangle: three indices of vertices and an index of a material.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Triangle {
    /// Indices into [`Scene::vertices`].
    pub vertices: [u32; 3],
    /// Index into [`Scene::materials`].
    pub material: u32,
}

/// A Phong material as it is stored on the device: 48 bytes. Colours are linear, 0 or more per channel.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Material {
    /// Colour that is reflected of the ambient light.
    pub ambient: Vec3,
    /// Share of the reflected ray's colour, 0 to 1; a surface with more than 0 is a mirror.
    pub reflectivity: f32,
    /// Colour of Lambert's diffuse reflection.
    pub diffuse: Vec3,
    /// Exponent of Phong's highlight, 0 or more.
    pub exponent: f32,
    /// Colour of Phong's highlight.
    pub specular: Vec3,
    /// Padding of WGSL's vec4; always zero.
    pub pad: f32,
}

impl Material {
    /// A diffuse material of one colour; its ambient colour is a tenth of it.
    pub fn matt(diffuse: Vec3) -> Material {
        Material { ambient: diffuse * 0.1, reflectivity: 0.0, diffuse, exponent: 1.0, specular: Vec3::ZERO, pad: 0.0 }
    }

    /// The material of scenes that define none: a light warm grey with a soft highlight, without a mirror.
    pub fn neutral() -> Material {
        Material::matt(Vec3::new(0.72, 0.70, 0.66)).shiny(Vec3::splat(0.25), 24.0, 0.0)
    }

    /// This material with a highlight and a mirror share.
    pub fn shiny(self, specular: Vec3, exponent: f32, reflectivity: f32) -> Material {
        Material { specular, exponent, reflectivity, ..self }
    }
}

/// A point light without attenuation as it is stored on the device: 32 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Light {
    /// Position in the scene's coordinates in memory.
    pub position: Vec3,
    /// Padding of WGSL's vec4; always zero.
    pub pad0: f32,
    /// Linear colour; the contributions of several lights are added.
    pub colour: Vec3,
    /// Padding of WGSL's vec4; always zero.
    pub pad1: f32,
}

impl Light {
    /// A light with zero padding.
    pub fn new(position: Vec3, colour: Vec3) -> Light {
        Light { position, pad0: 0.0, colour, pad1: 0.0 }
    }
}

/// The camera of a scene file, static or animated.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneCamera {
    /// Vertical field of view in degrees, between 0 and 180.
    pub field_of_view: f32,
    /// One pose per frame of the file's animation; a static camera has a single pose.
    pub frames: Vec<Pose>,
}

/// The pose of a camera at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Time in the units of the file's animation.
    pub time: f64,
    /// The centre of projection.
    pub position: Vec3,
    /// Unit vector to the centre of the image.
    pub direction: Vec3,
    /// The up vector; need not be perpendicular to `direction`, but must not be parallel to it.
    pub up: Vec3,
}

/// A loaded scene, in its coordinates in memory. Every reader guarantees these invariants (see [`Scene::check`]): there
/// is at least one triangle and one material, all indices are in range, all positions and normals are finite.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Short name, contained in every record: the file's stem and options, or the name and parameters of a built-in
    /// scene.
    pub name: String,
    /// The vertices of all triangles; a vertex may be unused.
    pub vertices: Vec<Vertex>,
    /// The triangles in file order. A hit reports the index of its triangle.
    pub triangles: Vec<Triangle>,
    /// The materials that triangles refer to; never empty.
    pub materials: Vec<Material>,
    /// The names of the materials in the file, as many as there are materials; empty where the format has none. They
    /// are no part of a scene's identity, and caches do not hold them.
    pub material_names: Vec<String>,
    /// Point lights; empty if the file has none, in which case the camera path provides them.
    pub lights: Vec<Light>,
    /// Colour of rays that leave the scene.
    pub background: Vec3,
    /// Name of the scene's camera path in `camera-paths/` (without extension), if it has one.
    pub camera_path: Option<String>,
    /// The camera of the scene's file, if it has one; it has precedence over `camera_path`.
    pub camera: Option<SceneCamera>,
    /// Number of triangles without area. They are kept, but never hit.
    pub degenerate_triangles: usize,
    /// Warnings of the reader for the user, one line each.
    pub warnings: Vec<String>,
    /// Conversion between the coordinates in memory and those of the scene's file, which users see.
    pub placement: Placement,
}

impl Scene {
    /// The corners of triangle `index`.
    pub fn corners(&self, index: u32) -> [Vec3A; 3] {
        self.triangles[index as usize].vertices.map(|v| self.vertices[v as usize].position_a())
    }

    /// The box around all triangles.
    pub fn bounds(&self) -> Aabb {
        Aabb::from_points(self.triangles.iter().flat_map(|t| t.vertices).map(|v| self.vertices[v as usize].position))
    }

    /// Checks the invariants of a scene.
    ///
    /// # Errors
    /// [`Error::Input`] with the scene's name and the first violated invariant.
    pub fn check(&self) -> Result<()> {
        self.first_fault(Extent::of(self))
            .map_or(Ok(()), |(problem, hint)| Err(Error::argument(self.name.clone(), problem, hint)))
    }

    /// The first violated invariant, as problem and hint. `extent` is the extent of this scene.
    fn first_fault(&self, extent: Extent) -> Option<(String, &'static str)> {
        if self.triangles.is_empty() {
            return Some(("there is no triangle".into(), "a scene needs at least one"));
        }
        for (count, elements) in [(self.vertices.len(), "vertices"), (self.triangles.len(), "triangles")] {
            if count > MAX_ELEMENTS {
                let problem = format!("{count} {elements} are more than rtbench supports ({MAX_ELEMENTS})");
                return Some((problem, "simplify the scene"));
            }
        }
        let (vertices, materials) = (self.vertices.len() as u32, self.materials.len() as u32);
        if !self.material_names.is_empty() && self.material_names.len() != self.materials.len() {
            let problem = format!("{} names are not those of {materials} materials", self.material_names.len());
            return Some((problem, "give each material a name, or none"));
        }
        if extent.vertex() >= vertices
            && let Some(i) = self.triangles.iter().position(|t| t.vertices.iter().any(|&v| v >= vertices))
        {
            let problem = format!("triangle {i} uses a vertex beyond the {vertices} of the scene");
            return Some((problem, "repair the triangle's indices"));
        }
        if extent.material() >= materials
            && let Some(i) = self.triangles.iter().position(|t| t.material >= materials)
        {
            let problem = format!("triangle {i} uses a material beyond the {materials} of the scene");
            return Some((problem, "repair the triangle's material"));
        }
        if !extent.is_finite()
            && let Some(i) = self.vertices.iter().position(|v| !v.position.is_finite() || !v.normal.is_finite())
        {
            return Some((format!("vertex {i} is not finite"), "remove it or repair the export"));
        }
        // Unused vertices may lie anywhere: if the bounds of all vertices are too large, those of the triangles decide.
        if !extent.bounds().diagonal().is_finite() && !self.bounds().diagonal().is_finite() {
            return Some(("the scene is too large: its diagonal is not finite".into(), "scale it down"));
        }
        let colours = |m: &Material| [m.ambient, m.diffuse, m.specular];
        let sound = |m: &Material| {
            colours(m).iter().all(|c| c.is_finite() && c.min_element() >= 0.0)
                && (0.0..=1.0).contains(&m.reflectivity)
                && m.exponent.is_finite()
                && m.exponent >= 0.0
        };
        if let Some(i) = self.materials.iter().position(|m| !sound(m)) {
            let problem = format!("material {i} is outside of its range");
            return Some((problem, "colours and the exponent are finite and not negative, reflectivity is 0 to 1"));
        }
        if let Some(i) = self.lights.iter().position(|l| !l.position.is_finite() || !l.colour.is_finite()) {
            return Some((format!("light {i} is not finite"), "give it a finite position and colour"));
        }
        None
    }

    /// Size in bytes of vertices, materials, material indices and lights on the device. Triangle references belong to
    /// the structures.
    pub fn geometry_bytes(&self) -> u64 {
        let materials = size_of_val(self.materials.as_slice()) + self.triangles.len() * size_of::<u32>();
        (size_of_val(self.vertices.as_slice()) + materials + size_of_val(self.lights.as_slice())) as u64
    }

    /// BLAKE3, hexadecimal, of all data that tracing and shading depend on: vertices, triangles, materials, lights and
    /// background, each with its length, and the placement unless it is the identity. The hash is equal on all machines
    /// with the same byte order.
    pub fn content_hash(&self) -> String {
        let background = [self.background];
        let parts: [&[u8]; 5] = [
            bytemuck::cast_slice(&self.vertices),
            bytemuck::cast_slice(&self.triangles),
            bytemuck::cast_slice(&self.materials),
            bytemuck::cast_slice(&self.lights),
            bytemuck::cast_slice(&background),
        ];
        let mut hasher = blake3::Hasher::new();
        for part in parts {
            hasher.update(&(part.len() as u64).to_le_bytes());
            hasher.update(part);
        }
        // Cameras and rays are given in the file's coordinates: with another placement they meet the scene elsewhere.
        if !self.placement.is_identity() {
            let Placement { offset, exponent } = self.placement;
            offset.to_array().iter().for_each(|x| _ = hasher.update(&x.to_le_bytes()));
            hasher.update(&exponent.to_le_bytes());
        }
        hasher.finalize().to_hex().to_string()
    }

    /// The share of the surface area with a reflectivity above 0, from 0 to 1.
    pub fn mirror_share(&self) -> f32 {
        let (mut mirrors, mut all) = (0.0f64, 0.0f64);
        for triangle in &self.triangles {
            let [a, b, c] = triangle.vertices.map(|v| self.vertices[v as usize].position.as_dvec3());
            let area = (b - a).cross(c - a).length();
            all += area;
            if self.materials[triangle.material as usize].reflectivity > 0.0 {
                mirrors += area;
            }
        }
        if all > 0.0 { (mirrors / all) as f32 } else { 0.0 }
    }

    /// Rotates the scene such that y is up, and scales it; lights, camera and placement included.
    fn transform(&mut self, up: Up, scale: f32) {
        if up == Up::Y && scale == 1.0 {
            return;
        }
        let turn = |v: Vec3| if up == Up::Z { Vec3::new(v.x, v.z, -v.y) } else { v };
        let offset = self.placement.offset;
        let turned = if up == Up::Z { DVec3::new(offset.x, offset.z, -offset.y) } else { offset };
        // Adding zero turns -0 into 0, so that both give the same placement.
        self.placement.offset = turned * f64::from(scale) + DVec3::ZERO;
        for vertex in &mut self.vertices {
            vertex.position = turn(vertex.position) * scale;
            vertex.normal = turn(vertex.normal);
        }
        for light in &mut self.lights {
            light.position = turn(light.position) * scale;
        }
        for pose in self.camera.iter_mut().flat_map(|camera| &mut camera.frames) {
            pose.position = turn(pose.position) * scale;
            pose.direction = turn(pose.direction);
            pose.up = turn(pose.up);
        }
    }

    /// Adds the neutral material if there is none, and checks the invariants; an error is a problem and a hint.
    /// `extent` is the extent of this scene.
    fn complete(&mut self, extent: Extent) -> Result<(), (String, &'static str)> {
        if self.materials.is_empty() {
            self.materials.push(Material::neutral());
        }
        self.first_fault(extent).map_or(Ok(()), Err)
    }

    /// Sets the number of degenerate triangles of a checked scene, and returns the box around all triangles.
    fn survey(&mut self) -> Aabb {
        let vertices = &self.vertices;
        type Found = (usize, Aabb);
        let nothing: Found = (0, Aabb::EMPTY);
        let add = |(degenerate, bounds): Found, triangle: &Triangle| {
            let corners = triangle.vertices.map(|v| vertices[v as usize].position);
            let bounds = corners.iter().fold(bounds, |b, &p| Aabb { min: b.min.min(p), max: b.max.max(p) });
            (degenerate + usize::from(normals::is_degenerate(corners)), bounds)
        };
        let both = |a: Found, b: Found| (a.0 + b.0, a.1.union(b.1));
        let chunks = self.triangles.par_chunks(1 << 14).map(|chunk| chunk.iter().fold(nothing, add));
        let (degenerate, bounds) = chunks.reduce(|| nothing, both);
        self.degenerate_triangles = degenerate;
        bounds
    }
}

/// Reads a file that is or may be text: UTF-16 with a byte order mark becomes UTF-8, and a byte order mark is removed,
/// which no format allows. All readers get their bytes from here.
fn read_text(path: &Path) -> Result<Vec<u8>> {
    text::to_utf8(read_file(path)?).map_err(|fault| fault.of(path))
}

/// Refuses what is no regular file.
pub(crate) fn regular_file(path: &Path) -> Result<std::fs::Metadata> {
    let fault = |problem: String, hint| Error::file(path, None, problem, hint);
    match std::fs::metadata(path) {
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => Err(fault("no such file".into(), "check the path")),
        Err(e) => Err(fault(format!("cannot be read: {e}"), "check the path and its permissions")),
        Ok(metadata) if !metadata.is_file() => {
            Err(fault("not a regular file".into(), "name a file that holds a scene"))
        }
        Ok(metadata) => Ok(metadata),
    }
}

/// The bytes of a file as they are.
fn read_file(path: &Path) -> Result<Vec<u8>> {
    let fault = |problem: String, hint| Error::file(path, None, problem, hint);
    let metadata = regular_file(path)?;
    let content = std::fs::read(path).map_err(|e| fault(format!("cannot be read: {e}"), "check its permissions"))?;
    sources::read(path, &metadata, &content);
    guard::read(path);
    Ok(content)
}
