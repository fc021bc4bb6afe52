//! A structure on a device: the cases of photon splatting that trace through it, verified, counted and run.

use super::case::SplatCase;
use super::clusters::Clusters;
use super::cpu::CpuFrame;
use super::gathering::Gathering;
use super::gpu::GpuFrame;
use super::input::{Lit, REFERENCE_TREE, SplatInput};
use super::photons::check_slots;
use super::verify::{self, Exactness};
use super::{Stages, count, memory, path_counts, references};
use crate::camera::Camera;
use crate::device::{CpuDevice, Device, FrameTime, KernelInfo, POISON, VulkanDevice};
use crate::error::{Error, Result};
use crate::harness::workload::{Case, Event, Run, Verdict};
use crate::record::row::{Artifact, Check, Metric};
use crate::workloads::size::Size;
use crate::workloads::trace::backend::Backend;
use crate::workloads::trace::{Built, Selection};
use glam::Vec4;

/// The small image on which every array of two frames is compared: no side is a multiple of a work-group's.
pub const SMALL: Size = Size { width: 53, height: 37 };

/// See the module.
pub(super) struct SplatRun<'a> {
    input: &'a SplatInput<'a>,
    device: &'a Device,
    selection: Selection,
    built: &'a Built,
    exactness: Exactness,
    /// What was prepared last, with what it was prepared for. It is freed after each step, since the runs of other
    /// structures need the room as well.
    frame: Option<(Shape, Frame<'a>)>,
    /// The last picture of the last pass of each case.
    timed: Vec<(SplatCase, Vec<Vec4>)>,
}

/// What decides the buffers and kernels of a frame.
type Shape = (SplatCase, Size);

/// A frame on a device.
enum Frame<'a> {
    Cpu { device: &'a CpuDevice, frame: CpuFrame<'a> },
    Vulkan(Box<GpuFrame<'a>>),
}

impl<'a> SplatRun<'a> {
    /// # Errors
    /// [`Error::Device`] for a structure that was not built.
    pub fn new(input: &'a SplatInput<'a>, device: &'a Device, selection: Selection) -> Result<SplatRun<'a>> {
        let built = input.of_selection(&selection)?;
        let exactness = match selection.method().is_exact_on(device.info()) {
            true => Exactness::Bits,
            false => Exactness::Close,
        };
        Ok(SplatRun { input, device, selection, built, exactness, frame: None, timed: Vec::new() })
    }

    /// Prepares frames of a case in a size, unless they were the last to be prepared.
    fn frame(&mut self, case: &SplatCase, size: Size) -> Result<&mut Frame<'a>> {
        let shape = (case.clone(), size);
        if self.frame.as_ref().is_none_or(|(known, _)| *known != shape) {
            // What was there goes first: both need not fit
            self.frame = None;
            let lit = self.input.lit(case)?;
            let gathering = self.input.gathering(case, size)?;
            let frame = match self.device {
                Device::Cpu(device) => {
                    let frame = cpu_frame(device, lit, self.built, &self.selection, case, gathering, size)?;
                    Frame::Cpu { device, frame }
                }
                Device::Vulkan(device) => Frame::Vulkan(Box::new(self.gpu_frame(device, lit, case, gathering, size)?)),
            };
            self.frame = Some((shape, frame));
        }
        match &mut self.frame {
            Some((_, frame)) => Ok(frame),
            None => Err(Error::Device("no frame was prepared".into())),
        }
    }

    fn gpu_frame(
        &self,
        device: &'a VulkanDevice,
        lit: &'a Lit,
        case: &SplatCase,
        gathering: Gathering,
        size: Size,
    ) -> Result<GpuFrame<'a>> {
        let (structure, method) = (&*self.built.structure, self.selection.method());
        GpuFrame::new(device, &lit.scene, structure, method, case.setting, gathering, size)
    }

    /// The scene of all cases.
    pub(super) fn input(&self) -> &'a SplatInput<'a> {
        self.input
    }

    /// Everything that a frame of the device makes.
    pub(super) fn render(&mut self, case: &SplatCase, size: Size, camera: &Camera) -> Result<Stages> {
        let (fault, interrupted) = (self.input.fault, self.input.context.interrupted);
        let mut stages = match self.frame(case, size)? {
            Frame::Cpu { frame, .. } => frame.render(camera, interrupted)?,
            Frame::Vulkan(frame) => frame.render(camera, interrupted)?,
        };
        if let Some(fault) = fault {
            (fault.stages)(&mut stages);
        }
        Ok(stages)
    }

    /// The clusters of a view in the case's size.
    pub(super) fn clusters(&mut self, case: &SplatCase, camera: &Camera) -> Result<Clusters> {
        let interrupted = self.input.context.interrupted;
        match self.frame(case, case.size)? {
            Frame::Cpu { frame, .. } => frame.clusters(camera, interrupted),
            Frame::Vulkan(frame) => frame.clusters(camera, interrupted),
        }
    }

    /// Compares all arrays of a small frame with the twins, which trace through the reference tree.
    fn check_small(&mut self, case: &SplatCase, number: usize, verdict: &mut Verdict) -> Result<()> {
        let (input, interrupted) = (self.input, self.input.context.interrupted);
        let (lit, camera) = (input.lit(case)?, input.path(case)?.cameras[number]);
        let stages = self.render(case, SMALL, &camera)?;
        let place = format!("frame {number} at {}x{}", SMALL.width, SMALL.height);
        let twin = input.twin(lit, case, input.gathering(case, SMALL)?, SMALL)?;
        let checks = verify::stages(&stages, twin, &camera, self.exactness, interrupted)?;
        for Check { ok, message, metrics } in checks {
            add(verdict, Check { ok, message: format!("{place}: {message}"), metrics });
        }
        Ok(())
    }

    /// Compares samples and direct light of a whole image with the twins, its estimate with sums in double precision,
    /// and keeps hashes.
    fn check_image(&mut self, case: &SplatCase, verdict: &mut Verdict) -> Result<()> {
        let input = self.input;
        let (lit, camera) = (input.lit(case)?, input.path(case)?.cameras[0]);
        let interrupted = input.context.interrupted;
        let stages = self.render(case, case.size, &camera)?;
        let place = format!("frame 0 at {}x{}", case.size.width, case.size.height);
        let twin = input.twin(lit, case, input.gathering(case, case.size)?, case.size)?;
        for check in verify::image(&stages, twin, &camera, self.exactness, interrupted)? {
            add(verdict, Check { message: format!("{place}: {}", check.message), ..check });
        }
        if verdict.problem.is_some() {
            return Ok(());
        }
        let photons = verify::photons_hash(&stages.photons);
        verdict.outputs.insert("photons".into(), photons.clone());
        // Where a sum depends on timing, no two frames have the same bits
        if case.technique.gather.is_repeatable() {
            verdict.outputs.insert("image".into(), verify::hash(&stages.picture));
        }
        // What is not exact is compared with nothing, and nothing is compared with it
        if self.exactness == Exactness::Bits {
            let own = (self.selection.full_name(), photons.clone());
            let mut known = input.photons.borrow_mut();
            let (first, reference) = known.entry(SplatInput::photons_key(case)).or_insert(own);
            verdict.outputs.insert("reference_photons".into(), reference.clone());
            if *reference != photons {
                verdict.problem.get_or_insert(format!("the photons differ from those of {first}"));
            }
        }
        verdict.metrics.extend(count::metrics(&stages, &lit.scene, case.setting, case.technique.gather));
        Ok(())
    }
}

/// Everything that one frame makes, traced through the reference tree.
///
/// # Errors
/// What the device cannot do, and the device's.
pub(super) fn once(
    input: &SplatInput,
    device: &Device,
    case: &SplatCase,
    size: Size,
    camera: &Camera,
) -> Result<Stages> {
    SplatRun::new(input, device, Selection::parse(REFERENCE_TREE)?)?.render(case, size, camera)
}

/// The twins over a structure.
pub(super) fn cpu_frame<'f>(
    device: &'f CpuDevice,
    lit: &'f Lit,
    built: &'f Built,
    selection: &Selection,
    case: &SplatCase,
    gathering: Gathering,
    size: Size,
) -> Result<CpuFrame<'f>> {
    memory::check(case.setting, size, case.clustering.as_ref())?;
    let caster = Backend::prepare(device, &lit.scene.scene, &*built.structure, selection.method())?;
    Ok(CpuFrame::new(device, caster, &lit.scene, case.setting, gathering, size))
}

/// Adds a check; the first that fails is the verdict's problem.
fn add(verdict: &mut Verdict, check: Check) {
    if !check.ok {
        verdict.problem.get_or_insert(check.message.clone());
    }
    verdict.checks.push(check);
}

impl Run for SplatRun<'_> {
    fn artifact(&self) -> Option<Artifact> {
        self.input.artifact_of(&self.selection, None)
    }

    fn kernels(&self, case: &Case) -> Result<Vec<KernelInfo>> {
        let Device::Vulkan(device) = self.device else { return Ok(Vec::new()) };
        let mut case = SplatCase::parse(case)?;
        let lit = self.input.lit(&case)?;
        // The kernels are the same for any number of paths
        case.setting.paths = lit.scene.lights.len() as u32;
        let gathering = self.input.gathering(&case, SMALL)?;
        Ok(self.gpu_frame(device, lit, &case, gathering, SMALL)?.kernels())
    }

    fn stages(&self, case: &Case) -> Vec<String> {
        match (SplatCase::parse(case), self.device) {
            (Ok(case), Device::Vulkan(device)) if device.info().timestamp_period_ns.is_some() => {
                let gather = case.technique.gather;
                let clusters = case.clustering.map(|clustering| clustering.setting).unwrap_or_default();
                super::gpu::stages(case.setting, gather, &clusters).into_iter().map(str::to_owned).collect()
            }
            _ => Vec::new(),
        }
    }

    fn verify(&mut self, case: &Case) -> Result<Verdict> {
        let case = SplatCase::parse(case)?;
        check_slots(&case.setting)?;
        memory::check(case.setting, case.size, case.clustering.as_ref())?;
        let mut verdict = Verdict::default();
        let frames = self.input.path(&case)?.cameras.len();
        for number in if frames > 1 { vec![0, frames / 2] } else { vec![0] } {
            if verdict.problem.is_none() {
                self.input.context.check_interrupt()?;
                self.check_small(&case, number, &mut verdict)?;
            }
        }
        if verdict.problem.is_none() {
            self.input.context.check_interrupt()?;
            self.check_image(&case, &mut verdict)?;
        }
        self.frame = None;
        Ok(verdict)
    }

    fn count(&mut self, case: &Case) -> Result<Verdict> {
        let input = self.input;
        let work = case.work / (input.context.settings.passes as u64 + 1);
        let case = SplatCase::parse(case)?;
        let camera = input.path(&case)?.cameras[0];
        let stages = self.render(&case, case.size, &camera)?;
        let mut verdict = Verdict::default();
        references::compare(input, &case, &camera, &stages, &mut verdict)?;
        if case.technique.gather.has_clusters() {
            verdict.metrics.extend(path_counts::metrics(self, &case, stages)?);
        }
        if let Some((_, Frame::Vulkan(frame))) = &self.frame {
            let buffers = frame.buffers();
            let all: u64 = buffers.iter().map(|(_, bytes)| bytes).sum();
            verdict.metrics.extend(buffers.iter().map(|(name, bytes)| Metric::of(name, "bytes", *bytes)));
            verdict.metrics.push(Metric::new("buffer_bytes", all));
        }
        self.frame = None;
        input.context.emit(Event::Work(work));
        Ok(verdict)
    }

    fn pass(&mut self, case: &Case, warm_up: Option<usize>) -> Result<Vec<FrameTime>> {
        let case = SplatCase::parse(case)?;
        let all = &self.input.path(&case)?.cameras;
        let number = warm_up.unwrap_or(all.len());
        let cameras: Vec<Camera> = all.iter().cycle().take(number).copied().collect();
        let interrupted = self.input.context.interrupted;
        let (times, picture) = match self.frame(&case, case.size)? {
            Frame::Cpu { device, frame } => {
                let mut picture = vec![Vec4::splat(f32::from_bits(POISON)); case.size.pixels()];
                let mut failed = None;
                let render = |index: usize| {
                    if let Err(error) = frame.picture(&cameras[index], &mut picture, interrupted) {
                        failed.get_or_insert(error);
                    }
                };
                let times = device.run_frames(number, render, interrupted)?;
                failed.map_or(Ok((times, picture)), Err)?
            }
            Frame::Vulkan(frame) => (frame.time(&cameras, interrupted)?, frame.last()?),
        };
        if warm_up.is_none() {
            self.frame = None;
            self.timed.retain(|(known, _)| *known != case);
            self.timed.push((case, picture));
        }
        Ok(times)
    }

    fn recheck(&mut self, case: &Case) -> Result<Verdict> {
        let case = SplatCase::parse(case)?;
        let mut verdict = Verdict::default();
        let Some(&camera) = self.input.path(&case)?.cameras.last() else { return Ok(verdict) };
        let place = self.timed.iter().position(|(known, _)| *known == case);
        let mut timed = place.map_or(Vec::new(), |place| self.timed.swap_remove(place).1);
        if let Some(fault) = self.input.fault {
            (fault.timed)(&mut timed);
        }
        let again = self.render(&case, case.size, &camera)?;
        self.frame = None;
        // The same kernels on the same device make the same bits, unless a sum depends on timing
        let mut check = match case.technique.gather.is_repeatable() {
            true => verify::same("the picture", "the frame's, rendered again", &timed, &again.picture, case.size.width),
            false => verify::near("the picture, to the frame rendered again", &timed, &again.picture),
        };
        check.message = format!("after the last pass: {}", check.message);
        add(&mut verdict, check);
        Ok(verdict)
    }
}
