//! The seam between harness and workload: a workload of a few lines, measured, resumed and summed up like any other.

use rtbench::device::{CpuDevice, Device, FrameTime};
use rtbench::harness::previous::PreviousRun;
use rtbench::harness::run::{self, Job, Opened, Outcome};
use rtbench::harness::summary::{self, Wide};
use rtbench::harness::workload::{Axis, Case, Context, Event, Info, Input, Library, Part, Run, Verdict, Workload};
use rtbench::harness::{Plan, Request};
use rtbench::record::journal::{FILE_NAME, Journal};
use rtbench::record::row::{Artifact, Check, Input as InputRecord, Key, Metric, Status};
use rtbench::{Error, Result};
use std::sync::Mutex;

/// Sums up the numbers below `n`, on two devices.
#[derive(Default)]
struct Sums {
    /// What was run, in this order: device, method, `warm` or `pass`.
    log: Mutex<Vec<String>>,
    /// Number of calls before one is interrupted, or loses its device.
    stop: Option<(usize, fn() -> Error)>,
}

const fn axis(name: &'static str) -> Axis {
    Axis { name, value_name: "N", help: "", is_flag: true, in_label: true }
}

static INFO: Info = Info {
    name: "sums",
    summary: "Sum up",
    description: "",
    examples: "",
    work_unit: "sums",
    budget: None,
    has_library: false,
    axes: &[axis("n"), axis("method")],
    columns: &["sum", "double", "bytes", "sum_hash"],
    table: &[("method", "method"), ("frame_ms_mean", "mean ms"), ("sum", "sum"), ("result", "result")],
    table_groups: &[],
    table_note: "sums of whole numbers",
    presets: &[(
        "tiny",
        "n = [10, 20]\nmethod = [\"loop\", \"wrong\", \"huge\", \"formula\"]\npasses = 2\nwarmup = 3\n",
    )],
};

impl Workload for Sums {
    fn info(&self) -> &'static Info {
        &INFO
    }

    fn plan(&self, part: &Part, _library: &Library) -> Result<Vec<Case>> {
        let mut cases = Vec::new();
        for n in part.of("n") {
            for method in part.of("method") {
                for device in 0..2 {
                    cases.push(Case {
                        axes: [("n", n), ("method", method)].map(|(axis, v)| (axis.to_owned(), v.clone())).into(),
                        input: n.clone(),
                        group: method.clone(),
                        turn: "all".into(),
                        device,
                        work: 1,
                    });
                }
            }
        }
        Ok(cases)
    }

    fn open<'a>(&'a self, cases: &[Case], _context: &'a Context<'a>) -> Result<Box<dyn Input + 'a>> {
        let n = cases[0].input.parse().map_err(|_| Error::argument("--n", "no number", "give one"))?;
        Ok(Box::new(Numbers { workload: self, n }))
    }

    fn derived(
        &self,
        row: &rtbench::record::row::Row,
        _: Option<&rtbench::record::statistics::FrameStatistics>,
    ) -> Vec<Metric> {
        let sum = row.metric(None, "sum").and_then(|sum| sum.integer());
        sum.map(|sum| Metric::new("double", 2 * sum)).into_iter().collect()
    }
}

struct Numbers<'a> {
    workload: &'a Sums,
    n: u64,
}

impl Input for Numbers<'_> {
    fn records(&self) -> Vec<InputRecord> {
        let metrics = vec![Metric::new("bytes", 8 * self.n)];
        vec![InputRecord { kind: "numbers".into(), name: self.n.to_string(), hash: format!("h{}", self.n), metrics }]
    }

    fn key(&self, case: &Case) -> Key {
        let inputs = [("numbers".to_owned(), format!("h{}", self.n))].into();
        Key { workload: INFO.name.into(), axes: case.axes.clone(), inputs }
    }

    fn build(&mut self, case: &Case, _: &Device) -> Result<u64> {
        match case.group.as_str() {
            "huge" => Err(Error::too_large("the table", "1 TiB is needed, 1 GiB is there", "use loop")),
            _ => Ok(8 * self.n),
        }
    }

    fn prepare<'a>(&'a self, device: &'a Device, _case: &Case) -> Result<Box<dyn Run + 'a>> {
        Ok(Box::new(Summed { input: self, device }))
    }

    fn artifact(&self, case: &Case) -> Option<Artifact> {
        let metrics = vec![Metric::new("build_ms", 1.5)];
        Some(Artifact { key: self.key(case), metrics, note: String::new() })
    }
}

struct Summed<'a> {
    input: &'a Numbers<'a>,
    device: &'a Device,
}

impl Run for Summed<'_> {
    fn stages(&self, _case: &Case) -> Vec<String> {
        vec!["fill".into(), "add-up".into()]
    }

    fn verify(&mut self, case: &Case) -> Result<Verdict> {
        let problem = (case.group == "wrong").then(|| "the sum is wrong".to_owned());
        let checks = vec![Check { ok: problem.is_none(), message: "compared".into(), metrics: vec![] }];
        let outputs = [("sum".to_owned(), "abc".to_owned())].into();
        Ok(Verdict { problem, checks, outputs, ..Verdict::default() })
    }

    fn count(&mut self, _case: &Case) -> Result<Verdict> {
        let metrics = vec![Metric::new("sum", (0..self.input.n).sum::<u64>())];
        Ok(Verdict { metrics, ..Verdict::default() })
    }

    fn pass(&mut self, case: &Case, warm_up: Option<usize>) -> Result<Vec<FrameTime>> {
        let what = if warm_up.is_some() { "warm" } else { "pass" };
        let line = format!("{} {} {what}", self.device.info().name, case.group);
        let mut log = self.input.workload.log.lock().unwrap();
        if let Some((_, error)) = self.input.workload.stop.filter(|(calls, _)| *calls == log.len()) {
            log.push("stop".into());
            return Err(error());
        }
        log.push(line);
        let frame = FrameTime { wall_ns: 50, device_ns: Some(40), stages: vec![10, 25] };
        Ok(vec![frame; warm_up.unwrap_or(4)])
    }
}

fn device(name: &str) -> Opened {
    Opened { device: Device::Cpu(CpuDevice::new(1).unwrap().named(name)), reason: "a test".into() }
}

/// Runs the plan into a folder, stopped after so many rows.
fn measured(workload: &Sums, folder: &std::path::Path, rows: usize) -> (Result<Outcome>, usize) {
    let plan = Plan::new(workload, &Request::default()).unwrap();
    let previous =
        if folder.join(FILE_NAME).exists() { PreviousRun::read(folder).unwrap() } else { PreviousRun::default() };
    let finished = std::cell::Cell::new(0);
    let outcome = run::run(Job {
        workload,
        plan: &plan,
        out: folder,
        previous,
        arguments: vec![],
        devices: vec![device("first"), device("second")],
        open: &|index| Ok(device(["first", "second"][index])),
        interrupted: &|| finished.get() >= rows,
        watch: &mut |event| {
            if let Event::Finished(_) = event {
                finished.set(finished.get() + 1);
            }
        },
    });
    (outcome, finished.get())
}

/// A whole run of it in a folder.
pub fn small_run(folder: &std::path::Path) {
    measured(&Sums::default(), folder, usize::MAX).0.unwrap();
}

#[test]
fn a_workload_is_a_few_functions() {
    let (workload, folder) = (Sums::default(), tempfile::tempdir().unwrap());
    let (outcome, finished) = measured(&workload, folder.path(), usize::MAX);
    let outcome = outcome.unwrap();
    assert_eq!(finished, 2 * 4 * 2);
    let [ok, skipped, wrong] = [Status::Ok, Status::Skipped, Status::Wrong].map(|status| outcome.count(status));
    assert_eq!((ok, skipped, wrong), (8, 4, 4));
    // Both devices take turns, and warm-up goes before each pass
    let log = workload.log.lock().unwrap();
    let first: Vec<&str> = log.iter().take(16).map(String::as_str).collect();
    let pass = ["first loop", "second loop", "first formula", "second formula"];
    let order = pass.iter().chain(pass.iter().rev());
    let expected: Vec<String> = order.flat_map(|who| [format!("{who} warm"), format!("{who} pass")]).collect();
    assert_eq!(first, expected);

    let journal = outcome.journal;
    assert_eq!(
        journal.provenance.devices.iter().map(|d| d.info.name.as_str()).collect::<Vec<_>>(),
        ["first", "second"]
    );
    assert_eq!((journal.inputs.len(), journal.artifacts.len()), (2, 6));
    let row = journal.rows.iter().find(|row| row.status == Status::Ok && row.device == 1).unwrap();
    let samples = row.samples.as_ref().unwrap();
    assert_eq!(samples.stages, ["fill", "add-up"]);
    assert_eq!(samples.stage_ns.as_ref().unwrap()[1], vec![vec![10, 25]; 4]);
    assert_eq!((row.interleaved_with, row.settings.warmup_frames), (4, 3));

    // One column per axis, metric, fact and stage
    let wide = Wide::new(&workload, &journal);
    let index = wide.rows.iter().position(|r| r[wide.column("status").unwrap()] == Some("ok".into())).unwrap();
    let value = |column: &str| wide.rows[index][wide.column(column).unwrap()].clone().map(|value| value.write());
    assert_eq!(value("method").as_deref(), Some("loop"));
    assert_eq!((value("sum").as_deref(), value("double").as_deref()), (Some("45"), Some("90")));
    assert_eq!((value("bytes").as_deref(), value("sum_hash").as_deref()), (Some("80"), Some("abc")));
    assert_eq!(
        (value("frame_ms_mean").as_deref(), value("fill_ms_mean").as_deref()),
        (Some("0.00004"), Some("0.00001"))
    );
    let text = summary::terminal(&workload, &journal);
    for words in ["\n10\n", "WRONG", "skipped: 10 huge and 3 more: too large: the table", "sums of whole numbers"] {
        assert!(text.contains(words), "{words}: {text}");
    }
}

#[test]
fn it_is_resumed_like_any_other() {
    let folder = tempfile::tempdir().unwrap();
    let (stopped, finished) = measured(&Sums::default(), folder.path(), 6);
    assert!(matches!(stopped, Err(Error::Interrupted)), "{stopped:?}");
    let (outcome, again) = measured(&Sums::default(), folder.path(), usize::MAX);
    assert_eq!((outcome.unwrap().journal.rows.len(), finished + again), (16, 16));
    let journal = Journal::read(&folder.path().join(FILE_NAME)).unwrap();
    assert_eq!((journal.resumed.len(), journal.inputs.len(), journal.artifacts.len()), (1, 2, 6));
}

/// Whatever stops the timing of a turn, what has all of its passes by then is a row.
#[test]
fn cases_with_all_passes_are_kept() {
    // Passes run forwards, then backwards, each after a call to warm up: two of four cases are complete after 12 calls
    for (error, rows) in [(Error::Interrupted, 2 + 4), (Error::DeviceLost("the driver reset".into()), 2 + 4)] {
        let stop: fn() -> Error = match error {
            Error::Interrupted => || Error::Interrupted,
            _ => || Error::DeviceLost("the driver reset".into()),
        };
        let folder = tempfile::tempdir().unwrap();
        let workload = Sums { stop: Some((12, stop)), ..Sums::default() };
        let (outcome, _) = measured(&workload, folder.path(), usize::MAX);
        let journal = Journal::read(&folder.path().join(FILE_NAME)).unwrap();
        let ok = journal.rows.iter().filter(|row| row.status == Status::Ok).count();
        match error {
            Error::Interrupted => {
                assert!(matches!(outcome, Err(Error::Interrupted)), "{outcome:?}");
                // Huge and wrong ones have their rows as well
                assert_eq!((ok, journal.rows.len()), (2, rows));
            }
            // The second device is opened again; its other case is measured there, the first device's are kept
            _ => {
                let outcome = outcome.unwrap();
                assert_eq!((outcome.count(Status::Failed), outcome.count(Status::Ok)), (1, 7));
            }
        }
        let (outcome, _) = measured(&Sums::default(), folder.path(), usize::MAX);
        let journal = outcome.unwrap().journal;
        assert_eq!((journal.rows.len(), journal.rows.iter().filter(|r| r.status == Status::Ok).count()), (16, 8));
    }
}
