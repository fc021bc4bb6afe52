//! A frame by the twins.

use super::clusters::Clusters;
use super::gathered::{self, Gathered, Scenery};
use super::gathering::Gathering;
use super::lit::{LightShare, LitScene};
use super::photons::{Photons, Traced, check_slots};
use super::samples::{Samples, Seen};
use super::setting::Setting;
use super::{bounce, camera, direct, emit, mix, samples};
use crate::camera::Camera;
use crate::device::{CpuDevice, Interrupted};
use crate::error::{Error, Result};
use crate::workloads::size::Size;
use crate::workloads::trace::backend::Prepared;
use glam::Vec4;
use rayon::ThreadPool;

/// Everything that a frame made.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stages {
    /// Slots of all paths.
    pub traced: Traced,
    /// What the slots hold, in their order.
    pub photons: Photons,
    /// Each pixel has a sample.
    pub samples: Samples,
    /// Radiance of each pixel by direct light; `w` is 0.
    pub direct: Vec<Vec4>,
    /// What lies between samples and irradiance.
    pub gathered: Gathered,
    /// Irradiance of each sample by indirect light; `w` is 0.
    pub irradiance: Vec<Vec4>,
    /// Radiance of each pixel; `w` is 0.
    pub picture: Vec<Vec4>,
}

/// A scene and a structure with all that decides a frame but the camera.
pub struct CpuFrame<'a> {
    device: &'a CpuDevice,
    caster: Box<dyn Prepared + 'a>,
    lit: &'a LitScene,
    setting: Setting,
    gathering: Gathering,
    size: Size,
}

impl<'a> CpuFrame<'a> {
    /// A frame on `device`; `caster` casts its rays.
    pub fn new(
        device: &'a CpuDevice,
        caster: Box<dyn Prepared + 'a>,
        lit: &'a LitScene,
        setting: Setting,
        gathering: impl Into<Gathering>,
        size: Size,
    ) -> CpuFrame<'a> {
        CpuFrame { device, caster, lit, setting, gathering: gathering.into(), size }
    }

    /// The image has this size.
    pub fn size(&self) -> Size {
        self.size
    }

    /// The threads that it runs on.
    pub fn pool(&self) -> &ThreadPool {
        self.device.pool()
    }

    /// Follows all paths.
    ///
    /// # Errors
    /// [`Error::Refused`] for more slots than photons can have, [`Error::Input`] for fewer paths than lights,
    /// [`Error::Interrupted`] between hits, and the device's.
    pub fn trace(&mut self, interrupted: Interrupted) -> Result<Traced> {
        let shares = self.lit.shares(self.setting.paths)?;
        trace(self.device.pool(), self.caster.as_mut(), self.lit, &shares, &self.setting, interrupted)
    }

    /// Makes the samples of a view.
    ///
    /// # Errors
    /// [`Error::Interrupted`] before rays are cast, and the device's.
    pub fn samples(&mut self, camera: &Camera, interrupted: Interrupted) -> Result<Samples> {
        let seen = self.see(camera, interrupted)?;
        Ok(self.device.pool().install(|| samples::of(self.lit, camera, &seen)))
    }

    /// Radiance of the samples of a view by direct light; `w` is 0.
    ///
    /// # Errors
    /// [`Error::Interrupted`] between lights, and the device's.
    pub fn direct(&mut self, camera: &Camera, samples: &Samples, interrupted: Interrupted) -> Result<Vec<Vec4>> {
        let seen = self.see(camera, interrupted)?;
        let (pool, caster) = (self.device.pool(), self.caster.as_mut());
        direct::light(pool, caster, self.lit, &self.setting, (&seen, samples), interrupted)
    }

    /// What lies between the samples of a view and their irradiance by indirect light, and that irradiance; `w` is 0.
    ///
    /// # Errors
    /// Those of [`gathered::gather`].
    pub fn gather(
        &self,
        camera: &Camera,
        samples: &Samples,
        photons: &Photons,
        interrupted: Interrupted,
    ) -> Result<(Gathered, Vec<Vec4>)> {
        let view = self.scenery(camera, samples, photons);
        gathered::gather(self.device.pool(), &self.gathering, &view, interrupted)
    }

    /// The clusters of a view.
    ///
    /// # Errors
    /// [`Error::Device`] for a frame without clusters, and those of [`CpuFrame::samples`].
    pub fn clusters(&mut self, camera: &Camera, interrupted: Interrupted) -> Result<Clusters> {
        let (samples, photons) = (self.samples(camera, interrupted)?, Photons::default());
        gathered::clustered(self.device.pool(), &self.gathering, &self.scenery(camera, &samples, &photons))
    }

    /// A view of the scene.
    pub fn scenery<'s>(&'s self, camera: &'s Camera, samples: &'s Samples, photons: &'s Photons) -> Scenery<'s> {
        Scenery { lit: self.lit, camera, size: self.size, samples, photons }
    }

    /// How photons reach samples.
    pub fn gathering(&self) -> &Gathering {
        &self.gathering
    }

    /// Renders a frame and keeps everything that it makes.
    ///
    /// # Errors
    /// Those of [`CpuFrame::trace`]; [`Error::Interrupted`] between stages.
    pub fn render(&mut self, camera: &Camera, interrupted: Interrupted) -> Result<Stages> {
        let traced = self.trace(interrupted)?;
        let photons = traced.slots.compacted();
        let seen = self.see(camera, interrupted)?;
        let (pool, lit) = (self.device.pool(), self.lit);
        let samples = pool.install(|| samples::of(lit, camera, &seen));
        let direct = direct::light(pool, self.caster.as_mut(), lit, &self.setting, (&seen, &samples), interrupted)?;
        let (gathered, irradiance) = self.gather(camera, &samples, &photons, interrupted)?;
        let picture = pool.install(|| mix::picture(&samples, &direct, &irradiance));
        Ok(Stages { traced, photons, samples, direct, gathered, irradiance, picture })
    }

    /// Renders a frame into `out`, which has an element for each pixel, rows from the top.
    ///
    /// # Errors
    /// Those of [`CpuFrame::render`].
    pub fn picture(&mut self, camera: &Camera, out: &mut [Vec4], interrupted: Interrupted) -> Result<()> {
        out.copy_from_slice(&self.render(camera, interrupted)?.picture);
        Ok(())
    }

    fn see(&mut self, camera: &Camera, interrupted: Interrupted) -> Result<Seen> {
        check(interrupted)?;
        let rays = self.device.pool().install(|| camera::rays(camera, self.size));
        let hits = self.caster.cast(&rays, None)?;
        Ok(Seen { rays, hits })
    }
}

/// Follows all paths; `shares` are those of the setting's paths. The threads are those of `pool` and the
/// caster's.
///
/// # Errors
/// [`Error::Interrupted`] between hits, and the device's.
pub fn trace(
    pool: &ThreadPool,
    caster: &mut dyn Prepared,
    lit: &LitScene,
    shares: &[LightShare],
    setting: &Setting,
    interrupted: Interrupted,
) -> Result<Traced> {
    check_slots(setting)?;
    let slots = Photons::empty(setting.slots() as usize);
    let mut traced = Traced { slots, arrived: Vec::with_capacity(setting.hits as usize) };
    let (mut rays, mut carried) = pool.install(|| emit::rays(lit, shares, setting));
    for number in 1..=setting.hits {
        check(interrupted)?;
        let hits = caster.cast(&rays, None)?;
        pool.install(|| bounce::hit(lit, setting, number, &hits, (&mut rays, &mut carried), &mut traced));
    }
    Ok(traced)
}

/// [`Error::Interrupted`] if work is to stop.
fn check(interrupted: Interrupted) -> Result<()> {
    if interrupted() { Err(Error::Interrupted) } else { Ok(()) }
}
