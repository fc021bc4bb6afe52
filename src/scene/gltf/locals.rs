//! Local transforms of nodes in double precision. The crate (1.4.1) holds them in single precision, which is too coarse
//! for a node far from the origin.

use glam::{DMat4, DQuat, DVec3, Mat4};
use gltf::Node;
use serde::Deserialize;

/// The transforms of all nodes in the JSON.
#[derive(Default, Deserialize)]
pub struct Locals {
    #[serde(default)]
    nodes: Vec<Local>,
}

/// The properties of a node that define its transform; all are optional.
#[derive(Deserialize)]
struct Local {
    matrix: Option<Box<[f64; 16]>>,
    translation: Option<Box<[f64; 3]>>,
    rotation: Option<Box<[f64; 4]>>,
    scale: Option<Box<[f64; 3]>>,
}

/// Upper bound of the memory of one property in bytes: that of a matrix, and the overhead of its allocation.
const PER_PART: usize = size_of::<[f64; 16]>() + 16;

impl Locals {
    /// Parses the JSON. If that fails the result is empty, and the crate reports the error.
    pub fn read(json: &[u8]) -> Locals {
        serde_json::from_slice(json).unwrap_or_default()
    }

    /// Memory of the transforms in bytes.
    pub fn bytes(&self) -> usize {
        let parts = |local: &Local| {
            let Local { matrix, translation, rotation, scale } = local;
            [matrix.is_some(), translation.is_some(), rotation.is_some(), scale.is_some()].map(usize::from)
        };
        let parts: usize = self.nodes.iter().flat_map(parts).sum();
        2 * size_of_val(self.nodes.as_slice()) + parts * PER_PART
    }

    /// The transform from a node to its parent.
    pub fn of(&self, node: &Node) -> DMat4 {
        let Some(Local { matrix, translation, rotation, scale }) = self.nodes.get(node.index()) else {
            return Mat4::from_cols_array_2d(&node.transform().matrix()).as_dmat4();
        };
        if let Some(matrix) = matrix {
            return DMat4::from_cols_array(matrix);
        }
        let vector = |part: &Option<Box<[f64; 3]>>, default| part.as_deref().map_or(default, |&v| DVec3::from(v));
        let turn = rotation.as_deref().map_or(DQuat::IDENTITY, |&q| DQuat::from_array(q));
        DMat4::from_scale_rotation_translation(vector(scale, DVec3::ONE), turn, vector(translation, DVec3::ZERO))
    }
}
