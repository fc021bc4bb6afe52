//! What PLOC's passes would cost, before they are run.
//!
//! A pass of PLOC merges two neighbours on the Morton curve where each is the other's cheapest partner, and looks at
//! every node that is left. Usually a third of them merges, so that all passes together look at three or four times as
//! many nodes as there are triangles. But where the costs of neighbours only rise along the curve, or are equal (a row
//! of equal boxes, boxes in one place, boxes inside each other), each node prefers the same side, and a pass merges a
//! single pair: `n` passes, `n^2 / 2` looks. No parameter of the builder changes that. Reinsertion, in contrast, costs
//! no more on such scenes.

use crate::math::Aabb;
use crate::workloads::trace::common::prims::Prim;
use glam::{DVec3, Vec3A, Vec4};
use rayon::prelude::*;

/// So few nodes cost nothing, however they merge.
const FEW: usize = 256;

/// Most bits of a Morton code for each axis.
const BITS: u32 = 21;

/// How many nodes PLOC's passes look at, with a search distance of one, or a little more than `most` if it is more.
/// `unit` is about 1 over the scene's extent, so that areas of huge scenes stay finite.
pub(crate) fn looks(prims: &[Prim], bounds: &Aabb, unit: f32, most: u64) -> u64 {
    let mut nodes = along_the_curve(prims, bounds, unit);
    let cost = |a: &Node, b: &Node| {
        let e = Vec3A::from_vec4(a.1.max(b.1) - a.0.min(b.0));
        e.dot(Vec3A::new(e.y, e.z, e.x))
    };
    let mut looks = 0;
    while nodes.len() > FEW && looks <= most {
        looks += nodes.len() as u64;
        let (mut kept, mut next) = (0, 0);
        let mut before = f32::INFINITY;
        let mut here = cost(&nodes[0], &nodes[1]);
        while next < nodes.len() {
            // Between the next node and the one behind it; nothing is behind the last.
            let behind = if next + 2 < nodes.len() { cost(&nodes[next + 1], &nodes[next + 2]) } else { f32::INFINITY };
            let is_last = next + 1 == nodes.len();
            // The first looks ahead unless its cost backwards is lower, the second backwards if its cost ahead is
            // higher.
            if !is_last && before >= here && here < behind {
                let (a, b) = (nodes[next], nodes[next + 1]);
                nodes[kept] = (a.0.min(b.0), a.1.max(b.1));
                next += 2;
                before = behind;
                here = if next + 1 < nodes.len() { cost(&nodes[next], &nodes[next + 1]) } else { f32::INFINITY };
            } else {
                nodes[kept] = nodes[next];
                next += 1;
                (before, here) = (here, behind);
            }
            kept += 1;
        }
        nodes.truncate(kept);
    }
    looks
}

/// A box in two rows whose fourth lanes mean nothing.
type Node = (Vec4, Vec4);

/// The boxes in the order of a Morton curve, in units of `1 / unit`.
fn along_the_curve(prims: &[Prim], bounds: &Aabb, unit: f32) -> Vec<Node> {
    // Code and number share a word, which sorts fastest: the more triangles, the coarser the curve.
    let number_bits = usize::BITS - prims.len().leading_zeros();
    let bits = ((u64::BITS - number_bits) / 3).min(BITS);
    let cells = (1_u64 << bits) as f64;
    let min = bounds.min.as_dvec3();
    let extent = bounds.max.as_dvec3() - min;
    // An axis without extent has one cell.
    let scale = DVec3::select(extent.cmpgt(DVec3::ZERO), cells / extent, DVec3::ZERO);
    let code = |prim: &Prim| {
        let centre = 0.5 * (prim.min.truncate().as_dvec3() + prim.max.truncate().as_dvec3());
        let cell = ((centre - min) * scale).min(DVec3::splat(cells - 1.0));
        let [x, y, z] = cell.to_array().map(|x| spread(x as u64));
        x | y << 1 | z << 2
    };
    let mut order: Vec<u64> =
        prims.par_iter().enumerate().map(|(i, prim)| code(prim) << number_bits | i as u64).collect();
    order.par_sort_unstable();
    let number = (1_u64 << number_bits) - 1;
    let prim = |&word: &u64| &prims[(word & number) as usize];
    order.iter().map(prim).map(|prim| (prim.min * unit, prim.max * unit)).collect()
}

/// Two zeros behind each of the lower 21 bits.
fn spread(x: u64) -> u64 {
    let x = (x | x << 32) & 0x001f_0000_0000_ffff;
    let x = (x | x << 16) & 0x001f_0000_ff00_00ff;
    let x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
    let x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
    (x | x << 2) & 0x1249_2492_4924_9249
}
