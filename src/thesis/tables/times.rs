//! Tables 5.12 to 5.14 and B.1 to B.6: frame times.

use super::context::{Context, repeated};
use crate::backend::Config;
use crate::thesis::data::{Data, Frame, STRUCTURES, structure_title};
use crate::thesis::scenes::SceneKey;
use crate::thesis::table::{Cell, Column, Form, Row, Table};

/// Configurations of the tables of one device, in their order: 5.12 to 5.14, B.1 to B.3, B.4 to B.6.
pub const CARD_CONFIGS: [(Config, &str); 3] =
    [(Config::P, "primary rays"), (Config::PS, "with shadow rays"), (Config::PSR, "with shadow and reflected rays")];

/// Table 5.12, 5.13 or 5.14: one per device, of the faster card alone where it is the thesis's.
pub fn at_one_resolution(context: &Context, id: &str) -> Vec<Table> {
    let (config, words) = CARD_CONFIGS[["5.12", "5.13", "5.14"].iter().position(|i| *i == id).unwrap_or(0)];
    let devices = if context.data.published { 1 } else { context.data.devices.len() };
    let side = context.options.resolution;
    (0..devices)
        .map(|device| {
            let title =
                format!("Frame times at {side}x{side}, {config:?} ({words}), {}", context.data.devices[device].label);
            let mut table = frame_times(context, id, title, (device, config), &[side]);
            let elsewhere = context.data.sides(device);
            if !context.data.published && !elsewhere.contains(&side) && !elsewhere.is_empty() {
                let sides: Vec<String> = elsewhere.iter().map(ToString::to_string).collect();
                table.notes.push(format!("Measured at other resolutions: see --resolution {}.", sides.join(" or ")));
            }
            table
        })
        .collect()
}

/// Tables B.1 to B.3 of the first device, B.4 to B.6 of the second and of each further one.
pub fn at_all_resolutions(context: &Context, id: &str) -> Vec<Table> {
    let number = id.strip_prefix("B.").and_then(|n| n.parse::<usize>().ok()).unwrap_or(1) - 1;
    let (config, words) = CARD_CONFIGS[number % 3];
    (0..context.data.devices.len())
        .filter(|device| (*device).min(1) == number / 3)
        .map(|device| {
            let mut sides = context.data.sides(device);
            if context.options.beside {
                sides.extend(context.published.sides(context.options.card));
                sides.sort_unstable();
                sides.dedup();
            }
            let title = format!("Frame times, {config:?} ({words}), {}", context.data.devices[device].label);
            frame_times(context, id, title, (device, config), &sides)
        })
        .collect()
}

/// Rows by scene (and size, if there are several), columns by structure: fastest, slowest, mean frame.
fn frame_times(context: &Context, id: &str, title: String, (device, config): (usize, Config), sides: &[u32]) -> Table {
    type Of = fn(&Frame) -> f64;
    let columns: [(&str, Of); 3] = [("min", |f| f.min_ms), ("max", |f| f.max_ms), ("mean", |f| f.mean_ms)];
    let headings = STRUCTURES
        .iter()
        .flat_map(|s| columns.iter().map(|(name, _)| Column::of(structure_title(s), name, "ms", Form::Time)))
        .collect();
    let mut rows: Vec<(SceneKey, Row)> = Vec::new();
    let mut again = 0;
    // The thesis has no reflections on its single objects: without a measurement they have no row there
    let reflects = |key: &SceneKey| config != Config::PSR || !key.thesis().is_some_and(|scene| scene.is_object());
    for key in context.scenes() {
        for &side in sides {
            let cell = |structure: &str, of: Of| {
                let ask = |d: &Data, device| Some(of(d.thesis_frame(device, &key, structure, config, side)?));
                context.device_cell(device, ask)
            };
            let cells: Vec<Cell> = STRUCTURES.iter().flat_map(|s| columns.iter().map(|(_, of)| cell(s, *of))).collect();
            let frames = STRUCTURES.iter().filter_map(|s| context.data.thesis_frame(device, &key, s, config, side));
            again += frames.filter(|f| f.repeated).count();
            let mut keys = vec![key.to_string()];
            if sides.len() > 1 {
                keys.push(side.to_string());
            }
            let row = Row { keys, cells };
            let anything =
                row.is_filled() || row.cells.iter().any(|c| matches!(c, Cell::Number { thesis: Some(_), .. }));
            // Of several sizes only those with a number have a row, and one that stands for the scene's absence
            let first = sides.first() == Some(&side);
            let scene_absent = !sides.iter().any(|&side| has_any(context, device, &key, config, side));
            if anything || (first && scene_absent && reflects(&key)) {
                rows.push((key.clone(), row));
            }
        }
    }
    let keys: &[&str] = if sides.len() > 1 { &["scene", "side"] } else { &["scene"] };
    let mut table = context.table(id, title, keys, headings, rows);
    if !context.data.published {
        notes(context, device, &mut table);
        table.notes.extend(context.failures(device, config, sides));
        table.notes.extend(repeated(again));
    }
    table
}

/// True if a row of this size would have a number in it.
fn has_any(context: &Context, device: usize, key: &SceneKey, config: Config, side: u32) -> bool {
    let of = |data: &Data, device| STRUCTURES.iter().any(|s| data.thesis_frame(device, key, s, config, side).is_some());
    of(context.data, device) || (context.options.beside && of(context.published, context.options.card))
}

/// What to know about a device's times.
fn notes(context: &Context, device: usize, table: &mut Table) {
    let measured = &context.data.devices[device];
    if measured.is_software() {
        table.notes.push("This device computes on the CPU: its times do not rank structures for a GPU.".into());
    }
    if measured.checked {
        table.notes.push("Kernels had wgpu's bounds checks.".into());
    }
    if context.options.beside {
        table.notes.push(format!("2009: {}.", context.published.devices[context.options.card].label));
    }
}
