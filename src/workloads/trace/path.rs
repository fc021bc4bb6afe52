//! What a pixel's path is made of: primary rays, and one segment with its surface and its light. Twin of
//! `kernels/trace/path.wgsl`; what is a scalar in the kernel is an array over the 64 lanes here.

use crate::camera::{PixelGrid, View};
use crate::math::{MISS, Ray, T_MAX};
use crate::scene::{Light, Scene};
use crate::workloads::trace::Method;
use crate::workloads::trace::backend::{ByRayType, Config, CountedPixel, GivenRay, Lengths, Pixel, RAY_TYPES, Size};
use crate::workloads::trace::count::Tally;
use crate::workloads::trace::method::{Group, Pattern, ShadowRays};
use crate::workloads::trace::shade::{Surface, normalize3, phong, reflected_ray, rgba8, surface_at};
use crate::workloads::trace::traverse::{GROUP, Lanes, Traverser, Triangles, bits, set_of};
use glam::Vec3A;

/// Indices of the ray types.
pub const PRIMARY: usize = 0;
const SHADOW: usize = 1;
/// See [`PRIMARY`].
pub const REFLECTED: usize = 2;
/// See [`PRIMARY`].
pub const AMBIENT: usize = 3;
/// See [`PRIMARY`].
pub const DIFFUSE: usize = 4;

/// One frame: the twin of the kernel's `Frame` and of its constants.
pub struct Frame<'a> {
    /// Geometry, materials.
    pub scene: &'a Scene,
    /// Vertices and the structure's triangle references.
    pub triangles: Triangles<'a>,
    /// Ray configuration.
    pub config: Config,
    /// Image size.
    pub size: Size,
    /// Rays that go together: the method's work-group where that matters to the traversal, otherwise 8 x 8.
    pub group: Group,
    /// Where each of them lies in its group.
    pub places: Lanes<(u32, u32)>,
    method: Method,
    grid: PixelGrid,
    lights: &'a [Light],
    /// Lengths of secondary rays.
    pub lengths: Lengths,
}

/// The paths of a group's pixels.
pub struct Paths<C> {
    /// Their next segments.
    pub rays: Lanes<Ray>,
    /// A bit for each path that has a next segment.
    pub alive: u64,
    /// Gathered so far.
    pub colour: Lanes<Vec3A>,
    /// Products of the reflectivities on the way.
    pub weight: Lanes<f32>,
    /// Triangles and distances that the primary rays hit.
    pub first: Lanes<(u32, f32)>,
    /// By ray type.
    pub counters: ByRayType<Lanes<C>>,
}

/// The primary ray of a pixel (rows from the top), exactly as a frame casts it.
pub fn primary_ray(method: Method, view: &View, size: Size, pixel: usize) -> GivenRay {
    let grid = view.camera.pixel_grid(size.width, size.height);
    let point = sample_position(method, size, pixel as u32 % size.width, pixel as u32 / size.width);
    GivenRay { origin: grid.origin, direction: direction_through(&grid, point).into() }
}

/// The position in the image, in pixels from its top left corner, that the ray of a pixel goes through: the middle of
/// the pixel, or one of four points at a quarter and three quarters of the image's sides.
fn sample_position(method: Method, size: Size, column: u32, row: u32) -> [f32; 2] {
    match method.pattern {
        Pattern::Image => [column as f32 + 0.5, row as f32 + 0.5],
        Pattern::Four => {
            let one_of = |place: u32, group: u32, side: u32| side as f32 * (0.25 + 0.5 * ((place / group) & 1) as f32);
            [one_of(column, method.group.width, size.width), one_of(row, method.group.height, size.height)]
        }
    }
}

fn direction_through(grid: &PixelGrid, [x, y]: [f32; 2]) -> Vec3A {
    normalize3(Vec3A::from(grid.corner) + Vec3A::from(grid.right) * x + Vec3A::from(grid.down) * y)
}

/// Between light and point, of which one is at distance 0 and the other at distance 1.
fn shadow_ray(direction: ShadowRays, light: Vec3A, point: Vec3A, reach: f32) -> Ray {
    match direction {
        ShadowRays::FromLight => {
            let start = shadow_start(light, point, reach);
            Ray::new(start, point - start)
        }
        ShadowRays::ToLight => Ray::new(point, light - point),
    }
}

/// The light, or the point towards it at the greatest distance at which a shadow ray starts.
pub(crate) fn shadow_start(light: Vec3A, point: Vec3A, reach: f32) -> Vec3A {
    let way = light - point;
    let distance = way.dot(way).sqrt();
    if distance > reach { point + way * (reach / distance) } else { light }
}

impl<'a> Frame<'a> {
    /// A frame of a view.
    pub fn new(
        scene: &'a Scene,
        triangles: Triangles<'a>,
        method: Method,
        (config, view, size): (Config, &'a View, Size),
        lengths: Lengths,
    ) -> Self {
        let grid = view.camera.pixel_grid(size.width, size.height);
        let group = if method.traversal.cooperative { method.group } else { Group::SQUARE };
        let places = std::array::from_fn(|lane| group.place(lane as u32));
        Frame { scene, triangles, config, size, group, places, method, grid, lights: &view.lights, lengths }
    }

    fn primary_ray(&self, column: u32, row: u32) -> Ray {
        let point = sample_position(self.method, self.size, column, row);
        Ray::new(self.grid.origin.into(), direction_through(&self.grid, point))
    }

    /// A bit for each pixel of the group whose top left pixel is `(column, row)` that is inside the image.
    pub fn inside(&self, (column, row): (u32, u32)) -> u64 {
        let is_inside = |&lane: &usize| {
            let (x, y) = self.places[lane];
            column + x < self.size.width && row + y < self.size.height
        };
        set_of((0..self.group.size() as usize).filter(is_inside))
    }

    /// The primary rays of a group whose top left pixel is `(column, row)`; `inside` says which pixels are in the
    /// image.
    pub fn start_paths<C: Tally>(&self, (column, row): (u32, u32), inside: u64) -> Paths<C> {
        Paths {
            rays: std::array::from_fn(|lane| {
                let (x, y) = self.places[lane];
                self.primary_ray(column + x, row + y)
            }),
            alive: inside,
            colour: [Vec3A::ZERO; GROUP],
            weight: [1.0; GROUP],
            first: [(MISS, T_MAX); GROUP],
            counters: [[C::default(); GROUP]; RAY_TYPES.len()],
        }
    }

    /// Hands each pixel inside the image of the group whose top left pixel is `(column, row)` to `store`, with its
    /// column and row.
    pub fn store<C: Tally>(
        &self,
        paths: &Paths<C>,
        (column, row): (u32, u32),
        mut store: impl FnMut(u32, u32, CountedPixel),
    ) {
        for lane in bits(self.inside((column, row))) {
            let (x, y) = self.places[lane];
            store(column + x, row + y, paths.pixel(lane));
        }
    }

    /// Traces the segments of rays of this kind, adds their light, and makes the mirrored rays the next ones. False if
    /// nothing was hit.
    pub fn follow<C: Tally>(&self, traversal: &dyn Traverser, kind: usize, paths: &mut Paths<C>) -> bool {
        let Paths { rays, alive, counters, .. } = paths;
        bits(*alive).for_each(|lane| counters[kind][lane].ray());
        let triangle_refs = traversal.nearest_hits(kind, rays, *alive, &mut counters[kind]);
        self.follow_hits(traversal, kind, paths, &triangle_refs)
    }

    /// The surfaces at the nearest hits of segments. Paths whose rays miss show the background and are done.
    pub fn surfaces<C: Tally>(
        &self,
        kind: usize,
        paths: &mut Paths<C>,
        triangle_refs: &Lanes<u32>,
    ) -> Lanes<Option<Surface>> {
        let mut surfaces = [None; GROUP];
        for lane in bits(paths.alive) {
            if triangle_refs[lane] == MISS {
                paths.colour[lane] += Vec3A::from(self.scene.background) * paths.weight[lane];
                paths.alive &= !(1 << lane);
            } else {
                let (ray, epsilon) = (&paths.rays[lane], self.lengths.epsilon);
                let surface = surface_at(self.triangles, self.scene, ray, triangle_refs[lane], epsilon);
                if kind == PRIMARY {
                    paths.first[lane] = (surface.triangle, surface.t);
                }
                surfaces[lane] = Some(surface);
            }
        }
        surfaces
    }

    /// The same as [`Frame::follow`] for segments whose nearest hits are known.
    pub fn follow_hits<C: Tally>(
        &self,
        traversal: &dyn Traverser,
        kind: usize,
        paths: &mut Paths<C>,
        triangle_refs: &Lanes<u32>,
    ) -> bool {
        let surfaces = self.surfaces(kind, paths, triangle_refs);
        let Paths { rays, alive, colour, weight, counters, .. } = paths;
        if *alive == 0 {
            return false;
        }
        for lane in bits(*alive) {
            let Some(surface) = &surfaces[lane] else { continue };
            colour[lane] += Vec3A::from(self.scene.materials[surface.material as usize].ambient) * weight[lane];
        }

        // Add the light of every lamp that is seen from there
        for light in self.lights {
            let mut lit = *alive;
            if self.config.shadows() {
                let position = Vec3A::from(light.position);
                let shadow = |s: Surface| shadow_ray(self.method.shadows, position, s.point, self.lengths.reach);
                let shadows: Lanes<Ray> = std::array::from_fn(|lane| surfaces[lane].map_or(rays[lane], shadow));
                bits(*alive).for_each(|lane| counters[SHADOW][lane].ray());
                lit &= !traversal.any_hits(SHADOW, &shadows, 1.0, *alive, &mut counters[SHADOW]);
            }
            for lane in bits(lit) {
                let Some(surface) = &surfaces[lane] else { continue };
                let material = &self.scene.materials[surface.material as usize];
                colour[lane] += phong(surface, material, light, rays[lane].direction) * weight[lane];
            }
        }

        // Go on in the mirror
        if self.config.bounces() > 0 {
            for lane in bits(*alive) {
                let Some(surface) = &surfaces[lane] else { continue };
                let reflectivity = self.scene.materials[surface.material as usize].reflectivity;
                if reflectivity <= 0.0 {
                    *alive &= !(1 << lane);
                }
                weight[lane] *= reflectivity;
                rays[lane] = reflected_ray(surface, rays[lane].direction);
            }
        }
        true
    }
}

impl<C: Tally> Paths<C> {
    /// What is known of a pixel so far.
    pub fn pixel(&self, lane: usize) -> CountedPixel {
        let (triangle, t) = self.first[lane];
        CountedPixel {
            pixel: Pixel { triangle, rgba: rgba8(self.colour[lane]) },
            t: t.to_bits(),
            pad: 0,
            counters: std::array::from_fn(|kind| self.counters[kind][lane].total()),
        }
    }
}
