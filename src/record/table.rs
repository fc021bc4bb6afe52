//! Tables for a terminal: pure functions of a run's rows.

use crate::record::schema::Status;
use crate::record::summary::{Row, Run, StructureRow};
use crate::workloads::trace::backend::{Config, DeviceInfo, DeviceType};
use comfy_table::{CellAlignment, LineStyle, Table, TableStyle};

/// One line below the headings and nothing else: rows are told apart by what stands in them.
pub(crate) const STYLE: TableStyle = TableStyle::new().header_separator(LineStyle::none().fill('─').junction('─'));

/// What a device is, in words that say what its times are good for.
pub fn device_in_words(device: &DeviceInfo) -> String {
    let name = &device.name;
    match device.device_type {
        DeviceType::CpuTwin => format!(
            "{name}: the CPU twins of the kernels, no GPU was used; \
             these times do not rank structures for a GPU"
        ),
        DeviceType::SoftwareRasteriser => format!(
            "{name}: a software rasteriser, which computes on the CPU; \
             these times do not rank structures for a GPU"
        ),
        DeviceType::IntegratedGpu => format!("{name}: a GPU that shares the CPU's memory"),
        DeviceType::DiscreteGpu => format!("{name}: a discrete GPU"),
        DeviceType::VirtualGpu => format!("{name}: a virtual GPU"),
        DeviceType::Other => format!("{name}: a device of unknown kind"),
    }
}

/// A table with these headings; columns from `numbers` on are aligned to the right.
fn table(headings: &[&str], numbers: usize) -> Table {
    let mut table = Table::new();
    table.load_style(STYLE).set_header(headings.iter().copied());
    for column in table.column_iter_mut().skip(numbers) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}

/// A number with as many decimals as fit its size; a dash where there is none.
fn number(value: Option<f64>) -> String {
    match value {
        None => "-".into(),
        Some(0.0) => "0".into(),
        Some(v) if v.abs() >= 1000.0 => format!("{v:.0}"),
        Some(v) if v.abs() >= 100.0 => format!("{v:.1}"),
        Some(v) if v.abs() >= 1.0 => format!("{v:.2}"),
        Some(v) => format!("{v:.3}"),
    }
}

/// A whole number; a dash where there is none.
fn whole(value: Option<u32>) -> String {
    value.map_or("-".into(), |v| v.to_string())
}

/// Bytes as MiB, the unit of the thesis's tables.
fn mib(bytes: u64) -> String {
    format!("{:.2}", bytes as f64 / (1024.0 * 1024.0))
}

/// The structure's name with its options, where they are not the defaults.
fn named(structure: &str, variant: &str) -> String {
    if variant.is_empty() || variant == "default" { structure.into() } else { format!("{structure}:{variant}") }
}

/// The measured configurations, scene by scene, each scene fastest first within a configuration and size.
pub fn configurations(device: &DeviceInfo, rows: &[Row]) -> String {
    let mut text = format!("{}\n", device_in_words(device));
    if device.checked && device.device_type != DeviceType::CpuTwin {
        text += "shader checks were on\n";
    }
    for scene in scenes_of(rows) {
        let of_scene: Vec<&Row> = rows.iter().filter(|r| r.scene == scene).collect();
        text += &format!("\n{scene}, {} triangles\n", of_scene[0].triangles);
        text += &table_of_scene(&of_scene).trim_fmt();
        text.push('\n');
    }
    for row in rows.iter().filter(|r| r.status == Status::Error) {
        text += &format!("error: {}: {}\n", label(row), row.message);
    }
    for row in rows.iter().filter(|r| !r.warnings.is_empty()) {
        text += &format!("warning: {}: {}\n", label(row), row.warnings);
    }
    text
}

/// A configuration in one line.
pub fn label(row: &Row) -> String {
    let structure = named(&row.structure, &row.variant);
    format!("{} {structure} {:?} {}x{}", row.scene, row.config, row.width, row.height)
}

/// Names of the scenes, each once, in the order of measuring.
fn scenes_of(rows: &[Row]) -> Vec<&str> {
    let mut scenes: Vec<&str> = Vec::new();
    for row in rows {
        if !scenes.contains(&row.scene.as_str()) {
            scenes.push(&row.scene);
        }
    }
    scenes
}

fn table_of_scene(rows: &[&Row]) -> Table {
    let mut rows = rows.to_vec();
    let group = |r: &Row| (r.config as u8, r.width, r.height);
    let time = |r: &Row| r.frame_ms_mean.unwrap_or(f64::INFINITY);
    rows.sort_by(|a, b| group(a).cmp(&group(b)).then(time(a).total_cmp(&time(b))));
    let mut table = table(
        &[
            "config",
            "size",
            "structure",
            "mean ms",
            "min ms",
            "max ms",
            "noise %",
            "Mrays/s",
            "steps/ray",
            "tests/ray",
            "restarts/ray",
            "result",
        ],
        3,
    );
    let mut last = None;
    for row in rows {
        if last.is_some_and(|last| last != group(row)) {
            table.add_row([""]);
        }
        last = Some(group(row));
        // As the thesis does, each configuration shows the ray type that it adds.
        let (steps, tests, restarts) = match row.config {
            Config::P => (row.primary_steps_per_ray, row.primary_tests_per_ray, row.primary_restarts_per_ray),
            Config::PS => (row.shadow_steps_per_ray, row.shadow_tests_per_ray, row.shadow_restarts_per_ray),
            Config::PSR => (row.reflected_steps_per_ray, row.reflected_tests_per_ray, row.reflected_restarts_per_ray),
        };
        let result = match (row.status, row.verified) {
            (Status::Ok, true) => "verified",
            (Status::Ok, false) => "not verified",
            (Status::Error, _) => "ERROR",
        };
        table.add_row([
            format!("{:?}", row.config),
            format!("{}x{}", row.width, row.height),
            named(&row.structure, &row.variant),
            number(row.frame_ms_mean),
            number(row.frame_ms_min),
            number(row.frame_ms_max),
            number(row.noise_pct),
            number(row.mrays_per_s),
            number(steps),
            number(tests),
            number(restarts),
            result.into(),
        ]);
    }
    table
}

/// Properties, sizes and build times of structures.
pub fn structures(rows: &[StructureRow]) -> String {
    let mut table = table(
        &[
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
        ],
        2,
    );
    for row in rows {
        let cells = match (row.cells_x, row.cells_y, row.cells_z) {
            (Some(x), Some(y), Some(z)) => format!("{x}x{y}x{z}"),
            _ => "-".into(),
        };
        table.add_row([
            row.scene.clone(),
            named(&row.structure, &row.variant),
            number(Some(row.build_ms)),
            mib(row.structure_bytes + row.geometry_bytes),
            mib(row.thesis_bytes),
            cells,
            whole(row.max_cell_triangles),
            number(row.references_per_triangle),
            whole(row.leaves),
            whole(row.empty_leaves),
            whole(row.max_leaf_triangles),
            whole(row.nodes),
            whole(row.depth),
            number(row.sah_cost),
        ]);
    }
    format!("{}\n", table.trim_fmt())
}

/// Everything that a run has to say at its end.
pub fn run(run: &Run) -> String {
    let mut text = String::new();
    if !run.structures.is_empty() {
        text += "Structures (sizes with geometry)\n";
        text += &structures(&run.structures);
        text.push('\n');
    }
    text += &configurations(&run.run.device, &run.configurations);
    text +=
        "steps, tests and restarts: of primary rays under P, of shadow rays under PS, of reflected rays under PSR\n";
    text
}
