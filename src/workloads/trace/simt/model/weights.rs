//! Instructions of events, and of which kernel they are.

use super::super::stream::{EVENTS, Event};
use super::super::sums::Sums;
use crate::device::Source;
use crate::error::{Error, Result};
use crate::workloads::trace::gpu::kernels::{self, Entry, Kernel, StagedPass};
use crate::workloads::trace::method::TriangleLayout;
use crate::workloads::trace::rays::Config;
use crate::workloads::trace::{Method, Selection};
use std::collections::HashMap;
use std::sync::{LazyLock, Mutex, PoisonError};

/// A weight may be wrong by this factor, up or down.
pub const EVENT_FACTOR: f64 = 1.5;

/// Instructions of a warp by what it issues.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weights {
    /// Of a traversal: set-up of rays, and what is done with their hits.
    pub ray: f64,
    /// By event.
    pub of: [f64; EVENTS.len()],
}

/// The mark of each event in kernels.
fn mark(event: &str) -> &str {
    match event {
        "step" => "inner",
        "child" => "box_test",
        other => other,
    }
}

impl Weights {
    /// The static costs of a kernel ([`Source::event_costs`]).
    ///
    /// # Errors
    /// [`crate::Error::Device`] for a kernel that is not valid (a mistake in `kernels/`).
    pub fn of_kernel(kernel: &Source) -> Result<Weights> {
        let costs = kernel.event_costs()?;
        let of = |mark: &str| costs.get(mark).copied().unwrap_or(0.0);
        Ok(Weights { ray: of("ray"), of: EVENTS.map(|event| of(mark(event))) })
    }

    /// Weights of a traversal and of these events; all others are 0.
    pub fn by_hand(ray: f64, events: &[(Event, f64)]) -> Weights {
        let mut weights = Weights { ray, of: [0.0; EVENTS.len()] };
        events.iter().for_each(|&(event, weight)| weights.of[event as usize] = weight);
        weights
    }

    /// Each weight times its factor: that of a traversal first.
    #[must_use]
    pub fn scaled(&self, factors: &[f64; EVENTS.len() + 1]) -> Weights {
        let of = std::array::from_fn(|event| self.of[event] * factors[event + 1]);
        Weights { ray: self.ray * factors[0], of }
    }

    /// Instructions that warps issue for these counts.
    pub fn instructions(&self, sums: &[Sums]) -> f64 {
        let of_type = |sums: &Sums| {
            let events = sums.issued.iter().zip(&self.of).map(|(&issued, weight)| issued as f64 * weight);
            sums.warps as f64 * self.ray + events.sum::<f64>()
        };
        sums.iter().map(of_type).sum()
    }
}

/// What the model needs to know of a kernel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KernelFacts {
    /// Of its events.
    pub weights: Weights,
    /// Work-group memory of a work-group.
    pub workgroup_bytes: u64,
}

impl KernelFacts {
    /// The timed kernel of frames of a selection; each is read once in the life of the program.
    ///
    /// # Errors
    /// [`Error::Device`] for a kernel that is not valid (a mistake in `kernels/`).
    pub fn of(selection: &Selection, config: Config) -> Result<KernelFacts> {
        static KNOWN: LazyLock<Mutex<HashMap<(String, Config), KernelFacts>>> = LazyLock::new(Mutex::default);
        let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        let key = (selection.full_name(), config);
        if let Some(facts) = known.get(&key) {
            return Ok(*facts);
        }
        let kernel = timed_kernel(selection.method(), config)?;
        let facts =
            KernelFacts { weights: Weights::of_kernel(&kernel)?, workgroup_bytes: kernel.cost()?.workgroup_bytes };
        known.insert(key, facts);
        Ok(facts)
    }
}

/// The timed kernel of frames as a GPU runs it, with a stack of 32; where a frame has several passes, that of primary
/// rays.
///
/// # Errors
/// [`Error::Device`] with file and line for an include that does not exist (a mistake in `kernels/`).
fn timed_kernel(method: Method, config: Config) -> Result<Source> {
    let entry = if method.traversal.packets.is_some() {
        kernels::packet_passes(config, false)[0]
    } else if method.is_staged(config.bounces()) {
        Entry::Staged { config, counting: false, pass: StagedPass::Primary }
    } else {
        Entry::Render { config, counting: false }
    };
    let leaf_order = method.traversal.leaf_order && method.triangles == TriangleLayout::LeafOrder;
    let kernel = Kernel { entry, method, stack_size: 32, software_threads: 0, textures: false, leaf_order };
    kernel.assemble().map_err(Error::Device)
}
