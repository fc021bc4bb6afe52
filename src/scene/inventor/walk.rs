//! The walk through a tree: groups, and what other nodes do to the state.

use super::Reader;
use super::kind::Kind;
use super::parse::MAX_DEPTH;
use super::state::State;
use super::transform::{PROJECTION, affine};
use super::tree::{Node, Tree, Values};
use crate::scene::text::{Fault, Trouble};
use glam::{DAffine3, DVec3};
use std::path::Path;

impl Reader {
    /// Goes through a node of the file `path` and what is inside of it. `crease_angle` is the file's default.
    pub(super) fn walk<'t>(
        &mut self,
        path: &Path,
        tree: &'t Tree,
        index: u32,
        state: &mut State<'t>,
        crease_angle: f64,
    ) -> Result<(), Trouble> {
        let node = tree.node(index);
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            let problem = format!("more than {MAX_DEPTH} nodes inside each other");
            return Err(Fault::new(Some(node.line), problem, "flatten the hierarchy").into());
        }
        self.pass(node.cost).map_err(|fault| fault.at(node.line))?;
        let walker = Walker { path, tree, crease_angle };
        match node.kind {
            Kind::Group => self.children(walker, node, 0..node.children.len(), state)?,
            Kind::Separator => {
                let mut inside = *state;
                self.children(walker, node, 0..node.children.len(), &mut inside)?;
            }
            Kind::TransformSeparator => {
                let (transform, unit) = (state.transform, state.unit);
                self.children(walker, node, 0..node.children.len(), state)?;
                (state.transform, state.unit) = (transform, unit);
            }
            Kind::Levels => self.children(walker, node, 0..node.children.len().min(1), state)?,
            Kind::Switch => self.switch(walker, node, state).map_err(|trouble| trouble.at(node.line))?,
            Kind::Array => self.array(walker, node, state).map_err(|trouble| trouble.at(node.line))?,
            Kind::MultipleCopy => self.copies(walker, node, state).map_err(|trouble| trouble.at(node.line))?,
            Kind::Include => self.include(path, node, state).map_err(|trouble| trouble.at(node.line))?,
            _ => self.leaf(walker, node, state).map_err(|fault| fault.at(node.line))?,
        }
        self.depth -= 1;
        Ok(())
    }

    /// A node without others inside.
    fn leaf<'t>(&mut self, walker: Walker<'t, '_>, node: &'t Node, state: &mut State<'t>) -> Result<(), Fault> {
        match node.kind {
            Kind::Translation
            | Kind::Rotation
            | Kind::RotationXyz
            | Kind::Scale
            | Kind::Transform
            | Kind::MatrixTransform
            | Kind::ResetTransform
            | Kind::Units => state.move_by(node),
            Kind::PointLight | Kind::SpotLight | Kind::DirectionalLight => self.light(node, state),
            Kind::PerspectiveCamera => self.view(node, state),
            Kind::Cube
            | Kind::Sphere
            | Kind::Cone
            | Kind::Cylinder
            | Kind::IndexedFaceSet
            | Kind::FaceSet
            | Kind::IndexedTriangleStripSet
            | Kind::TriangleStripSet
            | Kind::QuadMesh => {
                let mut own = *state;
                if let Some(vertices) = node.inner("vertexProperty")? {
                    let vertices = walker.tree.node(vertices);
                    if vertices.kind != Kind::VertexProperty {
                        return Err(Fault::new(None, "vertexProperty: the node is none", "give a VertexProperty"));
                    }
                    own.set(vertices, walker.crease_angle).map_err(|fault| fault.at(vertices.line))?;
                }
                self.shape(node, &own)
            }
            _ => state.set(node, walker.crease_angle),
        }
    }

    /// Goes through some of the nodes inside of a node.
    fn children<'t>(
        &mut self,
        walker: Walker<'t, '_>,
        node: &Node,
        which: std::ops::Range<usize>,
        state: &mut State<'t>,
    ) -> Result<(), Trouble> {
        let Walker { path, tree, crease_angle } = walker;
        node.children[which].iter().try_for_each(|&child| self.walk(path, tree, child, state, crease_angle))
    }

    /// `whichChild`: an index, -1 for none, -2 for what the switch around this one chose, -3 for all.
    fn switch<'t>(&mut self, walker: Walker<'t, '_>, node: &Node, state: &mut State<'t>) -> Result<(), Trouble> {
        let count = node.children.len();
        let which = match node.integer("whichChild", -1)? {
            // That switch may have had more to choose from
            -2 if state.chosen >= 0 && count > 0 => state.chosen % count as i64,
            -2 => state.chosen,
            which => which,
        };
        state.chosen = which;
        match usize::try_from(which) {
            Ok(which) if which < count => self.children(walker, node, which..which + 1, state),
            _ if which == -3 => self.children(walker, node, 0..count, state),
            _ if which == -1 => Ok(()),
            _ => {
                self.mesh.warnings.add("switch without the node that it chooses left out");
                Ok(())
            }
        }
    }

    /// Copies in one to three directions.
    fn array<'t>(&mut self, walker: Walker<'t, '_>, node: &Node, state: &mut State<'t>) -> Result<(), Trouble> {
        let axes = [
            ("numElements1", "separation1", DVec3::X),
            ("numElements2", "separation2", DVec3::Y),
            ("numElements3", "separation3", DVec3::Z),
        ];
        let (mut counts, mut steps, mut start) = ([0; 3], [DVec3::ZERO; 3], DVec3::ZERO);
        for (axis, (number, separation, default)) in axes.into_iter().enumerate() {
            counts[axis] = node.integer(number, 1)?;
            steps[axis] = node.vector(separation, default)?;
            let last = steps[axis] * counts[axis].saturating_sub(1).max(0) as f64;
            match node.word("origin")? {
                Some(b"CENTER") => start -= last / 2.0,
                Some(b"LAST") => start -= last,
                _ => {}
            }
        }
        // Of nothing, any number of rows is gone through in no time
        if counts[0] < 1 {
            return Ok(());
        }
        for k in 0..counts[2] {
            self.pass(1)?;
            for j in 0..counts[1] {
                for i in 0..counts[0] {
                    self.pass(1)?;
                    let [i, j, k] = [i, j, k].map(|index| index as f64);
                    let place = start + steps[0] * i + steps[1] * j + steps[2] * k;
                    let mut copy = *state;
                    copy.transform *= DAffine3::from_translation(place);
                    self.children(walker, node, 0..node.children.len(), &mut copy)?;
                }
            }
        }
        Ok(())
    }

    /// A copy for every matrix.
    fn copies<'t>(&mut self, walker: Walker<'t, '_>, node: &Node, state: &mut State<'t>) -> Result<(), Trouble> {
        let identity = glam::DMat4::IDENTITY.to_cols_array();
        let matrices = node.tuples("matrix", 16)?.unwrap_or(&identity);
        for matrix in matrices.as_chunks().0 {
            let mut copy = *state;
            copy.transform *=
                affine(matrix).ok_or_else(|| Fault::new(None, PROJECTION, "projections cannot be traced"))?;
            self.children(walker, node, 0..node.children.len(), &mut copy)?;
        }
        Ok(())
    }

    /// Another file, with all that is set here. What it sets ends with it.
    fn include(&mut self, path: &Path, node: &Node, state: &State) -> Result<(), Trouble> {
        let name = match node.field("name").map(|field| &field.values) {
            Some(Values::Words(words)) => words.first(),
            _ => None,
        };
        let Some(name) = name.filter(|name| !name.is_empty()) else {
            self.mesh.warnings.add("include without a file's name left out");
            return Ok(());
        };
        if name.windows(3).any(|window| window == b"://") {
            self.mesh.warnings.add("includes from the network left out");
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

/// Where the walk is.
#[derive(Clone, Copy)]
struct Walker<'t, 'p> {
    path: &'p Path,
    tree: &'t Tree,
    crease_angle: f64,
}
