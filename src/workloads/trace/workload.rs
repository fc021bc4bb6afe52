//! Ray tracing as a workload: its axes, and its plan.

use super::case::{TraceCase, parse_warp_width};
use super::gpu::kernels;
use super::input::TraceInput;
use super::rays::{self, Config};
use super::record::{RAY_TYPES, WORKLOAD, issued_of, variant_of};
use super::simt::Sums;
use super::tracer::Decorate;
use super::{Selection, artifacts, build};
use crate::camera::CameraPath;
use crate::device::Source;
use crate::error::{Error, Result};
use crate::harness::parse_list;
use crate::harness::workload::{Axis, Case, Context, Info, Input, Library, Part, Workload};
use crate::record::journal::Journal;
use crate::record::row::{Metric, Row, Value};
use crate::record::statistics::{FrameStatistics, round};
use crate::scene;
use crate::workloads::size::{self, parse_size};

/// The workload. Tests decorate its tracers with faults.
#[derive(Default)]
pub struct Trace {
    /// Wraps every tracer that is prepared; absent outside of tests.
    pub decorate: Option<Box<Decorate>>,
}

/// The one that the command line offers.
pub static TRACE: Trace = Trace { decorate: None };

const fn axis(name: &'static str, value_name: &'static str, help: &'static str) -> Axis {
    Axis { name, value_name, help, is_flag: true, in_label: true }
}

/// An axis whose values are options of a structure.
const fn options(name: &'static str, help: &'static str) -> Axis {
    Axis { name, value_name: "", help, is_flag: false, in_label: false }
}

static INFO: Info = Info {
    name: WORKLOAD,
    summary: "Measure every structure x ray configuration x resolution on scenes",
    description: "Each case is verified against a reference, then counted, then timed; its row is on the disk before the \
        next turn begins. A wrong answer becomes a row with a picture of the difference and is not timed; what a structure or \
        a device cannot do becomes a row with the reason, and all other rows are measured. Without further flags it runs the \
        preset quick; every flag overrides what the preset says.",
    examples: "\
Examples:
  rtbench sweep
      the preset quick: built-in scenes, all structures, a few minutes
  rtbench sweep --scene bunny.ply --structure grid,kdtree,bvh --config P,PS --resolution 512,1024
      a scene of your own
  rtbench sweep --scene hall --structure grid:x=64,grid:x=128 --config PSR --frames 20
      the same structure with different options
  rtbench sweep --preset thesis --scenes-dir ~/scenes --adapter nvidia
      the method of the thesis of 2009, on a chosen GPU
  rtbench sweep --backend cpu --out results/twins
      without any GPU or driver

The folder of results holds journal.jsonl (everything, one record per line), summary.csv, structures.csv and run.json.
Ctrl-C ends a sweep in order, also while a structure is built: what was measured is kept, and `rtbench sweep --resume
FOLDER` measures the rest. It goes on only with the same build of the program on the same device, with scenes and camera
paths that have not changed.",
    work_unit: "rays",
    budget: None,
    has_library: true,
    axes: &[
        axis("scene", "FILE|NAME[:KEY=VALUE,..]", "Scene file, or name of a scene with options; may be repeated"),
        axis(
            "structure",
            "NAME[:KEY=VALUE,..]",
            "Structures with options, as in `rtbench structures`, or all; comma list",
        ),
        options("build", "Options of the builder"),
        options("traversal", "Options of the traversal"),
        options("ray_options", "Which rays there are, and the test against a triangle"),
        options("device_options", "How the device works"),
        axis(
            "config",
            "P|PS|PSR|AO|DIFFUSE",
            "Ray configurations: P primary rays, PS with shadow rays, PSR with reflected rays; AO with 4 short any-hit \
             rays a pixel, DIFFUSE with one nearest-hit ray; comma list",
        ),
        axis("resolution", "N|WxH", "Image sizes in pixels; comma list"),
        Axis {
            name: "camera_path",
            value_name: "FILE|NAME",
            help: "Camera path for every scene and configuration, instead of each one's own",
            is_flag: true,
            in_label: false,
        },
        Axis {
            name: "warp_width",
            value_name: "N",
            help: "Also count what warps of N lanes (8, 16, 32, 64) would issue in lockstep, by the twins; comma list",
            is_flag: true,
            in_label: false,
        },
        Axis { name: "frames", value_name: "N", help: "Frames of the camera path", is_flag: false, in_label: false },
    ],
    columns: &[
        "variant",
        "width",
        "height",
        "triangles",
        "mrays_per_s",
        "primary_rays",
        "shadow_rays",
        "reflected_rays",
        "ambient_rays",
        "diffuse_rays",
        "primary_steps_per_ray",
        "primary_tests_per_ray",
        "primary_restarts_per_ray",
        "primary_inner_per_ray",
        "primary_leaves_per_ray",
        "primary_pops_per_ray",
        "primary_ropes_per_ray",
        "primary_fallbacks_per_ray",
        "primary_skips_per_ray",
        "primary_boxes_per_ray",
        "shadow_steps_per_ray",
        "shadow_tests_per_ray",
        "shadow_restarts_per_ray",
        "shadow_inner_per_ray",
        "shadow_leaves_per_ray",
        "shadow_pops_per_ray",
        "shadow_ropes_per_ray",
        "shadow_fallbacks_per_ray",
        "shadow_skips_per_ray",
        "shadow_boxes_per_ray",
        "reflected_steps_per_ray",
        "reflected_tests_per_ray",
        "reflected_restarts_per_ray",
        "reflected_inner_per_ray",
        "reflected_leaves_per_ray",
        "reflected_pops_per_ray",
        "reflected_ropes_per_ray",
        "reflected_fallbacks_per_ray",
        "reflected_skips_per_ray",
        "reflected_boxes_per_ray",
        "ambient_steps_per_ray",
        "ambient_tests_per_ray",
        "ambient_restarts_per_ray",
        "ambient_inner_per_ray",
        "ambient_leaves_per_ray",
        "ambient_pops_per_ray",
        "ambient_ropes_per_ray",
        "ambient_fallbacks_per_ray",
        "ambient_skips_per_ray",
        "ambient_boxes_per_ray",
        "diffuse_steps_per_ray",
        "diffuse_tests_per_ray",
        "diffuse_restarts_per_ray",
        "diffuse_inner_per_ray",
        "diffuse_leaves_per_ray",
        "diffuse_pops_per_ray",
        "diffuse_ropes_per_ray",
        "diffuse_fallbacks_per_ray",
        "diffuse_skips_per_ray",
        "diffuse_boxes_per_ray",
        "primary_utilisation",
        "shadow_utilisation",
        "reflected_utilisation",
        "ambient_utilisation",
        "diffuse_utilisation",
        "build_ms",
        "build_threads",
        "structure_bytes",
        "geometry_bytes",
        "thesis_bytes",
        "rt2_bytes",
        "dispatches",
        "image_hash",
    ],
    table: &[
        ("config", "config"),
        ("resolution", "size"),
        ("structure_label", "structure"),
        ("frame_ms_mean", "mean ms"),
        ("frame_ms_min", "min ms"),
        ("frame_ms_max", "max ms"),
        ("noise_pct", "noise %"),
        ("mrays_per_s", "Mrays/s"),
        ("steps_per_ray", "steps/ray"),
        ("tests_per_ray", "tests/ray"),
        ("restarts_per_ray", "restarts/ray"),
        ("result", "result"),
    ],
    table_groups: &["config", "resolution"],
    table_note: "steps, tests and restarts: of primary rays under P, of shadow rays under PS, of reflected rays under PSR, of \
        ambient rays under AO, of diffuse rays under DIFFUSE",
    presets: &[
        ("quick", include_str!("../../../presets/sweep/quick.toml")),
        ("thesis", include_str!("../../../presets/sweep/thesis.toml")),
        ("thesis-lite", include_str!("../../../presets/sweep/thesis-lite.toml")),
        ("rt2", include_str!("../../../presets/sweep/rt2.toml")),
        ("rt2-lite", include_str!("../../../presets/sweep/rt2-lite.toml")),
        ("structures", include_str!("../../../presets/sweep/structures.toml")),
        ("simt", include_str!("../../../presets/sweep/simt.toml")),
    ],
};

impl Workload for Trace {
    fn info(&self) -> &'static Info {
        &INFO
    }

    fn absent(&self, scene: &str, library: &Library) -> Option<String> {
        let entry = scene::catalogue::find(scene.split(':').next().unwrap_or(scene))?;
        Some(entry.path_in(library.scenes_folder.as_deref()).err()?.to_string())
    }

    fn plan(&self, part: &Part, library: &Library) -> Result<Vec<Case>> {
        let mut selections: Vec<Selection> = Vec::new();
        for selection in parse_list(part.of("structure"), Selection::parse_all)?.concat() {
            if !selections.contains(&selection) {
                selections.push(selection);
            }
        }
        let configs = parse_list(part.of("config"), rays::parse_config)?;
        let sizes = parse_list(part.of("resolution"), parse_size)?;
        for axis in ["scene", "structure", "config", "resolution"] {
            if part.of(axis).is_empty() {
                let hint = format!("give --{axis}, or {axis} in the preset");
                return Err(Error::argument(format!("--{axis}"), format!("no {axis} is given"), hint));
            }
        }
        let camera_paths = match part.of("camera_path") {
            [] => vec![String::new()],
            names => names.to_vec(),
        };
        for name in camera_paths.iter().filter(|name| !name.is_empty()) {
            CameraPath::load(name)?;
        }
        let warp_widths = match part.of("warp_width") {
            [] => vec![None],
            widths => parse_list(widths, parse_warp_width)?.into_iter().map(Some).collect(),
        };
        let mut cases = Vec::new();
        for scene in part.of("scene") {
            let scene = library.scene_time.map_or_else(|| scene.clone(), |time| scene::at_time(scene, time));
            scene::probe(&scene, library.scenes_folder.as_deref())?;
            for selection in &selections {
                for &config in &configs {
                    for &size in &sizes {
                        for camera_path in &camera_paths {
                            cases.extend(warp_widths.iter().map(|&warp_width| {
                                let (selection, camera_path) = (selection.clone(), camera_path.clone());
                                let frames = part.frames;
                                TraceCase { selection, config, size, frames, camera_path, warp_width }.to_case(&scene)
                            }));
                        }
                    }
                }
            }
        }
        Ok(cases)
    }

    fn needs(&self, cases: &[Case], library: &Library) -> Vec<String> {
        super::needs::of(cases, library)
    }

    fn open<'a>(&'a self, cases: &[Case], context: &'a Context<'a>) -> Result<Box<dyn Input + 'a>> {
        Ok(Box::new(TraceInput::open(cases, context, self.decorate.as_deref())?))
    }

    fn kernels(&self) -> Result<Vec<(String, Source)>> {
        let mut all = kernels::defaults()?;
        all.extend(build::gpu::kernels()?);
        Ok(all)
    }

    fn machine_metrics(&self) -> &'static [&'static str] {
        &["build_threads", "dispatches", "leaf_order_bytes"]
    }

    fn derived(&self, row: &Row, frames: Option<&FrameStatistics>) -> Vec<Metric> {
        let variant = variant_of(&row.key);
        let structure = row.key.axis("structure");
        let label = if variant == "default" { structure.to_owned() } else { format!("{structure}:{variant}") };
        let mut derived = vec![Metric::new("structure_label", label), Metric::new("variant", variant)];
        derived.extend(size::metrics(row.key.axis("resolution")));
        let sum = |ray: &str, counter: &str| row.metric(Some(ray), counter).and_then(Value::integer);
        let rays: u64 = RAY_TYPES.iter().filter_map(|ray| sum(ray, "rays")).sum();
        if let Some(frames) = frames.filter(|frames| rays > 0 && frames.total_ms > 0.0) {
            derived.push(Metric::new("mrays_per_s", round(rays as f64 / frames.total_ms / 1e3, 4)));
        }
        let config = Config::named(row.key.axis("config"));
        let width = row.key.axis("warp_width").parse().ok();
        let issued = width.and_then(|width| Some((width, issued_of(row, width)?)));
        for (index, ray) in RAY_TYPES.into_iter().enumerate() {
            let Some(rays) = sum(ray, "rays").filter(|&rays| rays > 0) else { continue };
            let per_ray = |sum: u64| round(sum as f64 / rays as f64, 4);
            // None where nothing but rays is counted
            let visits = [sum(ray, "inner"), sum(ray, "leaves")];
            let steps = visits.iter().any(Option::is_some).then(|| visits.into_iter().flatten().sum());
            let is_per_ray = |m: &&Metric| m.of.as_deref() == Some(ray) && m.name != "rays" && !Sums::has(&m.name);
            let counters = row.metrics.iter().filter(is_per_ray);
            let sums = counters.filter_map(|m| Some((m.name.as_str(), m.value.integer()?)));
            for (name, sum) in steps.map(|steps| ("steps", steps)).into_iter().chain(sums) {
                let name = format!("{name}_per_ray");
                derived.push(Metric::of(ray, &name, per_ray(sum)));
                // Each configuration shows its own ray type
                if config.is_some_and(|config| config.added_ray_type() == index) {
                    derived.push(Metric::new(&name, per_ray(sum)));
                }
            }
            if let Some(share) = issued.and_then(|(width, sums)| sums[index].utilisation(width)) {
                derived.push(Metric::of(ray, "utilisation", round(share, 4)));
            }
        }
        derived
    }

    fn files(&self, journal: &Journal) -> Result<Vec<(String, Vec<u8>)>> {
        Ok(vec![("structures.csv".to_owned(), artifacts::csv(&artifacts::rows(journal))?)])
    }

    fn artifacts_table(&self, journal: &Journal) -> String {
        let rows = artifacts::rows(journal);
        if rows.is_empty() {
            return String::new();
        }
        format!("Structures (sizes with geometry)\n{}\n", artifacts::table(&rows))
    }
}
