//! Ray tracing by the twins on a pool of threads.

use crate::camera::View;
use crate::device::CpuDevice;
use crate::error::{Error, Result};
use crate::math::Hit;
use crate::scene::Scene;
use crate::workloads::trace::backend::*;
use crate::workloads::trace::count::{CountOff, Tally};
use crate::workloads::trace::given::{TraceRay, trace_group};
use crate::workloads::trace::method::{Group, TriangleLayout};
use crate::workloads::trace::path::Frame;
use crate::workloads::trace::render::render_group;
use crate::workloads::trace::simt::{self, InWarps, Sums, TestReads};
use crate::workloads::trace::staged::{Waiting, bounce_group, primary_group};
use crate::workloads::trace::traverse::{GROUP, STACK_SIZE, Traverse, Traverser, Triangles};
use crate::workloads::trace::{Method, Structure, Traversal};
use bytemuck::Zeroable;
use rayon::prelude::*;

/// A twin, ready to be run on a structure that it can walk.
pub type Twin = for<'a> fn(TwinInput<'a>) -> Result<Box<dyn Prepared + 'a>>;

/// What a twin is made of.
#[derive(Clone, Copy)]
pub struct TwinInput<'a> {
    device: &'a CpuDevice,
    scene: &'a Scene,
    structure: &'a dyn Structure,
    /// How rays are traced.
    pub method: Method,
}

impl<'a> TwinInput<'a> {
    /// The structure.
    ///
    /// # Errors
    /// [`Error::Refused`] if it is of another type.
    pub fn structure<S: Structure>(&self) -> Result<&'a S> {
        self.structure.downcast_ref().ok_or_else(|| cannot_walk(self.method.traversal, self.structure))
    }

    /// Vertices and triangle references.
    pub fn triangles(&self) -> Triangles<'a> {
        let (vertices, triangle_refs) = (&self.scene.vertices, self.structure.triangle_refs());
        Triangles { vertices, triangle_refs, test: self.method.intersect }
    }

    /// The traversal, ready for frames and rays.
    pub fn with<T: Traverse + 'a>(self, traversal: T) -> Box<dyn Prepared + 'a> {
        let TwinInput { device, scene, structure, method } = self;
        let (triangles, lengths) = (self.triangles(), Lengths::new(scene.bounds()));
        let traversal = Box::new(traversal);
        Box::new(CpuPrepared { device, scene, structure, triangles, method, traversal, lengths, timed: Vec::new() })
    }
}

/// The refusal of a structure that a traversal is not made for.
pub(super) fn cannot_walk(traversal: &Traversal, structure: &dyn Structure) -> Error {
    Error::unsupported(format!("{} cannot walk a {}", traversal.kernel, structure.kind().name))
}

impl Backend for CpuDevice {
    fn info(&self) -> &DeviceInfo {
        CpuDevice::info(self)
    }

    fn prepare<'a>(
        &'a self,
        scene: &'a Scene,
        structure: &'a dyn Structure,
        method: Method,
    ) -> Result<Box<dyn Prepared + 'a>> {
        let depth = structure.stack_depth();
        if depth as usize + 1 >= STACK_SIZE {
            let problem =
                format!("a ray may have to keep {depth} nodes, and the stack of the twins holds {STACK_SIZE}");
            return Err(Error::too_large(
                "the tree",
                problem,
                "set another max_depth or max_leaf, where the builder has them",
            ));
        }
        if method.traversal.cooperative && method.group.size() as usize > GROUP {
            let Group { width, height } = method.group;
            return Err(Error::unsupported(format!("a packet of {width}x{height}, which is more than {GROUP} rays")));
        }
        match method.traversal.twin {
            Some(twin) => twin(TwinInput { device: self, scene, structure, method }),
            None => {
                Err(Error::unsupported(format!("{} has no CPU twin: choose a Vulkan device", method.traversal.kernel)))
            }
        }
    }
}

/// Rows of an image.
struct Strip<'a, P> {
    /// The first one.
    top: u32,
    width: u32,
    pixels: &'a mut [P],
}

impl<P> Strip<'_, P> {
    fn set(&mut self, column: u32, row: u32, pixel: P) {
        self.pixels[((row - self.top) * self.width + column) as usize] = pixel;
    }
}

struct CpuPrepared<'a> {
    device: &'a CpuDevice,
    scene: &'a Scene,
    structure: &'a dyn Structure,
    triangles: Triangles<'a>,
    method: Method,
    traversal: Box<dyn Traverser + 'a>,
    lengths: Lengths,
    /// The timed image, kept between frames like a device's buffer.
    timed: Vec<Pixel>,
}

impl<'a> CpuPrepared<'a> {
    /// Renders a tile into `out`, which holds its rows in full width.
    fn render<C: Tally, P: Copy + Send>(
        &self,
        traversal: &dyn Traverser,
        frame: &Frame,
        tile: Tile,
        out: &mut [P],
        convert: impl Fn(CountedPixel) -> P + Sync,
    ) {
        self.device.pool().install(|| match self.method.is_staged(frame.config.bounces()) {
            false => {
                self.groups(frame, tile, out, |corner, pixels| {
                    render_group::<C>(frame, traversal, corner, |x, y, p| pixels.set(x, y, convert(p)));
                });
            }
            true => self.staged::<C, P>(traversal, frame, tile, out, &convert),
        });
    }

    /// Calls `group` for the top left pixel of every work-group of a tile, rows of groups in parallel, each with its
    /// rows of `out`; what it returns, in the order of rows.
    fn groups<P: Send, R: Send>(
        &self,
        frame: &Frame,
        tile: Tile,
        out: &mut [P],
        group: impl Fn((u32, u32), &mut Strip<P>) -> R + Sync,
    ) -> Vec<R> {
        let width = frame.size.width;
        let strips = out.par_chunks_mut((width * frame.group.height) as usize).enumerate();
        let strips = strips.map(|(index, pixels)| {
            let mut strip = Strip { top: tile.row + index as u32 * frame.group.height, width, pixels };
            let columns = (tile.column..tile.column + tile.columns).step_by(frame.group.width as usize);
            columns.map(|column| group((column, strip.top), &mut strip)).collect::<Vec<_>>()
        });
        strips.collect::<Vec<_>>().into_iter().flatten().collect()
    }

    /// Pass by pass.
    fn staged<C: Tally, P: Copy + Send>(
        &self,
        traversal: &dyn Traverser,
        frame: &Frame,
        tile: Tile,
        out: &mut [P],
        convert: &(impl Fn(CountedPixel) -> P + Sync),
    ) {
        let lists = self.groups(frame, tile, out, |corner, pixels| {
            let mut list = Vec::new();
            primary_group::<C>(frame, traversal, corner, &mut list, |x, y, pixel| {
                pixels.set(x, y, convert(pixel));
            });
            list
        });
        let mut list = lists.concat();
        for _ in 0..frame.config.bounces() {
            let passed = list.par_chunks(GROUP).map(|paths| bounce_group::<C>(frame, traversal, paths));
            let (pixels, next): (Vec<Vec<CountedPixel>>, Vec<Vec<Waiting<C>>>) = passed.unzip();
            for (path, pixel) in list.iter().zip(pixels.into_iter().flatten()) {
                let (x, y) = path.place;
                out[((y - tile.row) * frame.size.width + x) as usize] = convert(pixel);
            }
            list = next.concat();
        }
    }

    /// The traversal, counting what warps of `width` lanes issue.
    ///
    /// # Errors
    /// [`Error::Refused`] where that is not modelled.
    fn warps_of(&self, frame: &Frame, width: u32) -> Result<InWarps<'_>> {
        let Some(lockstep) = self.method.traversal.lockstep else {
            return Err(Error::unsupported(format!(
                "how lanes of {} wait is not modelled",
                self.method.traversal.kernel
            )));
        };
        // The twin goes through 8 x 8 pixels, the kernel through its own group: lanes must have the same order in both
        let asked = self.method.group;
        if (0..frame.group.size()).any(|lane| asked.place(lane) != frame.group.place(lane)) {
            let Group { width, height } = asked;
            return Err(Error::unsupported(format!("warps of a work-group of {width}x{height} are not modelled")));
        }
        let group = simt::Group { size: frame.group.size(), width };
        // Counts do not depend on a device: `auto` is what a GPU does
        let tests = match self.method.triangles {
            TriangleLayout::LeafOrder => TestReads::LeafOrder,
            TriangleLayout::Indexed | TriangleLayout::Auto => TestReads::Indexed(self.triangles.triangle_refs),
        };
        Ok(InWarps::new(&*self.traversal, lockstep(&self.method.parameters), group, tests))
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
            self.render::<CountOff, _>(&*self.traversal, &frame, tile, rows, |p| p.pixel);
        }
    }
}

impl Prepared for CpuPrepared<'_> {
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
            self.render::<Counters, _>(&*self.traversal, &frame, tile, &mut pixels, |p| p);
            band(tile.row, &pixels);
        }
        Ok(())
    }

    fn in_warps(&mut self, config: Config, view: &View, size: Size, warps: Warps) -> Result<ByRayType<Sums>> {
        let frame = self.frame(config, view, size);
        let in_warps = self.warps_of(&frame, warps.width)?;
        let count = |tile: Tile| {
            let mut out = vec![(); (tile.rows * size.width) as usize];
            self.render::<Counters, _>(&in_warps, &frame, tile, &mut out, |_| ());
        };
        if warps.every == 1 {
            let down = (size.pixels() as u32).div_ceil(BAND_PIXELS);
            tiles(size, 1, down, frame.group).into_iter().for_each(count);
        } else {
            let (columns, rows) = (STRIPE * frame.group.width, frame.group.height);
            let stripe = |(down, across): (u32, u32)| {
                let (column, row) = (across * columns, down * rows);
                Tile { column, columns: columns.min(size.width - column), row, rows: rows.min(size.height - row) }
            };
            let places = |down| (0..size.width.div_ceil(columns)).map(move |across| (down, across));
            let all: Vec<_> = (0..size.height.div_ceil(rows)).flat_map(places).collect();
            let counted = all.into_par_iter().filter(|(down, across)| (down + across).is_multiple_of(warps.every));
            self.device.pool().install(|| counted.map(stripe).for_each(count));
        }
        in_warps.sums().map_err(Error::Device)
    }

    fn utilisation(&mut self, config: Config, view: &View, size: Size, width: u32) -> Result<Vec<u32>> {
        if self.method.is_staged(config.bounces()) {
            return Err(Error::unsupported("reflections in passes of their own belong to no work-group of pixels"));
        }
        let frame = self.frame(config, view, size);
        self.warps_of(&frame, width)?;
        let mut out = vec![0; size.pixels()];
        let of_group = |corner, strip: &mut Strip<u32>| -> Result<()> {
            let in_warps = self.warps_of(&frame, width)?;
            let mut pixels = Vec::new();
            render_group::<Counters>(&frame, &in_warps, corner, |x, y, _| pixels.push((x, y)));
            let sums = in_warps.sums().map_err(Error::Device)?;
            let share = sums.iter().fold(Sums::default(), |all, sums| all.with(sums)).utilisation(width);
            // Where nothing is issued no lane waits
            let percent = (100.0 * share.unwrap_or(1.0)).round() as u32;
            pixels.into_iter().for_each(|(x, y)| strip.set(x, y, percent));
            Ok(())
        };
        let whole = Tile { column: 0, columns: size.width, row: 0, rows: size.height };
        let done = self.device.pool().install(|| self.groups(&frame, whole, &mut out, of_group));
        done.into_iter().collect::<Result<Vec<()>>>()?;
        Ok(out)
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
        let render = |frame: usize| self.timed_frame(config, &views[frame], size, &mut pixels);
        let times = self.device.run_frames(views.len(), render, interrupted)?;
        self.timed = pixels;
        Ok(times)
    }

    fn timed(&mut self) -> Result<Timed> {
        Ok(Timed { pixels: self.timed.clone(), dispatches: 0 })
    }

    fn cast(&mut self, rays: &[TraceRay], any_before: Option<f32>) -> Result<Vec<Hit>> {
        let mut hits = vec![Hit::NONE; rays.len()];
        self.device.pool().install(|| {
            hits.par_chunks_mut(GROUP).zip(rays.par_chunks(GROUP)).for_each(|(hits, rays)| {
                trace_group(&*self.traversal, self.triangles, rays, any_before, hits);
            });
        });
        Ok(hits)
    }

    fn allocated(&self) -> (u64, u64) {
        (self.scene.geometry_bytes(), self.structure.structure_bytes())
    }
}
