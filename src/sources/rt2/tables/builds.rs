//! Figure 4.5: build times, and the BVH's gain over the kd-tree of the exact sweep.

use super::context::{Context, Gains, Place};
use crate::report::{Cell, Column, Form, Row, Table};
use crate::sources::rows::{BuiltBy, builders};
use crate::sources::rt2::data::Data;
use crate::sources::rt2::models::SceneKey;
use crate::sources::rt2::published::Quantity;
use crate::sources::rt2::structures::{BIH, BVH, CULLED, MIN_MAX, ROPES, SORT, SPATIAL, STACK, SWEEP, Trees, UNPUSHED};

const ID: &str = "4.5";

/// A column: its heading, and the structures of which any will do because their trees are built alike.
type Tree = (&'static str, Trees);

/// Builders that sort in every node, as the document's; min-max sorts nothing.
const ALIKE: [Tree; 3] = [("min-max", &[&MIN_MAX]), ("BVH", &[&SWEEP]), ("sort", &[&SORT])];

/// The same trees, sorted once.
const ONCE: [Tree; 2] = [("BVH", &[&BVH, &CULLED]), ("sort", &[&STACK])];

/// What the document did not measure.
const BEYOND: [Tree; 4] =
    [("ropes", &[&ROPES]), ("unpushed", &[&UNPUSHED]), ("spatial", &[&SPATIAL]), ("BIH", &[&BIH])];

/// The tables of each builder; without runs, the printed orders and percentages.
pub fn tables(context: &Context) -> Vec<Table> {
    let places = |scenes: &[SceneKey]| context.places(scenes);
    let Some(data) = context.data else {
        let none = |_: &SceneKey, _: Trees| None;
        return of_builder(context, &places(&[]), None, none);
    };
    let places = places(&data.scenes_built());
    let builders = builders(data.built.iter());
    if builders.is_empty() {
        return of_builder(context, &places, None, |_, _| None);
    }
    let of = |by: &BuiltBy| {
        let time = |scene: &SceneKey, trees: Trees| data.built(Some(*by), scene, trees)?.build_ms;
        let mut tables = of_builder(context, &places, Some(*by), time);
        tables[0].notes.extend(times_built(data, by));
        tables
    };
    builders.iter().flat_map(of).collect()
}

fn of_builder(
    context: &Context,
    places: &[Place],
    by: Option<BuiltBy>,
    time: impl Fn(&SceneKey, Trees) -> Option<f64>,
) -> Vec<Table> {
    let titled = |what: &str| by.map_or(what.to_owned(), |by| format!("{what}, {}", by.in_words()));
    let mut columns: Vec<Column> =
        ALIKE.iter().map(|(name, _)| Column::of("sorted in every node", name, "ms", Form::Time)).collect();
    columns.push(Column::of("sorted in every node", "fastest first", "", Form::Whole));
    let row = |place: &Place| {
        let of = |(_, trees): &Tree| place.scene.as_ref().and_then(|scene| time(scene, trees));
        let mut cells: Vec<Cell> = ALIKE.iter().map(|tree| Cell::number(of(tree))).collect();
        cells.push(context.order(place, Quantity::BuildTime, &ALIKE.map(|tree| (tree.0, of(&tree))), false));
        (place.clone(), Row { keys: context.keys(place), cells })
    };
    let keys = ["model", "scene"];
    let rows = places.iter().map(row).collect();
    let mut first = context.table(ID, titled("Build times"), &keys, columns, rows);
    first.notes.push(
        "min-max sorts nothing. Only builders that sort in every node are like those of the document, as far as it \
         says."
            .into(),
    );
    let kinds = [("every node", true), ("once", false)];
    let ratio = |scene: &SceneKey, kind: usize| {
        let (bvh, sort) = if kind == 0 { (ALIKE[1], ALIKE[2]) } else { (ONCE[0], ONCE[1]) };
        Some(time(scene, sort.1)? / time(scene, bvh.1)?)
    };
    let gains = Gains { quantity: Quantity::BuildTime, key: "sorted", kinds };
    let title = titled("Gain of the BVH over the kd-tree in build time");
    let mut tables = vec![first, context.gains(ID, title, places, &gains, ratio)];
    if context.data.is_some() {
        let once = ONCE.iter().map(|tree| ("sorted once", tree));
        let all: Vec<(&str, &Tree)> = once.chain(BEYOND.iter().map(|tree| ("beyond the document", tree))).collect();
        let columns = all.iter().map(|(group, (name, _))| Column::of(group, name, "ms", Form::Time)).collect();
        let row = |place: &Place| {
            let of = |(_, trees): &Tree| place.scene.as_ref().and_then(|scene| time(scene, trees));
            let cells = all.iter().map(|(_, tree)| Cell::number(of(tree))).collect();
            (place.clone(), Row { keys: context.keys(place), cells })
        };
        let title = titled("Build times of trees sorted once, and of structures beyond the document");
        tables.push(context.table(ID, title, &keys, columns, places.iter().map(row).collect()));
    }
    tables
}

/// The number of builds that the times of a builder are medians of.
fn times_built(data: &Data, by: &BuiltBy) -> Option<String> {
    let mut numbers: Vec<usize> = data.built.iter().filter(|b| b.by() == *by).map(|b| b.builds).collect();
    numbers.sort_unstable();
    numbers.dedup();
    match numbers[..] {
        [] => None,
        [1] => Some("Each structure was built once.".into()),
        [number] => Some(format!("Each time is the median of {number} builds.")),
        _ => {
            let words: Vec<String> = numbers.iter().map(ToString::to_string).collect();
            Some(format!("Times are medians of unlike numbers of builds: {}.", words.join(" or ")))
        }
    }
}
