//! Recorded rows with counts of warps, in groups that a GPU puts in order.

use super::super::sums::Sums;
use super::gpu::{Gpu, problem};
use super::order::{Modelled, rank, selection_of};
use crate::error::{Error, Result};
use crate::record::row::Status;
use crate::report::{Cell, Column, Form, Origin, Row as TableRow, Table};
use crate::workloads::trace::record::{ConfigurationRecord, TraceJournal};
use std::collections::BTreeSet;

const ORIGIN: Origin = Origin { source: "simt", kind: "table", published: "" };

/// Rows that differ in nothing but the structure.
struct Group {
    title: String,
    rows: Vec<Modelled>,
    /// What is not modelled, and why.
    without: Vec<(String, String)>,
}

fn groups(journals: &[&TraceJournal], gpu: &Gpu) -> Result<Vec<Group>> {
    let mut groups: Vec<(Vec<String>, Group)> = Vec::new();
    let mut other_widths = BTreeSet::new();
    for record in journals.iter().flat_map(|journal| &journal.configurations) {
        let Some(width) = record.warp_width else { continue };
        if width != gpu.warp_width {
            other_widths.insert(width);
            continue;
        }
        let ConfigurationRecord { scene, camera_path, config, frames, .. } = record;
        let size = format!("{}x{}", record.width, record.height);
        let frames = if *frames == 1 { "1 frame".to_owned() } else { format!("{frames} frames") };
        let title = format!("{}, {config:?}, {size}, {}, {frames}", scene.name, camera_path.name);
        // Files of the same name may have other contents
        let key = vec![title.clone(), scene.hash.clone(), camera_path.hash.clone()];
        let index = groups.iter().position(|(known, _)| *known == key).unwrap_or_else(|| {
            groups.push((key, Group { title, rows: Vec::new(), without: Vec::new() }));
            groups.len() - 1
        });
        let group = &mut groups[index].1;
        let name = selection_of(record).map_or_else(|_| unknown_name(record), |selection| selection.full_name());
        let reason = match Modelled::of(record, gpu) {
            Ok(Some(modelled)) => {
                // Of several rows of the same, the last one counts
                group.rows.retain(|known| known.name != name);
                group.without.retain(|(known, _)| *known != name);
                group.rows.push(modelled);
                continue;
            }
            Err(error) => problem(error),
            Ok(None) if record.status != Status::Ok => record.message.clone(),
            Ok(None) => {
                let warning = record.warnings.iter().find(|warning| warning.starts_with("warps are not counted"));
                warning.map_or("no counts, or damaged ones", String::as_str).to_owned()
            }
        };
        let is_known =
            group.rows.iter().any(|known| known.name == name) || group.without.iter().any(|(known, _)| *known == name);
        if !is_known {
            group.without.push((name, reason));
        }
    }
    if !other_widths.is_empty() && groups.is_empty() {
        let widths: Vec<String> = other_widths.iter().map(u32::to_string).collect();
        let widths = widths.join(", ");
        let problem = format!("warps of the run have {widths} lanes, those of {} have {}", gpu.name, gpu.warp_width);
        return Err(Error::argument("--gpu", problem, "measure with that --warp-width, or give another GPU"));
    }
    let titles: Vec<String> = groups.iter().map(|(_, group)| group.title.clone()).collect();
    let with_hash = |(key, mut group): (Vec<String>, Group)| {
        if titles.iter().filter(|title| **title == group.title).count() > 1 {
            let [scene, path] = [1, 2].map(|part| key[part].get(..8).unwrap_or(&key[part]));
            group.title += &format!(" (scene {scene}, path {path})");
        }
        group
    };
    Ok(groups.into_iter().map(with_hash).collect())
}

/// The name of a structure that this program does not have.
fn unknown_name(record: &ConfigurationRecord) -> String {
    [record.structure.as_str(), record.variant.as_str()].join(":")
}

/// A table for each scene, path, ray configuration and size: the order of structures on a GPU.
///
/// # Errors
/// [`Error::Input`]: warps of another width, structures that this program does not have, or no counts at all.
pub fn tables(journals: &[&TraceJournal], gpu: &Gpu) -> Result<Vec<Table>> {
    let groups = groups(journals, gpu)?;
    if groups.is_empty() {
        let hint = "measure with --warp-width, as `rtbench sweep --preset simt` does";
        return Err(Error::argument("RUN", "it has no counts of warps", hint));
    }
    if let Some((name, reason)) = groups.iter().flat_map(|group| &group.without).next()
        && groups.iter().all(|group| group.rows.is_empty())
    {
        let problem = format!("nothing of it is modelled: {name} ({reason})");
        return Err(Error::argument("RUN", problem, "docs/simt-model.md has what is"));
    }
    Ok(groups.into_iter().map(|group| table(group, gpu)).collect())
}

fn table(group: Group, gpu: &Gpu) -> Table {
    let columns = vec![
        Column::new("issue bound", "ms", Form::Time),
        Column::new("utilisation", "%", Form::Fixed(1)),
        Column::new("warps", "resident", Form::Whole),
        Column::new("work", "relative", Form::Fixed(2)),
        Column::new("band", "from", Form::Fixed(2)),
        Column::new("", "to", Form::Fixed(2)),
        Column::new("order", "", Form::Whole),
    ];
    let ranked = rank(gpu, &group.rows);
    let mut place = 0;
    let row = |(index, of): (usize, &super::order::Ranked)| {
        let modelled = &group.rows[of.index];
        let sums = modelled.sums.iter().fold(Sums::default(), |all, sums| all.with(sums));
        if !of.close {
            place = index + 1;
        }
        let order = if of.close { Cell::Text(format!("{place} (too close)")) } else { Cell::number(place as f64) };
        let cells = vec![
            Cell::number(of.bound_ms),
            Cell::number(sums.utilisation(gpu.warp_width).map(|share| 100.0 * share)),
            Cell::number(f64::from(modelled.warps)),
            Cell::number(of.relative),
            Cell::number(of.band.0),
            Cell::number(of.band.1),
            order,
        ];
        TableRow { keys: vec![modelled.name.clone()], cells }
    };
    let rows = ranked.iter().enumerate().map(row).collect();
    let mut notes = vec![
        format!(
            "Issue bound: the least time of issuing what is counted, no time of a frame. Work: issued instructions over resident \
             warps, as a multiple of the first one's; band: the same for weights of instructions within a factor of {}. \
             Too close: within {:.0} % of the first one of the place.",
            super::EVENT_FACTOR,
            100.0 * (super::CLOSE - 1.0)
        ),
        match gpu.validated.as_str() {
            "" => format!("{} is NOT VALIDATED: no published times have confirmed these orders.", gpu.name),
            by => format!("Orders on the {} were validated by {by}.", gpu.name),
        },
        "Registers, memory, caches and latency are not modelled.".to_owned(),
    ];
    if !group.without.is_empty() {
        let list: Vec<String> = group.without.iter().map(|(name, reason)| format!("{name} ({reason})")).collect();
        notes.push(format!("Not modelled: {}.", list.join("; ")));
    }
    Table {
        origin: ORIGIN,
        id: "order".into(),
        title: format!("The SIMT model of {}: {}", gpu.name, group.title),
        keys: vec!["structure".into()],
        columns,
        rows,
        notes,
        with_published: false,
        is_published: false,
    }
}
