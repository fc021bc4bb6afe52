//! The scene: one indexed triangle mesh, materials, point lights (SPEC section 1).
//!
//! [`Scene`] is the only thing that the rest of the crate sees of a file. [`load_in`] finds a reader by extension, or a
//! procedural scene or one of the catalogue by name; adding a format is one file and one line in [`FORMATS`].

pub mod aff;
pub mod cache;
pub mod catalogue;
mod extent;
pub mod gltf;
pub mod inventor;
pub mod lamps;
mod load;
pub mod mesh_builder;
pub mod mgf;
pub mod normals;
pub mod obj;
mod options;
pub mod placement;
pub mod ply;
pub mod polygon;
pub mod procedural;
mod sources;
mod suggest;
pub mod text;

use crate::error::{Error, Result};
use crate::math::{Aabb, Vertex};
use bytemuck::{Pod, Zeroable};
use extent::Extent;
use glam::{DVec3, Vec3, Vec3A};
pub use load::{at_time, has_no_time, load, load_in};
pub use options::{MAX_SEGMENTS, Options, Origin, Up};
pub use placement::Placement;
pub use procedural::{Parameter, SceneInfo, list};
use rayon::prelude::*;
use std::path::Path;
pub(crate) use suggest::did_you_mean;

/// Most vertices, and most triangles, that a scene may have (2^27): indices, node links and byte sizes then fit into 32
/// bits everywhere.
pub const MAX_ELEMENTS: usize = 1 << 27;

/// A reader: the scene in a file. From every position it subtracts [`Options::offset`] in double precision before it
/// rounds, and says so in `placement`. It need not set `name`, nor `materials` if the format has none, nor count
/// degenerate triangles; [`load`] does.
pub type Reader = fn(&Path, &Options) -> Result<Scene>;

/// What BART's files heed.
const AFF: &[&str] = &["time", "segments", "cones", "camera", "outside", "origin"];

/// Readers by file extension (lower case), and which options they heed beside those that every file takes
/// ([`Options::COMMON`]).
pub const FORMATS: &[(&str, Reader, &[&str])] = &[
    ("ply", ply::read, &["origin"]),
    ("aff", aff::read, AFF),
    ("nff", aff::read, AFF),
    ("mgf", mgf::read, &["segments", "outside", "origin"]),
    ("iv", inventor::read, &["segments", "outside", "origin"]),
    ("wrl", inventor::read, &["segments", "outside", "origin"]),
    ("obj", obj::read, &["lamp", "outside", "origin"]),
    ("gltf", gltf::read, &["camera", "outside", "origin"]),
    ("glb", gltf::read, &["camera", "outside", "origin"]),
    // The cache of any of them
    (cache::EXTENSION, cache::read, &[]),
];

/// One triangle: three vertices and a material.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Triangle {
    /// Indices into [`Scene::vertices`].
    pub vertices: [u32; 3],
    /// Index into [`Scene::materials`].
    pub material: u32,
}

/// A Phong material, as the device sees it (48 bytes).
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Material {
    /// Ambient colour, linear, 0 to 1.
    pub ambient: Vec3,
    /// Share of the reflected ray's colour, 0 to 1; more than 0 makes the surface shiny (PSR follows it).
    pub reflectivity: f32,
    /// Diffuse colour.
    pub diffuse: Vec3,
    /// Phong exponent.
    pub exponent: f32,
    /// Specular colour.
    pub specular: Vec3,
    /// Zero; WGSL's vec4.
    pub pad: f32,
}

impl Material {
    /// A matt material of one colour, with a little ambient light.
    pub fn matt(diffuse: Vec3) -> Material {
        Material { ambient: diffuse * 0.1, reflectivity: 0.0, diffuse, exponent: 1.0, specular: Vec3::ZERO, pad: 0.0 }
    }

    /// What a scene without materials of its own is made of: a light warm grey with a soft highlight, no mirror.
    pub fn neutral() -> Material {
        Material::matt(Vec3::new(0.72, 0.70, 0.66)).shiny(Vec3::splat(0.25), 24.0, 0.0)
    }

    /// With a highlight and a mirror's share.
    pub fn shiny(self, specular: Vec3, exponent: f32, reflectivity: f32) -> Material {
        Material { specular, exponent, reflectivity, ..self }
    }
}

/// A point light, without attenuation, as the device sees it (32 bytes).
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Light {
    /// Where it is.
    pub position: Vec3,
    /// Zero; WGSL's vec4.
    pub pad0: f32,
    /// Linear colour; several lights add up.
    pub colour: Vec3,
    /// Zero; WGSL's vec4.
    pub pad1: f32,
}

impl Light {
    /// A light.
    pub fn new(position: Vec3, colour: Vec3) -> Light {
        Light { position, pad0: 0.0, colour, pad1: 0.0 }
    }
}

/// A camera that stands in a scene file, still or moving.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneCamera {
    /// Vertical field of view in degrees, between 0 and 180.
    pub field_of_view: f32,
    /// One per frame of the file's animation; a single one for a camera that stands still.
    pub frames: Vec<Pose>,
}

/// Where a camera is at a moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// In the file's time.
    pub time: f64,
    /// Eye.
    pub position: Vec3,
    /// Unit vector to the image's middle.
    pub direction: Vec3,
    /// Roughly up; not parallel to `direction`.
    pub up: Vec3,
}

/// A scene as loaded, in the coordinates of memory. Invariants, kept by every reader (see [`Scene::check`]): at least
/// one triangle, all indices in range, all positions and normals finite, at least one material.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Short name: the file's stem or the procedural scene's name and parameters. Stands in every record.
    pub name: String,
    /// Positions and normals.
    pub vertices: Vec<Vertex>,
    /// Triangles in file order; polygons as fans. Their index is what a hit reports.
    pub triangles: Vec<Triangle>,
    /// Materials.
    pub materials: Vec<Material>,
    /// Point lights; empty where the file has none (a camera path brings its own then).
    pub lights: Vec<Light>,
    /// Colour where a ray leaves the scene.
    pub background: Vec3,
    /// The file name (without extension) of the camera path in `camera-paths/` that fits, if the scene knows one.
    pub camera_path: Option<String>,
    /// The camera that the file brings, if it does; it goes before `camera_path`.
    pub camera: Option<SceneCamera>,
    /// Triangles without area: kept, counted, never hit.
    pub degenerate_triangles: usize,
    /// What the reader wants the user to know, one line each.
    pub warnings: Vec<String>,
    /// Where all of this lies in the file: positions here are single precision near the origin, and users see the
    /// file's.
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

    /// Checks the invariants that everything behind the readers relies on.
    ///
    /// # Errors
    /// [`Error::Input`] that names the scene and the first invariant that does not hold.
    pub fn check(&self) -> Result<()> {
        self.first_fault(Extent::of(self))
            .map_or(Ok(()), |(problem, hint)| Err(Error::argument(self.name.clone(), problem, hint)))
    }

    /// The first invariant that does not hold: problem and mend. `extent` is this scene's.
    fn first_fault(&self, extent: Extent) -> Option<(String, &'static str)> {
        if self.triangles.is_empty() {
            return Some(("there is no triangle".into(), "a scene needs at least one"));
        }
        for (count, what) in [(self.vertices.len(), "vertices"), (self.triangles.len(), "triangles")] {
            if count > MAX_ELEMENTS {
                let problem = format!("{count} {what} are more than rtbench handles ({MAX_ELEMENTS})");
                return Some((problem, "simplify the scene"));
            }
        }
        let (vertices, materials) = (self.vertices.len() as u32, self.materials.len() as u32);
        if extent.vertex() >= vertices
            && let Some(i) = self.triangles.iter().position(|t| t.vertices.iter().any(|&v| v >= vertices))
        {
            let problem = format!("triangle {i} uses a vertex beyond the {vertices} that there are");
            return Some((problem, "repair the triangle's indices"));
        }
        if extent.material() >= materials
            && let Some(i) = self.triangles.iter().position(|t| t.material >= materials)
        {
            let problem = format!("triangle {i} uses a material beyond the {materials} that there are");
            return Some((problem, "repair the triangle's material"));
        }
        if !extent.is_finite()
            && let Some(i) = self.vertices.iter().position(|v| !v.position.is_finite() || !v.normal.is_finite())
        {
            return Some((format!("vertex {i} is not finite"), "remove it or repair the export"));
        }
        // Vertices that no triangle uses may lie anywhere: only then it takes the way by the triangles.
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

    /// Bytes of vertices, materials, every triangle's material and lights, as the twins hold them. (Triangle records belong to
    /// structures.)
    pub fn geometry_bytes(&self) -> u64 {
        let materials = size_of_val(self.materials.as_slice()) + self.triangles.len() * size_of::<u32>();
        (size_of_val(self.vertices.as_slice()) + materials + size_of_val(self.lights.as_slice())) as u64
    }

    /// BLAKE3 of all that decides what is traced and shaded, hexadecimal: vertices, triangles, materials, lights and
    /// background, each with its number, and the placement where there is one. Equal on all machines with the same
    /// byte order.
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
        // Cameras and rays are given in the file's coordinates: the same scene elsewhere is another one.
        if !self.placement.is_identity() {
            let Placement { offset, exponent } = self.placement;
            offset.to_array().iter().for_each(|x| _ = hasher.update(&x.to_le_bytes()));
            hasher.update(&exponent.to_le_bytes());
        }
        hasher.finalize().to_hex().to_string()
    }

    /// The share of the surface's area that is a mirror (reflectivity above 0), 0 to 1.
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

    /// Turns the scene's up to y and scales it, positions, lights and camera alike.
    fn transform(&mut self, up: Up, scale: f32) {
        if up == Up::Y && scale == 1.0 {
            return;
        }
        let turn = |v: Vec3| if up == Up::Z { Vec3::new(v.x, v.z, -v.y) } else { v };
        let offset = self.placement.offset;
        let turned = if up == Up::Z { DVec3::new(offset.x, offset.z, -offset.y) } else { offset };
        // Adding zero makes -0 and 0 the same placement
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

    /// Gives a material where there is none, and checks the rest; a fault comes back as problem and mend. `extent` is this
    /// scene's.
    fn complete(&mut self, extent: Extent) -> Result<(), (String, &'static str)> {
        if self.materials.is_empty() {
            self.materials.push(Material::neutral());
        }
        self.first_fault(extent).map_or(Ok(()), Err)
    }

    /// Counts the triangles without area of a scene that has been checked, and finds the box around all of them.
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

/// The bytes of a text file, or of one that may be text: without a byte order mark, which editors put before UTF-8 and which
/// no format has a place for. Every reader takes its files from here, so that none sees one.
fn read_text(path: &Path) -> Result<Vec<u8>> {
    let mut content = read_file(path)?;
    if content.starts_with("\u{feff}".as_bytes()) {
        content.drain(.."\u{feff}".len());
    }
    Ok(content)
}

/// The bytes of a file as they are.
fn read_file(path: &Path) -> Result<Vec<u8>> {
    let fault = |problem: String, hint| Error::file(path, None, problem, hint);
    let metadata = match std::fs::metadata(path) {
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => {
            return Err(fault("no such file".into(), "check the path"));
        }
        Err(e) => return Err(fault(format!("cannot be read: {e}"), "check the path and its permissions")),
        Ok(metadata) if !metadata.is_file() => {
            return Err(fault("not a regular file".into(), "name a file that holds a scene"));
        }
        Ok(metadata) => metadata,
    };
    let content = std::fs::read(path).map_err(|e| fault(format!("cannot be read: {e}"), "check its permissions"))?;
    sources::read(path, &metadata, &content);
    Ok(content)
}
