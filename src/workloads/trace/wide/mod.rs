//! Trees of boxes with two, four or eight children a node, collapsed from a BVH, with quantised boxes.

pub(crate) mod check;
pub mod collapse;
mod layout;
pub mod octants;
mod octants_stack;
pub mod pair_stack;
mod quantise;
pub(in crate::workloads::trace) mod reached;
mod short_stack;
pub mod stack;

pub use layout::{Slot, Wide, WideUniform};
pub use quantise::{Numbers, Planes};

use super::algorithm::{Builder, Made};
use super::bvh::{self, Bvh, BvhNode};
use super::common::sah::half_area;
use super::selection::Selection;
use super::structure::StructureKind;
use crate::device::vulkan::Texel;
use crate::error::Result;
use crate::math::Aabb;
use crate::scene::Scene;
use std::sync::Arc;

pub(in crate::workloads::trace) static PAIRS: StructureKind = wide("quantised BVH");
pub(in crate::workloads::trace) static FOUR: StructureKind = wide("BVH4");
pub(in crate::workloads::trace) static EIGHT: StructureKind = wide("BVH8");

const fn wide(name: &'static str) -> StructureKind {
    StructureKind { name, node_texel: Texel::Bytes16, has_cells: false }
}

/// The layout of trees with at most so many children a node.
fn kind(width: usize) -> &'static StructureKind {
    match width {
        2 => &PAIRS,
        4 => &FOUR,
        _ => &EIGHT,
    }
}

/// A BVH whose boxes are quantised.
static QUANTISED: Builder = builder("bvh-quantised", |s, scene| build(s, scene, 2));
static BVH4_BUILDER: Builder = Builder { purpose, ..builder("bvh4", |s, scene| build(s, scene, 4)) };
static BVH8_BUILDER: Builder = Builder { purpose, ..builder("bvh8", |s, scene| build(s, scene, 8)) };

pub(in crate::workloads::trace) const fn builder(
    name: &'static str,
    build: fn(&Selection, &Scene) -> Result<Made>,
) -> Builder {
    Builder {
        name,
        options: bvh::options::OPTIONS,
        parallel: true,
        purpose: |_| "",
        build,
        estimate: None,
        on_device: None,
    }
}

/// Where the children of a node lie.
fn purpose(s: &Selection) -> &'static str {
    if has_octants(s) { "octants" } else { "" }
}

fn has_octants(s: &Selection) -> bool {
    s.find("order") == Some("octant")
}

/// Builds the BVH that the options describe, and collapses it.
pub(in crate::workloads::trace) fn build(s: &Selection, scene: &Scene, width: usize) -> Result<Made> {
    let (bvh, note) = bvh::options::build(s, scene)?;
    let swelling = swelling(&bvh);
    let tree = collapse::collapse(bvh, width, has_octants(s));
    let coarse = (swelling > MUCH).then(|| {
        format!(
            "half of the leaves' boxes have more than {swelling:.1} times the surface of what they hold: {} planes on each \
             axis are few for this scene",
            tree.planes.last
        )
    });
    let notes: Vec<String> = [Some(note).filter(|note| !note.is_empty()), coarse].into_iter().flatten().collect();
    Ok(Made { structure: Arc::new(tree), note: notes.join("; ") })
}

/// From so many times the surface on, boxes of leaves are much larger than what they hold.
const MUCH: f64 = 2.0;

/// The surface of a leaf's box on the planes of the whole scene, as a multiple of that of what it holds: the median.
fn swelling(bvh: &Bvh) -> f64 {
    let planes = Planes::around(bvh.bounds, u16::MAX);
    let of_leaf = |own: Aabb| half_area(&planes.aabb(planes.numbers(own))) / half_area(&own);
    let leaves = bvh.nodes.iter().filter(|node| node.count > 0).map(BvhNode::aabb);
    let mut ratios: Vec<f64> = leaves.filter(|own| half_area(own) > 0.0).map(of_leaf).collect();
    let middle = ratios.len() / 2;
    if ratios.is_empty() { 1.0 } else { *ratios.select_nth_unstable_by(middle, f64::total_cmp).1 }
}
