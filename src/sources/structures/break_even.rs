//! After how many rays a structure that takes longer to build has caught up.

/// What a structure costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// Milliseconds until the first ray can be traced: the build, and the upload of what was not built on the device.
    pub build_ms: f64,
    /// 10^6 rays per second, above 0.
    pub mrays_per_s: f64,
}

/// For which numbers of rays build and trace of one structure take less time than those of another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BreakEven {
    /// For every number of rays.
    Always,
    /// For more than so many 10^6 rays.
    From(f64),
    /// For less than so many 10^6 rays.
    Until(f64),
    /// For none.
    Never,
}

impl Cost {
    /// Milliseconds for 10^6 rays.
    fn ms_per_mray(self) -> f64 {
        1e3 / self.mrays_per_s
    }
}

/// When `a` is ahead of `b`.
pub fn break_even(a: Cost, b: Cost) -> BreakEven {
    let later = a.build_ms - b.build_ms;
    let saved = b.ms_per_mray() - a.ms_per_mray();
    match (later, saved) {
        (later, saved) if saved > 0.0 && later > 0.0 => BreakEven::From(later / saved),
        (later, saved) if saved < 0.0 && later < 0.0 => BreakEven::Until(later / saved),
        (later, saved) if saved >= 0.0 && later <= 0.0 && (saved, later) != (0.0, 0.0) => BreakEven::Always,
        _ => BreakEven::Never,
    }
}
