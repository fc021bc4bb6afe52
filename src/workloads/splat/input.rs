//! A scene of photon splatting, opened: what its cases share.

use super::case::{SplatCase, light_choices};
use super::gathering::Gathering;
use super::lit::{self, LitScene};
use super::run::{self, SplatRun};
use super::workload::{Splat, WORKLOAD};
use super::{CpuFrame, pictures, references};
use crate::camera::{Camera, CameraPath};
use crate::device::{CpuDevice, Device};
use crate::error::{Error, Result};
use crate::harness::workload::{Case, Context, Event, Input, Run};
use crate::record::row::{Artifact, Input as InputRecord, Key, Metric, Row, Status};
use crate::scene::{self, Scene, catalogue};
use crate::workloads::size::Size;
use crate::workloads::trace::input::{self as trace_input, scene_record};
use crate::workloads::trace::record::PathRecord;
use crate::workloads::trace::{Built, Selection};
use std::cell::RefCell;
use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

/// The structure through which references are traced. Most rays have no neighbours that go their way, as packets need.
pub(super) const REFERENCE_TREE: &str = "bvh-stack";

/// See the module.
pub struct SplatInput<'a> {
    pub(super) context: &'a Context<'a>,
    /// Runs the twins.
    pub(super) cpu: CpuDevice,
    scene: Arc<Scene>,
    /// Of the file and its albedos.
    warnings: Vec<String>,
    /// The scene with the lights of each value of the axis `light`; a message where they cannot be in this scene.
    lit: Vec<(String, std::result::Result<Lit, String>)>,
    pub(super) paths: Vec<Path>,
    /// The tree by which twins trace what a device's answers are compared with.
    pub(super) reference: Arc<Built>,
    reference_key: String,
    /// What else is built, by [`Selection::build_key`].
    built: HashMap<String, Arc<Built>>,
    /// Path-traced references.
    pub(super) references: RefCell<references::References>,
    /// The folder in which they are kept from run to run.
    pub(super) cache: Option<PathBuf>,
    /// Hashes of the first photons, by what decides them: all structures and devices must make the same.
    pub(super) photons: RefCell<HashMap<String, (String, String)>>,
    /// Planted by a test.
    pub(super) fault: Option<super::Fault>,
    /// The cases: pictures are of the first of them, and of the first of each technique.
    pub(super) pictured: Vec<SplatCase>,
}

/// A scene with its lights.
pub struct Lit {
    /// Albedos, lights and lengths.
    pub scene: LitScene,
    /// BLAKE3 of scene, lights and extent, hexadecimal.
    pub hash: String,
}

/// A camera path with its frames.
pub struct Path {
    asked: String,
    frames: Option<usize>,
    /// Name and hash.
    pub record: PathRecord,
    /// One for each frame.
    pub cameras: Vec<Camera>,
}

/// BLAKE3 of what light and camera meet.
fn hash(lit: &LitScene) -> String {
    let mut hasher = blake3::Hasher::new();
    hasher.update(lit.scene.content_hash().as_bytes());
    let vectors = lit.lights.iter().flat_map(|light| [light.position, light.flux]);
    for vector in vectors.chain([lit.extent.min, lit.extent.max]) {
        vector.to_array().iter().for_each(|x| _ = hasher.update(&x.to_le_bytes()));
    }
    hasher.finalize().to_hex().to_string()
}

impl<'a> SplatInput<'a> {
    /// Loads the scene of some cases, its lights and their camera paths.
    ///
    /// # Errors
    /// [`Error::Input`] of a file or a light.
    pub fn open(cases: &[Case], context: &'a Context<'a>, workload: &Splat) -> Result<SplatInput<'a>> {
        let Some(first) = cases.first() else { return Err(Error::Device("no case of a scene".into())) };
        let mut loaded = scene::load_in(&first.input, context.library.scenes_folder.as_deref())?;
        let radiometry = catalogue::radiometry(&first.input);
        let mut warnings = loaded.warnings.clone();
        warnings.extend(lit::apply_albedos(&mut loaded, radiometry));
        let mut paths: Vec<Path> = Vec::new();
        // Lights that are given replace those of the scene, which may be none
        let unlit = LitScene::new(loaded.clone(), radiometry, &[])?;
        let mut lit: Vec<(String, std::result::Result<Lit, String>)> = Vec::new();
        for case in cases {
            let case = SplatCase::parse(case)?;
            if !lit.iter().any(|(asked, _)| *asked == case.light) {
                let choices = light_choices(&case.light)?;
                let scene = if choices.is_empty() { Ok(unlit.clone()) } else { unlit.relit(&choices) };
                let made = scene.map(|scene| Lit { hash: hash(&scene), scene }).map_err(|error| error.to_string());
                lit.push((case.light.clone(), made));
            }
            if !paths.iter().any(|path| path.is_of(&case)) {
                let of_entry = radiometry.and_then(|radiometry| radiometry.camera_path.as_deref());
                paths.push(Path::of(&case, of_entry, &loaded)?);
            }
        }
        let scene = unlit.scene.clone();
        let selection = Selection::parse(REFERENCE_TREE)?;
        let reference = Arc::new(trace_input::build(&selection, &scene, context, None)?);
        Ok(SplatInput {
            context,
            cpu: CpuDevice::new(context.settings.threads)?,
            scene,
            warnings,
            lit,
            paths,
            reference,
            reference_key: selection.build_key(),
            built: HashMap::new(),
            references: RefCell::default(),
            cache: workload.cache.clone().or_else(references::folder),
            photons: RefCell::default(),
            fault: workload.fault,
            pictured: cases.iter().map(SplatCase::parse).collect::<Result<_>>()?,
        })
    }

    /// The scene with the lights of a case.
    ///
    /// # Errors
    /// [`Error::Refused`] for lights that cannot be in this scene.
    pub fn lit(&self, case: &SplatCase) -> Result<&Lit> {
        match self.lit.iter().find(|(asked, _)| *asked == case.light) {
            Some((_, Ok(lit))) => Ok(lit),
            Some((_, Err(message))) => Err(Error::unsupported(message.clone())),
            None => Err(Error::Device("a case whose lights were not opened".into())),
        }
    }

    /// How photons reach samples in images of a case in a size.
    ///
    /// # Errors
    /// [`Error::Refused`] for keys of too many bits, and for a radius out of range.
    pub fn gathering(&self, case: &SplatCase, size: Size) -> Result<Gathering> {
        Gathering::new(case, &self.lit(case)?.scene, &self.path(case)?.cameras, size)
    }

    /// The twins of a case's frames, which trace through the reference tree.
    ///
    /// # Errors
    /// Those of [`run::cpu_frame`].
    pub fn twin<'s>(
        &'s self,
        lit: &'s Lit,
        case: &SplatCase,
        gathering: Gathering,
        size: Size,
    ) -> Result<CpuFrame<'s>> {
        run::cpu_frame(&self.cpu, lit, &self.reference, &Selection::parse(REFERENCE_TREE)?, case, gathering, size)
    }

    /// The camera path of a case.
    pub fn path(&self, case: &SplatCase) -> Result<&Path> {
        let found = self.paths.iter().find(|path| path.is_of(case));
        found.ok_or_else(|| Error::Device("a case whose camera path was not opened".into()))
    }

    fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// What was built for a selection.
    pub fn of_selection(&self, selection: &Selection) -> Result<&Arc<Built>> {
        let key = selection.build_key();
        let built = if key == self.reference_key { Some(&self.reference) } else { self.built.get(&key) };
        built.ok_or_else(|| Error::Device(format!("{} was not built", selection.name())))
    }

    /// What was built for a selection, with its sizes: on a device as allocated there.
    pub fn artifact_of(&self, selection: &Selection, allocated: Option<(u64, u64)>) -> Option<Artifact> {
        let built = self.of_selection(selection).ok()?;
        let record = scene_record(self.scene());
        let mut artifact = trace_input::artifact(&record, selection, built, self.scene(), allocated);
        artifact.key.workload = WORKLOAD.to_owned();
        Some(artifact)
    }

    /// What decides the photons of a case.
    pub fn photons_key(case: &SplatCase) -> String {
        format!("{:?} {}", case.setting, case.light)
    }
}

impl Path {
    fn of(case: &SplatCase, of_entry: Option<&str>, scene: &Scene) -> Result<Path> {
        let asked = case.camera_path.clone();
        let name = Some(asked.as_str()).filter(|name| !name.is_empty()).or(of_entry);
        let path = CameraPath::named_or_fitting(name, scene, false)?;
        let views = path.views(scene, case.frames)?;
        let record = PathRecord { name: path.name.clone(), hash: path.content_hash() };
        Ok(Path { asked, frames: case.frames, record, cameras: views.iter().map(|view| view.camera).collect() })
    }

    fn is_of(&self, case: &SplatCase) -> bool {
        (&self.asked, self.frames) == (&case.camera_path, case.frames)
    }
}

impl Input for SplatInput<'_> {
    fn records(&self) -> Vec<InputRecord> {
        let record = scene_record(self.scene());
        let mut records = Vec::new();
        for (_, lit) in &self.lit {
            let Ok(lit) = lit else { continue };
            let mut input = record.to_input();
            input.hash.clone_from(&lit.hash);
            let LitScene { extent, .. } = &lit.scene;
            let lengths = [
                ("extent_diagonal", lit.scene.diagonal()),
                ("near", lit.scene.near()),
                ("far", lit.scene.far()),
                ("epsilon", lit.scene.epsilon()),
                ("influence", lit.scene.influence()),
            ];
            let placement = &lit.scene.scene.placement;
            let in_file = |(name, length)| Metric::new(name, placement.length(length));
            input.metrics.extend(lengths.map(in_file));
            input.metrics.push(Metric::new("extent_min", placement.point(extent.min)));
            input.metrics.push(Metric::new("extent_max", placement.point(extent.max)));
            for (number, light) in (1..).zip(&lit.scene.lights) {
                let of = format!("light-{number}");
                input.metrics.push(Metric::of(&of, "position", placement.point(light.position)));
                input.metrics.push(Metric::of(&of, "flux", format!("{:?}", lit.scene.file_flux(light).to_array())));
            }
            records.push(input);
        }
        for path in &self.paths {
            let record = path.record.to_input();
            if !records.contains(&record) {
                records.push(record);
            }
        }
        records
    }

    fn warnings(&self) -> Vec<String> {
        let mut warnings = self.warnings.clone();
        let lit = self.lit.iter().filter_map(|(_, lit)| lit.as_ref().ok());
        for warning in lit.flat_map(|lit| &lit.scene.warnings) {
            if !warnings.contains(warning) {
                warnings.push(warning.clone());
            }
        }
        warnings
    }

    fn key(&self, case: &Case) -> Key {
        let mut key = Key { workload: WORKLOAD.into(), axes: case.axes.clone(), inputs: Default::default() };
        key.axes.insert("scene".into(), self.scene().name.clone());
        let Ok(case) = SplatCase::parse(case) else { return key };
        if let (Ok(lit), Ok(path)) = (self.lit(&case), self.path(&case)) {
            key.inputs.insert("scene".into(), lit.hash.clone());
            key.axes.insert("camera_path".into(), path.record.name.clone());
            key.axes.insert("frames".into(), path.cameras.len().to_string());
            key.inputs.insert("camera_path".into(), path.record.hash.clone());
        }
        key
    }

    fn remember(&self, case: &Case, row: &Row) {
        let (Ok(case), Some(hash)) = (SplatCase::parse(case), row.outputs.get("reference_photons")) else { return };
        if row.status == Status::Ok {
            let own = (case.selection.full_name(), hash.clone());
            self.photons.borrow_mut().entry(SplatInput::photons_key(&case)).or_insert(own);
        }
    }

    fn build(&mut self, case: &Case, device: &Device) -> Result<u64> {
        let selection = Selection::parse(&case.group)?;
        if self.of_selection(&selection).is_err() {
            let built = trace_input::build(&selection, self.scene(), self.context, Some(device))?;
            self.built.insert(selection.build_key(), Arc::new(built));
        }
        let built = self.of_selection(&selection)?;
        let sizes = trace_input::memory(built, self.scene(), None);
        Ok(sizes.structure_bytes + sizes.geometry_bytes)
    }

    fn prepare<'p>(&'p self, device: &'p Device, case: &Case) -> Result<Box<dyn Run + 'p>> {
        Ok(Box::new(SplatRun::new(self, device, Selection::parse(&case.group)?)?))
    }

    fn artifact(&self, case: &Case) -> Option<Artifact> {
        self.artifact_of(&Selection::parse(&case.group).ok()?, None)
    }

    fn release(&mut self) {
        self.built.clear();
    }

    fn pictures(&self, device: &Device) -> Result<()> {
        self.context.emit(Event::Doing(format!("picturing {}", self.scene().name)));
        pictures::take(self, device)
    }

    fn has_pictures(&self) -> bool {
        pictures::are_there(self.context.out, &self.scene().name, &self.pictured)
    }
}
