//! A camera path: what a file in `camera-paths/` says, fitted to a scene, frame by frame.

use super::file;
use super::orbit::{LightOrbit, Orbit};
use super::recorded::{Recorded, Recording};
use super::walk::Walk;
use super::{Camera, View};
use crate::error::{Error, Result};
use crate::math::Aabb;
use crate::scene::{Light, Placement, Scene, SceneCamera, did_you_mean};
use glam::{DVec3, Vec3};
use std::path::Path;

/// The files that are part of the program, so that it works wherever it stands. Name and text.
const EMBEDDED: &[(&str, &str)] = &[
    ("orbit", include_str!("../../camera-paths/orbit.toml")),
    ("light-orbit", include_str!("../../camera-paths/light-orbit.toml")),
    ("terrain", include_str!("../../camera-paths/terrain.toml")),
    ("sphereflake", include_str!("../../camera-paths/sphereflake.toml")),
    ("stadium", include_str!("../../camera-paths/stadium.toml")),
    ("hall", include_str!("../../camera-paths/hall.toml")),
    ("inside", include_str!("../../camera-paths/inside.toml")),
    ("room", include_str!("../../camera-paths/room.toml")),
    ("conference-obj", include_str!("../../camera-paths/conference-obj.toml")),
    ("sponza", include_str!("../../camera-paths/sponza.toml")),
];

/// Where an embedded path stands in errors.
fn embedded_place(name: &str) -> String {
    format!("camera-paths/{name}.toml")
}

/// The names of the embedded paths.
pub fn names() -> Vec<&'static str> {
    EMBEDDED.iter().map(|(name, _)| *name).collect()
}

/// Name, number of frames and description of the embedded paths.
pub fn descriptions() -> Vec<(String, usize, String)> {
    let paths = names().into_iter().filter_map(|name| CameraPath::load(name).ok());
    paths.map(|path| (path.name, path.frames, path.description)).collect()
}

/// A path as read from a file; [`CameraPath::views`] fits it to a scene.
#[derive(Clone, Debug)]
pub struct CameraPath {
    /// The embedded path's name, or the file's stem.
    pub name: String,
    /// For people.
    pub description: String,
    /// Number of frames of the whole path.
    pub frames: usize,
    /// Vertical field of view in degrees.
    pub field_of_view: f32,
    /// Roughly up; a walk's keys may have their own.
    pub up: Vec3,
    pub(super) kind: Kind,
    /// Lights that replace the scene's.
    pub(super) lights: Vec<PathLight>,
    /// BLAKE3 of the text, hexadecimal.
    pub(super) hash: String,
    /// File or name, for errors.
    pub(super) place: String,
}

/// What moves, and how.
#[derive(Clone, Debug)]
pub(super) enum Kind {
    Orbit(Orbit),
    LightOrbit(LightOrbit),
    Walk(Walk),
    Recorded(Recorded),
}

/// A light of the path's own.
#[derive(Clone, Copy, Debug)]
pub(super) struct PathLight {
    /// In the file's coordinates, unless it is relative.
    pub position: DVec3,
    pub colour: Vec3,
    /// True if the position is in units of the bounds, 0 to 1 per axis.
    pub relative: bool,
}

/// What a scene makes of a path's points.
#[derive(Clone, Copy)]
pub(super) struct Room {
    /// The box around the scene, in memory.
    pub bounds: Aabb,
    placement: Placement,
}

impl Room {
    fn of(scene: &Scene) -> Room {
        Room { bounds: scene.bounds(), placement: scene.placement }
    }

    /// Where a path's point lies in memory: it is in units of the bounds, 0 to 1 per axis, or in the file's
    /// coordinates.
    pub fn place(&self, point: DVec3, relative: bool) -> Vec3 {
        match relative {
            true => self.in_bounds(point.as_vec3()),
            false => self.placement.place(point),
        }
    }

    /// A point in units of the bounds.
    pub fn in_bounds(&self, relative: Vec3) -> Vec3 {
        self.bounds.min + self.bounds.extent() * relative
    }
}

impl CameraPath {
    /// A path file if one of that name exists, otherwise the embedded path of that name.
    ///
    /// # Errors
    /// [`Error::Input`] if there is neither, or the file cannot be used.
    pub fn load(name_or_file: &str) -> Result<CameraPath> {
        let path = Path::new(name_or_file);
        if path.is_file() {
            let text = std::fs::read_to_string(path).map_err(|e| {
                Error::file(path, None, format!("cannot be read: {e}"), "it must be a text file in UTF-8")
            })?;
            let name = path.file_stem().unwrap_or_default().to_string_lossy();
            return file::parse(&name, name_or_file, &text);
        }
        match EMBEDDED.iter().find(|(name, _)| *name == name_or_file) {
            Some((name, text)) => file::parse(name, &embedded_place(name), text),
            None => {
                let problem = "no file and no built-in camera path is called so";
                Err(Error::argument(name_or_file, problem, did_you_mean(name_or_file, &names())))
            }
        }
    }

    /// The path that the user names, or that fits the scene and rays with or without shadows.
    ///
    /// # Errors
    /// Those of [`CameraPath::load`].
    pub fn named_or_fitting(name: Option<&str>, scene: &Scene, shadows: bool) -> Result<CameraPath> {
        name.map_or_else(|| Ok(CameraPath::for_scene(scene, shadows)), CameraPath::load)
    }

    /// The path that fits the scene, and rays with or without `shadows`, if the user names none: the camera that the scene's file brings;
    /// the scene's own path; otherwise the thesis's method for single objects (SPEC section 8), the camera's turn for P
    /// and the light's turn where there are shadows.
    pub fn for_scene(scene: &Scene, shadows: bool) -> CameraPath {
        if let Some(camera) = scene.camera.as_ref().filter(|camera| !camera.frames.is_empty()) {
            return CameraPath::of_file(scene, camera);
        }
        let default = if shadows { "light-orbit" } else { "orbit" };
        let own = scene.camera_path.as_deref().and_then(|name| CameraPath::load(name).ok());
        own.unwrap_or_else(|| CameraPath::load(default).expect("an embedded path is sound: a test loads each"))
    }

    /// The camera that a scene's file brings. A still one is a path of one frame.
    fn of_file(scene: &Scene, camera: &SceneCamera) -> CameraPath {
        // Without the options that may stand behind the file's name
        let name = scene.name.split(':').next().unwrap_or_default().to_owned();
        let description = format!("The camera of the scene file {name}");
        let text = super::to_placed_toml(&scene.placement, camera, &[], &description);
        let hash = blake3::hash(text.as_bytes()).to_hex().to_string();
        let poses = camera.frames.iter().map(|pose| Recording::Placed(*pose)).collect();
        CameraPath {
            place: name.clone(),
            name,
            description,
            frames: camera.frames.len(),
            field_of_view: camera.field_of_view,
            up: Vec3::Y,
            kind: Kind::Recorded(Recorded { poses }),
            lights: Vec::new(),
            hash,
        }
    }

    /// BLAKE3 of the file's text, hexadecimal.
    pub fn content_hash(&self) -> String {
        self.hash.clone()
    }

    /// The frames of the path in this scene: all, or thinned evenly to `frames`, of which number i is the path's number
    /// `round(i * all / frames)`; the first is always there. A recorded camera that stands still has one frame, however
    /// many are wanted: more of the same would show nothing else.
    ///
    /// # Errors
    /// [`Error::Input`] if there are fewer frames than wanted, or the path does not work in this scene.
    pub fn views(&self, scene: &Scene, frames: Option<usize>) -> Result<Vec<View>> {
        let wanted = frames.map_or(self.frames, |frames| if self.stands_still() { frames.min(1) } else { frames });
        if wanted == 0 || wanted > self.frames {
            return Err(Error::argument(
                &self.place,
                format!("{wanted} frames wanted, but the path has {}", self.frames),
                format!("take 1 to {} frames{}", self.frames, self.more_frames()),
            ));
        }
        let room = Room::of(scene);
        let bounds = room.bounds;
        if bounds.diagonal() <= 0.0 || bounds.is_empty() {
            let problem = format!("scene {} is a single point: no camera can look at it", scene.name);
            return Err(Error::argument(&self.place, problem, "give a scene with an extent"));
        }
        let frame = |i| self.thinned(i, wanted);
        match &self.kind {
            Kind::Orbit(orbit) => {
                let fitted = orbit.fit(scene, bounds, self.up, self.field_of_view);
                (0..wanted).map(|i| self.view(scene, room, frame(i), fitted.camera(self.share(frame(i))))).collect()
            }
            Kind::LightOrbit(orbit) => {
                let camera = orbit.camera.fit(scene, bounds, self.up, self.field_of_view).camera(0.0);
                let camera = Camera { position: scene.placement.snap(camera.position), ..camera };
                let light = |i| vec![orbit.light(bounds, self.up, self.share(frame(i)))];
                self.check_camera(frame(0), &camera)?;
                Ok((0..wanted).map(|i| View { camera, lights: light(i) }).collect())
            }
            Kind::Recorded(recorded) => (0..wanted)
                .map(|i| self.view(scene, room, frame(i), recorded.camera(room, frame(i), self.field_of_view)))
                .collect(),
            Kind::Walk(walk) => (0..wanted)
                .map(|i| {
                    // The last frame stands at the last key.
                    let share = frame(i) as f32 / (self.frames - 1).max(1) as f32;
                    let camera = walk.camera(room, self.up, self.field_of_view, share);
                    self.view(scene, room, frame(i), camera)
                })
                .collect(),
        }
    }

    /// What else helps where a path has too few frames. Only a file of the user's own can be given more.
    fn more_frames(&self) -> &'static str {
        let embedded = EMBEDDED.iter().any(|(name, _)| self.place == embedded_place(name));
        match &self.kind {
            _ if embedded || !Path::new(&self.place).is_file() => "",
            Kind::Recorded(_) => ", or add poses to the file",
            _ => ", or raise `frames` in the file",
        }
    }

    fn stands_still(&self) -> bool {
        matches!(&self.kind, Kind::Recorded(recorded) if recorded.poses.len() == 1)
    }

    /// The path's frame that is number `i` of `wanted`.
    fn thinned(&self, i: usize, wanted: usize) -> usize {
        (2 * i * self.frames + wanted) / (2 * wanted)
    }

    /// The time of frame `i` of `wanted`: the recorded one, or the frame's number in the whole path.
    pub(super) fn time(&self, i: usize, wanted: usize) -> f64 {
        let frame = self.thinned(i, wanted);
        match &self.kind {
            Kind::Recorded(recorded) => recorded.poses[frame].time(),
            _ => frame as f64,
        }
    }

    /// The share of the turn at a frame: a full turn after the last.
    fn share(&self, frame: usize) -> f32 {
        frame as f32 / self.frames as f32
    }

    /// What a frame shows. The camera's position is rounded as an exported path would round it.
    fn view(&self, scene: &Scene, room: Room, frame: usize, camera: Camera) -> Result<View> {
        let camera = Camera { position: scene.placement.snap(camera.position), ..camera };
        self.check_camera(frame, &camera)?;
        Ok(View { camera, lights: self.lights_for(scene, room, &camera) })
    }

    /// True if each frame has a light of its own, as a light orbit's have.
    pub fn moves_light(&self) -> bool {
        matches!(self.kind, Kind::LightOrbit(_))
    }

    /// The path's own lights that stand still, in this scene.
    pub fn lights(&self, scene: &Scene) -> Vec<Light> {
        self.lights_in(Room::of(scene))
    }

    fn lights_in(&self, room: Room) -> Vec<Light> {
        let place = |l: &PathLight| room.placement.snap(room.place(l.position, l.relative));
        self.lights.iter().map(|l| Light::new(place(l), l.colour)).collect()
    }

    /// The path's lights, or the scene's, or the default light: white, half the scene's radius above and a quarter to the
    /// left of the camera, and moving with it, so that what is seen is lit.
    fn lights_for(&self, scene: &Scene, room: Room, camera: &Camera) -> Vec<Light> {
        if !self.lights.is_empty() {
            return self.lights_in(room);
        }
        if !scene.lights.is_empty() {
            return scene.lights.clone();
        }
        let radius = room.bounds.diagonal() * 0.5;
        let right = camera.direction.cross(camera.up).normalize();
        let up = right.cross(camera.direction);
        vec![Light::new(camera.position + (up * 0.5 - right * 0.25) * radius, Vec3::ONE)]
    }

    /// Interpolation may bring a camera where it cannot look.
    fn check_camera(&self, frame: usize, camera: &Camera) -> Result<()> {
        let fault = |problem: &str, hint: &str| {
            Err(Error::argument(&self.place, format!("frame {frame}: {problem}"), hint.to_owned()))
        };
        if !camera.position.is_finite() {
            return fault("the camera's position is not finite", "bring the keys closer to the scene");
        }
        if !camera.direction.is_normalized() {
            return fault("the camera has no direction", "move its target away from it, or add a key there");
        }
        if camera.direction.cross(camera.up).length() < 1e-3 * camera.up.length() || camera.up == Vec3::ZERO {
            return fault("the camera looks along its up vector", "give the keys near it another `up`");
        }
        Ok(())
    }
}
