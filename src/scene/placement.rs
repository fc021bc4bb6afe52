//! The placement of a scene: the conversion between its coordinates in the file and in memory.
//!
//! Vertices, lights and cameras are in single precision, which is coarse far from the origin: at 5,000,000 the spacing
//! of numbers is half a unit. A scene far from the origin is therefore moved to the origin while its file is read, in
//! double precision, and rounded once. A scene with an extent so small or so large that products of lengths would leave
//! the range of floats is scaled by a power of two, which changes no bit of its shape. All input and output of users is
//! in the file's coordinates; [`Placement`] converts them.

use super::Scene;
use crate::math::Aabb;
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// A scene is moved to the origin if a coordinate exceeds this many of the scene's diagonals. Up to here rounding moves
/// a coordinate by at most `2^-24 * 64` = 4e-6 of the diagonal, less than half of the surface epsilon.
pub const FAR: f64 = 64.0;

/// The largest coordinate of a scene; its inverse is the smallest extent.
pub const MAX_COORDINATE: f64 = 1e18;

/// Scenes with an extent in this range, 2^-8 to 2^24, are not scaled: products of lengths are in the range of floats,
/// rays from 2^23 diagonals away have distances below [`crate::math::SLACK`], and [`crate::math::PLANE_SHIFT_MIN`] is
/// small in relation to the scene.
const COMFORTABLE: std::ops::RangeInclusive<f64> = 1.0 / (1 << 8) as f64..=(1 << 24) as f64;

/// A light farther away than this many extents of the scene is moved nearer along its direction. Lights have no
/// attenuation and the direction changes by 2^-40 only, while squares of distances stay in the range of floats.
const FARTHEST_LIGHT: f64 = (1u64 << 40) as f64;

/// The largest distance of a light from the origin: the sum of three squares of it is in the range of floats.
const FARTHEST_OF_ALL: f64 = (1u64 << 60) as f64;

/// The conversion from a file's coordinates (after `up=` and `scale=`) to those in memory:
/// `(file - offset) * 2^exponent`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Placement {
    /// The point of the file that is the origin in memory.
    pub offset: DVec3,
    /// The power of two by which lengths are scaled.
    pub exponent: i32,
}

/// The exact power of two; the exponent is clamped to the range of normal doubles.
pub fn power_of_two(exponent: i32) -> f64 {
    f64::from_bits(((1023 + exponent.clamp(-1022, 1023)) as u64) << 52)
}

/// The exponent of the largest power of two that is not above a positive finite number.
pub(crate) fn exponent_of(number: f64) -> i32 {
    let exponent = |x: f64| (x.to_bits() >> 52) as i32 - 1023;
    // The bits of a denormal number do not hold its exponent.
    if number < f64::MIN_POSITIVE { exponent(number * power_of_two(100)) - 100 } else { exponent(number) }
}

impl Placement {
    /// The placement of a scene with equal coordinates in memory and in its file.
    pub const IDENTITY: Placement = Placement { offset: DVec3::ZERO, exponent: 0 };

    /// True if the coordinates in memory are those of the file.
    pub fn is_identity(&self) -> bool {
        *self == Placement::IDENTITY
    }

    /// True if a scene can have this placement; checks placements that are read from caches.
    pub(super) fn is_sound(&self) -> bool {
        self.offset.is_finite() && self.exponent.abs() <= 256
    }

    /// Converts a point from the file's coordinates to those in memory.
    pub fn place(&self, file: DVec3) -> Vec3 {
        ((file - self.offset) * power_of_two(self.exponent)).as_vec3()
    }

    /// Converts a point from the coordinates in memory to those of the file.
    pub fn file(&self, placed: Vec3) -> DVec3 {
        placed.as_dvec3() * power_of_two(-self.exponent) + self.offset
    }

    /// Converts a length in memory to a length in the file.
    pub fn length(&self, placed: f32) -> f64 {
        f64::from(placed) * power_of_two(-self.exponent)
    }

    /// Like [`Placement::length`], but with the fewest decimal digits that convert back to the length in memory.
    pub fn exact(&self, placed: f32) -> f64 {
        Placement { offset: DVec3::ZERO, ..*self }.coordinates(Vec3::splat(placed))[0]
    }

    /// Rounds a point in memory to one that survives a conversion to the file's coordinates and back: doubles far from
    /// the origin do not hold the last bits of a float near it.
    pub fn snap(&self, placed: Vec3) -> Vec3 {
        if self.offset == DVec3::ZERO { placed } else { self.place(self.file(placed)) }
    }

    /// Like [`Placement::file`], but with the fewest decimal digits that convert back to the point in memory.
    pub fn coordinates(&self, placed: Vec3) -> [f64; 3] {
        if self.is_identity() {
            // The double with the shortest digits of the float
            return placed.to_array().map(|x| x.to_string().parse().unwrap_or(f64::from(x)));
        }
        let (file, factor) = (self.file(placed), power_of_two(self.exponent));
        [0, 1, 2].map(|axis| {
            let back = |x: f64| ((x - self.offset[axis]) * factor) as f32;
            let shorter = |digits: usize| format!("{:.digits$e}", file[axis]).parse::<f64>().ok();
            let leads_back = |x: &f64| back(*x) == placed[axis];
            (0..17).filter_map(shorter).find(leads_back).unwrap_or(file[axis])
        })
    }

    /// The coordinates of a point in memory as `[x, y, z]` in the file.
    pub fn point(&self, placed: Vec3) -> String {
        let [x, y, z] = self.coordinates(placed).map(number);
        format!("[{x}, {y}, {z}]")
    }
}

/// Formats a number for users; very large and very small numbers have an exponent.
pub(crate) fn number(x: f64) -> String {
    if x == 0.0 || (1e-7..1e16).contains(&x.abs()) { x.to_string() } else { format!("{x:e}") }
}

/// The box around all vertices that triangles use. Indices out of range, which have not been checked yet, are ignored.
pub(super) fn used_bounds(scene: &Scene) -> Aabb {
    let corners = |t: &super::Triangle| {
        let position = |v: u32| scene.vertices.get(v as usize).map(|vertex| vertex.position);
        Aabb::from_points(t.vertices.into_iter().filter_map(position))
    };
    let bounds = |triangles: &[super::Triangle]| triangles.iter().map(corners).fold(Aabb::EMPTY, Aabb::union);
    scene.triangles.par_chunks(1 << 14).map(bounds).reduce(|| Aabb::EMPTY, Aabb::union)
}

/// An axis-aligned box in double precision.
#[derive(Clone, Copy)]
struct Bounds {
    min: DVec3,
    max: DVec3,
}

impl Bounds {
    /// The largest absolute coordinate.
    fn reach(&self) -> f64 {
        self.min.abs().max(self.max.abs()).max_element()
    }

    /// True if a scene with these bounds is moved to the origin.
    fn is_far(&self) -> bool {
        self.reach() > FAR * (self.max - self.min).length()
    }

    /// The new origin of the scene. On axes with coordinates larger than twice the extent it is near the centre, at a
    /// multiple of a power of two that is a quarter to a half of the extent, so that offsets have few digits; on other
    /// axes it is zero.
    fn origin(&self) -> DVec3 {
        let (middle, extent) = ((self.min + self.max) * 0.5, (self.max - self.min).max_element());
        let step = if extent > 0.0 { power_of_two(exponent_of(extent) - 1) } else { 0.0 };
        let along = |axis: usize| match self.min[axis].abs().max(self.max[axis].abs()) > 2.0 * extent {
            true if step > 0.0 => (middle[axis] / step).round() * step,
            true => middle[axis],
            false => 0.0,
        };
        DVec3::new(along(0), along(1), along(2))
    }
}

/// Number of triangles in the sample of [`is_surely_near`].
const FEW: usize = 256;

/// True if a sample of a part's triangles proves that the whole scene, which has the same placement, is not far from
/// the origin. In a scene that is far, every corner is more than 63 of the scene's diagonals away, and therefore more
/// than 63 diagonals of the sample.
fn is_surely_near(part: &Scene) -> bool {
    let few = part.triangles.iter().step_by(part.triangles.len() / FEW + 1);
    let position = |v: u32| part.vertices.get(v as usize).map(|vertex| vertex.position);
    let bounds = Aabb::from_points(few.flat_map(|t| t.vertices).filter_map(position));
    !bounds.is_empty() && distance(bounds) < FAR - 2.0
}

/// The largest coordinate of a scene in memory, in diagonals of the scene; infinite for a single point off the origin.
pub(super) fn distance(bounds: Aabb) -> f64 {
    let bounds = Bounds { min: bounds.min.as_dvec3(), max: bounds.max.as_dvec3() };
    let (reach, diagonal) = (bounds.reach(), (bounds.max - bounds.min).length());
    if reach > 0.0 { reach / diagonal } else { 0.0 }
}

/// The common offset with which the parts of a scene have to be read again; `None` if their placements are equal and
/// the scene is not far from the origin.
pub(super) fn better_offset<'a>(parts: impl Iterator<Item = &'a Scene> + Clone) -> Option<DVec3> {
    let first = parts.clone().next()?.placement;
    let agree = parts.clone().all(|part| part.placement == first);
    if agree && first.exponent == 0 && parts.clone().any(is_surely_near) {
        return None;
    }
    // Bounds are relative to the common origin in memory, if there is one, so that nothing is rounded.
    let base = if agree { first.offset } else { DVec3::ZERO };
    let union = |a: Bounds, b: Bounds| Bounds { min: a.min.min(b.min), max: a.max.max(b.max) };
    let bounds = parts.filter_map(|part| {
        let (bounds, shift) = (used_bounds(part), part.placement.offset - base);
        let local = |corner: Vec3| corner.as_dvec3() * power_of_two(-part.placement.exponent) + shift;
        (!bounds.is_empty()).then(|| Bounds { min: local(bounds.min), max: local(bounds.max) })
    });
    let bounds = bounds.reduce(union)?;
    let far = bounds.reach().is_finite() && bounds.is_far();
    (far || !agree).then(|| if far { base + bounds.origin() } else { base })
}

impl Scene {
    /// Converts the scene to another placement, which rounds positions once more.
    pub(super) fn move_to(&mut self, placement: Placement) {
        if placement == self.placement {
            return;
        }
        let old = self.placement;
        let shift = old.offset - placement.offset;
        let (before, after) = (power_of_two(-old.exponent), power_of_two(placement.exponent));
        self.map_positions(|p| ((p.as_dvec3() * before + shift) * after).as_vec3());
        self.placement = placement;
    }

    /// Scales a scene by a power of two if its extent in the file is not [`COMFORTABLE`], and moves lights nearer that
    /// are too far away. `bounds` is the box around its triangles.
    pub(super) fn normalise(&mut self, bounds: Aabb) {
        let extent = self.placement.length(bounds.extent().max_element());
        if !(extent > 0.0 && extent.is_finite()) {
            return;
        }
        let exponent = if COMFORTABLE.contains(&extent) { 0 } else { -exponent_of(extent) };
        let change = exponent - self.placement.exponent;
        if change != 0 {
            let factor = power_of_two(change);
            self.map_positions(|p| (p.as_dvec3() * factor).as_vec3());
            self.placement.exponent = exponent;
        }
        let farthest = (FARTHEST_LIGHT * extent * power_of_two(exponent)).min(FARTHEST_OF_ALL) as f32;
        for light in &mut self.lights {
            let distance = light.position.abs().max_element();
            if distance > farthest && distance.is_finite() {
                light.position *= farthest / distance;
            }
        }
    }

    /// Changes the positions of vertices, lights and camera.
    fn map_positions(&mut self, change: impl Fn(Vec3) -> Vec3 + Sync) {
        self.vertices.par_iter_mut().for_each(|vertex| vertex.position = change(vertex.position));
        for light in &mut self.lights {
            light.position = change(light.position);
        }
        for pose in self.camera.iter_mut().flat_map(|camera| &mut camera.frames) {
            pose.position = change(pose.position);
        }
    }

    /// The problem and the hint for a scene that is too large or too small. `bounds` is the box around its triangles.
    pub(super) fn size_fault(&self, bounds: Aabb) -> Option<(String, &'static str)> {
        let [min, max] = [bounds.min, bounds.max].map(|corner| self.placement.file(corner));
        let reach = min.abs().max(max.abs()).max_element();
        if !(reach <= MAX_COORDINATE) {
            let problem = format!("the scene is too large: its largest coordinate is {reach:e}, but the limit is 1e18");
            return Some((problem, "scale it down, as in FILE:scale=1e-6"));
        }
        let extent = self.placement.length(bounds.extent().max_element());
        if extent > 0.0 && extent < 1.0 / MAX_COORDINATE {
            let extent = self.placement.exact(bounds.extent().max_element());
            let problem = format!("the scene is too small: its extent is {extent:e}, but the limit is 1e-18");
            return Some((problem, "scale it up, as in FILE:scale=1e6"));
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_two_and_exponents_are_exact() {
        for exponent in [-1022, -149, -60, -1, 0, 1, 60, 127, 1023] {
            assert_eq!(exponent_of(power_of_two(exponent)), exponent);
            assert_eq!(exponent_of(power_of_two(exponent) * 1.999), exponent);
        }
        assert_eq!((power_of_two(10), power_of_two(-3), exponent_of(5e-324)), (1024.0, 0.125, -1074));
    }

    #[test]
    fn written_coordinates_convert_back_to_the_same_point() {
        let mut random = 1u64;
        let mut next = || {
            random = random.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (random >> 40) as f64 / f64::from(1 << 24) - 0.5
        };
        for (size, exponent) in [(0.0, 0), (5e6, 0), (1e15, 0), (0.0, 50), (1e-3, 40), (0.0, -50)] {
            for _ in 0..300 {
                let offset = DVec3::new(next(), next(), next()) * size;
                let placement = Placement { offset, exponent };
                let spread = power_of_two((next() * 60.0) as i32);
                let point = placement.snap((DVec3::new(next(), next(), next()) * spread).as_vec3());
                assert_eq!(placement.snap(point), point, "{placement:?}");
                let written = DVec3::from(placement.coordinates(point));
                assert_eq!(placement.place(written), point, "{placement:?}: {written}");
            }
        }
        let far = Placement { offset: DVec3::new(5e5, 0.0, 4649776.0), exponent: 0 };
        assert_eq!(far.point(Vec3::new(0.1, -16.5, 1e-3)), "[500000.1, -16.5, 4649776.001]");
        assert_eq!(Placement::IDENTITY.point(Vec3::new(0.1, 2.0, -1e-12)), "[0.1, 2, -1e-12]");
    }

    #[test]
    fn only_far_axes_are_moved_and_offsets_have_few_digits() {
        let bounds = |min: [f64; 3], max: [f64; 3]| Bounds { min: min.into(), max: max.into() };
        let utm = bounds([499984.0, 0.0, 4649760.0], [500016.0, 12.0, 4649792.0]);
        assert!(utm.is_far());
        assert_eq!(utm.origin(), DVec3::new(500000.0, 0.0, 4649776.0));
        assert!(!bounds([60.0, 0.0, 0.0], [61.0, 1.0, 1.0]).is_far());
        assert!(bounds([60.0, 0.0, 0.0], [61.0, 0.0, 0.0]).is_far() == (61.0 > FAR));
        let point = bounds([7.25, 1.0, 2.0], [7.25, 1.0, 2.0]);
        assert_eq!((point.is_far(), point.origin()), (true, DVec3::new(7.25, 1.0, 2.0)));
        assert!(!bounds([0.0; 3], [0.0; 3]).is_far());
    }
}
