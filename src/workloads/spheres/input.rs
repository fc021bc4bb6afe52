//! A scene of spheres, opened: what its cases share.

use super::case::SpheresCase;
use super::options::{Precision, Renderer};
use super::references::References;
use super::render::{CpuRenderer, Fault};
use super::run::SpheresRun;
use super::scene::{PackedSphere, Scene};
use super::workload::WORKLOAD;
use super::{half, pictures};
use crate::device::{Device, Feature};
use crate::error::{Error, Result};
use crate::harness::workload::{Case, Context, Input, Run};
use crate::record::row::{Input as InputRecord, Key, Metric, Row, Status};
use std::cell::RefCell;
use std::collections::HashMap;

/// Rays and hits of each bounce, and the case that counted them.
pub(super) type Totals = (String, Vec<u64>, Vec<u64>);

/// See the module.
pub struct SpheresInput<'a> {
    pub(super) context: &'a Context<'a>,
    /// As it was asked for.
    pub(super) name: String,
    pub(super) scene: Scene,
    pub(super) spheres: Vec<PackedSphere>,
    /// What the GPU gets: the same, unless a test makes one of them wrong.
    pub(super) on_gpu: Vec<PackedSphere>,
    /// What pictures are compared with.
    pub(super) references: RefCell<References>,
    /// What was counted first, by the axis values that decide it: all renderers must count the same.
    pub(super) totals: RefCell<HashMap<String, Totals>>,
    /// Planted by a test.
    pub(super) fault: Option<Fault>,
}

impl<'a> SpheresInput<'a> {
    /// Loads the scene of some cases. Tests plant a fault, or name a sphere that is wrong on the GPU.
    ///
    /// # Errors
    /// Those of [`Scene::load`].
    pub fn open(
        cases: &[Case],
        context: &'a Context<'a>,
        fault: Option<Fault>,
        wrong_sphere: Option<usize>,
    ) -> Result<SpheresInput<'a>> {
        let name = cases.first().map_or(String::new(), |case| case.input.clone());
        let scene = Scene::load(&name)?;
        let (spheres, references) = (scene.packed(), RefCell::new(References::default()));
        let mut on_gpu = spheres.clone();
        if let Some(sphere) = wrong_sphere.and_then(|index| on_gpu.get_mut(index)) {
            sphere.radius2 *= 2.0;
        }
        Ok(SpheresInput { context, name, scene, spheres, on_gpu, references, totals: RefCell::default(), fault })
    }
}

impl SpheresInput<'_> {
    /// What decides how many rays and hits a scene has.
    pub(super) fn shape_of(case: &Case) -> String {
        ["trips", "resolution", "frames"].map(|axis| case.axis(axis)).join(" ")
    }
}

impl Input for SpheresInput<'_> {
    fn records(&self) -> Vec<InputRecord> {
        let metrics = vec![Metric::new("spheres", self.spheres.len())];
        vec![InputRecord { kind: "scene".into(), name: self.name.clone(), hash: self.scene.hash.clone(), metrics }]
    }

    fn key(&self, case: &Case) -> Key {
        let inputs = [("scene".to_owned(), self.scene.hash.clone())].into();
        Key { workload: WORKLOAD.into(), axes: case.axes.clone(), inputs }
    }

    fn remember(&self, case: &Case, row: &Row) {
        // A GPU's counts may be others
        if row.status != Status::Ok || case.axis("renderer") == Renderer::Gpu.name() || case.axis("precision") != "f32"
        {
            return;
        }
        let counts = |name: &str| -> Vec<u64> {
            let of_bounce = |bounce: usize| row.metric(Some(&format!("bounce-{bounce}")), name)?.integer();
            (1..).map_while(of_bounce).collect()
        };
        let totals = (case.group.clone(), counts("rays"), counts("hits"));
        self.totals.borrow_mut().entry(SpheresInput::shape_of(case)).or_insert(totals);
    }

    fn build(&mut self, case: &Case, _: &Device) -> Result<u64> {
        let SpheresCase { renderer, precision, .. } = SpheresCase::parse(case)?;
        if precision == Precision::F16 && !matches!(renderer, Renderer::Sequential | Renderer::Gpu) {
            let problem = format!("{} has no half precision: sequential and gpu have", renderer.name());
            return Err(Error::unsupported(problem));
        }
        Ok(0)
    }

    fn prepare<'p>(&'p self, device: &'p Device, case: &Case) -> Result<Box<dyn Run + 'p>> {
        let SpheresCase { renderer, options, precision, .. } = SpheresCase::parse(case)?;
        match (device, renderer) {
            (Device::Vulkan(device), Renderer::Gpu) => {
                if precision == Precision::F32 {
                    return Ok(Box::new(SpheresRun::on_gpu(self, device, options)));
                }
                if !device.features().has(Feature::Half) {
                    return Err(Error::unsupported("speed not measured: this device has no half precision"));
                }
                Ok(Box::new(half::HalfRun::new(self, Some(device))))
            }
            (Device::Cpu(_), Renderer::Gpu) => {
                Err(Error::unsupported("there is no Vulkan device, on which the renderer gpu runs"))
            }
            (Device::Cpu(_), _) if precision == Precision::F16 => Ok(Box::new(half::HalfRun::new(self, None))),
            (Device::Cpu(device), _) => {
                let mut prepared = CpuRenderer::new(renderer, options, device.pool())?;
                if let Some(fault) = self.fault.filter(|_| renderer.is_simd()) {
                    prepared = prepared.with_fault(fault);
                }
                Ok(Box::new(SpheresRun::on_cpu(self, device, options.algorithm, prepared)))
            }
            (Device::Vulkan(_), _) => Err(Error::unsupported("this renderer runs on the CPU")),
        }
    }

    fn pictures(&self, _: &Device) -> Result<()> {
        pictures::take(self)
    }

    fn has_pictures(&self) -> bool {
        pictures::place(self.context.out, &self.name).is_file()
    }
}
