//! Prefix sums by length, sweeps and subgroups, the twin on all threads, and a copy of the same bytes on the device:
//! `cargo bench --bench scan`. Each scan reads the words twice and writes them once.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use rtbench::device::vulkan::{Selector, VulkanOptions, adapters, choose};
use rtbench::device::{Feature, Frame, Stage, Submissions, VulkanDevice};
use rtbench::workloads::scan::{self, Options, Scan};

const LENGTHS: [u32; 3] = [1 << 16, 1 << 20, 1 << 23];

fn scans(criterion: &mut Criterion) {
    let all = adapters();
    let best = choose(&all, &Selector::Best);
    let device = match best.and_then(|best| VulkanDevice::open(best, VulkanOptions::default())) {
        Ok(device) => Some(device),
        Err(error) => {
            eprintln!("on the CPU only: {error}");
            None
        }
    };
    let mut group = criterion.benchmark_group("scan");
    group.sample_size(20);
    for length in LENGTHS {
        group.throughput(Throughput::Bytes(u64::from(length) * 4));
        let values: Vec<u32> = (0..length).map(|i| i.wrapping_mul(747_796_405) >> 24).collect();
        group.bench_function(BenchmarkId::new("twin", length), |bencher| {
            bencher.iter(|| scan::exclusive(&values).expect("sums below 2^32"));
        });
        let Some(device) = &device else { continue };
        for (name, subgroups) in [("sweeps", false), ("subgroups", true)] {
            if subgroups && !device.features().has(Feature::Subgroups) {
                eprintln!("{} has no subgroups", device.info().name);
                continue;
            }
            let input = device.storage("the values", &values).expect("a buffer");
            let output = device.zeroed("the sums", u64::from(length) * 4).expect("a buffer");
            let scan = Scan::new(device, Options { subgroups }, &input, &output, length).expect("a scan");
            let frame = Frame { passes: scan.passes(Stage("scan")), submissions: Submissions::PerFrame };
            group.bench_function(BenchmarkId::new(name, length), |bencher| {
                bencher.iter(|| device.run_frames(std::slice::from_ref(&frame), &|| false).expect("a frame"));
            });
        }
        let [from, to] = ["a", "b"].map(|what| device.poisoned(what, u64::from(length) * 4).expect("a buffer"));
        // A frame without passes waits for what was submitted
        let nothing = Frame::new(Vec::new());
        group.bench_function(BenchmarkId::new("copy", length), |bencher| {
            bencher.iter(|| {
                device.copy(&from, &to);
                device.run(&nothing).expect("a frame")
            });
        });
    }
    group.finish();
}

criterion_group!(benches, scans);
criterion_main!(benches);
