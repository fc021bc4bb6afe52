//! What each switch does on its own: how many times as fast a renderer is with one thing changed.

use super::context::{Context, Draft, Side};
use crate::report::{Column, Form, Row, Table};
use crate::sources::spheres::data::View;
use crate::sources::spheres::scenes::SceneKey;
use crate::sources::spheres::setting::{Algorithm, Hit, Renderer, Stage, Version};

const FIRST: Version = Stage::TwoPass.version();
const WITH_EXIT: Version = Version { exit_on_miss: true, ..FIRST };
const WITHOUT_EXIT: Version = Version { algorithm: Algorithm::OnePass, ..FIRST };
const ONE_PASS: Version = Stage::OnePass.version();
const LAST: Version = Stage::Exits.version();

/// A change: group and name of its column, before, after, and whether it is of SIMD alone.
struct Change {
    group: &'static str,
    name: &'static str,
    before: Version,
    after: Version,
    of_simd: bool,
}

const fn change(group: &'static str, name: &'static str, before: Version, after: Version, of_simd: bool) -> Change {
    Change { group, name, before, after, of_simd }
}

const CHANGES: [Change; 10] = [
    change("one pass", "without exit", FIRST, WITHOUT_EXIT, false),
    change("one pass", "with exit", WITH_EXIT, ONE_PASS, false),
    change("exit on a miss", "two-pass", FIRST, WITH_EXIT, false),
    change("exit on a miss", "one-pass", WITHOUT_EXIT, ONE_PASS, false),
    change("both", "", FIRST, ONE_PASS, false),
    change("skip", "no hit", ONE_PASS, Version { skip_no_hit: true, ..ONE_PASS }, true),
    change("skip", "no discriminant", ONE_PASS, Version { skip_no_discriminant: true, ..ONE_PASS }, true),
    change("skip", "both", ONE_PASS, LAST, true),
    change("index", "no skips", ONE_PASS, Version { hit: Hit::Index, ..ONE_PASS }, false),
    change("index", "skips", LAST, Version { hit: Hit::Index, ..LAST }, true),
];

/// How many times as fast a renderer of so many lanes is after a change.
fn gain(view: &View, scene: &SceneKey, renderer: Renderer, lanes: usize, change: &Change) -> Option<f64> {
    let is_of_renderer = if renderer.has_lanes() { true } else { !change.of_simd };
    let is_hit = change.group == "index" && renderer == Renderer::Gpu;
    if !is_of_renderer || is_hit {
        return None;
    }
    let ms = |version: Version| Some(view.version(scene, renderer, Version { lanes, ..version })?.mean_ms);
    Some(ms(change.before)? / ms(change.after)?)
}

/// The table.
pub fn table(context: &Context, side: &Side) -> Table {
    let columns = CHANGES.iter().map(|c| Column::of(c.group, c.name, "", Form::Fixed(2))).collect();
    let mut rows = Vec::new();
    for scene in context.scenes(side) {
        for renderer in Renderer::ALL {
            let all_lanes: &[usize] = if renderer.has_lanes() { &[4, 8, 16] } else { &[4] };
            for lanes in all_lanes {
                let cell = |c: &Change| side.ratio(&scene, |view, scene| gain(view, scene, renderer, *lanes, c));
                let cells = CHANGES.iter().map(cell).collect();
                let name = match renderer.has_lanes() {
                    true => format!("{}, {lanes} lanes", renderer.title()),
                    false => renderer.title().to_owned(),
                };
                let row = Row { keys: vec![scene.to_string(), name], cells };
                let is_first = scene.is_of_paper() && renderer == Renderer::Sequential;
                if row.is_filled() || is_first {
                    rows.push((scene.clone(), row));
                }
            }
        }
    }
    let notes = vec![
        "How many times as fast: the time before a change by the time after it, all else equal. The paper changed one \
         pass and the exit on a miss together (both)."
            .to_owned(),
    ];
    let title = "What each switch does".to_owned();
    context.table(side, Draft { id: "switches", title, keys: &["scene", "renderer"], columns, rows, notes })
}
