//! A teapot (not Newell's): body and lid are surfaces of revolution, spout and handle are tubes that end inside the
//! body.

use super::mesh::{MaterialId, Mesh, segments};
use super::shapes::{curve, profile};
use glam::Vec3;

impl Mesh {
    /// Adds a teapot with its base at the origin, about 3 wide and 1.6 high, of about 50,000 triangles at detail 1.
    pub fn teapot(&mut self, material: MaterialId, knob: MaterialId, detail: f32) {
        let around = segments(128.0, detail, 12);
        let body = [
            (0.0, 0.0),
            (0.35, 0.0),
            (0.62, 0.0),
            (0.74, 0.03),
            (0.92, 0.22),
            (1.00, 0.50),
            (0.95, 0.78),
            (0.83, 1.02),
            (0.72, 1.17),
            (0.70, 1.215),
            (0.66, 1.225),
            (0.63, 1.20),
            (0.64, 1.10),
        ];
        self.lathe(material, &profile(&body, segments(96.0, detail, 12)), around);
        let lid = [(0.665, 1.165), (0.66, 1.20), (0.60, 1.25), (0.42, 1.32), (0.20, 1.37), (0.09, 1.40), (0.07, 1.43)];
        self.lathe(material, &profile(&lid, segments(32.0, detail, 6)), around);
        let button = [(0.05, 1.42), (0.08, 1.45), (0.14, 1.50), (0.15, 1.55), (0.11, 1.60), (0.05, 1.62), (0.0, 1.625)];
        self.lathe(knob, &profile(&button, segments(24.0, detail, 6)), segments(64.0, detail, 8));

        let spout = [
            Vec3::new(0.72, 0.45, 0.0),
            Vec3::new(1.00, 0.50, 0.0),
            Vec3::new(1.28, 0.68, 0.0),
            Vec3::new(1.42, 0.94, 0.0),
            Vec3::new(1.62, 1.14, 0.0),
        ];
        let (rows, thin) = (segments(64.0, detail, 8), segments(64.0, detail, 8));
        self.tube(
            material,
            &curve(&spout, rows),
            |t| 0.27 - 0.19 * t.min(0.75) / 0.75 + 0.02 * (t - 0.75).max(0.0),
            thin,
        );
        // The inner surface of the spout, so that one cannot see through its outer surface from inside
        let inner = |t: f32| 0.25 - 0.19 * t.min(0.75) / 0.75 + 0.02 * (t - 0.75).max(0.0);
        self.inside_tube(material, &curve(&spout, rows), inner, thin);

        let handle = [
            Vec3::new(-0.80, 1.02, 0.0),
            Vec3::new(-1.10, 1.08, 0.0),
            Vec3::new(-1.42, 1.02, 0.0),
            Vec3::new(-1.50, 0.78, 0.0),
            Vec3::new(-1.32, 0.50, 0.0),
            Vec3::new(-0.90, 0.28, 0.0),
        ];
        self.tube(material, &curve(&handle, rows), |t| 0.10 - 0.03 * t, thin);
    }

    /// Adds a tube that faces inwards.
    fn inside_tube(&mut self, material: MaterialId, path: &[Vec3], radii: impl Fn(f32) -> f32, around: usize) {
        let (vertices, triangles) = (self.vertices.len(), self.triangles.len());
        self.tube(material, path, radii, around);
        for vertex in &mut self.vertices[vertices..] {
            vertex.normal = -vertex.normal;
        }
        for triangle in &mut self.triangles[triangles..] {
            triangle.vertices.swap(1, 2);
        }
    }
}
