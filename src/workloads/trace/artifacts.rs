//! Built structures as a table: `structures.csv`, and what `rtbench build` prints.

use super::record::variant_of;
use crate::error::{Error, Result};
use crate::record::journal::Journal;
use crate::record::row::{Artifact, Input, Metric, Value, metric};
use crate::record::statistics::round;
use crate::record::terminal;
use std::path::Path;

/// A structure and the scene that it was built of.
pub type Row<'a> = (&'a Artifact, &'a Input);

/// Columns of `structures.csv`: empty where one has no meaning for a structure.
const COLUMNS: [&str; 28] = [
    "scene",
    "structure",
    "variant",
    "cells_x",
    "cells_y",
    "cells_z",
    "max_cell_triangles",
    "references_per_triangle",
    "leaves",
    "empty_leaves",
    "max_leaf_triangles",
    "nodes",
    "depth",
    "sah_cost",
    "build_ms",
    "build_threads",
    "build_stages_ms",
    "build_upload_ms",
    "upload_ms",
    "driver_build_ms",
    "structure_bytes",
    "leaf_order_bytes",
    "geometry_bytes",
    "thesis_bytes",
    "rt2_bytes",
    "triangles",
    "vertices",
    "note",
];

/// The structures of a journal, in the order of building.
pub fn rows(journal: &Journal) -> Vec<Row<'_>> {
    journal.artifacts.iter().filter_map(|artifact| Some((artifact, journal.input(&artifact.key, "scene")?))).collect()
}

/// A value of a structure by column. Numbers are rounded to the digits that they are worth.
fn value((artifact, scene): Row, column: &str) -> Option<Value> {
    let of = |metrics: &[Metric]| metric(metrics, None, column).cloned();
    let places = match column {
        "build_ms" | "build_upload_ms" | "upload_ms" | "driver_build_ms" => 3,
        _ => 4,
    };
    match column {
        "scene" => Some(scene.name.as_str().into()),
        "structure" => Some(artifact.key.axis("structure").into()),
        "variant" => Some(variant_of(&artifact.key).into()),
        "note" => Some(artifact.note.as_str().into()),
        "build_stages_ms" => stages(&artifact.metrics).map(Value::from),
        _ => match of(&artifact.metrics).or_else(|| of(&scene.metrics))? {
            Value::Number(number) => Some(Value::Number(round(number, places))),
            other => Some(other),
        },
    }
}

/// The stages of a build on a device with their milliseconds; `None` for one on the CPU.
fn stages(metrics: &[Metric]) -> Option<String> {
    let of = metrics.iter().filter(|metric| metric.name == "build_ms");
    let stages = of.filter_map(|m| Some(format!("{} {}", m.of.as_ref()?, round(m.value.number()?, 3))));
    Some(stages.collect::<Vec<_>>().join(", ")).filter(|text| !text.is_empty())
}

/// As CSV, with a header.
///
/// # Errors
/// None in practice: the writer is memory.
pub fn csv(rows: &[Row]) -> Result<Vec<u8>> {
    let failed = |e: csv::Error| Error::output(Path::new("CSV"), std::io::Error::other(e));
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(COLUMNS).map_err(failed)?;
    for &row in rows {
        let cells = COLUMNS.iter().map(|column| value(row, column).map_or(String::new(), |value| value.write()));
        writer.write_record(cells).map_err(failed)?;
    }
    writer.into_inner().map_err(|e| Error::output(Path::new("CSV"), e.into_error()))
}

/// As a table for a terminal.
pub fn table(rows: &[Row]) -> String {
    let headings = [
        "scene",
        "structure",
        "build ms",
        "MiB",
        "thesis MiB",
        "cells",
        "fullest",
        "refs/tri",
        "leaves",
        "empty",
        "largest",
        "nodes",
        "depth",
        "SAH",
    ];
    let lines: Vec<Vec<String>> = rows.iter().map(|&row| line(row)).collect();
    format!("{}\n", terminal::table(&headings, 2, &lines))
}

fn line(row: Row) -> Vec<String> {
    let get = |column: &str| value(row, column);
    let integer = |column: &str| get(column).and_then(|v| v.integer());
    let number = |column: &str| terminal::number(get(column).and_then(|v| v.number()));
    let whole = |column: &str| integer(column).map_or("-".to_owned(), |v| v.to_string());
    let mib = |bytes: Option<u64>| terminal::mib(bytes.unwrap_or(0));
    let variant = variant_of(&row.0.key);
    let structure = row.0.key.axis("structure");
    let cells = match (integer("cells_x"), integer("cells_y"), integer("cells_z")) {
        (Some(x), Some(y), Some(z)) => format!("{x}x{y}x{z}"),
        _ => "-".into(),
    };
    vec![
        row.1.name.clone(),
        if variant == "default" { structure.to_owned() } else { format!("{structure}:{variant}") },
        number("build_ms"),
        mib(integer("structure_bytes").zip(integer("geometry_bytes")).map(|(a, b)| a + b)),
        mib(integer("thesis_bytes")),
        cells,
        whole("max_cell_triangles"),
        number("references_per_triangle"),
        whole("leaves"),
        whole("empty_leaves"),
        whole("max_leaf_triangles"),
        whole("nodes"),
        whole("depth"),
        number("sah_cost"),
    ]
}
