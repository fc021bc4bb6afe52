//! Builders that work in passes on a Vulkan device next to those on the CPU, in interleaved rounds:
//! `cargo bench --bench device_build`. A device's time is that of all stages, from the triangles on the device to the
//! finished tree there; the CPU's goes from the scene to the finished tree in main memory, and what its upload takes is
//! stated next to it, as is that of the device's input.

mod common;

use common::{median, ratio};
use rtbench::device::VulkanDevice;
use rtbench::device::vulkan::{Selector, VulkanOptions, adapters, choose};
use rtbench::scene::Scene;
use rtbench::workloads::trace::build::gpu::BuildTimes;
use rtbench::workloads::trace::bvh::{Bvh, ploc};
use rtbench::workloads::trace::common::sah::CostModel;
use rtbench::workloads::trace::gpu::upload_ms;
use rtbench::workloads::trace::{Built, Selection};

fn main() {
    let best = choose(&adapters(), &Selector::Best).and_then(|best| VulkanDevice::open(best, VulkanOptions::default()));
    let device = match best {
        Ok(device) => device,
        Err(error) => {
            eprintln!("nothing is measured: {error}");
            return;
        }
    };
    if !common::measuring() {
        println!("only a test that this runs: use cargo bench --bench device_build");
        bars(&device, "scan", &common::scan(1000), 1);
        return;
    }
    let mut scenes = common::models();
    if scenes.is_empty() {
        scenes = vec![("scan", common::scan(200_000))];
    }
    for (name, scene) in &scenes {
        bars(&device, name, scene, 11);
    }
}

fn selection(text: &str) -> Selection {
    Selection::parse(text).expect("a name of the table")
}

fn on_device(device: &VulkanDevice, selection: &Selection, scene: &Scene) -> Built {
    let built = selection.build_on(scene, device, &|| false).expect("builds");
    built.expect("a builder for devices")
}

/// A builder's name, what it builds, and the times of its rounds.
struct Contestant {
    name: &'static str,
    selection: Selection,
    /// Of a builder on the CPU.
    threads: Option<usize>,
    stages: Vec<BuildTimes>,
}

fn bars(device: &VulkanDevice, name: &str, scene: &Scene, rounds: usize) {
    let cpu = |name, text, threads| Contestant {
        name,
        selection: selection(text),
        threads: Some(threads),
        stages: Vec::new(),
    };
    let gpu = |name, text| Contestant { name, selection: selection(text), threads: None, stages: Vec::new() };
    let mut contestants = [
        cpu("binned, 2 threads", "bvh", 2),
        gpu("lbvh, device", "bvh:build=lbvh"),
        cpu("lbvh, twin on 2 threads", "bvh:build=lbvh", 2),
        gpu("ploc-passes, device", "bvh:build=ploc-passes"),
        cpu("ploc-passes, twin on 2 threads", "bvh:build=ploc-passes", 2),
    ];
    for contestant in contestants.iter().filter(|contestant| contestant.threads.is_none()) {
        // The driver compiles kernels when they run for the first time
        on_device(device, &contestant.selection, scene);
    }
    let mut runs: Vec<Box<dyn FnMut() -> f64>> = Vec::new();
    for contestant in &mut contestants {
        let Contestant { selection, threads, stages, .. } = contestant;
        runs.push(Box::new(move || match threads {
            Some(threads) => selection.build(scene, *threads).expect("builds").build_ms,
            None => {
                let built = on_device(device, selection, scene);
                stages.extend(built.device_times);
                built.build_ms
            }
        }));
    }
    let mut borrowed: Vec<&mut dyn FnMut() -> f64> = runs.iter_mut().map(|run| &mut **run as _).collect();
    let times = common::interleaved(&mut borrowed, rounds);
    drop(borrowed);
    drop(runs);
    println!("{name}: {} triangles, {} interleaved rounds, {}", scene.triangles.len(), rounds, device.info().name);
    for (contestant, times) in contestants.iter().zip(&times) {
        let built = contestant.selection.build(scene, 0).expect("builds");
        let cost = built.structure.properties(scene).sah_cost.unwrap_or_default();
        let upload = upload_ms(device, scene, &*built.structure, contestant.selection.method()).expect("fits");
        println!(
            "  {:32} median {:8.2} ms, SAH cost {cost:7.2}, upload of the tree {upload:.2} ms",
            contestant.name,
            median(times)
        );
        let Some(first) = contestant.stages.first() else { continue };
        for (index, (stage, _)) in first.stages.iter().enumerate() {
            let of: Vec<f64> = contestant.stages.iter().map(|times| times.stages[index].1).collect();
            println!("    {stage:30} median {:8.2} ms", median(&of));
        }
        let uploads: Vec<f64> = contestant.stages.iter().map(|times| times.upload_ms).collect();
        println!("    {:30} median {:8.2} ms", "upload of the triangles", median(&uploads));
    }
    let bar = ratio(&times[1], &times[0]);
    println!(
        "  lbvh, device / binned, 2 threads: {:.3} ({:.3} to {:.3}), bar: at most 1",
        bar.value, bar.low, bar.high
    );
    clustering(scene);
}

/// PLOC with the search distance of an obvhs preset and without reinsertion, one triangle a leaf.
fn clustering(scene: &Scene) {
    let cost = |bvh: &Bvh| CostModel::default().bvh(bvh).unwrap_or_default();
    for (preset, radius) in [("fast", 6), ("medium", 14)] {
        let params = ploc::preset(preset).expect("a preset");
        let params = obvhs::BvhBuildParams { reinsertion_batch_ratio: 0.0, max_prims_per_leaf: 1, ..params };
        let Ok(Some(theirs)) = ploc::build(scene, params) else { continue };
        let own = selection(&format!("bvh:build=ploc-passes,max_leaf=1,radius={radius}"));
        let own = own.build(scene, 0).expect("builds").structure.properties(scene).sah_cost.unwrap_or_default();
        let theirs = cost(&theirs);
        println!(
            "  ploc-passes / obvhs {preset} without reinsertion, SAH cost: {own:.2} / {theirs:.2} = {:.3}",
            own / theirs
        );
    }
}
