//! Reads recorded runs into [`Data`].

use super::data::{Data, Failure, HalfPicture, Measurement, Place, Terms, Work};
use super::scenes::SceneKey;
use super::setting::Setting;
use crate::device::DeviceType;
use crate::record::journal::Journal;
use crate::record::row::{Row, Status, Value};
use crate::record::run::Provenance;
use crate::record::statistics::{self, round};
use crate::sources::rows::Devices;
use crate::sources::runs::RecordedRun;

/// Name of the workload in keys.
pub const WORKLOAD: &str = "spheres";

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
    for run in with_rows(runs) {
        let journal = &run.general;
        let added = devices.add(&journal.provenance);
        for (device, info) in &added {
            data.threads.resize(data.threads.len().max(device + 1), None);
            data.threads[*device] = info.threads;
        }
        for row in journal.rows.iter().filter(|row| row.key.workload == WORKLOAD) {
            let Some(&(device, info)) = added.get(row.device) else { continue };
            let machine = match info.device_type {
                DeviceType::CpuTwin => device,
                _ => machine_of(&journal.provenance, row.device).map_or(device, |index| added[index].0),
            };
            read(&mut data, journal, row, (machine, device));
        }
        data.notes.extend(run.notes());
    }
    data.devices = devices.named();
    data.places = places(&data);
    let repeated = data.measurements.iter().filter(|m| m.repeated).count();
    if repeated > 0 {
        let number = if repeated == 1 { "1 row was".into() } else { format!("{repeated} rows were") };
        data.notes.push(format!("{number} measured more than once; the last one is shown"));
    }
    data
}

/// The processor of the machine that a device belongs to, as an index of the run's devices. A merged run has several
/// machines.
fn machine_of(provenance: &Provenance, device: usize) -> Option<usize> {
    let is_cpu =
        |index: &usize| provenance.devices.get(*index).is_some_and(|d| d.info.device_type == DeviceType::CpuTwin);
    let part = provenance.merged.iter().find(|run| run.devices.contains(&device));
    match part {
        Some(part) => part.devices.iter().copied().find(is_cpu),
        None => (0..provenance.devices.len()).find(|index| is_cpu(index)),
    }
}

/// Each machine with each of its GPUs that has rows.
fn places(data: &Data) -> Vec<Place> {
    let failed = data.failures.iter().map(|f| (f.machine, f.device));
    let halves = data.halves.iter().map(|h| (h.machine, h.device));
    let measured = data.measurements.iter().map(|m| (m.machine, m.device));
    let mut all: Vec<(usize, usize)> = measured.chain(halves).chain(failed).collect();
    all.sort_unstable();
    all.dedup();
    let mut places = Vec::new();
    for machine in 0..data.devices.len() {
        let gpus: Vec<usize> = all.iter().filter(|(m, d)| *m == machine && d != m).map(|(_, d)| *d).collect();
        let has_rows = all.iter().any(|(m, _)| *m == machine);
        if gpus.is_empty() && has_rows {
            places.push(Place { machine, gpu: None });
        }
        places.extend(gpus.into_iter().map(|gpu| Place { machine, gpu: Some(gpu) }));
    }
    places
}

/// Reads a row: times, a picture of half precision, or the reason why there is neither.
fn read(data: &mut Data, journal: &Journal, row: &Row, (machine, device): (usize, usize)) {
    let key = &row.key;
    let Some((setting, terms)) = Setting::of(key).zip(terms_of(row)) else { return };
    let input = journal.input(key, "scene");
    let spheres = input.and_then(|i| crate::record::row::metric(&i.metrics, None, "spheres")).and_then(Value::integer);
    let scene = SceneKey::of(key.axis("scene"), spheres.unwrap_or(0), key.input("scene"));
    let number = |name: &str| row.metric(None, name).and_then(Value::number);
    let rmse = number("rmse").filter(|_| setting.half);
    if let Some(rmse) = rmse.filter(|_| matches!(row.status, Status::Ok | Status::Skipped)) {
        let largest = number("largest_difference");
        let half =
            HalfPicture { machine, device, scene: scene.clone(), setting: setting.clone(), terms, rmse, largest };
        let place = |h: &HalfPicture| (h.machine, h.device, h.terms, h.scene.clone(), h.setting.clone());
        data.halves.retain(|old| place(old) != place(&half));
        data.halves.push(half);
    }
    let times = row.timed().and_then(statistics::frames).filter(|times| times.mean_ms > 0.0);
    let Some(times) = times.filter(|_| row.status == Status::Ok) else {
        if rmse.is_none() || row.status != Status::Skipped {
            let message = if row.message.is_empty() { "no times".to_owned() } else { row.message.clone() };
            data.failures.push(Failure { machine, device, scene, setting, terms, message });
        }
        return;
    };
    let threads = row.metric(None, "processor_threads").and_then(Value::integer).map(|n| n as usize);
    let threads = threads.or(setting.threads).or(data.threads[device]).filter(|_| setting.renderer.has_threads());
    data.put(Measurement {
        machine,
        device,
        scene,
        setting,
        threads,
        terms,
        mean_ms: round(times.mean_ms, 6),
        min_ms: round(times.min_ms, 6),
        max_ms: round(times.max_ms, 6),
        places: None,
        noise_pct: times.noise_pct.map(|noise| round(noise, 3)),
        work: work_of(row, terms.trips),
        repeated: false,
    });
}

fn terms_of(row: &Row) -> Option<Terms> {
    let (width, height) = row.key.axis("resolution").split_once('x')?;
    Some(Terms {
        width: width.parse().ok()?,
        height: height.parse().ok()?,
        trips: row.key.axis("trips").parse().ok()?,
        frames: row.key.axis("frames").parse().ok()?,
        passes: row.settings.passes,
        warmup_frames: row.settings.warmup_frames,
    })
}

/// What was counted; `None` for a row without counts.
fn work_of(row: &Row, trips: u32) -> Option<Work> {
    let whole = |name: &str| row.metric(None, name).and_then(Value::integer);
    let of_bounce = |trip: u32| {
        let part = format!("bounce-{trip}");
        let of = |name: &str| row.metric(Some(&part), name).and_then(Value::integer);
        of("rays").zip(of("hits"))
    };
    Some(Work {
        bounces: (1..=trips).map_while(of_bounce).collect(),
        tests: whole("tests")?,
        wasted_tests: whole("wasted_tests").unwrap_or_default(),
        vectors: whole("vectors").unwrap_or_default(),
        occupancy: row.metric(None, "occupancy").and_then(Value::number),
        exits_on_miss: whole("exits_on_miss").unwrap_or_default(),
        skips_no_hit: whole("skips_no_hit").unwrap_or_default(),
        skips_no_discriminant: whole("skips_no_discriminant").unwrap_or_default(),
        instructions: row.metric(None, "instructions").map(Value::write).unwrap_or_default(),
    })
}
