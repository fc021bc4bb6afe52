//! Builds the scene: materials, and the triangles of every instance of a mesh.

use super::accessor::{Accessors, Use};
use super::json::{Json, List, Loose, Whole};
use super::lights::{Camera, PunctualLight, PunctualLights};
use super::material::GltfMaterial;
use super::nodes::PlacedMesh;
use super::notes::Notes;
use super::schema::{Mesh, Primitive, Root};
use super::shape::Shape;
use crate::math::Vertex;
use crate::scene::mesh_builder::Limits;
use crate::scene::text::Fault;
use crate::scene::{Material, Options, Placement, Scene, Triangle, normals};
use foldhash::fast::RandomState;
use glam::{DMat3, DMat4, DQuat, DVec3, Vec3};
use std::collections::HashMap;
use std::rc::Rc;

/// The lists of the JSON that nodes refer to.
pub struct Lists<'a> {
    pub nodes: List<'a>,
    pub meshes: List<'a>,
    pub cameras: List<'a>,
    pub lights: List<'a>,
}

/// The scene under construction, and the state of the traversal.
pub struct GltfReader<'a> {
    pub(super) json: Json<'a>,
    pub(super) root: &'a Root<'a>,
    pub(super) lists: Lists<'a>,
    pub(super) accessors: Accessors<'a>,
    pub(super) meshes: HashMap<usize, Rc<Mesh<'a>>, RandomState>,
    pub(super) scene: Scene,
    /// Emission of each material.
    pub(super) emission: Vec<Vec3>,
    /// Number of materials in the file.
    materials: usize,
    /// Index of the material for primitives without one, once it is needed.
    default_material: Option<u32>,
    pub(super) lights: PunctualLights,
    pub(super) notes: Notes,
    pub(super) limits: Limits,
    /// Name of the requested camera; `None` requests the first.
    pub(super) camera: Option<&'a str>,
    /// The problems of accessors that cannot be read as normals.
    pub(super) bad_normals: HashMap<usize, String, RandomState>,
    pub(super) known_cameras: HashMap<usize, Option<Camera<'a>>, RandomState>,
    pub(super) known_lights: HashMap<usize, Option<PunctualLight>, RandomState>,
}

impl<'a> GltfReader<'a> {
    /// `options` give the name of the camera and the origin in memory.
    pub fn new(
        (json, root): (Json<'a>, &'a Root<'a>),
        lists: Lists<'a>,
        accessors: Accessors<'a>,
        limits: Limits,
        options: &'a Options,
    ) -> GltfReader<'a> {
        let placement = Placement { offset: options.offset.unwrap_or(DVec3::ZERO), exponent: 0 };
        GltfReader {
            json,
            root,
            lists,
            accessors,
            meshes: HashMap::default(),
            scene: Scene { placement, ..Scene::default() },
            emission: Vec::new(),
            materials: 0,
            default_material: None,
            lights: PunctualLights::default(),
            notes: Notes::default(),
            limits,
            camera: options.camera.as_deref(),
            bad_normals: HashMap::default(),
            known_cameras: HashMap::default(),
            known_lights: HashMap::default(),
        }
    }

    /// Converts a point of a node to the coordinates in memory.
    pub(super) fn place(&self, world: &DMat4, point: DVec3) -> Vec3 {
        self.scene.placement.place(world.transform_point3(point))
    }

    /// Converts the materials. One that is malformed becomes the neutral material, with a warning.
    pub fn materials(&mut self) -> Result<(), Fault> {
        let materials = match self.json.list("materials", "material", self.root.materials) {
            Ok(materials) => materials,
            Err(fault) => {
                self.notes.malformed(|| fault.problem);
                return Ok(());
            }
        };
        self.materials = materials.len();
        self.limits.keep(self.materials * (size_of::<Material>() + size_of::<Vec3>()))?;
        // One more for primitives without a material
        self.scene.materials.reserve_exact(self.materials + 1);
        self.emission.reserve_exact(self.materials + 1);
        let (mut textures, mut transparent) = (false, false);
        for index in 0..self.materials {
            let (material, emission) = match materials.parse::<GltfMaterial>(index) {
                Some(material) => {
                    textures |= material.has_texture();
                    transparent |= material.is_transparent();
                    material.convert()
                }
                None => {
                    self.notes.malformed(|| materials.problem::<GltfMaterial>(index, ""));
                    (Material::neutral(), Vec3::ZERO)
                }
            };
            self.scene.materials.push(material);
            self.emission.push(emission);
        }
        if textures {
            self.scene.warnings.push("textures ignored: surfaces have their base colours".into());
        }
        if transparent {
            self.scene.warnings.push("transparent material: rendered opaque".into());
        }
        Ok(())
    }

    /// Reads all meshes of the scene, in the order of the nodes.
    pub fn scene(&mut self) -> Result<(), Fault> {
        let placed = self.nodes()?;
        self.reserve(&placed)?;
        for place in &placed {
            let mesh = self.mesh(place)?;
            let weights = self.weights(place, &mesh)?;
            let instances = self.instances(place)?;
            for primitive in &mesh.primitives.surfaces {
                self.notes.coloured |= primitive.coloured;
                let material = self.material(place.mesh, primitive);
                let shape = self.shape(place.mesh, primitive, &weights, material)?;
                match &instances {
                    None => self.add(&shape, &place.world),
                    Some(instances) => instances.iter().for_each(|world| self.add(&shape, world)),
                }
            }
        }
        Ok(())
    }

    /// The transforms of a node's instances to the scene; `None` if the node itself is the only one.
    fn instances(&mut self, place: &PlacedMesh) -> Result<Option<Vec<DMat4>>, Fault> {
        let Some(attributes) = &place.instances else { return Ok(None) };
        let GltfReader { accessors, limits, .. } = self;
        let mut vectors = |index: Option<Whole>| -> Result<Option<Vec<Vec3>>, Fault> {
            let Some(Whole(index)) = index else { return Ok(None) };
            let accessor = accessors.get(index, Use::Vectors, "an instance", limits)?;
            accessors.vectors(accessor, limits).map(Some)
        };
        let (translations, scales) = (vectors(attributes.translation)?, vectors(attributes.scale)?);
        let rotations = match attributes.rotation {
            Some(Whole(index)) => {
                let accessor = accessors.get(index, Use::Rotations, "an instance", limits)?;
                Some(accessors.rotations(accessor, limits)?)
            }
            None => None,
        };
        let lengths = [translations.as_ref().map(Vec::len), scales.as_ref().map(Vec::len)];
        let count = lengths.into_iter().flatten().next().or(rotations.as_ref().map(Vec::len)).unwrap_or(0);
        let at = |vectors: &Option<Vec<Vec3>>, i: usize, default| vectors.as_ref().map_or(default, |v| v[i].as_dvec3());
        let mut worlds = Vec::with_capacity(count);
        for i in 0..count {
            let turn = rotations.as_ref().map_or(DQuat::IDENTITY, |rotations| rotations[i]);
            let (scale, translation) = (at(&scales, i, DVec3::ONE), at(&translations, i, DVec3::ZERO));
            let world = place.world * DMat4::from_scale_rotation_translation(scale, turn, translation);
            if !world.is_finite() {
                let problem = format!("instance {i} of node {} has a transform that is not finite", place.node);
                return Err(Fault::new(None, problem, "repair it"));
            }
            worlds.push(world);
        }
        Ok(Some(worlds))
    }

    /// Adds a shape, transformed to the scene.
    fn add(&mut self, shape: &Shape, world: &DMat4) {
        let Shape { positions, normals: given, triangles } = shape;
        let linear = DMat3::from_mat4(*world);
        let mirrored = linear.determinant() < 0.0;
        let wound = |[a, b, c]: [u32; 3]| if mirrored { [a, c, b] } else { [a, b, c] };
        let (first, begin) = (self.scene.vertices.len(), self.scene.triangles.len());
        let placement = self.scene.placement;
        let place = |p: Vec3| placement.place(world.transform_point3(p.as_dvec3()));
        let Scene { vertices, triangles: all, .. } = &mut self.scene;
        match given {
            Some(given) => {
                // A singular transform makes all normals zero; they are then computed.
                let inverse = linear.inverse().transpose();
                let turn = |n: Vec3| (inverse * n.as_dvec3()).normalize_or_zero().as_vec3();
                vertices.extend(positions.iter().zip(given).map(|(&p, &n)| Vertex::new(place(p), turn(n))));
                all.extend(triangles.iter().map(|t| Triangle { vertices: wound(t.vertices), ..*t }));
                self.notes.repaired += normals::normalise_or_smooth(&mut vertices[first..], &all[begin..]);
            }
            None => {
                let corner = |v: u32| Vertex::new(place(positions[v as usize]), Vec3::ZERO);
                vertices.extend(triangles.iter().flat_map(|t| wound(t.vertices)).map(corner));
                let numbered = triangles.iter().zip((0..).step_by(3));
                all.extend(numbered.map(|(t, v)| Triangle { vertices: [v, v + 1, v + 2], ..*t }));
                normals::smooth(&mut vertices[first..], &all[begin..]);
            }
        }
        all[begin..].iter_mut().for_each(|t| t.vertices = t.vertices.map(|v| v + first as u32));
    }

    /// The index of a primitive's material in the file, if it has a valid one.
    pub(super) fn material_of(&self, primitive: &Primitive) -> Option<usize> {
        match primitive.material {
            Loose::Given(Whole(index)) => Some(index).filter(|&index| index < self.materials),
            Loose::Absent | Loose::Malformed => None,
        }
    }

    /// The index of a primitive's material in the scene.
    fn material(&mut self, mesh: usize, primitive: &Primitive) -> u32 {
        if let Some(index) = self.material_of(primitive) {
            return index as u32;
        }
        if primitive.material != Loose::Absent {
            self.notes.malformed(|| {
                format!("meshes[{mesh}].primitives[{}] has a material that does not exist", primitive.index)
            });
        }
        *self.default_material.get_or_insert_with(|| {
            self.scene.materials.push(Material::neutral());
            self.emission.push(Vec3::ZERO);
            self.scene.materials.len() as u32 - 1
        })
    }

    /// Converts the lights and returns the scene.
    pub fn finish(mut self) -> Result<Scene, Fault> {
        self.scene.warnings.extend(self.notes.warnings(self.scene.camera.is_some()));
        if self.scene.triangles.is_empty() {
            let mut problem = "the scene has no triangles".to_owned();
            if !self.scene.warnings.is_empty() {
                problem += &format!(": {}", self.scene.warnings.join(", "));
            }
            return Err(Fault::new(None, problem, "export it as a mesh of triangles"));
        }
        if let Some(name) = self.camera.filter(|_| self.scene.camera.is_none()) {
            let problem = format!("there is no valid perspective camera `{}`", super::shown(name, 80));
            return Err(Fault::new(None, problem, "give the name of a perspective camera"));
        }
        self.lights.add_to(&mut self.scene, &self.emission);
        Ok(self.scene)
    }
}
