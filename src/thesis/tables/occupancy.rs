//! Tables 5.7 and 5.8: the register limit, and what stands in for it.
//!
//! wgpu has no register limit. What a limit is for is the number of threads that a processor can hold at a time; here the
//! work-group's shape and the memory of the kd-tree's stack decide about that, so these are measured instead.

use super::Rows;
use super::context::Context;
use crate::thesis::data::{Data, Frame, RegisterLimit, STRUCTURES, structure_title};
use crate::thesis::published::{GT8600, GTX280};
use crate::thesis::scenes::SceneKey;
use crate::thesis::table::{Cell, Column, Form, Row, Table};
use crate::thesis::variant::Variant;
use crate::workloads::trace::backend::Config;

/// True for an option that changes how many threads a processor holds, and nothing that is computed.
pub fn is_stand_in(key: &str, value: &str) -> bool {
    key == "group" || (key == "memory" && value == "private")
}

/// Table 5.7 or 5.8. The first device stands for the faster card (5.8), further ones for the slower (5.7); without a second
/// one, 5.7 stands empty.
pub fn occupancy(context: &Context, id: &str) -> Vec<Table> {
    let own = context.card(if id == "5.7" { GT8600 } else { GTX280 });
    let card = context.options.card.unwrap_or(own);
    let printed_as = if card == context.card(GT8600) { "5.7" } else { "5.8" };
    if context.data.published {
        let other = || context.of_another_card(id, REGISTER_LIMIT, card, &format!("table {printed_as}"));
        return vec![if card == own { register_limit(context.data, id, card, "published") } else { other() }];
    }
    let devices = if id == "5.8" { 0..1 } else { 1..context.data.devices.len().max(2) };
    let mut tables: Vec<Table> = devices.map(|device| stand_in(context, id, device)).collect();
    if context.options.beside {
        tables.push(register_limit(context.published, id, card, &format!("published as table {printed_as}")));
    }
    tables
}

const REGISTER_LIMIT: &str = "Effect of a register limit, PSR";

/// As printed: rows by structure and registers, columns by scene.
fn register_limit(data: &Data, id: &str, device: usize, published: &str) -> Table {
    let of_device: Vec<_> = data.register_limit.iter().filter(|row| row.device == device).collect();
    let mut scenes = Vec::new();
    let mut rows: Vec<Row> = Vec::new();
    for row in &of_device {
        if !scenes.contains(&row.scene) {
            scenes.push(row.scene);
        }
    }
    let columns = scenes.iter().flat_map(|s| columns_of(s.name()));
    for structure in STRUCTURES {
        for limited in [false, true] {
            let of = |scene| {
                of_device
                    .iter()
                    .find(move |r| r.scene == scene && r.structure == structure && r.speedup.is_some() == limited)
            };
            let Some(first) = scenes.first().and_then(|scene| of(*scene)) else { continue };
            let cells = scenes.iter().flat_map(|scene| {
                let row = of(*scene);
                [Cell::number(row.map(|r| r.mean_ms)), Cell::number(row.and_then(|r| r.speedup).map(f64::from))]
            });
            let keys =
                [structure_title(structure).to_owned(), first.registers.to_string(), first.occupancy.to_string()];
            rows.push(Row { keys: keys.into(), cells: cells.collect() });
        }
    }
    Table {
        id: id.into(),
        title: format!("{REGISTER_LIMIT}, {} ({published})", data.devices[device].label),
        keys: ["structure", "registers", "occupancy %"].map(str::to_owned).into(),
        columns: columns.collect(),
        rows,
        notes: vec!["Faster: 1 - time with the limit / time without, as printed.".into()],
        beside: false,
        published: data.published,
    }
}

fn columns_of(scene: &str) -> [Column; 2] {
    [Column::of(scene, "mean", "ms", Form::Time), Column::of(scene, "faster", "%", Form::Whole)]
}

/// A default measurement and the same with one option changed, PSR, at the largest size that has both.
#[derive(Clone, Debug)]
pub struct StandIn<'a> {
    /// With the defaults.
    pub base: &'a Frame,
    /// With the option.
    pub changed: &'a Frame,
    /// The option, `key=value`.
    pub option: String,
}

/// All pairs of a device.
pub fn stand_ins(data: &Data, device: usize) -> Vec<StandIn<'_>> {
    let mut found: Vec<StandIn> = Vec::new();
    let of_device = |f: &&Frame| f.device == device && f.config == Config::PSR && f.width == f.height;
    for changed in data.frames.iter().filter(of_device) {
        let base = Variant::of_thesis(changed.scene.thesis(), &changed.structure);
        let Some((key, value)) = changed.variant.only_beyond(&base) else { continue };
        if !is_stand_in(key, value) {
            continue;
        }
        let frame = data.frame(device, &changed.scene, (&changed.structure, &base), Config::PSR, changed.width);
        let Some(base) = frame else { continue };
        let pair = StandIn { base, changed, option: format!("{key}={value}") };
        let same = |p: &&mut StandIn| {
            p.option == pair.option && p.base.scene == base.scene && p.base.structure == base.structure
        };
        match found.iter_mut().find(same) {
            Some(known) if known.base.width < base.width => *known = pair,
            Some(_) => {}
            None => found.push(pair),
        }
    }
    found
}

/// What a device without any stand-in has rows for: what the preset `thesis` measures.
const WANTED: [(&str, &str); 5] = [
    ("grid", "group=16x4"),
    ("grid", "group=16x16"),
    ("kdtree", "group=16x4"),
    ("kdtree", "group=16x16"),
    ("kdtree", "memory=private"),
];

fn stand_in(context: &Context, id: &str, device: usize) -> Table {
    let pairs = stand_ins(context.data, device);
    let mut scenes: Vec<SceneKey> = pairs.iter().map(|p| p.base.scene.clone()).collect();
    let measured = scenes.clone();
    let mut names: Vec<(&str, &str)> = pairs.iter().map(|p| (p.base.structure.as_str(), p.option.as_str())).collect();
    if context.options.rows != Rows::Measured {
        scenes.extend(context.published.register_limit.iter().map(|row| SceneKey::Thesis(row.scene)));
        if names.is_empty() {
            names.extend(WANTED);
        }
    }
    // The thesis's in the order of its own table, then the others
    let printed = |scene: &SceneKey| {
        let of_row = |row: &RegisterLimit| SceneKey::Thesis(row.scene) == *scene;
        context.published.register_limit.iter().position(of_row).unwrap_or(usize::MAX)
    };
    scenes.sort_by(|a, b| (printed(a), a).cmp(&(printed(b), b)));
    scenes.dedup();
    names.sort_unstable();
    names.dedup();
    let mut rows: Vec<Row> = Vec::new();
    let mut structure_before = "";
    for (structure, option) in names {
        let of = |scene: &SceneKey, option: Option<&str>| {
            pairs.iter().find(|p| {
                p.base.scene == *scene && p.base.structure == structure && option.is_none_or(|o| p.option == o)
            })
        };
        if structure != structure_before {
            structure_before = structure;
            let cells =
                scenes.iter().flat_map(|s| [Cell::number(of(s, None).map(|p| p.base.mean_ms)), Cell::number(None)]);
            rows.push(Row { keys: vec![structure_title(structure).into(), "default".into()], cells: cells.collect() });
        }
        let cells = scenes.iter().flat_map(|scene| {
            let pair = of(scene, Some(option));
            let faster = pair.map(|p| 100.0 * (1.0 - p.changed.mean_ms / p.base.mean_ms));
            [Cell::number(pair.map(|p| p.changed.mean_ms)), Cell::number(faster)]
        });
        rows.push(Row { keys: vec![structure_title(structure).into(), option.into()], cells: cells.collect() });
    }
    let mut notes = Vec::new();
    let absent: Vec<String> = scenes.iter().filter(|s| !measured.contains(s)).map(ToString::to_string).collect();
    if device >= context.data.devices.len() {
        notes.push("Not measured: a second device.".into());
    } else if pairs.is_empty() {
        notes.push("Not measured: reflected rays with another shape of work-groups or memory of the stack.".into());
    } else if !absent.is_empty() {
        notes.push(format!("Not measured: {}.", absent.join(", ")));
    }
    notes.extend([
        "A stand-in: wgpu has no register limit, so the thesis's question (how many threads fit on a processor) is \
         asked through the shape of work-groups and the memory of the stack."
            .into(),
        "Faster: 1 - time with the option / time by default; below zero it is slower. Default: groups of 8x8, the \
         kd-tree's stack in work-group memory."
            .into(),
    ]);
    Table {
        id: id.into(),
        title: format!("Group shape and memory of the stack, PSR, {}", context.label(device)),
        keys: vec!["structure".into(), "option".into()],
        columns: scenes.iter().flat_map(|s| columns_of(&s.to_string())).collect(),
        rows,
        notes,
        beside: false,
        published: false,
    }
}
