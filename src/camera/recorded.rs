//! Recorded frames: where the camera was at each of them. What scene files bring, and what is written for others to read.

use super::path::Room;
use super::{Camera, CameraPath, View};
use crate::error::Result;
use crate::scene::{Light, Placement, Pose, Scene, SceneCamera};
use glam::{DVec3, Vec3};
use std::fmt::Write;

/// A camera per frame.
#[derive(Clone, Debug)]
pub(super) struct Recorded {
    pub poses: Vec<Recording>,
}

/// Where the camera was at a frame.
#[derive(Clone, Copy, Debug)]
pub(super) enum Recording {
    /// In a scene as it lies in memory.
    Placed(Pose),
    /// At a point of the file's coordinates.
    InFile { position: DVec3, time: f64, direction: Vec3, up: Vec3 },
}

impl Recording {
    pub fn time(&self) -> f64 {
        match self {
            Recording::Placed(Pose { time, .. }) | Recording::InFile { time, .. } => *time,
        }
    }
}

impl Recorded {
    /// The camera at a frame.
    pub fn camera(&self, room: Room, frame: usize, field_of_view: f32) -> Camera {
        match self.poses[frame] {
            Recording::Placed(Pose { position, direction, up, .. }) => {
                Camera { position, direction, up, field_of_view }
            }
            Recording::InFile { position, direction, up, .. } => {
                Camera { position: room.place(position, false), direction, up, field_of_view }
            }
        }
    }
}

/// The columns of a recorded frame; in CSV the frame's number stands before them.
const COLUMNS: [&str; 10] = ["time", "pos_x", "pos_y", "pos_z", "dir_x", "dir_y", "dir_z", "up_x", "up_y", "up_z"];

/// The position in the file's coordinates; direction and up.
fn numbers(placement: &Placement, pose: &Pose) -> ([f64; 3], [f32; 6]) {
    let Pose { position, direction: d, up: u, .. } = *pose;
    (placement.coordinates(position), [d.x, d.y, d.z, u.x, u.y, u.z])
}

impl CameraPath {
    /// The path's frames in this scene as poses; where the path has no times of its own, a frame's time is its number.
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

/// A camera path file of recorded frames, and of the path's own lights if it has some. It gives the same views again, to
/// the bit: numbers are written with as many digits as it takes.
pub fn to_toml(camera: &SceneCamera, lights: &[Light], description: &str) -> String {
    to_placed_toml(&Placement::IDENTITY, camera, lights, description)
}

/// The same for a scene that does not lie in memory as in its file: written are the file's coordinates.
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

/// Recorded frames as CSV, a row for each: its number, its time, position, direction and up.
pub fn to_csv(camera: &SceneCamera) -> String {
    to_placed_csv(&Placement::IDENTITY, camera)
}

/// The same in the coordinates of a scene's file.
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
