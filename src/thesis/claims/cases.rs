//! Cases of claims 1 to 6: the three structures against each other.

use super::Case;
use super::compare::{Outcome, Uncertain, all, less};
use crate::thesis::builds::BuiltBy;
use crate::thesis::data::{Built, Data, Frame, STRUCTURES};
use crate::thesis::number::Number;
use crate::thesis::scenes::SceneKey;
use crate::thesis::table::Form;
use crate::thesis::variant::Variant;
use crate::workloads::trace::backend::Config;

/// Crowding of the fullest cell from which on a scene is not uniform: the thesis's three single objects have 1.5 to 2.7,
/// its walk-through scenes 15 to 180 (table 5.4).
pub const UNIFORM_CROWDING: f64 = 8.0;

/// How crowded a grid's fullest cell is. A surface of `n` even triangles passes through about the square of the number
/// of cells on a side, which by the rule is `16 sqrt(n)`: each of them holds `sqrt(n) / 16` triangles. Crowding is how many
/// times as many the fullest holds.
pub fn crowding(fullest: u32, triangles: u64) -> f64 {
    f64::from(fullest) / ((triangles.max(1) as f64).sqrt() / 16.0)
}

/// "More than a few percent" of the surface that mirrors.
pub const MIRRORS: f64 = 0.03;

/// A printed scene counts as shiny if reflections cost more than this much of the time with shadows alone: the thesis
/// does not print how much of a scene mirrors.
const PRINTED_REFLECTION_COST: f64 = 1.1;

/// True for evenly sized geometry, false for the rest; unknown where no grid was built by rule.
pub fn is_uniform(data: &Data, scene: &SceneKey) -> Option<bool> {
    if let Some(scene) = scene.thesis() {
        return Some(scene.is_object());
    }
    let fullest = data.built_of(scene, "grid", &Variant::default())?.properties.max_cell_triangles?;
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

/// A time in a case's numbers.
pub fn ms(value: impl Into<Number>) -> String {
    format!("{} ms", value.into().write(Form::Time))
}

/// Scenes of which there can be structures: a camera path makes no other scene of it.
fn scenes(data: &Data) -> impl Iterator<Item = &SceneKey> {
    data.scenes.iter().map(|s| &s.key).filter(|key| key.built() == *key)
}

/// Who built grid, kd-tree and BVH of a scene: only their times can be compared. The fewest threads first.
fn builders<'a>(data: &'a Data, scene: &SceneKey) -> Vec<BuiltBy<'a>> {
    data.builders().into_iter().filter(|by| data.thesis_trio(Some(*by), scene).is_some()).collect()
}

/// Claim 1: of several builders the one with the fewest threads, since the thesis had one.
pub fn build_times(data: &Data) -> Vec<Case> {
    let case = |scene: &SceneKey| {
        let by = *builders(data, scene).first()?;
        let [grid, kdtree, bvh] = data.thesis_trio(Some(by), scene)?.map(Built::time);
        let (grid, kdtree, bvh) = (grid?, kdtree?, bvh?);
        let time = |time: Number| Uncertain::build(time.value);
        let outcome = all([less(time(grid), time(bvh)), less(time(bvh), time(kdtree))]);
        let on = if by.threads == 1 { String::new() } else { format!(" ({} threads)", by.threads) };
        Some(Case::new(scene, "", outcome, format!("grid {}, BVH {}, kd-tree {}{on}", ms(grid), ms(bvh), ms(kdtree))))
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
                    add("Not judged", format!("builds on {by}, beside those on {first}"), scene);
                }
            }
        }
    }
    let line =
        |((verb, reason), scenes): ((&str, String), Vec<String>)| format!("{verb} on {}: {reason}", scenes.join(", "));
    reasons.into_iter().map(line).collect()
}

/// Why three structures of a scene cannot be compared.
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

/// Claim 2.
pub fn memory(data: &Data) -> Vec<Case> {
    let case = |scene: &SceneKey| {
        let [grid, kdtree, bvh] = data.thesis_trio(None, scene)?.map(|b| b.thesis_mib);
        let (grid, kdtree, bvh) = (grid?, kdtree?, bvh?);
        let outcome = all([
            less(Uncertain::exact(bvh), Uncertain::exact(kdtree)),
            less(Uncertain::exact(kdtree), Uncertain::exact(grid)),
        ]);
        Some(Case::new(scene, "", outcome, format!("BVH {bvh:.2}, kd-tree {kdtree:.2}, grid {grid:.2} MiB")))
    };
    scenes(data).filter_map(case).collect()
}

/// Grid, kd-tree and BVH with a scene and configuration, at each side that has all three, from the smallest.
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
            let outcome = judge(trio.map(|f| Uncertain::frame(data, f)));
            let [grid, kdtree, bvh] = trio.map(|f| ms(f.times()[2]));
            let numbers = format!("grid {grid}, kd-tree {kdtree}, BVH {bvh} at {side}x{side}", side = trio[0].width);
            cases.push(Case::new(scene, format!("{config:?}"), outcome, numbers));
        }
    }
    cases
}

/// Claim 3.
pub fn bvh_fastest(data: &Data, device: usize) -> Vec<Case> {
    let ordinary = |scene: &SceneKey| is_uniform(data, scene) == Some(false);
    by_trio((data, device), &[Config::P, Config::PS], ordinary, |[grid, kdtree, bvh]| {
        all([less(bvh, grid), less(bvh, kdtree)])
    })
}

/// Claim 4.
pub fn mirrors(data: &Data, device: usize) -> Vec<Case> {
    let shiny = |scene: &SceneKey| is_shiny(data, scene);
    by_trio((data, device), &[Config::PSR], shiny, |[grid, kdtree, bvh]| all([less(kdtree, bvh), less(bvh, grid)]))
}

/// Claim 5.
pub fn grid_slowest(data: &Data, device: usize) -> Vec<Case> {
    let ordinary = |scene: &SceneKey| is_uniform(data, scene) == Some(false);
    by_trio((data, device), &Config::ALL, ordinary, |[grid, kdtree, bvh]| all([less(kdtree, grid), less(bvh, grid)]))
}

/// By how much the time per ray falls from the smallest to the largest image, by structure, with the sides.
type Gains = ([Uncertain; 3], u32, u32);

fn gains(data: &Data, device: usize) -> Vec<(&SceneKey, Config, Gains)> {
    let mut all = Vec::new();
    for scene in data.scenes.iter().map(|s| &s.key) {
        for config in Config::ALL {
            let trios = trios(data, device, scene, config);
            let Some(large) = trios.last() else { continue };
            // The smallest image of the same frames
            let Some(small) = trios.iter().find(|trio| trio[0].workload == large[0].workload) else { continue };
            if small[0].width == large[0].width {
                continue;
            }
            let gain = |index: usize| {
                let [a, b] = [small[index], large[index]].map(|f| Uncertain::frame(data, f));
                let pixels = |f: &Frame| f64::from(f.width) * f64::from(f.height);
                let value = (a.value / pixels(small[index])) / (b.value / pixels(large[index]));
                Uncertain { value, noise: a.noise + b.noise, margin: a.margin.max(b.margin) }
            };
            all.push((scene, config, ([gain(0), gain(1), gain(2)], small[0].width, large[0].width)));
        }
    }
    all
}

fn gain_case(scene: &SceneKey, config: Config, outcome: Outcome, (gains, small, large): &Gains) -> Case {
    let [grid, kdtree, bvh] = gains.map(|g| g.value);
    let numbers = format!(
        "from {small} to {large} pixels a side the time per ray falls by grid {grid:.2}, kd-tree {kdtree:.2}, BVH {bvh:.2} times"
    );
    Case::new(scene, format!("{config:?}"), outcome, numbers)
}

/// Claim 6, first half.
pub fn time_per_ray_falls(data: &Data, device: usize) -> Vec<Case> {
    let one = Uncertain::exact(1.0);
    let case = |(scene, config, g): (&SceneKey, Config, Gains)| {
        gain_case(scene, config, all(g.0.map(|gain| less(one, gain))), &g)
    };
    gains(data, device).into_iter().map(case).collect()
}

/// Claim 6, second half.
pub fn bvh_gains_most(data: &Data, device: usize) -> Vec<Case> {
    let case = |(scene, config, g): (&SceneKey, Config, Gains)| {
        let [grid, kdtree, bvh] = g.0;
        gain_case(scene, config, all([less(grid, bvh), less(kdtree, bvh)]), &g)
    };
    gains(data, device).into_iter().map(case).collect()
}

/// A frame and the same with one option changed: claims 7 to 9.
pub fn changed<'a>(
    (data, device): (&'a Data, usize),
    structure: &str,
    config: Config,
    (key, value): (&str, &str),
) -> Vec<(&'a Frame, &'a Frame)> {
    let mut pairs: Vec<(&Frame, &Frame)> = Vec::new();
    for frame in &data.frames {
        let square = frame.width == frame.height;
        let base = Variant::of_thesis(frame.scene.thesis(), structure);
        if (frame.device, frame.config, frame.structure.as_str(), square) != (device, config, structure, true)
            || !frame.variant.is(&base, key, value)
        {
            continue;
        }
        let Some(plain) = data.frame(device, &frame.scene, (structure, &base), config, frame.width) else { continue };
        // Of several sizes the largest
        match pairs.iter_mut().find(|(p, _)| p.scene == plain.scene) {
            Some(pair) if pair.0.width < plain.width => *pair = (plain, frame),
            Some(_) => {}
            None => pairs.push((plain, frame)),
        }
    }
    pairs
}
