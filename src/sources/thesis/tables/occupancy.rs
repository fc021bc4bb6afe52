//! Tables 5.7 and 5.8: the register limit, and the options that are measured instead.
//!
//! wgpu has no register limit. The purpose of a limit is that a processor holds more threads at a time; the
//! work-group's shape and the memory of the kd-tree's stack decide that here, so these options are its substitutes.

use super::context::Context;
use crate::report::{Cell, Column, Form, Row, Table};
use crate::sources::Rows;
use crate::sources::thesis::ORIGIN;
use crate::sources::thesis::data::{Data, Frame, RegisterLimit};
use crate::sources::thesis::published::{GT8600, GTX280};
use crate::sources::thesis::scenes::SceneKey;
use crate::sources::thesis::structures::{GRID, KDTREE, STRUCTURES, title};
use crate::sources::thesis::variant::Variant;
use crate::workloads::trace::backend::Config;

/// True for an option that changes how many threads a processor holds, and nothing that is computed.
fn is_substitute(key: &str, value: &str) -> bool {
    key == "group" || (key == "memory" && value == "private")
}

/// Table 5.7 or 5.8. The first device is compared with the faster published one (5.8), further ones with the slower
/// (5.7); without a second device, 5.7 is empty.
pub fn occupancy(context: &Context, id: &str) -> Vec<Table> {
    let own = context.published_device(if id == "5.7" { GT8600 } else { GTX280 });
    let other = context.options.device.unwrap_or(own);
    let printed_as = if other == context.published_device(GT8600) { "5.7" } else { "5.8" };
    if context.data.published {
        if other == own {
            return vec![register_limit(context.data, id, other, "published")];
        }
        return vec![context.of_another_device(id, REGISTER_LIMIT, other, &format!("table {printed_as}"))];
    }
    let devices = if id == "5.8" { 0..1 } else { 1..context.data.devices.len().max(2) };
    let mut tables: Vec<Table> = devices.map(|device| substitute(context, id, device)).collect();
    if context.options.published {
        tables.push(register_limit(context.published, id, other, &format!("published as table {printed_as}")));
    }
    tables
}

const REGISTER_LIMIT: &str = "Effect of a register limit, PSR";

/// The printed table: rows by structure and registers, columns by scene.
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
            let keys = [title(structure).to_owned(), first.registers.to_string(), first.occupancy.to_string()];
            rows.push(Row { keys: keys.into(), cells: cells.collect() });
        }
    }
    Table {
        origin: ORIGIN,
        id: id.into(),
        title: format!("{REGISTER_LIMIT}, {} ({published})", data.devices[device].label),
        keys: ["structure", "registers", "occupancy %"].map(str::to_owned).into(),
        columns: columns.collect(),
        rows,
        notes: vec!["Faster: 1 - time with the limit / time without, as printed.".into()],
        with_published: false,
        is_published: data.published,
    }
}

fn columns_of(scene: &str) -> [Column; 2] {
    [Column::of(scene, "mean", "ms", Form::Time), Column::of(scene, "faster", "%", Form::Whole)]
}

/// A default measurement and the same with one option changed, PSR, at the largest size that has both.
#[derive(Clone, Debug)]
pub struct Substitute<'a> {
    /// The measurement with the defaults.
    pub base: &'a Frame,
    /// The measurement with the option.
    pub changed: &'a Frame,
    /// The option, `key=value`.
    pub option: String,
}

/// All such pairs of a device.
pub fn substitutes(data: &Data, device: usize) -> Vec<Substitute<'_>> {
    let mut found: Vec<Substitute> = Vec::new();
    let of_device = |f: &&Frame| f.device == device && f.config == Config::PSR && f.width == f.height;
    for changed in data.frames.iter().filter(of_device) {
        let base = Variant::of_thesis(changed.scene.thesis(), &changed.structure);
        let Some((key, value)) = changed.variant.only_beyond(&base) else { continue };
        if !is_substitute(key, value) {
            continue;
        }
        let frame = data.frame(device, &changed.scene, (&changed.structure, &base), Config::PSR, changed.width);
        let Some(base) = frame else { continue };
        let pair = Substitute { base, changed, option: format!("{key}={value}") };
        let same = |p: &&mut Substitute| {
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

/// The rows of a device without any substitute: the options that the preset `thesis` measures.
const WANTED: [(&str, &str); 5] = [
    (GRID, "group=16x4"),
    (GRID, "group=16x16"),
    (KDTREE, "group=16x4"),
    (KDTREE, "group=16x16"),
    (KDTREE, "memory=private"),
];

fn substitute(context: &Context, id: &str, device: usize) -> Table {
    let pairs = substitutes(context.data, device);
    let mut scenes: Vec<SceneKey> = pairs.iter().map(|p| p.base.scene.clone()).collect();
    let measured = scenes.clone();
    let mut names: Vec<(&str, &str)> = pairs.iter().map(|p| (p.base.structure.as_str(), p.option.as_str())).collect();
    if context.options.rows != Rows::Measured {
        scenes.extend(context.published.register_limit.iter().map(|row| SceneKey::Thesis(row.scene)));
        if names.is_empty() {
            names.extend(WANTED);
        }
    }
    // The thesis's scenes in the order of its own table, then the others
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
            rows.push(Row { keys: vec![title(structure).into(), "default".into()], cells: cells.collect() });
        }
        let cells = scenes.iter().flat_map(|scene| {
            let pair = of(scene, Some(option));
            let faster = pair.map(|p| 100.0 * (1.0 - p.changed.mean_ms / p.base.mean_ms));
            [Cell::number(pair.map(|p| p.changed.mean_ms)), Cell::number(faster)]
        });
        rows.push(Row { keys: vec![title(structure).into(), option.into()], cells: cells.collect() });
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
        "Substitute options: wgpu has no register limit, so the thesis's question (how many threads fit on a \
         processor) is asked through the shape of work-groups and the memory of the stack."
            .into(),
        "Faster: 1 - time with the option / time by default; below zero it is slower. Default: groups of 8x8, the \
         kd-tree's stack in work-group memory."
            .into(),
    ]);
    Table {
        origin: ORIGIN,
        id: id.into(),
        title: format!("Group shape and memory of the stack, PSR, {}", context.label(device)),
        keys: vec!["structure".into(), "option".into()],
        columns: scenes.iter().flat_map(|s| columns_of(&s.to_string())).collect(),
        rows,
        notes,
        with_published: false,
        is_published: false,
    }
}
