//! Recorded frames: where the camera was at each of them. What scene files bring, and what is written for others to read.

use super::{Camera, CameraPath, View};
use crate::error::Result;
use crate::scene::{Light, Pose, Scene, SceneCamera};
use std::fmt::Write;

/// A camera per frame.
#[derive(Clone, Debug)]
pub(super) struct Recorded {
    pub poses: Vec<Pose>,
}

impl Recorded {
    /// The camera at a frame.
    pub fn camera(&self, frame: usize, field_of_view: f32) -> Camera {
        let Pose { position, direction, up, .. } = self.poses[frame];
        Camera { position, direction, up, field_of_view }
    }
}

/// The columns of a recorded frame; in CSV the frame's number stands before them.
const COLUMNS: [&str; 10] = ["time", "pos_x", "pos_y", "pos_z", "dir_x", "dir_y", "dir_z", "up_x", "up_y", "up_z"];

fn numbers(pose: &Pose) -> [f32; 9] {
    let Pose { position: p, direction: d, up: u, .. } = *pose;
    [p.x, p.y, p.z, d.x, d.y, d.z, u.x, u.y, u.z]
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
    let description = toml::Value::from(description);
    let mut text = format!("description = {description}\nkind = \"frames\"\n");
    let _ = writeln!(text, "field_of_view = {:?}", camera.field_of_view);
    let _ = writeln!(text, "# {}", COLUMNS.join(" "));
    text += "poses = [\n";
    for pose in &camera.frames {
        let _ = write!(text, "  [{:?}", pose.time);
        for number in numbers(pose) {
            let _ = write!(text, ", {number:?}");
        }
        text += "],\n";
    }
    text += "]\n";
    for Light { position: p, colour: c, .. } in lights {
        let _ = writeln!(text, "[[lights]]\nposition = [{:?}, {:?}, {:?}]", p.x, p.y, p.z);
        let _ = writeln!(text, "colour = [{:?}, {:?}, {:?}]", c.x, c.y, c.z);
    }
    text
}

/// Recorded frames as CSV, a row for each: its number, its time, position, direction and up.
pub fn to_csv(camera: &SceneCamera) -> String {
    let mut text = format!("frame,{}\n", COLUMNS.join(","));
    for (frame, pose) in camera.frames.iter().enumerate() {
        let _ = write!(text, "{frame},{}", pose.time);
        for number in numbers(pose) {
            let _ = write!(text, ",{number}");
        }
        text.push('\n');
    }
    text
}
