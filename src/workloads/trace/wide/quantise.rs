//! Boxes whose planes are numbers: plane `q` of an axis lies at `lo + q * step`. Ours, after Ylitie et al. 2017.
//!
//! `step` is a power of two, which makes the product exact: a fused multiply-add rounds as two operations do.

use crate::math::Aabb;
use glam::{DVec3, Vec3, Vec3A};

/// A box by the numbers of its lower and upper planes.
pub type Numbers = ([u16; 3], [u16; 3]);

/// The planes of all axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Planes {
    /// Plane 0.
    pub lo: Vec3A,
    /// From a plane to the next: powers of two.
    pub step: Vec3A,
    /// The greatest number of a plane.
    pub last: u16,
}

impl Planes {
    /// Planes from 0 to `last` that reach around this box. An axis without extent has planes one unit apart, of which
    /// the first one is used.
    pub fn around(bounds: Aabb, last: u16) -> Planes {
        if bounds.is_empty() {
            return Planes { lo: Vec3A::ZERO, step: Vec3A::ONE, last };
        }
        let extent = bounds.max.as_dvec3() - bounds.min.as_dvec3();
        let step = |extent: f64| {
            let least = (extent / f64::from(last)).log2().ceil().exp2();
            // A logarithm may be rounded down
            let step = if least * f64::from(last) < extent { 2.0 * least } else { least };
            if extent > 0.0 { step.max(f64::from(f32::MIN_POSITIVE)) as f32 } else { 1.0 }
        };
        Planes { lo: bounds.min.into(), step: Vec3A::new(step(extent.x), step(extent.y), step(extent.z)), last }
    }

    /// Where planes of these numbers lie. Beyond the largest float it is infinite, which is a box without an end.
    #[inline(always)]
    pub fn at(&self, q: [u16; 3]) -> Vec3A {
        self.lo + Vec3A::from_array(q.map(f32::from)) * self.step
    }

    /// A box, as traversals see it.
    #[inline(always)]
    pub fn corners(&self, min: [u16; 3], max: [u16; 3]) -> (Vec3A, Vec3A) {
        (self.at(min), self.at(max))
    }

    /// The same.
    pub fn aabb(&self, (min, max): Numbers) -> Aabb {
        Aabb { min: self.at(min).into(), max: self.at(max).into() }
    }

    /// The smallest box around this one, as far as the planes reach.
    pub fn numbers(&self, content: Aabb) -> Numbers {
        (self.below(content.min), self.above(content.max))
    }

    /// How many planes from plane 0 a point is away.
    fn number(&self, point: Vec3) -> DVec3 {
        (point.as_dvec3() - self.lo.as_dvec3()) / self.step.as_dvec3()
    }

    fn on(&self, axis: usize, q: u16) -> f32 {
        self.lo[axis] + f32::from(q) * self.step[axis]
    }

    /// The greatest planes that do not lie above a point.
    fn below(&self, point: Vec3) -> [u16; 3] {
        let number = self.number(point);
        std::array::from_fn(|axis| {
            let mut q = number[axis].floor().clamp(0.0, f64::from(self.last)) as u16;
            // By exact numbers this would be it; planes are rounded, neighbours even to the same float
            while q > 0 && self.on(axis, q) > point[axis] {
                q -= 1;
            }
            if q < self.last && self.on(axis, q + 1) <= point[axis] { q + 1 } else { q }
        })
    }

    /// The smallest planes that do not lie below a point.
    fn above(&self, point: Vec3) -> [u16; 3] {
        let number = self.number(point);
        std::array::from_fn(|axis| {
            let mut q = number[axis].ceil().clamp(0.0, f64::from(self.last)) as u16;
            while q < self.last && self.on(axis, q) < point[axis] {
                q += 1;
            }
            if q > 0 && self.on(axis, q - 1) >= point[axis] { q - 1 } else { q }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn aabb(min: [f32; 3], max: [f32; 3]) -> Aabb {
        Aabb { min: min.into(), max: max.into() }
    }

    #[test]
    fn boxes_are_held_and_no_plane_could_be_nearer() {
        let bounds = [
            aabb([-1.0, 0.1, 3.0], [1.0, 0.7, 3.0]),
            aabb([1.0e6; 3], [1.0e6 + 0.3, 1.0e6 + 7.0, 1.0e6 + 1.0e-9]),
            aabb([-3.0e38; 3], [3.0e38, -2.9e38, 1.0]),
            aabb([0.0; 3], [1.0e-40, 1.0e-30, 1.0e30]),
        ];
        for (bounds, last) in bounds.into_iter().flat_map(|bounds| [(bounds, 255), (bounds, u16::MAX)]) {
            let planes = Planes::around(bounds, last);
            assert!(planes.aabb(planes.numbers(bounds)).contains(bounds), "{bounds:?}");
            let part = |a: f32| bounds.min + (bounds.max * 0.25 - bounds.min * 0.25) * a;
            for i in 0..200 {
                let content = Aabb { min: part(i as f32 * 0.01), max: part(i as f32 * 0.01 + 1.0) };
                let (min, max) = planes.numbers(content);
                let own = planes.aabb((min, max));
                assert!(own.contains(content), "{content:?} in {bounds:?}");
                for axis in 0..3 {
                    let inner_min = planes.on(axis, min[axis].saturating_add(1).min(last));
                    let inner_max = planes.on(axis, max[axis].saturating_sub(1));
                    let nearest = inner_min == own.min[axis] || inner_min > content.min[axis];
                    assert!(nearest, "{content:?} in {bounds:?}");
                    let nearest = inner_max == own.max[axis] || inner_max < content.max[axis];
                    assert!(nearest, "{content:?} in {bounds:?}");
                }
                // What is decoded is its own box
                let again = planes.aabb(planes.numbers(own));
                assert!(again == own, "{content:?} in {bounds:?}");
            }
        }
    }
}
