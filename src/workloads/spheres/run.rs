//! A renderer with its switches on a device: its cases verified, counted and run.

use super::case::SpheresCase;
use super::count::Counts;
use super::gpu::{Counted, GpuRenderer};
use super::input::SpheresInput;
use super::options::{Algorithm, Options};
use super::references::{SMALL, Shot};
use super::render::CpuRenderer;
use super::render::reference::Reference;
use super::verify::{self, Exactness};
use super::view::View;
use super::{memory, pictures, work};
use crate::device::{CpuDevice, FrameTime, KernelInfo, POISON, VulkanDevice};
use crate::error::{Error, Result};
use crate::harness::workload::{Case, Event, Run, Verdict};
use crate::record::row::{Check, Metric};
use crate::workloads::size::Size;
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::rc::Rc;

/// What renders.
enum Prepared<'a> {
    Cpu { device: &'a CpuDevice, renderer: CpuRenderer<'a>, image: Vec<[f32; 4]> },
    Gpu { device: &'a VulkanDevice, options: Options, of_shape: HashMap<Shape, GpuRenderer<'a>> },
}

/// What a kernel and its image are made for: the image's size, and the most rays along a path.
type Shape = (Size, u32);

fn shape(view: &View) -> Shape {
    (Size { width: view.width, height: view.height }, view.trips)
}

/// See the module.
pub(super) struct SpheresRun<'a> {
    input: &'a SpheresInput<'a>,
    algorithm: Algorithm,
    exactness: Exactness,
    prepared: Prepared<'a>,
}

impl<'a> SpheresRun<'a> {
    pub fn on_cpu(
        input: &'a SpheresInput<'a>,
        device: &'a CpuDevice,
        algorithm: Algorithm,
        renderer: CpuRenderer<'a>,
    ) -> SpheresRun<'a> {
        let prepared = Prepared::Cpu { device, renderer, image: Vec::new() };
        SpheresRun { input, algorithm, exactness: Exactness::Bits, prepared }
    }

    pub fn on_gpu(input: &'a SpheresInput<'a>, device: &'a VulkanDevice, options: Options) -> SpheresRun<'a> {
        let is_exact = device.info().agrees_with_twins();
        let exactness = if is_exact { Exactness::Bits } else { Exactness::Levels };
        let prepared = Prepared::Gpu { device, options, of_shape: HashMap::new() };
        SpheresRun { input, algorithm: options.algorithm, exactness, prepared }
    }

    /// Renders a frame by what is timed.
    fn render(&mut self, view: &View) -> Result<Vec<[f32; 4]>> {
        match &mut self.prepared {
            Prepared::Cpu { renderer, .. } => {
                let mut image = poisoned(shape(view).0);
                renderer.render(&self.input.spheres, view, &mut image);
                Ok(image)
            }
            Prepared::Gpu { .. } => self.gpu(shape(view))?.render(view),
        }
    }

    /// Renders a frame by what counts: the picture, the live hits of each pixel, and the work.
    fn count_frame(&mut self, view: &View) -> Result<(Vec<[f32; 4]>, Vec<u32>, Counts)> {
        match &mut self.prepared {
            Prepared::Cpu { renderer, .. } => {
                let size = shape(view).0;
                let (mut image, mut hits) = (poisoned(size), vec![POISON; size.pixels()]);
                let counts = renderer.count(&self.input.spheres, view, &mut image, &mut hits);
                Ok((image, hits, counts))
            }
            Prepared::Gpu { options, .. } => {
                let ends = options.exit_on_miss;
                let Counted { image, hits, searches } = self.gpu(shape(view))?.count(view)?;
                let counts = work::of_pixels(&hits, &searches, view.trips, ends);
                Ok((image, hits, counts))
            }
        }
    }

    /// The renderer on the GPU for a shape.
    fn gpu(&mut self, shape: Shape) -> Result<&mut GpuRenderer<'a>> {
        let Prepared::Gpu { device, options, of_shape } = &mut self.prepared else {
            return Err(Error::Device("this renderer runs on the CPU".into()));
        };
        match of_shape.entry(shape) {
            Entry::Occupied(entry) => Ok(entry.into_mut()),
            Entry::Vacant(entry) => {
                Ok(entry.insert(GpuRenderer::new(device, &self.input.on_gpu, *options, shape.0, shape.1)?))
            }
        }
    }

    /// Compares one frame with the reference, and keeps a picture of what differs.
    fn check(&mut self, shot: Shot, verdict: &mut Verdict) -> Result<()> {
        self.input.context.check_interrupt()?;
        let image = self.render(&shot.view(&self.input.scene))?;
        let reference = self.reference(shot)?;
        let check = verify::picture(&image, &reference.image, shot.size, shot.frame, self.exactness);
        if check.ok {
            if shot.size != SMALL {
                verdict.outputs.insert("image".into(), hash(&image));
                verdict.outputs.insert("reference_image".into(), hash(&reference.image));
            }
        } else {
            verdict.difference = Some(pictures::difference(self.input, &image, &reference.image, shot)?);
        }
        add(verdict, check);
        Ok(())
    }

    fn reference(&self, shot: Shot) -> Result<Rc<Reference>> {
        let SpheresInput { scene, spheres, references, context, .. } = self.input;
        references.borrow_mut().of(scene, spheres, (self.algorithm, shot), context.interrupted)
    }

    /// All renderers must count the same live rays and hits.
    fn compare_totals(&self, case: &Case, counts: &Counts, verdict: &mut Verdict) {
        // What is not exact is compared with nothing, and nothing is compared with it
        if self.exactness != Exactness::Bits {
            return;
        }
        let own = (case.group.clone(), counts.rays.clone(), counts.hits.clone());
        let mut totals = self.input.totals.borrow_mut();
        let (first, rays, hits) = totals.entry(SpheresInput::shape_of(case)).or_insert_with(|| own.clone());
        let differs = |trip: &usize| (rays.get(*trip), hits.get(*trip)) != (own.1.get(*trip), own.2.get(*trip));
        if let Some(trip) = (0..rays.len().max(own.1.len())).find(differs) {
            let [is, should] = [(&own.1, &own.2), (&*rays, &*hits)].map(|(rays, hits)| {
                let number = |counts: &[u64]| counts.get(trip).copied().unwrap_or_default();
                format!("{} rays and {} hits", number(rays), number(hits))
            });
            verdict.problem.get_or_insert(format!("bounce {}: {is}, {first} has {should}", trip + 1));
        }
    }
}

/// An image without a valid pixel.
pub(super) fn poisoned(size: Size) -> Vec<[f32; 4]> {
    vec![[f32::from_bits(POISON); 4]; size.pixels()]
}

fn hash(image: &[[f32; 4]]) -> String {
    blake3::hash(bytemuck::cast_slice(image)).to_hex().to_string()
}

/// Adds a check; the first that fails is the verdict's problem.
fn add(verdict: &mut Verdict, check: Check) {
    if !check.ok {
        verdict.problem.get_or_insert(check.message.clone());
    }
    verdict.checks.push(check);
}

impl Run for SpheresRun<'_> {
    fn kernels(&self, case: &Case) -> Result<Vec<KernelInfo>> {
        let SpheresCase { trips, .. } = SpheresCase::parse(case)?;
        match &self.prepared {
            Prepared::Cpu { .. } => Ok(Vec::new()),
            // The kernel is the same for every size
            Prepared::Gpu { device, options, .. } => {
                Ok(vec![GpuRenderer::new(device, &self.input.on_gpu, *options, SMALL, trips)?.kernel()])
            }
        }
    }

    fn verify(&mut self, case: &Case) -> Result<Verdict> {
        let case = SpheresCase::parse(case)?;
        let SpheresCase { size, trips, frames, .. } = case;
        memory::check(size)?;
        let mut verdict = Verdict::default();
        let SpheresInput { scene, spheres, references, .. } = self.input;
        let checks = references.borrow_mut().checks(scene, spheres, trips, self.input.context.interrupted)?;
        checks.into_iter().for_each(|check| add(&mut verdict, check));
        let small = |frame| Shot { size: SMALL, trips, frame, frames };
        let shots = [small(0), small(frames / 2), Shot { size, ..small(0) }];
        for (index, shot) in shots.iter().enumerate() {
            if verdict.problem.is_none() && !shots[..index].contains(shot) {
                self.check(*shot, &mut verdict)?;
            }
        }
        Ok(verdict)
    }

    fn count(&mut self, case: &Case) -> Result<Verdict> {
        let context = self.input.context;
        let work = case.work / (context.settings.passes as u64 + 1);
        let SpheresCase { size, trips, frames, .. } = SpheresCase::parse(case)?;
        let (mut verdict, mut sums) = (Verdict::default(), Counts::new(trips as usize));
        for frame in 0..frames {
            context.check_interrupt()?;
            let shot = Shot { size, trips, frame, frames };
            let (image, hits, counts) = self.count_frame(&shot.view(&self.input.scene))?;
            // What is counted must be what is timed: the first frame's picture was verified
            if frame == 0 {
                let reference = self.reference(shot)?;
                let mut picture = verify::picture(&image, &reference.image, size, frame, self.exactness);
                picture.message = format!("counting, {}", picture.message);
                add(&mut verdict, picture);
                add(&mut verdict, verify::hits(&hits, &reference.hits, size, frame, self.exactness));
            }
            sums += &counts;
            context.emit(Event::Work(work / frames as u64));
        }
        self.compare_totals(case, &sums, &mut verdict);
        verdict.metrics = work::metrics(&sums, self.input.spheres.len());
        if let Prepared::Cpu { renderer, .. } = &self.prepared {
            verdict.metrics.push(Metric::new("instructions", renderer.instructions()));
            verdict.metrics.push(Metric::new("processor_threads", renderer.threads()));
        }
        Ok(verdict)
    }

    fn pass(&mut self, case: &Case, warm_up: Option<usize>) -> Result<Vec<FrameTime>> {
        let SpheresCase { size, trips, frames, .. } = SpheresCase::parse(case)?;
        let number = warm_up.unwrap_or(frames);
        let shot = |index: usize| Shot { size, trips, frame: index % frames, frames };
        let views: Vec<View> = (0..number).map(|index| shot(index).view(&self.input.scene)).collect();
        let interrupted = self.input.context.interrupted;
        match &mut self.prepared {
            Prepared::Cpu { device, renderer, image } => {
                *image = poisoned(size);
                let spheres = &self.input.spheres;
                device.run_frames(number, |index| renderer.render(spheres, &views[index], image), interrupted)
            }
            Prepared::Gpu { .. } => self.gpu((size, trips))?.time(&views, interrupted),
        }
    }

    fn recheck(&mut self, case: &Case) -> Result<Verdict> {
        let SpheresCase { size, trips, frames, .. } = SpheresCase::parse(case)?;
        let last = Shot { size, trips, frame: frames - 1, frames };
        let image = match &mut self.prepared {
            Prepared::Cpu { image, .. } => std::mem::take(image),
            Prepared::Gpu { .. } => self.gpu((size, trips))?.last()?,
        };
        let reference = self.reference(last)?;
        let mut check = verify::picture(&image, &reference.image, size, last.frame, self.exactness);
        check.message = format!("after the last pass, {}", check.message);
        let mut verdict = Verdict::default();
        if !check.ok {
            verdict.difference = Some(pictures::difference(self.input, &image, &reference.image, last)?);
        }
        add(&mut verdict, check);
        Ok(verdict)
    }
}
