//! Table 5.2 and the speed-ups between devices of section 5.3.4.

use super::context::Context;
use super::times::CONFIGS;
use crate::report::{Cell, Column, Form, Origin, Row, Table};
use crate::sources::thesis::ORIGIN;
use crate::sources::thesis::data::{Data, Device};
use crate::sources::thesis::structures::{self, STRUCTURES};

/// Table 5.2; with published numbers, the thesis's own follows.
pub fn devices(context: &Context) -> Vec<Table> {
    let mut tables =
        vec![device_table(context.data, if context.data.published { "Devices compared" } else { "Devices" })];
    if context.options.published {
        tables.push(device_table(context.published, "Devices compared in 2009"));
    }
    tables
}

/// A row per property, a column per device, because descriptions are long.
fn device_table(data: &Data, title: &str) -> Table {
    let mut facts: Vec<&str> = Vec::new();
    for (name, _) in data.devices.iter().flat_map(|d| &d.facts) {
        if !facts.contains(name) {
            facts.push(name);
        }
    }
    let rows = facts.into_iter().map(|fact| {
        let cell = |device: &Device| {
            let found = device.facts.iter().find(|(name, text)| *name == fact && !text.is_empty());
            found.map_or(Cell::number(None), |(_, text)| Cell::Text(text.clone()))
        };
        Row { keys: vec![fact.to_owned()], cells: data.devices.iter().map(cell).collect() }
    });
    Table {
        origin: ORIGIN,
        id: "5.2".into(),
        title: title.into(),
        keys: vec!["device".into()],
        rows: rows.collect(),
        columns: data.devices.iter().map(|d| Column::new(&d.label, "", Form::Whole)).collect(),
        notes: data.notes.iter().map(|note| format!("Note: {note}.")).collect(),
        with_published: false,
        is_published: data.published,
    }
}

/// Speed-ups: how many times as long each further device takes as the first, at the largest common resolution, and
/// their range per structure. Without a second device, an empty table says so.
pub fn speedups(context: &Context) -> Vec<Table> {
    let mut tables = pairs(context.data);
    if tables.is_empty() {
        let only_one = context.data.devices.len() < 2;
        let absent = if only_one { "a second device" } else { "the same scene on two devices, at the same size" };
        tables.push(Table {
            title: "Speed-ups between devices".into(),
            notes: vec![format!("Not measured: {absent}.")],
            ..table_of_pair(context.data.published)
        });
    }
    if context.options.published {
        tables.extend(pairs(context.published));
    }
    tables
}

/// A table of speed-ups without rows.
fn table_of_pair(published: bool) -> Table {
    Table {
        origin: Origin { kind: "section", ..ORIGIN },
        id: "5.3.4".into(),
        title: String::new(),
        keys: ["scene", "rays", "side"].map(str::to_owned).into(),
        columns: STRUCTURES.map(|s| Column::new(structures::title(s), "times", Form::Fixed(2))).into(),
        rows: Vec::new(),
        notes: Vec::new(),
        with_published: false,
        is_published: published,
    }
}

fn pairs(data: &Data) -> Vec<Table> {
    (1..data.devices.len()).filter_map(|other| pair(data, other)).collect()
}

/// The first device and another.
fn pair(data: &Data, other: usize) -> Option<Table> {
    let mut rows = Vec::new();
    let mut range = [(f64::INFINITY, 0.0f64); 3];
    for scene in &data.scenes {
        for (config, _) in CONFIGS {
            let quotient = |structure: &str, side| {
                let time = |device| data.thesis_frame(device, &scene.key, structure, config, side);
                let (first, second) = (time(0)?, time(other)?);
                (first.conditions == second.conditions).then(|| second.mean_ms / first.mean_ms)
            };
            let common = |side: &u32| STRUCTURES.iter().any(|s| quotient(s, *side).is_some());
            let Some(side) = data.sides(0).into_iter().rev().find(common) else { continue };
            let quotients = STRUCTURES.map(|s| quotient(s, side));
            for (range, quotient) in range.iter_mut().zip(quotients).filter_map(|(r, q)| Some((r, q?))) {
                *range = (range.0.min(quotient), range.1.max(quotient));
            }
            let keys = vec![scene.key.to_string(), format!("{config:?}"), side.to_string()];
            rows.push(Row { keys, cells: quotients.map(Cell::number).into() });
        }
    }
    let ranges = STRUCTURES.iter().zip(range).filter(|(_, (low, _))| low.is_finite());
    let ranges: Vec<String> =
        ranges.map(|(s, (low, high))| format!("{} {low:.1} to {high:.1}", structures::title(s))).collect();
    let (first, second) = (&data.devices[0].label, &data.devices[other].label);
    let year = if data.published { " in 2009" } else { "" };
    (!rows.is_empty()).then(|| Table {
        title: format!("Speed-up of {first} over {second}{year}"),
        rows,
        notes: vec![
            format!("Mean frame time on {second} / on {first}, at the largest common resolution."),
            format!("Range: {}.", ranges.join(", ")),
        ],
        ..table_of_pair(data.published)
    })
}
