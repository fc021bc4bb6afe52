//! Shapes: what becomes triangles.

use super::Reader;
use super::crease::{Creased, Smooth};
use super::faces::{Choice, Face, Faces};
use super::kind::Kind;
use super::state::{Binding, State};
use super::tree::{Field, Node};
use crate::scene::Material;
use crate::scene::text::Fault;
use glam::DVec3;

/// The corners of a cube's sides, by the signs of their coordinates, in the order that materials are bound to them: front,
/// back, left, right, top, bottom.
const SIDES: [[[f64; 3]; 4]; 6] = [
    [[-1., -1., 1.], [1., -1., 1.], [1., 1., 1.], [-1., 1., 1.]],
    [[1., -1., -1.], [-1., -1., -1.], [-1., 1., -1.], [1., 1., -1.]],
    [[-1., -1., -1.], [-1., -1., 1.], [-1., 1., 1.], [-1., 1., -1.]],
    [[1., -1., 1.], [1., -1., -1.], [1., 1., -1.], [1., 1., 1.]],
    [[-1., 1., 1.], [1., 1., 1.], [1., 1., -1.], [-1., 1., -1.]],
    [[-1., -1., -1.], [1., -1., -1.], [1., -1., 1.], [-1., -1., 1.]],
];

/// Where the normals of a set of faces come from.
enum Normals<'t> {
    Given(Choice<'t>),
    /// Every face has its own.
    Flat,
    Made(Creased),
}

impl Reader {
    /// Adds a shape.
    pub(super) fn shape(&mut self, node: &Node, state: &State) -> Result<(), Fault> {
        if !state.filled {
            self.mesh.warnings.add("shape drawn as lines, as points or not at all left out");
            return Ok(());
        }
        self.mesh.set_transform(state.transform);
        self.mesh.new_shape();
        match node.kind {
            Kind::Cube => self.cube(node, state),
            Kind::Sphere => {
                self.part(0, state)?;
                self.mesh.sphere(DVec3::ZERO, node.number("radius", 1.0)?, self.segments)
            }
            Kind::Cone => {
                let (radius, height) = (node.number("bottomRadius", 1.0)?, node.number("height", 2.0)?);
                let (top, up) = (DVec3::Y * height / 2.0, DVec3::Y * height.signum());
                if node.has_part(b"SIDES")? {
                    self.part(0, state)?;
                    self.mesh.cone((-top, radius), (top, 0.0), self.segments)?;
                }
                self.cap(node, state, (b"BOTTOM", 1), (-top, -up, radius))
            }
            Kind::Cylinder => {
                let (radius, height) = (node.number("radius", 1.0)?, node.number("height", 2.0)?);
                let (top, up) = (DVec3::Y * height / 2.0, DVec3::Y * height.signum());
                if node.has_part(b"SIDES")? {
                    self.part(0, state)?;
                    self.mesh.cone((-top, radius), (top, radius), self.segments)?;
                }
                self.cap(node, state, (b"TOP", 1), (top, up, radius))?;
                self.cap(node, state, (b"BOTTOM", 2), (-top, -up, radius))
            }
            _ => self.faces(node, state),
        }
    }

    /// Takes the material of a part of a solid.
    fn part(&mut self, part: usize, state: &State) -> Result<(), Fault> {
        let index = if state.material_binding.0 == Binding::Part { part } else { 0 };
        let found = self.material(index, None, state)?;
        self.take(found);
        Ok(())
    }

    /// One of the materials, and whether light goes through it. An index that is the file's own, in this field, must be
    /// one; otherwise materials that are too few begin again.
    fn material(&mut self, index: usize, field: Option<&Field>, state: &State) -> Result<(Material, bool), Fault> {
        let count = state.materials.len();
        if index >= count {
            if let Some(field) = field {
                return Err(field.fault(format!("index {index} is out of range, there are {count} materials")));
            }
            self.mesh.warnings.add("fewer materials than are bound: they begin again with the first");
        }
        Ok(state.materials.get(index, state.ambient, state.lit))
    }

    fn take(&mut self, (material, through): (Material, bool)) {
        if through {
            self.mesh.warnings.add("transparent material: shown opaque");
        }
        self.mesh.set_material(material);
    }

    fn cube(&mut self, node: &Node, state: &State) -> Result<(), Fault> {
        let size = ["width", "height", "depth"].map(|name| node.number(name, 2.0));
        let [width, height, depth] = size;
        let half = DVec3::new(width?, height?, depth?) / 2.0;
        for (side, corners) in SIDES.into_iter().enumerate() {
            // A cube's sides are faces as well
            let bound = matches!(state.material_binding.0, Binding::Part | Binding::Face);
            let found = self.material(if bound { side } else { 0 }, None, state)?;
            self.take(found);
            self.mesh.polygon(&corners.map(|signs| DVec3::from(signs) * half), &[])?;
        }
        Ok(())
    }

    /// A round end, if the node has that part.
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
        self.part(part.1, state)?;
        self.mesh.ring(center, normal, [0.0, radius.abs()], self.segments)
    }

    /// A set of faces.
    fn faces(&mut self, node: &Node, state: &State) -> Result<(), Fault> {
        let faces = Faces::of(node, state.coordinates, state.clockwise)?;
        let normals = self.normals(node, state, &faces)?;
        if let Normals::Made(made) = &normals {
            let (positions, triangles) = made.size();
            self.mesh.make_room(positions, triangles);
        }
        let materials = Choice::of(node, "materialIndex", state.material_binding)?;
        if materials.is_overall() {
            self.part(0, state)?;
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
                    Normals::Made(made) => {
                        let Smooth { normal, whole, work } = made.normal(visited + i, face.visit);
                        self.smooth(work)?;
                        directions.push(normal);
                        indices.push(whole.map(|place| [place, 0]));
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
                self.bound_material(&face, &materials, state)?;
            }
            match &normals {
                Normals::Flat => self.mesh.flat_polygon(&points),
                _ => self.mesh.indexed_polygon(&points, &directions, &indices),
            }
        })
    }

    /// Where normals come from: from the file, if it has all that are needed.
    fn normals<'t>(&mut self, node: &'t Node, state: &State, faces: &Faces) -> Result<Normals<'t>, Fault> {
        let given = state.normals.len() / 3;
        if given > 0 {
            let choice = Choice::of(node, "normalIndex", state.normal_binding)?;
            if choice.is_within(given, faces) {
                return Ok(Normals::Given(choice));
            }
            let mut needed = 0;
            faces.visit(&mut |face: Face| {
                for corner in face.corners {
                    needed = needed.max(1 + choice.index(&face, corner)?);
                }
                Ok(())
            })?;
            if needed <= given {
                return Ok(Normals::Given(choice));
            }
            self.mesh.warnings.add("fewer normals than are bound: others made");
        }
        if state.crease_angle > 0.0 {
            Creased::new(faces, state.crease_angle, &self.mesh).map(Normals::Made)
        } else {
            Ok(Normals::Flat)
        }
    }

    /// Takes the material of a face; the mean of its corners' where they have their own.
    fn bound_material(&mut self, face: &Face, choice: &Choice, state: &State) -> Result<(), Fault> {
        let first = choice.index(face, &face.corners[0])?;
        let (mut sum, mut through) = self.material(first, choice.field(), state)?;
        let mut differ = false;
        if choice.is_per_corner() {
            for corner in &face.corners[1..] {
                let index = choice.index(face, corner)?;
                let (one, clear) = self.material(index, choice.field(), state)?;
                differ |= index != first;
                through |= clear;
                sum.ambient += one.ambient;
                sum.diffuse += one.diffuse;
                sum.specular += one.specular;
                sum.exponent += one.exponent;
            }
        }
        if !differ {
            let found = state.materials.get(first, state.ambient, state.lit);
            self.take(found);
            return Ok(());
        }
        self.mesh.warnings.add("colours bound to corners: a face has their mean");
        let share = 1.0 / face.corners.len() as f32;
        sum.ambient *= share;
        sum.diffuse *= share;
        sum.specular *= share;
        sum.exponent *= share;
        self.take((sum, through));
        Ok(())
    }
}
