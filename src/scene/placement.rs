//! Where a scene lies in memory, and where in its file.
//!
//! Vertices, lights and cameras are single precision, which is fine near the origin and coarse far from it: at
//! 5,000,000 the next number is half a unit away. A scene far from its origin is therefore moved there while its file
//! is read, in double precision, and rounded once. A scene whose extent is so small or so large that products of
//! lengths would leave the range of floats is scaled by a power of two, which changes no bit of its shape. All that
//! users see and give is in the file's coordinates; [`Placement`] leads from one to the other.

use super::Scene;
use crate::math::Aabb;
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// How many diagonals of a scene its coordinates may be away from the origin before the scene is moved there. Up to
/// here rounding moves a coordinate by at most `2^-24 * 64` = 4e-6 of the diagonal, less than half of the surface
/// epsilon.
pub const FAR: f64 = 64.0;

/// Coordinates beyond this are refused, and extents below its inverse.
pub const MAX_COORDINATE: f64 = 1e18;

/// Extents between these, 2^-8 and 2^24, stay as they are: products of lengths are floats, rays from 2^23 diagonals away
/// have distances below [`crate::math::SLACK`], and [`crate::math::PLANE_SHIFT_MIN`] is small compared with the scene.
const COMFORTABLE: std::ops::RangeInclusive<f64> = 1.0 / (1 << 8) as f64..=(1 << 24) as f64;

/// A light that is farther away than this, in units of about the scene's extent, is brought nearer in its direction:
/// lights do not fade, the direction changes by 2^-40, and squares of distances stay in range.
const FARTHEST_LIGHT: f64 = (1u64 << 40) as f64;

/// No light is farther away than this: the sum of three squares of it is a float.
const FARTHEST_OF_ALL: f64 = (1u64 << 60) as f64;

/// What leads from a file's coordinates (behind `up=` and `scale=`) to those in memory: `(file - offset) * 2^exponent`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Placement {
    /// The point of the file that is the origin in memory.
    pub offset: DVec3,
    /// The power of two by which lengths are scaled.
    pub exponent: i32,
}

/// A power of two, exactly; exponents beyond the range of normal doubles are cut to it.
pub fn power_of_two(exponent: i32) -> f64 {
    f64::from_bits(((1023 + exponent.clamp(-1022, 1023)) as u64) << 52)
}

/// The exponent of the largest power of two that is not above a positive finite number.
pub fn exponent_of(number: f64) -> i32 {
    let exponent = |x: f64| (x.to_bits() >> 52) as i32 - 1023;
    // Of a denormal number the bits say nothing
    if number < f64::MIN_POSITIVE { exponent(number * power_of_two(100)) - 100 } else { exponent(number) }
}

impl Placement {
    /// A scene that lies in memory as in its file.
    pub const IDENTITY: Placement = Placement { offset: DVec3::ZERO, exponent: 0 };

    /// True if the scene lies in memory as in its file.
    pub fn is_identity(&self) -> bool {
        *self == Placement::IDENTITY
    }

    /// True for one that a scene may have: it is used to check placements read from caches.
    pub(super) fn is_sound(&self) -> bool {
        self.offset.is_finite() && self.exponent.abs() <= 256
    }

    /// Where a point of the file lies in memory.
    pub fn place(&self, file: DVec3) -> Vec3 {
        ((file - self.offset) * power_of_two(self.exponent)).as_vec3()
    }

    /// Where a point in memory lies in the file.
    pub fn file(&self, placed: Vec3) -> DVec3 {
        placed.as_dvec3() * power_of_two(-self.exponent) + self.offset
    }

    /// A length in memory as it is in the file.
    pub fn length(&self, placed: f32) -> f64 {
        f64::from(placed) * power_of_two(-self.exponent)
    }

    /// The same in as few digits as lead back to it.
    pub fn exact(&self, placed: f32) -> f64 {
        Placement { offset: DVec3::ZERO, ..*self }.coordinates(Vec3::splat(placed))[0]
    }

    /// The point in memory that is read back where this one is written down in the file's coordinates: doubles far
    /// from the origin do not hold the last bits of what lies near it.
    pub fn snap(&self, placed: Vec3) -> Vec3 {
        if self.offset == DVec3::ZERO { placed } else { self.place(self.file(placed)) }
    }

    /// The coordinates of a point in memory, as they are in the file: the shortest numbers that lead back to the point.
    pub fn coordinates(&self, placed: Vec3) -> [f64; 3] {
        if self.is_identity() {
            // A float in its shortest digits, as a double
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

    /// The same as text.
    pub fn point(&self, placed: Vec3) -> String {
        let [x, y, z] = self.coordinates(placed).map(number);
        format!("[{x}, {y}, {z}]")
    }
}

/// A number as users see it: very large and small ones with an exponent.
pub fn number(x: f64) -> String {
    if x == 0.0 || (1e-7..1e16).contains(&x.abs()) { x.to_string() } else { format!("{x:e}") }
}

/// The box around all vertices that triangles use. Indices that lead nowhere, which nobody has looked for yet, are
/// passed over.
pub(super) fn used_bounds(scene: &Scene) -> Aabb {
    let corners = |t: &super::Triangle| {
        let position = |v: u32| scene.vertices.get(v as usize).map(|vertex| vertex.position);
        Aabb::from_points(t.vertices.into_iter().filter_map(position))
    };
    let bounds = |triangles: &[super::Triangle]| triangles.iter().map(corners).fold(Aabb::EMPTY, Aabb::union);
    scene.triangles.par_chunks(1 << 14).map(bounds).reduce(|| Aabb::EMPTY, Aabb::union)
}

/// A box in double precision.
#[derive(Clone, Copy)]
struct Bounds {
    min: DVec3,
    max: DVec3,
}

impl Bounds {
    /// The largest distance of a coordinate from zero.
    fn reach(&self) -> f64 {
        self.min.abs().max(self.max.abs()).max_element()
    }

    /// True if a box with coordinates so large should be moved to the origin.
    fn is_far(&self) -> bool {
        self.reach() > FAR * (self.max - self.min).length()
    }

    /// Where to put the origin: near the middle, on axes whose coordinates are larger than the extent, at a multiple
    /// of a power of two that is a quarter to a half of it, so that offsets are short numbers.
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

/// Triangles that are looked at where a few tell enough.
const FEW: usize = 256;

/// True if a few triangles of a part tell that the whole, which is placed as the part is, is not far from the origin:
/// of a scene that is, every corner lies farther out than 63 of the scene's diagonals, which is more than 63
/// diagonals of those few.
fn is_surely_near(part: &Scene) -> bool {
    let few = part.triangles.iter().step_by(part.triangles.len() / FEW + 1);
    let position = |v: u32| part.vertices.get(v as usize).map(|vertex| vertex.position);
    let bounds = Aabb::from_points(few.flat_map(|t| t.vertices).filter_map(position));
    !bounds.is_empty() && distance(bounds) < FAR - 2.0
}

/// How far a scene lies from the origin in memory, in diagonals; infinite for a point that is not there.
pub(super) fn distance(bounds: Aabb) -> f64 {
    let bounds = Bounds { min: bounds.min.as_dvec3(), max: bounds.max.as_dvec3() };
    let (reach, diagonal) = (bounds.reach(), (bounds.max - bounds.min).length());
    if reach > 0.0 { reach / diagonal } else { 0.0 }
}

/// Where the parts of a scene, which were read with placements of their own, should have the origin instead; `None`
/// if no move is needed.
pub(super) fn better_offset<'a>(parts: impl Iterator<Item = &'a Scene> + Clone) -> Option<DVec3> {
    let first = parts.clone().next()?.placement;
    let agree = parts.clone().all(|part| part.placement == first);
    if agree && first.exponent == 0 && parts.clone().any(is_surely_near) {
        return None;
    }
    // Around the origin in memory if there is one, so that nothing is rounded
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
    /// Brings a scene to another placement. Positions are rounded once more.
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

    /// Scales a scene by a power of two if its extent in the file is not comfortable, and brings lights nearer that are
    /// too far away. `bounds` is the box around its triangles.
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

    /// What is wrong with the size of a scene, if something is: the problem and the advice. `bounds` is the box around its
    /// triangles.
    pub(super) fn size_fault(&self, bounds: Aabb) -> Option<(String, &'static str)> {
        let [min, max] = [bounds.min, bounds.max].map(|corner| self.placement.file(corner));
        let reach = min.abs().max(max.abs()).max_element();
        if !(reach <= MAX_COORDINATE) {
            let problem = format!("the scene is too large: it reaches to {reach:e}, and coordinates end at 1e18");
            return Some((problem, "scale it down, as in FILE:scale=1e-6"));
        }
        let extent = self.placement.length(bounds.extent().max_element());
        if extent > 0.0 && extent < 1.0 / MAX_COORDINATE {
            let extent = self.placement.exact(bounds.extent().max_element());
            let problem = format!("the scene is too small: its extent is {extent:e}, and the smallest is 1e-18");
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
    fn what_is_written_down_leads_back() {
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
    fn only_axes_that_are_far_are_moved_by_short_numbers() {
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
