//! A camera path: the content of a path file, and the views that it gives in a scene.

use super::file;
use super::keyframes::KeyframePath;
use super::orbit::{LightOrbit, Orbit};
use super::recorded::{RecordedFrames, RecordedPose};
use super::{Camera, View};
use crate::error::{Error, Result};
use crate::guard;
use crate::math::Aabb;
use crate::names;
use crate::scene::{Light, Placement, Scene, SceneCamera, did_you_mean};
use glam::{DVec3, Vec3};

/// Name and text of the path files that are embedded in the program, so that it needs no files at run time.
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
    ("sponza-nave", include_str!("../../camera-paths/sponza-nave.toml")),
    ("sibenik", include_str!("../../camera-paths/sibenik.toml")),
    ("sphere", include_str!("../../camera-paths/sphere.toml")),
    ("box", include_str!("../../camera-paths/box.toml")),
    ("plane", include_str!("../../camera-paths/plane.toml")),
];

/// The file name by which errors refer to an embedded path.
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
    /// The embedded path's name, or that of the file's path, see [`names::of_file`].
    pub name: String,
    /// Description in the file, for listings; may be empty.
    pub description: String,
    /// Number of frames of the whole path.
    pub frames: usize,
    /// Vertical field of view in degrees.
    pub field_of_view: f32,
    /// The up vector; keys of a walk may override it.
    pub up: Vec3,
    pub(super) motion: Motion,
    /// Lights that replace the scene's; empty if the scene's are used.
    pub(super) lights: Vec<PathLight>,
    /// BLAKE3 of the text, hexadecimal.
    pub(super) hash: String,
    /// The file's path or the embedded path's name, by which errors refer to it.
    pub(super) place: String,
}

/// The kind of path: what moves, and along which curve.
#[derive(Clone, Debug)]
pub(super) enum Motion {
    Orbit(Orbit),
    LightOrbit(LightOrbit),
    Keyframes(KeyframePath),
    Recorded(RecordedFrames),
}

/// A light that the path file defines.
#[derive(Clone, Copy, Debug)]
pub(super) struct PathLight {
    /// Position in the coordinates of the scene's file, or in units of the bounds if `relative` is set.
    pub position: DVec3,
    pub colour: Vec3,
    /// True if the position is in units of the bounds, 0 to 1 per axis.
    pub relative: bool,
}

/// The coordinate systems of a scene; converts points of a path to the coordinates in memory.
#[derive(Clone, Copy)]
pub(super) struct SceneSpace {
    /// The box around the scene, in memory.
    pub bounds: Aabb,
    placement: Placement,
}

impl SceneSpace {
    fn of(scene: &Scene) -> SceneSpace {
        SceneSpace { bounds: scene.bounds(), placement: scene.placement }
    }

    /// The position in memory of a path's point, which is in units of the bounds (0 to 1 per axis) if `relative`, and
    /// in the file's coordinates otherwise.
    pub fn place(&self, point: DVec3, relative: bool) -> Vec3 {
        match relative {
            true => self.in_bounds(point.as_vec3()),
            false => self.placement.place(point),
        }
    }

    /// The position in memory of a point in units of the bounds.
    pub fn in_bounds(&self, relative: Vec3) -> Vec3 {
        self.bounds.min + self.bounds.extent() * relative
    }
}

impl CameraPath {
    /// Loads the path file of that name if it exists, otherwise the embedded path of that name.
    ///
    /// # Errors
    /// [`Error::Input`] if neither exists, or the file cannot be used.
    pub fn load(name_or_file: &str) -> Result<CameraPath> {
        let path = &*names::file(name_or_file);
        if path.is_file() {
            guard::read(path);
            let text = std::fs::read_to_string(path).map_err(|e| {
                Error::file(path, None, format!("cannot be read: {e}"), "it must be a text file in UTF-8")
            })?;
            return file::parse(&names::of_file(path), name_or_file, &text);
        }
        match EMBEDDED.iter().find(|(name, _)| *name == name_or_file) {
            Some((name, text)) => file::parse(name, &embedded_place(name), text),
            None => {
                let problem = "there is no file and no built-in camera path of this name";
                Err(Error::argument(name_or_file, problem, did_you_mean(name_or_file, &names())))
            }
        }
    }

    /// The path that the user names, otherwise [`CameraPath::for_scene`].
    ///
    /// # Errors
    /// Those of [`CameraPath::load`].
    pub fn named_or_fitting(name: Option<&str>, scene: &Scene, shadows: bool) -> Result<CameraPath> {
        name.map_or_else(|| Ok(CameraPath::for_scene(scene, shadows)), CameraPath::load)
    }

    /// The default path of a scene: the camera of the scene's file if it has one, otherwise the scene's `camera_path`,
    /// otherwise an orbit around the scene, as the thesis of 2009 measured single objects: the camera turns if there
    /// are no `shadows`, the light turns if there are.
    pub fn for_scene(scene: &Scene, shadows: bool) -> CameraPath {
        if let Some(camera) = scene.camera.as_ref().filter(|camera| !camera.frames.is_empty()) {
            return CameraPath::of_file(scene, camera);
        }
        let default = if shadows { "light-orbit" } else { "orbit" };
        let own = scene.camera_path.as_deref().and_then(|name| CameraPath::load(name).ok());
        own.unwrap_or_else(|| CameraPath::load(default).expect("an embedded path is sound: a test loads each"))
    }

    /// The camera of a scene's file as a path; a static camera gives one frame.
    fn of_file(scene: &Scene, camera: &SceneCamera) -> CameraPath {
        // The name without its options
        let name = scene.name.split(':').next().unwrap_or_default().to_owned();
        let description = format!("The camera of the scene file {name}");
        let text = super::to_placed_toml(&scene.placement, camera, &[], &description);
        let hash = blake3::hash(text.as_bytes()).to_hex().to_string();
        let poses = camera.frames.iter().map(|pose| RecordedPose::Placed(*pose)).collect();
        CameraPath {
            place: name.clone(),
            name,
            description,
            frames: camera.frames.len(),
            field_of_view: camera.field_of_view,
            up: Vec3::Y,
            motion: Motion::Recorded(RecordedFrames { poses }),
            lights: Vec::new(),
            hash,
        }
    }

    /// BLAKE3 of the file's text, hexadecimal.
    pub fn content_hash(&self) -> String {
        self.hash.clone()
    }

    /// The views of the path in this scene: all frames, or `frames` of them, evenly spaced. View `i` is the path's
    /// frame `round(i * all / frames)`, so that the first frame is always included. A static recorded camera gives one
    /// view for any number of `frames`.
    ///
    /// # Errors
    /// [`Error::Input`] if the path has fewer frames than requested, or its camera is not valid in this scene.
    pub fn views(&self, scene: &Scene, frames: Option<usize>) -> Result<Vec<View>> {
        let wanted = frames.map_or(self.frames, |frames| if self.is_static() { frames.min(1) } else { frames });
        if wanted == 0 || wanted > self.frames {
            return Err(Error::argument(
                &self.place,
                format!("{wanted} frames are requested, but the path has {}", self.frames),
                format!("take 1 to {} frames{}", self.frames, self.more_frames()),
            ));
        }
        let space = SceneSpace::of(scene);
        let bounds = space.bounds;
        if bounds.diagonal() <= 0.0 || bounds.is_empty() {
            let problem = format!("scene {} is a single point: no camera can look at it", scene.name);
            return Err(Error::argument(&self.place, problem, "give a scene with an extent"));
        }
        let frame = |i| self.thinned(i, wanted);
        match &self.motion {
            Motion::Orbit(orbit) => {
                let fitted = orbit.fit(scene, bounds, self.up, self.field_of_view);
                (0..wanted).map(|i| self.view(scene, space, frame(i), fitted.camera(self.share(frame(i))))).collect()
            }
            Motion::LightOrbit(orbit) => {
                let camera = orbit.camera.fit(scene, bounds, self.up, self.field_of_view).camera(0.0);
                let camera = Camera { position: scene.placement.snap(camera.position), ..camera };
                let light = |i| vec![orbit.light(bounds, self.up, self.share(frame(i)))];
                self.check_camera(frame(0), &camera)?;
                (0..wanted).map(|i| self.lit(frame(i), bounds, View { camera, lights: light(i) })).collect()
            }
            Motion::Recorded(recorded) => (0..wanted)
                .map(|i| self.view(scene, space, frame(i), recorded.camera(space, frame(i), self.field_of_view)))
                .collect(),
            Motion::Keyframes(keyframes) => (0..wanted)
                .map(|i| {
                    // The last frame shows the last key.
                    let share = frame(i) as f32 / (self.frames - 1).max(1) as f32;
                    let camera = keyframes.camera(space, self.up, self.field_of_view, share);
                    self.view(scene, space, frame(i), camera)
                })
                .collect(),
        }
    }

    /// Part of the hint for a path with too few frames: a file of the user can be given more, an embedded path cannot.
    fn more_frames(&self) -> &'static str {
        let embedded = EMBEDDED.iter().any(|(name, _)| self.place == embedded_place(name));
        match &self.motion {
            _ if embedded || !names::file(&self.place).is_file() => "",
            Motion::Recorded(_) => ", or add poses to the file",
            _ => ", or raise `frames` in the file",
        }
    }

    fn is_static(&self) -> bool {
        matches!(&self.motion, Motion::Recorded(recorded) if recorded.poses.len() == 1)
    }

    /// The number in the whole path of frame `i` of `wanted`.
    fn thinned(&self, i: usize, wanted: usize) -> usize {
        (2 * i * self.frames + wanted) / (2 * wanted)
    }

    /// The time of frame `i` of `wanted`: the recorded one, or the frame's number in the whole path.
    pub(super) fn time(&self, i: usize, wanted: usize) -> f64 {
        let frame = self.thinned(i, wanted);
        match &self.motion {
            Motion::Recorded(recorded) => recorded.poses[frame].time(),
            _ => frame as f64,
        }
    }

    /// The share of the turn at a frame; the frame after the last would complete the turn.
    fn share(&self, frame: usize) -> f32 {
        frame as f32 / self.frames as f32
    }

    /// The view of a frame. The camera's position is rounded as an exported path would round it.
    fn view(&self, scene: &Scene, space: SceneSpace, frame: usize, camera: Camera) -> Result<View> {
        let camera = Camera { position: scene.placement.snap(camera.position), ..camera };
        self.check_camera(frame, &camera)?;
        self.lit(frame, space.bounds, View { camera, lights: self.lights_for(scene, space, &camera) })
    }

    /// True if the light moves from frame to frame, as in a light orbit.
    pub fn moves_light(&self) -> bool {
        matches!(self.motion, Motion::LightOrbit(_))
    }

    /// The static lights of the path file, placed in this scene.
    pub fn lights(&self, scene: &Scene) -> Vec<Light> {
        self.lights_in(SceneSpace::of(scene))
    }

    fn lights_in(&self, space: SceneSpace) -> Vec<Light> {
        let place = |l: &PathLight| space.placement.snap(space.place(l.position, l.relative));
        self.lights.iter().map(|l| Light::new(place(l), l.colour)).collect()
    }

    /// The path's lights, otherwise the scene's, otherwise the default light. The default light is white and moves with
    /// the camera: half the scene's radius above and a quarter of it to the left, so that the visible surfaces are lit.
    fn lights_for(&self, scene: &Scene, space: SceneSpace, camera: &Camera) -> Vec<Light> {
        if !self.lights.is_empty() {
            return self.lights_in(space);
        }
        if !scene.lights.is_empty() {
            return scene.lights.clone();
        }
        let radius = space.bounds.diagonal() * 0.5;
        let right = camera.direction.cross(camera.up).normalize();
        let up = right.cross(camera.direction);
        vec![Light::new(camera.position + (up * 0.5 - right * 0.25) * radius, Vec3::ONE)]
    }

    /// Refuses a light whose distance to the scene, or its square, is outside of the range of floats.
    fn lit(&self, frame: usize, bounds: Aabb, view: View) -> Result<View> {
        let unusable = |light: &Light| !light.position.distance_squared(bounds.center()).is_finite();
        match view.lights.iter().position(unusable) {
            None => Ok(view),
            Some(light) => {
                let problem =
                    format!("frame {frame}: light {light} is too far away from the scene for single precision");
                Err(Error::argument(&self.place, problem, "bring it closer to the scene"))
            }
        }
    }

    /// Refuses a camera without a valid direction or up vector, which interpolation of keys can produce.
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
