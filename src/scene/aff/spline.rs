//! Keyframes between their keys: Kochanek-Bartels splines (Kochanek and Bartels 1984, for keys that are not equally
//! spaced), and squad on quaternions with the same multipliers (Shoemake 1987).

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

/// A key's value at a time.
pub trait Spline {
    type Value;
    /// The value at `time`, held at the second key before it and at the last but one behind it: the first and the last
    /// only shape the tangents. There are four keys at least, in order of time.
    fn at(&self, time: f64) -> Self::Value;
}

/// Where a time lies: index of the key before and the share of the way to the next, 0 to 1.
fn locate<T>(keys: &[Key<T>], time: f64) -> (usize, f64) {
    let (first, last) = (1, keys.len() - 2);
    let before = keys[..=last].partition_point(|key| key.time <= time).saturating_sub(1).max(first);
    if before >= last {
        return (last, 0.0);
    }
    let length = keys[before + 1].time - keys[before].time;
    (before, if length > 0.0 { ((time - keys[before].time) / length).clamp(0.0, 1.0) } else { 0.0 })
}

/// Factors of the tangents between keys 1 and 2 of four: of the steps 0 to 1 and 1 to 2 in the tangent that leaves key
/// 1, and of the steps 2 to 3 and 1 to 2 in the tangent that reaches key 2.
struct Factors {
    leaving: [f64; 2],
    reaching: [f64; 2],
}

impl Factors {
    fn new<T>(keys: &[Key<T>]) -> Factors {
        let [k0, k1, k2, k3] = [&keys[0], &keys[1], &keys[2], &keys[3]];
        // Unequal spacing: a tangent is scaled by the share that its interval has in the two around its key
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

/// A key's rotation.
#[derive(Clone, Copy, Debug)]
pub struct Turn {
    /// As the file gives it.
    given: DQuat,
    /// On the side of the key before it, so that the angle between the two is acute.
    aligned: DQuat,
}

impl Turn {
    /// A rotation that follows another, or none.
    pub fn new(given: DQuat, before: Option<&Turn>) -> Turn {
        let obtuse = before.is_some_and(|before| before.aligned.dot(given) < 0.0);
        Turn { given, aligned: if obtuse { -given } else { given } }
    }
}

/// The benchmark's own code turns a key to the side of the one before it when the curve first reaches it as its end: so
/// the key behind the end still is as the file gives it. Its tangent is the long way around then, which shows in the
/// robots' camera, and has to stay.
impl Spline for [Key<Turn>] {
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

/// The logarithm of the rotation from one to the other: half the angle times the axis.
fn step(from: DQuat, to: DQuat) -> DVec3 {
    let turn = from.inverse() * to;
    let sine = turn.xyz().length();
    if sine < 1e-12 { DVec3::ZERO } else { turn.xyz() * (sine.atan2(turn.w) / sine) }
}

/// The inverse of the logarithm.
fn exp(v: DVec3) -> DQuat {
    let angle = v.length();
    if angle < 1e-12 {
        return DQuat::IDENTITY;
    }
    let part = v * (angle.sin() / angle);
    DQuat::from_xyzw(part.x, part.y, part.z, angle.cos())
}

/// Spherical interpolation along the arc from `a` to `b`, whichever of the two arcs that is.
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
    fn the_curve_passes_through_its_keys_and_stands_still_outside() {
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

    /// By hand: P = 0, 0, 1, 1 at times 0, 1, 2, 4. Leaving: 2 (2-1)/(2-0) / 2 = 1/2 of each step: 0.5 * (0 + 1) = 0.5.
    /// Reaching: 2 (2-1)/(4-1) / 2 = 1/3: 1/3 * (0 + 1). At u = 1/2 Hermite's weights are 1/2, 1/2, 1/8, -1/8.
    #[test]
    fn tangents_follow_the_spacing_of_the_keys() {
        let mut keys = xs(&[(0.0, 0.0), (1.0, 0.0), (2.0, 1.0), (4.0, 1.0)]);
        let expected = 0.5 + 0.5 / 8.0 - 1.0 / 3.0 / 8.0;
        assert!((keys.as_slice().at(1.5).x - expected).abs() < 1e-12);
        // Full tension: no tangents. Continuity -1: only the step of the curve's own piece, twice. Bias 1: only the step
        // behind, twice for the tangent that leaves.
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
    fn an_even_turn_around_one_axis_stays_even_and_takes_the_short_way() {
        let turn = |degrees: f64| DQuat::from_axis_angle(DVec3::Y, degrees.to_radians());
        let mut keys: Vec<Key<Turn>> = Vec::new();
        for (i, value) in [turn(0.0), turn(80.0), -turn(160.0), turn(240.0)].into_iter().enumerate() {
            let value = Turn::new(value, keys.last().map(|last| &last.value));
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
