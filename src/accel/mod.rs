//! Acceleration structures: what they look like in memory, who builds them, how they are checked.
//!
//! A structure is independent of the traversal that walks it: the same [`bvh::Bvh`] serves the packet and the stack
//! traversal. [`Variant`] names a pair of builder and traversal, which is what a table's row measures.

pub mod bvh;
pub mod grid;
pub mod kdtree;

use crate::math::Aabb;
use bytemuck::{Pod, Zeroable};

/// A triangle as a leaf or cell stores it (SPEC section 1): 16 bytes, contiguous per leaf, repeated where a triangle
/// lies in several leaves. The fourth word is the triangle's index in the scene, so that equal distances are decided
/// by the lower index everywhere; the material is looked up by it, once per shaded hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Record {
    /// Vertex indices.
    pub vertices: [u32; 3],
    /// Index of the triangle in the scene.
    pub triangle: u32,
}

/// All triangles in one run, without any structure: the ground truth for small scenes.
#[derive(Clone, Debug)]
pub struct Brute {
    /// Box around all records.
    pub bounds: Aabb,
    /// One per triangle, in scene order.
    pub records: Vec<Record>,
}

/// Any built structure.
#[derive(Clone, Debug)]
pub enum Structure {
    /// No structure.
    Brute(Brute),
    /// Uniform grid.
    Grid(grid::Grid),
    /// kd-tree.
    KdTree(kdtree::KdTree),
    /// Bounding volume hierarchy.
    Bvh(bvh::Bvh),
}

/// How a structure is walked; each is one file in `kernels/traverse/` and its twin in [`crate::cpu`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Traversal {
    /// Every triangle.
    Brute,
    /// 3D-DDA.
    Grid,
    /// kd-tree with a short stack of four, pushdown and restart.
    KdTree,
    /// BVH, 8x8 packet with one shared stack.
    Bvh,
    /// BVH, one ray per invocation with a private stack.
    BvhStack,
}

// ---- stub ----
use crate::{Error, Result, scene::Scene};
/// stub
pub struct OptionInfo {
    /// k
    pub key: &'static str,
    /// d
    pub default: &'static str,
    /// m
    pub meaning: &'static str,
}
/// stub
pub struct VariantInfo {
    /// n
    pub name: &'static str,
    /// s
    pub summary: &'static str,
    /// p
    pub paper: &'static str,
    /// o
    pub options: &'static [OptionInfo],
    /// t
    pub traversal: Traversal,
}
static V: [VariantInfo; 6] = [
    VariantInfo {
        name: "grid",
        summary: "grid",
        paper: "",
        options: &[OptionInfo { key: "x", default: "auto", meaning: "cells" }],
        traversal: Traversal::Grid,
    },
    VariantInfo { name: "kdtree", summary: "kdtree", paper: "", options: &[], traversal: Traversal::KdTree },
    VariantInfo { name: "bvh", summary: "bvh", paper: "", options: &[], traversal: Traversal::Bvh },
    VariantInfo { name: "bvh-stack", summary: "bvh-stack", paper: "", options: &[], traversal: Traversal::BvhStack },
    VariantInfo { name: "ploc-stack", summary: "ploc-stack", paper: "", options: &[], traversal: Traversal::BvhStack },
    VariantInfo { name: "brute", summary: "brute", paper: "", options: &[], traversal: Traversal::Brute },
];
/// stub
pub fn variants() -> &'static [VariantInfo] {
    &V
}
/// stub
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Selection {
    name: String,
    variant: String,
}
/// stub
pub struct Built {
    /// s
    pub structure: Structure,
    /// b
    pub build_ms: f64,
    /// t
    pub build_threads: usize,
}
impl Selection {
    /// stub
    pub fn parse(text: &str) -> Result<Selection> {
        let (name, variant) = text.split_once(':').unwrap_or((text, "default"));
        if !V.iter().any(|v| v.name == name) {
            return Err(Error::argument(
                "--structure",
                format!("unknown structure {name:?}"),
                "there are grid, kdtree, bvh, bvh-stack, ploc-stack, brute",
            ));
        }
        Ok(Selection { name: name.into(), variant: variant.into() })
    }
    /// stub
    pub fn name(&self) -> &str {
        &self.name
    }
    /// stub
    pub fn variant(&self) -> String {
        self.variant.clone()
    }
    /// stub
    pub fn traversal(&self) -> Traversal {
        V.iter().find(|v| v.name == self.name).unwrap().traversal
    }
    /// stub
    pub fn build_key(&self) -> String {
        format!("{}:{}", self.name.trim_end_matches("-stack"), self.variant)
    }
    /// stub
    pub fn build(&self, scene: &Scene, threads: usize) -> Result<Built> {
        let bounds = scene.bounds();
        let records: Vec<Record> = scene
            .triangles
            .iter()
            .enumerate()
            .map(|(i, t)| Record { vertices: t.vertices, triangle: i as u32 })
            .collect();
        let structure = match self.traversal() {
            Traversal::Bvh | Traversal::BvhStack => {
                Structure::Bvh(bvh::Bvh { bounds, nodes: vec![], records, depth: 0 })
            }
            _ => Structure::Brute(Brute { bounds, records }),
        };
        Ok(Built { structure, build_ms: 1.0, build_threads: threads.max(1) })
    }
}
/// stub
#[derive(Clone, Debug, Default)]
pub struct Properties {
    /// c
    pub cells: [Option<u32>; 3],
    /// m
    pub max_cell_triangles: Option<u32>,
    /// r
    pub references_per_triangle: Option<f64>,
    /// l
    pub leaves: Option<u32>,
    /// e
    pub empty_leaves: Option<u32>,
    /// m
    pub max_leaf_triangles: Option<u32>,
    /// n
    pub nodes: Option<u32>,
    /// d
    pub depth: Option<u32>,
    /// s
    pub sah_cost: Option<f64>,
}
impl Structure {
    /// stub
    pub fn bounds(&self) -> Aabb {
        match self {
            Structure::Brute(b) => b.bounds,
            Structure::Bvh(b) => b.bounds,
            _ => Aabb::EMPTY,
        }
    }
    /// stub
    pub fn records(&self) -> &[Record] {
        match self {
            Structure::Brute(b) => &b.records,
            Structure::Bvh(b) => &b.records,
            _ => &[],
        }
    }
    /// stub
    pub fn structure_bytes(&self) -> u64 {
        16 * self.records().len() as u64
    }
    /// stub
    pub fn thesis_bytes(&self, s: &Scene) -> u64 {
        32 * s.vertices.len() as u64
    }
    /// stub
    pub fn properties(&self, _: &Scene) -> Properties {
        Properties { nodes: Some(2), ..Default::default() }
    }
    /// stub
    pub fn validate(&self, _: &Scene) -> std::result::Result<(), String> {
        Ok(())
    }
}
