//! The thesis on one page: HTML without any network, script or outside file.

mod claims;
mod differences;
mod html;
mod pictures;
mod provenance;
mod tables;

use super::claims::judge;
use super::data::Data;
use super::figures::{self, Figure, Missing};
use super::runs::RecordedRun;
use super::tables::{IDS, Options, Rows, build, without_numbers};
use crate::error::Result;
use html::escape;

/// What a report is made of.
pub struct Sources<'a> {
    /// The runs; none for what the thesis printed.
    pub runs: &'a [RecordedRun],
    /// Their numbers.
    pub data: &'a Data,
    /// The published ones.
    pub published: &'a Data,
}

/// The page.
///
/// # Errors
/// A picture that is there and cannot be read.
pub fn write(sources: &Sources, options: &Options) -> Result<String> {
    let (data, published) = (sources.data, sources.published);
    let findings = judge(data, published, options.card.unwrap_or(0));
    let (figures, missing) = figures::all(data)?;
    let mut tables = build(data, published, options, &IDS);
    if options.rows == Rows::Measured {
        tables.retain(|table| !table.rows.is_empty());
    }
    let absent = without_numbers(data, published, options, &IDS);

    let title =
        if sources.runs.is_empty() { "The thesis of 2009, as printed" } else { "The thesis of 2009, measured anew" };
    let mut body = format!("<h1>{title}</h1>\n{}", lead(sources, options.rows));
    body += "<nav><a href=\"#claims\">Claims</a> <a href=\"#tables\">Tables</a> <a href=\"#figures\">Figures</a> \
             <a href=\"#pictures\">Pictures</a> <a href=\"#differences\">What differs</a> \
             <a href=\"#provenance\">Provenance</a></nav>\n";
    body += &html::section("claims", "Claims", &claims::write(&findings));
    body += &html::section("tables", "Tables", &(tables::write(&tables) + &tables::absent(&absent)));
    body += &html::section("figures", "Figures", &(drawn(&figures) + &undrawn(&missing)));
    body += &html::section("pictures", "Pictures", &pictures::write(sources.runs)?);
    body += &html::section("differences", "What differs from 2009, and why", &differences::write(data, sources.runs));
    body += &html::section("provenance", "Provenance", &provenance::write(sources.runs));
    Ok(html::page(title, &body))
}

/// What the page is about, in a few lines.
fn lead(sources: &Sources, rows: Rows) -> String {
    if sources.runs.is_empty() {
        return "<p class=\"lead\">The numbers that were printed, and what its claims come to by them. Give recorded runs to \
                see them measured anew.</p>\n"
            .into();
    }
    let devices: Vec<String> = sources.data.devices.iter().map(|d| escape(&d.label)).collect();
    let mut text = format!(
        "<p class=\"lead\">Ray tracing with a uniform grid, a kd-tree and a BVH: every table, figure and claim that could be \
         made of {} on {}. Numbers of 2009 stand below the measured ones; what was not measured is {} and named.</p>\n",
        if sources.runs.len() == 1 {
            "one recorded run".into()
        } else {
            format!("{} recorded runs", sources.runs.len())
        },
        devices.join(", "),
        if rows == Rows::Measured { "left out" } else { "empty" },
    );
    if sources.data.devices.iter().any(super::data::Device::is_software) {
        text += "<p class=\"warning\">At least one device computes on the CPU (a software rasteriser, or the CPU twins of the \
                 kernels). Its times are about that machine and rank no structures for a GPU. Counts, sizes and properties do \
                 not depend on the device.</p>\n";
    }
    for note in &sources.data.notes {
        text += &format!("<p class=\"warning\">{}.</p>\n", escape(note));
    }
    text
}

fn drawn(figures: &[Figure]) -> String {
    figures
        .iter()
        .map(|f| {
            format!(
                "<figure><div class=\"wide\">{}</div><figcaption>{}</figcaption></figure>\n",
                inline(&f.svg),
                escape(&f.caption)
            )
        })
        .collect()
}

/// A figure as a part of the page: the page has the style sheet, and HTML needs no name space.
fn inline(svg: &str) -> String {
    let without_style = match (svg.find("<style>"), svg.find("</style>")) {
        (Some(from), Some(to)) => [&svg[..from], &svg[to + "</style>".len()..]].concat(),
        _ => svg.to_owned(),
    };
    without_style.replacen(" xmlns=\"http://www.w3.org/2000/svg\"", "", 1)
}

fn undrawn(missing: &[Missing]) -> String {
    let line = |m: &Missing| {
        let what = if m.id == "bars" { "Bars of frame times".into() } else { format!("Figure {}", m.id) };
        format!("<p class=\"note\">{what} is not drawn: it needs {}.</p>\n", escape(m.needs))
    };
    missing.iter().map(line).collect()
}
