//! Algorithm and hit record as types, so that the compiler writes a loop for each.
//!
//! Constants would not do: a closure that `vectorize` runs with a level's instructions is a function of its own, and
//! what it captures is read at run time.

use super::super::options::{Algorithm, HitRecord, Options};

/// What decides the shape of the loops.
pub trait Mode: Copy {
    /// Whether hits go into arrays and colours follow on the way back.
    fn two_pass(self) -> bool;

    /// Whether the loop over the spheres keeps the whole hit.
    fn in_loop(self) -> bool;
}

/// Known to the compiler.
#[derive(Clone, Copy)]
pub struct Fixed<const TWO_PASS: bool, const IN_LOOP: bool>;

impl<const TWO_PASS: bool, const IN_LOOP: bool> Mode for Fixed<TWO_PASS, IN_LOOP> {
    #[inline(always)]
    fn two_pass(self) -> bool {
        TWO_PASS
    }

    #[inline(always)]
    fn in_loop(self) -> bool {
        IN_LOOP
    }
}

/// Asked at run time: one loop for all, where time does not matter.
#[derive(Clone, Copy)]
pub struct Chosen {
    two_pass: bool,
    in_loop: bool,
}

impl Chosen {
    /// What the options say.
    pub fn of(options: &Options) -> Chosen {
        Chosen { two_pass: options.algorithm == Algorithm::TwoPass, in_loop: options.hit == HitRecord::InLoop }
    }
}

impl Mode for Chosen {
    #[inline(always)]
    fn two_pass(self) -> bool {
        self.two_pass
    }

    #[inline(always)]
    fn in_loop(self) -> bool {
        self.in_loop
    }
}

/// Evaluates `$call` with `$mode` from `$options`: [`Chosen`] where `$watched`, else a [`Fixed`] one.
macro_rules! by_mode {
    ($watched:expr, $options:expr, $mode:ident => $call:expr) => {{
        let chosen = $crate::workloads::spheres::render::mode::Chosen::of($options);
        use $crate::workloads::spheres::render::mode::{Fixed, Mode};
        match ($watched, chosen.two_pass(), chosen.in_loop()) {
            (true, ..) => {
                let $mode = chosen;
                $call
            }
            (false, false, false) => {
                let $mode = Fixed::<false, false>;
                $call
            }
            (false, false, true) => {
                let $mode = Fixed::<false, true>;
                $call
            }
            (false, true, false) => {
                let $mode = Fixed::<true, false>;
                $call
            }
            (false, true, true) => {
                let $mode = Fixed::<true, true>;
                $call
            }
        }
    }};
}

pub(super) use by_mode;
