//! Spheres, cones, rings and tori as surfaces of revolution with smooth normals; always the same triangles.

use super::{MeshBuilder, unit};
use crate::scene::text::Fault;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// A circle of a surface of revolution.
#[derive(Clone, Copy, Debug)]
pub struct Circle {
    /// Distance from the axis; zero is a pole.
    pub radius: f64,
    /// Along the axis.
    pub height: f64,
    /// The surface's normal: its part away from the axis and its part along it.
    pub normal: [f64; 2],
}

impl MeshBuilder {
    /// Turns a profile around an axis through `origin`. `profile` runs so that the outside is to its right when the axis
    /// points up and radii grow to the right; `inside` turns the surface inside out. `segments` quadrilaterals go
    /// around, of two triangles each, one at a pole.
    ///
    /// # Errors
    /// Too much geometry, or beyond single precision.
    pub fn revolve(
        &mut self,
        origin: DVec3,
        axis: DVec3,
        profile: &[Circle],
        segments: u32,
        inside: bool,
    ) -> Result<(), Fault> {
        let up = unit(axis);
        let (side, front) = up.any_orthonormal_pair();
        let sign = if inside { -1.0 } else { 1.0 };
        let mut below: Vec<u32> = Vec::new();
        for (row, circle) in profile.iter().enumerate() {
            let mut above = Vec::with_capacity(segments as usize);
            for segment in 0..segments {
                let (sine, cosine) = (TAU * f64::from(segment) / f64::from(segments)).sin_cos();
                let outward = side * cosine + front * sine;
                let normal = (outward * circle.normal[0] + up * circle.normal[1]) * sign;
                above.push(self.vertex(origin + outward * circle.radius + up * circle.height, normal)?);
            }
            for segment in 0..below.len() {
                let next = (segment + 1) % below.len();
                let [a, b, c, d] = [below[segment], below[next], above[next], above[segment]];
                let mut triangle = |[a, b, c]: [u32; 3]| self.triangle(if inside { [a, c, b] } else { [a, b, c] });
                if profile[row - 1].radius != 0.0 {
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

    /// A sphere; a negative radius turns it inside out. There are `segments` around and half as many from pole to pole.
    ///
    /// # Errors
    /// As [`MeshBuilder::revolve`].
    pub fn sphere(&mut self, center: DVec3, radius: f64, segments: u32) -> Result<(), Fault> {
        self.new_shape();
        if radius == 0.0 {
            self.warnings.add("sphere without a radius left out");
            return Ok(());
        }
        let rows = (segments / 2).max(2);
        let profile: Vec<Circle> = (0..=rows)
            .map(|row| {
                let pole = row == 0 || row == rows;
                let (sine, cosine) = (PI * f64::from(row) / f64::from(rows)).sin_cos();
                let (out, up) = if pole { (0.0, -cosine.signum()) } else { (sine, -cosine) };
                Circle { radius: radius.abs() * out, height: radius.abs() * up, normal: [out, up] }
            })
            .collect();
        self.revolve(center, DVec3::Y, &profile, segments, radius < 0.0)
    }

    /// The mantle of a cone or cylinder between two circles, without caps; a negative radius turns it inside out.
    ///
    /// # Errors
    /// As [`MeshBuilder::revolve`].
    pub fn cone(&mut self, from: (DVec3, f64), to: (DVec3, f64), segments: u32) -> Result<(), Fault> {
        self.new_shape();
        let axis = to.0 - from.0;
        let (height, radii) = (axis.length(), [from.1.abs(), to.1.abs()]);
        // Written so that NaN counts as nothing as well
        if !(height > 0.0 && radii[0] + radii[1] > 0.0) {
            self.warnings.add("cone without a height or a radius left out");
            return Ok(());
        }
        let normal = [height, radii[0] - radii[1]];
        let profile = [(radii[0], 0.0), (radii[1], height)].map(|(radius, height)| Circle { radius, height, normal });
        self.revolve(from.0, axis, &profile, segments, from.1 < 0.0 || to.1 < 0.0)
    }

    /// A flat ring between two radii, seen from where `normal` points; a disk if `inner` is zero.
    ///
    /// # Errors
    /// As [`MeshBuilder::revolve`].
    pub fn ring(&mut self, center: DVec3, normal: DVec3, [inner, outer]: [f64; 2], segments: u32) -> Result<(), Fault> {
        self.new_shape();
        if outer == inner || unit(normal) == DVec3::ZERO {
            self.warnings.add("ring without an area left out");
            return Ok(());
        }
        let profile = [outer, inner].map(|radius| Circle { radius, height: 0.0, normal: [0.0, 1.0] });
        self.revolve(center, normal, &profile, segments, false)
    }

    /// A torus: a tube of radius `tube` whose middle is a circle of radius `radius` around `axis`; a negative tube turns
    /// it inside out. There are `segments` around the axis and as many around the tube.
    ///
    /// # Errors
    /// As [`MeshBuilder::revolve`].
    pub fn torus(&mut self, center: DVec3, axis: DVec3, radius: f64, tube: f64, segments: u32) -> Result<(), Fault> {
        self.new_shape();
        if tube == 0.0 || unit(axis) == DVec3::ZERO {
            self.warnings.add("torus without a tube or an axis left out");
            return Ok(());
        }
        let profile: Vec<Circle> = (0..=segments)
            .map(|row| {
                // The last circle is the first
                let (sine, cosine) = (TAU * f64::from(row % segments) / f64::from(segments)).sin_cos();
                let outward = radius + tube.abs() * cosine;
                Circle { radius: outward, height: tube.abs() * sine, normal: [cosine, sine] }
            })
            .collect();
        self.revolve(center, axis, &profile, segments, tube < 0.0)
    }
}
