//! Tables 5.12 to 5.14 and B.1 to B.6: frame times.

use super::context::{Context, repeated};
use crate::report::{Cell, Column, Form, Row, Table};
use crate::sources::thesis::data::Data;
use crate::sources::thesis::published::{GT8600, GTX280};
use crate::sources::thesis::scenes::SceneKey;
use crate::sources::thesis::structures::{self, STRUCTURES};
use crate::workloads::trace::backend::Config;

/// Configurations of the tables of one device, in their order: 5.12 to 5.14, B.1 to B.3, B.4 to B.6.
pub const CONFIGS: [(Config, &str); 3] =
    [(Config::P, "primary rays"), (Config::PS, "with shadow rays"), (Config::PSR, "with shadow and reflected rays")];

/// The times that a table shows.
struct Selection<'a> {
    /// Index of the device.
    device: usize,
    /// Index of the published device that it is compared with.
    other: usize,
    /// The rays.
    config: Config,
    /// Sides of the square images.
    sides: &'a [u32],
}

/// Table 5.12, 5.13 or 5.14: one per measured device, or one of the published device that was chosen.
pub fn at_one_resolution(context: &Context, id: &str) -> Vec<Table> {
    let number = ["5.12", "5.13", "5.14"].iter().position(|i| *i == id).unwrap_or(0);
    let (config, words) = CONFIGS[number];
    let own = context.published_device(GTX280);
    let other = context.options.device.unwrap_or(own);
    let devices = if context.data.published { other..other + 1 } else { 0..context.data.devices.len() };
    let side = context.resolution;
    devices
        .map(|device| {
            let title = format!("Frame times at {side}x{side}, {config:?} ({words}), {}", context.label(device));
            let mut table = frame_times(context, id, title, &Selection { device, other, config, sides: &[side] });
            let elsewhere = context.data.sides(device);
            if !elsewhere.contains(&side) && !elsewhere.is_empty() {
                let sides: Vec<String> = elsewhere.iter().map(ToString::to_string).collect();
                let verb = if context.data.published { "Published" } else { "Measured" };
                table.notes.push(format!("{verb} at other resolutions: see --resolution {}.", sides.join(" or ")));
            }
            if context.data.published && other != own {
                table.notes.push(format!(
                    "The thesis printed this table of the {GTX280} only; these are rows of its table B.{}.",
                    number + 4
                ));
            }
            table
        })
        .collect()
}

/// Tables B.1 to B.3 of the first device, B.4 to B.6 of the second and of each further one.
pub fn at_all_resolutions(context: &Context, id: &str) -> Vec<Table> {
    let number = id.strip_prefix("B.").and_then(|n| n.parse::<usize>().ok()).unwrap_or(1) - 1;
    let (config, words) = CONFIGS[number % 3];
    let own = context.published_device(if number < 3 { GTX280 } else { GT8600 });
    let other = context.options.device.unwrap_or(own);
    let title = format!("Frame times, {config:?} ({words})");
    if context.data.published && other != own {
        let table = format!("table B.{}", (number + 3) % 6 + 1);
        return vec![context.of_another_device(id, &title, other, &table)];
    }
    let number_of_devices = context.data.devices.len();
    let devices = match (context.data.published, number < 3) {
        (true, _) => own..own + 1,
        (false, true) => 0..1,
        // Without a second device its table is empty
        (false, false) => 1..number_of_devices.max(2),
    };
    devices
        .map(|device| {
            let mut sides = context.data.sides(device);
            if context.options.published || sides.is_empty() {
                sides.extend(context.published.sides(other));
                sides.sort_unstable();
                sides.dedup();
            }
            let title = format!("{title}, {}", context.label(device));
            let mut table = frame_times(context, id, title, &Selection { device, other, config, sides: &sides });
            if device >= number_of_devices {
                table.notes.push("Not measured: a second device.".into());
            }
            table
        })
        .collect()
}

/// Rows by scene (and size, if there are several), columns by structure: fastest, slowest, mean frame.
fn frame_times(context: &Context, id: &str, title: String, selection: &Selection) -> Table {
    let Selection { device, other, config, sides } = *selection;
    let columns = ["min", "max", "mean"];
    let headings = STRUCTURES
        .iter()
        .flat_map(|s| columns.iter().map(|name| Column::of(structures::title(s), name, "ms", Form::Time)))
        .collect();
    let mut rows: Vec<(SceneKey, Row)> = Vec::new();
    let mut again = 0;
    // The thesis has no reflections on its single objects: without a measurement they have no row there
    let reflects = |key: &SceneKey| config != Config::PSR || !key.thesis().is_some_and(|scene| scene.is_object());
    for key in context.scenes() {
        for &side in sides {
            let cell = |structure: &str, time: usize| {
                let ask = |d: &Data, device| Some(d.thesis_frame(device, &key, structure, config, side)?.times()[time]);
                context.device_cell(device, other, ask)
            };
            let cells: Vec<Cell> =
                STRUCTURES.iter().flat_map(|s| (0..columns.len()).map(|time| cell(s, time))).collect();
            let frames = STRUCTURES.iter().filter_map(|s| context.data.thesis_frame(device, &key, s, config, side));
            again += frames.filter(|f| f.repeated).count();
            // Of several sizes only those with a number have a row; a scene without any has one row
            let first = sides.first() == Some(&side);
            let scene_absent = !sides.iter().any(|&side| has_any(context, selection, &key, side));
            let mut keys = vec![key.to_string()];
            if sides.len() > 1 {
                keys.push(if scene_absent { String::new() } else { side.to_string() });
            }
            let row = Row { keys, cells };
            if row.is_filled() || row.cells.iter().any(Cell::has_published) || (first && scene_absent && reflects(&key))
            {
                rows.push((key.clone(), row));
            }
        }
    }
    let keys: &[&str] = if sides.len() > 1 { &["scene", "side"] } else { &["scene"] };
    let mut table = context.table(id, title, keys, headings, rows);
    if !context.data.published {
        notes(context, selection, &mut table);
        table.notes.extend(context.failures(device, config, sides));
        table.notes.extend(repeated(again));
    }
    table
}

/// True if a row of this size would have a number in it.
fn has_any(context: &Context, selection: &Selection, key: &SceneKey, side: u32) -> bool {
    let of = |data: &Data, device| {
        STRUCTURES.iter().any(|s| data.thesis_frame(device, key, s, selection.config, side).is_some())
    };
    of(context.data, selection.device) || (context.options.published && of(context.published, selection.other))
}

/// Notes on a device's times, and on the published times that they are compared with.
fn notes(context: &Context, selection: &Selection, table: &mut Table) {
    if let Some(measured) = context.data.devices.get(selection.device) {
        if measured.is_software() {
            table.notes.push("This device computes on the CPU: its times do not rank structures for a GPU.".into());
        }
        if measured.checked {
            table.notes.push("Kernels had wgpu's bounds checks.".into());
        }
    }
    if context.options.published {
        let label = &context.published.devices[selection.other].label;
        table.notes.push(if table.rows.iter().flat_map(|row| &row.cells).any(Cell::has_published) {
            format!("2009: {label}.")
        } else {
            let sides: Vec<String> = context.published.sides(selection.other).iter().map(ToString::to_string).collect();
            format!(
                "2009: there is nothing to compare these with, the thesis has times of the {label} at {}.",
                sides.join(", ")
            )
        });
    }
}
