//! Tables 5.12 to 5.14 and B.1 to B.6: frame times.

use super::context::{Context, repeated};
use crate::thesis::data::{Data, STRUCTURES, structure_title};
use crate::thesis::published::{GT8600, GTX280};
use crate::thesis::scenes::SceneKey;
use crate::thesis::table::{Cell, Column, Form, Row, Table};
use crate::workloads::trace::backend::Config;

/// Configurations of the tables of one device, in their order: 5.12 to 5.14, B.1 to B.3, B.4 to B.6.
pub const CARD_CONFIGS: [(Config, &str); 3] =
    [(Config::P, "primary rays"), (Config::PS, "with shadow rays"), (Config::PSR, "with shadow and reflected rays")];

/// Whose times a table shows.
struct Subject<'a> {
    /// Index of the device.
    device: usize,
    /// Index of the published card beside it.
    card: usize,
    /// Rays.
    config: Config,
    /// Sides of the square images.
    sides: &'a [u32],
}

/// Table 5.12, 5.13 or 5.14: one per device, of the card that was chosen where it is the thesis's.
pub fn at_one_resolution(context: &Context, id: &str) -> Vec<Table> {
    let number = ["5.12", "5.13", "5.14"].iter().position(|i| *i == id).unwrap_or(0);
    let (config, words) = CARD_CONFIGS[number];
    let own = context.card(GTX280);
    let card = context.options.card.unwrap_or(own);
    let devices = if context.data.published { card..card + 1 } else { 0..context.data.devices.len() };
    let side = context.options.resolution;
    devices
        .map(|device| {
            let title = format!("Frame times at {side}x{side}, {config:?} ({words}), {}", context.label(device));
            let mut table = frame_times(context, id, title, &Subject { device, card, config, sides: &[side] });
            let elsewhere = context.data.sides(device);
            if !elsewhere.contains(&side) && !elsewhere.is_empty() {
                let sides: Vec<String> = elsewhere.iter().map(ToString::to_string).collect();
                let verb = if context.data.published { "Published" } else { "Measured" };
                table.notes.push(format!("{verb} at other resolutions: see --resolution {}.", sides.join(" or ")));
            }
            if context.data.published && card != own {
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
    let (config, words) = CARD_CONFIGS[number % 3];
    let own = context.card(if number < 3 { GTX280 } else { GT8600 });
    let card = context.options.card.unwrap_or(own);
    let title = format!("Frame times, {config:?} ({words})");
    if context.data.published && card != own {
        let other = format!("table B.{}", (number + 3) % 6 + 1);
        return vec![context.of_another_card(id, &title, card, &other)];
    }
    let number_of_devices = context.data.devices.len();
    let devices = match (context.data.published, number < 3) {
        (true, _) => own..own + 1,
        (false, true) => 0..1,
        // Without a second device its table stands empty
        (false, false) => 1..number_of_devices.max(2),
    };
    devices
        .map(|device| {
            let mut sides = context.data.sides(device);
            if context.options.beside || sides.is_empty() {
                sides.extend(context.published.sides(card));
                sides.sort_unstable();
                sides.dedup();
            }
            let title = format!("{title}, {}", context.label(device));
            let mut table = frame_times(context, id, title, &Subject { device, card, config, sides: &sides });
            if device >= number_of_devices {
                table.notes.push("Not measured: a second device.".into());
            }
            table
        })
        .collect()
}

/// Rows by scene (and size, if there are several), columns by structure: fastest, slowest, mean frame.
fn frame_times(context: &Context, id: &str, title: String, subject: &Subject) -> Table {
    let Subject { device, card, config, sides } = *subject;
    let columns = ["min", "max", "mean"];
    let headings = STRUCTURES
        .iter()
        .flat_map(|s| columns.iter().map(|name| Column::of(structure_title(s), name, "ms", Form::Time)))
        .collect();
    let mut rows: Vec<(SceneKey, Row)> = Vec::new();
    let mut again = 0;
    // The thesis has no reflections on its single objects: without a measurement they have no row there
    let reflects = |key: &SceneKey| config != Config::PSR || !key.thesis().is_some_and(|scene| scene.is_object());
    for key in context.scenes() {
        for &side in sides {
            let cell = |structure: &str, time: usize| {
                let ask = |d: &Data, device| Some(d.thesis_frame(device, &key, structure, config, side)?.times()[time]);
                context.device_cell(device, card, ask)
            };
            let cells: Vec<Cell> =
                STRUCTURES.iter().flat_map(|s| (0..columns.len()).map(|time| cell(s, time))).collect();
            let frames = STRUCTURES.iter().filter_map(|s| context.data.thesis_frame(device, &key, s, config, side));
            again += frames.filter(|f| f.repeated).count();
            // Of several sizes only those with a number have a row, and one that stands for the scene's absence
            let first = sides.first() == Some(&side);
            let scene_absent = !sides.iter().any(|&side| has_any(context, subject, &key, side));
            let mut keys = vec![key.to_string()];
            if sides.len() > 1 {
                keys.push(if scene_absent { String::new() } else { side.to_string() });
            }
            let row = Row { keys, cells };
            if row.is_filled() || row.cells.iter().any(Cell::is_published) || (first && scene_absent && reflects(&key))
            {
                rows.push((key.clone(), row));
            }
        }
    }
    let keys: &[&str] = if sides.len() > 1 { &["scene", "side"] } else { &["scene"] };
    let mut table = context.table(id, title, keys, headings, rows);
    if !context.data.published {
        notes(context, subject, &mut table);
        table.notes.extend(context.failures(device, config, sides));
        table.notes.extend(repeated(again));
    }
    table
}

/// True if a row of this size would have a number in it.
fn has_any(context: &Context, subject: &Subject, key: &SceneKey, side: u32) -> bool {
    let of = |data: &Data, device| {
        STRUCTURES.iter().any(|s| data.thesis_frame(device, key, s, subject.config, side).is_some())
    };
    of(context.data, subject.device) || (context.options.beside && of(context.published, subject.card))
}

/// What to know about a device's times, and whose stand beside them.
fn notes(context: &Context, subject: &Subject, table: &mut Table) {
    if let Some(measured) = context.data.devices.get(subject.device) {
        if measured.is_software() {
            table.notes.push("This device computes on the CPU: its times do not rank structures for a GPU.".into());
        }
        if measured.checked {
            table.notes.push("Kernels had wgpu's bounds checks.".into());
        }
    }
    if context.options.beside {
        let label = &context.published.devices[subject.card].label;
        table.notes.push(if table.rows.iter().flat_map(|row| &row.cells).any(Cell::is_published) {
            format!("2009: {label}.")
        } else {
            let sides: Vec<String> = context.published.sides(subject.card).iter().map(ToString::to_string).collect();
            format!("2009: nothing stands beside these, the thesis has times of the {label} at {}.", sides.join(", "))
        });
    }
}
