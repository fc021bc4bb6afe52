//! A walk: key frames with times, joined by Catmull-Rom splines.

use super::Camera;
use super::path::Room;
use glam::{DVec3, Vec3};

/// A key frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Key {
    /// Any unit; the path's frames are spread evenly from the first key to the last.
    pub time: f32,
    /// In the file's coordinates, unless the walk is relative; so is a target.
    pub position: DVec3,
    pub aim: Aim,
    /// Overrides the path's.
    pub up: Option<Vec3>,
}

/// Where the camera looks.
#[derive(Clone, Copy, Debug)]
pub(super) enum Aim {
    /// At a point.
    Target(DVec3),
    /// Along a vector.
    Direction(Vec3),
}

/// The keys, in order of time; at least two.
#[derive(Clone, Debug)]
pub(super) struct Walk {
    pub keys: Vec<Key>,
    /// True if positions and targets are in units of the bounds, 0 to 1 per axis. Directions never are.
    pub relative: bool,
}

impl Walk {
    /// The camera after a share of the time.
    ///
    /// If all keys have targets, the target is interpolated (a camera that circles a point keeps looking at it),
    /// otherwise the direction.
    pub fn camera(&self, room: Room, up: Vec3, field_of_view: f32, share: f32) -> Camera {
        // What is relative is interpolated in units of the bounds
        let value = |p: DVec3| if self.relative { p.as_vec3() } else { room.place(p, false) };
        let point = |value: Vec3| if self.relative { room.in_bounds(value) } else { value };
        let place = |p: DVec3| room.place(p, self.relative);
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

    /// Catmull-Rom through the keys' values: cubic Hermite pieces, whose tangent at a key is the slope between its two
    /// neighbours in time (at the ends, to the one neighbour).
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
