//! Photon splatting on the harness, as tests run it: requests, devices, rows.

use crate::support::own_gpu;
use rtbench::device::{CpuDevice, Device};
use rtbench::harness::previous::PreviousRun;
use rtbench::harness::run::{self, Job, Opened};
use rtbench::harness::{Plan, Request};
use rtbench::record::journal::Journal;
use rtbench::record::row::Row;
use rtbench::workloads::splat::{Fault, Splat};
use std::path::Path;

/// A small run of the box with these values of axes.
pub fn request(values: &[(&str, &str)]) -> Request {
    // A technique that is given is measured as the preset's first part says
    let mut all = vec![
        ("scene", "box"),
        ("technique", "reference"),
        ("resolution", "64x36"),
        ("paths", "300"),
        ("radius", "0.2"),
    ];
    all.retain(|(axis, _)| !values.iter().any(|(given, _)| given == axis));
    let values = all.iter().chain(values).map(|(axis, value)| (axis.to_string(), vec![value.to_string()]));
    Request { values: values.collect(), frames: Some(2), passes: Some(2), warmup: Some(0), ..Request::default() }
}

/// What is planted.
#[derive(Default)]
pub struct Faults(pub Option<Fault>);

/// Measures, and keeps references with the run, not where the user's are.
pub fn measured(device: Device, faults: Faults, request: &Request, out: &Path) -> Journal {
    let workload = &Splat { fault: faults.0, cache: Some(out.join("cache")) };
    let plan = Plan::new(workload, request).unwrap();
    let outcome = run::run(Job {
        workload,
        plan: &plan,
        out,
        previous: PreviousRun::default(),
        arguments: vec![],
        devices: vec![Opened { device, reason: "a test".into() }],
        open: &|_| panic!("no device is lost"),
        interrupted: &|| false,
        watch: &mut |_| (),
    });
    outcome.unwrap().journal
}

/// Two threads.
pub fn on_cpu() -> Device {
    Device::Cpu(CpuDevice::new(2).unwrap())
}

/// Devices of this machine.
pub fn devices() -> Vec<Device> {
    std::iter::once(on_cpu()).chain(own_gpu(false).map(Device::Vulkan)).collect()
}

/// The only row of a run.
pub fn the_row(journal: &Journal) -> &Row {
    assert_eq!(journal.rows.len(), 1, "{:?}", journal.rows);
    &journal.rows[0]
}
