//! What may be chosen when a file is read: the same few options for every format.

use super::did_you_mean;
use crate::error::{Error, Result};
use glam::DVec3;

/// How a file is to be read. A reader heeds what means something in its format; [`super::load`] applies the rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// The moment, in the file's time, at which moving geometry is frozen; `None`: where its animation begins.
    pub time: Option<f64>,
    /// Segments around a sphere, cone or other curved surface; `None`: the format's default.
    pub segments: Option<u32>,
    /// False if a BART file's cones are to be left out, as the thesis did.
    pub cones: bool,
    /// True if includes may leave the folder of the file that is named.
    pub outside: bool,
    /// Which way is up in the file; the loaded scene's up is y.
    pub up: Up,
    /// Factor on all lengths, applied last.
    pub scale: f32,
    /// Name of the camera among the file's: for BART of the keyframes that move the viewer, for glTF of the camera or its
    /// node. `None`: BART's `camera`, glTF's first.
    pub camera: Option<String>,
    /// Field of view in degrees for the file's camera, instead of the file's own.
    pub fov: Option<f32>,
    /// Where the origin is put while the scene is in memory.
    pub origin: Origin,
    /// What readers subtract from every position, in the file's coordinates; `None`: nothing, and a cache stays where
    /// it is. [`super::load`] sets it by `origin`.
    pub offset: Option<DVec3>,
    /// OBJ: the material that shines although the file does not say so (exporters lose it); its faces become lights.
    pub lamp: Option<String>,
}

/// An axis that points up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Up {
    /// Nothing to do.
    #[default]
    Y,
    /// As in most of MGF and in CAD: (x, y, z) becomes (x, z, -y).
    Z,
}

/// Where the origin is put while a scene is in memory, see [`super::Placement`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Origin {
    /// Into the scene, if its coordinates are larger than [`super::placement::FAR`] diagonals; otherwise where the
    /// file has it.
    #[default]
    Auto,
    /// Where the file has it, however far that is.
    Keep,
    /// At a point of the file, before `up` and `scale`.
    At(DVec3),
}

impl Origin {
    /// Reads `auto`, `keep` or `x,y,z`.
    fn parse(value: &str) -> Option<Origin> {
        match value {
            "auto" => Some(Origin::Auto),
            "keep" => Some(Origin::Keep),
            _ => {
                let numbers: Vec<f64> = value.split(',').map(|x| x.trim().parse().ok()).collect::<Option<_>>()?;
                let sound = |x: &f64| x.abs() <= super::placement::MAX_COORDINATE;
                // Adding zero makes -0 and 0 the same origin
                let point = |&[x, y, z]: &[f64; 3]| Origin::At(DVec3::new(x, y, z) + DVec3::ZERO);
                numbers.iter().all(sound).then(|| numbers.as_slice().try_into().ok().map(point))?
            }
        }
    }

    /// What readers are to subtract, as far as it is known before anything has been read.
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

/// The settings in `key=value,...`. A piece without a key belongs to the one before it if that is a point.
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
        }
    }
}

/// Most segments of a curved surface.
pub const MAX_SEGMENTS: u32 = 1024;

impl Options {
    /// The names of all options.
    pub const KEYS: [&str; 10] =
        ["time", "segments", "cones", "outside", "up", "scale", "origin", "camera", "fov", "lamp"];

    /// Those that every file takes; a file's format may heed more ([`super::FORMATS`]).
    pub const COMMON: [&str; 3] = ["up", "scale", "fov"];

    /// Reads `key=value,...`; `what` stands in errors.
    ///
    /// # Errors
    /// [`Error::Input`] for the first unknown key or bad value.
    pub fn parse(what: &str, settings: &str) -> Result<Options> {
        let mut options = Options::default();
        for setting in self::settings(settings) {
            let (key, value) = setting.split_once('=').unwrap_or((&setting, ""));
            let wrong = |hint: &str| Error::argument(what, format!("{key}: `{value}` does not do"), hint);
            match key {
                "time" => match value.parse() {
                    Ok(time) if f64::is_finite(time) => options.time = Some(time),
                    _ => return Err(wrong("give a moment of the file's animation, as time=3")),
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
                    return Err(Error::argument(what, problem, did_you_mean(key, &Self::KEYS)));
                }
            }
        }
        Ok(options)
    }

    /// The options that differ from those of `base`, `:key=value,...`, or nothing.
    pub fn suffix(&self, base: &Options) -> String {
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
