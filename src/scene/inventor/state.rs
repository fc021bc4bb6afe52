//! What the nodes so far have set, for the shapes that follow.

use super::kind::Kind;
use super::tree::{Field, Node};
use crate::scene::Material;
use crate::scene::text::Fault;
use glam::{DAffine3, DVec3, Vec3};

/// How many corners share a normal or a material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Binding {
    /// All.
    Overall,
    /// Those of a part: a side of a solid, a strip, a row of a mesh. The parts of a set of faces are its faces.
    Part,
    /// Those of a face.
    Face,
    /// None.
    Vertex,
}

impl Binding {
    /// A binding of its field; what the default is depends on what it binds. True if it goes by a list of indices.
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

/// Where a node's word is none of those that it may be.
#[cold]
fn unknown(field: Option<&Field>, word: &[u8]) -> Fault {
    let problem = format!("{} is none of its values", crate::scene::text::quote_bytes(word));
    field.map_or_else(|| Fault::new(None, problem.clone(), ""), |field| field.fault(&problem))
}

/// Diffuse colours.
#[derive(Clone, Copy, Debug)]
enum Colours<'t> {
    /// Three numbers each.
    Rgb(&'t [f64]),
    /// One number each, 0xRRGGBBAA.
    Rgba(&'t [f64]),
    /// One number each, 0xAABBGGRR, as in V2.0.
    Abgr(&'t [f64]),
}

impl Colours<'_> {
    fn len(&self) -> usize {
        match self {
            Colours::Rgb(numbers) => numbers.len() / 3,
            Colours::Rgba(numbers) | Colours::Abgr(numbers) => numbers.len(),
        }
    }

    /// A colour and how transparent it is.
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

/// A vector of a list that starts again where it ends.
fn triple(numbers: &[f64], index: usize) -> DVec3 {
    let at = 3 * (index % (numbers.len() / 3).max(1));
    numbers.get(at..at + 3).map_or(DVec3::ZERO, DVec3::from_slice)
}

/// Lists of what makes materials: each starts again where it ends.
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
    /// Number of materials.
    pub fn len(&self) -> usize {
        let triples = [self.ambient, self.specular, self.emissive].map(|list| list.len() / 3);
        let singles = [self.shininess.len(), self.transparency.len(), self.diffuse.len()];
        triples.into_iter().chain(singles).max().unwrap_or(0).max(1)
    }

    /// A material, and whether light goes through it. `ambient` is the light that is everywhere; without `lit` it shows its
    /// diffuse colour and no light changes that.
    pub fn get(&self, index: usize, ambient: DVec3, lit: bool) -> (Material, bool) {
        let single = |list: &[f64]| list.get(index % list.len().max(1)).copied().unwrap_or(0.0);
        let (diffuse, through) = self.diffuse.get(index);
        let diffuse = diffuse.as_vec3();
        let through = through.max(single(self.transparency)) > 0.0;
        if !lit {
            return (Material { ambient: diffuse, ..Material::matt(Vec3::ZERO) }, through);
        }
        let own = triple(self.ambient, index) * ambient + triple(self.emissive, index);
        let material = Material { ambient: own.as_vec3(), ..Material::matt(diffuse) };
        let exponent = single(self.shininess) * SHININESS;
        (material.shiny(triple(self.specular, index).as_vec3(), exponent as f32, 0.0), through)
    }
}

/// Phong exponent of a shininess of one.
const SHININESS: f64 = 128.0;

/// Positions.
#[derive(Clone, Copy, Debug)]
pub struct Coordinates<'t> {
    pub numbers: &'t [f64],
    /// Numbers per position: three, or four with a divisor.
    pub width: usize,
}

impl Coordinates<'_> {
    /// Number of positions.
    pub fn len(&self) -> usize {
        self.numbers.len() / self.width
    }

    /// A position.
    pub fn get(&self, index: usize) -> Option<DVec3> {
        match *self.numbers.get(index * self.width..(index + 1) * self.width)? {
            [x, y, z] => Some(DVec3::new(x, y, z)),
            [x, y, z, w] => Some(DVec3::new(x, y, z) / w),
            _ => None,
        }
    }
}

/// Everything that a separator saves.
#[derive(Clone, Copy, Debug)]
pub struct State<'t> {
    /// From here to the scene.
    pub transform: DAffine3,
    /// Metres per unit.
    pub unit: f64,
    pub coordinates: Coordinates<'t>,
    /// Three numbers each.
    pub normals: &'t [f64],
    /// How they are bound, and whether by index.
    pub normal_binding: (Binding, bool),
    pub materials: Materials<'t>,
    pub material_binding: (Binding, bool),
    /// False if colours are shown as they are.
    pub lit: bool,
    /// False if shapes are drawn as lines or points, or not at all.
    pub filled: bool,
    /// Radians up to which an edge is smooth.
    pub crease_angle: f64,
    /// True if corners go clockwise where a face is seen from outside.
    pub clockwise: bool,
    /// The light that is everywhere.
    pub ambient: DVec3,
    /// What the switch around this one chose.
    pub chosen: i64,
}

/// Diffuse colour by default.
const GREY: [f64; 3] = [0.8; 3];
const PACKED_GREY: [f64; 1] = [0xcccc_ccff_u32 as f64];

/// Of normals: corners have their own, by the shape's coordinates.
const NORMALS: (Binding, bool) = (Binding::Vertex, true);
const MATERIALS: (Binding, bool) = (Binding::Overall, false);

impl State<'static> {
    /// Before the first node.
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
            ambient: DVec3::splat(0.2),
            chosen: -1,
        }
    }
}

/// The list in a field: `before` where it is empty or is to be ignored, `default` where it is not there.
fn list<'t>(
    node: &'t Node,
    name: &str,
    width: usize,
    before: &'t [f64],
    default: &'t [f64],
) -> Result<&'t [f64], Fault> {
    match node.tuples(name, width)? {
        Some([]) => Ok(before),
        Some(numbers) => Ok(numbers),
        None if node.ignores(name) => Ok(before),
        None => Ok(default),
    }
}

impl<'t> State<'t> {
    /// Takes over what a node that is neither group, transform nor shape sets. A field that is not there has its default; one that is
    /// empty leaves things as they are.
    pub fn set(&mut self, node: &'t Node, crease_angle: f64) -> Result<(), Fault> {
        // Nodes of one field, which may be told to leave things as they are
        if ["point", "vector", "value", "model", "style", "creaseAngle"].iter().any(|field| node.ignores(field)) {
            return Ok(());
        }
        match node.kind {
            Kind::Coordinate3 => self.positions(node.tuples("point", 3)?, 3),
            Kind::Coordinate4 => self.positions(node.tuples("point", 4)?, 4),
            Kind::Normal => self.normals = list(node, "vector", 3, self.normals, self.normals)?,
            Kind::NormalBinding => self.normal_binding = Binding::read(node, "value", NORMALS)?,
            Kind::MaterialBinding => self.material_binding = Binding::read(node, "value", MATERIALS)?,
            Kind::Material => self.material(node)?,
            Kind::BaseColor => self.diffuse(Colours::Rgb(list(node, "rgb", 3, &[], &GREY)?)),
            Kind::PackedColor => {
                self.diffuse(Colours::Rgba(list(node, "orderedRGBA", 1, &[], &PACKED_GREY)?));
                self.diffuse(Colours::Abgr(list(node, "rgba", 1, &[], &[])?));
            }
            Kind::VertexProperty => self.vertex_property(node)?,
            Kind::ShapeHints => {
                self.crease_angle = node.number("creaseAngle", crease_angle)?;
                self.clockwise = node.word("vertexOrdering")? == Some(b"CLOCKWISE");
            }
            Kind::LightModel => self.lit = node.word("model")? != Some(b"BASE_COLOR"),
            Kind::DrawStyle => self.filled = matches!(node.word("style")?, None | Some(b"FILLED")),
            Kind::Environment => {
                let intensity = node.number("ambientIntensity", 0.2)?;
                self.ambient = node.vector("ambientColor", DVec3::ONE)? * intensity;
            }
            _ => {}
        }
        Ok(())
    }

    /// Positions, unless there are none.
    fn positions(&mut self, numbers: Option<&'t [f64]>, width: usize) {
        if let Some(numbers) = numbers.filter(|numbers| !numbers.is_empty()) {
            self.coordinates = Coordinates { numbers, width };
        }
    }

    /// Colours, unless there are none.
    fn diffuse(&mut self, colours: Colours<'t>) {
        if colours.len() > 0 {
            self.materials.diffuse = colours;
        }
    }

    fn material(&mut self, node: &'t Node) -> Result<(), Fault> {
        let (before, default) = (self.materials, State::new(0.0).materials);
        self.diffuse(Colours::Rgb(list(node, "diffuseColor", 3, &[], &GREY)?));
        self.materials = Materials {
            ambient: list(node, "ambientColor", 3, before.ambient, default.ambient)?,
            specular: list(node, "specularColor", 3, before.specular, default.specular)?,
            emissive: list(node, "emissiveColor", 3, before.emissive, default.emissive)?,
            shininess: list(node, "shininess", 1, before.shininess, default.shininess)?,
            transparency: list(node, "transparency", 1, before.transparency, default.transparency)?,
            ..self.materials
        };
        Ok(())
    }

    /// What is empty there leaves the state as it is, and its binding with it.
    fn vertex_property(&mut self, node: &'t Node) -> Result<(), Fault> {
        self.positions(node.tuples("vertex", 3)?, 3);
        if let Some(numbers) = node.tuples("normal", 3)?.filter(|numbers| !numbers.is_empty()) {
            self.normals = numbers;
            self.normal_binding = Binding::read(node, "normalBinding", NORMALS)?;
        }
        if let Some(colours) = node.numbers("orderedRGBA")?.filter(|numbers| !numbers.is_empty()) {
            self.diffuse(Colours::Rgba(colours));
            self.material_binding = Binding::read(node, "materialBinding", MATERIALS)?;
        }
        Ok(())
    }
}
