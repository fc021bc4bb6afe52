//! The walk over the nodes, which collects the scene.

use super::buffers::Buffers;
use super::{Fault, accessor, material};
use crate::math::Vertex;
use crate::scene::mesh_builder::Limits;
use crate::scene::text;
use crate::scene::{Light, MAX_ELEMENTS, Material, Pose, Scene, SceneCamera, Triangle, lamps, normals};
use glam::{DMat3, DMat4, DVec3, Mat4, Vec3};
use gltf::khr_lights_punctual::Kind;
use gltf::mesh::Mode;
use gltf::{Document, Node, Primitive};

/// What has been collected.
pub struct Walk<'a> {
    document: &'a Document,
    buffers: &'a Buffers<'a>,
    scene: Scene,
    emission: Vec<Vec3>,
    /// Index of the material without an entry in the file.
    default_material: Option<u32>,
    /// Position and power of point and spot lights, direction and power of directional ones.
    points: Vec<(Vec3, Vec3)>,
    directions: Vec<(Vec3, Vec3)>,
    /// Primitives that are points or lines.
    no_surface: usize,
    orthographic: bool,
    deformed: bool,
    repaired: usize,
    limits: Limits,
}

impl<'a> Walk<'a> {
    /// Begins with the materials.
    pub fn new(document: &'a Document, buffers: &'a Buffers<'a>, limits: Limits) -> Walk<'a> {
        let (materials, emission): (Vec<Material>, Vec<Vec3>) =
            document.materials().map(|m| material::convert(&m)).unzip();
        let mut scene = Scene { materials, ..Scene::default() };
        if document.materials().any(|m| material::has_texture(&m)) {
            scene.warnings.push("textures are left out: surfaces have their plain colours".into());
        }
        Walk {
            document,
            buffers,
            scene,
            emission,
            default_material: None,
            points: Vec::new(),
            directions: Vec::new(),
            no_surface: 0,
            orthographic: false,
            deformed: false,
            repaired: 0,
            limits,
        }
    }

    /// Goes over all nodes of the scene, parents before children, in file order.
    pub fn scene(&mut self) -> Result<(), Fault> {
        // What the buffers take beside the file's own bytes
        self.limits.grow(self.buffers.total()).map_err(too_much)?;
        let scene = self.document.default_scene().or_else(|| self.document.scenes().next());
        let mut stack: Vec<(Node, DMat4)> = match scene {
            Some(scene) => scene.nodes().map(|node| (node, DMat4::IDENTITY)).collect(),
            None => {
                let mut child = vec![false; self.document.nodes().count()];
                self.document.nodes().flat_map(|n| n.children()).for_each(|c| child[c.index()] = true);
                self.document.nodes().filter(|n| !child[n.index()]).map(|node| (node, DMat4::IDENTITY)).collect()
            }
        };
        stack.reverse();
        let mut seen = vec![false; self.document.nodes().count()];
        while let Some((node, parent)) = stack.pop() {
            // A tree is what the format demands; a loop would never end.
            if std::mem::replace(&mut seen[node.index()], true) {
                let problem = format!("node {} has two parents or is its own ancestor", node.index());
                return Err((problem, "the nodes must be a tree: export the file again"));
            }
            let world = parent * Mat4::from_cols_array_2d(&node.transform().matrix()).as_dmat4();
            if !world.is_finite() {
                return Err((format!("node {} has a transform that is not finite", node.index()), "repair it"));
            }
            self.node(&node, &world)?;
            let first = stack.len();
            stack.extend(node.children().map(|child| (child, world)));
            stack[first..].reverse();
        }
        Ok(())
    }

    fn node(&mut self, node: &Node, world: &DMat4) -> Result<(), Fault> {
        if let Some(mesh) = node.mesh() {
            self.deformed |= node.skin().is_some();
            for primitive in mesh.primitives() {
                self.deformed |= primitive.morph_targets().next().is_some();
                self.primitive(&primitive, world)?;
            }
        }
        if let Some(camera) = node.camera().filter(|_| self.scene.camera.is_none()) {
            match camera.projection() {
                gltf::camera::Projection::Perspective(lens) => self.camera(lens.yfov(), world),
                gltf::camera::Projection::Orthographic(_) => self.orthographic = true,
            }
        }
        if let Some(light) = node.light() {
            let power = Vec3::from(light.color()) * light.intensity();
            // The crate has refused spots without their cone.
            if matches!(light.kind(), Kind::Directional) {
                self.directions.push((world.transform_vector3(DVec3::NEG_Z).as_vec3(), power));
            } else {
                self.points.push((world.transform_point3(DVec3::ZERO).as_vec3(), power));
            }
        }
        Ok(())
    }

    fn camera(&mut self, field_of_view: f32, world: &DMat4) {
        let field_of_view = field_of_view.to_degrees();
        let position = world.transform_point3(DVec3::ZERO).as_vec3();
        let direction = world.transform_vector3(DVec3::NEG_Z).normalize_or_zero().as_vec3();
        let up = world.transform_vector3(DVec3::Y).normalize_or_zero().as_vec3();
        let looks = position.is_finite() && direction.cross(up).length() > 1e-3;
        if looks && field_of_view > 0.0 && field_of_view < 180.0 {
            let pose = Pose { time: 0.0, position, direction, up };
            self.scene.camera = Some(SceneCamera { field_of_view, frames: vec![pose] });
        } else {
            self.scene.warnings.push("the camera cannot look: it is left out".into());
        }
    }

    /// Adds a primitive's triangles, at their place in the world.
    fn primitive(&mut self, primitive: &Primitive, world: &DMat4) -> Result<(), Fault> {
        if matches!(primitive.mode(), Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip) {
            self.no_surface += 1;
            return Ok(());
        }
        let Some(positions) = primitive.get(&gltf::Semantic::Positions) else {
            return Err(("a primitive has no positions".into(), "export the file again"));
        };
        accessor::check(&positions, self.buffers)?;
        if let Some(indices) = primitive.indices() {
            accessor::check_indices(&indices, self.buffers)?;
        }
        self.hold(primitive, positions.count())?;
        let positions = accessor::vectors(&positions, self.buffers)?;
        let given = match primitive.get(&gltf::Semantic::Normals) {
            Some(normals) => Some(accessor::vectors(&normals, self.buffers)?),
            None => None,
        };
        if given.as_ref().is_some_and(|given| given.len() != positions.len()) {
            return Err(("a primitive has not as many normals as positions".into(), "export the file again"));
        }
        let indices = match primitive.indices() {
            Some(indices) => accessor::indices(&indices, self.buffers)?,
            None => (0..positions.len() as u32).collect(),
        };
        if let Some(index) = indices.iter().find(|&&i| i as usize >= positions.len()) {
            let problem = format!("a primitive uses vertex {index} of {}", positions.len());
            return Err((problem, "export the file again"));
        }
        let mut triangles = corners(primitive.mode(), &indices);
        let linear = DMat3::from_mat4(*world);
        let mirrored = linear.determinant() < 0.0;
        if mirrored {
            triangles.iter_mut().for_each(|t| t.swap(1, 2));
        }
        let new = if given.is_some() { positions.len() } else { 3 * triangles.len() };
        if self.scene.vertices.len() + new > MAX_ELEMENTS || self.scene.triangles.len() + triangles.len() > MAX_ELEMENTS
        {
            let problem = format!("there are more than {MAX_ELEMENTS} triangles or vertices, instances counted");
            return Err((problem, "simplify the scene"));
        }
        let material = self.material(primitive);
        let first = self.scene.vertices.len() as u32;
        let place = |p: Vec3| world.transform_point3(p.as_dvec3()).as_vec3();
        let mut vertices: Vec<Vertex>;
        match given {
            Some(given) => {
                // Of a flattening transform no normal is left: they are computed.
                let inverse = linear.inverse().transpose();
                let turn = |n: Vec3| (inverse * n.as_dvec3()).normalize_or_zero().as_vec3();
                vertices = positions.iter().zip(given).map(|(&p, n)| Vertex::new(place(p), turn(n))).collect();
            }
            None => {
                let corner = |i: u32| Vertex::new(place(positions[i as usize]), Vec3::ZERO);
                vertices = triangles.iter().flatten().map(|&i| corner(i)).collect();
                triangles = (0..triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
            }
        }
        let local: Vec<Triangle> = triangles.iter().map(|&vertices| Triangle { vertices, material }).collect();
        let has_normals = new == positions.len() && primitive.get(&gltf::Semantic::Normals).is_some();
        let repaired = normals::normalise_or_smooth(&mut vertices, &local);
        self.repaired += if has_normals { repaired } else { 0 };
        self.scene.vertices.append(&mut vertices);
        let global = |t: &Triangle| Triangle { vertices: t.vertices.map(|v| v + first), ..*t };
        self.scene.triangles.extend(local.iter().map(global));
        Ok(())
    }

    /// Holds what a primitive needs of memory against what its file may take: every node that shows a mesh has a copy.
    fn hold(&mut self, primitive: &Primitive, positions: usize) -> Result<(), Fault> {
        let corners = primitive.indices().map_or(positions, |indices| indices.count());
        let triangles = if primitive.mode() == Mode::Triangles { corners / 3 } else { corners };
        let flat = primitive.get(&gltf::Semantic::Normals).is_none();
        let vertices = if flat { triangles.saturating_mul(3) } else { positions };
        // Indices, and triangles three times: of the file, of this primitive, with their material
        let triangles_now = triangles.saturating_mul(2 * size_of::<[u32; 3]>() + size_of::<Triangle>());
        // Vertices with and without their normals computed, and what must be computed
        let vertices_now = vertices.saturating_mul(2 * size_of::<Vertex>() + size_of::<usize>());
        let read = positions.saturating_mul(2 * size_of::<Vec3>()).saturating_add(corners.saturating_mul(4));
        let now = triangles_now.saturating_add(vertices_now).saturating_add(read);
        self.limits.passing(now).map_err(too_much)?;
        let shines = primitive.material().index().is_some_and(|i| self.emission[i] != Vec3::ZERO);
        let lamps = if shines { triangles.saturating_mul(lamps::BYTES) } else { 0 };
        let kept = vertices * size_of::<Vertex>() + triangles * size_of::<Triangle>();
        self.limits.grow(kept.saturating_add(lamps)).map_err(too_much)
    }

    fn material(&mut self, primitive: &Primitive) -> u32 {
        match primitive.material().index() {
            Some(index) => index as u32,
            None => *self.default_material.get_or_insert_with(|| {
                self.scene.materials.push(Material::neutral());
                self.emission.push(Vec3::ZERO);
                self.scene.materials.len() as u32 - 1
            }),
        }
    }

    /// The scene, with its lights.
    pub fn finish(mut self) -> Result<Scene, Fault> {
        if self.scene.triangles.is_empty() {
            return Err(("the scene shows no triangle".into(), "export it as a mesh of triangles"));
        }
        self.lights();
        let mut warn = |warning: String| self.scene.warnings.push(warning);
        if self.no_surface > 0 {
            warn(format!("{} primitives that are points or lines skipped", self.no_surface));
        }
        if self.orthographic && self.scene.camera.is_none() {
            warn("the camera is orthographic: it is left out".into());
        }
        if self.deformed {
            warn("skins and morph targets are left out: meshes stand in their rest pose".into());
        }
        if self.repaired > 0 {
            warn(format!("{} normals in the file are zero or not finite: computed instead", self.repaired));
        }
        Ok(self.scene)
    }

    fn lights(&mut self) {
        let bounds = self.scene.bounds();
        let far = bounds.diagonal() * 10.0;
        let from = |d: Vec3| bounds.center() - d.normalize_or_zero() * far;
        // Candela and lux cannot be compared: each kind has its half where there are both.
        let share = if self.points.is_empty() || self.directions.is_empty() { 1.0 } else { 0.5 };
        let directions: Vec<(Vec3, Vec3)> = self.directions.iter().map(|&(d, power)| (from(d), power)).collect();
        for group in [&self.points, &directions] {
            let brightest = group.iter().map(|(_, power)| *power).sum::<Vec3>().max_element();
            let lights = group.iter().map(|&(position, power)| Light::new(position, power * share / brightest));
            self.scene.lights.extend(lights.filter(|l| l.position.is_finite() && l.colour.is_finite()));
        }
        if self.scene.lights.is_empty() {
            self.scene.lights = lamps::lights(&self.scene.vertices, &self.scene.triangles, &self.emission);
        }
    }
}

/// The file needs more memory than it may take.
fn too_much(fault: text::Fault) -> Fault {
    (fault.problem, "do many nodes show the same mesh? Show it less often, or simplify it")
}

/// Triangles of a list, strip or fan, all wound the same way; an incomplete one at the end is dropped.
fn corners(mode: Mode, i: &[u32]) -> Vec<[u32; 3]> {
    let all = i.len().saturating_sub(2);
    match mode {
        Mode::TriangleStrip => {
            (0..all).map(|k| if k % 2 == 0 { [i[k], i[k + 1], i[k + 2]] } else { [i[k + 1], i[k], i[k + 2]] }).collect()
        }
        Mode::TriangleFan => (0..all).map(|k| [i[0], i[k + 1], i[k + 2]]).collect(),
        _ => i.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
    }
}
