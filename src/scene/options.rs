//! Options for reading scene files, common to all formats.

use super::{budget, did_you_mean};
use crate::error::{Error, Result};
use glam::DVec3;

/// Options for reading a file. A reader applies those that its format supports ([`super::FORMATS`]); [`super::load`]
/// applies [`Options::COMMON`].
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Time at which animated geometry is evaluated, in the file's units; `None` means the start of the animation.
    pub time: Option<f64>,
    /// Number of segments around a sphere, cone or other curved surface; `None` means the format's default.
    pub segments: Option<u32>,
    /// False if the cones of a BART file are omitted, as in the thesis of 2009.
    pub cones: bool,
    /// True if files may include files outside of the scene's folder.
    pub outside: bool,
    /// The up axis of the file; in the loaded scene y is up.
    pub up: Up,
    /// Factor on all lengths, applied last.
    pub scale: f32,
    /// Name of the camera to use: in BART files of the viewer's keyframes, in glTF files of the camera or its node.
    /// `None` means `camera` in BART files and the first camera in glTF files.
    pub camera: Option<String>,
    /// Vertical field of view in degrees that overrides that of the file's camera.
    pub fov: Option<f32>,
    /// The point of the file that is the origin while the scene is in memory.
    pub origin: Origin,
    /// The vector that readers subtract from every position, in the file's coordinates; `None` means zero, and that a
    /// cache keeps its placement. [`super::load`] derives it from `origin`.
    pub offset: Option<DVec3>,
    /// OBJ: name of a material to treat as emissive, for files of which the exporter has lost the emission.
    pub lamp: Option<String>,
    /// Memory in bytes that what a file repeats may take; `None` means half of the memory that the process may use. It
    /// changes nothing in a scene and is no part of its name.
    pub memory: Option<usize>,
}

/// The axis of a file that points up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Up {
    /// The scene is loaded as it is.
    #[default]
    Y,
    /// (x, y, z) becomes (x, z, -y); most MGF and CAD files have z up.
    Z,
}

/// The choice of the origin of a scene in memory, see [`super::Placement`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Origin {
    /// The origin is moved into the scene if coordinates exceed [`super::placement::FAR`] diagonals of the scene;
    /// otherwise it is the file's.
    #[default]
    Auto,
    /// The origin is always the file's.
    Keep,
    /// The origin is this point in the file's coordinates, before `up` and `scale`.
    At(DVec3),
}

impl Origin {
    /// Parses `auto`, `keep` or `x,y,z`.
    fn parse(value: &str) -> Option<Origin> {
        match value {
            "auto" => Some(Origin::Auto),
            "keep" => Some(Origin::Keep),
            _ => {
                let numbers: Vec<f64> = value.split(',').map(|x| x.trim().parse().ok()).collect::<Option<_>>()?;
                let sound = |x: &f64| x.abs() <= super::placement::MAX_COORDINATE;
                // Adding zero turns -0 into 0, so that both give the same origin.
                let point = |&[x, y, z]: &[f64; 3]| Origin::At(DVec3::new(x, y, z) + DVec3::ZERO);
                numbers.iter().all(sound).then(|| numbers.as_slice().try_into().ok().map(point))?
            }
        }
    }

    /// The value of [`Options::offset`] before the first reading of the file.
    fn offset(self) -> Option<DVec3> {
        match self {
            Origin::Auto => None,
            Origin::Keep => Some(DVec3::ZERO),
            Origin::At(point) => Some(point),
        }
    }
}

impl std::fmt::Display for Origin {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Origin::Auto => f.write_str("auto"),
            Origin::Keep => f.write_str("keep"),
            Origin::At(p) => write!(f, "{},{},{}", p.x, p.y, p.z),
        }
    }
}

/// Splits `key=value,...` into settings. A piece without a key continues a point, as in `origin=1,2,3`.
pub(super) fn settings(text: &str) -> Vec<String> {
    let mut settings: Vec<String> = Vec::new();
    for piece in text.split(',').filter(|piece| !piece.is_empty()) {
        match settings.last_mut() {
            Some(last) if !piece.contains('=') && last.starts_with("origin=") => *last += &format!(",{piece}"),
            _ => settings.push(piece.to_owned()),
        }
    }
    settings
}

impl Default for Options {
    fn default() -> Options {
        Options {
            time: None,
            segments: None,
            cones: true,
            outside: false,
            up: Up::Y,
            scale: 1.0,
            camera: None,
            fov: None,
            origin: Origin::Auto,
            offset: None,
            lamp: None,
            memory: None,
        }
    }
}

/// The largest number of segments of a curved surface.
pub const MAX_SEGMENTS: u32 = 1024;

impl Options {
    /// The names of all options.
    pub const KEYS: [&str; 11] =
        ["time", "segments", "cones", "outside", "up", "scale", "origin", "camera", "fov", "lamp", "memory"];

    /// The options that all formats support; [`super::FORMATS`] lists those of each format.
    pub const COMMON: [&str; 4] = ["up", "scale", "fov", "memory"];

    /// Parses `key=value,...`; errors refer to the scene `spec`.
    ///
    /// # Errors
    /// [`Error::Input`] for the first unknown key or bad value.
    pub fn parse(spec: &str, settings: &str) -> Result<Options> {
        let mut options = Options::default();
        for setting in self::settings(settings) {
            let (key, value) = setting.split_once('=').unwrap_or((&setting, ""));
            let wrong = |hint: &str| Error::argument(spec, format!("{key}: the value `{value}` is not valid"), hint);
            match key {
                "time" => match value.parse() {
                    Ok(time) if f64::is_finite(time) => options.time = Some(time),
                    _ => return Err(wrong("give a time of the file's animation, as in time=3")),
                },
                "segments" => match value.parse() {
                    Ok(segments) if (3..=MAX_SEGMENTS).contains(&segments) => options.segments = Some(segments),
                    _ => return Err(wrong("give 3 to 1024")),
                },
                "cones" => match value {
                    "yes" | "no" => options.cones = value == "yes",
                    _ => return Err(wrong("give yes or no")),
                },
                "outside" => match value {
                    "yes" | "no" => options.outside = value == "yes",
                    _ => return Err(wrong("give yes or no")),
                },
                "up" => match value {
                    "y" => options.up = Up::Y,
                    "z" => options.up = Up::Z,
                    _ => return Err(wrong("give y or z")),
                },
                "scale" => match value.parse() {
                    Ok(scale) if (1e-20..=1e20).contains(&scale) => options.scale = scale,
                    _ => return Err(wrong("give a positive number, 1e-20 to 1e20")),
                },
                "origin" => match Origin::parse(value) {
                    Some(origin) => (options.origin, options.offset) = (origin, origin.offset()),
                    None => return Err(wrong("give keep, auto, or a point of the file as x,y,z, up to 1e18")),
                },
                "fov" => match value.parse() {
                    Ok(fov) if (0.1..=179.0).contains(&fov) => options.fov = Some(fov),
                    _ => return Err(wrong("give 0.1 to 179 degrees")),
                },
                "memory" => match budget::size(value) {
                    Some(bytes) => options.memory = Some(bytes),
                    None => return Err(wrong("give a size, as in memory=64M or memory=2G")),
                },
                "camera" => match value {
                    "" => return Err(wrong("give the name of a camera")),
                    name => options.camera = Some(name.to_owned()),
                },
                "lamp" => match value {
                    "" => return Err(wrong("give the name of a material")),
                    name => options.lamp = Some(name.to_owned()),
                },
                _ => {
                    let problem = format!("scene files have no option `{key}`");
                    return Err(Error::argument(spec, problem, did_you_mean(key, &Self::KEYS)));
                }
            }
        }
        Ok(options)
    }

    /// Memory in bytes that what a file repeats may take.
    pub fn repeatable_bytes(&self) -> usize {
        self.memory.unwrap_or_else(|| budget::process_bytes() / 2)
    }

    /// The options that differ from those of `base` as `:key=value,...`; empty if none differs.
    pub(crate) fn suffix(&self, base: &Options) -> String {
        let mut set = Vec::new();
        let mut text = |key: &str, value: Option<String>| set.extend(value.map(|value| format!("{key}={value}")));
        let yes = |yes: bool| if yes { "yes".to_owned() } else { "no".to_owned() };
        text("time", self.time.filter(|_| self.time != base.time).map(|time| time.to_string()));
        text("segments", self.segments.filter(|_| self.segments != base.segments).map(|n| n.to_string()));
        text("cones", (self.cones != base.cones).then(|| yes(self.cones)));
        text("outside", (self.outside != base.outside).then(|| yes(self.outside)));
        let up = if self.up == Up::Z { "z" } else { "y" };
        text("up", (self.up != base.up).then(|| up.to_owned()));
        text("scale", (self.scale != base.scale).then(|| self.scale.to_string()));
        text("origin", (self.origin != base.origin).then(|| self.origin.to_string()));
        text("camera", self.camera.clone().filter(|_| self.camera != base.camera));
        text("fov", self.fov.filter(|_| self.fov != base.fov).map(|fov| fov.to_string()));
        text("lamp", self.lamp.clone().filter(|_| self.lamp != base.lamp));
        if set.is_empty() { String::new() } else { format!(":{}", set.join(",")) }
    }
}
