//! Where the numbers come from.

use super::html::{entry, escape};
use crate::record::table::device_in_words;
use crate::thesis::runs::RecordedRun;

/// A list per run.
pub fn write(runs: &[RecordedRun]) -> String {
    if runs.is_empty() {
        return "<p>The numbers that the thesis printed, from <code>results/thesis-2009</code>.</p>\n".into();
    }
    runs.iter().map(one).collect()
}

fn one(run: &RecordedRun) -> String {
    let p = &run.journal.provenance;
    let changed = match p.program.git_dirty {
        Some(true) => ", with changes",
        Some(false) => "",
        None => ", perhaps with changes",
    };
    let end = match &run.journal.end {
        None => "killed before its end".into(),
        Some(end) if end.complete => format!("complete, {}", end.ended),
        Some(end) => {
            format!("ended early, {}: {}", end.ended, if end.message.is_empty() { "interrupted" } else { &end.message })
        }
    };
    let list = |words: &[String]| words.join(", ");
    let e = &p.environment;
    let load = e.load_average.map(|l| format!("{l:.2}")).join(", ");
    let variables: Vec<String> = e.variables.iter().map(|(name, value)| format!("{name}={value}")).collect();
    let packages: Vec<String> = p.program.packages.iter().map(|(name, version)| format!("{name} {version}")).collect();
    let (rows, errors) = (
        run.journal.configurations.len(),
        run.journal.configurations.iter().filter(|c| c.status == crate::record::schema::Status::Error).count(),
    );
    let entries = [
        ("device", device_in_words(&p.device)),
        ("driver", [p.device.backend.as_str(), p.device.driver.as_str()].join(" ").trim().to_owned()),
        ("chosen because", p.device_reason.clone()),
        ("shader checks", if p.device.checked { "on" } else { "off" }.to_owned()),
        ("processor", format!("{}, {} threads", e.cpu, e.logical_cpus)),
        ("system", [e.os.as_str(), e.kernel.as_str(), e.architecture.as_str()].join(" ").trim().to_owned()),
        ("load before", load),
        ("variables", list(&variables)),
        (
            "program",
            format!("rtbench {}, revision {}{changed}, {}", p.program.version, p.program.git_revision, p.program.rustc),
        ),
        ("packages", list(&packages)),
        ("command", p.arguments.join(" ")),
        ("preset", p.plan.preset.clone()),
        ("left out", list(&p.plan.skipped)),
        ("measured", format!("{rows} configurations, {errors} without a result; {} passes", p.plan.passes)),
        ("taken up again", list(&run.journal.resumed.iter().map(|r| r.started.clone()).collect::<Vec<_>>())),
        ("end", end),
    ];
    let entries: String = entries.iter().map(|(name, value)| entry(name, value)).collect();
    format!("<h3>Run of {}</h3>\n<dl>\n{entries}</dl>\n", escape(&p.started))
}
