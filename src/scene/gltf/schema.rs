//! The parts of the schema of glTF 2.0 that are read. Unknown properties are passed over, `null` counts as absent.

use super::json::{Indices, Loose, Present, Whole};
use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::value::RawValue;
use std::borrow::Cow;
use std::fmt::Formatter;

/// The properties of the root, which are parsed when they are needed.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Root<'a> {
    #[serde(default, borrow)]
    pub asset: Loose<Asset<'a>>,
    #[serde(borrow)]
    pub extensions_used: Option<&'a RawValue>,
    #[serde(borrow)]
    pub extensions_required: Option<&'a RawValue>,
    #[serde(borrow)]
    pub scene: Option<&'a RawValue>,
    #[serde(borrow)]
    pub scenes: Option<&'a RawValue>,
    #[serde(borrow)]
    pub nodes: Option<&'a RawValue>,
    #[serde(borrow)]
    pub meshes: Option<&'a RawValue>,
    #[serde(borrow)]
    pub accessors: Option<&'a RawValue>,
    #[serde(borrow)]
    pub buffer_views: Option<&'a RawValue>,
    #[serde(borrow)]
    pub buffers: Option<&'a RawValue>,
    #[serde(borrow)]
    pub materials: Option<&'a RawValue>,
    #[serde(borrow)]
    pub cameras: Option<&'a RawValue>,
    #[serde(default, borrow)]
    pub extensions: Loose<RootExtensions<'a>>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Asset<'a> {
    #[serde(default, borrow)]
    pub version: Loose<Text<'a>>,
    #[serde(default, borrow)]
    pub min_version: Loose<Text<'a>>,
}

/// A string; a number is taken as it is written.
pub struct Text<'a>(pub Cow<'a, str>);

impl<'de: 'a, 'a> Deserialize<'de> for Text<'a> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Text<'a>, D::Error> {
        let raw = <&'de RawValue>::deserialize(deserializer)?.get();
        match raw.as_bytes().first() {
            Some(b'"') => serde_json::from_str(raw).map(|text: String| Text(text.into())).map_err(D::Error::custom),
            Some(b'0'..=b'9') => Ok(Text(raw.into())),
            _ => Err(D::Error::custom("not a string")),
        }
    }
}

#[derive(Deserialize)]
pub struct RootExtensions<'a> {
    #[serde(default, borrow, rename = "KHR_lights_punctual")]
    pub lights: Loose<Lights<'a>>,
}

#[derive(Deserialize)]
pub struct Lights<'a> {
    #[serde(borrow)]
    pub lights: Option<&'a RawValue>,
}

#[derive(Deserialize)]
pub struct SceneNodes {
    #[serde(default)]
    pub nodes: Indices,
}

#[derive(Deserialize)]
pub struct Node<'a> {
    pub matrix: Option<[f64; 16]>,
    pub translation: Option<[f64; 3]>,
    pub rotation: Option<[f64; 4]>,
    pub scale: Option<[f64; 3]>,
    #[serde(default)]
    pub children: Indices,
    pub mesh: Option<Whole>,
    #[serde(default)]
    pub skin: Present,
    #[serde(default)]
    pub camera: Loose<Whole>,
    #[serde(default, borrow)]
    pub name: Loose<Text<'a>>,
    #[serde(borrow)]
    pub weights: Option<&'a RawValue>,
    #[serde(default, borrow)]
    pub extensions: Loose<NodeExtensions<'a>>,
}

#[derive(Deserialize)]
pub struct NodeExtensions<'a> {
    #[serde(default, rename = "KHR_lights_punctual")]
    pub light: Loose<NodeLight>,
    #[serde(borrow, rename = "EXT_mesh_gpu_instancing")]
    pub instancing: Option<&'a RawValue>,
}

#[derive(Deserialize)]
pub struct NodeLight {
    pub light: Whole,
}

/// EXT_mesh_gpu_instancing: accessors of the instances' transforms.
#[derive(Deserialize)]
pub struct Instancing {
    #[serde(default)]
    pub attributes: InstanceAttributes,
}

#[derive(Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub struct InstanceAttributes {
    pub translation: Option<Whole>,
    pub rotation: Option<Whole>,
    pub scale: Option<Whole>,
}

/// The children of a node, parsed alone to find the roots.
#[derive(Deserialize)]
pub struct Children {
    #[serde(default)]
    pub children: Indices,
}

#[derive(Deserialize)]
pub struct Mesh<'a> {
    #[serde(default, borrow)]
    pub primitives: Primitives<'a>,
    #[serde(borrow)]
    pub weights: Option<&'a RawValue>,
}

/// The primitives of a mesh that have triangles.
#[derive(Default)]
pub struct Primitives<'a> {
    pub surfaces: Vec<Primitive<'a>>,
    /// Number of primitives that are points or lines.
    pub no_surface: usize,
    /// Number of primitives without positions.
    pub no_positions: usize,
}

/// A primitive with positions.
pub struct Primitive<'a> {
    /// Index in the mesh.
    pub index: u32,
    /// Accessors.
    pub positions: usize,
    pub normals: Loose<Whole>,
    pub indices: Option<usize>,
    pub material: Loose<Whole>,
    pub mode: Mode,
    pub coloured: bool,
    /// True if there is compressed data in addition to the accessors.
    pub compressed: bool,
    pub targets: Option<&'a RawValue>,
}

/// How indices make triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    List,
    Strip,
    Fan,
}

#[derive(Deserialize)]
struct AnyPrimitive<'a> {
    #[serde(default)]
    attributes: Option<Attributes>,
    indices: Option<Whole>,
    #[serde(default)]
    material: Loose<Whole>,
    mode: Option<Whole>,
    #[serde(borrow)]
    targets: Option<&'a RawValue>,
    #[serde(default)]
    extensions: Loose<PrimitiveExtensions>,
}

/// Attributes of a primitive or of a morph target.
#[derive(Default, Deserialize)]
pub struct Attributes {
    #[serde(rename = "POSITION")]
    pub positions: Option<Whole>,
    #[serde(default, rename = "NORMAL")]
    pub normals: Loose<Whole>,
    #[serde(default, rename = "COLOR_0")]
    pub colours: Present,
}

#[derive(Deserialize)]
struct PrimitiveExtensions {
    #[serde(default, rename = "KHR_draco_mesh_compression")]
    draco: Present,
}

impl<'de: 'a, 'a> Deserialize<'de> for Primitives<'a> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Primitives<'a>, D::Error> {
        struct All;
        impl<'de> Visitor<'de> for All {
            type Value = Primitives<'de>;

            fn expecting(&self, f: &mut Formatter) -> std::fmt::Result {
                f.write_str("an array of primitives")
            }

            fn visit_unit<E>(self) -> Result<Primitives<'de>, E> {
                Ok(Primitives::default())
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Primitives<'de>, A::Error> {
                let mut all = Primitives::default();
                let mut index = 0;
                while let Some(AnyPrimitive { attributes, indices, material, mode, targets, extensions }) =
                    seq.next_element()?
                {
                    let mode = match mode.map_or(4, |Whole(mode)| mode) {
                        0..=3 => None,
                        4 => Some(Mode::List),
                        5 => Some(Mode::Strip),
                        6 => Some(Mode::Fan),
                        other => {
                            let problem = format!("primitive {index} has the mode {other}, which is not 0 to 6");
                            return Err(A::Error::custom(problem));
                        }
                    };
                    let Attributes { positions, normals, colours } = attributes.unwrap_or_default();
                    match (mode, positions) {
                        (None, _) => all.no_surface += 1,
                        (_, None) => all.no_positions += 1,
                        (Some(mode), Some(Whole(positions))) => all.surfaces.push(Primitive {
                            index,
                            positions,
                            normals,
                            indices: indices.map(|Whole(i)| i),
                            material,
                            mode,
                            coloured: colours.0,
                            compressed: extensions.given().is_some_and(|extensions| extensions.draco.0),
                            targets,
                        }),
                    }
                    index += 1;
                }
                Ok(all)
            }
        }
        deserializer.deserialize_any(All)
    }
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Accessor<'a> {
    pub buffer_view: Option<Whole>,
    pub byte_offset: Option<Whole>,
    pub component_type: Whole,
    #[serde(default)]
    pub normalized: Loose<bool>,
    pub count: Whole,
    #[serde(borrow, rename = "type")]
    pub dimensions: Text<'a>,
    pub sparse: Option<Sparse>,
}

/// Elements that replace those of an accessor.
#[derive(Clone, Copy, Deserialize)]
pub struct Sparse {
    pub count: Whole,
    pub indices: SparsePart,
    pub values: SparsePart,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct SparsePart {
    pub buffer_view: Whole,
    pub byte_offset: Option<Whole>,
    /// Only indices have it.
    pub component_type: Option<Whole>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct View {
    pub buffer: Whole,
    pub byte_offset: Option<Whole>,
    pub byte_length: Whole,
    pub byte_stride: Option<Whole>,
    #[serde(default)]
    pub extensions: Loose<Compression>,
}

/// Extensions of buffer views and buffers.
#[derive(Deserialize)]
pub struct Compression {
    #[serde(default, rename = "EXT_meshopt_compression")]
    meshopt: Present,
    #[serde(default, rename = "KHR_meshopt_compression")]
    meshopt_khr: Present,
}

impl Compression {
    pub fn is_meshopt(&self) -> bool {
        self.meshopt.0 || self.meshopt_khr.0
    }
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Buffer<'a> {
    #[serde(borrow)]
    pub uri: Option<Uri<'a>>,
    pub byte_length: Option<Whole>,
    #[serde(default)]
    pub extensions: Loose<Compression>,
}

/// A string without escapes is borrowed: it may hold megabytes.
#[derive(Deserialize)]
pub struct Uri<'a>(#[serde(borrow)] pub Cow<'a, str>);
