//! Cases of claims 1 to 6: the three structures against each other.

use super::{Case, case, frame_time};
use crate::compare::judge::{Outcome, Uncertain, all, less};
use crate::report::{Form, Number};
use crate::sources::rows::BuiltBy;
use crate::sources::thesis::data::{Built, CONFIGS, Data, Frame};
use crate::sources::thesis::scenes::SceneKey;
use crate::sources::thesis::structures::{GRID, STRUCTURES};
use crate::sources::thesis::variant::Variant;
use crate::workloads::trace::backend::Config;

/// A scene whose fullest cell is at least so crowded is not uniform: the thesis's three single objects have 1.5 to 2.7,
/// its walk-through scenes 15 to 180 (table 5.4).
pub const UNIFORM_CROWDING: f64 = 8.0;

/// The crowding of a grid's fullest cell. A surface of `n` even triangles passes through about the square of the number
/// of cells on a side, which by the rule is `16 sqrt(n)`: each of these cells holds `sqrt(n) / 16` triangles. Crowding
/// is the quotient of the triangles in the fullest cell and this number.
pub fn crowding(fullest: u32, triangles: u64) -> f64 {
    f64::from(fullest) / ((triangles.max(1) as f64).sqrt() / 16.0)
}

/// The share of mirrors that the claims call "more than a few percent".
pub const MIRRORS: f64 = 0.03;

/// The thesis does not print how much of a scene mirrors: a printed scene counts as shiny if the time with reflections
/// is more than so many times the time with shadows alone.
const PRINTED_REFLECTION_COST: f64 = 1.1;

/// True for evenly sized geometry, false for other geometry; unknown if no grid was built by rule.
pub fn is_uniform(data: &Data, scene: &SceneKey) -> Option<bool> {
    if let Some(scene) = scene.thesis() {
        return Some(scene.is_object());
    }
    let fullest = data.built_of(scene, GRID, &Variant::default())?.properties.max_cell_triangles?;
    Some(crowding(fullest, data.scene(scene)?.triangles) < UNIFORM_CROWDING)
}

/// True if more than a few percent of a scene mirror.
pub fn is_shiny(data: &Data, scene: &SceneKey) -> bool {
    match data.scene(scene).and_then(|s| s.mirror_share) {
        Some(share) => share > MIRRORS,
        None => {
            let time = |config| data.frames.iter().find(|f| f.scene == *scene && f.config == config).map(|f| f.mean_ms);
            time(Config::PSR).zip(time(Config::PS)).is_some_and(|(psr, ps)| psr / ps > PRINTED_REFLECTION_COST)
        }
    }
}

/// Writes a time for a case's numbers.
pub fn ms(value: impl Into<Number>) -> String {
    format!("{} ms", value.into().write(Form::Time))
}

impl Data {
    /// Writes a frame's time, or work in its place, for a case's numbers.
    pub fn write_time(&self, value: impl Into<Number>) -> String {
        if self.modelled { format!("{} M", value.into().write(Form::Time)) } else { ms(value) }
    }
}

/// Scenes that structures are built of: a camera path makes no other scene.
fn scenes(data: &Data) -> impl Iterator<Item = &SceneKey> {
    data.scenes.iter().map(|s| &s.key).filter(|key| key.built() == *key)
}

/// The builders of all three structures of a scene: only their times can be compared. The fewest threads first.
fn builders<'a>(data: &'a Data, scene: &SceneKey) -> Vec<BuiltBy<'a>> {
    data.builders().into_iter().filter(|by| data.thesis_trio(Some(*by), scene).is_some()).collect()
}

/// Claim 1, by the builder with the fewest threads, because the thesis built on one.
pub fn build_times(data: &Data) -> Vec<Case> {
    let case = |scene: &SceneKey| {
        let by = *builders(data, scene).first()?;
        let [grid, kdtree, bvh] = data.thesis_trio(Some(by), scene)?.map(Built::time);
        let (grid, kdtree, bvh) = (grid?, kdtree?, bvh?);
        let time = |time: Number| Uncertain::build(time.value);
        let outcome = all([less(time(grid), time(bvh)), less(time(bvh), time(kdtree))]);
        let on = if by.threads == 1 { String::new() } else { format!(" ({} threads)", by.threads) };
        Some(case(scene, "", outcome, format!("grid {}, BVH {}, kd-tree {}{on}", ms(grid), ms(bvh), ms(kdtree))))
    };
    scenes(data).filter_map(case).collect()
}

/// Builds that claim 1 does not compare, each reason with its scenes.
pub fn unlike_builds(data: &Data) -> Vec<String> {
    let mut reasons: Vec<((&str, String), Vec<String>)> = Vec::new();
    let mut add = |verb, reason: String, scene: &SceneKey| {
        let reason = (verb, reason);
        match reasons.iter_mut().find(|(known, _)| *known == reason) {
            Some((_, scenes)) => scenes.push(scene.to_string()),
            None => reasons.push((reason, vec![scene.to_string()])),
        }
    };
    for scene in scenes(data) {
        match &builders(data, scene)[..] {
            [] => {
                if let Some(trio) = data.thesis_trio(None, scene) {
                    add("Not measured", unlike(&trio), scene);
                }
            }
            [first, further @ ..] => {
                for by in further {
                    let (by, first) = (by.in_words(), first.in_words());
                    add("Not judged", format!("builds on {by}, in addition to those on {first}"), scene);
                }
            }
        }
    }
    let line =
        |((verb, reason), scenes): ((&str, String), Vec<String>)| format!("{verb} on {}: {reason}", scenes.join(", "));
    reasons.into_iter().map(line).collect()
}

/// The reason why three structures of a scene cannot be compared.
fn unlike(trio: &[&Built; 3]) -> String {
    let [grid, kdtree, bvh] = trio.map(|b| b.by().threads);
    if [kdtree, bvh] == [grid; 2] {
        return "the structures were built by unlike processors".into();
    }
    let [grid, kdtree, bvh] = [grid, kdtree, bvh].map(threads);
    format!("built on {grid} (grid), {bvh} (BVH) and {kdtree} (kd-tree); sweep with --threads 1")
}

fn threads(number: usize) -> String {
    if number == 1 { "1 thread".into() } else { format!("{number} threads") }
}

/// Claim 2: sizes.
pub fn memory(data: &Data) -> Vec<Case> {
    let case = |scene: &SceneKey| {
        let [grid, kdtree, bvh] = data.thesis_trio(None, scene)?.map(|b| b.thesis_mib);
        let (grid, kdtree, bvh) = (grid?, kdtree?, bvh?);
        let outcome = all([
            less(Uncertain::exact(bvh), Uncertain::exact(kdtree)),
            less(Uncertain::exact(kdtree), Uncertain::exact(grid)),
        ]);
        Some(case(scene, "", outcome, format!("BVH {bvh:.2}, kd-tree {kdtree:.2}, grid {grid:.2} MiB")))
    };
    scenes(data).filter_map(case).collect()
}

/// Grid, kd-tree and BVH of a scene and configuration, at each side that has all three, from the smallest.
fn trios<'a>(data: &'a Data, device: usize, scene: &SceneKey, config: Config) -> Vec<[&'a Frame; 3]> {
    let trio = |side| {
        let [grid, kdtree, bvh] = STRUCTURES.map(|s| data.thesis_frame(device, scene, s, config, side));
        Some([grid?, kdtree?, bvh?])
    };
    data.sides(device).into_iter().filter_map(trio).collect()
}

/// One case per scene and configuration, from the largest image that all three structures have.
fn by_trio(
    (data, device): (&Data, usize),
    configs: &[Config],
    of: impl Fn(&SceneKey) -> bool,
    judge: impl Fn([Uncertain; 3]) -> Outcome,
) -> Vec<Case> {
    let mut cases = Vec::new();
    for scene in data.scenes.iter().map(|s| &s.key).filter(|key| of(key)) {
        for config in configs {
            let Some(trio) = trios(data, device, scene, *config).pop() else { continue };
            let outcome = judge(trio.map(|f| frame_time(data, f)));
            let [grid, kdtree, bvh] = trio.map(|f| data.write_time(f.times()[2]));
            let numbers = format!("grid {grid}, kd-tree {kdtree}, BVH {bvh} at {side}x{side}", side = trio[0].width);
            cases.push(case(scene, format!("{config:?}"), outcome, numbers));
        }
    }
    cases
}

/// Claim 3: the BVH is fastest.
pub fn bvh_fastest(data: &Data, device: usize) -> Vec<Case> {
    let ordinary = |scene: &SceneKey| is_uniform(data, scene) == Some(false);
    by_trio((data, device), &[Config::P, Config::PS], ordinary, |[grid, kdtree, bvh]| {
        all([less(bvh, grid), less(bvh, kdtree)])
    })
}

/// Claim 4: the kd-tree is fastest with mirrors.
pub fn mirrors(data: &Data, device: usize) -> Vec<Case> {
    let shiny = |scene: &SceneKey| is_shiny(data, scene);
    by_trio((data, device), &[Config::PSR], shiny, |[grid, kdtree, bvh]| all([less(kdtree, bvh), less(bvh, grid)]))
}

/// Claim 5: the grid is slowest.
pub fn grid_slowest(data: &Data, device: usize) -> Vec<Case> {
    let ordinary = |scene: &SceneKey| is_uniform(data, scene) == Some(false);
    by_trio((data, device), &CONFIGS, ordinary, |[grid, kdtree, bvh]| all([less(kdtree, grid), less(bvh, grid)]))
}

/// The quotients of the time per ray in the smallest and in the largest image, by structure, with both sides.
type Gains = ([Uncertain; 3], u32, u32);

fn gains(data: &Data, device: usize) -> Vec<(&SceneKey, Config, Gains)> {
    let mut all = Vec::new();
    for scene in data.scenes.iter().map(|s| &s.key) {
        for config in CONFIGS {
            let trios = trios(data, device, scene, config);
            let Some(large) = trios.last() else { continue };
            // The smallest image of the same frames
            let Some(small) = trios.iter().find(|trio| trio[0].conditions == large[0].conditions) else { continue };
            if small[0].width == large[0].width {
                continue;
            }
            let gain = |index: usize| {
                let [a, b] = [small[index], large[index]].map(|f| frame_time(data, f));
                let pixels = |f: &Frame| f64::from(f.width) * f64::from(f.height);
                let value = (a.value / pixels(small[index])) / (b.value / pixels(large[index]));
                Uncertain { value, noise: a.noise + b.noise, margin: a.margin.max(b.margin) }
            };
            all.push((scene, config, ([gain(0), gain(1), gain(2)], small[0].width, large[0].width)));
        }
    }
    all
}

fn gain_case(
    data: &Data,
    (scene, config): (&SceneKey, Config),
    outcome: Outcome,
    (gains, small, large): &Gains,
) -> Case {
    let what = if data.modelled { "work" } else { "time" };
    let [grid, kdtree, bvh] = gains.map(|g| g.value);
    let numbers = format!(
        "from {small} to {large} pixels a side the {what} per ray falls by grid {grid:.2}, kd-tree {kdtree:.2}, BVH \
         {bvh:.2} times"
    );
    case(scene, format!("{config:?}"), outcome, numbers)
}

/// Claim 6a: time per ray falls with resolution.
pub fn time_per_ray_falls(data: &Data, device: usize) -> Vec<Case> {
    let one = Uncertain::exact(1.0);
    let case = |(scene, config, g): (&SceneKey, Config, Gains)| {
        gain_case(data, (scene, config), all(g.0.map(|gain| less(one, gain))), &g)
    };
    gains(data, device).into_iter().map(case).collect()
}

/// Claim 6b: it falls most for the BVH.
pub fn bvh_gains_most(data: &Data, device: usize) -> Vec<Case> {
    let case = |(scene, config, g): (&SceneKey, Config, Gains)| {
        let [grid, kdtree, bvh] = g.0;
        gain_case(data, (scene, config), all([less(grid, bvh), less(kdtree, bvh)]), &g)
    };
    gains(data, device).into_iter().map(case).collect()
}

/// Pairs of a frame and the same with one option changed, one pair per scene, for claims 7 to 9.
pub fn changed<'a>(
    (data, device): (&'a Data, usize),
    structure: &str,
    config: Config,
    (key, value): (&str, &str),
) -> Vec<(&'a Frame, &'a Frame)> {
    let mut pairs: Vec<(&Frame, &Frame)> = Vec::new();
    for frame in data.frames.iter() {
        let square = frame.width == frame.height;
        let base = Variant::of_thesis(frame.scene.thesis(), structure);
        if (frame.device, frame.config, frame.structure.as_str(), square) != (device, config, structure, true)
            || !frame.variant.is(&base, key, value)
        {
            continue;
        }
        let Some(plain) = data.frame(device, &frame.scene, (structure, &base), config, frame.width) else { continue };
        // Of several sizes, the largest is kept
        match pairs.iter_mut().find(|(p, _)| p.scene == plain.scene) {
            Some(pair) if pair.0.width < plain.width => *pair = (plain, frame),
            Some(_) => {}
            None => pairs.push((plain, frame)),
        }
    }
    pairs
}
