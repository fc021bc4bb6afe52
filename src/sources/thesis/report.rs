//! The thesis's words in the HTML report: the lead, and what differs from 2009.

use super::data::{Data, Device};
use super::structures::title;
use crate::report::html::escape;
use crate::sources::rows::threads_in_words;
use crate::sources::runs::{RecordedRun, interleaved_rows};
use crate::sources::{Rows, Section};

/// What the page is about, and what to beware of.
pub fn lead(data: &Data, runs: usize, rows: Rows) -> String {
    if runs == 0 {
        return "<p class=\"lead\">The numbers that were printed, and what its claims come to by them. Give recorded \
                runs to see them measured anew.</p>\n"
            .into();
    }
    let devices: Vec<String> = data.devices.iter().map(|d| escape(&d.label)).collect();
    let mut text = format!(
        "<p class=\"lead\">Ray tracing with a uniform grid, a kd-tree and a BVH: every table, figure and claim that \
         could be made of {} on {}. Numbers of 2009 are below the measured ones; what was not measured is {} and \
         named.</p>\n",
        if runs == 1 { "one recorded run".into() } else { format!("{runs} recorded runs") },
        devices.join(", "),
        if rows == Rows::Measured { "left out" } else { "empty" },
    );
    if data.devices.iter().any(Device::is_software) {
        text += "<p class=\"warning\">At least one device computes on the CPU (a software rasteriser, or the CPU \
                 twins of the kernels). Its times are about that machine and rank no structures for a GPU. Counts, \
                 sizes and properties do not depend on the device.</p>\n";
    }
    for note in &data.notes {
        text += &format!("<p class=\"warning\">{}.</p>\n", escape(note));
    }
    text
}

/// What differs, and the consequence or reason.
const DIFFERENCES: [(&str, &str); 8] = [
    (
        "The interface",
        "Kernels were CUDA, here they are WGSL through wgpu and Vulkan. There is no constant memory for nodes and \
         triangles: they are read from storage buffers, through the caches that a device has, or on software drivers \
         from textures.",
    ),
    (
        "Registers",
        "A compiler's register limit cannot be set through wgpu. Tables 5.7 and 5.8 have substitute options that ask \
         the same question, how many threads fit on a processor: the shape of work-groups, and the memory of the \
         kd-tree's stack.",
    ),
    (
        "Barriers",
        "WGSL demands uniform control flow at barriers. The packet's current node is made uniform explicitly, where \
         CUDA relied on all threads of a block taking the same path.",
    ),
    (
        "Checks",
        "wgpu can put bounds checks and loop limits into kernels. They are off unless a table says otherwise; CUDA \
         had none.",
    ),
    (
        "Infinities",
        "WGSL lets an implementation assume that there are none. Directions along an axis are treated explicitly, and \
         intervals are made so that all structures find the same hit to the bit.",
    ),
    (
        "Verification",
        "Every configuration is compared with a reference before it is timed; one that disagrees has no number here. \
         The thesis does not say how its images were checked.",
    ),
    (
        "Cameras",
        "The framing of single objects and the walks through theatre, office and conference were not printed. Counts \
         of these scenes depend on the path that was chosen here; those of BART's scenes follow the path in their \
         files.",
    ),
    (
        "Steps",
        "What the thesis counted as a step in a tree is not known. Ours are stated below tables 5.10 and 5.11, inner \
         nodes, leaves and stack entries are recorded apart, and --convention forms others.",
    ),
];

/// What is not as it was in 2009: the list, and entries for the runs and devices of this page.
pub fn differences(data: &Data, runs: &[RecordedRun]) -> Section {
    let mut entries: Vec<(String, String)> =
        DIFFERENCES.iter().map(|(what, why)| ((*what).to_owned(), (*why).to_owned())).collect();
    entries.push(("What a time is".into(), times(runs)));
    entries.push(("Builders".into(), builders(data)));
    for device in data.devices.iter().filter(|d| d.is_software()) {
        entries.push((
            device.label.clone(),
            "Computes on the CPU. Barriers are dear there and divergence is cheap, the reverse of a GPU: packets look \
             worse and single rays better than they are. Its counts are as good as any device's."
                .into(),
        ));
    }
    for device in data.devices.iter().filter(|d| d.checked) {
        entries.push((device.label.clone(), "Measured with wgpu's checks on, at least in part.".into()));
    }
    let list: String =
        entries.iter().map(|(what, why)| format!("<dt>{}</dt><dd>{}</dd>\n", escape(what), escape(why))).collect();
    Section {
        id: "differences",
        name: "What differs",
        title: "What differs from 2009, and why",
        content: format!("<dl>\n{list}</dl>\n"),
    }
}

/// How frames were timed, and whether passes of several structures were interleaved: older versions did not.
fn times(runs: &[RecordedRun]) -> String {
    let order = match interleaved_rows(runs) {
        (_, 0) => String::new(),
        (0, _) => " Each row was timed on its own.".into(),
        (some, all) if some == all => " Passes of several structures were interleaved.".into(),
        (some, all) => {
            format!(
                " In {some} of {all} rows passes of several structures were interleaved; the others were timed each on \
                 its own."
            )
        }
    };
    format!(
        "A frame's time is its median over several passes along the path, by the device's timestamps where there are \
         any.{order} The thesis recorded single frames; its minimum and maximum therefore hold disturbances that ours \
         do not."
    )
}

/// The numbers of threads that structures were built on, from their records.
fn builders(data: &Data) -> String {
    let constants = "The constants of its builders were not printed: ours are one set for all scenes.";
    if data.published || data.built.is_empty() {
        return format!("The thesis built everything on one core. {constants}");
    }
    let mut threads: Vec<(usize, Vec<&str>)> = Vec::new();
    for by in data.builders() {
        let built = data.built.iter().filter(|b| b.by() == by).map(|b| title(&b.structure));
        match threads.iter_mut().find(|(number, _)| *number == by.threads) {
            Some((_, structures)) => structures.extend(built),
            None => threads.push((by.threads, built.collect())),
        }
    }
    if let [(1, _)] = threads[..] {
        return format!("All structures were built on one thread, as the thesis's were on one core. {constants}");
    }
    let line = |(number, structures): &mut (usize, Vec<&str>)| {
        structures.sort_unstable();
        structures.dedup();
        format!("on {}: {}", threads_in_words(*number), structures.join(", "))
    };
    let lines: Vec<String> = threads.iter_mut().map(line).collect();
    format!("Built {}. The thesis built everything on one core. {constants}", lines.join("; "))
}
