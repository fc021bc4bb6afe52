//! A scene with its camera paths, its reference answers, and the structures that are built of it.

use super::backend::surface_epsilon;
use super::case::TraceCase;
use super::rays::Config;
use super::record::{Memory, PathRecord, PlacementRecord, SceneRecord, WORKLOAD, structure_metrics};
use super::run::TraceRun;
use super::tracer::{self, Decorate};
use super::verify::Verifier;
use super::{Built, Selection, building, pictures};
use crate::camera::{CameraPath, View};
use crate::device::Device;
use crate::error::{Error, Result};
use crate::harness::workload::{Case, Context, Event, Input, Run};
use crate::record::row::{Artifact, Input as InputRecord, Key, Metric, Row, Status};
use crate::scene::{self, Scene};
use std::cell::RefCell;
use std::collections::HashMap;
use std::sync::Arc;

/// A scene, opened.
pub(super) struct TraceInput<'a> {
    pub(super) context: &'a Context<'a>,
    decorate: Option<&'a Decorate>,
    pub(super) scene: Arc<Scene>,
    /// Surface epsilon, in scene units.
    pub(super) epsilon: f32,
    pub(super) record: SceneRecord,
    pub(super) paths: Vec<Path>,
    /// The tree through which references are traced; brute force confirms them (see [`super::verify`]).
    pub(super) reference: Arc<Built>,
    reference_key: String,
    pub(super) verifier: RefCell<Verifier>,
    /// What else is built, by [`Selection::build_key`].
    built: HashMap<String, Arc<Built>>,
    /// Of the first structure that was measured, by what its image depends on: structure and hash.
    pub(super) images: RefCell<HashMap<String, (String, String)>>,
    /// The first case: pictures have its shape.
    pub(super) first: Case,
}

/// A camera path with its frames.
pub(super) struct Path {
    pub config: Config,
    frames: Option<usize>,
    /// As it was asked for; empty for the scene's own.
    asked: String,
    pub record: PathRecord,
    pub views: Vec<View>,
}

impl Path {
    fn is_of(&self, case: &TraceCase) -> bool {
        (self.config, self.frames, &self.asked) == (case.config, case.frames, &case.camera_path)
    }
}

impl<'a> TraceInput<'a> {
    /// Loads the scene of some cases and their camera paths.
    pub fn open(cases: &[Case], context: &'a Context<'a>, decorate: Option<&'a Decorate>) -> Result<TraceInput<'a>> {
        let Some(first) = cases.first() else { return Err(Error::Device("no case of a scene".into())) };
        let scene = Arc::new(scene::load_in(&first.input, context.library.scenes_folder.as_deref())?);
        let mut paths: Vec<Path> = Vec::new();
        for case in cases {
            let case = TraceCase::parse(case)?;
            if !paths.iter().any(|path| path.is_of(&case)) {
                let TraceCase { config, frames, camera_path: asked, .. } = case;
                let name = Some(asked.as_str()).filter(|name| !name.is_empty());
                let path = CameraPath::named_or_fitting(name, &scene, config.shadows())?;
                let record = PathRecord { name: path.name.clone(), hash: path.content_hash() };
                paths.push(Path { config, frames, views: path.views(&scene, frames)?, asked, record });
            }
        }
        let selection = Selection::parse("bvh")?;
        let reference = Arc::new(build(&selection, &scene, context, None)?);
        Ok(TraceInput {
            context,
            decorate,
            record: scene_record(&scene),
            epsilon: surface_epsilon(scene.bounds()),
            paths,
            verifier: RefCell::new(Verifier::new(scene.clone(), reference.clone())?),
            scene,
            reference,
            reference_key: selection.build_key(),
            built: HashMap::new(),
            images: RefCell::default(),
            first: first.clone(),
        })
    }

    /// The camera path of a case.
    pub fn path(&self, case: &TraceCase) -> Result<&Path> {
        let found = self.paths.iter().find(|path| path.is_of(case));
        found.ok_or_else(|| Error::Device("a case whose camera path was not opened".into()))
    }

    fn of_selection(&self, selection: &Selection) -> Option<&Arc<Built>> {
        let key = selection.build_key();
        if key == self.reference_key { Some(&self.reference) } else { self.built.get(&key) }
    }

    /// What was built for a selection, with its sizes: on a device as allocated there.
    pub fn artifact_of(&self, selection: &Selection, allocated: Option<(u64, u64)>) -> Option<Artifact> {
        let built = self.of_selection(selection)?;
        let mut artifact = artifact(&self.record, selection, built, &self.scene, allocated);
        artifact.key.inputs.insert("scene".into(), self.record.hash.clone());
        Some(artifact)
    }

    /// What decides which image a case makes: all structures must make the same one.
    pub fn image_key(&self, case: &TraceCase) -> String {
        let rays = case.selection.method().rays();
        format!("{:?} {:?} {:?} {rays:?} {}", case.config, case.frames, case.size, case.camera_path)
    }
}

impl Input for TraceInput<'_> {
    fn records(&self) -> Vec<InputRecord> {
        let mut records = vec![self.record.to_input()];
        for path in &self.paths {
            let record = path.record.to_input();
            if !records.contains(&record) {
                records.push(record);
            }
        }
        records
    }

    fn warnings(&self) -> Vec<String> {
        self.scene.warnings.clone()
    }

    fn key(&self, case: &Case) -> Key {
        let mut key = Key { workload: WORKLOAD.into(), axes: case.axes.clone(), inputs: Default::default() };
        key.axes.insert("scene".into(), self.record.name.clone());
        key.inputs.insert("scene".into(), self.record.hash.clone());
        if let Ok(path) = TraceCase::parse(case).and_then(|case| self.path(&case)) {
            key.axes.insert("camera_path".into(), path.record.name.clone());
            key.axes.insert("frames".into(), path.views.len().to_string());
            key.inputs.insert("camera_path".into(), path.record.hash.clone());
        }
        key
    }

    fn remember(&self, case: &Case, row: &Row) {
        let (Ok(case), Some(hash)) = (TraceCase::parse(case), row.outputs.get("image")) else { return };
        // The first of them founded the reference
        if row.status == Status::Ok && row.outputs.get("reference_image") == Some(hash) {
            let own = (case.selection.name().to_owned(), hash.clone());
            self.images.borrow_mut().entry(self.image_key(&case)).or_insert(own);
        }
    }

    fn build(&mut self, case: &Case, device: &Device) -> Result<u64> {
        let selection = Selection::parse(&case.group)?;
        if self.of_selection(&selection).is_none() {
            let built = build(&selection, &self.scene, self.context, Some(device))?;
            self.built.insert(selection.build_key(), Arc::new(built));
        }
        // On the device once for each traversal, and the geometry with it
        let sizes = self.of_selection(&selection).map(|built| memory(built, &self.scene, None)).unwrap_or_default();
        Ok(sizes.structure_bytes + sizes.geometry_bytes)
    }

    fn prepare<'p>(&'p self, device: &'p Device, case: &Case) -> Result<Box<dyn Run + 'p>> {
        let selection = Selection::parse(&case.group)?;
        let Some(built) = self.of_selection(&selection) else {
            return Err(Error::Device(format!("{} was not built", selection.name())));
        };
        let mut tracer = tracer::prepare(device, &self.scene, &*built.structure, selection.method())?;
        if let Some(decorate) = self.decorate {
            tracer = decorate(tracer, &selection)?;
        }
        Ok(Box::new(TraceRun::new(self, device.info(), selection, built, tracer)))
    }

    fn artifact(&self, case: &Case) -> Option<Artifact> {
        self.artifact_of(&Selection::parse(&case.group).ok()?, None)
    }

    fn release(&mut self) {
        self.built.clear();
    }

    fn pictures(&self, device: &Device) -> Result<()> {
        pictures::take(self, device)
    }

    fn has_pictures(&self) -> bool {
        pictures::are_there(self.context.out, &self.record.name)
    }
}

/// Builds a structure as often as the settings say; its time is the median. It is built on the device where its builder
/// can do that, otherwise on the CPU.
///
/// # Errors
/// Those of [`Selection::build`] and [`Selection::build_on`], [`Error::Interrupted`].
pub fn build(selection: &Selection, scene: &Arc<Scene>, context: &Context, device: Option<&Device>) -> Result<Built> {
    context.emit(Event::Building(format!("building {} of {}", selection.name(), scene.name)));
    let (settings, interrupted) = (context.settings, context.interrupted);
    let on_device = match device {
        Some(Device::Vulkan(device)) => {
            building::build_repeatedly_on(device, selection, scene, settings.builds, interrupted)?
        }
        _ => None,
    };
    let on_cpu = || building::build_repeatedly(selection, scene, settings.threads, settings.builds, interrupted);
    let built = on_device.map_or_else(on_cpu, Ok)?;
    if built.device_times.is_some() {
        // What a device computed is trusted no more than what a file holds
        let broken = |why: String| Error::Device(format!("{} is not valid: {why}", selection.name()));
        built.structure.validate(scene).map_err(broken)?;
    }
    if !built.note.is_empty() {
        context.emit(Event::Note(format!("{} {}: {}", scene.name, selection.name(), built.note)));
    }
    Ok(built)
}

/// A scene for records.
pub fn scene_record(scene: &Scene) -> SceneRecord {
    SceneRecord {
        name: scene.name.clone(),
        hash: scene.content_hash(),
        triangles: scene.triangles.len() as u64,
        vertices: scene.vertices.len() as u64,
        lights: scene.lights.len() as u64,
        degenerate_triangles: scene.degenerate_triangles as u64,
        mirror_share: f64::from(scene.mirror_share()),
        placement: (!scene.placement.is_identity())
            .then(|| PlacementRecord { offset: scene.placement.offset.to_array(), exponent: scene.placement.exponent }),
    }
}

/// Sizes: as allocated on a device (geometry, structure) where it was, otherwise as the CPU twins hold it.
pub fn memory(built: &Built, scene: &Scene, allocated: Option<(u64, u64)>) -> Memory {
    let held = || (scene.geometry_bytes(), built.structure.structure_bytes());
    let (geometry_bytes, structure_bytes) = allocated.unwrap_or_else(held);
    let (thesis_bytes, rt2_bytes) = (built.structure.thesis_bytes(scene), built.structure.rt2_bytes());
    Memory { structure_bytes, geometry_bytes, thesis_bytes, rt2_bytes }
}

/// What was built, for records.
pub fn artifact(
    record: &SceneRecord,
    selection: &Selection,
    built: &Built,
    scene: &Scene,
    allocated: Option<(u64, u64)>,
) -> Artifact {
    let mut key = Key { workload: WORKLOAD.into(), ..Key::default() };
    key.axes.insert("scene".into(), record.name.clone());
    key.axes.insert("structure".into(), selection.name().to_owned());
    key.axes.extend(selection.option_axes().map(|(axis, options)| (axis.to_owned(), options)));
    key.inputs.insert("scene".into(), record.hash.clone());
    let (properties, memory) = (built.structure.properties(scene), memory(built, scene, allocated));
    let mut metrics = structure_metrics(&properties, memory, built.build_ms, built.build_threads);
    if let Some(times) = &built.device_times {
        metrics.push(Metric::new("build_upload_ms", times.upload_ms));
        metrics.extend(times.stages.iter().map(|&(stage, ms)| Metric::of(stage, "build_ms", ms)));
    }
    Artifact { key, metrics, note: built.note.clone() }
}
