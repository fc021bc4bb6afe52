//! Traverses the nodes and builds the scene.

use super::buffers::Buffers;
use super::locals::Locals;
use super::memory::{is_surface, positions, too_much};
use super::{Problem, accessor, material};
use crate::math::Vertex;
use crate::scene::mesh_builder::Limits;
use crate::scene::{Light, Material, Options, Placement, Pose, Scene, SceneCamera, Triangle, lamps, normals};
use glam::{DMat3, DMat4, DVec3, Vec3};
use gltf::khr_lights_punctual::Kind;
use gltf::mesh::Mode;
use gltf::{Document, Node, Primitive};

/// The scene under construction, and the state of the traversal.
pub struct GltfReader<'a> {
    document: &'a Document,
    pub(super) buffers: &'a Buffers<'a>,
    pub(super) scene: Scene,
    pub(super) emission: Vec<Vec3>,
    /// Index of the material for primitives without one, once it is needed.
    default_material: Option<u32>,
    /// Position and power of point and spot lights.
    points: Vec<(Vec3, Vec3)>,
    /// Direction and power of directional lights.
    directions: Vec<(Vec3, Vec3)>,
    /// Number of primitives that are points or lines.
    no_surface: usize,
    /// True if there is an orthographic camera.
    orthographic: bool,
    /// True if there are skins or morph targets.
    deformed: bool,
    /// True if there are vertex colours.
    coloured: bool,
    /// Number of invalid normals that were computed instead.
    repaired: usize,
    pub(super) limits: Limits,
    /// Name of the requested camera; `None` requests the first.
    camera: Option<&'a str>,
    locals: Locals,
}

impl<'a> GltfReader<'a> {
    /// Converts the materials. `options` give the name of the camera and the origin in memory.
    pub fn new(
        document: &'a Document,
        buffers: &'a Buffers<'a>,
        limits: Limits,
        locals: Locals,
        options: &'a Options,
    ) -> GltfReader<'a> {
        let (materials, emission): (Vec<Material>, Vec<Vec3>) =
            document.materials().map(|m| material::convert(&m)).unzip();
        let placement = Placement { offset: options.offset.unwrap_or(DVec3::ZERO), exponent: 0 };
        let mut scene = Scene { materials, placement, ..Scene::default() };
        if document.materials().any(|m| material::has_texture(&m)) {
            scene.warnings.push("textures ignored: surfaces have their base colours".into());
        }
        if document.materials().any(|m| material::is_transparent(&m)) {
            scene.warnings.push("transparent material: rendered opaque".into());
        }
        GltfReader {
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
            coloured: false,
            repaired: 0,
            limits,
            camera: options.camera.as_deref(),
            locals,
        }
    }

    /// Converts a point of a node to the coordinates in memory.
    fn place(&self, world: &DMat4, point: DVec3) -> Vec3 {
        self.scene.placement.place(world.transform_point3(point))
    }

    /// Reads all nodes of the scene, parents before children, in file order.
    pub fn scene(&mut self) -> Result<(), Problem> {
        // The memory of the buffers, in addition to the file's bytes
        self.limits.grow(self.buffers.total()).map_err(too_much)?;
        let nodes = self.nodes()?;
        self.reserve(&nodes)?;
        nodes.iter().try_for_each(|(node, world)| self.node(node, world))
    }

    /// All nodes of the scene with their transforms to world space.
    fn nodes(&mut self) -> Result<Vec<(Node<'a>, DMat4)>, Problem> {
        let count = self.document.nodes().count();
        self.limits.keep(count * (2 * size_of::<(Node, DMat4)>() + 1)).map_err(too_much)?;
        let mut nodes = Vec::with_capacity(count);
        let mut pending = PendingNodes { stack: Vec::with_capacity(count), seen: vec![false; count] };
        match self.document.default_scene().or_else(|| self.document.scenes().next()) {
            Some(scene) => pending.push(scene.nodes(), DMat4::IDENTITY)?,
            None => {
                let mut child = vec![false; count];
                self.document.nodes().flat_map(|n| n.children()).for_each(|c| child[c.index()] = true);
                pending.push(self.document.nodes().filter(|n| !child[n.index()]), DMat4::IDENTITY)?;
            }
        }
        while let Some((node, parent)) = pending.stack.pop() {
            let world = parent * self.locals.of(&node);
            if !world.is_finite() {
                return Err((format!("node {} has a transform that is not finite", node.index()), "repair it"));
            }
            pending.push(node.children(), world)?;
            nodes.push((node, world));
        }
        Ok(nodes)
    }

    fn node(&mut self, node: &Node, world: &DMat4) -> Result<(), Problem> {
        if let Some(mesh) = node.mesh() {
            self.deformed |= node.skin().is_some();
            for primitive in mesh.primitives() {
                self.deformed |= primitive.morph_targets().next().is_some();
                self.primitive(&primitive, world)?;
            }
        }
        let wanted = |camera: &gltf::Camera| {
            let named = self.camera.is_none_or(|name| [camera.name(), node.name()].contains(&Some(name)));
            named && self.scene.camera.is_none()
        };
        if let Some(camera) = node.camera().filter(wanted) {
            match camera.projection() {
                gltf::camera::Projection::Perspective(lens) => self.camera(lens.yfov(), world),
                gltf::camera::Projection::Orthographic(_) => self.orthographic = true,
            }
        }
        if let Some(light) = node.light() {
            let power = Vec3::from(light.color()) * light.intensity();
            // Spot lights become point lights; the crate has refused those without a cone.
            if matches!(light.kind(), Kind::Directional) {
                self.directions.push((world.transform_vector3(DVec3::NEG_Z).as_vec3(), power));
            } else {
                self.points.push((self.place(world, DVec3::ZERO), power));
            }
        }
        Ok(())
    }

    fn camera(&mut self, field_of_view: f32, world: &DMat4) {
        let field_of_view = field_of_view.to_degrees();
        let position = self.place(world, DVec3::ZERO);
        let direction = world.transform_vector3(DVec3::NEG_Z).normalize_or_zero().as_vec3();
        let up = world.transform_vector3(DVec3::Y).normalize_or_zero().as_vec3();
        let looks = position.is_finite() && direction.cross(up).length() > 1e-3;
        if looks && field_of_view > 0.0 && field_of_view < 180.0 {
            let pose = Pose { time: 0.0, position, direction, up };
            self.scene.camera = Some(SceneCamera { field_of_view, frames: vec![pose] });
        } else {
            self.scene.warnings.push("the camera has no valid direction or field of view: ignored".into());
        }
    }

    /// Adds a primitive's triangles, transformed to world space.
    fn primitive(&mut self, primitive: &Primitive, world: &DMat4) -> Result<(), Problem> {
        if !is_surface(primitive.mode()) {
            self.no_surface += 1;
            return Ok(());
        }
        self.coloured |= primitive.get(&gltf::Semantic::Colors(0)).is_some();
        let positions = accessor::vectors(&positions(primitive)?, self.buffers)?;
        let given = match primitive.get(&gltf::Semantic::Normals) {
            Some(normals) => Some(accessor::vectors(&normals, self.buffers)?),
            None => None,
        };
        if given.as_ref().is_some_and(|given| given.len() != positions.len()) {
            return Err(("a primitive has different numbers of normals and positions".into(), "export the file again"));
        }
        let indices = match primitive.indices() {
            Some(indices) => accessor::indices(&indices, self.buffers)?,
            None => (0..positions.len() as u32).collect(),
        };
        if let Some(index) = indices.iter().find(|&&i| i as usize >= positions.len()) {
            let problem = format!("a primitive uses vertex {index} of {}", positions.len());
            return Err((problem, "export the file again"));
        }
        let material = self.material(primitive);
        let mut triangles = corners(primitive.mode(), &indices, material);
        drop(indices);
        let linear = DMat3::from_mat4(*world);
        if linear.determinant() < 0.0 {
            triangles.iter_mut().for_each(|t| t.vertices.swap(1, 2));
        }
        let first = self.scene.vertices.len();
        let placement = self.scene.placement;
        let place = |p: Vec3| placement.place(world.transform_point3(p.as_dvec3()));
        let vertices = &mut self.scene.vertices;
        match given {
            Some(given) => {
                // A singular transform makes all normals zero; they are then computed.
                let inverse = linear.inverse().transpose();
                let turn = |n: Vec3| (inverse * n.as_dvec3()).normalize_or_zero().as_vec3();
                vertices.extend(positions.iter().zip(given).map(|(&p, n)| Vertex::new(place(p), turn(n))));
                self.repaired += normals::normalise_or_smooth(&mut vertices[first..], &triangles);
            }
            None => {
                let corner = |v: u32| Vertex::new(place(positions[v as usize]), Vec3::ZERO);
                vertices.extend(triangles.iter().flat_map(|t| t.vertices).map(corner));
                for (triangle, v) in triangles.iter_mut().zip((0..).step_by(3)) {
                    triangle.vertices = [v, v + 1, v + 2];
                }
                normals::smooth(&mut vertices[first..], &triangles);
            }
        }
        let global = |t: &Triangle| Triangle { vertices: t.vertices.map(|v| v + first as u32), ..*t };
        self.scene.triangles.extend(triangles.iter().map(global));
        Ok(())
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

    /// Converts the lights and returns the scene.
    pub fn finish(mut self) -> Result<Scene, Problem> {
        if self.scene.triangles.is_empty() {
            return Err(("the scene has no triangles".into(), "export it as a mesh of triangles"));
        }
        if let Some(name) = self.camera.filter(|_| self.scene.camera.is_none()) {
            return Err((
                format!("there is no valid perspective camera `{name}`"),
                "give the name of a perspective camera",
            ));
        }
        self.lights();
        let mut warn = |warning: String| self.scene.warnings.push(warning);
        if self.no_surface > 0 {
            warn(format!("{} primitives that are points or lines ignored", self.no_surface));
        }
        if self.orthographic && self.scene.camera.is_none() {
            warn("orthographic camera ignored".into());
        }
        if self.coloured {
            warn("vertex colours ignored".into());
        }
        if self.deformed {
            warn("skins and morph targets ignored: meshes are in their rest pose".into());
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
        // Candela and lux are not comparable. If there are both kinds of lights, each kind gets half of the brightness.
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

/// The nodes that have not been visited yet.
struct PendingNodes<'a> {
    /// Nodes with the transform of their parent; the last one is visited next.
    stack: Vec<(Node<'a>, DMat4)>,
    /// For each node of the document, whether it has been pushed.
    seen: Vec<bool>,
}

impl<'a> PendingNodes<'a> {
    /// Pushes the children of a node with the transform `parent`.
    ///
    /// # Errors
    /// A node was pushed before: the nodes must be a tree, otherwise the traversal could take unlimited time.
    fn push(&mut self, nodes: impl Iterator<Item = Node<'a>>, parent: DMat4) -> Result<(), Problem> {
        let first = self.stack.len();
        for node in nodes {
            if std::mem::replace(&mut self.seen[node.index()], true) {
                let problem = format!("node {} has two parents or is its own ancestor", node.index());
                return Err((problem, "the nodes must be a tree: export the file again"));
            }
            self.stack.push((node, parent));
        }
        self.stack[first..].reverse();
        Ok(())
    }
}

/// The triangles of a list, strip or fan, with consistent winding; an incomplete triangle at the end is dropped.
fn corners(mode: Mode, i: &[u32], material: u32) -> Vec<Triangle> {
    let all = i.len().saturating_sub(2);
    let triangle = |vertices| Triangle { vertices, material };
    match mode {
        Mode::TriangleStrip => (0..all)
            .map(|k| if k % 2 == 0 { [i[k], i[k + 1], i[k + 2]] } else { [i[k + 1], i[k], i[k + 2]] })
            .map(triangle)
            .collect(),
        Mode::TriangleFan => (0..all).map(|k| [i[0], i[k + 1], i[k + 2]]).map(triangle).collect(),
        _ => i.as_chunks().0.iter().copied().map(triangle).collect(),
    }
}
