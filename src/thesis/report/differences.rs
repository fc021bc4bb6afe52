//! What is not as it was in 2009 (SPEC section 12), and what that means for the numbers.

use super::html::escape;
use crate::record::schema::Status;
use crate::thesis::builds::threads_in_words;
use crate::thesis::data::{Data, structure_title};
use crate::thesis::runs::RecordedRun;

/// What, and why.
const DIFFERENCES: [(&str, &str); 8] = [
    (
        "The interface",
        "Kernels were CUDA, here they are WGSL through wgpu and Vulkan. There is no constant memory for nodes \
         and triangles: they are read from storage buffers, through whatever caches a device has, or on software drivers \
         from textures.",
    ),
    (
        "Registers",
        "A compiler's register limit cannot be set through wgpu. Tables 5.7 and 5.8 have stand-ins that ask the same \
         question, how many threads fit on a processor: the shape of work-groups, and the memory of the kd-tree's stack.",
    ),
    (
        "Barriers",
        "WGSL demands uniform control flow at barriers. The packet's current node is made uniform explicitly, where CUDA \
         relied on all threads of a block taking the same way.",
    ),
    (
        "Checks",
        "wgpu can put bounds checks and loop limits into kernels. They are off unless a table says otherwise; CUDA had none.",
    ),
    (
        "Infinities",
        "WGSL lets an implementation assume that there are none. Directions along an axis are treated explicitly, and \
         intervals are made so that all structures find the same hit to the bit.",
    ),
    (
        "Verification",
        "Every configuration is compared with a reference before it is timed; one that disagrees has no number here. The \
         thesis does not say how its images were checked.",
    ),
    (
        "Cameras",
        "The framing of single objects and the walks through theatre, office and conference were not printed. Counts of \
         these scenes depend on the path that was chosen here; those of BART's scenes follow the path in their files.",
    ),
    (
        "Steps",
        "What the thesis counted as a step in a tree is not known. Ours are stated below tables 5.10 and 5.11, inner nodes, \
         leaves and stack entries are recorded apart, and --convention forms others.",
    ),
];

/// The list, and what this page's own runs and devices add to it.
pub fn write(data: &Data, runs: &[RecordedRun]) -> String {
    let mut entries: Vec<(String, String)> =
        DIFFERENCES.iter().map(|(what, why)| ((*what).to_owned(), (*why).to_owned())).collect();
    entries.push(("What a time is".into(), times(runs)));
    entries.push(("Builders".into(), builders(data)));
    for device in data.devices.iter().filter(|d| d.is_software()) {
        entries.push((
            device.label.clone(),
            "Computes on the CPU. Barriers are dear there and divergence is cheap, the reverse of a GPU: packets look worse \
             and single rays better than they are. Its counts are as good as any device's."
                .into(),
        ));
    }
    for device in data.devices.iter().filter(|d| d.checked) {
        entries.push((device.label.clone(), "Measured with wgpu's checks on, at least in part.".into()));
    }
    let list: String =
        entries.iter().map(|(what, why)| format!("<dt>{}</dt><dd>{}</dd>\n", escape(what), escape(why))).collect();
    format!("<dl>\n{list}</dl>\n")
}

/// How frames were timed, and whether structures took turns: by the rows themselves, because older versions did not.
fn times(runs: &[RecordedRun]) -> String {
    let rows = runs.iter().flat_map(|run| &run.journal.configurations);
    let turns: Vec<usize> = rows.filter(|r| r.status == Status::Ok && r.verified).map(|r| r.turns).collect();
    let in_turns = turns.iter().filter(|number| **number > 1).count();
    let order = match (in_turns, turns.len()) {
        (_, 0) => String::new(),
        (0, _) => " Each row was timed on its own.".into(),
        (some, all) if some == all => " Structures took turns in being timed, pass by pass.".into(),
        (some, all) => {
            format!(
                " In {some} of {all} rows structures took turns in being timed, pass by pass; the others were timed each on its own."
            )
        }
    };
    format!(
        "A frame's time is its median over several passes along the path, by the device's timestamps where there are any.{order} \
         The thesis recorded single frames; its minimum and maximum therefore hold disturbances that ours do not."
    )
}

/// On how many threads structures were built: by their records, since presets and --threads choose.
fn builders(data: &Data) -> String {
    let constants = "The constants of its builders were not printed: ours are one set for all scenes.";
    if data.published || data.built.is_empty() {
        return format!("The thesis built everything on one core. {constants}");
    }
    let mut threads: Vec<(usize, Vec<&str>)> = Vec::new();
    for by in data.builders() {
        let built = data.built.iter().filter(|b| b.by() == by).map(|b| structure_title(&b.structure));
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
