//! Surfaces of revolution: a profile that is rotated around an axis.
//!
//! In nearly all of them vertices are provably distinct, except at poles and at the seam of a torus, which are shared
//! by construction. These surfaces are built without a search for equal vertices; the result is the same to the bit. In
//! the other surfaces (flattened, far from the origin, near the memory limit) every corner is searched.

use super::{Frame, MeshBuilder, unit};
use crate::math::Vertex;
use crate::scene::text::Fault;
use crate::scene::{MAX_ELEMENTS, Material, Triangle};
use glam::{DMat3, DVec2, DVec3, Vec3};
use std::f64::consts::{PI, TAU};

/// A circle of a surface of revolution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// Distance from the axis; zero is a pole.
    pub radius: f64,
    /// Coordinate along the axis.
    pub height: f64,
    /// The surface normal: its components away from the axis and along it.
    pub normal: [f64; 2],
}

impl Circle {
    /// True for a pole at which the surface is smooth, so that all of its corners are equal.
    fn is_point(&self) -> bool {
        self.radius == 0.0 && self.normal[0] == 0.0
    }
}

/// Cached values: the points of a divided unit circle, and the normals of the last surface.
#[derive(Default)]
pub struct UnitCircles {
    around: Vec<[f64; 2]>,
    half: Vec<[f64; 2]>,
    /// Normals of the last surface, one per vertex.
    normals: Vec<Vec3>,
    /// The transform of normals and whether it faces inwards, if the last surface was a sphere. Spheres for which these
    /// are equal have equal normals.
    sphere: Option<(DMat3, bool)>,
}

impl UnitCircles {
    /// Computes the circles for a number of segments, unless they are cached.
    pub fn of(&mut self, segments: u32) -> &UnitCircles {
        if self.around.len() != segments as usize {
            let turn = |part: u32| (TAU * f64::from(part) / f64::from(segments)).sin_cos();
            self.around = (0..segments).map(turn).map(|(sine, cosine)| [cosine, sine]).collect();
            let rows = (segments / 2).max(2);
            let half = |row: u32| {
                let (sine, cosine) = (PI * f64::from(row) / f64::from(rows)).sin_cos();
                if row == 0 || row == rows { [0.0, -cosine.signum()] } else { [sine, -cosine] }
            };
            self.half = (0..=rows).map(half).collect();
            self.sphere = None;
        }
        self
    }

    /// The transformed normals of a surface, one per vertex.
    fn normals(&mut self, surface: &Surface, frame: &Frame) -> &[Vec3] {
        let sphere = surface.is_sphere.then_some((frame.normals, surface.inside));
        if sphere.is_none() || sphere != self.sphere {
            self.normals.clear();
            for circle in surface.circles() {
                let outward = surface.outward[..surface.corners(circle)].iter();
                self.normals.extend(outward.map(|&outward| frame.direction(surface.normal(circle, outward))));
            }
            self.sphere = sphere;
        }
        &self.normals
    }

    /// The full circle: cosine and sine of the start of each segment.
    pub fn around(&self) -> &[[f64; 2]] {
        &self.around
    }

    /// The half circle from pole to pole, in half as many segments: the components away from the axis and along it.
    pub fn half(&self) -> &[[f64; 2]] {
        &self.half
    }
}

/// A surface of revolution in local coordinates.
struct Surface<'p> {
    origin: DVec3,
    /// Unit vector along the axis.
    up: DVec3,
    /// Unit vectors away from the axis, at the start of each segment.
    outward: Vec<DVec3>,
    profile: &'p [Circle],
    /// True if the surface faces inwards.
    inside: bool,
    is_sphere: bool,
}

/// The vertices of a circle: one per segment, or a single one (`step` 0).
#[derive(Clone, Copy)]
struct Row {
    first: u32,
    step: u32,
}

impl Row {
    #[inline(always)]
    fn at(self, segment: usize) -> u32 {
        self.first + self.step * segment as u32
    }
}

impl MeshBuilder {
    /// Adds a surface of revolution around an axis through `origin`, as a new shape. If the axis points up and radii
    /// increase to the right, the outside is to the right of the profile; with `inside` the surface faces inwards.
    /// There are `segments` quadrilaterals around the axis, of two triangles each, or one at a pole.
    ///
    /// The profile must be two circles, or points at equal distances on a circle; it may be closed.
    ///
    /// # Errors
    /// The geometry exceeds the limits, or a position exceeds single precision.
    pub(super) fn revolve(
        &mut self,
        origin: DVec3,
        axis: DVec3,
        profile: &[Circle],
        segments: u32,
        inside: bool,
    ) -> Result<(), Fault> {
        let up = unit(axis);
        let (side, front) = up.any_orthonormal_pair();
        let UnitCircles { around, half, .. } = self.circles.of(segments);
        let outward = around.iter().map(|&[cosine, sine]| side * cosine + front * sine).collect();
        let is_sphere = profile.len() == half.len() && profile.iter().zip(half).all(|(a, b)| a.normal == *b);
        let surface = Surface { origin, up, outward, profile, inside, is_sphere: is_sphere && axis == DVec3::Y };
        let (vertices, triangles) = surface.size();
        if self.has_room(vertices, triangles) && surface.is_distinct(self.frame()) {
            self.add_distinct(&surface, vertices, triangles)
        } else {
            self.add_searched(&surface)
        }
    }

    /// True if this many vertices and triangles, and the table of the vertices, are within the limits.
    fn has_room(&self, vertices: usize, triangles: usize) -> bool {
        let bytes = vertices * size_of::<Vertex>() + triangles * size_of::<Triangle>() + 2 * size_of::<Material>();
        self.vertices.len() + vertices <= MAX_ELEMENTS
            && self.triangles.len() + triangles <= MAX_ELEMENTS
            && self.limits.have_room(2 * bytes + vertices * size_of::<Vec3>() + self.shared.bytes_with(vertices))
    }

    /// Adds a surface with distinct vertices ([`Surface::is_distinct`]) within the limits ([`MeshBuilder::has_room`]).
    fn add_distinct(&mut self, surface: &Surface, vertices: usize, triangles: usize) -> Result<(), Fault> {
        self.limits.repeat(2 * (vertices * size_of::<Vertex>() + triangles * size_of::<Triangle>()))?;
        self.vertices.reserve(vertices);
        self.triangles.reserve(triangles);
        let begin = self.vertices.len();
        let rows = self.add_circles(surface)?;
        self.unlisted = begin..self.vertices.len();
        if triangles == 0 {
            return Ok(());
        }
        let material = self.material_index()?;
        let (mirrored, segments) = (self.frame().mirrored != surface.inside, surface.outward.len());
        let mut add = |[a, b, c]: [u32; 3]| {
            self.triangles.push(Triangle { vertices: if mirrored { [a, c, b] } else { [a, b, c] }, material });
        };
        for (rows, circles) in rows.windows(2).zip(surface.profile.windows(2)) {
            let (below, above) = (rows[0], rows[1]);
            for segment in 0..segments {
                let next = if segment + 1 == segments { 0 } else { segment + 1 };
                let [a, b, c, d] = [below.at(segment), below.at(next), above.at(next), above.at(segment)];
                if circles[0].radius != 0.0 {
                    add([a, b, c]);
                }
                if circles[1].radius != 0.0 {
                    add([a, c, d]);
                }
            }
        }
        Ok(())
    }

    /// Adds the vertices of a surface's circles, and returns their indices.
    fn add_circles(&mut self, surface: &Surface) -> Result<Vec<Row>, Fault> {
        let frame = *self.frame();
        let mut normals = self.circles.normals(surface, &frame).iter();
        let mut rows: Vec<Row> = Vec::with_capacity(surface.profile.len());
        for circle in surface.circles() {
            rows.push(Row { first: self.vertices.len() as u32, step: u32::from(!circle.is_point()) });
            for (&outward, &normal) in surface.outward[..surface.corners(circle)].iter().zip(normals.by_ref()) {
                self.vertices.push(frame.place(surface.position(circle, outward), normal)?);
            }
        }
        if surface.is_closed() {
            rows.push(rows[0]);
        }
        Ok(rows)
    }

    /// Adds a surface that may have equal vertices or exceed the limits.
    fn add_searched(&mut self, surface: &Surface) -> Result<(), Fault> {
        let mut below: Vec<u32> = Vec::new();
        for (row, circle) in surface.profile.iter().enumerate() {
            let mut above = Vec::with_capacity(surface.outward.len());
            for &outward in &surface.outward {
                above.push(self.vertex(surface.position(circle, outward), surface.normal(circle, outward))?);
            }
            for segment in 0..below.len() {
                let next = (segment + 1) % below.len();
                let [a, b, c, d] = [below[segment], below[next], above[next], above[segment]];
                let mut triangle =
                    |[a, b, c]: [u32; 3]| self.triangle(if surface.inside { [a, c, b] } else { [a, b, c] });
                if surface.profile[row - 1].radius != 0.0 {
                    triangle([a, b, c])?;
                }
                if circle.radius != 0.0 {
                    triangle([a, c, d])?;
                }
            }
            below = above;
        }
        Ok(())
    }
}

/// The distance at which two positions differ in single precision, relative to their largest coordinate: eight times
/// the rounding error of two positions.
const POSITIONS: f64 = 1.0 / (1 << 20) as f64;

/// The relative distance at which two positions differ in double precision.
const DOUBLES: f64 = POSITIONS / (1 << 29) as f64;

/// The distance at which two unit normals differ, with a margin for rounding errors of the transform.
const NORMALS: f64 = 1e-4;

/// The smallest distance between two positions.
const TINY: f64 = 1e-30;

impl Surface<'_> {
    #[inline(always)]
    fn position(&self, circle: &Circle, outward: DVec3) -> DVec3 {
        self.origin + outward * circle.radius + self.up * circle.height
    }

    #[inline(always)]
    fn normal(&self, circle: &Circle, outward: DVec3) -> DVec3 {
        let sign = if self.inside { -1.0 } else { 1.0 };
        (outward * circle.normal[0] + self.up * circle.normal[1]) * sign
    }

    /// True if the last circle of the profile is the first.
    fn is_closed(&self) -> bool {
        self.profile.len() > 1 && self.profile.first() == self.profile.last()
    }

    /// The distinct circles of the profile.
    fn circles(&self) -> &[Circle] {
        &self.profile[..self.profile.len() - usize::from(self.is_closed())]
    }

    /// Number of vertices of a circle.
    fn corners(&self, circle: &Circle) -> usize {
        if circle.is_point() { 1 } else { self.outward.len() }
    }

    /// The numbers of vertices and of triangles.
    fn size(&self) -> (usize, usize) {
        let vertices = self.circles().iter().map(|circle| self.corners(circle)).sum();
        let around = |circle: &Circle| if circle.radius != 0.0 { self.outward.len() } else { 0 };
        (vertices, self.profile.windows(2).map(|pair| around(&pair[0]) + around(&pair[1])).sum())
    }

    /// True if no two vertices of the surface are equal in single precision, in position and normal. Consecutive
    /// circles, and therefore all circles, must have a minimum distance; on each circle either positions or normals
    /// must. The transform multiplies distances by at least its smallest singular value, and distances of normals by at
    /// least the quotient of the smallest and the largest. This is sufficient, not necessary.
    fn is_distinct(&self, frame: &Frame) -> bool {
        let (matrix, translation) = (frame.affine.matrix3, frame.affine.translation);
        let squares = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(DVec3::length_squared).iter().sum::<f64>();
        // The product of the two largest singular values is at most half the sum of the squares.
        let smallest = matrix.determinant().abs() / (squares / 2.0);
        let largest = squares.sqrt();
        let reach = self.profile.iter().map(|circle| circle.radius + circle.height.abs()).fold(0.0, f64::max);
        // Positions are rounded in the file's coordinates, and again in memory near the origin.
        let near = largest * reach + (frame.affine.transform_point3(self.origin) - frame.offset).length();
        let far = largest * (self.origin.length() + reach) + translation.length();
        let least = near * POSITIONS + far * DOUBLES + TINY;
        let step = 2.0 * (PI / self.outward.len() as f64).sin();
        let on_circle = |circle: &Circle| {
            circle.is_point()
                || circle.radius * step * smallest > least
                || circle.normal[0].abs() * step * smallest
                    > NORMALS * largest * circle.normal[0].hypot(circle.normal[1])
        };
        let between = |pair: &[Circle]| {
            let [from, to] = [pair[0], pair[1]].map(|circle| DVec2::new(circle.radius, circle.height));
            from.distance(to) * smallest > least
        };
        (self.up.length_squared() - 1.0).abs() < 1e-6
            && self.profile.iter().all(|circle| circle.radius >= 0.0 && on_circle(circle))
            && self.profile.windows(2).all(between)
    }
}

#[cfg(test)]
mod tests;
