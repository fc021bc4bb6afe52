//! The passes of a frame, in their order.

use super::buffers::{Buffers, Sizes};
use super::inputs::Inputs;
use super::kernels::{GROUP_SIZE, Kernel};
use super::uniforms::*;
use crate::device::vulkan::{Bindings, Buffer, Dispatch, Groups, Pipeline, PipelineDescription, Resource};
use crate::device::{KernelInfo, Pass, Stage, VulkanDevice};
use crate::error::Result;
use crate::workloads::scan::{self, Scan};
use crate::workloads::splat::direct::lamps;
use crate::workloads::splat::lit::LitScene;
use crate::workloads::splat::setting::{Estimate, MAX_HITS, Setting};
use crate::workloads::trace::gpu::{Cast, RayCaster};
use bytemuck::Pod;
use std::f32::consts::FRAC_1_PI;
use std::sync::Arc;

/// The stages of hits; paths leave the lights in the first.
pub const HITS: [Stage; MAX_HITS as usize] = [
    Stage("hit-1"),
    Stage("hit-2"),
    Stage("hit-3"),
    Stage("hit-4"),
    Stage("hit-5"),
    Stage("hit-6"),
    Stage("hit-7"),
    Stage("hit-8"),
    Stage("hit-9"),
    Stage("hit-10"),
    Stage("hit-11"),
    Stage("hit-12"),
    Stage("hit-13"),
    Stage("hit-14"),
    Stage("hit-15"),
    Stage("hit-16"),
];
const COMPACTION: Stage = Stage("compaction");
const SAMPLES: Stage = Stage("samples");
const DIRECT: Stage = Stage("direct");
const ESTIMATE: Stage = Stage("estimate");
const MIX: Stage = Stage("mix");

/// Most distances between photons and samples that a dispatch of the estimate tests.
pub const MAX_TESTS: u64 = 1 << 33;

/// A pass, or passes of other modules.
enum Step {
    Own(Stage, OwnPass),
    Cast(Stage, Cast),
    Scan(Scan),
}

struct OwnPass {
    pipeline: Arc<Pipeline>,
    /// `None` where the camera is bound, which each run does anew.
    bindings: Option<Bindings>,
    groups: (u32, u32),
    kernel: Kernel,
}

/// What passes are made of.
pub(super) struct Maker<'a> {
    pub device: &'a VulkanDevice,
    pub caster: &'a RayCaster<'a>,
    pub lit: &'a LitScene,
    pub setting: &'a Setting,
    pub estimate: &'a Estimate,
    pub sizes: &'a Sizes,
    pub buffers: &'a Buffers,
    pub inputs: &'a Inputs,
}

/// The passes of a frame with their bindings, but for the camera's.
pub(super) struct Passes {
    steps: Vec<Step>,
    kernels: Vec<KernelInfo>,
    /// Dispatches of the estimate.
    pub estimates: usize,
}

/// The bindings of the passes that read the camera.
pub(super) struct ViewBindings {
    camera: Bindings,
    samples: Bindings,
}

impl Maker<'_> {
    /// Makes the passes.
    ///
    /// # Errors
    /// The device's.
    pub fn passes(&self) -> Result<Passes> {
        let mut passes = Passes { steps: Vec::new(), kernels: Vec::new(), estimates: 0 };
        self.photons(&mut passes)?;
        self.compaction(&mut passes)?;
        self.samples(&mut passes)?;
        self.direct(&mut passes)?;
        self.estimates(&mut passes)?;
        let (buffers, count) = (self.buffers, self.sizes.pixels);
        let job = List { inverse_pi: FRAC_1_PI, ..self.list(count)? };
        let bound = [&buffers.albedos, &buffers.direct, &buffers.irradiance, &buffers.picture];
        self.add(&mut passes, MIX, Kernel::Mix, count, job, &bound)?;
        passes
            .kernels
            .extend([false, true].map(|any_hit| self.caster.kernel(any_hit)).into_iter().collect::<Result<Vec<_>>>()?);
        self.device.check()?;
        Ok(passes)
    }

    fn photons(&self, passes: &mut Passes) -> Result<()> {
        let (buffers, inputs, setting) = (self.buffers, self.inputs, self.setting);
        let lights = self.lit.lights.len() as u32;
        for (first_path, paths) in self.sizes.batches() {
            let row_groups = self.device.groups_for(paths.into(), GROUP_SIZE)?.0;
            let is_first = u32::from(first_path == 0);
            let job = EmitJob { seed: setting.seed, first_path, paths, row_groups, lights, is_first, pad0: 0, pad1: 0 };
            let bound = [&inputs.sources, &buffers.rays, &buffers.carried, &buffers.arrived];
            self.add(passes, HITS[0], Kernel::Emit, paths, job, &bound)?;
            for number in 1..=setting.hits {
                let stage = HITS[number as usize - 1];
                passes.steps.push(Step::Cast(stage, self.caster.cast(&buffers.rays, &buffers.hits, paths, None)?));
                let job = BounceJob {
                    seed: setting.seed,
                    first_path,
                    paths,
                    row_groups,
                    number,
                    per_path: setting.hits - 1,
                    epsilon: self.lit.epsilon(),
                    divisor: setting.divisor(),
                };
                let slots = [&buffers.slot_positions, &buffers.slot_directions, &buffers.slot_fluxes];
                let bound = [
                    &inputs.facets,
                    &buffers.hits,
                    &buffers.rays,
                    &buffers.carried,
                    slots[0],
                    slots[1],
                    slots[2],
                    &buffers.arrived,
                ];
                self.add(passes, stage, Kernel::Bounce, paths, job, &bound)?;
            }
        }
        Ok(())
    }

    fn compaction(&self, passes: &mut Passes) -> Result<()> {
        let (buffers, slots) = (self.buffers, self.sizes.slots);
        let flags = [&buffers.slot_positions, &buffers.places];
        self.add(passes, COMPACTION, Kernel::Flags, slots, self.list(slots)?, &flags)?;
        let scan = Scan::in_place(self.device, scan::Options { subgroups: false }, &buffers.places, slots)?;
        passes.kernels.extend(scan.kernels().iter().cloned());
        passes.steps.push(Step::Scan(scan));
        let bound = [
            &buffers.slot_positions,
            &buffers.slot_directions,
            &buffers.slot_fluxes,
            &buffers.places,
            &buffers.positions,
            &buffers.directions,
            &buffers.fluxes,
        ];
        self.add(passes, COMPACTION, Kernel::Scatter, slots, self.list(slots)?, &bound)
    }

    fn samples(&self, passes: &mut Passes) -> Result<()> {
        let (buffers, pixels) = (self.buffers, self.sizes.pixels);
        self.add_unbound(passes, SAMPLES, Kernel::Camera, pixels)?;
        let cast = self.caster.cast(&buffers.view_rays, &buffers.view_hits, pixels, None)?;
        passes.steps.push(Step::Cast(SAMPLES, cast));
        self.add_unbound(passes, SAMPLES, Kernel::Samples, pixels)
    }

    fn direct(&self, passes: &mut Passes) -> Result<()> {
        let (buffers, pixels) = (self.buffers, self.sizes.pixels);
        let row_groups = self.device.groups_for(pixels.into(), GROUP_SIZE)?.0;
        for (index, lamp) in lamps(self.lit, self.setting.falloff).into_iter().enumerate() {
            let (light, reach) = (lamp.position, self.lit.reach());
            let job = ShadowJob { light, reach, pixels, row_groups, pad0: 0, pad1: 0 };
            self.add(passes, DIRECT, Kernel::Shadow, pixels, job, &[&buffers.samples, &buffers.shadow_rays])?;
            let cast = self.caster.cast(&buffers.shadow_rays, &buffers.shadow_hits, pixels, Some(1.0))?;
            passes.steps.push(Step::Cast(DIRECT, cast));
            let job = DirectJob {
                light,
                pixels,
                intensity: lamp.intensity,
                row_groups,
                influence2: self.lit.influence() * self.lit.influence(),
                inverse_pi: FRAC_1_PI,
                one: 1.0,
                is_first: u32::from(index == 0),
            };
            let mut bound =
                vec![&buffers.shadow_hits, &buffers.samples, &buffers.normals, &buffers.albedos, &buffers.direct];
            if let Some(highlights) = &self.inputs.highlights {
                bound.extend([&buffers.view_rays, &buffers.view_hits, highlights]);
            }
            self.add(passes, DIRECT, Kernel::Direct(self.setting.falloff), pixels, job, &bound)?;
        }
        Ok(())
    }

    fn estimates(&self, passes: &mut Passes) -> Result<()> {
        let (buffers, Sizes { slots, pixels, .. }) = (self.buffers, *self.sizes);
        let scan = passes.steps.iter().find_map(|step| if let Step::Scan(scan) = step { Some(scan) } else { None });
        let Some(photons) = scan.map(Scan::total) else { return Ok(()) };
        // Made apart from the others, since the number of photons is borrowed of them
        let mut made = Passes { steps: Vec::new(), kernels: Vec::new(), estimates: 0 };
        let kernel = Kernel::Estimate(self.estimate.kernel, self.estimate.weight);
        for (first_pixel, end_pixel) in parts(pixels, slots) {
            let count = end_pixel - first_pixel;
            let job = EstimateJob {
                first_pixel,
                end_pixel,
                row_groups: self.device.groups_for(count.into(), GROUP_SIZE)?.0,
                slots,
                radius2: self.estimate.radius2(),
                peak: self.estimate.peak(),
                one: 1.0,
                pad: 0,
            };
            let bound = [
                &buffers.samples,
                &buffers.normals,
                &buffers.positions,
                &buffers.directions,
                &buffers.fluxes,
                photons,
                &buffers.irradiance,
            ];
            self.add(&mut made, ESTIMATE, kernel, count, job, &bound)?;
        }
        passes.estimates = made.steps.len();
        passes.steps.append(&mut made.steps);
        passes.kernels.append(&mut made.kernels);
        Ok(())
    }

    fn list(&self, count: u32) -> Result<List> {
        let row_groups = self.device.groups_for(count.into(), GROUP_SIZE)?.0;
        Ok(List { count, row_groups, inverse_pi: 0.0, pad: 0 })
    }

    /// Adds a pass with its uniform and its buffers, which have the numbers from 1.
    fn add<J: Pod>(
        &self,
        passes: &mut Passes,
        stage: Stage,
        kernel: Kernel,
        count: u32,
        job: J,
        buffers: &[&Buffer],
    ) -> Result<()> {
        self.add_unbound(passes, stage, kernel, count)?;
        let job = self.device.uniform("the job", &[job])?;
        if let Some(Step::Own(_, pass)) = passes.steps.last_mut() {
            pass.bindings = Some(bind(self.device, &pass.pipeline, Resource::from(&job), buffers));
        }
        Ok(())
    }

    fn add_unbound(&self, passes: &mut Passes, stage: Stage, kernel: Kernel, count: u32) -> Result<()> {
        let source = kernel.assemble()?;
        let pipeline = self.device.pipeline(&PipelineDescription {
            label: &kernel.label(),
            text: &source.text,
            layout: &kernel.layout(),
            checked: false,
            zero_workgroup_memory: false,
        })?;
        let checked = self.device.options().checked;
        let info = KernelInfo { hash: source.hash(), fetch: "buffers".to_owned(), checked };
        if !passes.kernels.contains(&info) {
            passes.kernels.push(info);
        }
        let groups = self.device.groups_for(count.into(), GROUP_SIZE)?;
        passes.steps.push(Step::Own(stage, OwnPass { pipeline, bindings: None, groups, kernel }));
        Ok(())
    }
}

/// First pixel and end of each dispatch of the estimate: whole work-groups with at most [`MAX_TESTS`] tests.
pub(super) fn parts(pixels: u32, slots: u32) -> impl Iterator<Item = (u32, u32)> {
    let most = MAX_TESTS / u64::from(slots.max(1)) / u64::from(GROUP_SIZE) * u64::from(GROUP_SIZE);
    let most = most.clamp(GROUP_SIZE.into(), u64::from(u32::MAX / 2)) as u32;
    (0..pixels).step_by(most as usize).map(move |first| (first, (first + most).min(pixels)))
}

fn bind(device: &VulkanDevice, pipeline: &Pipeline, first: Resource, buffers: &[&Buffer]) -> Bindings {
    let mut resources = vec![(0, first)];
    resources.extend((1..).zip(buffers).map(|(number, &buffer)| (number, Resource::from(buffer))));
    device.bind(pipeline, &resources)
}

impl Passes {
    /// Binds the cameras of a run, of which `views` has a window for each.
    pub fn bind_views(
        &self,
        device: &VulkanDevice,
        views: &Buffer,
        buffers: &Buffers,
        inputs: &Inputs,
    ) -> Option<ViewBindings> {
        let bound = |wanted: Kernel, buffers: &[&Buffer]| {
            let pipeline = self.steps.iter().find_map(|step| match step {
                Step::Own(_, pass) if pass.kernel == wanted => Some(&pass.pipeline),
                _ => None,
            })?;
            Some(bind(device, pipeline, Resource::Window(views, size_of::<View>() as u64), buffers))
        };
        let seen = [&inputs.facets, &buffers.view_rays, &buffers.view_hits];
        Some(ViewBindings {
            camera: bound(Kernel::Camera, &[&buffers.view_rays])?,
            samples: bound(
                Kernel::Samples,
                &[seen[0], seen[1], seen[2], &buffers.samples, &buffers.normals, &buffers.albedos],
            )?,
        })
    }

    /// The passes of a frame whose camera is at `offset` of the views.
    pub fn frame<'s>(&'s self, views: &'s ViewBindings, offset: u32) -> Vec<Pass<Dispatch<'s>>> {
        let mut passes = Vec::with_capacity(self.steps.len());
        for step in &self.steps {
            match step {
                Step::Own(stage, OwnPass { pipeline, bindings, groups: (x, y), kernel }) => {
                    let view = if *kernel == Kernel::Camera { &views.camera } else { &views.samples };
                    let (bindings, offset) = match bindings {
                        Some(bindings) => (bindings, None),
                        None => (view, Some(offset)),
                    };
                    let work = Dispatch { pipeline, bindings, offset, groups: Groups::Fixed(*x, *y, 1) };
                    passes.push(Pass { stage: *stage, work });
                }
                Step::Cast(stage, cast) => passes.push(Pass { stage: *stage, work: cast.dispatch() }),
                Step::Scan(scan) => passes.extend(scan.passes(COMPACTION)),
            }
        }
        passes
    }

    /// The kernels, each once.
    pub fn kernels(&self) -> &[KernelInfo] {
        &self.kernels
    }

    /// Where the number of photons is.
    pub fn scan(&self) -> Option<&Scan> {
        self.steps.iter().find_map(|step| if let Step::Scan(scan) = step { Some(scan) } else { None })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_cover_all_pixels_once_and_keep_the_limit() {
        for (pixels, slots) in [(1, 1), (1000, 1 << 23), (2_073_600, 17_001), (2_073_600, 1 << 23), (1 << 26, 0)] {
            let parts: Vec<(u32, u32)> = parts(pixels, slots).collect();
            assert_eq!((parts[0].0, parts[parts.len() - 1].1), (0, pixels));
            assert!(parts.windows(2).all(|pair| pair[0].1 == pair[1].0), "{pixels} {slots}");
            for (first, end) in parts {
                assert!(first < end && first % GROUP_SIZE == 0);
                assert!(u64::from(end - first) * u64::from(slots) <= MAX_TESTS, "{pixels} {slots}");
            }
        }
        assert_eq!(parts(2_073_600, 4096).count(), 1);
        assert_eq!(parts(2_073_600, 1 << 23).count(), 2025);
    }
}
