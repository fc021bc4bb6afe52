//! Interpolation of keys: Kochanek-Bartels splines (Kochanek and Bartels 1984, for unequally spaced keys), and squad on
//! quaternions with the same tangents (Shoemake 1987).

use glam::{DQuat, DVec3};

/// A key of a spline.
#[derive(Clone, Copy, Debug)]
pub struct Key<T> {
    pub time: f64,
    pub value: T,
    pub tension: f64,
    pub continuity: f64,
    pub bias: f64,
}

/// Interpolation of a sequence of keys.
pub trait Spline {
    type Value;
    /// The value at `time`. It is constant before the second key and after the last but one: the first and the last key
    /// only define tangents. There must be at least four keys, in order of time.
    fn at(&self, time: f64) -> Self::Value;
}

/// The segment that contains a time: the index of the key before it, and the share of the way to the next key, 0 to 1.
fn locate<T>(keys: &[Key<T>], time: f64) -> (usize, f64) {
    let (first, last) = (1, keys.len() - 2);
    let before = keys[..=last].partition_point(|key| key.time <= time).saturating_sub(1).max(first);
    if before >= last {
        return (last, 0.0);
    }
    let length = keys[before + 1].time - keys[before].time;
    (before, if length > 0.0 { ((time - keys[before].time) / length).clamp(0.0, 1.0) } else { 0.0 })
}

/// Factors of the two tangents of the segment from key 1 to key 2 of four keys. `leaving` has the factors of the
/// differences 0 to 1 and 1 to 2 in the tangent at key 1, `reaching` those of the differences 2 to 3 and 1 to 2 in the
/// tangent at key 2.
struct Factors {
    leaving: [f64; 2],
    reaching: [f64; 2],
}

impl Factors {
    fn new<T>(keys: &[Key<T>]) -> Factors {
        let [k0, k1, k2, k3] = [&keys[0], &keys[1], &keys[2], &keys[3]];
        // For unequally spaced keys, a tangent is scaled by the segment's share of the two intervals around its key.
        let span = k2.time - k1.time;
        let share = |around: f64| if around > 0.0 { span / around } else { 0.0 };
        let leaving = share(k2.time - k0.time) * (1.0 - k1.tension);
        let reaching = share(k3.time - k1.time) * (1.0 - k2.tension);
        Factors {
            leaving: [
                leaving * (1.0 + k1.continuity) * (1.0 + k1.bias),
                leaving * (1.0 - k1.continuity) * (1.0 - k1.bias),
            ],
            reaching: [
                reaching * (1.0 + k2.continuity) * (1.0 - k2.bias),
                reaching * (1.0 - k2.continuity) * (1.0 + k2.bias),
            ],
        }
    }
}

impl Spline for [Key<DVec3>] {
    type Value = DVec3;

    fn at(&self, time: f64) -> DVec3 {
        let (i, u) = locate(self, time);
        if u == 0.0 {
            return self[i].value;
        }
        let keys = &self[i - 1..i + 3];
        let factors = Factors::new(keys);
        let [p0, p1, p2, p3] = [0, 1, 2, 3].map(|k: usize| keys[k].value);
        let leaving = (p1 - p0) * factors.leaving[0] + (p2 - p1) * factors.leaving[1];
        let reaching = (p3 - p2) * factors.reaching[0] + (p2 - p1) * factors.reaching[1];
        let (u2, u3) = (u * u, u * u * u);
        p1 * (2.0 * u3 - 3.0 * u2 + 1.0)
            + p2 * (3.0 * u2 - 2.0 * u3)
            + leaving * (u3 - 2.0 * u2 + u)
            + reaching * (u3 - u2)
    }
}

/// The rotation of a key.
#[derive(Clone, Copy, Debug)]
pub struct Rotation {
    /// The quaternion with the sign that the file gives it.
    given: DQuat,
    /// The quaternion with the sign at which its angle to the previous key's is acute.
    aligned: DQuat,
}

impl Rotation {
    /// The rotation of the key that follows `before`.
    pub fn new(given: DQuat, before: Option<&Rotation>) -> Rotation {
        let obtuse = before.is_some_and(|before| before.aligned.dot(given) < 0.0);
        Rotation { given, aligned: if obtuse { -given } else { given } }
    }
}

/// BART's own code aligns the sign of a key with the previous one when the curve first reaches the key as the end of a
/// segment. The key after the segment's end therefore still has the sign of the file, and the tangent may take the
/// longer arc. The camera of the scene `robots` depends on this.
impl Spline for [Key<Rotation>] {
    type Value = DQuat;

    fn at(&self, time: f64) -> DQuat {
        let (i, u) = locate(self, time);
        if u == 0.0 {
            return self[i].value.aligned;
        }
        let keys = &self[i - 1..i + 3];
        let factors = Factors::new(keys);
        let [q0, q1, q2] = [0, 1, 2].map(|k: usize| keys[k].value.aligned);
        let q3 = keys[3].value.given;
        let (step01, step12, step23) = (step(q0, q1), step(q1, q2), step(q2, q3));
        let leaving = step01 * factors.leaving[0] + step12 * factors.leaving[1];
        let reaching = step23 * factors.reaching[0] + step12 * factors.reaching[1];
        let a = q1 * exp((leaving - step12) * 0.5);
        let b = q2 * exp((step12 - reaching) * 0.5);
        slerp(slerp(q1, q2, u), slerp(a, b, u), 2.0 * u * (1.0 - u)).normalize()
    }
}

/// The logarithm of the rotation between two quaternions: the axis times half the angle.
fn step(from: DQuat, to: DQuat) -> DVec3 {
    let turn = from.inverse() * to;
    let sine = turn.xyz().length();
    if sine < 1e-12 { DVec3::ZERO } else { turn.xyz() * (sine.atan2(turn.w) / sine) }
}

/// The quaternion of which `v` is the logarithm.
fn exp(v: DVec3) -> DQuat {
    let angle = v.length();
    if angle < 1e-12 {
        return DQuat::IDENTITY;
    }
    let part = v * (angle.sin() / angle);
    DQuat::from_xyzw(part.x, part.y, part.z, angle.cos())
}

/// Spherical linear interpolation from `a` to `b`, along the shorter or the longer arc, as their signs demand.
fn slerp(a: DQuat, b: DQuat, u: f64) -> DQuat {
    let angle = a.dot(b).clamp(-1.0, 1.0).acos();
    let sine = angle.sin();
    if sine < 1e-9 {
        return a;
    }
    a * (((1.0 - u) * angle).sin() / sine) + b * ((u * angle).sin() / sine)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    fn key<T>(time: f64, value: T) -> Key<T> {
        Key { time, value, tension: 0.0, continuity: 0.0, bias: 0.0 }
    }

    fn xs(keys: &[(f64, f64)]) -> Vec<Key<DVec3>> {
        keys.iter().map(|&(time, x)| key(time, DVec3::X * x)).collect()
    }

    #[test]
    fn the_curve_passes_through_its_keys_and_is_constant_outside() {
        let keys = xs(&[(0.0, 9.0), (1.0, 1.0), (2.0, 5.0), (4.0, 2.0), (5.0, 9.0)]);
        for (time, x) in [(-7.0, 1.0), (1.0, 1.0), (2.0, 5.0), (4.0, 2.0), (99.0, 2.0), (f64::MIN, 1.0)] {
            assert_eq!(keys.as_slice().at(time).x, x, "at {time}");
        }
    }

    #[test]
    fn a_straight_line_at_even_times_stays_one() {
        let keys = xs(&[(0.0, 0.0), (1.0, 2.0), (2.0, 4.0), (3.0, 6.0)]);
        for i in 0..=10 {
            let time = 1.0 + f64::from(i) / 10.0;
            assert!((keys.as_slice().at(time).x - 2.0 * time).abs() < 1e-12);
        }
    }

    /// Computed by hand: P = 0, 0, 1, 1 at times 0, 1, 2, 4. The leaving tangent has 2 (2-1)/(2-0) / 2 = 1/2 of each
    /// difference: 0.5 * (0 + 1) = 0.5. The reaching tangent has 2 (2-1)/(4-1) / 2 = 1/3: 1/3 * (0 + 1). At u = 1/2
    /// Hermite's weights are 1/2, 1/2, 1/8, -1/8.
    #[test]
    fn tangents_follow_the_spacing_of_the_keys() {
        let mut keys = xs(&[(0.0, 0.0), (1.0, 0.0), (2.0, 1.0), (4.0, 1.0)]);
        let expected = 0.5 + 0.5 / 8.0 - 1.0 / 3.0 / 8.0;
        assert!((keys.as_slice().at(1.5).x - expected).abs() < 1e-12);
        // Tension 1 gives no tangents. Continuity -1 gives twice the difference of the segment itself. Bias 1 gives, in
        // the leaving tangent, twice the difference of the segment before.
        keys[1].tension = 1.0;
        keys[2].tension = 1.0;
        assert!((keys.as_slice().at(1.5).x - 0.5).abs() < 1e-12);
        keys[1] = Key { tension: 0.0, continuity: -1.0, ..keys[1] };
        assert!((keys.as_slice().at(1.5).x - (0.5 + 1.0 / 8.0)).abs() < 1e-12);
        keys[1] = Key { continuity: 0.0, bias: 1.0, ..keys[1] };
        assert!((keys.as_slice().at(1.5).x - 0.5).abs() < 1e-12);
        keys[2] = Key { tension: 0.0, bias: -1.0, ..keys[2] };
        assert!((keys.as_slice().at(1.5).x - 0.5).abs() < 1e-12);
    }

    #[test]
    fn a_uniform_rotation_stays_uniform_and_takes_the_shorter_arc() {
        let turn = |degrees: f64| DQuat::from_axis_angle(DVec3::Y, degrees.to_radians());
        let mut keys: Vec<Key<Rotation>> = Vec::new();
        for (i, value) in [turn(0.0), turn(80.0), -turn(160.0), turn(240.0)].into_iter().enumerate() {
            let value = Rotation::new(value, keys.last().map(|last| &last.value));
            keys.push(key(i as f64, value));
        }
        for i in 0..=10 {
            let u = f64::from(i) / 10.0;
            let found = keys.as_slice().at(1.0 + u);
            assert!(found.angle_between(turn(80.0 + 80.0 * u)) < 1e-6, "{u}: {found}");
        }
    }

    #[test]
    fn exp_is_the_inverse_of_step() {
        for v in [DVec3::ZERO, DVec3::new(0.3, -0.2, 0.1), DVec3::Z * FRAC_PI_2, DVec3::X * (PI - 0.1)] {
            let from = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 1.0);
            assert!(step(from, from * exp(v)).abs_diff_eq(v, 1e-9), "{v}");
        }
        assert_eq!(slerp(DQuat::IDENTITY, DQuat::IDENTITY, 0.3), DQuat::IDENTITY);
    }
}
