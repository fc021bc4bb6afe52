//! Counting, or not: twins of `kernels/lib/count_on.wgsl` and `count_off.wgsl`.

use crate::workloads::trace::backend::Counters;

/// What traversals report of one ray.
pub trait Count: Copy + Default + Send + Sync {
    /// A ray sets out.
    fn ray(&mut self);
    /// An inner node, or a grid cell.
    fn inner(&mut self);
    /// A leaf.
    fn leaf(&mut self);
    /// A ray/triangle test.
    fn test(&mut self);
    /// An entry taken from a stack.
    fn pop(&mut self);
    /// A restart.
    fn restart(&mut self);
    /// What was counted.
    fn total(&self) -> Counters;
}

/// Counts nothing and costs nothing: the timed twins.
#[derive(Clone, Copy, Default)]
pub struct CountOff;

impl Count for CountOff {
    #[inline(always)]
    fn ray(&mut self) {}
    #[inline(always)]
    fn inner(&mut self) {}
    #[inline(always)]
    fn leaf(&mut self) {}
    #[inline(always)]
    fn test(&mut self) {}
    #[inline(always)]
    fn pop(&mut self) {}
    #[inline(always)]
    fn restart(&mut self) {}
    fn total(&self) -> Counters {
        Counters::default()
    }
}

impl Count for Counters {
    #[inline(always)]
    fn ray(&mut self) {
        self.rays += 1;
    }
    #[inline(always)]
    fn inner(&mut self) {
        self.inner += 1;
    }
    #[inline(always)]
    fn leaf(&mut self) {
        self.leaves += 1;
    }
    #[inline(always)]
    fn test(&mut self) {
        self.tests += 1;
    }
    #[inline(always)]
    fn pop(&mut self) {
        self.pops += 1;
    }
    #[inline(always)]
    fn restart(&mut self) {
        self.restarts += 1;
    }
    fn total(&self) -> Counters {
        *self
    }
}
