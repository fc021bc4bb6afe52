//! The twins as a device: [`Backend`] and [`Prepared`] over a pool of threads.

use crate::camera::View;
use crate::error::{Error, Result};
use crate::math::Hit;
use crate::scene::Scene;
use crate::threads;
use crate::workloads::trace::backend::*;
use crate::workloads::trace::bvh::stack::STACK_SIZE;
use crate::workloads::trace::count::{Count, CountOff};
use crate::workloads::trace::given::trace_group;
use crate::workloads::trace::method::{Group, MAX_SHORT_STACK};
use crate::workloads::trace::render::Frame;
use crate::workloads::trace::traverse::{GROUP, Traverse, Triangles};
use crate::workloads::trace::{Method, Structure, Traversal};
use crate::workloads::trace::{brute, bvh, grid, kdtree};
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
    /// Those of [`threads::pool`].
    pub fn new(threads: usize) -> Result<CpuBackend> {
        let pool = threads::pool(threads)?;
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
        method: Method,
    ) -> Result<Box<dyn Prepared + 'a>> {
        let triangles = |triangle_refs| Triangles { vertices: &scene.vertices, triangle_refs, test: method.intersect };
        let check_depth = |depth: u32| match (depth as usize) + 1 < STACK_SIZE {
            true => Ok(()),
            false => {
                Err(Error::Device(format!("the tree is {depth} levels deep, the twins' stack holds {STACK_SIZE}")))
            }
        };
        if method.traversal.is_cooperative() && method.group.size() as usize > GROUP {
            let Group { width, height } = method.group;
            return Err(Error::Device(format!("a packet of {width}x{height} is larger than {GROUP} rays")));
        }
        Ok(match (structure, method.traversal) {
            (Structure::Brute(b), Traversal::Brute) => {
                let triangles = triangles(&b.triangle_refs);
                self.with((scene, structure, triangles), method, brute::scan::Brute { triangles })
            }
            (Structure::Grid(g), Traversal::Grid) => {
                let triangles = triangles(&g.triangle_refs);
                self.with((scene, structure, triangles), method, grid::dda::Grid::new(triangles, g))
            }
            (Structure::Grid(g), Traversal::GridCoop) => {
                let triangles = triangles(&g.triangle_refs);
                let grid = grid::dda::Grid::new(triangles, g);
                self.with((scene, structure, triangles), method, grid::coop::GridCoop { grid })
            }
            (Structure::Grid(g), Traversal::GridPacket) => {
                let triangles = triangles(&g.triangle_refs);
                let grid = grid::dda::Grid::new(triangles, g);
                self.with((scene, structure, triangles), method, grid::packet::GridPacket { grid })
            }
            (Structure::KdTree(tree), Traversal::KdTree(search)) => {
                let triangles = triangles(&tree.triangle_refs);
                if search.stack as usize <= kdtree::search::SMALL {
                    let twin = kdtree::search::KdTree::<{ kdtree::search::SMALL }> { triangles, tree, search };
                    self.with((scene, structure, triangles), method, twin)
                } else {
                    let twin = kdtree::search::KdTree::<{ MAX_SHORT_STACK as usize }> { triangles, tree, search };
                    self.with((scene, structure, triangles), method, twin)
                }
            }
            (Structure::Bvh(b), Traversal::Bvh(vote)) => {
                check_depth(b.depth)?;
                let triangles = triangles(&b.triangle_refs);
                self.with((scene, structure, triangles), method, bvh::packet::Bvh::new(triangles, b, vote))
            }
            (Structure::Bvh(b), Traversal::BvhStack) => {
                check_depth(b.depth)?;
                let triangles = triangles(&b.triangle_refs);
                self.with((scene, structure, triangles), method, bvh::stack::BvhStack::new(triangles, b))
            }
            _ => return Err(Error::Device(format!("{:?} cannot walk this structure", method.traversal))),
        })
    }
}

impl CpuBackend {
    fn with<'a, T: Traverse + 'a>(
        &'a self,
        (scene, structure, triangles): (&'a Scene, &'a Structure, Triangles<'a>),
        method: Method,
        traversal: T,
    ) -> Box<dyn Prepared + 'a> {
        let lengths = Lengths::new(scene.bounds());
        let (pool, timed) = (&self.pool, Vec::new());
        Box::new(CpuPrepared { pool, scene, structure, triangles, method, traversal, lengths, timed })
    }
}

struct CpuPrepared<'a, T> {
    pool: &'a rayon::ThreadPool,
    scene: &'a Scene,
    structure: &'a Structure,
    triangles: Triangles<'a>,
    method: Method,
    traversal: T,
    lengths: Lengths,
    /// The timed image, kept between frames like a device's buffer.
    timed: Vec<Pixel>,
}

impl<'a, T: Traverse> CpuPrepared<'a, T> {
    /// Renders a tile into `out`, which holds its rows in full width; whole groups of rows at a time, in parallel.
    fn render<C: Count, P: Copy + Send>(
        &self,
        frame: &Frame,
        tile: Tile,
        out: &mut [P],
        convert: impl Fn(CountedPixel) -> P + Sync,
    ) {
        let width = frame.size.width;
        let strip = (width * frame.group.height) as usize;
        self.pool.install(|| {
            out.par_chunks_mut(strip).enumerate().for_each(|(index, pixels)| {
                let top = tile.row + index as u32 * frame.group.height;
                for column in (tile.column..tile.column + tile.columns).step_by(frame.group.width as usize) {
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
        Frame::new(self.scene, self.triangles, self.method, (config, view, size), self.lengths)
    }

    /// A whole frame, tile by tile.
    fn timed_frame(&self, config: Config, view: &View, size: Size, pixels: &mut [Pixel]) {
        let frame = self.frame(config, view, size);
        for tile in tiles(size, self.method.tiles, self.method.tiles, frame.group) {
            let rows = &mut pixels[(tile.row * size.width) as usize..][..(tile.rows * size.width) as usize];
            self.render::<CountOff, _>(&frame, tile, rows, |p| p.pixel);
        }
    }
}

/// Pixels per band of the counting pass, about.
const BAND_PIXELS: u32 = 262_144;

impl<T: Traverse> Prepared for CpuPrepared<'_, T> {
    fn image(&mut self, config: Config, view: &View, size: Size) -> Result<Vec<Pixel>> {
        let mut pixels = vec![Pixel { triangle: POISON, rgba: POISON }; size.pixels()];
        self.timed_frame(config, view, size, &mut pixels);
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
        for tile in tiles(size, 1, (size.pixels() as u32).div_ceil(BAND_PIXELS), frame.group) {
            let mut poison = CountedPixel::zeroed();
            poison.pixel = Pixel { triangle: POISON, rgba: POISON };
            let mut pixels = vec![poison; (tile.rows * size.width) as usize];
            self.render::<Counters, _>(&frame, tile, &mut pixels, |p| p);
            band(tile.row, &pixels);
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
        pixels.clear();
        pixels.resize(size.pixels(), Pixel { triangle: POISON, rgba: POISON });
        let mut times = Vec::with_capacity(views.len());
        let mut last = Instant::now();
        for view in views {
            if interrupted() {
                return Err(Error::Interrupted);
            }
            self.timed_frame(config, view, size, &mut pixels);
            let now = Instant::now();
            times.push(FrameTime { device_ns: None, wall_ns: (now - last).as_nanos() as u64 });
            last = now;
        }
        self.timed = pixels;
        Ok(times)
    }

    fn timed(&mut self) -> Result<Timed> {
        Ok(Timed { pixels: self.timed.clone(), dispatches: 0 })
    }

    fn trace(&mut self, rays: &[GivenRay], any_hit: bool) -> Result<Vec<Hit>> {
        trace_units(rays, 0, |rays| {
            let mut hits = vec![Hit::NONE; rays.len()];
            self.pool.install(|| {
                hits.par_chunks_mut(GROUP).zip(rays.par_chunks(GROUP)).for_each(|(hits, rays)| {
                    trace_group(&self.traversal, self.triangles, rays, any_hit, hits);
                });
            });
            Ok(hits)
        })
    }

    fn allocated(&self) -> (u64, u64) {
        (self.scene.geometry_bytes(), self.structure.structure_bytes())
    }
}
