//! The order of structures by the SIMT model, next to that of published times.

use super::context::Context;
use crate::report::{Cell, Column, Form, Number, Row, Table};
use crate::sources::thesis::data::{CONFIGS, Data};
use crate::sources::thesis::published;
use crate::sources::thesis::scenes::SceneKey;
use crate::sources::thesis::structures::{self, STRUCTURES};
use crate::workloads::trace::backend::Config;

const WHAT: &str = "Instructions that warps issue for a frame over resident warps, as a multiple of the least of the three \
                    structures; no times, and nothing was measured on this GPU (docs/simt-model.md). Below 1.15 they are \
                    too close to be told apart.";

/// One table for each GPU of the model.
pub fn orders(context: &Context) -> Vec<Table> {
    if context.modelled.is_empty() {
        let mut table = context.table("simt", "Work by the SIMT model".into(), &["scene"], Vec::new(), Vec::new());
        table.notes.push("Not measured: what warps issue. --warp-width 32 counts it, and --preset simt does.".into());
        return vec![table];
    }
    context.modelled.iter().map(|data| order(context, data)).collect()
}

fn order(context: &Context, data: &Data) -> Table {
    let gpu = &data.devices[0].label;
    let card = published::device_of(gpu).filter(|_| context.options.published);
    let mut rows = Vec::new();
    for scene in context.scenes() {
        for (config, side) in CONFIGS.into_iter().flat_map(|config| data.sides(0).into_iter().map(move |s| (config, s)))
        {
            let modelled = relative(data, 0, &scene, config, side);
            if modelled.iter().all(Option::is_none) {
                continue;
            }
            let printed = card.map_or([None; 3], |card| relative(context.published, card, &scene, config, side));
            let cells = modelled.into_iter().zip(printed);
            let cells: Vec<Cell> = cells.map(|(value, published)| Cell::Number { value, published }).collect();
            rows.push((
                scene.clone(),
                Row { keys: vec![scene.to_string(), format!("{config:?}"), side.to_string()], cells },
            ));
        }
    }
    let columns = STRUCTURES.iter().map(|s| Column::of(structures::title(s), "work", "relative", Form::Fixed(2)));
    let title = format!("Work by the SIMT model of {gpu}");
    let mut table = context.table("simt", title, &["scene", "rays", "side"], columns.collect(), rows);
    table.notes.push(WHAT.into());
    if table.rows.iter().flat_map(|row| &row.cells).any(Cell::has_published) {
        table.notes.push("2009: mean frame times of this card in the same form.".into());
    }
    table
}

/// What the three structures cost as multiples of the least of them.
fn relative(data: &Data, device: usize, scene: &SceneKey, config: Config, side: u32) -> [Option<Number>; 3] {
    let of = |structure| Some(data.thesis_frame(device, scene, structure, config, side)?.mean_ms);
    let costs = STRUCTURES.map(of);
    let least = costs.into_iter().flatten().fold(f64::INFINITY, f64::min);
    costs.map(|cost| Some(Number::from(cost? / least)))
}
