//! Cases from frame times, or from steps in their place; and those of claim 11, from a counter.

use super::{Case, Frames, case};
use crate::compare::judge::{Outcome, Uncertain, all, less};
use crate::report::Form;
use crate::sources::rt2::data::{Cost, Data, counterparts};
use crate::sources::rt2::gains::{Reading, agrees};
use crate::sources::rt2::models::{Model, SceneKey};
use crate::sources::rt2::published::{Published, Quantity};
use crate::sources::rt2::structures::{BIH, BVH, CULLED, ROPES, STACK, Structure};

/// Built-in scenes of several separate objects, or with empty space between the camera and what it sees.
pub const SEPARATE: [&str; 2] = ["sphereflake", "room"];

/// The share of a BIH's inner visits that enter neither child from which one says something.
const SKIPS: f64 = 0.001;

impl Frames<'_> {
    fn of(&self, scene: &SceneKey, structure: &Structure) -> Option<Uncertain> {
        self.data.cost((self.device, self.size), scene, structure, self.cost)
    }

    fn scenes(&self) -> Vec<SceneKey> {
        self.data.scenes_of(self.device)
    }

    fn counterparts(&self) -> Vec<SceneKey> {
        counterparts(&self.scenes(), &Model::ALL)
    }

    fn write(&self, number: Uncertain) -> String {
        let form = if self.cost == Cost::Steps { Form::Fixed(2) } else { Form::Time };
        form.write(number.value)
    }

    /// How many times as much a structure costs as another. Noise and margin are those of both.
    fn quotient(&self, scene: &SceneKey, dear: &Structure, cheap: &Structure) -> Option<Uncertain> {
        let (a, b) = (self.of(scene, dear)?, self.of(scene, cheap)?);
        Some(Uncertain { value: a.value / b.value, noise: a.noise + b.noise, margin: a.margin.max(b.margin) })
    }
}

/// Claim 1: ropes are faster than the stack and than the BVH as printed.
pub fn ropes_fastest(frames: &Frames) -> Vec<Case> {
    let of = |scene: &SceneKey| {
        let [ropes, stack, bvh] = [&ROPES, &STACK, &BVH].map(|structure| frames.of(scene, structure));
        let (ropes, stack, bvh) = (ropes?, stack?, bvh?);
        let [a, b, c] = [ropes, stack, bvh].map(|number| frames.write(number));
        let numbers = format!("ropes {a}, kd-tree {b}, BVH {c} {}", frames.cost.unit());
        Some(case(scene, "", all([less(ropes, stack), less(ropes, bvh)]), numbers))
    };
    frames.counterparts().iter().filter_map(of).collect()
}

/// Claims 2u and 2c: the kd-tree with a stack against one of the BVHs.
pub fn kdtree_faster(frames: &Frames, bvh: &Structure) -> Vec<Case> {
    let of = |scene: &SceneKey| {
        let (stack, other) = (frames.of(scene, &STACK)?, frames.of(scene, bvh)?);
        let numbers = format!(
            "kd-tree {}, BVH {} {}: {:.2} times",
            frames.write(stack),
            frames.write(other),
            frames.cost.unit(),
            other.value / stack.value
        );
        Some(case(scene, "", less(stack, other), numbers))
    };
    frames.counterparts().iter().filter_map(of).collect()
}

/// Claim 2a: the gains that were printed.
pub fn gains(frames: &Frames, published: &Published) -> Vec<Case> {
    let of = |scene: &SceneKey| {
        let printed = published.gain(scene.model()?, Quantity::FrameRate)?;
        let (stack, bvh) = (frames.of(scene, &STACK)?, frames.of(scene, &BVH)?);
        // The claim has a margin of its own, but the model tells small differences not apart
        let is_time = frames.cost != Cost::Work;
        let [own, other] =
            [stack, bvh].map(|number| Uncertain { margin: if is_time { 0.0 } else { number.margin }, ..number });
        Some(case(scene, "", agrees(own, other, printed), percentages(bvh.value / stack.value, printed)))
    };
    frames.counterparts().iter().filter_map(of).collect()
}

/// A ratio as a gain in both readings, with the printed one.
pub fn percentages(ratio: f64, printed: f64) -> String {
    let [more, less] = Reading::ALL.map(|reading| (reading.percent(ratio), reading.formula()));
    format!("ratio {ratio:.2}: {:.0} % ({}) or {:.0} % ({}), printed {printed:.0} %", more.0, more.1, less.0, less.1)
}

/// The pointed shapes, each with the evenly meshed scans of Alien's and Dino's size.
pub fn pointed_and_compact(scenes: &[SceneKey]) -> Vec<(&SceneKey, &SceneKey)> {
    let is_small = |scene: &&SceneKey| matches!(scene.model(), Some(Model::Alien | Model::Dino));
    let compact = || scenes.iter().filter(is_small).filter(|scene| scene.is_even_scan());
    let pointed = scenes.iter().filter(|scene| scene.is_pointed());
    pointed.flat_map(|pointed| compact().map(move |compact| (pointed, compact))).collect()
}

/// Claim 3: the kd-tree's lead on a pointed shape against that on a compact one.
pub fn lead_on_points(frames: &Frames) -> Vec<Case> {
    let scenes = frames.scenes();
    let of = |(pointed, compact): (&SceneKey, &SceneKey)| {
        let lead = |scene| frames.quotient(scene, &BVH, &STACK);
        let (on_points, on_compact) = (lead(pointed)?, lead(compact)?);
        let numbers = format!("BVH to kd-tree {:.2} here, {:.2} on {compact}", on_points.value, on_compact.value);
        Some(case(pointed, format!("and {compact}"), less(on_points, on_compact), numbers))
    };
    pointed_and_compact(&scenes).into_iter().filter_map(of).collect()
}

/// Claim 8: the ratio of the kd-tree to either BVH where objects are separate, against that on the nearest even scan.
pub fn separate_objects(frames: &Frames) -> Vec<Case> {
    let scenes = frames.scenes();
    let mut cases = Vec::new();
    for scene in scenes.iter().filter(|scene| SEPARATE.contains(&scene.base())) {
        for (bvh, cull) in [(&BVH, "cull=off"), (&CULLED, "cull=on")] {
            let ratio = |scene: &SceneKey| frames.quotient(scene, &STACK, bvh);
            let scans = scenes.iter().filter(|other| other.is_even_scan() && ratio(other).is_some());
            let nearest = scans.min_by_key(|other| other.triangles.abs_diff(scene.triangles));
            let Some((here, scan)) = ratio(scene).zip(nearest) else { continue };
            let Some(there) = ratio(scan) else { continue };
            let numbers = format!("kd-tree to BVH {:.2} here, {:.2} on {scan}", here.value, there.value);
            cases.push(case(scene, cull, less(there, here), numbers));
        }
    }
    cases
}

/// Claim 11: visits of a BIH's inner nodes that enter neither child. Of several measurements of a scene the first.
pub fn skips(data: &Data) -> Vec<Case> {
    let mut cases: Vec<Case> = Vec::new();
    let of_bih = data.measurements.iter().filter(|m| BIH.is(&m.frame.structure, &m.frame.variant));
    for measurement in of_bih {
        let scene = &measurement.frame.scene;
        let Some(sums) = measurement.primary.filter(|sums| sums.inner > 0) else { continue };
        if cases.iter().any(|case| case.scene == scene.to_string()) {
            continue;
        }
        let share = sums.skips as f64 / sums.inner as f64;
        let outcome = match sums.skips {
            0 => Outcome::Contradicts,
            _ if share >= SKIPS => Outcome::Agrees,
            _ => Outcome::Undecided,
        };
        let numbers = format!("{} of {} visits enter neither child ({:.2} %)", sums.skips, sums.inner, 100.0 * share);
        cases.push(case(scene, "", outcome, numbers));
    }
    cases
}
