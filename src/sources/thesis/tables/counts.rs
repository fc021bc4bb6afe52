//! Tables 5.9 to 5.11: steps, triangle tests and restarts per ray.

use super::context::Context;
use crate::report::{Column, Form, Row, Table};
use crate::sources::convention::Convention;
use crate::sources::thesis::data::Data;
use crate::sources::thesis::scenes::SceneKey;
use crate::sources::thesis::structures::{self, Step};

/// Columns by ray configuration: as in the thesis, each shows the rays that it adds.
const RAYS: [&str; 3] = ["P", "PS", "PSR"];

/// Table 5.9, 5.10 or 5.11.
pub fn counts(context: &Context, id: &str, structure: &str) -> Table {
    let convention = context.options.convention;
    type Ask<'a> = &'a dyn Fn(&Data, &SceneKey, usize) -> Option<f64>;
    let steps: Ask = &|d, key, ray| Some(d.thesis_counts(key, structure, ray)?.steps.by(convention));
    let tests: Ask = &|d, key, ray| Some(d.thesis_counts(key, structure, ray)?.tests);
    let restarts: Ask = &|d, key, ray| d.thesis_counts(key, structure, ray)?.restarts;
    let mut groups = vec![("steps", steps), ("tests", tests)];
    if structures::restarts(structure) {
        groups.push(("restarts", restarts));
    }
    let column = |group: &str, ray: &str| Column::of(group, ray, "", Form::Fixed(2));
    let columns = groups.iter().flat_map(|(name, _)| RAYS.map(|ray| column(name, ray))).collect();
    let rows: Vec<_> = context
        .scenes()
        .into_iter()
        .map(|key| {
            let cells = groups.iter().flat_map(|(_, ask)| (0..3).map(|ray| context.cell(|d| ask(d, &key, ray))));
            (key.clone(), Row { keys: vec![key.to_string()], cells: cells.collect() })
        })
        .collect();
    let title = format!("Steps and triangle tests per ray, {}", structures::title(structure));
    let mut table = context.table(id, title, &["scene"], columns, rows);
    let rays = "P: primary rays; PS: the shadow rays alone; PSR: the reflected rays alone.";
    if context.data.published {
        table.notes.push(rays.into());
        return table;
    }
    table
        .notes
        .push(format!("{rays} Counted at the largest square image that was measured: {}.", sizes(context, structure)));
    if structures::step(structure) == Step::Cell {
        table.notes.push("A step is a cell.".into());
        return table;
    }
    table.notes.push(format!(
        "A step here: {}. The thesis does not say what it counted; see --convention.",
        convention.in_words()
    ));
    if context.options.published {
        table.notes.extend(conventions(context, structure));
    }
    table
}

/// The sizes of the images that counts come from.
fn sizes(context: &Context, structure: &str) -> String {
    let pairs = context.scenes().into_iter().flat_map(|key| (0..3).map(move |ray| (key.clone(), ray)));
    let side = |(key, ray): (SceneKey, usize)| Some(context.data.thesis_counts(&key, structure, ray)?.resolution);
    let mut sides: Vec<u32> = pairs.filter_map(side).collect();
    sides.sort_unstable();
    sides.dedup();
    if sides.is_empty() {
        return "none".into();
    }
    sides.iter().map(|side| format!("{side}x{side}")).collect::<Vec<_>>().join(", ")
}

/// The geometric mean and the spread of the quotients of measured and published steps, by convention.
fn conventions(context: &Context, structure: &str) -> Option<String> {
    let mut words = Vec::new();
    let mut cells = 0;
    for convention in Convention::ALL {
        let steps = |data: &Data, key: &SceneKey, ray| {
            Some(data.thesis_counts(key, structure, ray)?.steps.by(convention)).filter(|s| *s > 0.0)
        };
        let pairs = context.scenes().into_iter().flat_map(|key| (0..3).map(move |ray| (key.clone(), ray)));
        let logs: Vec<f64> = pairs
            .filter_map(|(key, ray)| {
                Some((steps(context.data, &key, ray)? / steps(context.published, &key, ray)?).ln())
            })
            .collect();
        if logs.is_empty() {
            return None;
        }
        cells = logs.len();
        let mean = logs.iter().sum::<f64>() / cells as f64;
        let spread = logs.iter().map(|l| (l - mean).powi(2)).sum::<f64>() / cells as f64;
        words.push(format!("{} {:.2} (spread x{:.2})", convention.in_words(), mean.exp(), spread.sqrt().exp()));
    }
    Some(format!("Steps by published steps, geometric mean over {cells} cells: {}.", words.join("; ")))
}
