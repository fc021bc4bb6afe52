//! Keyframes: the entity `k NAME { ... }`, and its transform at a given time.

use super::spline::{Key, Rotation, Spline};
use crate::scene::text::{Fault, Tokenizer, quote_bytes};
use glam::{DAffine3, DQuat, DVec3};

/// The keyframes of one name. A missing block gives the identity.
#[derive(Default)]
pub struct Keyframes {
    translations: Vec<Key<DVec3>>,
    rotations: Vec<Key<Rotation>>,
    scales: Vec<Key<DVec3>>,
    /// Times, and whether objects are visible from then on.
    visibility: Vec<(f64, bool)>,
    /// Number of keys that were ignored because their time is before the previous key's. (BART's scene `robots` has
    /// some, which repeat earlier keys.)
    pub ignored: usize,
}

impl Keyframes {
    /// Reads the blocks in braces.
    pub fn read(tokens: &mut Tokenizer) -> Result<Keyframes, Fault> {
        let mut keyframes = Keyframes::default();
        tokens.expect("{", "k")?;
        loop {
            match tokens.need("k")? {
                b"}" => return Ok(keyframes),
                b"transl" => {
                    keyframes.translations = keyframes.block(tokens, "transl", |tokens, _| vector(tokens, "transl"))?
                }
                b"scale" => keyframes.scales = keyframes.block(tokens, "scale", |tokens, _| vector(tokens, "scale"))?,
                b"rot" => keyframes.rotations = keyframes.block(tokens, "rot", turn)?,
                b"visibility" => {
                    let count = tokens.count(4, "visibility")?;
                    for _ in 0..count {
                        let [time, visible] = tokens.numbers("visibility")?;
                        if keyframes.visibility.last().is_none_or(|last| time >= last.0) {
                            keyframes.visibility.push((time, visible != 0.0));
                        } else {
                            keyframes.ignored += 1;
                        }
                    }
                }
                other => {
                    let problem = format!("{} is not a block of keyframes", quote_bytes(other));
                    return Err(tokens.fault(problem, "blocks are transl, rot, scale and visibility"));
                }
            }
        }
    }

    /// Reads a block; its rows are time, value, tension, continuity and bias.
    fn block<T>(
        &mut self,
        tokens: &mut Tokenizer,
        context: &str,
        value: fn(&mut Tokenizer, Option<&T>) -> Result<T, Fault>,
    ) -> Result<Vec<Key<T>>, Fault> {
        let count = tokens.count(14, context)?;
        let mut keys: Vec<Key<T>> = Vec::with_capacity(count);
        for _ in 0..count {
            let time = tokens.number(context)?;
            // No segment of the curve ends at the second key, so its quaternion is not aligned with the one before.
            let before = keys.get(1).and(keys.last());
            let value = value(tokens, before.map(|before| &before.value))?;
            let [tension, continuity, bias] = tokens.numbers(context)?;
            if keys.last().is_none_or(|last| time >= last.time) {
                keys.push(Key { time, value, tension, continuity, bias });
            } else {
                self.ignored += 1;
            }
        }
        if keys.len() < 4 {
            let problem = format!("{context}: {} keys in order of time", keys.len());
            return Err(tokens.fault(problem, "a spline needs at least four"));
        }
        Ok(keys)
    }

    /// The first time at which a spline is defined, that of its second key.
    pub fn first_time(&self) -> Option<f64> {
        let splines = [second(&self.translations), second(&self.rotations), second(&self.scales)];
        splines.into_iter().flatten().min_by(f64::total_cmp)
    }

    /// The transform at a time: it scales, then rotates, then translates.
    pub fn transform(&self, time: f64) -> DAffine3 {
        let vector = |keys: &[Key<DVec3>], default| if keys.is_empty() { default } else { keys.at(time) };
        let scale = vector(&self.scales, DVec3::ONE);
        DAffine3::from_scale_rotation_translation(scale, self.rotation(time), vector(&self.translations, DVec3::ZERO))
    }

    pub fn rotation(&self, time: f64) -> DQuat {
        if self.rotations.is_empty() { DQuat::IDENTITY } else { self.rotations.as_slice().at(time) }
    }

    /// True if objects are visible at a time; they are before the first key.
    pub fn visible(&self, time: f64) -> bool {
        let before = self.visibility.partition_point(|key| key.0 <= time);
        before == 0 || self.visibility[before - 1].1
    }
}

fn second<T>(keys: &[Key<T>]) -> Option<f64> {
    keys.get(1).map(|key| key.time)
}

fn vector(tokens: &mut Tokenizer, context: &str) -> Result<DVec3, Fault> {
    tokens.numbers(context).map(DVec3::from)
}

fn turn(tokens: &mut Tokenizer, before: Option<&Rotation>) -> Result<Rotation, Fault> {
    rotation(tokens, "rot").map(|given| Rotation::new(given, before))
}

/// Reads a rotation as an axis and an angle in degrees; an axis of length zero gives the identity.
pub fn rotation(tokens: &mut Tokenizer, context: &str) -> Result<DQuat, Fault> {
    let [x, y, z, degrees] = tokens.numbers(context)?;
    let axis = DVec3::new(x, y, z).normalize_or_zero();
    Ok(if axis == DVec3::ZERO { DQuat::IDENTITY } else { DQuat::from_axis_angle(axis, degrees.to_radians()) })
}
