//! Traverses the nodes: the meshes with their transforms, the camera and the lights.

use super::json::{Indices, Whole};
use super::reader::GltfReader;
use super::schema::{Children, InstanceAttributes, Instancing, Node, SceneNodes, Text};
use crate::scene::text::Fault;
use glam::{DMat4, DQuat, DVec3};
use serde_json::value::RawValue;

/// A mesh at its place in the scene.
pub struct PlacedMesh<'a> {
    pub node: u32,
    pub mesh: usize,
    /// From the node to the scene, in the file's coordinates.
    pub world: DMat4,
    /// The transforms of several instances, relative to the node.
    pub instances: Option<Box<InstanceAttributes>>,
    /// The node's weights of morph targets, which replace those of the mesh.
    pub weights: Option<&'a RawValue>,
}

/// The children of a node that are still to be visited.
struct Level {
    /// `None` for the roots.
    parent: Option<u32>,
    world: DMat4,
    children: std::vec::IntoIter<u32>,
}

impl<'a> GltfReader<'a> {
    /// Visits all nodes of the scene, parents before children, in file order: the default scene, otherwise the first
    /// one with nodes, otherwise all nodes.
    pub(super) fn nodes(&mut self) -> Result<Vec<PlacedMesh<'a>>, Fault> {
        let count = self.lists.nodes.len();
        self.limits.keep(2 * count)?;
        let mut seen = vec![false; count];
        let mut placed = Vec::new();
        let mut levels = vec![Level { parent: None, world: DMat4::IDENTITY, children: self.roots()?.into_iter() }];
        while let Some(Level { parent, world, children }) = levels.last_mut() {
            let Some(index) = children.next() else {
                levels.pop();
                self.limits.shrink(size_of::<Level>());
                continue;
            };
            if seen.get_mut(index as usize).is_some_and(|seen| std::mem::replace(seen, true)) {
                let problem = format!("node {index} has two parents or is its own ancestor");
                return Err(Fault::new(None, problem, "the nodes must be a tree: export the file again"));
            }
            let from = match parent {
                Some(parent) => format!("nodes[{parent}].children"),
                None => "the scene".to_owned(),
            };
            let mut node: Node = self.lists.nodes.get(index as usize, from)?;
            let world = *world * local(&node);
            if !world.is_finite() {
                let problem = format!("node {index} has a transform that is not finite");
                return Err(Fault::new(None, problem, "repair it"));
            }
            let Indices(children) = std::mem::take(&mut node.children);
            self.visit(index, node, &world, &mut placed)?;
            if !children.is_empty() {
                self.limits.grow(size_of::<Level>())?;
                levels.push(Level { parent: Some(index), world, children: children.into_iter() });
            }
        }
        Ok(placed)
    }

    /// The nodes without parents.
    fn roots(&mut self) -> Result<Vec<u32>, Fault> {
        let scenes = self.json.list("scenes", "scene", self.root.scenes)?;
        let chosen = self.root.scene.map(|raw| self.json.value::<Option<Whole>>("scene", raw)).transpose()?.flatten();
        if let Some(Whole(chosen)) = chosen.filter(|_| scenes.len() > 0) {
            return Ok(scenes.get::<SceneNodes>(chosen, "scene")?.nodes.0);
        }
        for index in 0..scenes.len() {
            let SceneNodes { nodes: Indices(nodes) } = scenes.get(index, "scene")?;
            if !nodes.is_empty() {
                return Ok(nodes);
            }
        }
        let count = self.lists.nodes.len();
        self.limits.keep(count)?;
        let mut child = vec![false; count];
        for index in 0..count {
            let Children { children: Indices(children) } = self.lists.nodes.get(index, "the scene")?;
            for index in children {
                child.get_mut(index as usize).into_iter().for_each(|child| *child = true);
            }
        }
        Ok((0..count as u32).filter(|&index| !child[index as usize]).collect())
    }

    fn visit(
        &mut self,
        index: u32,
        node: Node<'a>,
        world: &DMat4,
        placed: &mut Vec<PlacedMesh<'a>>,
    ) -> Result<(), Fault> {
        let extensions = node.extensions.given();
        if let Some(Whole(mesh)) = node.mesh {
            let instancing = extensions.as_ref().and_then(|extensions| extensions.instancing);
            let instances = match instancing {
                Some(raw) => {
                    let place = format!("nodes[{index}].extensions.EXT_mesh_gpu_instancing");
                    let Instancing { attributes } = self.json.value(place, raw)?;
                    (attributes.count() > 0).then(|| Box::new(attributes))
                }
                None => None,
            };
            self.notes.skinned |= node.skin.0;
            self.limits.repeat(2 * size_of::<PlacedMesh>())?;
            if instances.is_some() {
                self.limits.repeat(2 * size_of::<InstanceAttributes>())?;
            }
            placed.push(PlacedMesh { node: index, mesh, world: *world, instances, weights: node.weights });
        }
        let name = node.name.given().map(|Text(name)| name);
        self.node_camera(index, node.camera, name.as_deref(), world);
        if let Some(extensions) = extensions {
            self.node_light(index, extensions.light, world)?;
        }
        Ok(())
    }
}

impl InstanceAttributes {
    /// Number of attributes that are given.
    pub fn count(&self) -> usize {
        [self.translation, self.rotation, self.scale].iter().flatten().count()
    }
}

/// The transform from a node to its parent, in double precision.
fn local(node: &Node) -> DMat4 {
    if let Some(matrix) = &node.matrix {
        return DMat4::from_cols_array(matrix);
    }
    let vector = |part: Option<[f64; 3]>, default| part.map_or(default, DVec3::from);
    let turn = node.rotation.map_or(DQuat::IDENTITY, DQuat::from_array);
    DMat4::from_scale_rotation_translation(vector(node.scale, DVec3::ONE), turn, vector(node.translation, DVec3::ZERO))
}
