//! One hit of all paths: photons are stored, and paths go on. Twin of `kernels/splat/bounce.wgsl`.

use super::lit::LitScene;
use super::photons::Traced;
use super::random::{cosine_direction, flushed, unit_vector};
use super::setting::{Energy, Setting};
use super::surface::surface_at;
use crate::math::Hit;
use crate::workloads::trace::given::TraceRay;
use glam::Vec4;
use rayon::prelude::*;

impl Setting {
    /// What a stored photon's flux is divided by.
    pub fn divisor(&self) -> f32 {
        match self.energy {
            Energy::Flux => 1.0,
            Energy::Shared => (self.hits - 1) as f32,
        }
    }
}

/// Stores hit `number` (from 1) of every path, and makes the next rays; `hits` are those of `rays`, and `carried` is
/// the flux of each path. A path that hits nothing has no direction afterwards, and its slot is zero.
pub fn hit(
    lit: &LitScene,
    setting: &Setting,
    number: u32,
    hits: &[Hit],
    (rays, carried): (&mut [TraceRay], &mut [Vec4]),
    traced: &mut Traced,
) {
    let (epsilon, divisor, per_path) = (lit.epsilon(), setting.divisor(), (setting.hits - 1) as usize);
    let slots = &mut traced.slots;
    let positions = slots.positions.par_chunks_mut(per_path);
    let directions = slots.directions.par_chunks_mut(per_path);
    let fluxes = slots.fluxes.par_chunks_mut(per_path);
    let slots = positions.zip(directions).zip(fluxes);
    let paths = hits.par_iter().zip(rays.par_iter_mut()).zip(carried.par_iter_mut()).zip(slots).enumerate();
    let arrived = paths.map(|(path, (((&hit, ray), carried), ((positions, directions), fluxes)))| {
        let mut store = |position: Vec4, direction: Vec4, flux: Vec4| {
            if number >= 2 {
                let slot = number as usize - 2;
                (positions[slot], directions[slot], fluxes[slot]) = (position, direction, flux);
            }
        };
        let Some(surface) = surface_at(&lit.scene, ray, hit, epsilon) else {
            store(Vec4::ZERO, Vec4::ZERO, Vec4::ZERO);
            *ray = TraceRay::default();
            return 0;
        };
        store(
            surface.point.extend(number as f32),
            ray.direction.extend(path as f32),
            flushed(*carried / Vec4::splat(divisor)),
        );
        *carried = flushed(*carried * surface.albedo.extend(0.0));
        let direction = cosine_direction(surface.normal, unit_vector(setting.seed, path as u32, number));
        *ray = TraceRay::new(surface.point.into(), direction.into());
        1_u32
    });
    let arrived: u32 = arrived.sum();
    traced.arrived.push(arrived);
}
