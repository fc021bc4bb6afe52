//! How a picture is made: renderers, and the switches whose effects are told apart.

/// Most rays along a path that can be asked for.
pub const MAX_TRIPS: u32 = 64;

/// Who renders.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Renderer {
    /// One thread, one pixel at a time.
    Sequential,
    /// Rows of the image over a pool of threads; 0 for the device's number of threads.
    Threads(usize),
    /// One thread, several pixels of a row at once.
    Simd(Lanes, Option<Level>),
    /// The same, rows over a pool of threads.
    SimdThreads(Lanes, Option<Level>, usize),
    /// One invocation of a kernel per pixel.
    Gpu,
}

/// Pixels at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Lanes {
    /// 4.
    Four,
    /// 8.
    Eight,
    /// 16.
    Sixteen,
}

/// Instruction sets, the least first. Which of them a processor has is asked at run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Level {
    /// x86-64's baseline, 128 bits.
    Sse2,
    /// 256 bits.
    Avx2,
    /// 512 bits, Ice Lake's.
    Avx512,
    /// AArch64's baseline, 128 bits.
    Neon,
}

/// Order of the work along a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Algorithm {
    /// All hits of a path into arrays, then colours from the last one to the first.
    TwoPass,
    /// Colours on the way, scaled by the product of what the surfaces so far reflect.
    OnePass,
}

/// What the loop over the spheres keeps of the nearest hit so far.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum HitRecord {
    /// Position, normal, distance and colour, written at each nearer hit.
    InLoop,
    /// Distance and the sphere's index; the rest follows after the loop.
    Index,
}

/// Arithmetic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Precision {
    /// Single precision.
    F32,
    /// Half precision.
    F16,
}

/// The switches. Those that a renderer does not have are off, and `hit` is [`HitRecord::Index`] there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Options {
    /// Order of the work along a path.
    pub algorithm: Algorithm,
    /// End a path (SIMD: a vector of paths, when no lane hits) at its first miss; otherwise all trips are searched.
    pub exit_on_miss: bool,
    /// SIMD only: in the loop over the spheres, nothing is stored where no lane has a nearer hit.
    pub skip_no_hit: bool,
    /// SIMD only: no square root and no division where no lane's discriminant is positive.
    pub skip_no_discriminant: bool,
    /// CPU renderers only: what the loop keeps.
    pub hit: HitRecord,
}

impl Lanes {
    /// The number of pixels.
    pub fn count(self) -> usize {
        match self {
            Lanes::Four => 4,
            Lanes::Eight => 8,
            Lanes::Sixteen => 16,
        }
    }
}
