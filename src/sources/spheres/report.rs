//! The document's words in the HTML report: the lead, and what differs from the paper.

use super::data::Data;
use crate::report::html::escape;
use crate::sources::rows::Device;
use crate::sources::{Rows, Section};

/// What the page is about, and warnings.
pub fn lead(data: Option<&Data>, runs: usize, rows: Rows) -> String {
    let Some(data) = data else {
        return "<p class=\"lead\">The times and metrics that were printed, what follows from them, and what the claims \
                come to by them. Give recorded runs to see them measured anew.</p>\n"
            .into();
    };
    let devices: Vec<String> = data.devices.iter().map(|d| escape(&d.label)).collect();
    let mut text = format!(
        "<p class=\"lead\">One picture of spheres, rendered sequentially, with SIMD, with threads, with both and on a \
         GPU: the paper's four tables and its metrics with the printed values below the measured ones, what each switch \
         does on its own, and every claim that could be judged by {} on {}. What was not measured is {} and named.</p>\n",
        if runs == 1 { "one recorded run".into() } else { format!("{runs} recorded runs") },
        devices.join(", "),
        if rows == Rows::Measured { "left out" } else { "empty" },
    );
    let gpus = data.places.iter().filter_map(|place| data.devices.get(place.gpu?));
    let software: Vec<String> = gpus.filter(|d| d.is_software()).map(|d| escape(&d.label)).collect();
    if !software.is_empty() {
        text += &format!(
            "<p class=\"warning\">In place of a GPU: {}, which computes on the CPU. Its times are about this machine \
             only.</p>\n",
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
        "Positions, radii and colours are not published. Ours have the names and numbers of spheres of the paper's, so \
         that no printed time belongs to the same picture.",
    ),
    (
        "Times",
        "Size of the image, frames, constants and compiler options are not published either: ratios between renderers \
         and versions are compared, never milliseconds.",
    ),
    (
        "Frames",
        "A run takes its frames evenly over one period of the orbit, by their index. Had the paper's camera moved with \
         the clock, which it does not say, its renderers would have shown unlike frames.",
    ),
    (
        "Presentation",
        "Nothing is presented here. The paper's GPU times with 3 and 20 spheres hardly change while the work falls \
         several times: they look like the pace of a screen, or like copying.",
    ),
    (
        "Versions",
        "The paper changed the algorithm and the exit on a miss together. Here each is a switch, so that what one of \
         them does can be told.",
    ),
    (
        "Dead paths",
        "A ray made from a miss may hit again. Here such a path stays dead, and still costs its searches where no exit \
         ends it.",
    ),
    (
        "Metrics",
        "No printed Karp-Flatt metric follows from the formula; all do if 1/p is added instead of subtracted. Both are \
         in the table.",
    ),
    (
        "Processors",
        "The paper counts 8 cores times 4 lanes, slow cores as fast ones. Here the threads of the run count, times the \
         lanes; a GPU has no number unless --processors gives it one.",
    ),
    (
        "Half precision",
        "On the CPU every operation is rounded to half precision: that tells what the picture is like, and no speed.",
    ),
];

/// What is not as in the paper.
pub fn differences(data: Option<&Data>) -> Section {
    let mut entries: Vec<(String, String)> =
        DIFFERENCES.iter().map(|(what, why)| ((*what).to_owned(), (*why).to_owned())).collect();
    let instructions = data.map(instructions).unwrap_or_default();
    if !instructions.is_empty() {
        entries.push((
            "Instructions".into(),
            format!("The paper used Neon, 128 bits at once. Measured here: {}.", instructions.join(", ")),
        ));
    }
    let list: String =
        entries.iter().map(|(what, why)| format!("<dt>{}</dt><dd>{}</dd>\n", escape(what), escape(why))).collect();
    Section {
        id: "differences",
        name: "What differs",
        title: "What differs from the paper, and why",
        content: format!("<dl>\n{list}</dl>\n"),
    }
}

/// What the renderers ran on, each once.
fn instructions(data: &Data) -> Vec<String> {
    let mut found: Vec<String> =
        data.measurements.iter().filter_map(|m| m.work.as_ref()).map(|w| w.instructions.clone()).collect();
    found.retain(|words| !words.is_empty());
    found.sort_unstable();
    found.dedup();
    found
}
