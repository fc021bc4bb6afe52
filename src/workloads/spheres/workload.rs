//! The sphere tracer as a workload: its axes, and its plan.

use super::case::{self, SpheresCase};
use super::input::SpheresInput;
use super::render::Fault;
use super::renderer::{OPTIONS, typed};
use super::scene::Scene;
use super::{gpu, memory};
use crate::device::Source;
use crate::error::Result;
use crate::harness::workload::{Axis, Case, Context, Devices, Info, Input, Library, Part, Workload};
use crate::names;
use crate::record::row::{Metric, Row, Value};
use crate::record::statistics::{FrameStatistics, round};
use crate::workloads::size;

/// Name of the workload in keys.
pub const WORKLOAD: &str = "spheres";

/// Most ray/sphere tests of a case in one pass.
const BUDGET: u64 = 1_000_000_000_000;

/// The workload.
#[derive(Default)]
pub struct Spheres {
    /// Planted into every vector renderer; absent outside of tests.
    pub fault: Option<Fault>,
    /// The sphere whose radius the GPU gets too large; absent outside of tests.
    pub wrong_sphere: Option<usize>,
}

/// The one that the command line offers.
pub static SPHERES: Spheres = Spheres { fault: None, wrong_sphere: None };

const fn axis(name: &'static str, value_name: &'static str, help: &'static str) -> Axis {
    Axis { name, value_name, help, is_flag: true, in_label: true }
}

/// An axis whose values follow from another one's.
const fn option(name: &'static str, help: &'static str) -> Axis {
    Axis { name, value_name: "", help, is_flag: false, in_label: false }
}

static INFO: Info = Info {
    name: WORKLOAD,
    summary: "Measure a sphere tracer: sequential, vectors, threads, GPU",
    description: "Every ray is tested against every sphere. All renderers make the same picture, which is compared with a \
        reference to the bit (on a GPU: within a stated share of pixels) before anything is timed. Renderers: sequential; \
        threads[:threads=N]; simd[:lanes=4|8|16,level=sse2|avx2|avx512|neon], the best level of the processor where none \
        is given (neon is untested); simd-threads with the options of both; gpu. The first four run on the CPU whatever --backend is.",
    examples: "\
Examples:
  rtbench spheres
      the preset quick: three scenes, all renderers, less than a minute
  rtbench spheres --scene random:spheres=1000,seed=7 --renderer simd:lanes=4,simd:lanes=8,simd:lanes=16
      a generated scene, vectors of three sizes
  rtbench spheres --scene random100 --renderer sequential,simd --algorithm one-pass,two-pass --exit-on-miss on,off
      what the algorithm gains, and what ending a path at its first miss does
  rtbench spheres --scene mine.json --renderer threads:threads=1,threads:threads=2 --resolution 1920x1080
      a scene of your own, one thread and two

The folder of results holds journal.jsonl (everything, one record per line), summary.csv, run.json and pictures of the
scenes. `rtbench tables`, `claims`, `figures` and `report` show a run in the form of the source spheres.",
    work_unit: "ray/sphere tests",
    budget: Some(BUDGET),
    has_library: false,
    axes: &[
        axis(
            "scene",
            "FILE|NAME[:KEY=VALUE,..]",
            "default, random20, random100, random:spheres=N,seed=S, or a JSON file; may be repeated",
        ),
        axis("renderer", "NAME[:KEY=VALUE,..]", "Renderers with options, or all; comma list"),
        option("lanes", "Pixels at once"),
        option("level", "Instruction set"),
        option("threads", "Threads"),
        axis("algorithm", "LIST", "one-pass, two-pass: order of the work along a path [default: one-pass]"),
        axis("exit_on_miss", "LIST", "on, off: a path ends at its first miss [default: on]"),
        axis("skip_no_hit", "LIST", "on, off: SIMD stores nothing where no lane hits [default: on]"),
        axis(
            "skip_no_discriminant",
            "LIST",
            "on, off: SIMD computes no root and quotient where no lane needs it [default: on]",
        ),
        axis("hit", "LIST", "index, in-loop: what the loop over the spheres keeps of a hit [default: index]"),
        axis("precision", "LIST", "f32, f16: arithmetic [default: f32]"),
        axis("trips", "N", "Most rays along a path, 1 to 64; comma list [default: 5]"),
        axis("resolution", "N|WxH", "Image sizes in pixels; comma list"),
        Axis { name: "frames", value_name: "N", help: "Views of an orbit", is_flag: false, in_label: false },
    ],
    columns: &[
        "spheres",
        "width",
        "height",
        "instructions",
        "processor_threads",
        "mrays_per_s",
        "mtests_per_s",
        "rays",
        "hits",
        "tests",
        "wasted_tests",
        "vectors",
        "occupancy",
        "exits_on_miss",
        "skips_no_hit",
        "skips_no_discriminant",
        "bounce-1_rays",
        "bounce-1_hits",
        "bounce-2_rays",
        "bounce-2_hits",
        "bounce-3_rays",
        "bounce-3_hits",
        "bounce-4_rays",
        "bounce-4_hits",
        "bounce-5_rays",
        "bounce-5_hits",
        "rmse",
        "largest_difference",
        "image_hash",
    ],
    table: &[
        ("resolution", "size"),
        ("algorithm", "algorithm"),
        ("switches", "switches"),
        ("renderer_label", "renderer"),
        ("frame_ms_mean", "mean ms"),
        ("frame_ms_min", "min ms"),
        ("frame_ms_max", "max ms"),
        ("noise_pct", "noise %"),
        ("mtests_per_s", "Mtests/s"),
        ("occupancy", "occupancy"),
        ("result", "result"),
    ],
    table_groups: &["resolution", "algorithm"],
    table_note: "switches: m exit on miss, h skip without hit, d skip without discriminant, l hits stored in the loop; \
        Mtests/s: tests of rays that are live; occupancy: share of the lanes that are live",
    presets: &[
        ("quick", include_str!("../../../presets/spheres/quick.toml")),
        ("spheres", include_str!("../../../presets/spheres/spheres.toml")),
        ("spheres-lite", include_str!("../../../presets/spheres/spheres-lite.toml")),
    ],
};

impl Workload for Spheres {
    fn info(&self) -> &'static Info {
        &INFO
    }

    fn plan(&self, part: &Part, _: &Library) -> Result<Vec<Case>> {
        let of_part = SpheresCase::all(part)?;
        let mut cases = Vec::new();
        for scene in case::scenes(part)? {
            let spheres = match Scene::load(&scene) {
                Ok(loaded) => loaded.spheres.len(),
                // What is wrong inside a file shows when it is opened, so that other scenes are measured
                Err(_) if names::file(&scene).is_file() => 1,
                Err(error) => return Err(error),
            };
            cases.extend(of_part.iter().map(|case| case.to_case(&scene, spheres)));
        }
        Ok(cases)
    }

    fn needs(&self, cases: &[Case], _: &Library) -> Vec<String> {
        let sizes = cases.iter().filter_map(|case| Some(SpheresCase::parse(case).ok()?.size));
        let largest = sizes.max_by_key(|size| size.pixels());
        largest.map(|size| format!("{} MiB of main memory for images", memory::bytes(size) >> 20)).into_iter().collect()
    }

    fn devices(&self) -> Devices {
        Devices::CpuAndVulkan
    }

    fn open<'a>(&'a self, cases: &[Case], context: &'a Context<'a>) -> Result<Box<dyn Input + 'a>> {
        Ok(Box::new(SpheresInput::open(cases, context, self.fault, self.wrong_sphere)?))
    }

    fn kernels(&self) -> Result<Vec<(String, Source)>> {
        gpu::kernels()
    }

    fn machine_metrics(&self) -> &'static [&'static str] {
        &["processor_threads"]
    }

    fn derived(&self, row: &Row, frames: Option<&FrameStatistics>) -> Vec<Metric> {
        let axis = |name: &str| row.key.axis(name);
        let label = typed(axis("renderer"), &OPTIONS.map(|key| (key, axis(key))));
        // In messages the switches that are on have names, and defaults have none
        let word = |name: &str, value: &str, word: &'static str| if axis(name) == value { word } else { "" };
        let letters = [
            word("exit_on_miss", "on", "m"),
            word("skip_no_hit", "on", "h"),
            word("skip_no_discriminant", "on", "d"),
            word("hit", "in-loop", "l"),
        ];
        let precision = if axis("precision") == "f32" { "" } else { axis("precision") };
        let trips = if axis("trips") == "5" { String::new() } else { format!("{} trips", axis("trips")) };
        let switches = format!("{} {precision} {trips}", letters.concat());
        let mut derived = vec![
            Metric::new("renderer_label", label),
            Metric::new("switches", switches.split_whitespace().collect::<Vec<_>>().join(" ")),
            Metric::new("exit_on_miss_label", word("exit_on_miss", "on", "exit-on-miss")),
            Metric::new("skip_no_hit_label", word("skip_no_hit", "on", "skip-no-hit")),
            Metric::new("skip_no_discriminant_label", word("skip_no_discriminant", "on", "skip-no-discriminant")),
            Metric::new("hit_label", word("hit", "in-loop", "in-loop")),
            Metric::new("precision_label", precision),
            Metric::new("trips_label", trips),
        ];
        derived.extend(size::metrics(axis("resolution")));
        let millions_per_s = |name: &str| {
            let sum = row.metric(None, name).and_then(Value::integer)?;
            let frames = frames.filter(|frames| frames.total_ms > 0.0)?;
            Some(round(sum as f64 / frames.total_ms / 1e3, 4))
        };
        let rates = [("mrays_per_s", millions_per_s("rays")), ("mtests_per_s", millions_per_s("tests"))];
        derived.extend(rates.into_iter().filter_map(|(name, rate)| Some(Metric::new(name, rate?))));
        derived
    }
}
