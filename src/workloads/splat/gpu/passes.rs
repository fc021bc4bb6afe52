//! The passes of a frame, in their order.

use super::buffers::{Buffers, Sizes};
use super::inputs::Inputs;
use super::kernels::{GROUP_SIZE, Kernel};
use super::steps::{Count, Steps};
use super::uniforms::*;
use crate::device::vulkan::Buffer;
use crate::device::{Stage, VulkanDevice};
use crate::error::Result;
use crate::workloads::scan::{self, Scan};
use crate::workloads::splat::direct::lamps;
use crate::workloads::splat::lit::LitScene;
use crate::workloads::splat::setting::{Estimate, MAX_HITS, Setting};
use crate::workloads::trace::gpu::RayCaster;
use std::f32::consts::FRAC_1_PI;

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
pub(super) const COMPACTION: Stage = Stage("compaction");
const SAMPLES: Stage = Stage("samples");
const DIRECT: Stage = Stage("direct");
pub(super) const ESTIMATE: Stage = Stage("estimate");
const MIX: Stage = Stage("mix");

/// Most distances between photons and samples that a dispatch of the estimate tests.
pub const MAX_TESTS: u64 = 1 << 33;

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

impl Maker<'_> {
    /// Adds the passes of photons, samples and direct light. The first word of the buffer is the number of photons.
    ///
    /// # Errors
    /// The device's.
    pub fn seen(&self, steps: &mut Steps) -> Result<Buffer> {
        self.photons(steps)?;
        let photons = self.compaction(steps)?;
        self.samples(steps)?;
        self.direct(steps)?;
        for any_hit in [false, true] {
            steps.know(self.caster.kernel(any_hit)?);
        }
        Ok(photons)
    }

    /// Adds the pass that makes the picture.
    ///
    /// # Errors
    /// The device's.
    pub fn mix(&self, steps: &mut Steps) -> Result<()> {
        let (buffers, count) = (self.buffers, self.sizes.pixels);
        let job = List { inverse_pi: FRAC_1_PI, ..self.list(count)? };
        let bound = [&buffers.albedos, &buffers.direct, &buffers.irradiance, &buffers.picture];
        steps.add(MIX, &Kernel::Mix, Count::Elements(count), job, &bound)?;
        self.device.check()
    }

    fn photons(&self, steps: &mut Steps) -> Result<()> {
        let (buffers, inputs, setting) = (self.buffers, self.inputs, self.setting);
        let lights = self.lit.lights.len() as u32;
        for (first_path, paths) in self.sizes.batches() {
            let row_groups = self.device.groups_for(paths.into(), GROUP_SIZE)?.0;
            let is_first = u32::from(first_path == 0);
            let job = EmitJob { seed: setting.seed, first_path, paths, row_groups, lights, is_first, pad0: 0, pad1: 0 };
            let bound = [&inputs.sources, &buffers.rays, &buffers.carried, &buffers.arrived];
            steps.add(HITS[0], &Kernel::Emit, Count::Elements(paths), job, &bound)?;
            for number in 1..=setting.hits {
                let stage = HITS[number as usize - 1];
                steps.cast(stage, self.caster.cast(&buffers.rays, &buffers.hits, paths, None)?);
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
                steps.add(stage, &Kernel::Bounce, Count::Elements(paths), job, &bound)?;
            }
        }
        Ok(())
    }

    fn compaction(&self, steps: &mut Steps) -> Result<Buffer> {
        let (buffers, slots) = (self.buffers, self.sizes.slots);
        let flags = [&buffers.slot_positions, &buffers.places];
        steps.add(COMPACTION, &Kernel::Flags, Count::Elements(slots), self.list(slots)?, &flags)?;
        let scan = Scan::in_place(self.device, scan::Options { subgroups: false }, &buffers.places, slots)?;
        let photons = scan.total().clone();
        steps.scan(COMPACTION, scan);
        let bound = [
            &buffers.slot_positions,
            &buffers.slot_directions,
            &buffers.slot_fluxes,
            &buffers.places,
            &buffers.positions,
            &buffers.directions,
            &buffers.fluxes,
        ];
        steps.add(COMPACTION, &Kernel::Scatter, Count::Elements(slots), self.list(slots)?, &bound)?;
        Ok(photons)
    }

    fn samples(&self, steps: &mut Steps) -> Result<()> {
        let (buffers, pixels) = (self.buffers, self.sizes.pixels);
        steps.add_view(SAMPLES, &Kernel::Camera, pixels, &[&buffers.view_rays])?;
        let cast = self.caster.cast(&buffers.view_rays, &buffers.view_hits, pixels, None)?;
        steps.cast(SAMPLES, cast);
        let bound = [
            &self.inputs.facets,
            &buffers.view_rays,
            &buffers.view_hits,
            &buffers.samples,
            &buffers.normals,
            &buffers.albedos,
        ];
        steps.add_view(SAMPLES, &Kernel::Samples, pixels, &bound)
    }

    fn direct(&self, steps: &mut Steps) -> Result<()> {
        let (buffers, pixels) = (self.buffers, self.sizes.pixels);
        let row_groups = self.device.groups_for(pixels.into(), GROUP_SIZE)?.0;
        for (index, lamp) in lamps(self.lit, self.setting.falloff).into_iter().enumerate() {
            let (light, reach) = (lamp.position, self.lit.reach());
            let job = ShadowJob { light, reach, pixels, row_groups, pad0: 0, pad1: 0 };
            steps.add(
                DIRECT,
                &Kernel::Shadow,
                Count::Elements(pixels),
                job,
                &[&buffers.samples, &buffers.shadow_rays],
            )?;
            let cast = self.caster.cast(&buffers.shadow_rays, &buffers.shadow_hits, pixels, Some(1.0))?;
            steps.cast(DIRECT, cast);
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
            steps.add(DIRECT, &Kernel::Direct(self.setting.falloff), Count::Elements(pixels), job, &bound)?;
        }
        Ok(())
    }

    /// Adds the passes of the reference estimate.
    ///
    /// # Errors
    /// The device's.
    pub fn estimates(&self, steps: &mut Steps, photons: &Buffer) -> Result<()> {
        let (buffers, Sizes { slots, pixels, .. }) = (self.buffers, *self.sizes);
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
            steps.add(ESTIMATE, &kernel, Count::Elements(count), job, &bound)?;
        }
        Ok(())
    }

    fn list(&self, count: u32) -> Result<List> {
        let row_groups = self.device.groups_for(count.into(), GROUP_SIZE)?.0;
        Ok(List { count, row_groups, inverse_pi: 0.0, pad: 0 })
    }
}

/// First pixel and end of each dispatch of the estimate: whole work-groups with at most [`MAX_TESTS`] tests.
pub(super) fn parts(pixels: u32, slots: u32) -> impl Iterator<Item = (u32, u32)> {
    let most = MAX_TESTS / u64::from(slots.max(1)) / u64::from(GROUP_SIZE) * u64::from(GROUP_SIZE);
    let most = most.clamp(GROUP_SIZE.into(), u64::from(u32::MAX / 2)) as u32;
    (0..pixels).step_by(most as usize).map(move |first| (first, (first + most).min(pixels)))
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
