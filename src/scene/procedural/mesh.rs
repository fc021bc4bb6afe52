//! The mesh of a built-in scene, and the search for the detail that gives the requested number of triangles.
//!
//! A scene defines its geometry as a function of a *detail*, a factor on all numbers of segments. [`fit`] evaluates
//! that function repeatedly on a mesh that only counts triangles, until the detail gives the requested number, and then
//! builds the mesh.

use crate::math::Vertex;
use crate::scene::{Material, Triangle};
use glam::{Affine3A, Vec3};

/// A mesh under construction.
pub struct Mesh {
    pub vertices: Vec<Vertex>,
    pub triangles: Vec<Triangle>,
    pub materials: Vec<Material>,
    /// The transform of the following shapes: a rotation, a translation and a uniform scale.
    pub place: Affine3A,
    /// Number of triangles so far, including those that are only counted.
    count: usize,
    /// True if triangles are counted, not built.
    counting: bool,
}

/// Index of a material in [`Mesh::materials`].
pub type MaterialId = u32;

/// Builds the mesh with the largest number of triangles up to `target`, or the coarsest mesh if all have more.
pub fn fit(target: usize, geometry: impl Fn(&mut Mesh, f32)) -> Mesh {
    let count = |detail: f32| {
        let mut mesh = Mesh::new(true);
        geometry(&mut mesh, detail);
        mesh.count
    };
    // The count is about proportional to the square of the detail; the range covers all parameters of all scenes.
    let (mut low, mut high) = (1.0f32 / 1024.0, 1024.0f32);
    for _ in 0..40 {
        let middle = (low * high).sqrt();
        if count(middle) <= target { low = middle } else { high = middle }
    }
    let mut mesh = Mesh::new(false);
    geometry(&mut mesh, low);
    debug_assert_eq!(mesh.count, mesh.triangles.len());
    mesh
}

/// A number of segments: `base` at detail 1, but at least `least`.
pub fn segments(base: f32, detail: f32, least: usize) -> usize {
    ((base * detail).round() as usize).max(least)
}

impl Mesh {
    fn new(counting: bool) -> Mesh {
        Mesh {
            vertices: Vec::new(),
            triangles: Vec::new(),
            materials: Vec::new(),
            place: Affine3A::IDENTITY,
            count: 0,
            counting,
        }
    }

    /// A mesh that is built directly, without [`fit`].
    pub fn plain() -> Mesh {
        Mesh::new(false)
    }

    /// Adds a material and returns its index.
    pub fn material(&mut self, material: Material) -> MaterialId {
        self.materials.push(material);
        self.materials.len() as u32 - 1
    }

    /// Counts `triangles`. Returns true if the caller must add them, false if they are only counted.
    #[must_use]
    pub fn announce(&mut self, triangles: usize) -> bool {
        self.count += triangles;
        !self.counting
    }

    /// Adds a vertex, transformed by [`Mesh::place`], and returns its index.
    pub fn vertex(&mut self, position: Vec3, normal: Vec3) -> u32 {
        let position = self.place.transform_point3(position);
        let normal = self.place.transform_vector3(normal).normalize_or_zero();
        self.vertices.push(Vertex::new(position, normal));
        self.vertices.len() as u32 - 1
    }

    /// Adds a triangle; its vertices are counter-clockwise, seen from outside.
    pub fn triangle(&mut self, material: MaterialId, vertices: [u32; 3]) {
        self.triangles.push(Triangle { vertices, material });
    }

    /// Adds a smooth surface of `nu` x `nv` cells. `surface(u, v)` gives position and normal for u, v in 0..=1; the
    /// cross product of the derivatives by u and v points outwards. `poles` tells whether the first and the last row (v
    /// = 0, v = 1) are a single point.
    pub fn patch(
        &mut self,
        material: MaterialId,
        [nu, nv]: [usize; 2],
        poles: [bool; 2],
        surface: impl Fn(f32, f32) -> (Vec3, Vec3),
    ) {
        let [start, end] = poles.map(usize::from);
        if !self.announce(nu * (2 * nv - start - end)) {
            return;
        }
        let first = self.vertices.len() as u32;
        for j in 0..=nv {
            for i in 0..=nu {
                let (position, normal) = surface(i as f32 / nu as f32, j as f32 / nv as f32);
                self.vertex(position, normal);
            }
        }
        let row = nu as u32 + 1;
        for j in 0..nv {
            for i in 0..nu {
                let a = first + j as u32 * row + i as u32;
                let (b, c, d) = (a + 1, a + row + 1, a + row);
                if !(poles[0] && j == 0) {
                    self.triangle(material, [a, b, c]);
                }
                if !(poles[1] && j + 1 == nv) {
                    self.triangle(material, [a, c, d]);
                }
            }
        }
    }
}
