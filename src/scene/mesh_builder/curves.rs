//! Spheres, cones, rings and tori as surfaces of revolution with smooth normals. Equal arguments always give the same
//! triangles.

use super::revolve::Circle;
use super::{MeshBuilder, unit};
use crate::scene::text::Fault;
use glam::DVec3;

impl MeshBuilder {
    /// Adds a sphere with `segments` segments around the y axis and half as many from pole to pole. With a negative
    /// radius it faces inwards.
    ///
    /// # Errors
    /// The geometry exceeds the limits, or a position exceeds single precision.
    pub fn sphere(&mut self, center: DVec3, radius: f64, segments: u32) -> Result<(), Fault> {
        self.new_shape();
        if !self.keep_if(center.is_finite() && radius.is_finite()) {
            return Ok(());
        }
        if radius == 0.0 {
            self.warnings.add("sphere with radius 0 ignored");
            return Ok(());
        }
        let circle =
            |&[out, up]: &[f64; 2]| Circle { radius: radius.abs() * out, height: radius.abs() * up, normal: [out, up] };
        let profile: Vec<Circle> = self.circles.of(segments).half().iter().map(circle).collect();
        self.revolve(center, DVec3::Y, &profile, segments, radius < 0.0)
    }

    /// Adds the lateral surface of a cone or cylinder between two circles, without caps. With a negative radius it
    /// faces inwards.
    ///
    /// # Errors
    /// As [`MeshBuilder::sphere`].
    pub fn cone(&mut self, from: (DVec3, f64), to: (DVec3, f64), segments: u32) -> Result<(), Fault> {
        self.new_shape();
        if !self.keep_if([from, to].iter().all(|(center, radius)| center.is_finite() && radius.is_finite())) {
            return Ok(());
        }
        let axis = to.0 - from.0;
        let (height, radii) = (axis.length(), [from.1.abs(), to.1.abs()]);
        // The condition is also true for NaN.
        if !(height > 0.0 && radii[0] + radii[1] > 0.0) {
            self.warnings.add("cone without height or radius ignored");
            return Ok(());
        }
        let normal = [height, radii[0] - radii[1]];
        let profile = [(radii[0], 0.0), (radii[1], height)].map(|(radius, height)| Circle { radius, height, normal });
        self.revolve(from.0, axis, &profile, segments, from.1 < 0.0 || to.1 < 0.0)
    }

    /// Adds a flat ring between two radii that faces along `normal`; a disk if `inner` is zero.
    ///
    /// # Errors
    /// As [`MeshBuilder::sphere`].
    pub fn ring(&mut self, center: DVec3, normal: DVec3, [inner, outer]: [f64; 2], segments: u32) -> Result<(), Fault> {
        self.new_shape();
        if !self.keep_if(center.is_finite() && inner.is_finite() && outer.is_finite()) {
            return Ok(());
        }
        if outer == inner || unit(normal) == DVec3::ZERO {
            self.warnings.add("ring without area ignored");
            return Ok(());
        }
        let profile = [outer, inner].map(|radius| Circle { radius, height: 0.0, normal: [0.0, 1.0] });
        self.revolve(center, normal, &profile, segments, false)
    }

    /// Adds a torus: a tube of radius `tube` around a circle of radius `radius` around `axis`, with `segments` segments
    /// in both directions. With a negative `tube` it faces inwards.
    ///
    /// # Errors
    /// As [`MeshBuilder::sphere`].
    pub fn torus(&mut self, center: DVec3, axis: DVec3, radius: f64, tube: f64, segments: u32) -> Result<(), Fault> {
        self.new_shape();
        if !self.keep_if(center.is_finite() && radius.is_finite() && tube.is_finite()) {
            return Ok(());
        }
        if tube == 0.0 || unit(axis) == DVec3::ZERO {
            self.warnings.add("torus without tube radius or axis ignored");
            return Ok(());
        }
        let circle = |&[cosine, sine]: &[f64; 2]| {
            let outward = radius + tube.abs() * cosine;
            Circle { radius: outward, height: tube.abs() * sine, normal: [cosine, sine] }
        };
        let around = self.circles.of(segments).around();
        // The profile is closed: the last circle is the first.
        let profile: Vec<Circle> = around.iter().chain(around.first()).map(circle).collect();
        self.revolve(center, axis, &profile, segments, tube < 0.0)
    }
}
