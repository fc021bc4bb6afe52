//! Spheres, cones, rings and tori as surfaces of revolution with smooth normals; always the same triangles.

use super::revolve::Circle;
use super::{MeshBuilder, unit};
use crate::scene::text::Fault;
use glam::DVec3;

impl MeshBuilder {
    /// A sphere; a negative radius turns it inside out. There are `segments` around and half as many from pole to pole.
    ///
    /// # Errors
    /// Too much geometry, or beyond single precision.
    pub fn sphere(&mut self, center: DVec3, radius: f64, segments: u32) -> Result<(), Fault> {
        self.new_shape();
        if radius == 0.0 {
            self.warnings.add("sphere without a radius left out");
            return Ok(());
        }
        let circle =
            |&[out, up]: &[f64; 2]| Circle { radius: radius.abs() * out, height: radius.abs() * up, normal: [out, up] };
        let profile: Vec<Circle> = self.turns.of(segments).half().iter().map(circle).collect();
        self.revolve(center, DVec3::Y, &profile, segments, radius < 0.0)
    }

    /// The mantle of a cone or cylinder between two circles, without caps; a negative radius turns it inside out.
    ///
    /// # Errors
    /// As [`MeshBuilder::sphere`].
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
    /// As [`MeshBuilder::sphere`].
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
    /// As [`MeshBuilder::sphere`].
    pub fn torus(&mut self, center: DVec3, axis: DVec3, radius: f64, tube: f64, segments: u32) -> Result<(), Fault> {
        self.new_shape();
        if tube == 0.0 || unit(axis) == DVec3::ZERO {
            self.warnings.add("torus without a tube or an axis left out");
            return Ok(());
        }
        let circle = |&[cosine, sine]: &[f64; 2]| {
            let outward = radius + tube.abs() * cosine;
            Circle { radius: outward, height: tube.abs() * sine, normal: [cosine, sine] }
        };
        let around = self.turns.of(segments).around();
        // The last circle is the first
        let profile: Vec<Circle> = around.iter().chain(around.first()).map(circle).collect();
        self.revolve(center, axis, &profile, segments, tube < 0.0)
    }
}
