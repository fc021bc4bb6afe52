//! Photon splatting as a workload: its axes, and its plan.

use super::case::SplatCase;
use super::input::SplatInput;
use super::photons::PHOTON_BYTES;
use super::{Fault, gpu, memory};
use crate::camera::CameraPath;
use crate::device::Source;
use crate::error::{Error, Result};
use crate::harness::workload::{Axis, Case, Context, Info, Input, Library, Part, Workload};
use crate::record::row::{Metric, Row, Value};
use crate::record::statistics::{FrameStatistics, round};
use crate::scene;
use crate::workloads::{scan, size};
use std::path::PathBuf;

/// Name of the workload in keys.
pub const WORKLOAD: &str = "splat";

/// Most distances between samples and photons of a case in one pass.
const BUDGET: u64 = 2_000_000_000_000;

/// The workload.
#[derive(Default)]
pub struct Splat {
    /// Planted into what a device made; absent outside of tests.
    pub fault: Option<Fault>,
    /// The folder of path-traced references, instead of the user's.
    pub cache: Option<PathBuf>,
}

/// The one that the command line offers.
pub static SPLAT: Splat = Splat { fault: None, cache: None };

const fn axis(name: &'static str, value_name: &'static str, help: &'static str) -> Axis {
    Axis { name, value_name, help, is_flag: true, in_label: true }
}

/// An axis whose values follow from another one's.
const fn option(name: &'static str, help: &'static str) -> Axis {
    Axis { name, value_name: "", help, is_flag: false, in_label: false }
}

/// A flag that is not a part of a row's name.
const fn quiet(name: &'static str, value_name: &'static str, help: &'static str) -> Axis {
    Axis { name, value_name, help, is_flag: true, in_label: false }
}

static INFO: Info = Info {
    name: WORKLOAD,
    summary: "Measure global illumination by photons: tracing, clusters of view samples, splatting, density estimates",
    description: "Paths of light are traced through a structure, every hit but the first is stored as a photon. View \
        samples are put into clusters, photons are splatted onto those that they touch, and the indirect light of each \
        sample is estimated from the photons of its cluster. Each stage has its own time. Every array of a small frame \
        is compared with its twin on the CPU, estimates with sums in double precision, and their mean with a \
        path-traced reference, which is kept in RTBENCH_CACHE or the user's folder for caches.",
    examples: "\
Examples:
  rtbench splat
      the preset quick: built-in scenes, less than three minutes
  rtbench splat --scene sponza --resolution 480x270 --radius 0.03,0.1 --frames 2
      a scene of the catalogue, two radii
  rtbench splat --scene sibenik --technique per-sample,buckets --resolution 480x270 --tile 8 --radius 0.1
      the source's two techniques, at a load near that of its charts
  rtbench splat --scene box --technique reference:kernel=epanechnikov,reference:kernel=constant --paths 20000
      two kernels of an estimate over all photons
  rtbench splat --scene hall --light point:x=0,y=3,z=0,flux=100 --hits 6
      a light of your own, paths of six hits

The folder of results holds journal.jsonl (everything, one record per line), summary.csv, run.json and pictures of the
scenes: all light, direct light, indirect light, and the photons.",
    work_unit: "distance tests",
    budget: Some(BUDGET),
    has_library: true,
    axes: &[
        axis("scene", "FILE|NAME[:KEY=VALUE,..]", "Scene file, or name of a scene with options; may be repeated"),
        axis(
            "technique",
            "NAME[:KEY=VALUE,..]",
            "per-sample[:kernel=epanechnikov|constant,weight=side|cosine,form=normalised|source,order=any|sorted,\
             tasks=sample|queue], buckets[:form=,atomics=fixed|exchange|float,share=all|centre (with a kernel=),\
             blur=0..16 pixels,level=1..5], tiled and reference (each sample over all photons) with kernel=, weight= and \
             form= as per-sample; all is all but reference; comma list [default: per-sample]",
        ),
        option("kernel", "Weight of a photon by its distance"),
        option("weight", "Weight of a photon by its direction"),
        option("form", "Normalised, or as the source prints it"),
        option("order", "Order of photons in a list"),
        option("tasks", "What an invocation of the estimate works on"),
        option("atomics", "How flux is added to a bucket"),
        option("share", "How much of a photon's flux a cluster gets"),
        option("blur", "Blur after the estimate, in pixels"),
        option("level", "The level that has the buckets"),
        axis("light", "point:x=,y=,z=[,flux=N|R/G/B]", "Light, or several joined by +, instead of the scene's"),
        quiet("camera_path", "FILE|NAME", "Camera path for every scene, instead of each one's own"),
        axis(
            "structure",
            "NAME[:KEY=VALUE,..]",
            "What rays are traced through, as in `rtbench structures`; comma list [default: bvh-stack]",
        ),
        option("build", "Options of the builder"),
        option("traversal", "Options of the traversal"),
        option("ray_options", "Which rays there are, and the test against a triangle"),
        option("device_options", "How the device works"),
        axis("paths", "N", "Paths of light; comma list [default: 5667]"),
        axis("hits", "N", "Most hits along a path, 2 to 16: all but the first are photons [default: 4]"),
        axis("seed", "N", "Of the generator of random numbers [default: 1]"),
        axis(
            "radius",
            "SHARE|Nu",
            "Radius of photons: share of the extent's diagonal, or N units of the file [default: 0.03]",
        ),
        axis("falloff", "LIST", "square, source: how direct light falls off [default: square]"),
        axis("energy", "LIST", "flux, shared: what a photon carries of its ray [default: flux]"),
        axis("tile", "N", "Side of a tile in pixels, 4 to 64; comma list [default: 32]"),
        axis("key", "LIST", "morton, concat: order of a key's bits [default: morton]"),
        axis("normals", "LIST", "off, faces, cells: bits of a key for normals [default: off]"),
        axis("unique", "LIST", "flags, sort, bits: how the set of keys is found [default: flags]"),
        axis("bounds", "LIST", "direct, two-step: how boxes of clusters are found [default: direct]"),
        axis("hierarchy", "LIST", "masks, none: what photons find clusters by [default: masks]"),
        axis("space", "LIST", "view, world: the axes of boxes [default: view]"),
        axis("capacity", "N", "Entries of all lists at most, up to 33554432 [default: 33554432]"),
        axis("sync", "LIST", "device, readback: who knows how many clusters there are [default: device]"),
        axis("resolution", "N|WxH", "Image sizes in pixels; comma list"),
        Axis { name: "frames", value_name: "N", help: "Frames of the camera path", is_flag: false, in_label: false },
    ],
    columns: &[
        "width",
        "height",
        "triangles",
        "photons",
        "samples",
        "distance_tests",
        "mtests_per_s",
        "stored_flux_share",
        "irradiance_mean",
        "direct_mean",
        "path_traced_mean",
        "path_traced_error",
        "path_traced_error_pct",
        "path_traced_paths",
        "ratio_to_path_traced",
        "rmse",
        "best_scale",
        "rmse_scaled",
        "clusters_mean",
        "clusters_max",
        "assignments_mean",
        "assignments_max",
        "fullest_cluster",
        "fullest_cluster_mean",
        "box_tests_mean",
        "inner_nodes_mean",
        "photon_evaluations_mean",
        "bucket_directions_mean",
        "atomics_bounds_mean",
        "empty_cluster_pct",
        "key_bits",
        "buffer_bytes",
        "source_bytes",
        "hit-1_arrived",
        "hit-2_arrived",
        "hit-3_arrived",
        "hit-4_arrived",
        "hit-1_lost_pct",
        "hit-2_lost_pct",
        "hit-3_lost_pct",
        "hit-4_lost_pct",
        "photons_hash",
        "image_hash",
    ],
    table: &[
        ("resolution", "size"),
        ("technique_label", "technique"),
        ("structure_label", "structure"),
        ("settings", "settings"),
        ("photons", "photons"),
        ("radius", "radius"),
        ("tile", "tile"),
        ("clusters_mean", "clusters"),
        ("assignments_mean", "assignments"),
        ("frame_ms_mean", "mean ms"),
        ("noise_pct", "noise %"),
        ("mtests_per_s", "Mtests/s"),
        ("ratio_to_path_traced", "ratio"),
        ("path_traced_error_pct", "± %"),
        ("rmse", "RMSE"),
        ("result", "result"),
    ],
    table_groups: &["resolution"],
    table_note: "Mtests/s: distances between samples and photons, of all or of those in the samples' clusters; ratio: \
        mean irradiance / path-traced mean, which has \
        the standard error ±; RMSE: root of the mean squared difference from it, in irradiance",
    presets: &[
        ("quick", include_str!("../../../presets/splat/quick.toml")),
        ("splat", include_str!("../../../presets/splat/splat.toml")),
        ("splat-lite", include_str!("../../../presets/splat/splat-lite.toml")),
        ("splat-reference", include_str!("../../../presets/splat/splat-reference.toml")),
    ],
};

impl Workload for Splat {
    fn info(&self) -> &'static Info {
        &INFO
    }

    fn absent(&self, scene: &str, library: &Library) -> Option<String> {
        crate::workloads::trace::TRACE.absent(scene, library)
    }

    fn plan(&self, part: &Part, library: &Library) -> Result<Vec<Case>> {
        if part.of("scene").is_empty() {
            return Err(Error::argument("--scene", "no scene is given", "give --scene, or scene in the preset"));
        }
        let of_part = SplatCase::all(part)?;
        for name in part.of("camera_path") {
            CameraPath::load(name)?;
        }
        let mut cases = Vec::new();
        for scene in part.of("scene") {
            let scene = library.scene_time.map_or_else(|| scene.clone(), |time| scene::at_time(scene, time));
            scene::probe(&scene, library.scenes_folder.as_deref())?;
            cases.extend(of_part.iter().map(|case| case.to_case(&scene)));
        }
        Ok(cases)
    }

    fn needs(&self, cases: &[Case], _: &Library) -> Vec<String> {
        let parsed: Vec<SplatCase> = cases.iter().filter_map(|case| SplatCase::parse(case).ok()).collect();
        let mib = |bytes: u64| bytes.div_ceil(1 << 20);
        let memory = parsed.iter().map(|case| memory::bytes(case.setting, case.size, case.clustering.as_ref())).max();
        let photons = parsed.iter().map(|case| case.setting.slots() * PHOTON_BYTES).max();
        let mut needs = Vec::new();
        needs.extend(memory.map(|bytes| format!("{} MiB of main memory for photons, images and clusters", mib(bytes))));
        needs.extend(
            photons.map(|bytes| format!("{} MiB of device memory for each of two sets of photons", mib(bytes))),
        );
        needs
    }

    fn open<'a>(&'a self, cases: &[Case], context: &'a Context<'a>) -> Result<Box<dyn Input + 'a>> {
        Ok(Box::new(SplatInput::open(cases, context, self)?))
    }

    fn kernels(&self) -> Result<Vec<(String, Source)>> {
        let mut kernels = gpu::kernels()?;
        kernels.extend(scan::kernels()?);
        Ok(kernels)
    }

    fn machine_metrics(&self) -> &'static [&'static str] {
        &["build_threads", "path_traced_paths", "bytes", "buffer_bytes"]
    }

    fn derived(&self, row: &Row, frames: Option<&FrameStatistics>) -> Vec<Metric> {
        let axis = |name: &str| row.key.axis(name);
        let label = |name: &str, options: &[&str]| {
            let options: Vec<&str> = options.iter().map(|name| axis(name)).filter(|value| !value.is_empty()).collect();
            let colon = if options.is_empty() { "" } else { ":" };
            format!("{}{colon}{}", axis(name), options.join(","))
        };
        let technique = super::technique::Technique::of_axes(|name| row.key.axis(name));
        let technique = technique.map_or_else(|_| axis("technique").to_owned(), |technique| technique.to_string());
        let structure = label("structure", &["build", "traversal", "ray_options", "device_options"]);
        // What differs from the defaults and has no column of its own in the table
        let usual = [
            ("hits", "4"),
            ("seed", "1"),
            ("falloff", "square"),
            ("energy", "flux"),
            ("light", ""),
            ("key", "morton"),
            ("normals", "off"),
            ("unique", "flags"),
            ("bounds", "direct"),
            ("hierarchy", "masks"),
            ("space", "view"),
            ("capacity", "33554432"),
            ("sync", "device"),
        ];
        // What a technique does not have is no setting of it
        let is_unusual = |name: &str, usual: &str| axis(name) != usual && !(axis(name).is_empty() && name != "light");
        let unusual = usual.into_iter().filter(|(name, usual)| is_unusual(name, usual));
        let settings: Vec<String> = unusual.map(|(name, _)| format!("{name} {}", axis(name))).collect();
        let mut derived = vec![
            Metric::new("technique_label", technique),
            Metric::new("structure_label", structure),
            Metric::new("settings", settings.join(", ")),
        ];
        // In messages numbers have a name, and defaults are left out
        for (name, usual) in usual.into_iter().chain([("paths", ""), ("radius", ""), ("tile", "")]) {
            let value = axis(name);
            let label = if value == usual || value.is_empty() { String::new() } else { format!("{name} {value}") };
            derived.push(Metric::new(&format!("{name}_label"), label));
        }
        derived.extend(size::metrics(axis("resolution")));
        let of_row = |name: &str| row.metric(None, name).and_then(Value::number);
        let tests = of_row("distance_tests").or_else(|| of_row("photon_evaluations_mean"));
        let frames = frames.filter(|frames| frames.mean_ms > 0.0);
        if let Some((tests, frames)) = tests.zip(frames) {
            derived.push(Metric::new("mtests_per_s", round(tests / frames.mean_ms / 1e3, 2)));
        }
        derived
    }
}
