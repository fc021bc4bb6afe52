//! Reads recorded runs into [`Data`].

use super::axes;
use super::data::{Data, Failure, Measurement};
use super::scenes::SceneKey;
use crate::record::row::{Row, Samples, Status, TimingSource};
use crate::record::statistics::{self, round};
use crate::sources::rows::Devices;
use crate::sources::runs::RecordedRun;

/// Name of the workload in keys.
pub const WORKLOAD: &str = "splat";

/// True if a run has rows of this workload.
pub fn has_rows(run: &RecordedRun) -> bool {
    run.general.rows.iter().any(|row| row.key.workload == WORKLOAD)
}

/// Those runs with rows of this workload; all of them where none has any.
pub fn with_rows(runs: &[RecordedRun]) -> Vec<&RecordedRun> {
    let found: Vec<&RecordedRun> = runs.iter().filter(|run| has_rows(run)).collect();
    if found.is_empty() { runs.iter().collect() } else { found }
}

/// Everything that runs have measured. Of several measurements of the same, the last one with a result counts.
pub fn data(runs: &[RecordedRun]) -> Data {
    let mut data = Data::default();
    let mut devices = Devices::default();
    let mut repeated = 0;
    for run in with_rows(runs) {
        let added = devices.add(&run.general.provenance);
        for row in run.general.rows.iter().filter(|row| row.key.workload == WORKLOAD) {
            let Some(&(device, _)) = added.get(row.device) else { continue };
            repeated += usize::from(read(&mut data, row, device));
        }
        data.notes.extend(run.notes());
    }
    data.devices = devices.named();
    let is_measured = |f: &Failure| {
        let same =
            |m: &Measurement| (m.device, &m.scene, m.settings, &m.axes) == (f.device, &f.scene, f.settings, &f.axes);
        data.measurements.iter().any(same)
    };
    let failures = std::mem::take(&mut data.failures);
    data.failures = failures.into_iter().filter(|f| !is_measured(f)).collect();
    if repeated > 0 {
        let number = if repeated == 1 { "1 row was".into() } else { format!("{repeated} rows were") };
        data.notes.push(format!("{number} measured more than once; the last one is shown"));
    }
    data
}

/// Adds a row; true if it replaced an earlier one of the same.
fn read(data: &mut Data, row: &Row, device: usize) -> bool {
    let scene = SceneKey::of(row.key.axis("scene"), row.key.input("scene"));
    let (axes, settings) = (axes::of(&row.key), row.settings);
    let times = row.timed().and_then(statistics::frames).filter(|times| times.mean_ms > 0.0);
    let Some(times) = times.filter(|_| row.status == Status::Ok) else {
        let message = if row.message.is_empty() { "no times".to_owned() } else { row.message.clone() };
        data.failures.push(Failure { device, scene, axes, settings, message });
        return false;
    };
    let samples = row.samples.as_ref();
    let (stages, stage_ms) = samples.and_then(stages).unwrap_or_default();
    let timed = samples.map_or(&[][..], |samples| match (row.timing_source, &samples.device_ns) {
        (Some(TimingSource::Device), Some(device_ns)) => device_ns,
        _ => &samples.wall_ns,
    });
    let new = Measurement {
        device,
        scene,
        axes,
        settings,
        mean_ms: round(times.mean_ms, 6),
        noise_pct: times.noise_pct.map(|noise| round(noise, 3)),
        frames_ms: (0..timed.first().map_or(0, Vec::len)).map(|frame| mean_ms(timed, |pass| pass.get(frame))).collect(),
        stages,
        stage_ms,
        metrics: row.metrics.clone(),
    };
    match data.measurements.iter_mut().find(|old| old.is_like(&new, &[])) {
        Some(old) => {
            *old = new;
            true
        }
        None => {
            data.measurements.push(new);
            false
        }
    }
}

/// Milliseconds of one frame or stage, mean over the passes that have it.
fn mean_ms<T>(passes: &[T], of: impl Fn(&T) -> Option<&u64>) -> f64 {
    let found: Vec<u64> = passes.iter().filter_map(|pass| of(pass).copied()).collect();
    round(found.iter().sum::<u64>() as f64 / found.len().max(1) as f64 / 1e6, 6)
}

/// Labels, and milliseconds by frame and stage; `None` where stages have no times.
fn stages(samples: &Samples) -> Option<(Vec<String>, Vec<Vec<f64>>)> {
    let passes = samples.stage_ns.as_ref()?;
    let frames = passes.first()?.len();
    let of_frame = |frame: usize| {
        let of_stage = |stage: usize| mean_ms(passes, |pass| pass.get(frame)?.get(stage));
        (0..samples.stages.len()).map(of_stage).collect()
    };
    Some((samples.stages.clone(), (0..frames).map(of_frame).collect()))
}
