//! Cases from sizes and properties of structures, which no device and no builder changes.

use super::frames::pointed_and_compact;
use super::{Case, case};
use crate::compare::judge::{Outcome, Uncertain, all, less, not};
use crate::sources::rt2::data::{Built, Data, counterparts};
use crate::sources::rt2::models::{Model, SceneKey};
use crate::sources::rt2::structures::{KDTREES, SPATIALS, SWEPT, Trees, WITH_ROPES};

/// Bytes that ropes take for a leaf in the model: a box and six links.
const ROPE_BYTES: u64 = 48;

/// A difference of expected costs below this share decides nothing.
const COST_MARGIN: f64 = 0.01;

/// Scenes of evenly spread triangles, besides the evenly meshed scans.
const EVEN: [&str; 4] = ["bunny", "bun_zipper", "dragon", "dragon_vrip"];

/// Scenes of unevenly spread triangles.
const UNEVEN: [&str; 2] = ["room", "sponza"];

fn bytes(built: &Built) -> Option<u64> {
    built.memory.map(|memory| memory.rt2_bytes).filter(|bytes| *bytes > 0)
}

/// Claim 6: orders of memory on the models. An evenly meshed scan of the Dino's size has not its shape.
pub fn orders(data: &Data) -> Vec<Case> {
    let of = |scene: &SceneKey| {
        let of = |trees: Trees| bytes(data.built(None, scene, trees)?);
        let [stack, bvh, ropes] = [of(KDTREES), of(SWEPT), of(WITH_ROPES)];
        let (stack, bvh, ropes) = (stack?, bvh?, ropes?);
        let exact = |bytes: u64| Uncertain::exact(bytes as f64);
        let by_shape = less(exact(stack), exact(bvh));
        let by_shape = if scene.is_pointed() { not(by_shape) } else { by_shape };
        let per_triangle = |bytes: u64| bytes as f64 / scene.triangles.max(1) as f64;
        let numbers = format!(
            "kd-tree {:.1}, BVH {:.1}, ropes {:.1} bytes per triangle",
            per_triangle(stack),
            per_triangle(bvh),
            per_triangle(ropes)
        );
        let what = if scene.is_pointed() { "pointed" } else { "" };
        Some(case(scene, what, all([less(exact(bvh), exact(ropes)), by_shape]), numbers))
    };
    let scenes = counterparts(&data.scenes_built(), &Model::ALL);
    let has_shape = |scene: &&SceneKey| scene.model() != Some(Model::Dino) || scene.is_pointed();
    scenes.iter().filter(has_shape).filter_map(of).collect()
}

/// Claim 6a: leaves per triangle.
pub fn leaves_of_points(data: &Data) -> Vec<Case> {
    let leaves = |scene: &SceneKey| {
        let leaves = data.built(None, scene, KDTREES)?.properties.leaves?;
        Some(Uncertain::exact(f64::from(leaves) / scene.triangles.max(1) as f64))
    };
    let of = |(pointed, compact): (&SceneKey, &SceneKey)| {
        let (here, there) = (leaves(pointed)?, leaves(compact)?);
        let numbers = format!("{:.3} leaves per triangle here, {:.3} on {compact}", here.value, there.value);
        Some(case(pointed, format!("and {compact}"), less(there, here), numbers))
    };
    pointed_and_compact(&data.scenes_built()).into_iter().filter_map(of).collect()
}

/// Claim 7: bytes of ropes for a leaf.
pub fn bytes_of_ropes(data: &Data) -> Vec<Case> {
    let of = |scene: &SceneKey| {
        let ropes = data.built(None, scene, WITH_ROPES)?;
        let (with, without) = (bytes(ropes)?, bytes(data.built(None, scene, KDTREES)?)?);
        let leaves = u64::from(ropes.properties.leaves?).max(1);
        let is_exact = with == without + ROPE_BYTES * leaves;
        let outcome = if is_exact { Outcome::Agrees } else { Outcome::Contradicts };
        let numbers =
            format!("{:.2} bytes for each of {leaves} leaves", (with as f64 - without as f64) / leaves as f64);
        Some(case(scene, "", outcome, numbers))
    };
    data.scenes_built().iter().filter_map(of).collect()
}

/// Claim 9: spatial splits lower the expected cost on even scenes, and do not on uneven ones.
pub fn suits(data: &Data) -> Vec<Case> {
    let of = |scene: &SceneKey| {
        let is_even = scene.is_even_scan() || EVEN.contains(&scene.stem());
        if !is_even && !UNEVEN.contains(&scene.stem()) {
            return None;
        }
        let cost = |trees: Trees| {
            let value = data.built(None, scene, trees)?.properties.sah_cost?;
            Some(Uncertain { value, noise: 0.0, margin: COST_MARGIN })
        };
        let (spatial, object) = (cost(SPATIALS)?, cost(SWEPT)?);
        let lower = less(spatial, object);
        let outcome = if is_even { lower } else { not(lower) };
        // No sign where a tenth of a percent shows nothing
        let tenths = (1000.0 * (spatial.value / object.value - 1.0)).round();
        let change = if tenths == 0.0 { "0.0".to_owned() } else { format!("{:+.1}", tenths / 10.0) };
        let numbers = format!("spatial {:.2}, object {:.2}: {change} %", spatial.value, object.value);
        Some(case(scene, if is_even { "even" } else { "uneven" }, outcome, numbers))
    };
    data.scenes_built().iter().filter_map(of).collect()
}

/// Claim 10: the overlap of the children of spatial splits.
pub fn overlap(data: &Data) -> Vec<Case> {
    let of = |scene: &SceneKey| {
        let properties = &data.built(None, scene, SPATIALS)?.properties;
        let (splits, share) = (properties.spatial_splits?, properties.spatial_overlap?);
        let outcome = match splits {
            0 => Outcome::Undecided,
            _ if share > 0.0 => Outcome::Contradicts,
            _ => Outcome::Agrees,
        };
        let numbers = format!("at most {:.4} % of a node's volume in {splits} spatial splits", 100.0 * share);
        Some(case(scene, "", outcome, numbers))
    };
    data.scenes_built().iter().filter_map(of).collect()
}
