//! A walk (`kind = "walk"`): keyframes with times, interpolated by Catmull-Rom splines.

use super::Camera;
use super::path::SceneSpace;
use glam::{DVec3, Vec3};

/// A keyframe: the camera at one time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Key {
    /// Time in any unit; the path's frames are evenly spaced from the first key's time to the last key's.
    pub time: f32,
    /// Position in the file's coordinates, or in units of the bounds if the walk is relative.
    pub position: DVec3,
    pub aim: Aim,
    /// Overrides the path's up vector.
    pub up: Option<Vec3>,
}

/// The two ways in which a key defines the camera's direction.
#[derive(Clone, Copy, Debug)]
pub(super) enum Aim {
    /// The camera looks at this point, which is in the same coordinates as the key's position.
    Target(DVec3),
    /// The camera looks along this vector.
    Direction(Vec3),
}

/// At least two keys, in order of time.
#[derive(Clone, Debug)]
pub(super) struct KeyframePath {
    pub keys: Vec<Key>,
    /// True if positions and targets are in units of the bounds, 0 to 1 per axis. It does not concern directions.
    pub relative: bool,
}

impl KeyframePath {
    /// The camera after a share of the time from the first key to the last, 0 to 1.
    ///
    /// If all keys have targets, the target is interpolated, so that a camera that circles a point keeps looking at it;
    /// otherwise the direction is interpolated.
    pub fn camera(&self, space: SceneSpace, up: Vec3, field_of_view: f32, share: f32) -> Camera {
        // Relative positions are interpolated in units of the bounds and then converted.
        let value = |p: DVec3| if self.relative { p.as_vec3() } else { space.place(p, false) };
        let point = |value: Vec3| if self.relative { space.in_bounds(value) } else { value };
        let place = |p: DVec3| space.place(p, self.relative);
        let (first, last) = (self.keys[0].time, self.keys[self.keys.len() - 1].time);
        let time = first + (last - first) * share;

        let position = point(self.interpolate(time, |k| value(k.position)));
        let target = |k: &Key| match k.aim {
            Aim::Target(target) => Some(target),
            Aim::Direction(_) => None,
        };
        let direction = if self.keys.iter().all(|k| target(k).is_some()) {
            point(self.interpolate(time, |k| value(target(k).unwrap_or_default()))) - position
        } else {
            self.interpolate(time, |k| match k.aim {
                Aim::Target(target) => (place(target) - place(k.position)).normalize_or_zero(),
                Aim::Direction(direction) => direction.normalize_or_zero(),
            })
        };
        let up = self.interpolate(time, |k| k.up.unwrap_or(up).normalize_or_zero());
        Camera { position, direction: direction.normalize_or_zero(), up: up.normalize_or_zero(), field_of_view }
    }

    /// A Catmull-Rom spline through the keys' values: cubic Hermite segments. The tangent at a key is the slope between
    /// its two neighbours in time; at either end it is the slope to the only neighbour.
    fn interpolate(&self, time: f32, value: impl Fn(&Key) -> Vec3) -> Vec3 {
        let keys = &self.keys;
        let last = keys.len() - 1;
        let i = keys.partition_point(|k| k.time <= time).saturating_sub(1).min(last - 1);
        let slope = |a: usize, b: usize| (value(&keys[b]) - value(&keys[a])) / (keys[b].time - keys[a].time);
        let length = keys[i + 1].time - keys[i].time;
        let t = ((time - keys[i].time) / length).clamp(0.0, 1.0);
        let (p0, p1) = (value(&keys[i]), value(&keys[i + 1]));
        let m0 = slope(i.saturating_sub(1), i + 1) * length;
        let m1 = slope(i, (i + 2).min(last)) * length;
        let (t2, t3) = (t * t, t * t * t);
        p0 * (2.0 * t3 - 3.0 * t2 + 1.0) + m0 * (t3 - 2.0 * t2 + t) + p1 * (3.0 * t2 - 2.0 * t3) + m1 * (t3 - t2)
    }
}
