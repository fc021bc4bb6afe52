//! Converts shapes to triangles.

use super::InventorReader;
use super::crease::{CornerNormal, Creased};
use super::faces::{BindingIndices, Corner, Face, Faces};
use super::node_type::NodeType;
use super::state::{Binding, State};
use super::tree::{Field, Node};
use crate::scene::Material;
use crate::scene::text::Fault;
use glam::DVec3;

/// The signs of the coordinates of the corners of a cube's sides. The order of the sides is that of bound materials:
/// front, back, left, right, top, bottom.
const SIDES: [[[f64; 3]; 4]; 6] = [
    [[-1., -1., 1.], [1., -1., 1.], [1., 1., 1.], [-1., 1., 1.]],
    [[1., -1., -1.], [-1., -1., -1.], [-1., 1., -1.], [1., 1., -1.]],
    [[-1., -1., -1.], [-1., -1., 1.], [-1., 1., 1.], [-1., 1., -1.]],
    [[1., -1., 1.], [1., -1., -1.], [1., 1., -1.], [1., 1., 1.]],
    [[-1., 1., 1.], [1., 1., 1.], [1., 1., -1.], [-1., 1., -1.]],
    [[-1., -1., -1.], [1., -1., -1.], [1., -1., 1.], [-1., -1., 1.]],
];

/// The source of the normals of a face set.
enum Normals<'t> {
    /// The file gives them.
    Given(BindingIndices<'t>),
    /// All corners of a face have the face's normal.
    Flat,
    /// They are computed with a crease angle.
    Computed(Creased),
}

impl InventorReader {
    /// Adds the triangles of a shape to the mesh.
    pub(super) fn shape(&mut self, node: &Node, state: &State) -> Result<(), Fault> {
        if !state.filled {
            self.mesh.warnings.add("shape with a draw style other than FILLED ignored");
            return Ok(());
        }
        self.mesh.set_transform(state.transform);
        self.mesh.new_shape();
        match node.kind {
            NodeType::Cube => self.cube(node, state),
            NodeType::Sphere => {
                self.part(0, state);
                self.mesh.sphere(DVec3::ZERO, node.number("radius", 1.0)?, self.segments)
            }
            NodeType::Cone => {
                let (radius, height) = (node.number("bottomRadius", 1.0)?, node.number("height", 2.0)?);
                let (top, up) = (DVec3::Y * height / 2.0, DVec3::Y * height.signum());
                if node.has_part(b"SIDES")? {
                    self.part(0, state);
                    self.mesh.cone((-top, radius), (top, 0.0), self.segments)?;
                }
                self.cap(node, state, (b"BOTTOM", 1), (-top, -up, radius))
            }
            NodeType::Cylinder => {
                let (radius, height) = (node.number("radius", 1.0)?, node.number("height", 2.0)?);
                let (top, up) = (DVec3::Y * height / 2.0, DVec3::Y * height.signum());
                if node.has_part(b"SIDES")? {
                    self.part(0, state);
                    self.mesh.cone((-top, radius), (top, radius), self.segments)?;
                }
                self.cap(node, state, (b"TOP", 1), (top, up, radius))?;
                self.cap(node, state, (b"BOTTOM", 2), (-top, -up, radius))
            }
            _ => self.faces(node, state),
        }
    }

    /// Sets the mesh's material to that of a part of a solid.
    fn part(&mut self, part: usize, state: &State) {
        let index = if state.material_binding.0 == Binding::Part { part } else { 0 };
        let found = self.material(index, None, state);
        self.set_material(found);
    }

    /// A material, and whether it is transparent. Beyond the last material they are repeated, with a warning; `field`
    /// is the field that has the index.
    fn material(&mut self, index: usize, field: Option<&Field>, state: &State) -> (Material, bool) {
        let count = state.materials.len();
        if index >= count {
            match field {
                Some(field) if self.faults.is_empty() => {
                    self.faults.push(field.fault(format!(
                        "index {index} is out of range, there are {count} materials: they are repeated"
                    )))
                }
                Some(_) => {}
                None => self.mesh.warnings.add("fewer materials than bindings: the materials are repeated"),
            }
        }
        state.materials.get(index, state.ambient, state.lit)
    }

    /// The index of the material of a corner; that of the first material if there is no index, with a warning.
    fn material_index(&mut self, choice: &BindingIndices, face: &Face, corner: &Corner) -> usize {
        choice.index(face, corner).unwrap_or_else(|fault| {
            if self.faults.is_empty() {
                self.faults.push(Fault { problem: format!("{}: the first material is used", fault.problem), ..fault });
            }
            0
        })
    }

    fn set_material(&mut self, (material, transparent): (Material, bool)) {
        if transparent {
            self.mesh.warnings.add("transparent material: rendered opaque");
        }
        self.mesh.set_material(material);
    }

    fn cube(&mut self, node: &Node, state: &State) -> Result<(), Fault> {
        let size = ["width", "height", "depth"].map(|name| node.number(name, 2.0));
        let [width, height, depth] = size;
        let half = DVec3::new(width?, height?, depth?) / 2.0;
        for (side, corners) in SIDES.into_iter().enumerate() {
            // The sides of a cube count as parts and as faces.
            let bound = matches!(state.material_binding.0, Binding::Part | Binding::Face);
            let found = self.material(if bound { side } else { 0 }, None, state);
            self.set_material(found);
            self.mesh.polygon(&corners.map(|signs| DVec3::from(signs) * half), &[])?;
        }
        Ok(())
    }

    /// Adds the disk at an end of a cone or cylinder, if the node has that part.
    fn cap(
        &mut self,
        node: &Node,
        state: &State,
        part: (&[u8], usize),
        (center, normal, radius): (DVec3, DVec3, f64),
    ) -> Result<(), Fault> {
        if !node.has_part(part.0)? {
            return Ok(());
        }
        self.part(part.1, state);
        self.mesh.ring(center, normal, [0.0, radius.abs()], self.segments)
    }

    /// Adds the triangles of a face set.
    fn faces(&mut self, node: &Node, state: &State) -> Result<(), Fault> {
        let faces = Faces::of(node, state.coordinates, state.clockwise)?;
        let normals = self.normals(node, state, &faces)?;
        if let Normals::Computed(computed) = &normals {
            let (positions, triangles) = computed.size();
            self.mesh.reserve(positions, triangles);
        }
        let materials = BindingIndices::of(node, "materialIndex", state.material_binding)?;
        if materials.is_overall() {
            self.part(0, state);
        }
        let (mut points, mut directions, mut indices, mut visited) = (Vec::new(), Vec::new(), Vec::new(), 0);
        faces.visit(&mut |face: Face| {
            points.clear();
            points.extend(face.corners.iter().map(|corner| faces.position(corner)));
            directions.clear();
            indices.clear();
            for (i, corner) in face.corners.iter().enumerate() {
                match &normals {
                    Normals::Flat => break,
                    Normals::Computed(computed) => {
                        let CornerNormal { normal, shared, work } = computed.normal(visited + i, face.visit);
                        self.count_faces(work)?;
                        directions.push(normal);
                        indices.push(shared.map(|position| [position, 0]));
                    }
                    Normals::Given(choice) => {
                        let index = choice.index(&face, corner)?;
                        let normal = state.normals.get(3 * index..3 * index + 3);
                        directions.push(normal.map_or(DVec3::ZERO, DVec3::from_slice));
                        indices.push(Some([corner.coordinate as u32, index as u32]));
                    }
                }
            }
            visited += face.corners.len();
            if !materials.is_overall() && face.corners.len() > 2 {
                self.bound_material(&face, &materials, state);
            }
            match &normals {
                Normals::Flat => self.mesh.flat_polygon(&points),
                _ => self.mesh.indexed_polygon(&points, &directions, &indices),
            }
        })
    }

    /// The source of a face set's normals: the file, if it has all that are needed.
    fn normals<'t>(&mut self, node: &'t Node, state: &State, faces: &Faces) -> Result<Normals<'t>, Fault> {
        let given = state.normals.len() / 3;
        if given > 0 {
            let choice = BindingIndices::of(node, "normalIndex", state.normal_binding)?;
            if choice.is_within(given, faces) {
                return Ok(Normals::Given(choice));
            }
            let (mut needed, mut problem) = (0, None);
            faces.visit(&mut |face: Face| {
                for corner in face.corners {
                    match choice.index(&face, corner) {
                        Ok(index) => needed = needed.max(1 + index),
                        Err(fault) => _ = problem.get_or_insert(fault),
                    }
                }
                Ok(())
            })?;
            if let Some(fault) = problem {
                let problem = format!("{}: normals are computed", fault.problem);
                self.faults.push(Fault { problem, ..fault });
                needed = usize::MAX;
            }
            if needed <= given {
                return Ok(Normals::Given(choice));
            }
            self.mesh.warnings.add("fewer normals than bindings: normals are computed");
        }
        if state.crease_angle > 0.0 {
            Creased::new(faces, state.crease_angle, &self.mesh).map(Normals::Computed)
        } else {
            Ok(Normals::Flat)
        }
    }

    /// Sets the mesh's material to that of a face: if corners have different materials, the mean of them.
    fn bound_material(&mut self, face: &Face, choice: &BindingIndices, state: &State) {
        let first = self.material_index(choice, face, &face.corners[0]);
        let (mut sum, mut transparent) = self.material(first, choice.field(), state);
        let mut differ = false;
        if choice.is_per_corner() {
            for corner in &face.corners[1..] {
                let index = self.material_index(choice, face, corner);
                let (one, one_transparent) = self.material(index, choice.field(), state);
                differ |= index != first;
                transparent |= one_transparent;
                sum.ambient += one.ambient;
                sum.diffuse += one.diffuse;
                sum.specular += one.specular;
                sum.exponent += one.exponent;
            }
        }
        if !differ {
            let found = state.materials.get(first, state.ambient, state.lit);
            self.set_material(found);
            return;
        }
        self.mesh.warnings.add("colours bound to corners: a face has the mean of its corners");
        let share = 1.0 / face.corners.len() as f32;
        sum.ambient *= share;
        sum.diffuse *= share;
        sum.specular *= share;
        sum.exponent *= share;
        self.set_material((sum, transparent));
    }
}
