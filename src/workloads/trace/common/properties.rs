//! What a structure is like: the columns of `structures.csv`.

use crate::scene::Scene;
use crate::workloads::trace::TriangleRef;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Properties of a built structure; `None` where a property has no meaning for it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Properties {
    /// Grid: cells on x.
    pub cells_x: Option<u32>,
    /// Grid: cells on y.
    pub cells_y: Option<u32>,
    /// Grid: cells on z.
    pub cells_z: Option<u32>,
    /// Grid: triangles in the fullest cell.
    pub max_cell_triangles: Option<u32>,
    /// Triangle references per triangle of the scene.
    pub references_per_triangle: Option<f64>,
    /// Trees: leaves, empty ones included.
    pub leaves: Option<u32>,
    /// Trees: leaves without triangles.
    pub empty_leaves: Option<u32>,
    /// Trees: triangles in the fullest leaf.
    pub max_leaf_triangles: Option<u32>,
    /// Trees: nodes as allocated, a BVH's dummy sibling included.
    pub nodes: Option<u32>,
    /// Trees: levels of inner nodes on the longest way from the root to a leaf.
    pub depth: Option<u32>,
    /// Trees: expected cost of a ray by the default cost model ([`super::sah::CostModel`]).
    pub sah_cost: Option<f64>,
    /// Trees of more than two children a node, and of quantised boxes: children per node.
    pub children_per_node: Option<f64>,
    /// BVHs with spatial splits: inner nodes that are such splits.
    pub spatial_splits: Option<u32>,
    /// BVHs with spatial splits: the largest share of a node's volume that the boxes of both children have in common,
    /// over all such splits, before references are un-split and boxes are padded.
    pub spatial_overlap: Option<f64>,
}

impl Properties {
    /// What is known of every structure with references.
    pub(crate) fn of_references(triangle_refs: &[TriangleRef], scene: &Scene) -> Properties {
        let references = triangle_refs.len() as f64 / scene.triangles.len().max(1) as f64;
        Properties { references_per_triangle: Some(references), ..Properties::default() }
    }
}

/// A tree's leaves.
#[derive(Default)]
pub(crate) struct Leaves {
    all: u32,
    empty: u32,
    largest: u32,
}

impl Leaves {
    /// From the number of triangles in each.
    pub fn of(counts: impl Iterator<Item = u32>) -> Leaves {
        counts.fold(Leaves::default(), |l, count| Leaves {
            all: l.all + 1,
            empty: l.empty + u32::from(count == 0),
            largest: l.largest.max(count),
        })
    }

    /// The columns of a tree.
    pub fn into_properties(self, nodes: usize, depth: u32, sah_cost: Option<f64>, common: Properties) -> Properties {
        Properties {
            leaves: Some(self.all),
            empty_leaves: Some(self.empty),
            max_leaf_triangles: Some(self.largest),
            nodes: Some(nodes as u32),
            depth: Some(depth),
            sah_cost,
            ..common
        }
    }
}
