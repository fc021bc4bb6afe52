//! The viewer: `v`, the keyframes called `camera`, and the frames of `a`.

use super::keys::Keyframes;
use crate::scene::text::{Fault, Words};
use crate::scene::{Pose, SceneCamera};
use glam::DVec3;

/// Most frames of an animation.
const MAX_FRAMES: i64 = 100_000;

/// `v`.
#[derive(Clone, Copy)]
pub struct Viewpoint {
    from: DVec3,
    at: DVec3,
    up: DVec3,
    /// Vertical field of view in degrees.
    angle: f64,
}

impl Default for Viewpoint {
    fn default() -> Viewpoint {
        Viewpoint { from: DVec3::ZERO, at: DVec3::NEG_Z, up: DVec3::Y, angle: 45.0 }
    }
}

impl Viewpoint {
    /// Reads what follows `v`: its keywords in any order, each of them once or not at all.
    pub fn read(words: &mut Words) -> Result<Viewpoint, Fault> {
        let mut view = Viewpoint::default();
        loop {
            let keyword = words.peek().unwrap_or_default();
            let vector = match keyword {
                b"from" => &mut view.from,
                b"at" => &mut view.at,
                b"up" => &mut view.up,
                b"angle" => {
                    words.skip(1, "v")?;
                    view.angle = words.number("angle")?;
                    if !(view.angle > 0.0 && view.angle < 180.0) {
                        let problem = format!("the field of view of {} degrees is impossible", view.angle);
                        return Err(words.fault(problem, "give an angle between 0 and 180"));
                    }
                    continue;
                }
                b"hither" | b"resolution" => {
                    words.skip(1, "v")?;
                    words.number("v")?;
                    if keyword == b"resolution" {
                        words.number("v")?;
                    }
                    continue;
                }
                _ => return Ok(view),
            };
            words.skip(1, "v")?;
            *vector = words.numbers("v").map(DVec3::from)?;
        }
    }
}

/// `a`.
#[derive(Clone, Copy)]
pub struct Animation {
    pub start: f64,
    end: f64,
    frames: usize,
}

impl Animation {
    /// Reads what follows `a`.
    pub fn read(words: &mut Words) -> Result<Animation, Fault> {
        let [start, end] = words.numbers("a")?;
        let frames = words.integer("a")?;
        if !(1..=MAX_FRAMES).contains(&frames) {
            let problem = format!("an animation of {frames} frames");
            return Err(words.fault(problem, format!("give 1 to {MAX_FRAMES}")));
        }
        Ok(Animation { start, end, frames: frames as usize })
    }

    fn times(&self) -> impl Iterator<Item = f64> {
        let Animation { start, end, frames } = *self;
        (0..frames).map(move |i| start + (end - start) * i as f64 / (frames - 1).max(1) as f64)
    }
}

/// The scene's camera: a pose per frame if it is animated, one if it stands still. `None` if there is no viewpoint, or
/// it looks nowhere. `offset` is the point of the file that is the origin in memory.
pub fn camera(
    view: Option<&Viewpoint>,
    keys: Option<&Keyframes>,
    animation: Option<&Animation>,
    time: f64,
    offset: DVec3,
) -> Option<SceneCamera> {
    let field_of_view = view.copied().unwrap_or_default().angle as f32;
    let Some(keys) = keys else {
        let view = view?;
        let direction = (view.at - view.from).normalize_or_zero();
        if direction == DVec3::ZERO {
            return None;
        }
        let pose = pose(time, view.from - offset, direction, view.up);
        return Some(SceneCamera { field_of_view, frames: vec![pose] });
    };
    let frame = |time: f64| {
        let turn = keys.rotation(time);
        pose(time, keys.transform(time).translation - offset, turn * DVec3::NEG_Z, turn * DVec3::Y)
    };
    let frames = animation.map_or_else(|| vec![frame(time)], |animation| animation.times().map(frame).collect());
    Some(SceneCamera { field_of_view, frames })
}

/// A pose; an up vector along the direction is replaced by another.
fn pose(time: f64, position: DVec3, direction: DVec3, up: DVec3) -> Pose {
    let up = up.normalize_or_zero();
    let up = if up.cross(direction).length() > 2e-3 { up } else { direction.any_orthonormal_vector() };
    Pose { time, position: position.as_vec3(), direction: direction.as_vec3(), up: up.as_vec3() }
}
