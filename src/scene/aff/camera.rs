//! The camera: the viewpoint `v`, the keyframes named `camera`, and the frames of the animation `a`.

use super::keys::Keyframes;
use super::loose;
use crate::scene::text::{Fault, Tokenizer};
use crate::scene::{Pose, SceneCamera};
use glam::DVec3;

/// The largest number of frames of an animation.
const MAX_FRAMES: i64 = 100_000;

/// The entity `v`: the viewpoint.
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
    /// Reads the parameters of `v`: its keywords in any order; all of them are optional. The inner result is the
    /// problem of a viewpoint that is not usable.
    ///
    /// # Errors
    /// None: what is malformed is the inner result.
    pub fn read(tokens: &mut Tokenizer) -> Result<Result<Viewpoint, Fault>, Fault> {
        let (mut view, mut problem) = (Viewpoint::default(), None);
        loop {
            let (keyword, wanted) = match tokens.peek().unwrap_or_default() {
                b"from" => ("from", 3),
                b"at" => ("at", 3),
                b"up" => ("up", 3),
                b"angle" => ("angle", 1),
                b"hither" => ("hither", 1),
                b"resolution" => ("resolution", 2),
                _ => break,
            };
            tokens.skip(1, "v")?;
            let line = tokens.line();
            let (mut numbers, mut given) = ([0.0; 3], 0);
            while given < wanted {
                let ([number], 1) = loose::numbers(tokens, "v")? else { break };
                numbers[given] = number;
                given += 1;
            }
            // A word in place of a number is no entity, even if it is spelled like one.
            for _ in given..wanted {
                if tokens.peek_on_line().is_some_and(|word| !loose::ends_view(word)) {
                    tokens.skip(1, "v")?;
                }
            }
            let rest = loose::skip_words(tokens)?;
            let fault = match keyword {
                _ if given < wanted || rest.is_some() => Some(format!("{keyword}: it is not {wanted} numbers")),
                "hither" | "resolution" => None,
                _ if numbers.iter().any(|number| !(*number as f32).is_finite()) => {
                    Some("the viewpoint is not finite".into())
                }
                "angle" if !(numbers[0] > 0.0 && numbers[0] < 180.0) => {
                    Some(format!("the field of view of {} degrees is not between 0 and 180", numbers[0]))
                }
                _ => None,
            };
            if let Some(text) = fault {
                problem.get_or_insert_with(|| Fault::new(Some(line), format!("v: {text}"), ""));
            }
            match keyword {
                "from" => view.from = numbers.into(),
                "at" => view.at = numbers.into(),
                "up" => view.up = numbers.into(),
                "angle" => view.angle = numbers[0],
                _ => {}
            }
        }
        Ok(problem.map_or(Ok(view), Err))
    }
}

/// The entity `a`: time span and number of frames of the animation.
#[derive(Clone, Copy)]
pub struct Animation {
    pub start: f64,
    end: f64,
    frames: usize,
}

impl Animation {
    /// Reads the parameters of `a`.
    pub fn read(tokens: &mut Tokenizer) -> Result<Animation, Fault> {
        let [start, end] = tokens.numbers("a")?;
        let frames = tokens.integer("a")?;
        if !(1..=MAX_FRAMES).contains(&frames) {
            let problem = format!("the animation has {frames} frames");
            return Err(tokens.fault(problem, format!("give 1 to {MAX_FRAMES}")));
        }
        Ok(Animation { start, end, frames: frames as usize })
    }

    fn times(&self) -> impl Iterator<Item = f64> {
        let Animation { start, end, frames } = *self;
        (0..frames).map(move |i| start + (end - start) * i as f64 / (frames - 1).max(1) as f64)
    }
}

/// The scene's camera, with a pose per frame if it is animated and a single pose otherwise. `None` if there is no
/// viewpoint, or it has no direction. `offset` is the point of the file that is the origin in memory.
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

/// A pose; an up vector parallel to the direction is replaced by a perpendicular vector.
fn pose(time: f64, position: DVec3, direction: DVec3, up: DVec3) -> Pose {
    let up = up.normalize_or_zero();
    let up = if up.cross(direction).length() > 2e-3 { up } else { direction.any_orthonormal_vector() };
    Pose { time, position: position.as_vec3(), direction: direction.as_vec3(), up: up.as_vec3() }
}
