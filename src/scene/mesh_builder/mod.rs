//! A mesh as readers of scene files put it together: a stack of transforms, a current material, polygons and curved
//! surfaces, and limits on what a file may grow into.
//!
//! A vertex has one normal (SPEC section 1). Corners with the same position and normal share a vertex within a *shape*
//! (see [`MeshBuilder::new_shape`]), so that a smooth surface is indexed and a sharp edge has its vertices twice. Only a mesh
//! of nothing but flat faces is not searched for such corners, except in neighbours ([`MeshBuilder::flat_polygon`]).

mod curves;
mod limits;
mod polygons;
mod revolve;
mod shared;
mod warnings;

use super::placement::MAX_COORDINATE;
use super::polygon::Triangulator;
use super::text::Fault;
use super::{Light, Material, Placement, Scene, Triangle};
use crate::math::Vertex;
use foldhash::fast::RandomState;
use glam::{DAffine3, DMat3, DVec3, Vec3};
pub use limits::Limits;
use polygons::has_direction;
use revolve::Turns;
use shared::Shared;
use std::collections::HashMap;
use std::ops::Range;
pub use warnings::Warnings;

/// Most transforms inside each other.
const MAX_DEPTH: usize = 1000;

/// Builds a scene's mesh.
pub struct MeshBuilder {
    vertices: Vec<Vertex>,
    triangles: Vec<Triangle>,
    materials: Vec<Material>,
    lights: Vec<Light>,
    /// The shape's vertices.
    shared: Shared,
    /// Those of the shape's vertices that are not among them yet, for nobody has searched: a curved surface makes its own,
    /// and so does a plane's first polygon.
    unlisted: Range<usize>,
    /// What curved surfaces of as many segments have in common.
    turns: Turns,
    /// Normal of the flat polygon that began the shape.
    flat: Vec3,
    /// Materials by their bits.
    known: HashMap<[u32; 12], u32, RandomState>,
    current: Material,
    /// Index of the current material, once a triangle has it.
    current_index: Option<u32>,
    stack: Vec<Frame>,
    triangulator: Triangulator,
    corners: Vec<u32>,
    limits: Limits,
    /// What the user is told.
    pub warnings: Warnings,
}

/// A transform with what follows from it.
#[derive(Clone, Copy)]
struct Frame {
    affine: DAffine3,
    /// For normals: the inverse transpose but for its length, and good for singular matrices of rank two as well.
    normals: DMat3,
    /// True if it turns left into right.
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

    /// A vertex where the transform puts it, rounded once it is near the origin; the normal is one that
    /// [`Frame::direction`] has turned.
    #[inline(always)]
    fn place(&self, position: DVec3, normal: Vec3) -> Result<Vertex, Fault> {
        let position = self.affine.transform_point3(position);
        // Adding zero makes -0 and 0 the same vertex
        let placed = (position - self.offset).as_vec3() + Vec3::ZERO;
        let within = position.abs().cmple(DVec3::splat(MAX_COORDINATE)).all();
        if within { Ok(Vertex::new(placed, normal)) } else { Err(too_far(position)) }
    }

    /// A normal of any length as the transform turns it, of length one or zero.
    #[inline(always)]
    fn direction(&self, normal: DVec3) -> Vec3 {
        let turned = unit_if_easy(self.normals * normal).unwrap_or_else(|| unit(self.normals * unit(normal)));
        turned.as_vec3() + Vec3::ZERO
    }
}

#[cold]
fn too_far(position: DVec3) -> Fault {
    let problem = match position.as_vec3().is_finite() {
        true => format!("a corner at {position} lies beyond 1e18"),
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
            turns: Turns::default(),
            flat: Vec3::ZERO,
            known: HashMap::default(),
            current: Material::neutral(),
            current_index: None,
            stack: vec![Frame::new(DAffine3::IDENTITY, DVec3::ZERO)],
            triangulator: Triangulator::default(),
            corners: Vec::new(),
            limits: Limits::default(),
            warnings: Warnings::default(),
        }
    }
}

impl MeshBuilder {
    /// A builder of a mesh whose origin in memory is this point of the file.
    pub fn new(offset: Option<DVec3>) -> MeshBuilder {
        let frame = Frame::new(DAffine3::IDENTITY, offset.unwrap_or(DVec3::ZERO));
        MeshBuilder { stack: vec![frame], ..MeshBuilder::default() }
    }

    /// The point of the file that is the origin in memory.
    pub fn offset(&self) -> DVec3 {
        self.frame().offset
    }

    /// Tells the size of a file that is being read: the mesh may grow with it. An included file counts once.
    pub fn read(&mut self, bytes: usize) {
        self.limits.read(bytes);
        self.triangulator.read(bytes);
    }

    /// Holds memory that a reader keeps of the file beside the mesh against the same limits.
    ///
    /// # Errors
    /// It is more than the file may take.
    pub fn charge(&mut self, bytes: usize) -> Result<(), Fault> {
        self.limits.grow(bytes)
    }

    /// Gives back memory that was charged.
    pub fn discharge(&mut self, bytes: usize) {
        self.limits.shrink(bytes);
    }

    /// The same for memory that a reader is about to take and will soon give back.
    ///
    /// # Errors
    /// It is more than the file may take.
    pub fn charge_for_now(&self, bytes: usize) -> Result<(), Fault> {
        self.limits.passing(bytes)
    }

    /// The transform from here to the scene.
    pub fn transform(&self) -> DAffine3 {
        self.frame().affine
    }

    fn frame(&self) -> &Frame {
        &self.stack[self.stack.len() - 1]
    }

    /// Applies a transform to what follows, inside the present one, until [`MeshBuilder::pop`].
    ///
    /// # Errors
    /// More than a thousand inside each other.
    pub fn push(&mut self, local: DAffine3) -> Result<(), Fault> {
        if self.stack.len() > MAX_DEPTH {
            let problem = format!("more than {MAX_DEPTH} transforms inside each other");
            return Err(Fault::new(None, problem, "flatten the file's hierarchy"));
        }
        self.stack.push(Frame::new(self.transform() * local, self.offset()));
        Ok(())
    }

    /// Ends what [`MeshBuilder::push`] began; false if there was nothing to end.
    pub fn pop(&mut self) -> bool {
        self.stack.len() > 1 && self.stack.pop().is_some()
    }

    /// Replaces the present transform by one from here to the scene.
    pub fn set_transform(&mut self, transform: DAffine3) {
        if let Some(top) = self.stack.last_mut() {
            *top = Frame::new(transform, top.offset);
        }
    }

    /// The material of what follows. What lies outside of a material's range is brought into it.
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
            self.warnings.add("material with a value out of its range: brought into it");
        }
        if range != self.current {
            self.current = range;
            self.current_index = None;
        }
    }

    /// Adds a point light, at a position inside the present transform.
    ///
    /// # Errors
    /// Position or colour are beyond single precision.
    pub fn light(&mut self, position: DVec3, colour: DVec3) -> Result<(), Fault> {
        let position = (self.transform().transform_point3(position) - self.offset()).as_vec3();
        let colour = colour.as_vec3();
        if !position.is_finite() || !colour.is_finite() {
            return Err(Fault::new(None, format!("a light at {position} of colour {colour} is not finite"), FINITE));
        }
        self.limits.grow(size_of::<Light>())?;
        self.lights.push(Light::new(position, colour));
        Ok(())
    }

    /// Number of lights so far.
    pub fn lights(&self) -> usize {
        self.lights.len()
    }

    /// Number of triangles so far.
    pub fn triangles(&self) -> usize {
        self.triangles.len()
    }

    /// Sets room aside for a shape of about so many vertices and triangles: a vector that doubles takes three times what it
    /// holds for a moment. Small shapes beside what is there already would only be slowed down, and have no need of it.
    pub fn make_room(&mut self, vertices: usize, triangles: usize) {
        let bytes = vertices.saturating_mul(size_of::<Vertex>());
        let bytes = bytes.saturating_add(triangles.saturating_mul(size_of::<Triangle>()));
        if self.limits.passing(bytes).is_ok() && triangles >= self.triangles.len() {
            self.triangles.reserve_exact(triangles);
            self.vertices.reserve_exact(vertices);
        }
    }

    /// Begins a shape: nothing that follows shares a vertex with what came before.
    pub fn new_shape(&mut self) {
        self.shared.clear();
        self.unlisted = 0..0;
    }

    /// The index of a vertex, new or shared with an equal one of this shape. The normal may have any length; zero stays
    /// zero, and is shaded with the triangle's own.
    ///
    /// # Errors
    /// The position is beyond single precision, or there are too many.
    pub fn vertex(&mut self, position: DVec3, normal: DVec3) -> Result<u32, Fault> {
        self.shared_vertex(position, self.direction(normal))
    }

    /// The same with a normal that [`MeshBuilder::direction`] has brought into the scene.
    fn shared_vertex(&mut self, position: DVec3, normal: Vec3) -> Result<u32, Fault> {
        let vertex = self.frame().place(position, normal)?;
        let MeshBuilder { shared, vertices, limits, unlisted, .. } = self;
        std::mem::take(unlisted).for_each(|index| shared.list(index as u32, vertices));
        let held = shared.bytes();
        shared.find_or(&vertex, vertices, |vertices| store(vertices, vertex, limits, held))
    }

    /// The same in a shape of few vertices, of which none is listed.
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

    /// The same for a mesh that has indices of its own: corners with the same two indices share a vertex, others do not.
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

    /// A normal of any length as the present transform turns it, of length one or zero.
    fn direction(&self, normal: DVec3) -> Vec3 {
        self.frame().direction(normal)
    }

    /// A triangle between vertices, counter-clockwise where it is seen from outside.
    ///
    /// # Errors
    /// There are too many.
    pub fn triangle(&mut self, [a, b, c]: [u32; 3]) -> Result<(), Fault> {
        self.limits.elements(self.triangles.len())?;
        self.limits.grow(size_of::<Triangle>())?;
        let vertices = if self.frame().mirrored { [a, c, b] } else { [a, b, c] };
        let material = self.material_index()?;
        self.triangles.push(Triangle { vertices, material });
        Ok(())
    }

    /// The index of the current material, which a triangle is about to have.
    fn material_index(&mut self) -> Result<u32, Fault> {
        if let Some(index) = self.current_index {
            return Ok(index);
        }
        let words: [u32; 12] = bytemuck::cast(self.current);
        let next = self.materials.len() as u32;
        let index = *self.known.entry(words).or_insert(next);
        if index == next {
            // Once in the list and once, with its index, in the map
            self.limits.grow(2 * size_of::<Material>())?;
            self.materials.push(self.current);
        }
        self.current_index = Some(index);
        Ok(index)
    }

    /// The mesh with its materials, lights and warnings.
    pub fn finish(self) -> Scene {
        let placement = Placement { offset: self.offset(), exponent: 0 };
        let MeshBuilder { mut vertices, mut triangles, materials, lights, warnings, shared, .. } = self;
        // Before the vectors are copied into smaller ones
        drop(shared);
        vertices.shrink_to_fit();
        triangles.shrink_to_fit();
        Scene { vertices, triangles, materials, lights, warnings: warnings.lines(), placement, ..Scene::default() }
    }
}

const FINITE: &str = "bring the scene closer to its origin, or repair its transforms";

/// Adds a vertex, if it and what the tables hold are within the limits.
fn store(vertices: &mut Vec<Vertex>, vertex: Vertex, limits: &mut Limits, held: usize) -> Result<u32, Fault> {
    let index = vertices.len();
    limits.elements(index)?;
    limits.grow(size_of::<Vertex>())?;
    limits.passing(held)?;
    vertices.push(vertex);
    Ok(index as u32)
}

/// A unit vector of that direction; zero for what has none.
pub(super) fn unit(v: DVec3) -> DVec3 {
    unit_if_easy(v)
        .unwrap_or_else(|| if has_direction(v) { (v / v.abs().max_element()).normalize_or_zero() } else { DVec3::ZERO })
}

/// The unit vector if squares are far from what doubles hold: most of them, and the quick way.
#[inline]
fn unit_if_easy(v: DVec3) -> Option<DVec3> {
    let square = v.length_squared();
    (1e-200..1e200).contains(&square).then(|| v * square.sqrt().recip())
}

#[cfg(test)]
mod tests;
