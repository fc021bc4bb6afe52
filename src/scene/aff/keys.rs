//! Keyframes: what `k NAME { ... }` says, and where it puts things at a time.

use super::spline::{Key, Spline, Turn};
use crate::scene::text::{Fault, Words, quote_bytes};
use glam::{DAffine3, DQuat, DVec3};

/// The keyframes of one name. Empty blocks leave things as they are.
#[derive(Default)]
pub struct Keyframes {
    translations: Vec<Key<DVec3>>,
    rotations: Vec<Key<Turn>>,
    scales: Vec<Key<DVec3>>,
    /// Time and whether it is visible from then on.
    visibility: Vec<(f64, bool)>,
    /// Keys that were left out because their time lies before that of the key ahead of them. (BART's robots have some:
    /// there they repeat what was said before.)
    pub left_out: usize,
}

impl Keyframes {
    /// Reads `{ blocks }`.
    pub fn read(words: &mut Words) -> Result<Keyframes, Fault> {
        let mut keyframes = Keyframes::default();
        words.expect("{", "k")?;
        loop {
            match words.need("k")? {
                b"}" => return Ok(keyframes),
                b"transl" => {
                    keyframes.translations = keyframes.block(words, "transl", |words, _| vector(words, "transl"))?
                }
                b"scale" => keyframes.scales = keyframes.block(words, "scale", |words, _| vector(words, "scale"))?,
                b"rot" => keyframes.rotations = keyframes.block(words, "rot", turn)?,
                b"visibility" => {
                    let count = words.count(4, "visibility")?;
                    for _ in 0..count {
                        let [time, visible] = words.numbers("visibility")?;
                        if keyframes.visibility.last().is_none_or(|last| time >= last.0) {
                            keyframes.visibility.push((time, visible != 0.0));
                        } else {
                            keyframes.left_out += 1;
                        }
                    }
                }
                other => {
                    let problem = format!("{} is no block of keyframes", quote_bytes(other));
                    return Err(words.fault(problem, "blocks are transl, rot, scale and visibility"));
                }
            }
        }
    }

    /// Rows of a time, a value, tension, continuity and bias.
    fn block<T>(
        &mut self,
        words: &mut Words,
        what: &str,
        value: fn(&mut Words, Option<&T>) -> Result<T, Fault>,
    ) -> Result<Vec<Key<T>>, Fault> {
        let count = words.count(14, what)?;
        let mut keys: Vec<Key<T>> = Vec::with_capacity(count);
        for _ in 0..count {
            let time = words.number(what)?;
            // The curve never ends at the second key: it has no side to be turned to
            let before = keys.get(1).and(keys.last());
            let value = value(words, before.map(|before| &before.value))?;
            let [tension, continuity, bias] = words.numbers(what)?;
            if keys.last().is_none_or(|last| time >= last.time) {
                keys.push(Key { time, value, tension, continuity, bias });
            } else {
                self.left_out += 1;
            }
        }
        if keys.len() < 4 {
            let problem = format!("{what}: {} keys in order of time", keys.len());
            return Err(words.fault(problem, "a spline needs four at least"));
        }
        Ok(keys)
    }

    /// The first time at which anything is given.
    pub fn first_time(&self) -> Option<f64> {
        let splines = [second(&self.translations), second(&self.rotations), second(&self.scales)];
        splines.into_iter().flatten().min_by(f64::total_cmp)
    }

    /// Where things are at a time: scaled, then turned, then moved.
    pub fn transform(&self, time: f64) -> DAffine3 {
        let vector = |keys: &[Key<DVec3>], default| if keys.is_empty() { default } else { keys.at(time) };
        let scale = vector(&self.scales, DVec3::ONE);
        DAffine3::from_scale_rotation_translation(scale, self.rotation(time), vector(&self.translations, DVec3::ZERO))
    }

    /// The rotation alone.
    pub fn rotation(&self, time: f64) -> DQuat {
        if self.rotations.is_empty() { DQuat::IDENTITY } else { self.rotations.as_slice().at(time) }
    }

    /// Whether things are visible at a time: before the first key they are.
    pub fn visible(&self, time: f64) -> bool {
        let before = self.visibility.partition_point(|key| key.0 <= time);
        before == 0 || self.visibility[before - 1].1
    }
}

fn second<T>(keys: &[Key<T>]) -> Option<f64> {
    keys.get(1).map(|key| key.time)
}

fn vector(words: &mut Words, what: &str) -> Result<DVec3, Fault> {
    words.numbers(what).map(DVec3::from)
}

fn turn(words: &mut Words, before: Option<&Turn>) -> Result<Turn, Fault> {
    rotation(words, "rot").map(|given| Turn::new(given, before))
}

/// An axis and an angle in degrees; an axis of no length turns nothing.
pub fn rotation(words: &mut Words, what: &str) -> Result<DQuat, Fault> {
    let [x, y, z, degrees] = words.numbers(what)?;
    let axis = DVec3::new(x, y, z).normalize_or_zero();
    Ok(if axis == DVec3::ZERO { DQuat::IDENTITY } else { DQuat::from_axis_angle(axis, degrees.to_radians()) })
}
