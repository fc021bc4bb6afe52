//! The twins as a device: [`Backend`] and [`Prepared`] over a pool of threads.

use super::count::{Count, CountOff};
use super::render::Frame;
use super::trace::trace_group;
use super::traverse::bvh_stack::STACK_SIZE;
use super::traverse::{GROUP, Traverse, Triangles, brute, bvh, bvh_stack, grid, kdtree};
use crate::accel::{Record, Structure, Traversal};
use crate::backend::*;
use crate::camera::View;
use crate::error::{Error, Result};
use crate::math::Hit;
use crate::scene::{Light, Material, Scene};
use bytemuck::Zeroable;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::time::Instant;

/// The CPU twins, on their own pool of threads.
pub struct CpuBackend {
    info: DeviceInfo,
    pool: rayon::ThreadPool,
}

impl CpuBackend {
    /// A pool of `threads`; 0 takes one per processor.
    ///
    /// # Errors
    /// [`Error::Device`] if the threads cannot be started.
    pub fn new(threads: usize) -> Result<CpuBackend> {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .map_err(|e| Error::Device(format!("cannot start {threads} threads: {e}")))?;
        let info = DeviceInfo {
            name: processor_name(),
            device_type: DeviceType::CpuTwin,
            backend: "cpu".into(),
            driver: String::new(),
            timestamp_period_ns: None,
            checked: true,
            features: Vec::new(),
            limits: BTreeMap::new(),
            threads: Some(pool.current_num_threads()),
        };
        Ok(CpuBackend { info, pool })
    }
}

/// The processor's name as the system gives it, or `CPU`.
fn processor_name() -> String {
    let Ok(mut system) = sysinfo::System::new() else {
        return "CPU".into();
    };
    system.refresh_cpu_all();
    match system.cpus().first().map(|cpu| cpu.brand().trim()) {
        Some(name) if !name.is_empty() => name.into(),
        _ => "CPU".into(),
    }
}

impl Backend for CpuBackend {
    fn info(&self) -> &DeviceInfo {
        &self.info
    }

    fn prepare<'a>(
        &'a self,
        scene: &'a Scene,
        structure: &'a Structure,
        traversal: Traversal,
    ) -> Result<Box<dyn Prepared + 'a>> {
        let triangles = |records| Triangles { vertices: &scene.vertices, records };
        let check_depth = |depth: u32| match (depth as usize) + 1 < STACK_SIZE {
            true => Ok(()),
            false => {
                Err(Error::Device(format!("the tree is {depth} levels deep, the twins' stack holds {STACK_SIZE}")))
            }
        };
        Ok(match (structure, traversal) {
            (Structure::Brute(b), Traversal::Brute) => {
                let triangles = triangles(&b.records);
                self.with(scene, structure, triangles, brute::Brute { triangles })
            }
            (Structure::Grid(g), Traversal::Grid) => {
                let triangles = triangles(&g.records);
                self.with(scene, structure, triangles, grid::Grid::new(triangles, g))
            }
            (Structure::KdTree(tree), Traversal::KdTree) => {
                let triangles = triangles(&tree.records);
                self.with(scene, structure, triangles, kdtree::KdTree { triangles, tree })
            }
            (Structure::Bvh(b), Traversal::Bvh) => {
                check_depth(b.depth)?;
                let triangles = triangles(&b.records);
                self.with(scene, structure, triangles, bvh::Bvh::new(triangles, b))
            }
            (Structure::Bvh(b), Traversal::BvhStack) => {
                check_depth(b.depth)?;
                let triangles = triangles(&b.records);
                self.with(scene, structure, triangles, bvh_stack::BvhStack::new(triangles, b))
            }
            _ => return Err(Error::Device(format!("{traversal:?} cannot walk this structure"))),
        })
    }
}

impl CpuBackend {
    fn with<'a, T: Traverse + 'a>(
        &'a self,
        scene: &'a Scene,
        structure: &'a Structure,
        triangles: Triangles<'a>,
        traversal: T,
    ) -> Box<dyn Prepared + 'a> {
        let epsilon = surface_epsilon(scene.bounds());
        Box::new(CpuPrepared { pool: &self.pool, scene, structure, triangles, traversal, epsilon, timed: Vec::new() })
    }
}

struct CpuPrepared<'a, T> {
    pool: &'a rayon::ThreadPool,
    scene: &'a Scene,
    structure: &'a Structure,
    triangles: Triangles<'a>,
    traversal: T,
    epsilon: f32,
    /// The timed image, kept between frames like a device's buffer.
    timed: Vec<Pixel>,
}

impl<'a, T: Traverse> CpuPrepared<'a, T> {
    /// Renders rows `first_row..` as many as `out` holds, whole groups of rows at a time, in parallel.
    fn render<C: Count, P: Copy + Send>(
        &self,
        frame: &Frame,
        first_row: u32,
        out: &mut [P],
        convert: impl Fn(CountedPixel) -> P + Sync,
    ) {
        let width = frame.size.width;
        let strip = (width * GROUP_SIDE) as usize;
        self.pool.install(|| {
            out.par_chunks_mut(strip).enumerate().for_each(|(index, pixels)| {
                let top = first_row + index as u32 * GROUP_SIDE;
                for column in (0..width).step_by(GROUP_SIDE as usize) {
                    frame.render_group::<T, C>(&self.traversal, (column, top), |x, y, pixel| {
                        pixels[((y - top) * width + x) as usize] = convert(pixel);
                    });
                }
            });
        });
    }

    fn frame<'f>(&self, config: Config, view: &'f View, size: Size) -> Frame<'f>
    where
        'a: 'f,
    {
        Frame::new(self.scene, self.triangles, config, view, size, self.epsilon)
    }
}

/// Rows per band of the counting pass: about 256k pixels.
fn band_rows(size: Size) -> u32 {
    (262_144 / size.width).max(1).next_multiple_of(GROUP_SIDE)
}

impl<T: Traverse> Prepared for CpuPrepared<'_, T> {
    fn image(&mut self, config: Config, view: &View, size: Size) -> Result<Vec<Pixel>> {
        let mut pixels = vec![Pixel { triangle: POISON, rgba: POISON }; size.pixels()];
        self.render::<CountOff, _>(&self.frame(config, view, size), 0, &mut pixels, |p| p.pixel);
        Ok(pixels)
    }

    fn counted(
        &mut self,
        config: Config,
        view: &View,
        size: Size,
        band: &mut dyn FnMut(u32, &[CountedPixel]),
    ) -> Result<()> {
        let frame = self.frame(config, view, size);
        for first_row in (0..size.height).step_by(band_rows(size) as usize) {
            let rows = band_rows(size).min(size.height - first_row);
            let mut poison = CountedPixel::zeroed();
            poison.pixel = Pixel { triangle: POISON, rgba: POISON };
            let mut pixels = vec![poison; (rows * size.width) as usize];
            self.render::<Counters, _>(&frame, first_row, &mut pixels, |p| p);
            band(first_row, &pixels);
        }
        Ok(())
    }

    fn time_path(
        &mut self,
        config: Config,
        views: &[View],
        size: Size,
        interrupted: Interrupted,
    ) -> Result<Vec<FrameTime>> {
        let mut pixels = std::mem::take(&mut self.timed);
        pixels.resize(size.pixels(), Pixel::zeroed());
        let mut times = Vec::with_capacity(views.len());
        let mut last = Instant::now();
        for view in views {
            if interrupted() {
                return Err(Error::Interrupted);
            }
            self.render::<CountOff, _>(&self.frame(config, view, size), 0, &mut pixels, |p| p.pixel);
            let now = Instant::now();
            times.push(FrameTime { device_ns: None, wall_ns: (now - last).as_nanos() as u64 });
            last = now;
        }
        self.timed = pixels;
        Ok(times)
    }

    fn trace(&mut self, rays: &[GivenRay], any_hit: bool) -> Result<Vec<Hit>> {
        let mut hits = vec![Hit::NONE; rays.len()];
        self.pool.install(|| {
            hits.par_chunks_mut(GROUP).zip(rays.par_chunks(GROUP)).for_each(|(hits, rays)| {
                trace_group(&self.traversal, self.triangles, rays, any_hit, hits);
            });
        });
        Ok(hits)
    }

    fn allocated(&self) -> (u64, u64) {
        let bytes = |n: usize, each: usize| (n * each) as u64;
        let geometry = bytes(self.scene.vertices.len(), size_of::<crate::math::Vertex>())
            + bytes(self.scene.materials.len(), size_of::<Material>())
            + bytes(self.scene.triangles.len(), size_of::<u32>())
            + bytes(self.scene.lights.len(), size_of::<Light>());
        let nodes = match self.structure {
            Structure::Brute(_) => 0,
            Structure::Grid(g) => std::mem::size_of_val(g.cells.as_slice()) as u64,
            Structure::KdTree(k) => std::mem::size_of_val(k.nodes.as_slice()) as u64,
            Structure::Bvh(b) => std::mem::size_of_val(b.nodes.as_slice()) as u64,
        };
        (geometry, nodes + bytes(self.triangles.records.len(), size_of::<Record>()))
    }
}
