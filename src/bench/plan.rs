//! The plan of a sweep: scenes x structures x configurations x sizes, checked as a whole before anything runs.

use super::preset::{Preset, PresetScene};
use crate::accel::Selection;
use crate::backend::{Config, DeviceInfo, Pixel, Size};
use crate::camera::{CameraPath, View};
use crate::error::{Error, Result};
use crate::results::record::{PathRecord, PlanRecord, SceneRecord};
use crate::scene::{self, Scene, catalogue};
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
    /// Untimed frames before the first pass.
    pub warmup_frames: Option<usize>,
    /// Folder with the files of the catalogue's scenes.
    pub scenes_folder: Option<PathBuf>,
}

/// A checked plan.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The preset that it began with.
    pub preset: String,
    /// What to load, in this order.
    pub scenes: Vec<String>,
    /// Camera path for everything; otherwise each scene and configuration has its own.
    pub camera_path: Option<String>,
    /// Structures, each once.
    pub selections: Vec<Selection>,
    /// Ray configurations, each once.
    pub configs: Vec<Config>,
    /// Image sizes, each once.
    pub sizes: Vec<Size>,
    /// Frames that each path is thinned to.
    pub frames: Option<usize>,
    /// Timed passes.
    pub passes: usize,
    /// Untimed frames before the first pass.
    pub warmup_frames: usize,
    /// Folder with the files of the catalogue's scenes.
    pub scenes_folder: Option<PathBuf>,
    /// What the preset names and this machine does not have, in words.
    pub skipped: Vec<String>,
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
        let scenes = if request.scenes.is_empty() {
            let mut scenes = Vec::new();
            for PresetScene { scene } in preset.scene {
                // What is absent is named, with where to get it, and left out; nothing takes its place.
                let entry = catalogue::find(scene.split(':').next().unwrap_or(&scene));
                match entry.map(|entry| entry.path_in(request.scenes_folder.as_deref())) {
                    Some(Err(absent)) => skipped.push(absent.to_string()),
                    _ => scenes.push(scene),
                }
            }
            scenes
        } else {
            request.scenes.clone()
        };
        if scenes.is_empty() {
            let problem = format!("none of the scenes of preset {} is here: {}", preset.name, skipped.join("; "));
            return Err(Error::argument("--preset", problem, "or name a scene with --scene"));
        }
        let or = |given: &[String], preset: &[String]| if given.is_empty() { preset.to_vec() } else { given.to_vec() };
        let frames = request.frames.or(preset.frames);
        let (passes, warmup_frames) =
            (request.passes.unwrap_or(preset.passes), request.warmup_frames.unwrap_or(preset.warmup_frames));
        for (flag, value, least) in
            [("--frames", frames.unwrap_or(1), 1), ("--passes", passes, 1), ("--warmup", warmup_frames, 0)]
        {
            if !(least..=MAX_REPEATS).contains(&value) {
                let mend = format!("give {least} to {MAX_REPEATS}");
                return Err(Error::argument(flag, format!("{value} is out of range"), mend));
            }
        }
        Ok(Plan {
            scenes,
            camera_path: request.camera_path.clone(),
            selections: parse_list(&or(&request.structures, &preset.structures), Selection::parse)?,
            configs: parse_list(&or(&request.configs, &preset.configs), parse_config)?,
            sizes: parse_list(&or(&request.resolutions, &preset.resolutions), parse_size)?,
            frames,
            passes,
            warmup_frames,
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
        self.sizes.iter().try_for_each(|&size| check_size(size, device))
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
        let rays_of = |what: &String| {
            let scene = self.load(what)?;
            let mut rays = 0;
            for &config in &self.configs {
                let path = self.path(&scene, config)?;
                for &size in &self.sizes {
                    rays += self.work(config, size, &path.views) * self.selections.len() as u64;
                }
            }
            Ok(rays)
        };
        self.scenes.iter().map(rays_of).collect()
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

    /// The camera path of a scene and a configuration.
    ///
    /// # Errors
    /// [`Error::Input`] of the path.
    pub fn path(&self, scene: &Scene, config: Config) -> Result<Path> {
        let path = match &self.camera_path {
            Some(name) => CameraPath::load(name)?,
            None => CameraPath::for_scene(scene, config),
        };
        let record = PathRecord { name: path.name.clone(), hash: path.content_hash() };
        Ok(Path { record, views: path.views(scene, self.frames)? })
    }

    /// Number of rows.
    pub fn configurations(&self) -> usize {
        self.scenes.len() * self.selections.len() * self.configs.len() * self.sizes.len()
    }

    /// For the provenance.
    pub fn record(&self) -> PlanRecord {
        PlanRecord {
            preset: self.preset.clone(),
            scenes: self.scenes.clone(),
            structures: self.selections.iter().map(|s| format!("{} ({})", s.name(), s.variant())).collect(),
            configurations: self.configurations(),
            passes: self.passes,
            warmup_frames: self.warmup_frames,
            skipped: self.skipped.clone(),
        }
    }
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
