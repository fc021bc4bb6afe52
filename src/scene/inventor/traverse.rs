//! Traverses a tree: group nodes, and the effect of all other nodes on the state.

use super::InventorReader;
use super::node_type::NodeType;
use super::parse::MAX_DEPTH;
use super::state::State;
use super::tree::{Node, Tree, Values};
use crate::scene::text::{Fault, ReadError, place};
use std::path::Path;

impl InventorReader {
    /// Traverses a node of the file `path` and its children. `crease_angle` is the file's default.
    pub(super) fn traverse<'t>(
        &mut self,
        path: &Path,
        tree: &'t Tree,
        index: u32,
        state: &mut State<'t>,
        crease_angle: f64,
    ) -> Result<(), ReadError> {
        let node = tree.node(index);
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            let problem = format!("nodes are nested more than {MAX_DEPTH} levels deep");
            return Err(Fault::new(Some(node.line), problem, "flatten the hierarchy").into());
        }
        self.count_work(node.cost).map_err(|fault| fault.at(node.line))?;
        let file = FileContext { path, tree, crease_angle };
        match node.kind {
            NodeType::Group => self.children(file, node, 0..node.children.len(), state)?,
            NodeType::Separator => {
                let mut inside = *state;
                self.children(file, node, 0..node.children.len(), &mut inside)?;
            }
            NodeType::TransformSeparator => {
                let (transform, unit) = (state.transform, state.unit);
                self.children(file, node, 0..node.children.len(), state)?;
                (state.transform, state.unit) = (transform, unit);
            }
            NodeType::Levels => self.children(file, node, 0..node.children.len().min(1), state)?,
            NodeType::Switch => self.switch(file, node, state).map_err(|error| error.at(node.line))?,
            NodeType::Array => self.array(file, node, state).map_err(|error| error.at(node.line))?,
            NodeType::MultipleCopy => self.copies(file, node, state).map_err(|error| error.at(node.line))?,
            NodeType::Include => self.include(path, node, state).map_err(|error| error.at(node.line))?,
            _ => {
                self.leaf(file, node, state).map_err(|fault| fault.at(node.line))?;
                self.warn_of_faults(path, node);
            }
        }
        self.depth -= 1;
        Ok(())
    }

    /// Turns the errors of a node that are not errors of geometry into warnings.
    #[inline]
    fn warn_of_faults(&mut self, path: &Path, node: &Node) {
        for fault in self.faults.drain(..) {
            let place = place(path, fault.line.unwrap_or(node.line));
            self.mesh.warnings.add(&format!("{place}: {}", fault.problem));
        }
        self.mesh.not_finite.set_place(|| place(path, node.line));
    }

    /// Processes a node without children.
    fn leaf<'t>(&mut self, file: FileContext<'t, '_>, node: &'t Node, state: &mut State<'t>) -> Result<(), Fault> {
        match node.kind {
            NodeType::Translation
            | NodeType::Rotation
            | NodeType::RotationXyz
            | NodeType::Scale
            | NodeType::Transform
            | NodeType::MatrixTransform
            | NodeType::ResetTransform
            | NodeType::Units => state.apply_transform(node),
            NodeType::PointLight | NodeType::SpotLight | NodeType::DirectionalLight => self.light(node, state),
            NodeType::PerspectiveCamera => {
                self.view(node, state);
                Ok(())
            }
            NodeType::Cube
            | NodeType::Sphere
            | NodeType::Cone
            | NodeType::Cylinder
            | NodeType::IndexedFaceSet
            | NodeType::FaceSet
            | NodeType::IndexedTriangleStripSet
            | NodeType::TriangleStripSet
            | NodeType::QuadMesh => {
                let mut own = *state;
                if let Some(vertices) = node.inner("vertexProperty")? {
                    let vertices = file.tree.node(vertices);
                    if vertices.kind != NodeType::VertexProperty {
                        return Err(Fault::new(
                            None,
                            "vertexProperty: the node has another type",
                            "give a VertexProperty",
                        ));
                    }
                    own.set(vertices, file.crease_angle, &mut self.faults).map_err(|fault| fault.at(vertices.line))?;
                }
                self.shape(node, &own)
            }
            _ => state.set(node, file.crease_angle, &mut self.faults),
        }
    }

    /// Traverses the children in the range `which`.
    pub(super) fn children<'t>(
        &mut self,
        file: FileContext<'t, '_>,
        node: &Node,
        which: std::ops::Range<usize>,
        state: &mut State<'t>,
    ) -> Result<(), ReadError> {
        let FileContext { path, tree, crease_angle } = file;
        node.children[which].iter().try_for_each(|&child| self.traverse(path, tree, child, state, crease_angle))
    }

    /// Traverses the child that `whichChild` selects: an index, -1 for none, -3 for all, -2 for what the state has: the
    /// index that the last switch with another value selected, or the number of the copy. A switch that inherits leaves
    /// the state unchanged.
    fn switch<'t>(&mut self, file: FileContext<'t, '_>, node: &Node, state: &mut State<'t>) -> Result<(), ReadError> {
        let count = node.children.len();
        let which = match node.integer("whichChild", -1)? {
            // The number is of another node, which may have more children.
            -2 if state.selected_child >= 0 && count > 0 => state.selected_child % count as i64,
            -2 => state.selected_child,
            which => {
                state.selected_child = which;
                which
            }
        };
        match usize::try_from(which) {
            Ok(which) if which < count => self.children(file, node, which..which + 1, state),
            _ if which == -3 => self.children(file, node, 0..count, state),
            _ if which == -1 => Ok(()),
            _ => {
                self.mesh.warnings.add("switch that selects a child out of range ignored");
                Ok(())
            }
        }
    }

    /// Reads an included file with the current state, which the file cannot change.
    fn include(&mut self, path: &Path, node: &Node, state: &State) -> Result<(), ReadError> {
        let name = match node.field("name").map(|field| &field.values) {
            Some(Values::Words(words)) => words.first(),
            _ => None,
        };
        let Some(name) = name.filter(|name| !name.is_empty()) else {
            self.mesh.warnings.add("include without a file name ignored");
            return Ok(());
        };
        if name.windows(3).any(|window| window == b"://") {
            self.mesh.warnings.add("includes from the network ignored");
            return Ok(());
        }
        let known = self.includes.bytes();
        let (path, bytes) = self.includes.open(path, name)?;
        self.mesh.read(self.includes.bytes() - known);
        self.file(&path, bytes, Some(state))?;
        self.includes.close();
        Ok(())
    }
}

/// The file that is being traversed.
#[derive(Clone, Copy)]
pub(super) struct FileContext<'t, 'p> {
    path: &'p Path,
    pub tree: &'t Tree,
    crease_angle: f64,
}
