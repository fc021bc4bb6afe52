//! Builds the mesh of a scene for the readers: a stack of transforms, a current material, polygons and curved surfaces,
//! and limits on the memory.
//!
//! A vertex has one normal. Corners with equal position and normal share a vertex within a *shape* (see
//! [`MeshBuilder::new_shape`]), so a smooth surface is indexed, and a sharp edge has two vertices per corner. In a mesh
//! of flat faces only consecutive coplanar faces share vertices ([`MeshBuilder::flat_polygon`]).

mod charges;
mod curves;
mod finite;
mod limits;
mod polygons;
mod revolve;
mod shared;
mod warnings;

use super::placement::MAX_COORDINATE;
use super::polygon::Triangulator;
use super::text::Fault;
use super::{Light, Material, Options, Placement, Scene, Triangle};
use crate::math::Vertex;
pub use finite::{DROPPED, NotFinite, drop_invalid, is_valid, narrow, narrow_number};
use foldhash::fast::RandomState;
use glam::{DAffine3, DMat3, DVec3, Vec3};
pub use limits::Limits;
pub use polygons::has_direction;
use revolve::UnitCircles;
use shared::Shared;
use std::collections::HashMap;
use std::ops::Range;
pub use warnings::Warnings;

/// The largest depth of the stack of transforms.
const MAX_DEPTH: usize = 1000;

/// A mesh under construction.
pub struct MeshBuilder {
    vertices: Vec<Vertex>,
    triangles: Vec<Triangle>,
    materials: Vec<Material>,
    lights: Vec<Light>,
    /// Search tables of the shape's vertices.
    shared: Shared,
    /// Vertices of the shape that are not in the tables yet. They are added before the next search; curved surfaces and
    /// the first polygon of a plane need none.
    unlisted: Range<usize>,
    circles: UnitCircles,
    /// Normal of the flat polygon that began the shape.
    flat: Vec3,
    /// Index of each material by its bits.
    known: HashMap<[u32; 12], u32, RandomState>,
    current: Material,
    /// Index of the current material, once a triangle uses it.
    current_index: Option<u32>,
    stack: Vec<Frame>,
    triangulator: Triangulator,
    corners: Vec<u32>,
    limits: Limits,
    pub warnings: Warnings,
    /// Faces and surfaces that were dropped, because a coordinate in the file is not finite.
    pub not_finite: NotFinite,
}

/// A transform with derived values.
#[derive(Clone, Copy)]
struct Frame {
    affine: DAffine3,
    /// The transform of normals: the inverse transpose up to a factor, which is also valid for matrices of rank two.
    normals: DMat3,
    /// True if it inverts orientation.
    mirrored: bool,
    /// The point of the file that is the origin in memory.
    offset: DVec3,
}

impl Frame {
    fn new(affine: DAffine3, offset: DVec3) -> Frame {
        let m = affine.matrix3;
        let sign = if m.determinant() < 0.0 { -1.0 } else { 1.0 };
        let cofactors = DMat3::from_cols(
            m.y_axis.cross(m.z_axis) * sign,
            m.z_axis.cross(m.x_axis) * sign,
            m.x_axis.cross(m.y_axis) * sign,
        );
        Frame { affine, normals: cofactors, mirrored: sign < 0.0, offset }
    }

    /// A vertex at the transformed position, which is moved to the origin before it is rounded. `normal` is the result
    /// of [`Frame::direction`].
    #[inline(always)]
    fn place(&self, position: DVec3, normal: Vec3) -> Result<Vertex, Fault> {
        let position = self.affine.transform_point3(position);
        // Adding zero turns -0 into 0, so that both give the same vertex.
        let placed = (position - self.offset).as_vec3() + Vec3::ZERO;
        let within = position.abs().cmple(DVec3::splat(MAX_COORDINATE)).all();
        if within { Ok(Vertex::new(placed, normal)) } else { Err(too_far(position)) }
    }

    /// The transformed unit normal of a normal of any length; zero if it has no direction.
    #[inline(always)]
    fn direction(&self, normal: DVec3) -> Vec3 {
        let turned = unit_if_in_range(self.normals * normal).unwrap_or_else(|| unit(self.normals * unit(normal)));
        turned.as_vec3() + Vec3::ZERO
    }
}

#[cold]
fn too_far(position: DVec3) -> Fault {
    let problem = match position.as_vec3().is_finite() {
        true => format!("a corner at {position} exceeds the largest coordinate 1e18"),
        false => format!("a corner at {} is not finite in single precision", position.as_vec3()),
    };
    Fault::new(None, problem, FINITE)
}

impl Default for MeshBuilder {
    fn default() -> MeshBuilder {
        MeshBuilder {
            vertices: Vec::new(),
            triangles: Vec::new(),
            materials: Vec::new(),
            lights: Vec::new(),
            shared: Shared::default(),
            unlisted: 0..0,
            circles: UnitCircles::default(),
            flat: Vec3::ZERO,
            known: HashMap::default(),
            current: Material::neutral(),
            current_index: None,
            stack: vec![Frame::new(DAffine3::IDENTITY, DVec3::ZERO)],
            triangulator: Triangulator::default(),
            corners: Vec::new(),
            limits: Limits::default(),
            warnings: Warnings::default(),
            not_finite: NotFinite::default(),
        }
    }
}

impl MeshBuilder {
    /// A builder of a mesh; `options` give the point of the file that is the origin in memory, and the memory that
    /// repetitions may take. All geometry counts as possibly repeated: the files' bytes are parsed for every triangle
    /// that is not.
    pub fn new(options: &Options) -> MeshBuilder {
        let frame = Frame::new(DAffine3::IDENTITY, options.offset.unwrap_or(DVec3::ZERO));
        MeshBuilder { stack: vec![frame], limits: Limits::new(options), ..MeshBuilder::default() }
    }

    /// The point of the file that is the origin in memory.
    pub fn offset(&self) -> DVec3 {
        self.frame().offset
    }

    /// The current transform, from local to scene coordinates.
    pub fn transform(&self) -> DAffine3 {
        self.frame().affine
    }

    fn frame(&self) -> &Frame {
        &self.stack[self.stack.len() - 1]
    }

    /// Pushes a transform, relative to the current one.
    ///
    /// # Errors
    /// The stack is too deep.
    pub fn push(&mut self, local: DAffine3) -> Result<(), Fault> {
        if self.stack.len() > MAX_DEPTH {
            let problem = format!("transforms are nested more than {MAX_DEPTH} levels deep");
            return Err(Fault::new(None, problem, "flatten the file's hierarchy"));
        }
        self.stack.push(Frame::new(self.transform() * local, self.offset()));
        Ok(())
    }

    /// Pops the transform that was pushed last; false if there is none.
    pub fn pop(&mut self) -> bool {
        self.stack.len() > 1 && self.stack.pop().is_some()
    }

    /// Replaces the current transform; `transform` is from local to scene coordinates.
    pub fn set_transform(&mut self, transform: DAffine3) {
        if let Some(top) = self.stack.last_mut() {
            *top = Frame::new(transform, top.offset);
        }
    }

    /// Sets the material of the following triangles. Values out of range are clamped, with a warning.
    pub fn set_material(&mut self, material: Material) {
        let sound = |x: f32, most: f32| if x > 0.0 { x.min(most) } else { 0.0 };
        let colour = |c: Vec3| Vec3::from(c.to_array().map(|x| sound(x, 1e6)));
        let range = Material {
            ambient: colour(material.ambient),
            diffuse: colour(material.diffuse),
            specular: colour(material.specular),
            reflectivity: sound(material.reflectivity, 1.0),
            exponent: sound(material.exponent, 1e6),
            pad: 0.0,
        };
        if range != material {
            self.warnings.add("material with a value out of range: clamped");
        }
        if range != self.current {
            self.current = range;
            self.current_index = None;
        }
    }

    /// Adds a point light at a position in local coordinates. A light with a position or colour that is not finite in
    /// single precision is not added; the result is then the text of a warning.
    ///
    /// # Errors
    /// The limit of memory is exceeded.
    pub fn light(&mut self, position: DVec3, colour: DVec3) -> Result<Option<String>, Fault> {
        let position = (self.transform().transform_point3(position) - self.offset()).as_vec3();
        let colour = colour.as_vec3();
        if !position.is_finite() || !colour.is_finite() {
            return Ok(Some(format!("a light at {position} of colour {colour} is not finite: the light is ignored")));
        }
        self.limits.repeat(2 * size_of::<Light>())?;
        self.lights.push(Light::new(position, colour));
        Ok(None)
    }

    /// Number of triangles so far.
    pub fn triangles(&self) -> usize {
        self.triangles.len()
    }

    /// Reserves memory for a shape of about this size. It avoids that a vector doubles, for which it temporarily needs
    /// three times the memory of its content. Shapes smaller than the mesh so far do not benefit and are ignored.
    pub fn reserve(&mut self, vertices: usize, triangles: usize) {
        let bytes = vertices.saturating_mul(size_of::<Vertex>());
        let bytes = bytes.saturating_add(triangles.saturating_mul(size_of::<Triangle>()));
        if self.limits.have_room(bytes) && triangles >= self.triangles.len() {
            self.triangles.reserve_exact(triangles);
            self.vertices.reserve_exact(vertices);
        }
    }

    /// Begins a new shape, which shares no vertices with the previous ones.
    pub fn new_shape(&mut self) {
        self.shared.clear();
        self.unlisted = 0..0;
    }

    /// The index of a vertex, which is new or shared with an equal one of this shape. The normal may have any length;
    /// with a zero normal, shading uses the triangle's.
    ///
    /// # Errors
    /// The position exceeds single precision, or there are too many vertices.
    pub fn vertex(&mut self, position: DVec3, normal: DVec3) -> Result<u32, Fault> {
        self.shared_vertex(position, self.direction(normal))
    }

    /// Like [`MeshBuilder::vertex`], with a normal that [`MeshBuilder::direction`] has transformed.
    fn shared_vertex(&mut self, position: DVec3, normal: Vec3) -> Result<u32, Fault> {
        let vertex = self.frame().place(position, normal)?;
        let MeshBuilder { shared, vertices, limits, unlisted, .. } = self;
        std::mem::take(unlisted).for_each(|index| shared.list(index as u32, vertices));
        let held = shared.bytes();
        shared.find_or(&vertex, vertices, |vertices| store(vertices, vertex, limits, held))
    }

    /// Like [`MeshBuilder::shared_vertex`], in a shape of few vertices, none of which is in the tables.
    fn unlisted_vertex(&mut self, position: DVec3, normal: Vec3) -> Result<u32, Fault> {
        let vertex = self.frame().place(position, normal)?;
        let same = |&index: &usize| shared::bits(&self.vertices[index]) == shared::bits(&vertex);
        if let Some(index) = self.unlisted.clone().find(same) {
            return Ok(index as u32);
        }
        let index = store(&mut self.vertices, vertex, &mut self.limits, self.shared.bytes())?;
        let begin = if self.unlisted.is_empty() { index as usize } else { self.unlisted.start };
        self.unlisted = begin..index as usize + 1;
        Ok(index)
    }

    /// Like [`MeshBuilder::vertex`], for a mesh with indices: exactly the corners with the same two indices share a
    /// vertex.
    ///
    /// # Errors
    /// As [`MeshBuilder::vertex`].
    pub fn indexed_vertex(&mut self, indices: [u32; 2], position: DVec3, normal: DVec3) -> Result<u32, Fault> {
        if let Some(index) = self.shared.find_indices(indices) {
            return Ok(index);
        }
        let vertex = self.frame().place(position, self.direction(normal))?;
        let index = store(&mut self.vertices, vertex, &mut self.limits, self.shared.bytes())?;
        self.shared.insert_indices(indices, index);
        Ok(index)
    }

    /// See [`Frame::direction`].
    fn direction(&self, normal: DVec3) -> Vec3 {
        self.frame().direction(normal)
    }

    /// Drops and counts a face or surface unless it is `finite`; returns `finite`.
    #[inline]
    pub fn keep_if(&mut self, finite: bool) -> bool {
        if !finite {
            self.not_finite.add_face();
        }
        finite
    }

    /// Adds a triangle; its vertices are counter-clockwise, seen from outside.
    ///
    /// # Errors
    /// There are too many triangles.
    pub fn triangle(&mut self, [a, b, c]: [u32; 3]) -> Result<(), Fault> {
        self.limits.elements(self.triangles.len())?;
        self.limits.repeat(2 * size_of::<Triangle>())?;
        let vertices = if self.frame().mirrored { [a, c, b] } else { [a, b, c] };
        let material = self.material_index()?;
        self.triangles.push(Triangle { vertices, material });
        Ok(())
    }

    /// The index of the current material, which is added to the list if necessary.
    fn material_index(&mut self) -> Result<u32, Fault> {
        if let Some(index) = self.current_index {
            return Ok(index);
        }
        let words: [u32; 12] = bytemuck::cast(self.current);
        let next = self.materials.len() as u32;
        let index = *self.known.entry(words).or_insert(next);
        if index == next {
            // A material is stored in the list and in the map.
            self.limits.repeat(4 * size_of::<Material>())?;
            self.materials.push(self.current);
        }
        self.current_index = Some(index);
        Ok(index)
    }

    /// The scene with the mesh, its materials, lights and warnings.
    pub fn finish(self) -> Scene {
        let placement = Placement { offset: self.offset(), exponent: 0 };
        let MeshBuilder { mut vertices, mut triangles, materials, lights, warnings, not_finite, shared, .. } = self;
        // This is released before the vectors are copied to vectors of their exact size.
        drop(shared);
        vertices.shrink_to_fit();
        triangles.shrink_to_fit();
        let warnings = not_finite.warning().into_iter().chain(warnings.lines()).collect();
        Scene { vertices, triangles, materials, lights, warnings, placement, ..Scene::default() }
    }
}

const FINITE: &str = "move the scene closer to its origin, or repair its transforms";

/// Adds a vertex, if the memory of the vertices and of the tables, `held`, is within the limits.
fn store(vertices: &mut Vec<Vertex>, vertex: Vertex, limits: &mut Limits, held: usize) -> Result<u32, Fault> {
    let index = vertices.len();
    limits.elements(index)?;
    limits.repeat(2 * size_of::<Vertex>())?;
    limits.check_room(held)?;
    vertices.push(vertex);
    Ok(index as u32)
}

/// The unit vector of that direction; zero for a vector without direction.
pub(super) fn unit(v: DVec3) -> DVec3 {
    unit_if_in_range(v)
        .unwrap_or_else(|| if has_direction(v) { (v / v.abs().max_element()).normalize_or_zero() } else { DVec3::ZERO })
}

/// The unit vector, if the squared length is well inside the range of doubles, as it nearly always is.
#[inline]
fn unit_if_in_range(v: DVec3) -> Option<DVec3> {
    let square = v.length_squared();
    (1e-200..1e200).contains(&square).then(|| v * square.sqrt().recip())
}

#[cfg(test)]
mod tests;
