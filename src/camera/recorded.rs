//! Recorded frames: a camera pose for each frame, read from scene files and path files, and exported as TOML and CSV.

use super::path::SceneSpace;
use super::{Camera, CameraPath, View};
use crate::error::Result;
use crate::scene::{Light, Placement, Pose, Scene, SceneCamera};
use glam::{DVec3, Vec3};
use std::fmt::Write;

/// A path with a recorded pose for each frame.
#[derive(Clone, Debug)]
pub(super) struct RecordedFrames {
    pub poses: Vec<RecordedPose>,
}

/// The camera's pose in one frame.
#[derive(Clone, Copy, Debug)]
pub(super) enum RecordedPose {
    /// A pose in the scene's coordinates in memory.
    Placed(Pose),
    /// A pose in the coordinates of the scene's file.
    InFile { position: DVec3, time: f64, direction: Vec3, up: Vec3 },
}

impl RecordedPose {
    pub fn time(&self) -> f64 {
        match self {
            RecordedPose::Placed(Pose { time, .. }) | RecordedPose::InFile { time, .. } => *time,
        }
    }
}

impl RecordedFrames {
    pub fn camera(&self, space: SceneSpace, frame: usize, field_of_view: f32) -> Camera {
        match self.poses[frame] {
            RecordedPose::Placed(Pose { position, direction, up, .. }) => {
                Camera { position, direction, up, field_of_view }
            }
            RecordedPose::InFile { position, direction, up, .. } => {
                Camera { position: space.place(position, false), direction, up, field_of_view }
            }
        }
    }
}

/// The columns of a recorded frame; in CSV the frame's number precedes them.
const COLUMNS: [&str; 10] = ["time", "pos_x", "pos_y", "pos_z", "dir_x", "dir_y", "dir_z", "up_x", "up_y", "up_z"];

/// The position in the file's coordinates, and the components of direction and up.
fn numbers(placement: &Placement, pose: &Pose) -> ([f64; 3], [f32; 6]) {
    let Pose { position, direction: d, up: u, .. } = *pose;
    (placement.coordinates(position), [d.x, d.y, d.z, u.x, u.y, u.z])
}

impl CameraPath {
    /// The path's frames in this scene as poses. If the path has no recorded times, a frame's time is its number.
    ///
    /// # Errors
    /// As [`CameraPath::views`].
    pub fn poses(&self, scene: &Scene, frames: Option<usize>) -> Result<SceneCamera> {
        let views = self.views(scene, frames)?;
        let pose = |(i, view): (usize, &View)| {
            let Camera { position, direction, up, .. } = view.camera;
            Pose { time: self.time(i, views.len()), position, direction, up }
        };
        let poses = views.iter().enumerate().map(pose).collect();
        Ok(SceneCamera { field_of_view: self.field_of_view, frames: poses })
    }
}

/// The text of a camera path file with recorded frames and `lights`. Numbers have enough digits that the file gives the
/// same views, to the bit.
pub fn to_toml(camera: &SceneCamera, lights: &[Light], description: &str) -> String {
    to_placed_toml(&Placement::IDENTITY, camera, lights, description)
}

/// Like [`to_toml`], with all positions converted to the coordinates of the scene's file.
pub fn to_placed_toml(placement: &Placement, camera: &SceneCamera, lights: &[Light], description: &str) -> String {
    let description = toml::Value::from(description);
    let mut text = format!("description = {description}\nkind = \"frames\"\n");
    let _ = writeln!(text, "field_of_view = {:?}", camera.field_of_view);
    let _ = writeln!(text, "# {}", COLUMNS.join(" "));
    text += "poses = [\n";
    for pose in &camera.frames {
        let _ = write!(text, "  [{:?}", pose.time);
        let (position, vectors) = numbers(placement, pose);
        position.iter().for_each(|number| _ = write!(text, ", {number:?}"));
        vectors.iter().for_each(|number| _ = write!(text, ", {number:?}"));
        text += "],\n";
    }
    text += "]\n";
    for Light { position, colour: c, .. } in lights {
        let [x, y, z] = placement.coordinates(*position);
        let _ = writeln!(text, "[[lights]]\nposition = [{x:?}, {y:?}, {z:?}]");
        let _ = writeln!(text, "colour = [{:?}, {:?}, {:?}]", c.x, c.y, c.z);
    }
    text
}

/// Recorded frames as CSV; a row is number, time, position, direction and up of a frame.
pub fn to_csv(camera: &SceneCamera) -> String {
    to_placed_csv(&Placement::IDENTITY, camera)
}

/// Like [`to_csv`], with positions converted to the coordinates of the scene's file.
pub fn to_placed_csv(placement: &Placement, camera: &SceneCamera) -> String {
    let mut text = format!("frame,{}\n", COLUMNS.join(","));
    for (frame, pose) in camera.frames.iter().enumerate() {
        let _ = write!(text, "{frame},{}", pose.time);
        let (position, vectors) = numbers(placement, pose);
        position.iter().for_each(|number| _ = write!(text, ",{number}"));
        vectors.iter().for_each(|number| _ = write!(text, ",{number}"));
        text.push('\n');
    }
    text
}
