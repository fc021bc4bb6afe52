//! The words of the HTML report.

use super::data::Data;
use crate::report::html::escape;
use crate::sources::Section;
use crate::sources::rows::Device;

/// What the page is about.
pub fn lead(data: &Data, runs: usize) -> String {
    let devices: Vec<String> = data.devices.iter().map(|device| escape(&device.label)).collect();
    let runs = if runs == 1 { "one recorded run".into() } else { format!("{runs} recorded runs") };
    let mut text = format!(
        "<p class=\"lead\">Acceleration structures measured by one harness: rays per second, what a ray does, build time and \
         bytes, by {runs} on {}.</p>\n",
        devices.join(", ")
    );
    if data.devices.iter().any(Device::is_software) {
        text += "<p class=\"warning\">At least one device computes on the CPU. Its times rank no structures for a \
                 GPU; counts and costs do not depend on the device, and bytes only by triangles in leaf order, which \
                 such a device has in addition.</p>\n";
    }
    for note in &data.notes {
        text += &format!("<p class=\"warning\">{}.</p>\n", escape(note));
    }
    text
}

/// What the numbers mean.
pub fn reading() -> Section {
    let entries = [
        ("Rate", "Rays of all types on the path by the time of its frames; shading is in that time."),
        (
            "Break-even",
            "Build and upload of A take longer than those of B, and its rays less time: the number of rays after which A \
             has caught up.",
        ),
        (
            "Pareto front",
            "The structures for which no other one is at least as good in both quantities and better in one.",
        ),
        (
            "SAH cost",
            "The expected cost of a ray by the surface-area heuristic, a node and a triangle test at 1 each. Costs of trees \
             of unlike width do not compare: a wide node tests more boxes.",
        ),
        (
            "The driver's structure",
            "Nothing in it can be counted, and its size is not told. Its build time is that of the sorting on the CPU and \
             of the driver's build.",
        ),
    ];
    let list: String =
        entries.iter().map(|(what, words)| format!("<dt>{}</dt><dd>{}</dd>\n", escape(what), escape(words))).collect();
    Section {
        id: "reading",
        name: "How to read it",
        title: "How to read these numbers",
        content: format!("<dl>\n{list}</dl>\n"),
    }
}
