//! Kernel variants: the algorithm, where the spheres are, and what is written.

use crate::device::vulkan::{Binding, BindingKind};
use crate::device::{Constants, Source, assemble};
use crate::error::{Error, Result};
use crate::workloads::kernel_files::FILES;
use crate::workloads::spheres::options::{Algorithm, Precision};

/// Pixels of a work-group along each axis.
pub const GROUP_SIDE: u32 = 8;

/// Most spheres in a uniform buffer, where the device has no lower limit: 64 KiB.
pub const MAX_UNIFORM_SPHERES: u32 = 2048;

/// One kernel variant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Kernel {
    /// Order of the work along a path.
    pub algorithm: Algorithm,
    /// Ends a path at its first miss.
    pub exit_on_miss: bool,
    /// Most rays along a path.
    pub trips: u32,
    /// Spheres for which the uniform array has room; `None` for a storage buffer.
    pub uniform_spheres: Option<u32>,
    /// Of the arithmetic, and of the spheres in their buffer.
    pub precision: Precision,
    /// Also writes the number of hits and of searches of each pixel.
    pub counting: bool,
}

impl Kernel {
    /// A name for labels and messages, such as `one-pass exits uniform counting`.
    pub fn label(&self) -> String {
        let algorithm = match self.algorithm {
            Algorithm::TwoPass => "two-pass",
            Algorithm::OnePass => "one-pass",
        };
        let exits = if self.exit_on_miss { " exits" } else { "" };
        let memory = if self.uniform_spheres.is_some() { " uniform" } else { " storage" };
        let precision = if self.precision == Precision::F16 { " half" } else { "" };
        let counting = if self.counting { " counting" } else { "" };
        format!("{algorithm}{exits}{memory}{precision}{counting}")
    }

    /// The WGSL of this variant.
    ///
    /// # Errors
    /// [`Error::Device`] for an include that does not exist (a mistake in `kernels/`).
    pub fn assemble(&self) -> Result<Source> {
        let mut constants = Constants::default();
        constants.unsigned("GROUP_SIDE", GROUP_SIDE);
        constants.unsigned("TRIPS", self.trips);
        constants.flag("EXIT_ON_MISS", self.exit_on_miss);
        if let Some(spheres) = self.uniform_spheres {
            constants.machine("SPHERES", spheres);
        }
        let chosen = |is_second: bool, files: [&'static str; 2]| files[usize::from(is_second)];
        let slots = [
            ("precision", chosen(self.precision == Precision::F16, ["spheres/single.wgsl", "spheres/half.wgsl"])),
            ("spheres", chosen(self.is_uniform(), ["spheres/spheres_storage.wgsl", "spheres/spheres_uniform.wgsl"])),
            (
                "algorithm",
                chosen(self.algorithm == Algorithm::OnePass, ["spheres/two_pass.wgsl", "spheres/one_pass.wgsl"]),
            ),
            ("store", chosen(self.counting, ["spheres/store_timed.wgsl", "spheres/store_counted.wgsl"])),
        ];
        assemble(FILES, "spheres/render.wgsl", &slots, constants).map_err(Error::Device)
    }

    /// The bindings that its text declares.
    pub(super) fn layout(&self) -> Vec<Binding> {
        let spheres = if self.is_uniform() { BindingKind::Uniform } else { BindingKind::Read };
        let kinds = [BindingKind::MovingUniform, spheres, BindingKind::ReadWrite, BindingKind::ReadWrite];
        let bound = if self.counting { 4 } else { 3 };
        (0..).zip(kinds).take(bound).map(|(number, kind)| Binding::new(number, kind)).collect()
    }

    fn is_uniform(&self) -> bool {
        self.uniform_spheres.is_some()
    }
}

/// Every variant with the usual number of rays along a path, those in half precision timed and with a uniform buffer
/// only: its name and its text.
///
/// # Errors
/// [`Error::Device`] for an include that does not exist (a mistake in `kernels/`).
pub fn kernels() -> Result<Vec<(String, Source)>> {
    let mut all = Vec::new();
    let uniform = Some(MAX_UNIFORM_SPHERES);
    for algorithm in [Algorithm::TwoPass, Algorithm::OnePass] {
        for exit_on_miss in [false, true] {
            for (uniform_spheres, precision, counting) in [
                (uniform, Precision::F32, false),
                (uniform, Precision::F32, true),
                (None, Precision::F32, false),
                (None, Precision::F32, true),
                (uniform, Precision::F16, false),
            ] {
                let kernel = Kernel { algorithm, exit_on_miss, trips: 5, uniform_spheres, precision, counting };
                all.push((kernel.label(), kernel.assemble()?));
            }
        }
    }
    Ok(all)
}
