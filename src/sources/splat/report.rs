//! The document's words in the HTML report: the lead, what differs from the thesis, and its kernels.

use super::data::Data;
use super::published::Published;
use crate::report::html::escape;
use crate::sources::rows::Device;
use crate::sources::{Rows, Section};

/// What the page is about, and warnings.
pub fn lead(data: Option<&Data>, runs: usize, rows: Rows) -> String {
    let Some(data) = data else {
        return "<p class=\"lead\">The labels and axes of charts and the sizes that were printed, and what the claims \
                come to by them. Give recorded runs to see them measured anew.</p>\n"
            .into();
    };
    let devices: Vec<String> = data.devices.iter().map(|d| escape(&d.label)).collect();
    let mut text = format!(
        "<p class=\"lead\">Photons splatted onto clusters of view samples, estimated per sample and by buckets of \
         directions: times of groups of stages and printed bounds next to measured values, clusters and their \
         photons, memory, errors against path-traced references, and every claim that could be judged by {} on {}. \
         What was not measured is {}.</p>\n",
        if runs == 1 { "one recorded run".into() } else { format!("{runs} recorded runs") },
        devices.join(", "),
        if rows == Rows::Measured { "left out" } else { "empty and named" },
    );
    let software: Vec<String> = data.devices.iter().filter(|d| d.is_software()).map(|d| escape(&d.label)).collect();
    if !software.is_empty() {
        text += &format!(
            "<p class=\"warning\">In place of a GPU: {}, which computes on the CPU. Its times are about this machine \
             only; claims are judged by counts where there are any.</p>\n",
            software.join(", ")
        );
    }
    if data.devices.iter().any(|d: &Device| d.checked) {
        text += "<p class=\"warning\">Kernels had wgpu's checks.</p>\n";
    }
    for note in &data.notes {
        text += &format!("<p class=\"warning\">{}.</p>\n", escape(note));
    }
    text
}

/// What differs, and the consequence or reason.
const DIFFERENCES: [(&str, &str); 9] = [
    (
        "Scenes",
        "The thesis measured Crytek's Sponza, ours is that of Dabrovic unless a row says otherwise; Sibenik is the \
         same model. Cameras, lights and animations are not printed.",
    ),
    (
        "Radius",
        "Printed in units of an unknown scale (15 and 20). Here a share of the extent's diagonal: 0.10 gives the \
         published numbers of assignments, 0.03 a usable picture.",
    ),
    (
        "Photons",
        "17 thousand there; here the photons that stay of 5667 paths with four hits, all but the first hit stored.",
    ),
    (
        "Samples and direct light",
        "Rasterised with a shadow map there, traced here: group B is other work, and the shadow is exact.",
    ),
    (
        "Charts",
        "Lines of charts cannot be read from the scan; ends of axes are upper bounds. Only figure 5.2 has labels.",
    ),
    (
        "Normalisation",
        "The thesis prints no normalisation of its kernel. Here 2 / (pi r^2), so that errors can be compared with a \
         path-traced reference, as printed and after the best single scale.",
    ),
    (
        "Minimum and maximum of floats",
        "There are no such atomic operations here: words with the same order take their place.",
    ),
    (
        "Lists",
        "The thesis provides for 10 million assignments, its charts reach 14 million. Here a row with more than the \
         capacity is an error that names both numbers.",
    ),
    ("Buckets", "Fixed-point words by default, which give the same bits in any order; floats are an option."),
];

/// What is not as in the thesis.
pub fn differences() -> Section {
    let entry = |(what, why): &(&str, &str)| format!("<dt>{}</dt><dd>{}</dd>\n", escape(what), escape(why));
    let list: String = DIFFERENCES.iter().map(entry).collect();
    Section {
        id: "differences",
        name: "What differs",
        title: "What differs from the thesis, and why",
        content: format!("<dl>\n{list}</dl>\n"),
    }
}

/// The thesis's kernels with the stages that do the same here.
pub fn kernels(published: &Published) -> Section {
    let entry = |kernel: &super::published::Kernel| {
        let name = if kernel.kernel.is_empty() { "(not legible)" } else { &kernel.kernel };
        let technique = if kernel.technique == "both" { "" } else { &kernel.technique };
        let technique = if technique.is_empty() { String::new() } else { format!(", {technique}") };
        format!(
            "<dt>{}</dt><dd>{}: {}{}; here <code>{}</code></dd>\n",
            escape(name),
            kernel.group.letter(),
            escape(&kernel.does),
            escape(&technique),
            escape(&kernel.stage_here)
        )
    };
    let list: String = published.kernels.iter().map(entry).collect();
    Section {
        id: "kernels",
        name: "Kernels",
        title: "Kernels of the thesis, and the stages here",
        content: format!("<dl>\n{list}</dl>\n"),
    }
}
