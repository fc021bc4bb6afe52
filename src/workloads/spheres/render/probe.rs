//! What is asked and planted along the way: nothing where a frame is timed, counters and faults where it is watched.

use super::super::count::Counts;
use fearless_simd::{Select, Simd, SimdFloat, SimdMask};

/// The widest vector.
pub const MAX_LANES: usize = 16;

/// A place where a vector ends something early because no lane needs it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// The paths, because no lane hit.
    Miss,
    /// The stores of a sphere, because it is the nearest one of no lane.
    NoHit,
    /// A sphere's root and division, because no discriminant is positive.
    NoDiscriminant,
}

/// A mistake for the tests to plant into a SIMD renderer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The broken lane; [`FaultKind::AllForAny`] concerns all lanes.
    pub lane: usize,
    /// What is wrong.
    pub kind: FaultKind,
}

/// Kinds of mistakes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaultKind {
    /// Distances of the lane are longer by 1/64.
    ShiftDistance,
    /// The lane never hits.
    DropMask,
    /// The exit is taken where one lane does not need what follows, instead of none.
    AllForAny(Exit),
    /// The exit does not ask the lane: it is taken where this one alone needs what follows.
    Overlook(Exit),
}

/// Called by the renderers' one text; inlined, so that [`Silent`] leaves nothing behind.
pub trait Probe {
    /// Whether hits are to be counted.
    const WATCHES: bool;

    /// One search by a vector of `lanes` pixels; 1 for scalar renderers.
    fn searched(&mut self, lanes: usize);

    /// An exit was taken by its switch.
    fn exited(&mut self, exit: Exit);

    /// A pixel's path hit `hits` times; `at` is its place in the probe's part of the image.
    fn pixel(&mut self, at: usize, hits: u32);

    /// The lanes' distances.
    #[inline(always)]
    fn distance<S: Simd, F: SimdFloat<S, Element = f32>>(&self, _simd: S, t: F) -> F {
        t
    }

    /// The lanes for which a sphere is the nearest one.
    #[inline(always)]
    fn nearest<S: Simd, M: SimdMask<S>>(&self, _simd: S, mask: M) -> M {
        mask
    }

    /// Whether a lane needs what follows the exit.
    #[inline(always)]
    fn any<S: Simd, M: SimdMask<S>>(&self, _exit: Exit, mask: M) -> bool {
        mask.any_true()
    }
}

/// Nothing.
pub struct Silent;

impl Probe for Silent {
    const WATCHES: bool = false;
    #[inline(always)]
    fn searched(&mut self, _lanes: usize) {}
    #[inline(always)]
    fn exited(&mut self, _exit: Exit) {}
    #[inline(always)]
    fn pixel(&mut self, _at: usize, _hits: u32) {}
}

/// Counts, and plants a fault where there is one.
pub struct Watched<'a> {
    /// So far.
    pub counts: Counts,
    /// Hits of each pixel's path, of the same part of the image.
    pub hits: &'a mut [u32],
    /// To be planted.
    pub fault: Option<Fault>,
}

impl Watched<'_> {
    fn planted(&self, kind: FaultKind) -> Option<usize> {
        self.fault.filter(|fault| fault.kind == kind).map(|fault| fault.lane)
    }
}

impl Probe for Watched<'_> {
    const WATCHES: bool = true;

    fn searched(&mut self, lanes: usize) {
        self.counts.searches += lanes as u64;
        self.counts.vectors += u64::from(lanes > 1);
    }

    fn exited(&mut self, exit: Exit) {
        match exit {
            Exit::Miss => self.counts.exits_on_miss += 1,
            Exit::NoHit => self.counts.skips_no_hit += 1,
            Exit::NoDiscriminant => self.counts.skips_no_discriminant += 1,
        }
    }

    fn pixel(&mut self, at: usize, hits: u32) {
        self.counts.add_path(hits as usize);
        if let Some(pixel) = self.hits.get_mut(at) {
            *pixel = hits;
        }
    }

    #[inline(always)]
    fn distance<S: Simd, F: SimdFloat<S, Element = f32>>(&self, simd: S, t: F) -> F {
        match self.planted(FaultKind::ShiftDistance) {
            Some(lane) => F::Mask::from_bitmask(simd, 1 << lane).select(t * F::splat(simd, 1.015625), t),
            None => t,
        }
    }

    #[inline(always)]
    fn nearest<S: Simd, M: SimdMask<S>>(&self, simd: S, mask: M) -> M {
        match self.planted(FaultKind::DropMask) {
            Some(lane) => mask & M::from_bitmask(simd, !(1 << lane)),
            None => mask,
        }
    }

    #[inline(always)]
    fn any<S: Simd, M: SimdMask<S>>(&self, exit: Exit, mask: M) -> bool {
        if self.planted(FaultKind::AllForAny(exit)).is_some() {
            return mask.all_true();
        }
        match self.planted(FaultKind::Overlook(exit)) {
            Some(lane) => mask.to_bitmask() & !(1 << lane) != 0,
            None => mask.any_true(),
        }
    }
}
