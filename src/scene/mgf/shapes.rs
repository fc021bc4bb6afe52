//! Converts shapes to triangles.

use super::transform::any_number_of;
use super::{MgfReader, VertexContext};
use crate::scene::polygon::newell;
use crate::scene::text::Fault;
use glam::{DVec3, Vec3};
use std::cell::LazyCell;

impl MgfReader {
    /// Adds the triangles of a shape, with the current material.
    pub(super) fn shape(&mut self, entity: &[u8], arguments: &[&[u8]]) -> Result<(), Fault> {
        if !self.material_set {
            self.material_set = true;
            let material = *self.materials.current();
            if material.transparent.amount + material.translucent.amount > 0.0 {
                self.mesh.warnings.add("transparent material: rendered opaque");
            }
            self.mesh.set_material(material.material());
        }
        let before = self.mesh.triangles();
        match (entity, arguments) {
            (b"f", names) => {
                let mut points = std::mem::take(&mut self.points);
                points.clear();
                for &name in names {
                    points.push(*self.vertices.find(name)?);
                }
                self.face(&points, &[])?;
                self.points = points;
            }
            (b"fh", names) => {
                let mut points = Vec::with_capacity(names.len());
                let mut holes = Vec::new();
                for &name in names {
                    match name {
                        b"-" => holes.push(points.len() as u32),
                        name => points.push(*self.vertices.find(name)?),
                    }
                }
                self.face(&points, &holes)?;
            }
            (b"sph", &[center, radius]) => {
                let center = self.vertices.find(center)?.position;
                self.mesh.sphere(center, any_number_of(radius)?, self.segments)?;
            }
            (b"cyl", &[from, radius, to]) => self.cone([from, radius, to, radius])?,
            (b"cone", &[from, radius, to, radius_there]) => self.cone([from, radius, to, radius_there])?,
            (b"ring", &[center, inner, outer]) => {
                let VertexContext { position, normal } = *self.vertices.find(center)?;
                let radii = [any_number_of(inner)?, any_number_of(outer)?];
                if radii[0] < 0.0 || radii[1] < radii[0] {
                    return Err(Fault::new(None, "the radii are not 0 <= inner < outer", "put the inner one first"));
                }
                self.mesh.ring(position, normal.as_dvec3(), radii, self.segments)?;
            }
            (b"torus", &[center, inner, outer]) => {
                let VertexContext { position, normal } = *self.vertices.find(center)?;
                // Negative radii mean that normals point inwards.
                let (inner, outer) = (any_number_of(inner)?, any_number_of(outer)?);
                let finite = inner.is_finite() && outer.is_finite();
                if finite && !(0.0 <= inner && inner < outer || outer < inner && inner <= 0.0) {
                    let hint = "put the inner one first; both are negative where the normals point inward";
                    return Err(Fault::new(None, "the radii are not 0 <= inner < outer", hint));
                }
                self.mesh.torus(
                    position,
                    normal.as_dvec3(),
                    (inner + outer).abs() / 2.0,
                    (outer - inner) / 2.0,
                    self.segments,
                )?;
            }
            (b"prism", [names @ .., length]) => self.prism(names, any_number_of(length)?)?,
            _ => return Err(Fault::new(None, format!("{} arguments are the wrong number", arguments.len()), "")),
        }
        let emitted = self.materials.current().emitted;
        let after = self.mesh.triangles();
        if emitted.amount > 0.0 && after > before {
            self.emitters.add(before..after, emitted.colour.rgb() * emitted.amount);
        }
        Ok(())
    }

    fn points(&self, names: &[&[u8]]) -> Result<Vec<VertexContext>, Fault> {
        names.iter().map(|name| self.vertices.find(name).copied()).collect()
    }

    /// Adds a face; vertices without a normal have the face's normal.
    fn face(&mut self, points: &[VertexContext], holes: &[u32]) -> Result<(), Fault> {
        let mut corners = std::mem::take(&mut self.corners);
        corners.clear();
        corners.extend(points.iter().map(|point| point.position));
        if points.iter().all(|point| point.normal == Vec3::ZERO) {
            self.mesh.polygon_with_holes(&corners, &[], holes)?;
            self.corners = corners;
            return Ok(());
        }
        let outer = holes.first().map_or(corners.len(), |&first| first as usize);
        let own = LazyCell::new(|| newell(&corners[..outer]));
        let normal = |point: &VertexContext| if point.normal == Vec3::ZERO { *own } else { point.normal.as_dvec3() };
        let normals: Vec<DVec3> = points.iter().map(normal).collect();
        self.mesh.polygon_with_holes(&corners, &normals, holes)
    }

    fn cone(&mut self, [from, radius, to, radius_there]: [&[u8]; 4]) -> Result<(), Fault> {
        let [from, to] = [self.vertices.find(from)?.position, self.vertices.find(to)?.position];
        let radii = [any_number_of(radius)?, any_number_of(radius_there)?];
        if radii[0] * radii[1] < 0.0 {
            return Err(Fault::new(None, "one radius is positive and one is negative", "give both the same sign"));
        }
        self.mesh.cone((from, radii[0]), (to, radii[1]), self.segments)
    }

    /// Adds a prism: an end face that faces outwards, extruded against its normal. A negative length extrudes along the
    /// normal, so that all faces face inwards.
    fn prism(&mut self, names: &[&[u8]], length: f64) -> Result<(), Fault> {
        self.mesh.new_shape();
        let points = self.points(names)?;
        let near: Vec<DVec3> = points.iter().map(|point| point.position).collect();
        if !self.mesh.keep_if(length.is_finite() && near.iter().all(|corner| corner.is_finite())) {
            return Ok(());
        }
        let normal = newell(&near).normalize_or_zero();
        if near.len() < 3 || normal == DVec3::ZERO || length == 0.0 {
            self.mesh.warnings.add("prism without volume ignored");
            return Ok(());
        }
        let far: Vec<DVec3> = near.iter().map(|&corner| corner - normal * length).collect();
        self.mesh.polygon(&near, &[])?;
        for i in 0..near.len() {
            let next = (i + 1) % near.len();
            let corners = [near[i], far[i], far[next], near[next]];
            match [i, next].map(|i| points[i].normal.as_dvec3()) {
                [a, b] if a != DVec3::ZERO && b != DVec3::ZERO => self.mesh.polygon(&corners, &[a, a, b, b])?,
                _ => self.mesh.polygon(&corners, &[])?,
            }
        }
        let back: Vec<DVec3> = far.into_iter().rev().collect();
        self.mesh.polygon(&back, &[])
    }
}
