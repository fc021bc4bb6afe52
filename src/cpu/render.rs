//! One frame, work-group by work-group. Twin of `kernels/render.wgsl`; what is a scalar in the kernel is an array over
//! the 64 lanes here.

use super::count::Count;
use super::shade::{Surface, phong, reflected_ray, rgba8, surface_at, unit};
use super::traverse::{GROUP, Lanes, Traverse, Triangles, bits};
use crate::backend::{Config, CountedPixel, GivenRay, Pixel, Size};
use crate::camera::{PixelGrid, View};
use crate::math::{MISS, Ray, T_MAX};
use crate::scene::{Light, Scene};
use glam::Vec3A;

const PRIMARY: usize = 0;
const SHADOW: usize = 1;
const REFLECTED: usize = 2;

/// Place of a lane in its group of pixels: Morton order.
fn place_in_group(i: u32) -> (u32, u32) {
    ((i & 1) | (i >> 1 & 2) | (i >> 2 & 4), (i >> 1 & 1) | (i >> 2 & 2) | (i >> 3 & 4))
}

/// One frame: the twin of the kernel's `Frame` and of its constants SHADOWS and BOUNCES.
pub struct Frame<'a> {
    /// Geometry, materials.
    pub scene: &'a Scene,
    /// Vertices and the structure's records.
    pub triangles: Triangles<'a>,
    /// Ray configuration.
    pub config: Config,
    /// Image size.
    pub size: Size,
    grid: PixelGrid,
    lights: &'a [Light],
    epsilon: f32,
}

/// The primary ray of a pixel (rows from the top), exactly as a frame casts it.
pub fn primary_ray(view: &View, size: Size, pixel: usize) -> GivenRay {
    let grid = view.camera.pixel_grid(size.width, size.height);
    let (column, row) = (pixel as u32 % size.width, pixel as u32 / size.width);
    GivenRay { origin: grid.origin, direction: pixel_direction(&grid, column, row).into() }
}

fn pixel_direction(grid: &PixelGrid, column: u32, row: u32) -> Vec3A {
    let x = column as f32 + 0.5;
    let y = row as f32 + 0.5;
    unit(Vec3A::from(grid.corner) + Vec3A::from(grid.right) * x + Vec3A::from(grid.down) * y)
}

impl<'a> Frame<'a> {
    /// A frame of a view. `epsilon` is [`crate::backend::surface_epsilon`] of the scene.
    pub fn new(
        scene: &'a Scene,
        triangles: Triangles<'a>,
        config: Config,
        view: &'a View,
        size: Size,
        epsilon: f32,
    ) -> Self {
        let grid = view.camera.pixel_grid(size.width, size.height);
        Frame { scene, triangles, config, size, grid, lights: &view.lights, epsilon }
    }

    fn primary_ray(&self, column: u32, row: u32) -> Ray {
        Ray::new(self.grid.origin.into(), pixel_direction(&self.grid, column, row))
    }

    /// Renders the group whose top left pixel is `(column, row)` and hands each pixel inside the image to `store` with
    /// its column and row.
    pub fn render_group<T: Traverse, C: Count>(
        &self,
        traversal: &T,
        (column, row): (u32, u32),
        mut store: impl FnMut(u32, u32, CountedPixel),
    ) {
        let place = |lane: usize| {
            let (x, y) = place_in_group(lane as u32);
            (column + x, row + y)
        };
        let inside = (0..GROUP)
            .filter(|&lane| place(lane).0 < self.size.width && place(lane).1 < self.size.height)
            .fold(0u64, |set, lane| set | 1 << lane);
        let mut counters = [[C::default(); GROUP]; 3];
        let mut rays: Lanes<Ray> = std::array::from_fn(|lane| self.primary_ray(place(lane).0, place(lane).1));
        let mut alive = inside;
        let mut colour = [Vec3A::ZERO; GROUP];
        let mut weight = [1.0f32; GROUP]; // product of the reflectivities on the way
        let mut first = [(MISS, T_MAX); GROUP];

        for bounce in 0..=self.config.bounces() {
            if alive == 0 {
                break;
            }

            // Find the nearest hit
            let kind = if bounce == 0 { PRIMARY } else { REFLECTED };
            bits(alive).for_each(|lane| counters[kind][lane].ray());
            let records = traversal.nearest_hits(&rays, alive, &mut counters[kind]);

            // Make it a surface; whatever is missed shows the background and is done
            let mut surfaces: Lanes<Option<Surface>> = [None; GROUP];
            for lane in bits(alive) {
                if records[lane] == MISS {
                    colour[lane] += Vec3A::from(self.scene.background) * weight[lane];
                    alive &= !(1 << lane);
                } else {
                    let surface = surface_at(self.triangles, self.scene, &rays[lane], records[lane], self.epsilon);
                    if bounce == 0 {
                        first[lane] = (surface.triangle, surface.t);
                    }
                    let material = &self.scene.materials[surface.material as usize];
                    colour[lane] += Vec3A::from(material.ambient) * weight[lane];
                    surfaces[lane] = Some(surface);
                }
            }
            if alive == 0 {
                break;
            }

            // Add the light of every lamp that is seen from there
            for light in self.lights {
                let mut lit = alive;
                if self.config.shadows() {
                    // From the light towards the point, which lies at distance 1
                    let origin = Vec3A::from(light.position);
                    let towards =
                        |lane: usize| surfaces[lane].map_or(rays[lane], |s| Ray::new(origin, s.point - origin));
                    let shadows: Lanes<Ray> = std::array::from_fn(towards);
                    bits(alive).for_each(|lane| counters[SHADOW][lane].ray());
                    lit &= !traversal.any_hits(&shadows, 1.0, alive, &mut counters[SHADOW]);
                }
                for lane in bits(lit) {
                    let Some(surface) = &surfaces[lane] else { continue };
                    let material = &self.scene.materials[surface.material as usize];
                    colour[lane] += phong(surface, material, light, rays[lane].direction) * weight[lane];
                }
            }

            // Go on in the mirror
            if self.config.bounces() > 0 {
                for lane in bits(alive) {
                    let Some(surface) = &surfaces[lane] else { continue };
                    let reflectivity = self.scene.materials[surface.material as usize].reflectivity;
                    if reflectivity <= 0.0 {
                        alive &= !(1 << lane);
                    }
                    weight[lane] *= reflectivity;
                    rays[lane] = reflected_ray(surface, rays[lane].direction);
                }
            }
        }

        for lane in bits(inside) {
            let (x, y) = place(lane);
            let (triangle, t) = first[lane];
            store(
                x,
                y,
                CountedPixel {
                    pixel: Pixel { triangle, rgba: rgba8(colour[lane]) },
                    t: t.to_bits(),
                    pad: 0,
                    counters: std::array::from_fn(|kind| counters[kind][lane].total()),
                },
            );
        }
    }
}
