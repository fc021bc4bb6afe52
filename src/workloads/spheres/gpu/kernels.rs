//! Kernel variants: the algorithm, where the spheres are, and what is written.

use crate::device::vulkan::{Binding, BindingKind};
use crate::device::{Constants, Source, assemble};
use crate::error::{Error, Result};
use crate::workloads::kernel_files::FILES;
use crate::workloads::spheres::options::Algorithm;

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
    /// Also writes the number of hits of each pixel.
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
        let counting = if self.counting { " counting" } else { "" };
        format!("{algorithm}{exits}{memory}{counting}")
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
        let slots = [
            (
                "spheres",
                ["spheres/spheres_storage.wgsl", "spheres/spheres_uniform.wgsl"][usize::from(self.is_uniform())],
            ),
            (
                "algorithm",
                match self.algorithm {
                    Algorithm::TwoPass => "spheres/two_pass.wgsl",
                    Algorithm::OnePass => "spheres/one_pass.wgsl",
                },
            ),
            ("store", ["spheres/store_timed.wgsl", "spheres/store_counted.wgsl"][usize::from(self.counting)]),
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

/// Every variant with the usual number of rays along a path: its name and its text.
///
/// # Errors
/// [`Error::Device`] for an include that does not exist (a mistake in `kernels/`).
pub fn kernels() -> Result<Vec<(String, Source)>> {
    let mut all = Vec::new();
    for algorithm in [Algorithm::TwoPass, Algorithm::OnePass] {
        for exit_on_miss in [false, true] {
            for uniform_spheres in [Some(MAX_UNIFORM_SPHERES), None] {
                for counting in [false, true] {
                    let kernel = Kernel { algorithm, exit_on_miss, trips: 5, uniform_spheres, counting };
                    all.push((kernel.label(), kernel.assemble()?));
                }
            }
        }
    }
    Ok(all)
}
