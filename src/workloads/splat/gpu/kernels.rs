//! Kernel variants of a frame.

use super::steps::Variant;
use crate::device::vulkan::{Binding, BindingKind};
use crate::device::{Constants, Source, assemble};
use crate::error::{Error, Result};
use crate::math;
use crate::workloads::kernel_files::FILES;
use crate::workloads::splat::estimate::BLOCK;
use crate::workloads::splat::setting::{EstimateKernel, Falloff, MAX_HITS, Weight};

/// Invocations of a work-group.
pub const GROUP_SIZE: u32 = 64;

/// A kernel of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // each is described by its file
pub enum Kernel {
    Emit,
    Bounce,
    Flags,
    Scatter,
    Camera,
    Samples,
    Shadow,
    Direct(Falloff),
    Estimate(EstimateKernel, Weight),
    Mix,
}

use BindingKind::{MovingUniform, Read, ReadWrite, Uniform};

impl Kernel {
    /// Every variant.
    pub fn all() -> Vec<Kernel> {
        use Kernel::*;
        let mut all = vec![Emit, Bounce, Flags, Scatter, Camera, Samples, Shadow, Mix];
        all.extend([Falloff::Square, Falloff::Source].map(Direct));
        for kernel in [EstimateKernel::Epanechnikov, EstimateKernel::Constant] {
            all.extend([Weight::Side, Weight::Cosine].map(|weight| Estimate(kernel, weight)));
        }
        all
    }

    fn file(self) -> &'static str {
        match self {
            Kernel::Emit => "splat/emit.wgsl",
            Kernel::Bounce => "splat/bounce.wgsl",
            Kernel::Flags => "splat/flags.wgsl",
            Kernel::Scatter => "splat/scatter.wgsl",
            Kernel::Camera => "splat/camera.wgsl",
            Kernel::Samples => "splat/samples.wgsl",
            Kernel::Shadow => "splat/shadow.wgsl",
            Kernel::Direct(_) => "splat/direct.wgsl",
            Kernel::Estimate(..) => "splat/estimate.wgsl",
            Kernel::Mix => "splat/mix.wgsl",
        }
    }

    /// A name for labels and messages, such as `estimate constant cosine`.
    fn name(self) -> String {
        let name = self.file().trim_start_matches("splat/").trim_end_matches(".wgsl");
        let options = match self {
            Kernel::Direct(Falloff::Square) => " square",
            Kernel::Direct(Falloff::Source) => " source",
            Kernel::Estimate(EstimateKernel::Epanechnikov, Weight::Side) => " epanechnikov side",
            Kernel::Estimate(EstimateKernel::Epanechnikov, Weight::Cosine) => " epanechnikov cosine",
            Kernel::Estimate(EstimateKernel::Constant, Weight::Side) => " constant side",
            Kernel::Estimate(EstimateKernel::Constant, Weight::Cosine) => " constant cosine",
            _ => "",
        };
        format!("{name}{options}")
    }
}

impl Variant for Kernel {
    fn label(&self) -> String {
        self.name()
    }

    fn assemble(&self) -> Result<Source> {
        let mut constants = Constants::default();
        constants.unsigned("GROUP_SIZE", GROUP_SIZE);
        constants.unsigned("MAX_HITS", MAX_HITS);
        constants.unsigned("MISS", math::MISS);
        constants.float("MIN_POSITIVE", f32::MIN_POSITIVE);
        constants.float("INVERSE_OF_ZERO", math::INVERSE_OF_ZERO);
        constants.float("PLANE_SHIFT", math::PLANE_SHIFT);
        constants.float("PLANE_SHIFT_MIN", math::PLANE_SHIFT_MIN);
        constants.float("SLACK", math::SLACK);
        constants.flag("SOFTWARE", false);
        let mut slots = vec![("intersect", "trace/intersect/watertight.wgsl")];
        match *self {
            Kernel::Direct(Falloff::Square) => slots.push(("falloff", "splat/falloff_square.wgsl")),
            Kernel::Direct(Falloff::Source) => slots.push(("falloff", "splat/falloff_source.wgsl")),
            Kernel::Estimate(kernel, weight) => {
                constants.unsigned("BLOCK", BLOCK as u32);
                constants.flag("CONSTANT_KERNEL", kernel == EstimateKernel::Constant);
                constants.flag("COSINE_WEIGHT", weight == Weight::Cosine);
            }
            _ => {}
        }
        assemble(FILES, self.file(), &slots, constants).map_err(Error::Device)
    }

    fn layout(&self) -> Vec<Binding> {
        let kinds: &[BindingKind] = match *self {
            Kernel::Emit => &[Uniform, Read, ReadWrite, ReadWrite, ReadWrite],
            Kernel::Bounce => &[Uniform, Read, Read, ReadWrite, ReadWrite, ReadWrite, ReadWrite, ReadWrite, ReadWrite],
            Kernel::Flags => &[Uniform, Read, ReadWrite],
            Kernel::Scatter => &[Uniform, Read, Read, Read, Read, ReadWrite, ReadWrite, ReadWrite],
            Kernel::Camera => &[MovingUniform, ReadWrite],
            Kernel::Samples => &[MovingUniform, Read, Read, Read, ReadWrite, ReadWrite, ReadWrite],
            Kernel::Shadow => &[Uniform, Read, ReadWrite],
            Kernel::Direct(Falloff::Square) => &[Uniform, Read, Read, Read, Read, ReadWrite],
            Kernel::Direct(Falloff::Source) => &[Uniform, Read, Read, Read, Read, ReadWrite, Read, Read, Read],
            Kernel::Estimate(..) => &[Uniform, Read, Read, Read, Read, Read, Read, ReadWrite],
            Kernel::Mix => &[Uniform, Read, Read, Read, ReadWrite],
        };
        (0..).zip(kinds).map(|(number, &kind)| Binding::new(number, kind)).collect()
    }
}

/// Every kernel of a frame but those that cast rays and add up: its name and its text.
///
/// # Errors
/// [`Error::Device`] for an include that does not exist (a mistake in `kernels/`).
pub fn kernels() -> Result<Vec<(String, Source)>> {
    let own = Kernel::all().into_iter().map(|kernel| Ok((kernel.label(), kernel.assemble()?)));
    let mut all = own.collect::<Result<Vec<_>>>()?;
    all.extend(super::splatting::kernels()?);
    all.extend(super::clusters::kernels()?);
    Ok(all)
}
