//! Tables 5.7 and 5.8: the register limit, and what stands in for it.
//!
//! wgpu has no register limit. What a limit is for is the number of threads that a processor can hold at a time; here the
//! work-group's shape and the memory of the kd-tree's stack decide about that, so these are measured instead.

use super::context::Context;
use crate::backend::Config;
use crate::thesis::data::{Data, Frame, STRUCTURES, structure_title};
use crate::thesis::published::GT8600;
use crate::thesis::scenes::SceneKey;
use crate::thesis::table::{Cell, Column, Form, Row, Table};
use crate::thesis::variant::Variant;

/// True for an option that changes how many threads a processor holds, and nothing that is computed.
pub fn is_stand_in(key: &str, value: &str) -> bool {
    key == "group" || (key == "memory" && value == "private")
}

/// Table 5.7 or 5.8. The first device stands for the faster card (5.8), further ones for the slower (5.7).
pub fn occupancy(context: &Context, id: &str) -> Vec<Table> {
    let published = || {
        let device = context.published.devices.iter().position(|d| (d.label == GT8600) == (id == "5.7"));
        register_limit(context.published, id, device.unwrap_or(0))
    };
    if context.data.published {
        return vec![published()];
    }
    let devices = (0..context.data.devices.len()).filter(|device| (*device == 0) == (id == "5.8"));
    let mut tables: Vec<Table> = devices.map(|device| stand_in(context.data, id, device)).collect();
    tables.retain(|table| !table.rows.is_empty());
    if context.options.beside && !tables.is_empty() {
        tables.push(published());
    }
    tables
}

/// As printed: rows by structure and registers, columns by scene.
fn register_limit(data: &Data, id: &str, device: usize) -> Table {
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
        title: format!("Effect of a register limit, PSR, {} (published)", data.devices[device].label),
        keys: ["structure", "registers", "occupancy %"].map(str::to_owned).into(),
        columns: columns.collect(),
        rows,
        notes: vec!["Faster: 1 - time with the limit / time without, as printed.".into()],
        beside: false,
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

fn stand_in(data: &Data, id: &str, device: usize) -> Table {
    let pairs = stand_ins(data, device);
    let mut scenes: Vec<&SceneKey> = pairs.iter().map(|p| &p.base.scene).collect();
    scenes.sort();
    scenes.dedup();
    let mut names: Vec<(&str, &str)> = pairs.iter().map(|p| (p.base.structure.as_str(), p.option.as_str())).collect();
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
    Table {
        id: id.into(),
        title: format!("Group shape and memory of the stack, PSR, {}", data.devices[device].label),
        keys: vec!["structure".into(), "option".into()],
        columns: scenes.iter().flat_map(|s| columns_of(&s.to_string())).collect(),
        rows,
        notes: vec![
            "A stand-in: wgpu has no register limit, so the thesis's question (how many threads fit on a processor) is \
             asked through the shape of work-groups and the memory of the stack."
                .into(),
            "Faster: 1 - time with the option / time by default; below zero it is slower. Default: groups of 8x8, the \
             kd-tree's stack in work-group memory."
                .into(),
        ],
        beside: false,
    }
}
