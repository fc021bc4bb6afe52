//! The plan of a sweep: scenes x structures x configurations x sizes, checked as a whole before anything runs.

use crate::camera::{CameraPath, View};
use crate::error::{Error, Result};
use crate::harness::preset::{Preset, PresetScene};
use crate::record::schema::{PathRecord, PlacementRecord, PlanRecord, SceneRecord};
use crate::scene::{self, Scene, catalogue};
use crate::workloads::trace::Selection;
use crate::workloads::trace::backend::{Config, DeviceInfo, Pixel, Size};
use std::path::PathBuf;

/// Most pixels of an image, whatever the device: a frame's pixels are also held in main memory.
pub const MAX_PIXELS: u64 = 1 << 26;

/// Most frames and passes: samples are kept.
const MAX_REPEATS: usize = 100_000;

/// What was asked for, as typed; what is empty comes from the preset.
#[derive(Clone, Debug, Default)]
pub struct Request {
    /// Name or file.
    pub preset: String,
    /// Scenes.
    pub scenes: Vec<String>,
    /// Camera path for all scenes and configurations.
    pub camera_path: Option<String>,
    /// Structures with options; comma lists.
    pub structures: Vec<String>,
    /// Ray configurations; comma lists.
    pub configs: Vec<String>,
    /// `N` or `WxH`; comma lists.
    pub resolutions: Vec<String>,
    /// Frames that each path is thinned to.
    pub frames: Option<usize>,
    /// Timed passes.
    pub passes: Option<usize>,
    /// Untimed frames before each pass.
    pub warmup_frames: Option<usize>,
    /// Folder with the files of the catalogue's scenes.
    pub scenes_folder: Option<PathBuf>,
}

/// A checked plan.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The preset that it began with.
    pub preset: String,
    /// What is measured, in this order.
    pub parts: Vec<Part>,
    /// Camera path for everything; otherwise each scene and configuration has its own.
    pub camera_path: Option<String>,
    /// Timed passes.
    pub passes: usize,
    /// Untimed frames before each pass.
    pub warmup_frames: usize,
    /// Threads that build, where the command line does not say; 0 for all.
    pub build_threads: usize,
    /// How often each structure is built; the median counts.
    pub builds: usize,
    /// Folder with the files of the catalogue's scenes.
    pub scenes_folder: Option<PathBuf>,
    /// What the preset names and this machine does not have, in words.
    pub skipped: Vec<String>,
}

/// Every structure x configuration x size on one scene.
#[derive(Clone, Debug)]
pub struct Part {
    /// What to load.
    pub scene: String,
    /// Structures, each once.
    pub selections: Vec<Selection>,
    /// Ray configurations, each once.
    pub configs: Vec<Config>,
    /// Image sizes, each once.
    pub sizes: Vec<Size>,
    /// Frames that each path is thinned to.
    pub frames: Option<usize>,
}

/// One row of a sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Task {
    /// Ray configuration.
    pub config: Config,
    /// Image size.
    pub size: Size,
    /// Frames that the path is thinned to.
    pub frames: Option<usize>,
}

/// A camera path with its frames.
pub struct Path {
    /// For the record.
    pub record: PathRecord,
    /// Frames.
    pub views: Vec<View>,
}

impl Plan {
    /// Checks a request; nothing is loaded yet.
    ///
    /// # Errors
    /// [`Error::Input`] for the first thing that cannot be.
    pub fn new(request: &Request) -> Result<Plan> {
        let preset = Preset::load(&request.preset)?;
        let mut skipped = Vec::new();
        let mut wanted = Vec::new();
        for scene in &request.scenes {
            // A scene that the preset names keeps what is said of it there. Other structures are compared as its first part
            // says: the parts behind it are there for the structures that they name.
            let parts = preset.scene.iter().filter(|part| part.scene == *scene);
            let before = wanted.len();
            wanted.extend(parts.take(if request.structures.is_empty() { usize::MAX } else { 1 }).cloned());
            if wanted.len() == before {
                wanted.push(PresetScene {
                    scene: scene.clone(),
                    structures: None,
                    configs: None,
                    resolutions: None,
                    frames: None,
                });
            }
        }
        if request.scenes.is_empty() {
            for part in preset.scene {
                // What is absent is named, with where to get it, and left out; nothing takes its place.
                let entry = catalogue::find(part.scene.split(':').next().unwrap_or(&part.scene));
                match entry.map(|entry| entry.path_in(request.scenes_folder.as_deref())) {
                    Some(Err(absent)) => skipped.push(absent.to_string()),
                    _ => wanted.push(part),
                }
            }
            skipped = once(skipped.into_iter());
        }
        if wanted.is_empty() {
            let problem = format!("none of the scenes of preset {} is here: {}", preset.name, skipped.join("; "));
            return Err(Error::argument("--preset", problem, "or name a scene with --scene"));
        }
        let choose = |given: &[String], own: &Option<Vec<String>>, preset: &[String]| match (given, own) {
            ([], Some(own)) => own.clone(),
            ([], None) => preset.to_vec(),
            (given, _) => given.to_vec(),
        };
        let part = |part: &PresetScene| {
            let structures = choose(&request.structures, &part.structures, &preset.structures);
            let configs = choose(&request.configs, &part.configs, &preset.configs);
            let resolutions = choose(&request.resolutions, &part.resolutions, &preset.resolutions);
            Ok(Part {
                scene: part.scene.clone(),
                selections: parse_list(&structures, Selection::parse)?,
                configs: parse_list(&configs, parse_config)?,
                sizes: parse_list(&resolutions, parse_size)?,
                frames: request.frames.or(part.frames).or(preset.frames),
            })
        };
        let parts = wanted.iter().map(part).collect::<Result<Vec<Part>>>()?;
        let frames = parts.iter().filter_map(|part| part.frames);
        let (least, most) = frames.fold((1, 1), |(least, most), n| (n.min(least), n.max(most)));
        let (passes, warmup_frames) =
            (request.passes.unwrap_or(preset.passes), request.warmup_frames.unwrap_or(preset.warmup_frames));
        for (flag, value, least) in
            [("--frames", least, 1), ("--frames", most, 1), ("--passes", passes, 1), ("--warmup", warmup_frames, 0)]
        {
            if !(least..=MAX_REPEATS).contains(&value) {
                let hint = format!("give {least} to {MAX_REPEATS}");
                return Err(Error::argument(flag, format!("{value} is out of range"), hint));
            }
        }
        Ok(Plan {
            parts,
            camera_path: request.camera_path.clone(),
            passes,
            warmup_frames,
            build_threads: preset.build_threads,
            builds: preset.builds.clamp(1, MAX_REPEATS),
            scenes_folder: request.scenes_folder.clone(),
            skipped,
            preset: preset.name,
        })
    }

    /// Refuses sizes that the device cannot hold.
    ///
    /// # Errors
    /// [`Error::Input`].
    pub fn check_device(&self, device: &DeviceInfo) -> Result<()> {
        self.parts.iter().flat_map(|part| &part.sizes).try_for_each(|&size| check_size(size, device))
    }

    /// Loads one of the plan's scenes.
    ///
    /// # Errors
    /// [`Error::Input`] of the scene.
    pub fn load(&self, what: &str) -> Result<Scene> {
        scene::load_in(what, self.scenes_folder.as_deref())
    }

    /// Loads every scene and camera path once, so that a sweep does not end in the middle over a typing error, and
    /// tells what is ahead: the work of each scene in rays, roughly.
    ///
    /// # Errors
    /// [`Error::Input`] of the scene or path.
    pub fn survey(&self) -> Result<Vec<u64>> {
        let rays_of = |what: &str| {
            let scene = self.load(what)?;
            let mut rays = 0;
            for selection in self.selections(what) {
                for Task { config, size, frames } in self.tasks(what, selection) {
                    rays += self.work(config, size, &self.path(&scene, config, frames)?.views);
                }
            }
            Ok(rays)
        };
        self.scenes().into_iter().map(rays_of).collect()
    }

    /// The scenes, each once.
    pub fn scenes(&self) -> Vec<&str> {
        once(self.parts.iter().map(|part| part.scene.as_str()))
    }

    /// The structures that are measured on a scene, each once.
    pub fn selections(&self, what: &str) -> Vec<&Selection> {
        once(self.parts.iter().filter(|part| part.scene == what).flat_map(|part| &part.selections))
    }

    /// The rows of a structure on a scene: of equal configurations and sizes, the first.
    pub fn tasks(&self, what: &str, selection: &Selection) -> Vec<Task> {
        let mut tasks: Vec<Task> = Vec::new();
        for part in self.parts.iter().filter(|part| part.scene == what && part.selections.contains(selection)) {
            for &config in &part.configs {
                for &size in &part.sizes {
                    if !tasks.iter().any(|task| task.config == config && task.size == size) {
                        tasks.push(Task { config, size, frames: part.frames });
                    }
                }
            }
        }
        tasks
    }

    /// The size of a scene's first row; 1x1 for a scene without rows.
    pub fn first_size(&self, what: &str) -> Size {
        let sizes = self.parts.iter().filter(|part| part.scene == what).flat_map(|part| &part.sizes);
        sizes.copied().next().unwrap_or(Size { width: 1, height: 1 })
    }

    /// Rays that measuring one configuration traces, roughly: the passes and the counting of every frame.
    pub fn work(&self, config: Config, size: Size, views: &[View]) -> u64 {
        let lights = views.first().map_or(0, |v| v.lights.len() as u64);
        let per_pixel = match config {
            Config::P => 2,
            Config::PS => 2 + 2 * lights,
            // A third of the pixels with a bounce is between an object without mirrors and a hall full of them.
            Config::PSR => (2 + 2 * lights) * 4 / 3,
        };
        size.pixels() as u64 * views.len() as u64 * (self.passes as u64 + 1) * per_pixel / 2
    }

    /// The camera path of a scene and a configuration, thinned to `frames`.
    ///
    /// # Errors
    /// [`Error::Input`] of the path.
    pub fn path(&self, scene: &Scene, config: Config, frames: Option<usize>) -> Result<Path> {
        let path = CameraPath::named_or_fitting(self.camera_path.as_deref(), scene, config.shadows())?;
        let record = PathRecord { name: path.name.clone(), hash: path.content_hash() };
        Ok(Path { record, views: path.views(scene, frames)? })
    }

    /// Number of rows.
    pub fn configurations(&self) -> usize {
        let rows =
            |what| self.selections(what).into_iter().map(|selection| self.tasks(what, selection).len()).sum::<usize>();
        self.scenes().into_iter().map(rows).sum()
    }

    /// For the provenance.
    pub fn record(&self) -> PlanRecord {
        PlanRecord {
            preset: self.preset.clone(),
            scenes: self.scenes().into_iter().map(str::to_owned).collect(),
            structures: once(self.parts.iter().flat_map(|part| &part.selections))
                .into_iter()
                .map(|s| format!("{} ({})", s.name(), s.variant()))
                .collect(),
            configurations: self.configurations(),
            passes: self.passes,
            warmup_frames: self.warmup_frames,
            builds: self.builds,
            skipped: self.skipped.clone(),
        }
    }
}

/// Each item once, in the order of first appearance.
fn once<T: PartialEq>(items: impl Iterator<Item = T>) -> Vec<T> {
    let mut seen = Vec::new();
    items.for_each(|item| {
        if !seen.contains(&item) {
            seen.push(item);
        }
    });
    seen
}

/// A scene as it stands in records.
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

/// A ray configuration by name.
///
/// # Errors
/// [`Error::Input`].
pub fn parse_config(text: &str) -> Result<Config> {
    let found = Config::ALL.into_iter().find(|config| format!("{config:?}").eq_ignore_ascii_case(text));
    found.ok_or_else(|| Error::argument("--config", format!("unknown configuration {text:?}"), "give P, PS or PSR"))
}

/// `N` or `WxH`.
///
/// # Errors
/// [`Error::Input`].
pub fn parse_size(text: &str) -> Result<Size> {
    let wrong =
        |problem: String| Error::argument("--resolution", problem, "give N or WxH in pixels, as 512 or 640x480");
    let (width, height) = text.split_once(['x', 'X']).unwrap_or((text, text));
    match (width.trim().parse::<u32>(), height.trim().parse::<u32>()) {
        (Ok(0), _) | (_, Ok(0)) => Err(wrong(format!("{text} has no pixels"))),
        (Ok(width), Ok(height)) => {
            if u64::from(width) * u64::from(height) > MAX_PIXELS {
                return Err(wrong(format!("{text} has more than {MAX_PIXELS} pixels")));
            }
            Ok(Size { width, height })
        }
        _ => Err(wrong(format!("{text:?} is no image size"))),
    }
}

/// Refuses a size whose pixels do not fit one of the device's buffers.
///
/// # Errors
/// [`Error::Input`].
pub fn check_size(size: Size, device: &DeviceInfo) -> Result<()> {
    let bytes = (size.pixels() * size_of::<Pixel>()) as u64;
    for name in ["max_storage_buffer_binding_size", "max_buffer_size"] {
        if let Some(&limit) = device.limits.get(name)
            && bytes > limit
        {
            let (width, height) = (size.width, size.height);
            let problem = format!("{width}x{height} needs {bytes} bytes, {} has {name} = {limit}", device.name);
            return Err(Error::argument("--resolution", problem, "give a smaller image"));
        }
    }
    Ok(())
}

/// Parses a list given as several arguments, comma lists, or both; each value once, in the given order. A comma inside
/// a structure's options (`grid:x=64,y=64`) is recognised by what follows it: `key=value` without a name.
///
/// # Errors
/// Those of `parse`.
pub fn parse_list<T: PartialEq>(texts: &[String], parse: impl Fn(&str) -> Result<T>) -> Result<Vec<T>> {
    let mut items: Vec<String> = Vec::new();
    for text in texts {
        let first = items.len();
        for part in text.split(',') {
            match items.get_mut(first..).and_then(|of_this| of_this.last_mut()) {
                Some(last) if part.contains('=') && !part.contains(':') => {
                    last.push(',');
                    last.push_str(part);
                }
                _ => items.push(part.trim().to_owned()),
            }
        }
    }
    let mut values = Vec::new();
    for item in &items {
        let value = parse(item)?;
        if !values.contains(&value) {
            values.push(value);
        }
    }
    Ok(values)
}
