//! Tables: structures by rays per second, what their rays do, and after how many rays one is ahead of another.

use super::break_even::{BreakEven, break_even};
use super::data::{Data, Entry, Group};
use super::pareto::front;
use super::{ORIGIN, SOURCE};
use crate::report::{Cell, Column, Form, Row, Table};
use crate::sources::Options;
use crate::workloads::trace::record::CounterSums;

/// Names of the tables.
pub const IDS: [&str; 3] = ["rates", "work", "break-even"];

/// The tables of these names, one for each scene, ray configuration and size on a device; an empty one without runs.
pub fn build(data: &Data, ids: &[&str], options: &Options) -> Vec<Table> {
    let is_shown = |group: &&Group| options.resolution.is_none_or(|side| group.size.0 == side);
    let groups: Vec<&Group> = data.groups.iter().filter(is_shown).collect();
    let of = |id: &str| -> Vec<Table> {
        let Some(&known) = IDS.iter().find(|known| **known == id) else { return Vec::new() };
        if groups.is_empty() {
            return vec![empty(known)];
        }
        // Where nothing has a result, the first table says why
        let has_it = |group: &&&Group| !group.entries.is_empty() || known == IDS[0];
        groups.iter().filter(has_it).map(|group| one(known, group, &data.devices[group.device].label)).collect()
    };
    ids.iter().flat_map(|id| of(id)).collect()
}

fn one(id: &str, group: &Group, device: &str) -> Table {
    let mut table = match id {
        "rates" => rates(group),
        "work" => work(group),
        _ => break_evens(group),
    };
    table.title += &format!(": {}, {device}", group.title());
    if id == "rates" {
        table.notes.extend(group.failures.iter().map(|failure| format!("Without a result: {failure}.")));
    }
    table
}

/// A table of a name, with nothing in it yet.
fn table(id: &str, title: &str, keys: &[&str], columns: Vec<Column>) -> Table {
    Table {
        origin: ORIGIN,
        id: id.to_owned(),
        title: title.to_owned(),
        keys: keys.iter().map(|key| (*key).to_owned()).collect(),
        columns,
        rows: Vec::new(),
        notes: Vec::new(),
        with_published: false,
        is_published: false,
    }
}

fn empty(id: &str) -> Table {
    let mut table = table(id, "nothing was measured", &["structure"], Vec::new());
    table.is_published = true;
    table.notes.push(format!("Nothing of it is published: give a run of `rtbench sweep --preset {}`.", SOURCE.name));
    table
}

/// The structure that is ready first: the one to catch up with.
fn first_ready(group: &Group) -> Option<&Entry> {
    group.entries.iter().min_by(|a, b| a.ready_ms().total_cmp(&b.ready_ms()))
}

fn rates(group: &Group) -> Table {
    let columns = vec![
        Column::new("rate", "Mrays/s", Form::Time),
        Column::new("frame", "ms", Form::Time),
        Column::new("noise", "%", Form::Fixed(1)),
        Column::new("SAH cost", "", Form::Fixed(2)),
        Column::new("structure", "B/triangle", Form::Fixed(1)),
        Column::new("build", "ms", Form::Time),
        Column::new("upload", "ms", Form::Time),
        Column::new("threads", "", Form::Whole),
        Column::new("break-even", "Mrays", Form::Time),
    ];
    let mut table = table("rates", "Rays per second", &["structure"], columns);
    let reference = first_ready(group);
    let row = |entry: &Entry| {
        let ahead = reference.filter(|reference| reference.name != entry.name);
        let ahead = ahead.map(|reference| break_even(entry.cost(), reference.cost()));
        let cells = vec![
            Cell::number(entry.mrays_per_s),
            Cell::number(entry.frame_ms),
            Cell::number(entry.noise_pct),
            Cell::number(entry.sah_cost),
            Cell::number(entry.bytes_per_triangle),
            Cell::number(entry.build_ms),
            Cell::number(entry.upload_ms),
            Cell::number((entry.build_threads > 0).then_some(entry.build_threads as f64)),
            match ahead {
                Some(BreakEven::From(mrays)) => Cell::number(mrays),
                Some(BreakEven::Always) => Cell::number(0.0),
                Some(BreakEven::Until(_) | BreakEven::Never) => Cell::Text("none".into()),
                None => Cell::number(None),
            },
        ];
        Row { keys: vec![entry.name.clone()], cells }
    };
    table.rows = group.entries.iter().map(row).collect();
    if let Some(reference) = reference {
        table.notes.push(format!(
            "Break-even: the number of rays after which build, upload and trace take less time than those of {}, which \
             is ready first. none: it is never ahead.",
            reference.name
        ));
        table.notes.push(
            "structure: nodes, references and, where this device has them, triangles in leaf order; - where the driver \
             does not tell."
                .into(),
        );
    }
    table
}

fn work(group: &Group) -> Table {
    let columns = [
        ("inner nodes", "a ray"),
        ("leaves", "a ray"),
        ("boxes", "a ray"),
        ("triangle tests", "a ray"),
        ("pops", "a ray"),
        ("restarts", "a ray"),
    ];
    let columns = columns.map(|(name, unit)| Column::new(name, unit, Form::Fixed(2))).to_vec();
    let mut table = table("work", "What a ray does, on average over all ray types", &["structure"], columns);
    let row = |entry: &Entry| {
        let cell = |of: fn(&CounterSums) -> u64| {
            Cell::number(entry.counts.as_ref().map(|counts| of(counts) as f64 / counts.rays as f64))
        };
        let cells = vec![
            cell(|c| c.inner),
            cell(|c| c.leaves),
            cell(|c| c.boxes),
            cell(|c| c.tests),
            cell(|c| c.pops),
            cell(|c| c.restarts),
        ];
        Row { keys: vec![entry.name.clone()], cells }
    };
    table.rows = group.entries.iter().map(row).collect();
    table.notes.push("Inner nodes of a grid are cells. Boxes are those of nodes in trees of boxes.".into());
    table
}

fn break_evens(group: &Group) -> Table {
    let points: Vec<(f64, f64)> = group.entries.iter().map(|entry| (entry.ready_ms(), entry.mrays_per_s)).collect();
    let best: Vec<&Entry> =
        group.entries.iter().zip(front(&points)).filter(|(_, best)| *best).map(|(e, _)| e).collect();
    let columns = best.iter().map(|entry| Column::of("ahead of", &entry.name, "Mrays", Form::Time)).collect();
    let mut table = table("break-even", "Rays after which one is ahead of another", &["structure"], columns);
    let row = |entry: &Entry| {
        let cell = |other: &&Entry| match break_even(entry.cost(), other.cost()) {
            _ if other.name == entry.name => Cell::number(None),
            BreakEven::Always => Cell::Text("always".into()),
            BreakEven::From(mrays) => Cell::Text(format!("from {}", Form::Time.write(mrays))),
            BreakEven::Until(mrays) => Cell::Text(format!("until {}", Form::Time.write(mrays))),
            BreakEven::Never => Cell::Text("never".into()),
        };
        Row { keys: vec![entry.name.clone()], cells: best.iter().map(cell).collect() }
    };
    table.rows = group.entries.iter().map(row).collect();
    table.notes.push(
        "Build, upload and trace of a row take less time than those of a column from or until so many 10^6 rays. Columns \
         are the structures that no other one beats in both time until the first ray and rays per second."
            .into(),
    );
    table
}
