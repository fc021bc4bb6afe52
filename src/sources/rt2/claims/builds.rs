//! Cases from build times. Only times of one builder are compared: the one with the fewest threads that built all.

use super::frames::percentages;
use super::{Case, case};
use crate::compare::judge::{Outcome, Uncertain, all, less};
use crate::report::Form;
use crate::sources::rows::{BuiltBy, builders};
use crate::sources::rt2::data::{Data, counterparts};
use crate::sources::rt2::gains::agrees;
use crate::sources::rt2::models::{Model, SceneKey};
use crate::sources::rt2::published::{Published, Quantity};
use crate::sources::rt2::structures::{MIN_MAX, SORT, SWEEP, Structure};

/// Min-max, BVH and sort.
const THREE: [&Structure; 3] = [&MIN_MAX, &SWEEP, &SORT];

/// BVH and sort.
const TWO: [&Structure; 2] = [&SWEEP, &SORT];

/// Build times of structures by the first builder that built all of them.
fn times<const N: usize>(data: &Data, scene: &SceneKey, structures: [&Structure; N]) -> Option<[Uncertain; N]> {
    let of = |by: BuiltBy| {
        let times = structures.map(|structure| data.built(Some(by), scene, &[structure])?.build_ms);
        times.iter().all(Option::is_some).then(|| times.map(|ms| Uncertain::build(ms.unwrap_or_default())))
    };
    builders(data.built.iter()).into_iter().find_map(of)
}

fn models(data: &Data, models: &[Model]) -> Vec<SceneKey> {
    counterparts(&data.scenes_built(), models)
}

fn three(data: &Data, of: &[Model], judge: impl Fn([Uncertain; 3]) -> Outcome) -> Vec<Case> {
    let of_scene = |scene: &SceneKey| {
        let times = times(data, scene, THREE)?;
        let [min_max, bvh, sort] = times.map(|time| Form::Time.write(time.value));
        let numbers = format!("min-max {min_max}, BVH {bvh}, sort {sort} ms");
        Some(case(scene, "", judge(times), numbers))
    };
    models(data, of).iter().filter_map(of_scene).collect()
}

/// Claim 4: min-max < BVH < sort.
pub fn between(data: &Data) -> Vec<Case> {
    three(data, &[Model::Alien, Model::Dino], |[min_max, bvh, sort]| all([less(min_max, bvh), less(bvh, sort)]))
}

/// Claim 4a: the BVH takes longest.
pub fn slowest(data: &Data) -> Vec<Case> {
    three(data, &[Model::Dragon], |[min_max, bvh, sort]| all([less(min_max, bvh), less(sort, bvh)]))
}

/// Claim 5: the gains that were printed.
pub fn gains(data: &Data, published: &Published) -> Vec<Case> {
    let of = |scene: &SceneKey| {
        let printed = published.gain(scene.model()?, Quantity::BuildTime)?;
        let [bvh, sort] = times(data, scene, TWO)?;
        Some(case(scene, "", agrees(bvh, sort, printed), percentages(sort.value / bvh.value, printed)))
    };
    models(data, &Model::ALL).iter().filter_map(of).collect()
}

/// Scenes of claim 4 whose structures were built, but not by one builder.
pub fn unlike_between(data: &Data) -> Vec<String> {
    left_out(data, &[Model::Alien, Model::Dino], THREE)
}

/// The same for claim 4a.
pub fn unlike_slowest(data: &Data) -> Vec<String> {
    left_out(data, &[Model::Dragon], THREE)
}

/// The same for claim 5.
pub fn unlike_gains(data: &Data) -> Vec<String> {
    left_out(data, &Model::ALL, TWO)
}

fn left_out<const N: usize>(data: &Data, of: &[Model], structures: [&Structure; N]) -> Vec<String> {
    let is_left_out = |scene: &&SceneKey| {
        let all_built = structures.iter().all(|structure| data.built(None, scene, &[structure]).is_some());
        all_built && times(data, scene, structures).is_none()
    };
    let scenes = models(data, of);
    let names: Vec<String> = scenes.iter().filter(is_left_out).map(ToString::to_string).collect();
    if names.is_empty() {
        return Vec::new();
    }
    let why = "the structures were built by unlike processors or numbers of threads; sweep with --threads 1";
    vec![format!("Not measured on {}: {why}", names.join(", "))]
}
