//! The scene: one indexed triangle mesh, materials, point lights (SPEC section 1).
//!
//! [`Scene`] is the only thing that the rest of the crate sees of a file. [`load`] finds a reader by extension, or a
//! procedural scene by name; adding a format is one file and one line in [`FORMATS`].

use crate::error::Result;
use crate::math::{Aabb, Vertex};
use bytemuck::{Pod, Zeroable};
use glam::{Vec3, Vec3A};

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

/// A scene as loaded. Invariants, kept by every reader (see [`Scene::check`]): at least one triangle, all indices in
/// range, all positions and normals finite, at least one material.
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
    /// Triangles without area: kept, counted, never hit.
    pub degenerate_triangles: usize,
    /// What the reader wants the user to know, one line each.
    pub warnings: Vec<String>,
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
}

/// Loads a scene: a file by its extension, or a procedural scene by `name[:key=value,...]`.
pub fn load(_what: &str) -> Result<Scene> {
    unimplemented!()
}
