//! Memory that frames with clusters take, in a process of its own.
#![cfg(target_os = "linux")]

use super::frames::*;
use crate::support::gpu;
use glam::Vec3;
use rtbench::scene;
use rtbench::workloads::size::Size;
use rtbench::workloads::splat::clusters::KeyLayout;
use rtbench::workloads::splat::clusters::setting::ClusterSetting;
use rtbench::workloads::splat::gathering::Gathering;
use rtbench::workloads::splat::gpu::GpuFrame;
use rtbench::workloads::splat::setting::Setting;
use rtbench::workloads::splat::technique::Technique;
use rtbench::workloads::trace::Selection;
use std::process::Command;

/// Set where the process measures itself.
const CHILD: &str = "RTBENCH_TEST_MEMORY_OF";

/// Kibibytes of a line of the process's status.
fn kib(line: &str) -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let found = status.lines().find_map(|l| l.strip_prefix(line)).unwrap();
    found.trim_start_matches(':').trim().trim_end_matches(" kB").parse().unwrap()
}

/// Run by the test below, in a process of its own: prints what there was before the first buffer, the peak, and the
/// buffers, in KiB.
#[test]
#[ignore = "is run by peak_memory_is_that_of_the_buffers"]
fn frames_of_a_technique() {
    let (Ok(technique), Some(gpu)) = (std::env::var(CHILD), gpu()) else { return };
    let scene = scene::load("room:triangles=20000").unwrap();
    let camera = camera_of(&scene);
    let light = light_at(&scene, [0.45, 0.6, 0.55], Vec3::ONE);
    let lit = lit(scene, &[light]);
    let (size, setting) = (Size { width: 960, height: 540 }, ClusterSetting { tile: 16, ..Default::default() });
    let technique = Technique::parse(&technique).unwrap();
    let layout = KeyLayout::new(&setting, size, camera.field_of_view, (lit.near(), lit.far())).unwrap();
    let estimate = technique.estimate(lit.diagonal() * 0.05);
    let gathering =
        Gathering { gather: technique.gather, clusters: setting, layout: Some(layout), ..Gathering::from(estimate) };
    let selection = Selection::parse("bvh-stack").unwrap();
    let built = selection.build(&lit.scene, 1).unwrap();
    let photons = Setting { paths: 5667, ..SETTING };
    let before = kib("VmRSS");
    let mut frame = GpuFrame::new(gpu, &lit, &*built.structure, selection.method(), photons, gathering, size).unwrap();
    frame.time(&[camera; 3], &|| false).unwrap();
    let buffers: u64 = frame.buffers().iter().map(|(_, bytes)| bytes).sum();
    println!("memory {before} {} {}", kib("VmHWM"), buffers / 1024);
}

#[test]
fn peak_memory_is_that_of_the_buffers() {
    let Some(gpu) = gpu() else { return };
    if !gpu.info().device_type.computes_on_cpu() {
        // The memory of other devices is not the process's
        return;
    }
    for technique in ["per-sample", "buckets"] {
        let child = Command::new(std::env::current_exe().unwrap())
            .args(["splat::memory::frames_of_a_technique", "--exact", "--ignored", "--nocapture"])
            .env(CHILD, technique)
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&child.stdout);
        let line = text.lines().find_map(|line| line.split_once("memory ")).map(|(_, numbers)| numbers);
        let line = line.unwrap_or_else(|| panic!("{technique}: {text} {}", String::from_utf8_lossy(&child.stderr)));
        let numbers: Vec<u64> = line.split_whitespace().map(|number| number.parse().unwrap()).collect();
        let [before, peak, buffers] = numbers[..] else { panic!("{line}") };
        println!("{technique}: {before} KiB before, peak {peak}, buffers {buffers}");
        assert!(buffers > 60 << 10, "{technique}: {line}");
        assert!(peak <= before + buffers * 12 / 10, "{technique}: {line}");
    }
}
