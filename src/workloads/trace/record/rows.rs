//! Conversions between typed rows and the general schema.

use super::variant::{split_variant, variant_of};
use super::*;
use crate::record::row::{Artifact, Check, Input, Metric, Value, metric};
use crate::workloads::trace::simt::NotWhole;
use serde::Deserializer;

fn integer(metrics: &[Metric], name: &str) -> u64 {
    metric(metrics, None, name).and_then(Value::integer).unwrap_or_default()
}

fn number(metrics: &[Metric], name: &str) -> f64 {
    metric(metrics, None, name).and_then(Value::number).unwrap_or_default()
}

/// What warps of `width` lanes issue, by ray type; `None` where nothing is recorded, or the record is damaged.
pub fn issued_of(row: &Row, width: u32) -> Option<ByRayType<Sums>> {
    let mut issued = ByRayType::<Sums>::default();
    let counted = |ray: &&str| row.metric(Some(ray), "warps").is_some();
    let mut any = false;
    for (sums, ray) in issued.iter_mut().zip(RAY_TYPES).filter(|(_, ray)| counted(ray)) {
        let count = |name: &str| row.metric(Some(ray), name).map_or(Ok(0), |value| value.integer().ok_or(NotWhole));
        *sums = Sums::read(count).filter(|sums| sums.fits(width))?;
        any = true;
    }
    any.then_some(issued)
}

impl SceneRecord {
    /// For the journal.
    pub fn to_input(&self) -> Input {
        let mut metrics = vec![
            Metric::new("triangles", self.triangles),
            Metric::new("vertices", self.vertices),
            Metric::new("lights", self.lights),
            Metric::new("degenerate_triangles", self.degenerate_triangles),
            Metric::new("mirror_share", self.mirror_share),
        ];
        if let Some(PlacementRecord { offset: [x, y, z], exponent }) = self.placement {
            metrics.extend([("offset_x", x), ("offset_y", y), ("offset_z", z)].map(|(name, v)| Metric::new(name, v)));
            metrics.push(Metric::new("exponent", f64::from(exponent)));
        }
        Input { kind: "scene".into(), name: self.name.clone(), hash: self.hash.clone(), metrics }
    }

    fn from_input(input: &Input) -> SceneRecord {
        let facts = &input.metrics;
        let placement = metric(facts, None, "exponent").and_then(Value::number).map(|exponent| PlacementRecord {
            offset: ["offset_x", "offset_y", "offset_z"].map(|name| number(facts, name)),
            exponent: exponent as i32,
        });
        SceneRecord {
            name: input.name.clone(),
            hash: input.hash.clone(),
            triangles: integer(facts, "triangles"),
            vertices: integer(facts, "vertices"),
            lights: integer(facts, "lights"),
            degenerate_triangles: integer(facts, "degenerate_triangles"),
            mirror_share: number(facts, "mirror_share"),
            placement,
        }
    }
}

impl PathRecord {
    /// For the journal.
    pub fn to_input(&self) -> Input {
        Input { kind: "camera_path".into(), name: self.name.clone(), hash: self.hash.clone(), metrics: Vec::new() }
    }
}

/// The metrics of a structure: its properties, sizes and build time.
pub fn structure_metrics(properties: &Properties, memory: Memory, build_ms: f64, build_threads: usize) -> Vec<Metric> {
    let mut metrics = vec![
        Metric::new("build_ms", build_ms),
        Metric::new("build_threads", build_threads),
        Metric::new("structure_bytes", memory.structure_bytes),
        Metric::new("geometry_bytes", memory.geometry_bytes),
        Metric::new("thesis_bytes", memory.thesis_bytes),
        Metric::new("rt2_bytes", memory.rt2_bytes),
    ];
    // A property that has no meaning for the structure is null
    let properties = serde_json::to_value(properties).unwrap_or_default();
    for (name, value) in properties.as_object().into_iter().flatten() {
        if let Some(value) = value.as_u64() {
            metrics.push(Metric::new(name, value));
        } else if let Some(value) = value.as_f64() {
            metrics.push(Metric::new(name, value));
        }
    }
    metrics
}

fn properties_of(metrics: &[Metric]) -> Properties {
    let values = metrics.iter().filter(|metric| metric.of.is_none());
    let object = values.map(|metric| (metric.name.clone(), serde_json::json!(metric.value))).collect();
    serde_json::from_value(serde_json::Value::Object(object)).unwrap_or_default()
}

fn memory_of(metrics: &[Metric]) -> Memory {
    Memory {
        structure_bytes: integer(metrics, "structure_bytes"),
        geometry_bytes: integer(metrics, "geometry_bytes"),
        thesis_bytes: integer(metrics, "thesis_bytes"),
        rt2_bytes: integer(metrics, "rt2_bytes"),
    }
}

impl StructureRecord {
    pub(super) fn from_artifact(journal: &Journal, artifact: &Artifact) -> Option<StructureRecord> {
        if artifact.key.workload != WORKLOAD {
            return None;
        }
        Some(StructureRecord {
            scene: SceneRecord::from_input(journal.input(&artifact.key, "scene")?),
            structure: artifact.key.axis("structure").to_owned(),
            variant: variant_of(&artifact.key),
            properties: properties_of(&artifact.metrics),
            build_ms: number(&artifact.metrics, "build_ms"),
            build_threads: integer(&artifact.metrics, "build_threads") as usize,
            memory: memory_of(&artifact.metrics),
            upload_ms: metric(&artifact.metrics, None, "upload_ms").and_then(Value::number),
            driver_build_ms: metric(&artifact.metrics, None, "driver_build_ms").and_then(Value::number),
            leaf_order_bytes: metric(&artifact.metrics, None, "leaf_order_bytes").and_then(Value::integer),
            note: artifact.note.clone(),
        })
    }

    /// For the general schema.
    pub(crate) fn to_artifact(&self) -> Artifact {
        let StructureRecord { scene, structure, variant, note, .. } = self;
        let mut key = Key { workload: WORKLOAD.into(), ..Key::default() };
        key.axes.insert("scene".into(), scene.name.clone());
        key.axes.insert("structure".into(), structure.clone());
        key.axes.extend(split_variant(structure, variant));
        key.inputs.insert("scene".into(), scene.hash.clone());
        let mut metrics = structure_metrics(&self.properties, self.memory, self.build_ms, self.build_threads);
        metrics.extend(self.driver_build_ms.map(|ms| Metric::new("driver_build_ms", ms)));
        metrics.extend(self.leaf_order_bytes.map(|bytes| Metric::new("leaf_order_bytes", bytes)));
        metrics.extend(self.upload_ms.map(|ms| Metric::new("upload_ms", ms)));
        Artifact { key, metrics, note: note.clone() }
    }
}

impl ConfigurationRecord {
    /// Reads a row; `None` for a row of another workload, or of an input that could not be read.
    pub fn from_row(journal: &Journal, row: &Row) -> Option<ConfigurationRecord> {
        let key = &row.key;
        if key.workload != WORKLOAD {
            return None;
        }
        let path = journal.input(key, "camera_path")?;
        let (width, height) = key.axis("resolution").split_once('x')?;
        let sums = |ray: &str| CounterSums::read(|name| row.metric(Some(ray), name).and_then(Value::integer));
        let counters = RAY_TYPES.map(sums);
        let warp_width = key.axis("warp_width").parse().ok();
        let issued = warp_width.and_then(|width| issued_of(row, width));
        Some(ConfigurationRecord {
            scene: SceneRecord::from_input(journal.input(key, "scene")?),
            camera_path: PathRecord { name: path.name.clone(), hash: path.hash.clone() },
            structure: key.axis("structure").to_owned(),
            variant: variant_of(key),
            config: Config::named(key.axis("config"))?,
            width: width.parse().ok()?,
            height: height.parse().ok()?,
            frames: key.axis("frames").parse().ok()?,
            passes: row.settings.passes,
            status: row.status,
            message: row.message.clone(),
            warnings: row.warnings.clone(),
            verified: row.status == Status::Ok,
            verification: row.checks.iter().map(Verification::from_check).collect(),
            difference: row.difference.clone(),
            image_hash: row.outputs.get("image").cloned(),
            reference_image_hash: row.outputs.get("reference_image").cloned(),
            kernel: row.kernels.first().cloned(),
            dispatches: row.metric(None, "dispatches").and_then(Value::integer).map(|n| n as u32),
            counters: counters[0].map(|_| counters.map(Option::unwrap_or_default)),
            warp_width,
            issued,
            memory: memory_of(&row.metrics),
            build_ms: number(&row.metrics, "build_ms"),
            build_threads: integer(&row.metrics, "build_threads") as usize,
            timing_source: row.timing_source,
            samples: row.samples.clone(),
            interleaved_with: row.interleaved_with,
            verification_s: row.verification_s,
            counting_s: row.counting_s,
            device: row.device,
        })
    }

    /// For the general schema.
    pub(crate) fn to_row(&self, settings: Settings) -> Row {
        let mut key = Key { workload: WORKLOAD.into(), ..Key::default() };
        for (axis, value) in [
            ("scene", self.scene.name.clone()),
            ("camera_path", self.camera_path.name.clone()),
            ("structure", self.structure.clone()),
            ("config", format!("{:?}", self.config)),
            ("resolution", format!("{}x{}", self.width, self.height)),
            ("frames", self.frames.to_string()),
        ] {
            key.axes.insert(axis.to_owned(), value);
        }
        key.axes.extend(split_variant(&self.structure, &self.variant));
        key.inputs.insert("scene".into(), self.scene.hash.clone());
        key.inputs.insert("camera_path".into(), self.camera_path.hash.clone());
        let mut row = Row::new(key, Settings { passes: self.passes, ..settings }, self.device);
        row.status = if self.status == Status::Ok && !self.verified { Status::Wrong } else { self.status };
        row.message = self.message.clone();
        row.warnings = self.warnings.clone();
        row.checks = self.verification.iter().map(Verification::to_check).collect();
        row.difference = self.difference.clone();
        let outputs = [("image", &self.image_hash), ("reference_image", &self.reference_image_hash)];
        row.outputs = outputs.into_iter().filter_map(|(name, hash)| Some((name.into(), hash.clone()?))).collect();
        row.kernels = self.kernel.iter().cloned().collect();
        row.metrics = vec![
            Metric::new("build_ms", self.build_ms),
            Metric::new("build_threads", self.build_threads),
            Metric::new("structure_bytes", self.memory.structure_bytes),
            Metric::new("geometry_bytes", self.memory.geometry_bytes),
            Metric::new("thesis_bytes", self.memory.thesis_bytes),
            Metric::new("rt2_bytes", self.memory.rt2_bytes),
        ];
        row.metrics.extend(self.dispatches.map(|n| Metric::new("dispatches", n)));
        row.metrics.extend(self.counters.iter().flat_map(counter_metrics));
        row.timing_source = self.timing_source;
        row.samples = self.samples.clone();
        row.interleaved_with = self.interleaved_with;
        row.verification_s = self.verification_s;
        row.counting_s = self.counting_s;
        row
    }
}

/// Counters as metrics: those of primary, shadow and reflected rays always, those of other types where there are such
/// rays.
pub fn counter_metrics(counters: &ByRayType<CounterSums>) -> Vec<Metric> {
    let of_type = |(ray, sums): (&&str, &CounterSums)| {
        sums.values().into_iter().map(|(name, sum)| Metric::of(ray, name, sum)).collect::<Vec<_>>()
    };
    let is_shown = |(index, (_, sums)): &(usize, (&&str, &CounterSums))| *index < SCHEMA_1 || sums.rays > 0;
    RAY_TYPES.iter().zip(counters).enumerate().filter(is_shown).map(|(_, pair)| pair).flat_map(of_type).collect()
}

/// Ray types of schema 1: primary, shadow, reflected.
const SCHEMA_1: usize = 3;

/// Reads the counters of schema 1; those of other ray types are zero.
pub(super) fn first_ray_types<'d, D: Deserializer<'d>>(from: D) -> Result<Option<ByRayType<CounterSums>>, D::Error> {
    let read: Option<[CounterSums; SCHEMA_1]> = Option::deserialize(from)?;
    Ok(read.map(by_ray_type))
}

/// Counters of the first ray types; those of the others are zero.
pub fn by_ray_type(first: [CounterSums; SCHEMA_1]) -> ByRayType<CounterSums> {
    let mut all = ByRayType::default();
    all[..SCHEMA_1].copy_from_slice(&first);
    all
}

impl Verification {
    /// For the general schema.
    pub fn to_check(&self) -> Check {
        let integers = [
            ("frame", self.frame as u64),
            ("width", self.width.into()),
            ("height", self.height.into()),
            ("twin", self.twin.into()),
            ("rays", self.rays),
            ("brute_checked", self.brute_checked),
            ("hits_differing", self.hits_differing),
            ("hits_lost", self.hits_lost),
            ("counters_differing", self.counters_differing),
            ("colours_differing", self.colours_differing),
            ("max_colour_difference", self.max_colour_difference.into()),
        ];
        let mut metrics: Vec<Metric> = integers.map(|(name, value)| Metric::new(name, value)).into();
        metrics.push(Metric::new("image_hash", self.image_hash.as_str()));
        Check { ok: self.ok, message: self.message.clone(), metrics }
    }

    fn from_check(check: &Check) -> Verification {
        let get = |name: &str| integer(&check.metrics, name);
        let image_hash = metric(&check.metrics, None, "image_hash").map(Value::write).unwrap_or_default();
        Verification {
            frame: get("frame") as usize,
            width: get("width") as u32,
            height: get("height") as u32,
            ok: check.ok,
            twin: get("twin") != 0,
            rays: get("rays"),
            brute_checked: get("brute_checked"),
            hits_differing: get("hits_differing"),
            hits_lost: get("hits_lost"),
            counters_differing: get("counters_differing"),
            colours_differing: get("colours_differing"),
            max_colour_difference: get("max_colour_difference") as u8,
            image_hash,
            message: check.message.clone(),
        }
    }
}
