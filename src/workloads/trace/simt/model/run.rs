//! Recorded rows with counts of warps, in groups that a GPU puts in order.

use super::super::sums::Sums;
use super::gpu::Gpu;
use super::order::{Modelled, rank};
use super::weights::Weights;
use crate::device::Source;
use crate::error::{Error, Result};
use crate::record::journal::Journal;
use crate::record::row::{Row, Status, Value};
use crate::report::{Cell, Column, Form, Origin, Row as TableRow, Table};
use crate::workloads::trace::backend::RAY_TYPES;
use crate::workloads::trace::gpu::kernels::{self, Entry, Kernel, StagedPass};
use crate::workloads::trace::rays::Config;
use crate::workloads::trace::record::{WORKLOAD, variant_of};
use crate::workloads::trace::{Method, Selection};

const ORIGIN: Origin = Origin { source: "simt", kind: "table", published: "" };

/// Rows that differ in nothing but the structure.
struct Group {
    title: String,
    rows: Vec<Modelled>,
    /// What is not modelled, and why.
    without: Vec<(String, String)>,
}

/// What a row's warps issued, by ray type; `None` where they were not counted.
pub fn sums_of(row: &Row) -> Option<Vec<Sums>> {
    let of = |ray: &str| Sums::read(|name| row.metric(Some(ray), name).and_then(Value::integer));
    let sums: Vec<Sums> = RAY_TYPES.iter().filter_map(|ray| of(ray)).collect();
    (!sums.is_empty()).then_some(sums)
}

/// The selection of a row.
fn selection_of(row: &Row) -> Result<Selection> {
    let (structure, variant) = (row.key.axis("structure"), variant_of(&row.key));
    Selection::parse(&if variant == "default" { structure.to_owned() } else { format!("{structure}:{variant}") })
}

/// The timed kernel of frames as a GPU runs it, with a stack of 32; where a frame has several passes, that of primary
/// rays.
///
/// # Errors
/// [`crate::Error::Device`] with file and line for an include that does not exist (a mistake in `kernels/`).
fn timed_kernel(method: Method, config: Config) -> Result<Source> {
    let entry = if method.traversal.packets.is_some() {
        kernels::packet_passes(config, false)[0]
    } else if method.is_staged(config.bounces()) {
        Entry::Staged { config, counting: false, pass: StagedPass::Primary }
    } else {
        Entry::Render { config, counting: false }
    };
    let kernel = Kernel { entry, method, stack_size: 32, software_threads: 0, textures: false, leaf_order: false };
    kernel.assemble().map_err(Error::Device)
}

impl Modelled {
    /// A row on a GPU, by the weights of its kernel.
    ///
    /// # Errors
    /// [`Error::Input`] for a structure that this program does not have.
    pub fn of(row: &Row, sums: Vec<Sums>, gpu: &Gpu) -> Result<Modelled> {
        let selection = selection_of(row)?;
        let method = selection.method();
        let config = Config::named(row.key.axis("config"));
        let config = config.ok_or_else(|| Error::argument("RUN", "a row has no ray configuration", ""))?;
        let frames = row.key.axis("frames").parse().ok().filter(|&frames| frames > 0);
        let frames = frames.ok_or_else(|| Error::argument("RUN", "a row has no number of frames", ""))?;
        let kernel = timed_kernel(method, config)?;
        let bytes = kernel.cost()?.workgroup_bytes;
        Ok(Modelled {
            warps: gpu.resident_warps(selection.name(), method.group.size(), bytes),
            name: selection.full_name(),
            weights: Weights::of_kernel(&kernel)?,
            sums,
            frames,
        })
    }
}

fn groups(journals: &[&Journal], gpu: &Gpu) -> Result<Vec<Group>> {
    let mut groups: Vec<Group> = Vec::new();
    let mut other_width = None;
    for row in journals.iter().flat_map(|journal| &journal.rows) {
        let width = row.key.axis("warp_width");
        if row.key.workload != WORKLOAD || width.is_empty() {
            continue;
        }
        if width.parse() != Ok(gpu.warp_width) {
            other_width.get_or_insert(width);
            continue;
        }
        let [scene, path, config, size] = ["scene", "camera_path", "config", "resolution"].map(|a| row.key.axis(a));
        let title = format!("{scene}, {config}, {size}, {path}, {} frames", row.key.axis("frames"));
        let index = groups.iter().position(|group| group.title == title).unwrap_or_else(|| {
            groups.push(Group { title, rows: Vec::new(), without: Vec::new() });
            groups.len() - 1
        });
        let group = &mut groups[index];
        match sums_of(row) {
            Some(sums) => {
                let modelled = Modelled::of(row, sums, gpu)?;
                // Of several rows of the same, the last one counts
                group.rows.retain(|known| known.name != modelled.name);
                group.without.retain(|(name, _)| *name != modelled.name);
                group.rows.push(modelled);
            }
            None => {
                let name = selection_of(row).map_or(row.key.axis("structure").to_owned(), |s| s.full_name());
                let reason = match row.status {
                    Status::Ok => row.warnings.iter().find(|warning| warning.starts_with("warps are not counted")),
                    _ => Some(&row.message),
                };
                let is_known = group.rows.iter().any(|known| known.name == name)
                    || group.without.iter().any(|(known, _)| *known == name);
                if !is_known {
                    group.without.push((name, reason.map_or("not counted", String::as_str).to_owned()));
                }
            }
        }
    }
    if let Some(width) = other_width.filter(|_| groups.is_empty()) {
        let problem = format!("warps of the run have {width} lanes, those of {} have {}", gpu.name, gpu.warp_width);
        return Err(Error::argument("--gpu", problem, "measure with that --warp-width, or give another GPU"));
    }
    Ok(groups)
}

/// A table for each scene, path, ray configuration and size: the order of structures on a GPU.
///
/// # Errors
/// [`Error::Input`]: warps of another width, structures that this program does not have, or no counts at all.
pub fn tables(journals: &[&Journal], gpu: &Gpu) -> Result<Vec<Table>> {
    let groups = groups(journals, gpu)?;
    if groups.is_empty() {
        let hint = "measure with --warp-width, as `rtbench sweep --preset simt` does";
        return Err(Error::argument("RUN", "it has no counts of warps", hint));
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
