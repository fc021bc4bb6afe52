//! A comparison as a page: tables, and a plot of the ratios.

use super::{Comparison, Shown, tables};
use crate::error::Result;
use crate::record::stream::Names;
use crate::report::figure::{Axis, Bar, Figure, Panel, Picture, Series};
use crate::report::html::{self, entry, escape};

/// Writes the page.
///
/// # Errors
/// None in practice: drawing goes to memory.
pub fn page(comparison: &Comparison, names: &Names, shown: Shown) -> Result<String> {
    let sides: Vec<&str> = comparison.sides.iter().map(|side| side.name.as_str()).collect();
    let title = format!("Comparison of {}", sides.join(", "));
    let tables = tables(comparison, names, shown);
    let mut sections = String::new();
    for (table, (id, heading)) in tables.iter().zip([("exact", "Exact quantities"), ("means", "Means")]) {
        if table.id != "3" {
            sections += &html::section(id, heading, &html::table(table));
        }
    }
    if let Some(figure) = figure(comparison)? {
        sections += &html::section("ratios", "Ratios", &html::figure(&figure));
    }
    if let Some(rows) = tables.last() {
        sections += &html::section("rows", "Rows", &html::table(rows));
    }
    sections += &html::section("provenance", "Provenance", &provenance(comparison));
    Ok(html::page(&title, &format!("<h1>{}</h1>\n{sections}", escape(&title))))
}

fn provenance(comparison: &Comparison) -> String {
    let mut list = String::new();
    for run in comparison.sides.iter().flat_map(|side| &side.runs).map(|&run| &comparison.runs[run]) {
        let provenance = &run.run.provenance;
        let devices: Vec<String> =
            run.devices.iter().map(|device| format!("{}, {}", device.device, device.driver)).collect();
        list += &format!("<h3>{}</h3>\n<dl>\n", escape(&run.run.folder.display().to_string()));
        list += &entry("run", &provenance.id);
        list += &entry("started", &provenance.started);
        list += &entry("revision", &provenance.program.git_revision);
        list += &entry("devices", &devices.join("; "));
        list += &entry("command", &provenance.arguments.join(" "));
        list += "</dl>\n";
    }
    list
}

/// The ratios of all rows in ascending order, and geometric means with the range of their ratios. `None` without
/// ratios.
pub fn figure(comparison: &Comparison) -> Result<Option<Figure>> {
    let rated = |row: &super::PairedRow| row.ratio.map(|ratio| ratio.estimate.value);
    let mut ratios: Vec<f64> = comparison.rows.iter().filter_map(rated).collect();
    ratios.sort_by(f64::total_cmp);
    let (Some(_), Some(&most)) = (ratios.first(), ratios.last()) else { return Ok(None) };
    let count = ratios.len() as f64;
    // A line of a few hundred points is as good as one of a hundred thousand
    let step = ratios.len().div_ceil(400);
    let points = ratios.iter().enumerate().filter(|(index, _)| index % step == 0 || index + 1 == ratios.len());
    let points: Vec<(f64, f64)> = points.map(|(index, ratio)| (100.0 * (index + 1) as f64 / count, *ratio)).collect();
    let mut panels = vec![Panel {
        title: "all rows, sorted".into(),
        x: Axis::of_values("share of the rows [%]", false, [100.0]),
        y: Axis::of_values("new time / old time", false, [most, 1.0]),
        series: vec![
            Series { label: "ratio".into(), style: 0, faint: false, points, ringed: None },
            Series {
                label: "equal".into(),
                style: 6,
                faint: true,
                points: vec![(0.0, 1.0), (100.0, 1.0)],
                ringed: None,
            },
        ],
        groups: Vec::new(),
        bars: Vec::new(),
        bands: Vec::new(),
        marks: Vec::new(),
    }];
    // As many as can be labelled
    let means: Vec<_> = comparison.means.iter().take(8).collect();
    if means.len() > 1 {
        let bars = means.iter().enumerate().map(|(index, mean)| Bar {
            label: "geometric mean".into(),
            style: 0,
            span: (index as f64 - 0.3, index as f64 + 0.3),
            mean: mean.ratio,
            whiskers: (mean.ratio, mean.ratio),
        });
        let name = |mean: &&super::Mean| {
            let text = mean.value.chars().take(12).collect::<String>();
            if mean.axis.is_empty() { "all".into() } else { text }
        };
        let end = means.len() as f64;
        panels.push(Panel {
            title: "geometric means".into(),
            x: Axis {
                label: "by axis, in the order of the table".into(),
                log: false,
                range: (-0.5, end - 0.5),
                ticks: (0..means.len()).map(|index| index as f64).collect(),
            },
            y: Axis::of_values("new time / old time", false, means.iter().map(|mean| mean.ratio).chain([1.0])),
            series: Vec::new(),
            groups: means.iter().map(name).collect(),
            bars: bars.collect(),
            bands: Vec::new(),
            marks: Vec::new(),
        });
    }
    let picture = Picture { title: "Ratios of frame times".into(), panels, columns: 1 };
    let caption = format!("Ratios of {} rows, new time by old time; below 1 the newer side is faster.", ratios.len());
    Figure::draw("ratios", "ratios".into(), caption, &picture).map(Some)
}
