//! What a structure is like: the columns of `structures.csv`, and how much memory it takes.

use crate::math::Aabb;
use crate::scene::Scene;
use crate::workloads::trace::common::memory;
use crate::workloads::trace::common::sah::CostModel;
use crate::workloads::trace::{Structure, TriangleRef};
use serde::{Deserialize, Serialize};

/// Properties of a built structure; `None` where a property has no meaning for it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Properties {
    /// Grid: cells on x.
    pub cells_x: Option<u32>,
    /// Grid: cells on y.
    pub cells_y: Option<u32>,
    /// Grid: cells on z.
    pub cells_z: Option<u32>,
    /// Grid: triangles in the fullest cell.
    pub max_cell_triangles: Option<u32>,
    /// Records per triangle of the scene.
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
    /// Trees: expected cost of a ray by [`CostModel::default`].
    pub sah_cost: Option<f64>,
}

impl Structure {
    /// Box around all triangles.
    pub fn bounds(&self) -> Aabb {
        match self {
            Structure::Brute(s) => s.bounds,
            Structure::Grid(s) => s.bounds,
            Structure::KdTree(s) => s.bounds,
            Structure::Bvh(s) => s.bounds,
        }
    }

    /// triangle references, leaf by leaf or cell by cell.
    pub fn triangle_refs(&self) -> &[TriangleRef] {
        match self {
            Structure::Brute(s) => &s.triangle_refs,
            Structure::Grid(s) => &s.triangle_refs,
            Structure::KdTree(s) => &s.triangle_refs,
            Structure::Bvh(s) => &s.triangle_refs,
        }
    }

    /// Bytes of nodes or cells, and of triangle references: what a device must hold beside the vertices.
    pub fn structure_bytes(&self) -> u64 {
        let nodes = match self {
            Structure::Brute(_) => 0,
            Structure::Grid(s) => size_of_val(s.cells.as_slice()),
            Structure::KdTree(s) => size_of_val(s.nodes.as_slice()),
            Structure::Bvh(s) => size_of_val(s.nodes.as_slice()),
        };
        (nodes + size_of_val(self.triangle_refs())) as u64
    }

    /// Bytes by the thesis's own accounting, vertices included (SPEC section 7): its BVH leaves the triangle references out and has
    /// 40 bytes a node.
    pub fn thesis_bytes(&self, scene: &Scene) -> u64 {
        let (triangle_refs, vertices) = (self.triangle_refs().len() as u64, scene.vertices.len() as u64);
        match self {
            Structure::Brute(_) => memory::grid_bytes(0, triangle_refs, vertices),
            Structure::Grid(s) => memory::grid_bytes(s.cells.len() as u64, triangle_refs, vertices),
            Structure::KdTree(s) => memory::kdtree_bytes(s.nodes.len() as u64, triangle_refs, vertices),
            Structure::Bvh(s) => memory::bvh_bytes(s.nodes.len() as u64, vertices),
        }
    }

    /// What it is like.
    pub fn properties(&self, scene: &Scene) -> Properties {
        let references = self.triangle_refs().len() as f64 / scene.triangles.len().max(1) as f64;
        let common = Properties { references_per_triangle: Some(references), ..Properties::default() };
        match self {
            Structure::Brute(_) => Properties::default(),
            Structure::Grid(s) => Properties {
                cells_x: Some(s.resolution[0]),
                cells_y: Some(s.resolution[1]),
                cells_z: Some(s.resolution[2]),
                max_cell_triangles: s.cells.iter().map(|c| c.count).max(),
                ..common
            },
            Structure::KdTree(s) => {
                let leaves = Leaves::of(s.nodes.iter().filter(|n| n.is_leaf()).map(|n| n.count()));
                let sah_cost = CostModel::default().kdtree(s);
                leaves.into_properties(s.nodes.len(), s.depth, sah_cost, common)
            }
            Structure::Bvh(s) => {
                let leaves = Leaves::of(s.nodes.iter().map(|n| n.count).filter(|&count| count > 0));
                let sah_cost = CostModel::default().bvh(s);
                leaves.into_properties(s.nodes.len(), s.depth, sah_cost, common)
            }
        }
    }
}

#[derive(Default)]
struct Leaves {
    all: u32,
    empty: u32,
    largest: u32,
}

impl Leaves {
    fn of(counts: impl Iterator<Item = u32>) -> Leaves {
        counts.fold(Leaves::default(), |l, count| Leaves {
            all: l.all + 1,
            empty: l.empty + u32::from(count == 0),
            largest: l.largest.max(count),
        })
    }

    fn into_properties(self, nodes: usize, depth: u32, sah_cost: Option<f64>, common: Properties) -> Properties {
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
