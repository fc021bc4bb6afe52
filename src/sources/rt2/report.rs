//! The document's words in the HTML report: the lead, and what differs from 2010.

use super::data::Data;
use super::published::Published;
use crate::report::html::escape;
use crate::sources::rows::Device;
use crate::sources::{Rows, Section};

/// What the page is about, and what to beware of.
pub fn lead(data: Option<&Data>, runs: usize, rows: Rows) -> String {
    let Some(data) = data else {
        return "<p class=\"lead\">The orders and percentages that were printed, and what the claims come to by them. \
                Give recorded runs to see them measured anew.</p>\n"
            .into();
    };
    let devices: Vec<String> = data.devices.iter().map(|d| escape(&d.label)).collect();
    let mut text = format!(
        "<p class=\"lead\">A kd-tree with and without ropes against a BVH: every figure as a table and a bar chart, \
         and every claim that could be judged by {} on {}. Orders and percentages of 2010 are below the measured numbers; \
         frames per second, times and sizes of 2010 are in no text and stay empty. What was not measured is {} and \
         named.</p>\n",
        if runs == 1 { "one recorded run".into() } else { format!("{runs} recorded runs") },
        devices.join(", "),
        if rows == Rows::Measured { "left out" } else { "empty" },
    );
    if data.devices.iter().any(Device::is_software) {
        text += "<p class=\"warning\">At least one device computes on the CPU (a software rasteriser, or the CPU \
                 twins of the kernels). Its times are about that machine and rank no structures for a GPU: claims \
                 about frames are judged by steps per ray there. Counts, sizes and properties do not depend on the \
                 device.</p>\n";
    }
    for note in &data.notes {
        text += &format!("<p class=\"warning\">{}.</p>\n", escape(note));
    }
    text
}

/// What differs, and the consequence or reason.
const DIFFERENCES: [(&str, &str); 8] = [
    (
        "Models",
        "Alien, Dino and the document's Dragon are not public. Their counterparts are evenly meshed built-in scans of \
         their sizes, a scan with spikes for the Dino's pointed shape, and Stanford's dragon.",
    ),
    (
        "Cameras",
        "The document shows its views as pictures only. Objects are circled here, rooms have a path of their own.",
    ),
    (
        "Rays",
        "Whether shadows or reflections were on while the document measured is not stated. Its tables are filled with \
         primary rays alone.",
    ),
    (
        "The BVH's traversal",
        "As printed, no box is compared with the nearest hit so far. Tables and claims have this one (cull=off), and \
         next to it the one that leaves out what lies behind that hit.",
    ),
    (
        "Builders",
        "Costs and stop rules were not printed. Here the kd-tree's costs of a node and of a triangle \
         are both 1, and a BVH node of at most three triangles is a leaf. Build times are like those of the document only where both sort in every node.",
    ),
    (
        "Memory",
        "Its sizes are in a chart only. The model counts what the text says of records; what is really allocated is \
         in the same table, and has another order on some scenes.",
    ),
    (
        "Exactness",
        "Rays through edges of cells are finished by a search that visits cells of no length, because ropes alone \
         would lose hits. The counters say how often.",
    ),
    ("Spatial splits and BIH", "The document describes both and measured neither. They are in tables of their own."),
];

/// What is not as it was in 2010, and the parameters that were printed.
pub fn differences(published: &Published) -> Section {
    let mut entries: Vec<(String, String)> =
        DIFFERENCES.iter().map(|(what, why)| ((*what).to_owned(), (*why).to_owned())).collect();
    let parameters: Vec<String> =
        published.parameters.iter().map(|p| format!("{}: {} {}", p.structure, p.parameter, p.value)).collect();
    entries.push(("Parameters as printed".into(), parameters.join("; ") + "."));
    let list: String =
        entries.iter().map(|(what, why)| format!("<dt>{}</dt><dd>{}</dd>\n", escape(what), escape(why))).collect();
    Section {
        id: "differences",
        name: "What differs",
        title: "What differs from 2010, and why",
        content: format!("<dl>\n{list}</dl>\n"),
    }
}
