//! The traversal state: properties that nodes set for the shapes that follow.

use super::node_type::NodeType;
use super::tree::{Field, Node};
use crate::scene::Material;
use crate::scene::text::Fault;
use glam::{DAffine3, DVec3, Vec3};

/// The set of corners that share a normal or a material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Binding {
    /// All corners of a shape.
    Overall,
    /// The corners of a part: a side of a solid, a strip, a row of a mesh. The parts of a face set are its faces.
    Part,
    /// The corners of a face.
    Face,
    /// No corners: each corner has its own.
    Vertex,
}

impl Binding {
    /// The binding in a field, and whether it uses a list of indices.
    fn read(node: &Node, field: &str, default: (Binding, bool)) -> Result<(Binding, bool), Fault> {
        let Some(word) = node.word(field)? else { return Ok(default) };
        Ok(match word {
            b"OVERALL" => (Binding::Overall, false),
            b"PER_PART" => (Binding::Part, false),
            b"PER_PART_INDEXED" => (Binding::Part, true),
            b"PER_FACE" => (Binding::Face, false),
            b"PER_FACE_INDEXED" => (Binding::Face, true),
            b"PER_VERTEX" => (Binding::Vertex, false),
            b"PER_VERTEX_INDEXED" => (Binding::Vertex, true),
            b"DEFAULT" | b"NONE" => default,
            _ => return Err(unknown(node.field(field), word)),
        })
    }
}

/// The error that a field's word is not one of its allowed values.
#[cold]
fn unknown(field: Option<&Field>, word: &[u8]) -> Fault {
    let problem = format!("{} is not one of its values", crate::scene::text::quote_bytes(word));
    field.map_or_else(|| Fault::new(None, problem.clone(), ""), |field| field.fault(&problem))
}

/// A list of diffuse colours in one of the format's encodings.
#[derive(Clone, Copy, Debug)]
enum Colours<'t> {
    /// Three numbers per colour, 0 to 1.
    Rgb(&'t [f64]),
    /// One number per colour, 0xRRGGBBAA.
    Rgba(&'t [f64]),
    /// One number per colour, 0xAABBGGRR, as in V2.0.
    Abgr(&'t [f64]),
}

impl Colours<'_> {
    fn len(&self) -> usize {
        match self {
            Colours::Rgb(numbers) => numbers.len() / 3,
            Colours::Rgba(numbers) | Colours::Abgr(numbers) => numbers.len(),
        }
    }

    /// A colour and its transparency, 0 to 1. The list is repeated.
    fn get(&self, index: usize) -> (DVec3, f64) {
        let bytes = |numbers: &[f64]| {
            let packed = numbers.get(index % numbers.len().max(1)).map_or(0, |&number| number as u32);
            packed.to_be_bytes().map(|byte| f64::from(byte) / 255.0)
        };
        match self {
            Colours::Rgb(numbers) => (triple(numbers, index), 0.0),
            Colours::Rgba(numbers) => {
                let [r, g, b, a] = bytes(numbers);
                (DVec3::new(r, g, b), 1.0 - a)
            }
            Colours::Abgr(numbers) => {
                let [a, b, g, r] = bytes(numbers);
                (DVec3::new(r, g, b), 1.0 - a)
            }
        }
    }
}

/// A vector of a list of vectors, which is repeated.
fn triple(numbers: &[f64], index: usize) -> DVec3 {
    let at = 3 * (index % (numbers.len() / 3).max(1));
    numbers.get(at..at + 3).map_or(DVec3::ZERO, DVec3::from_slice)
}

/// The lists that define materials; each of them is repeated.
#[derive(Clone, Copy, Debug)]
pub struct Materials<'t> {
    ambient: &'t [f64],
    diffuse: Colours<'t>,
    specular: &'t [f64],
    emissive: &'t [f64],
    shininess: &'t [f64],
    transparency: &'t [f64],
}

impl Materials<'_> {
    /// Number of materials: the length of the longest list, at least 1.
    pub fn len(&self) -> usize {
        let triples = [self.ambient, self.specular, self.emissive].map(|list| list.len() / 3);
        let singles = [self.shininess.len(), self.transparency.len(), self.diffuse.len()];
        triples.into_iter().chain(singles).max().unwrap_or(0).max(1)
    }

    /// A material, and whether it is transparent. `ambient` is the ambient light; unless `lit`, the material has its
    /// diffuse colour under any light.
    pub fn get(&self, index: usize, ambient: DVec3, lit: bool) -> (Material, bool) {
        let single = |list: &[f64]| list.get(index % list.len().max(1)).copied().unwrap_or(0.0);
        let (diffuse, transparency) = self.diffuse.get(index);
        let diffuse = diffuse.as_vec3();
        let transparent = transparency.max(single(self.transparency)) > 0.0;
        if !lit {
            return (Material { ambient: diffuse, ..Material::matt(Vec3::ZERO) }, transparent);
        }
        let own = triple(self.ambient, index) * ambient + triple(self.emissive, index);
        let material = Material { ambient: own.as_vec3(), ..Material::matt(diffuse) };
        let exponent = single(self.shininess) * SHININESS;
        (material.shiny(triple(self.specular, index).as_vec3(), exponent as f32, 0.0), transparent)
    }
}

/// The Phong exponent of a shininess of 1.
const SHININESS: f64 = 128.0;

/// A list of positions.
#[derive(Clone, Copy, Debug)]
pub struct Coordinates<'t> {
    pub numbers: &'t [f64],
    /// Numbers per position: three, or four for homogeneous coordinates.
    pub width: usize,
}

impl Coordinates<'_> {
    pub fn len(&self) -> usize {
        self.numbers.len() / self.width
    }

    /// The position at an index, if it is in range.
    pub fn get(&self, index: usize) -> Option<DVec3> {
        match *self.numbers.get(index * self.width..(index + 1) * self.width)? {
            [x, y, z] => Some(DVec3::new(x, y, z)),
            [x, y, z, w] => Some(DVec3::new(x, y, z) / w),
            _ => None,
        }
    }
}

/// The traversal state, which a separator saves and restores.
#[derive(Clone, Copy, Debug)]
pub struct State<'t> {
    /// The transform from the coordinates of the current node to those of the file.
    pub transform: DAffine3,
    /// The unit of length in metres.
    pub unit: f64,
    pub coordinates: Coordinates<'t>,
    /// Three numbers per normal.
    pub normals: &'t [f64],
    /// The binding of normals, and whether it uses indices.
    pub normal_binding: (Binding, bool),
    pub materials: Materials<'t>,
    /// The binding of materials, and whether it uses indices.
    pub material_binding: (Binding, bool),
    /// False if shapes have their diffuse colour under any light.
    pub lit: bool,
    /// False if shapes are drawn as lines or points, or are invisible.
    pub filled: bool,
    /// The largest angle, in radians, between faces at a smooth edge.
    pub crease_angle: f64,
    /// True if the corners of a face are clockwise, seen from outside.
    pub clockwise: bool,
    /// The ambient light.
    pub ambient: DVec3,
    /// The child that the last switch selected by itself, as in `whichChild`, or the number of the enclosing copy.
    pub selected_child: i64,
}

/// The default ambient light.
const AMBIENT: DVec3 = DVec3::splat(0.2);

/// The default diffuse colour.
const GREY: [f64; 3] = [0.8; 3];
const PACKED_GREY: [f64; 1] = [0xcccc_ccff_u32 as f64];

/// The default binding of normals: each corner has its own, by the index of its coordinate.
const NORMALS: (Binding, bool) = (Binding::Vertex, true);
/// The default binding of materials: all corners have the first.
const MATERIALS: (Binding, bool) = (Binding::Overall, false);

impl State<'static> {
    /// The state before the first node.
    pub fn new(crease_angle: f64) -> State<'static> {
        State {
            transform: DAffine3::IDENTITY,
            unit: 1.0,
            coordinates: Coordinates { numbers: &[], width: 3 },
            normals: &[],
            normal_binding: NORMALS,
            materials: Materials {
                ambient: &[0.2; 3],
                diffuse: Colours::Rgb(&GREY),
                specular: &[0.0; 3],
                emissive: &[0.0; 3],
                shininess: &[0.2],
                transparency: &[0.0],
            },
            material_binding: MATERIALS,
            lit: true,
            filled: true,
            crease_angle,
            clockwise: false,
            ambient: AMBIENT,
            selected_child: -1,
        }
    }
}

/// The list in a field that is not geometry; `before` if it is empty or ignored (`~`), `default` if the field is absent
/// or has an error, which is added to `faults`.
fn list<'t>(
    node: &'t Node,
    name: &str,
    width: usize,
    (before, default): (&'t [f64], &'t [f64]),
    faults: &mut Vec<Fault>,
) -> &'t [f64] {
    match node.tuples(name, width) {
        Ok(Some([])) => before,
        Ok(Some(numbers)) if numbers.iter().all(|number| number.is_finite()) => numbers,
        Ok(Some(_)) => {
            faults.extend(node.field(name).map(|field| field.fault("a number is not finite")));
            default
        }
        Ok(None) if node.ignores(name) => before,
        Ok(None) => default,
        Err(fault) => {
            faults.push(fault);
            default
        }
    }
}

/// The value, or the default after adding the error to `faults`.
fn or_default<T>(value: Result<T, Fault>, default: T, faults: &mut Vec<Fault>) -> T {
    value.unwrap_or_else(|fault| {
        faults.push(fault);
        default
    })
}

/// The number of a field if it is finite, otherwise the default after adding an error to `faults`.
fn finite(number: f64, default: f64, field: Option<&Field>, faults: &mut Vec<Fault>) -> f64 {
    if number.is_finite() {
        return number;
    }
    faults.extend(field.map(|field| field.fault("the number is not finite")));
    default
}

impl<'t> State<'t> {
    /// Applies a property node. An absent field has its default; an empty field leaves the state unchanged. Errors in
    /// fields that are not geometry are added to `faults`, and the fields have their defaults.
    ///
    /// # Errors
    /// Those of positions.
    pub fn set(&mut self, node: &'t Node, crease_angle: f64, faults: &mut Vec<Fault>) -> Result<(), Fault> {
        // For nodes with a single field, an ignored field (`~`) means that the node is ignored.
        if ["point", "vector", "value", "model", "style"].iter().any(|field| node.ignores(field)) {
            return Ok(());
        }
        match node.kind {
            NodeType::Coordinate3 => self.positions(node.tuples("point", 3)?, 3),
            NodeType::Coordinate4 => self.positions(node.tuples("point", 4)?, 4),
            NodeType::Normal => _ = self.normals(node, "vector", faults),
            NodeType::NormalBinding => {
                self.normal_binding = or_default(Binding::read(node, "value", NORMALS), NORMALS, faults);
            }
            NodeType::MaterialBinding => {
                self.material_binding = or_default(Binding::read(node, "value", MATERIALS), MATERIALS, faults);
            }
            NodeType::Material => self.material(node, faults),
            NodeType::BaseColor => self.diffuse(Colours::Rgb(list(node, "rgb", 3, (&[], &GREY), faults))),
            NodeType::PackedColor => {
                self.diffuse(Colours::Rgba(list(node, "orderedRGBA", 1, (&[], &PACKED_GREY), faults)));
                self.diffuse(Colours::Abgr(list(node, "rgba", 1, (&[], &[]), faults)));
            }
            NodeType::VertexProperty => self.vertex_property(node, faults)?,
            NodeType::ShapeHints => {
                if !node.ignores("creaseAngle") {
                    let angle = or_default(node.number("creaseAngle", crease_angle), crease_angle, faults);
                    self.crease_angle = finite(angle, crease_angle, node.field("creaseAngle"), faults);
                }
                if !node.ignores("vertexOrdering") {
                    let ordering = or_default(node.word("vertexOrdering"), None, faults);
                    self.clockwise = ordering == Some(b"CLOCKWISE");
                }
            }
            NodeType::LightModel => {
                self.lit = or_default(node.word("model"), None, faults) != Some(b"BASE_COLOR");
            }
            NodeType::DrawStyle => {
                let style = or_default(node.word("style"), None, faults).unwrap_or(b"FILLED");
                self.filled = !matches!(style, b"LINES" | b"POINTS" | b"INVISIBLE");
                if self.filled && style != b"FILLED" {
                    faults.push(unknown(node.field("style"), style));
                }
            }
            NodeType::Environment if !node.ignores("ambientIntensity") && !node.ignores("ambientColor") => {
                let intensity = or_default(node.number("ambientIntensity", 0.2), 0.2, faults);
                let ambient = or_default(node.vector("ambientColor", DVec3::ONE), DVec3::ONE, faults) * intensity;
                let field = node.field("ambientIntensity").or(node.field("ambientColor"));
                self.ambient = if finite(ambient.length(), -1.0, field, faults) < 0.0 { AMBIENT } else { ambient };
            }
            _ => {}
        }
        Ok(())
    }

    /// Sets the positions, unless the list is empty.
    fn positions(&mut self, numbers: Option<&'t [f64]>, width: usize) {
        if let Some(numbers) = numbers.filter(|numbers| !numbers.is_empty()) {
            self.coordinates = Coordinates { numbers, width };
        }
    }

    /// Sets the normals, unless the list is empty; false if it is. After an error there are none, so that they are
    /// computed.
    fn normals(&mut self, node: &'t Node, field: &str, faults: &mut Vec<Fault>) -> bool {
        let numbers = or_default(node.tuples(field, 3).map(|numbers| numbers.unwrap_or(&[])), &[], faults);
        let empty = numbers.is_empty() && faults.is_empty();
        if !empty {
            self.normals = numbers;
        }
        !empty
    }

    /// Sets the diffuse colours, unless the list is empty.
    fn diffuse(&mut self, colours: Colours<'t>) {
        if colours.len() > 0 {
            self.materials.diffuse = colours;
        }
    }

    fn material(&mut self, node: &'t Node, faults: &mut Vec<Fault>) {
        let (before, default) = (self.materials, State::new(0.0).materials);
        self.diffuse(Colours::Rgb(list(node, "diffuseColor", 3, (&[], &GREY), faults)));
        self.materials = Materials {
            ambient: list(node, "ambientColor", 3, (before.ambient, default.ambient), faults),
            specular: list(node, "specularColor", 3, (before.specular, default.specular), faults),
            emissive: list(node, "emissiveColor", 3, (before.emissive, default.emissive), faults),
            shininess: list(node, "shininess", 1, (before.shininess, default.shininess), faults),
            transparency: list(node, "transparency", 1, (before.transparency, default.transparency), faults),
            ..self.materials
        };
    }

    /// Applies a `VertexProperty`. An empty field leaves the state and its binding unchanged.
    fn vertex_property(&mut self, node: &'t Node, faults: &mut Vec<Fault>) -> Result<(), Fault> {
        self.positions(node.tuples("vertex", 3)?, 3);
        if self.normals(node, "normal", faults) {
            self.normal_binding = or_default(Binding::read(node, "normalBinding", NORMALS), NORMALS, faults);
        }
        let colours = list(node, "orderedRGBA", 1, (&[], &[]), faults);
        if !colours.is_empty() {
            self.diffuse(Colours::Rgba(colours));
            self.material_binding = or_default(Binding::read(node, "materialBinding", MATERIALS), MATERIALS, faults);
        }
        Ok(())
    }
}
