//! Instructions of events.

use super::super::stream::{EVENTS, Event};
use super::super::sums::Sums;
use crate::device::Source;
use crate::error::Result;

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
