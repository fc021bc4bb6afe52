//! The committed run of the preset simt against the times that the thesis of 2009 printed.

use super::study::by_eye;
use rtbench::sources::runs::RecordedRun;
use rtbench::workloads::trace::simt::Sums;
use rtbench::workloads::trace::simt::model::{Gpu, Modelled, Weights};
use std::collections::BTreeMap;
use std::path::Path;

const RUN: &str = "results/simt-2026-11-30";

/// Published mean frame times: device, configuration, scene, side, structure.
pub fn published() -> BTreeMap<(String, String, String, u32, String), f64> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("results/thesis-2009/frame_times_ms.csv");
    let rows = crate::support::csv_rows(&path);
    let of = |row: &BTreeMap<String, String>| {
        let key = ["device", "config", "scene"].map(|column| row[column].clone());
        let [device, config, scene] = key;
        let side = row["resolution"].parse().unwrap();
        ((device, config, scene, side, row["structure"].clone()), row["mean_ms"].parse().unwrap())
    };
    rows.iter().map(of).collect()
}

/// What is compared: a group of structures, and of each its work per resident warp, its bound and its published time.
pub type Groups = BTreeMap<(String, String, u32), BTreeMap<String, [f64; 3]>>;

/// The default structures of the committed run, each by these weights.
fn groups(gpu: &Gpu, device: &str, weights: impl Fn(&Modelled) -> (Vec<Sums>, Weights)) -> Groups {
    let run = RecordedRun::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join(RUN)).unwrap();
    let published = published();
    let mut groups = Groups::new();
    for record in &run.journal.configurations {
        // The thesis set the robots' grid by hand
        if !["default", "x=128"].contains(&record.variant.as_str()) {
            continue;
        }
        let key = (
            device.to_owned(),
            format!("{:?}", record.config),
            record.scene.name.clone(),
            record.width,
            record.structure.clone(),
        );
        let (Some(&time), Some(modelled)) = (published.get(&key), Modelled::of(record, gpu).unwrap()) else { continue };
        let (_, config, scene, side, structure) = key;
        let (sums, weights) = weights(&modelled);
        let modelled = Modelled { sums, weights, ..modelled };
        let values = [modelled.work(), gpu.issue_ms(modelled.instructions()), time];
        groups.entry((scene, config, side)).or_default().insert(structure, values);
    }
    groups
}

/// As the kernels of today are.
fn compiled(gpu: &Gpu, device: &str) -> Groups {
    groups(gpu, device, |modelled| (modelled.sums.clone(), modelled.weights))
}

/// The same without lockstep: as if all lanes were always busy.
fn without_lockstep(modelled: &Modelled) -> Vec<Sums> {
    let busy = |sums: &Sums| Sums { issued: sums.lanes.map(|lanes| lanes.div_ceil(32)), ..*sums };
    modelled.sums.iter().map(busy).collect()
}

/// Pairs of structures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pairs {
    /// All.
    pub all: usize,
    /// Those in the published order.
    pub right: usize,
    /// Those whose published times differ by more than 10 %.
    pub far: usize,
    /// Of these, those in the published order.
    pub far_right: usize,
    /// Those within 15 % in the model.
    pub close: usize,
}

/// The pairs of structures at these sides.
pub fn pairs(groups: &Groups, sides: &[u32]) -> Pairs {
    let mut pairs = Pairs::default();
    for (_, structures) in groups.iter().filter(|((_, _, side), _)| sides.contains(side)) {
        let values: Vec<&[f64; 3]> = structures.values().collect();
        for (i, a) in values.iter().enumerate() {
            for b in &values[..i] {
                let (modelled, printed) = (a[0] / b[0], a[2] / b[2]);
                let is_right = usize::from((modelled > 1.0) == (printed > 1.0));
                pairs.all += 1;
                pairs.right += is_right;
                pairs.close += usize::from(modelled.max(1.0 / modelled) < 1.15);
                if printed.max(1.0 / printed) > 1.1 {
                    pairs.far += 1;
                    pairs.far_right += is_right;
                }
            }
        }
    }
    pairs
}

#[test]
fn orders_are_those_of_the_thesis() {
    for (name, device, least) in [("8600gt", "8600GT", LEAST[0]), ("gtx280", "GTX280", LEAST[1])] {
        let gpu = Gpu::load(name).unwrap();
        let groups = compiled(&gpu, device);
        let (small, large) = (pairs(&groups, &[256, 512]), pairs(&groups, &[1024]));
        println!("{device}: {small:?} at 256 and 512, {large:?} at 1024");
        let is_as_good = small.far_right >= least[0] && large.far_right >= least[1] && small.close <= least[2];
        assert!(is_as_good, "{device}: {small:?} {large:?}");
        assert!(small.far >= 48 && groups.len() >= 20, "{device}: {small:?}");
    }
}

/// Pairs at 256 and 512, pairs at 1024, pairs that are too close at 256 and 512: the first honest figures, less one
/// pair.
const LEAST: [[usize; 3]; 2] = [[47, 8, 10], [41, 18, 9]];

#[test]
fn bounds_are_below_the_published_times() {
    for (name, device) in [("8600gt", "8600GT"), ("gtx280", "GTX280")] {
        let gpu = Gpu::load(name).unwrap();
        for ((scene, config, side), structures) in compiled(&gpu, device) {
            // Lamp and mirrors of the robots are not the thesis's; our grid computes borders where that adds distances
            for (structure, [_, bound, time]) in structures {
                if scene != "robots" {
                    assert!(bound <= time, "{device} {scene} {config} {side} {structure}: {bound} {time}");
                }
            }
        }
    }
}

/// What docs/simt-model.md says of other weights, and of lanes that do not wait for each other.
#[test]
fn lockstep_is_what_matters() {
    for (name, device) in [("8600gt", "8600GT"), ("gtx280", "GTX280")] {
        let gpu = Gpu::load(name).unwrap();
        let eye = |modelled: &Modelled| by_eye(modelled.name.split(':').next().unwrap());
        let all = [
            ("kernels", compiled(&gpu, device)),
            ("eye", groups(&gpu, device, |modelled| (modelled.sums.clone(), eye(modelled)))),
            ("kernels, no lockstep", groups(&gpu, device, |modelled| (without_lockstep(modelled), modelled.weights))),
            ("eye, no lockstep", groups(&gpu, device, |modelled| (without_lockstep(modelled), eye(modelled)))),
        ];
        for (words, groups) in &all {
            for sides in [&[256, 512][..], &[768], &[1024], &[256, 512, 768, 1024]] {
                println!("{device} {words} {sides:?} {:?}", pairs(groups, sides));
            }
        }
        let right = all.map(|(_, groups)| pairs(&groups, &[256, 512, 768, 1024]).right);
        assert!(right[0] > right[2] && right[1] > right[3], "{device}: {right:?}");
    }
}

/// From 256 to 512 the published times grow by 1.6 to 3.5, counts of rays by 4.
#[test]
fn bounds_grow_with_the_image_as_times_do() {
    for (name, device) in [("8600gt", "8600GT"), ("gtx280", "GTX280")] {
        let groups = compiled(&Gpu::load(name).unwrap(), device);
        let (mut squares, mut count) = (0.0, 0);
        for ((scene, config, _), small) in groups.iter().filter(|((_, _, side), _)| *side == 256) {
            let Some(large) = groups.get(&(scene.clone(), config.clone(), 512)) else { continue };
            for (structure, [_, bound, time]) in small {
                let Some([_, larger, longer]) = large.get(structure) else { continue };
                squares += ((larger / bound) / (longer / time)).ln().powi(2);
                count += 1;
            }
        }
        let rms = (squares / f64::from(count)).sqrt();
        println!("{device}: growth within {:.1} % rms over {count} rows", 100.0 * rms);
        assert!(count >= 25 && rms <= 0.25, "{device}: {rms} over {count}");
    }
}

/// The weights of the kernels as a GPU runs them without options, with the kernels' hashes.
#[test]
fn the_committed_weights_are_those_of_the_kernels() {
    let found = std::process::Command::new(env!("CARGO_BIN_EXE_rtbench"))
        .args(["kernels", "--events", "--format", "csv", "sweep"])
        .output()
        .unwrap();
    let text = String::from_utf8(found.stdout).unwrap();
    let timed = text.lines().filter(|line| !line.contains(" counting") && !line.contains("build "));
    let expected: String = timed.map(|line| format!("{line}\n")).collect();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("gpus/weights.csv");
    let committed = std::fs::read_to_string(&path).unwrap();
    let how = "rtbench kernels --events --format csv sweep | grep -v ' counting\\|build ' > gpus/weights.csv";
    assert!(committed == expected, "a kernel has changed: judge the orders again, and renew the file: {how}");
    assert!(expected.lines().count() > 60, "{expected}");
}
