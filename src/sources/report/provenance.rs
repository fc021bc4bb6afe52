//! Where the numbers come from: device, machine, program and command of every run.

use crate::record::row::Status;
use crate::record::run::DeviceRecord;
use crate::report::html::{entry, escape};
use crate::sources::Source;
use crate::sources::runs::RecordedRun;

/// A list per run; without runs, the folder of the published numbers.
pub fn write(runs: &[RecordedRun], source: &Source) -> String {
    if runs.is_empty() {
        return format!("<p>{}</p>\n", source.published_in);
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
    let (rows, errors) =
        (run.general.rows.len(), run.general.rows.iter().filter(|row| row.status != Status::Ok).count());
    let of_devices = |text: &dyn Fn(&DeviceRecord) -> String| p.devices.iter().map(text).collect::<Vec<_>>().join("; ");
    let entries = [
        ("device", of_devices(&|d| d.info.description())),
        ("driver", of_devices(&|d| [d.info.backend.as_str(), d.info.driver.as_str()].join(" ").trim().to_owned())),
        ("chosen because", of_devices(&|d| d.reason.clone())),
        ("shader checks", of_devices(&|d| if d.info.checked { "on" } else { "off" }.to_owned())),
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
        ("left out", list(&p.plan.absent)),
        ("measured", format!("{rows} rows, {errors} without a result; {} passes", p.plan.settings.passes)),
        ("resumed", list(&run.journal.resumed.iter().map(|r| r.started.clone()).collect::<Vec<_>>())),
        ("end", end),
    ];
    let entries: String = entries.iter().map(|(name, value)| entry(name, value)).collect();
    format!("<h3>Run of {}</h3>\n<dl>\n{entries}</dl>\n", escape(&p.started))
}
