//! Frames in passes: the same rays as in one pass, each counted once, timed stage by stage, split where a list is too
//! long for the device.

use crate::support::{gpu, soup};
use crate::traversal::{SIZE, counted, shiny, view};
use rtbench::Error;
use rtbench::workloads::trace::backend::{Backend, Config, Size};
use rtbench::workloads::trace::{CpuBackend, Selection};

#[test]
fn twins_count_the_same_in_one_pass_and_in_several() {
    let scene = shiny(soup(400, 11, false));
    let cpu = CpuBackend::new(2).unwrap();
    for name in ["bvh-stack", "kdtree", "grid", "brute"] {
        for config in Config::ALL {
            let fused = counted(&cpu, &scene, name, config, SIZE);
            assert_eq!(counted(&cpu, &scene, &format!("{name}:reflections=staged"), config, SIZE), fused, "{name}");
        }
    }
}

#[test]
fn the_device_counts_the_same_in_one_pass_and_in_several() {
    let Some(gpu) = gpu() else { return };
    if !gpu.info().agrees_with_twins() {
        eprintln!("not run: {} is not compared to the bit", gpu.info().name);
        return;
    }
    let scene = shiny(soup(400, 12, false));
    let (fused, timed) = counted(gpu, &scene, "bvh-stack", Config::PSR, SIZE);
    let (staged, timed_staged) = counted(gpu, &scene, "bvh-stack:reflections=staged", Config::PSR, SIZE);
    let reflected = |kind: usize| staged.iter().map(|p| p.counters[kind].rays).sum::<u32>();
    assert!(reflected(2) > 100, "{} reflected rays: the test would see nothing", reflected(2));
    assert_eq!(staged, fused);
    assert_eq!(timed_staged, timed);
}

#[test]
fn each_pass_is_a_stage_with_a_time() {
    let Some(gpu) = gpu() else { return };
    let scene = shiny(soup(400, 13, false));
    let stages = |name: &str, config: Config| {
        let selection = Selection::parse(name).unwrap();
        let built = selection.build(&scene, 1).unwrap();
        let mut prepared = gpu.prepare(&scene, &*built.structure, selection.method()).unwrap();
        let times = prepared.time_path(config, &[view(1), view(2)], SIZE, &|| false).unwrap();
        let stages = prepared.stages(config);
        let kernels = prepared.kernels(config).unwrap();
        assert_eq!(times.len(), 2);
        for time in times {
            assert_eq!(time.stages.len(), if time.device_ns.is_some() { stages.len() } else { 0 });
        }
        (stages, kernels.len(), prepared.timed().unwrap().dispatches)
    };
    let all = vec!["primary", "reflection-1", "reflection-2"];
    let without_timestamps = gpu.info().timestamp_period_ns.is_none();
    let expected = |stages: &[&'static str]| if without_timestamps { Vec::new() } else { stages.to_vec() };
    assert_eq!(stages("bvh-stack:reflections=staged", Config::PSR), (expected(&all), 3, 3));
    // Without reflections there is one pass, by the fused kernel
    assert_eq!(stages("bvh-stack:reflections=staged", Config::PS), (expected(&["render"]), 1, 1));
    assert_eq!(stages("bvh-stack", Config::PSR), (expected(&["render"]), 1, 1));
}

/// A path on the list takes 48 bytes: the list of an image that is larger than a binding is worked off in parts.
#[test]
fn an_image_whose_list_is_too_long_is_split() {
    let Some(gpu) = gpu() else { return };
    let paths = (gpu.max_binding() / 48).min(u64::from(gpu.max_groups()) * 64);
    let height = 1024;
    let width = u32::try_from(paths / u64::from(height)).unwrap_or(u32::MAX).next_multiple_of(8);
    if width > 4096 {
        eprintln!("not run: this device binds lists of {paths} paths");
        return;
    }
    let scene = shiny(soup(30, 14, false));
    let dispatches = |width: u32| {
        let selection = Selection::parse("bvh-stack:reflections=staged").unwrap();
        let built = selection.build(&scene, 1).unwrap();
        let mut prepared = gpu.prepare(&scene, &*built.structure, selection.method()).unwrap();
        let size = Size { width, height };
        prepared.time_path(Config::PSR, &[view(1)], size, &|| false).unwrap();
        let timed = prepared.timed().unwrap();
        assert_eq!(timed.pixels, prepared.image(Config::PSR, &view(1), size).unwrap());
        timed.dispatches
    };
    assert_eq!(dispatches(width - 8), 3);
    assert_eq!(dispatches(width + 8), 6);
}

#[test]
fn rays_that_go_together_are_not_parted() {
    let refused = |text: &str| match Selection::parse(text) {
        Err(Error::Input(input)) => input.problem,
        other => panic!("{text}: {other:?}"),
    };
    for name in ["bvh", "grid-coop", "grid-packet"] {
        let problem = refused(&format!("{name}:reflections=staged"));
        let expected = format!("reflections has no effect: the rays of a work-group of {name} go together");
        assert_eq!(problem, expected);
    }
}

/// Each part changes the stage three times, more often than a frame has timestamps: such a frame is timed as a whole.
#[test]
fn a_frame_of_very_many_parts_is_timed_as_a_whole() {
    let Some(gpu) = gpu() else { return };
    let scene = shiny(soup(30, 15, false));
    let selection = Selection::parse("bvh-stack:reflections=staged,tiles=28").unwrap();
    let built = selection.build(&scene, 1).unwrap();
    let mut prepared = gpu.prepare(&scene, &*built.structure, selection.method()).unwrap();
    let size = Size { width: 224, height: 224 };
    let times = prepared.time_path(Config::PSR, &[view(1)], size, &|| false).unwrap();
    assert_eq!(prepared.timed().unwrap().dispatches, 28 * 28 * 3);
    assert_eq!(times[0].stages.len(), usize::from(times[0].device_ns.is_some()));
}
