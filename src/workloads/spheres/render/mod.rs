//! Renderers on the CPU, and what their pictures are held to.
//!
//! Each kernel is one text with a [`probe::Probe`]: a silent one where a frame is timed, one that counts and plants
//! faults where it is watched. [`reference`](mod@reference) makes the same picture by plain code, [`exact`] in double
//! precision and [`half`] in half precision; [`compare`](mod@compare) tells pictures apart.

pub mod compare;
pub mod exact;
pub mod half;
pub mod levels;
mod mode;
mod probe;
pub mod reference;
mod sequential;
mod simd;
mod vector;

pub use levels::{best_level, levels};
pub use probe::{Exit, Fault, FaultKind};

use super::count::Counts;
use super::options::{Lanes, Options, Renderer};
use super::scene::PackedSphere;
use super::view::View;
use crate::error::{Error, Result};
use levels::Token;
use probe::{Probe, Silent, Watched};
use rayon::ThreadPool;
use rayon::prelude::*;

/// What all rows of a frame have in common.
struct Job<'a> {
    spheres: &'a [PackedSphere],
    view: &'a View,
    options: Options,
}

/// Whole rows of a frame, from `first_row` on.
struct Band<'a> {
    first_row: usize,
    image: &'a mut [[f32; 4]],
}

enum Pool<'p> {
    Device(&'p ThreadPool),
    Own(ThreadPool),
}

/// A renderer on the CPU, ready to render any number of frames.
pub struct CpuRenderer<'p> {
    options: Options,
    /// None: on the caller's thread.
    pool: Option<Pool<'p>>,
    /// None: scalar code.
    vectors: Option<(Lanes, Token)>,
    fault: Option<Fault>,
}

impl<'p> CpuRenderer<'p> {
    /// A renderer with threads takes `pool`, or starts a pool where it has its own number of threads.
    ///
    /// # Errors
    /// Refused: [`Renderer::Gpu`], and a level that this processor lacks. [`Error::Input`] if threads cannot be
    /// started.
    pub fn new(renderer: Renderer, options: Options, pool: &'p ThreadPool) -> Result<CpuRenderer<'p>> {
        let pool = |threads| match threads {
            0 => Ok(Pool::Device(pool)),
            _ => crate::threads::pool(threads).map(Pool::Own),
        };
        let (pool, vectors) = match renderer {
            Renderer::Sequential => (None, None),
            Renderer::Threads(threads) => (Some(pool(threads)?), None),
            Renderer::Simd(lanes, level) => (None, Some((lanes, levels::token(level)?))),
            Renderer::SimdThreads(lanes, level, threads) => {
                let token = levels::token(level)?;
                (Some(pool(threads)?), Some((lanes, token)))
            }
            Renderer::Gpu => return Err(Error::unsupported("renderer gpu does not run on the CPU")),
        };
        Ok(CpuRenderer { options, pool, vectors, fault: None })
    }

    /// What the code runs on: the processor's architecture and what scalar code was compiled for, `x86_64 sse2`, or the
    /// level of SIMD, `avx512`.
    pub fn instructions(&self) -> String {
        match self.vectors {
            Some((_, token)) => token.level().name().to_owned(),
            None => levels::compiled(),
        }
    }

    /// Threads that render.
    pub fn threads(&self) -> usize {
        match &self.pool {
            Some(Pool::Device(pool)) => pool.current_num_threads(),
            Some(Pool::Own(pool)) => pool.current_num_threads(),
            None => 1,
        }
    }

    /// Plants a mistake, for tests: from now on both [`render`](Self::render) and [`count`](Self::count) are watched.
    pub fn with_fault(self, fault: Fault) -> Self {
        CpuRenderer { fault: Some(fault), ..self }
    }

    /// Renders a frame into `image`, rows from the top, as many pixels as `view` has.
    pub fn render(&self, spheres: &[PackedSphere], view: &View, image: &mut [[f32; 4]]) {
        if self.fault.is_some() {
            self.count(spheres, view, image, &mut vec![0; image.len()]);
            return;
        }
        let job = Job { spheres, view, options: self.options };
        let rows = |(row, image)| self.band(&job, Band { first_row: row, image }, &mut Silent);
        match self.threads_of() {
            Some(pool) => pool.install(|| image.par_chunks_mut(row_length(view)).enumerate().for_each(rows)),
            None => rows((0, image)),
        }
    }

    /// The same picture by the counting variant. `hits`, one for each pixel, becomes the number of live hits of its
    /// path.
    pub fn count(&self, spheres: &[PackedSphere], view: &View, image: &mut [[f32; 4]], hits: &mut [u32]) -> Counts {
        let job = Job { spheres, view, options: self.options };
        let none = || Counts::new(view.trips as usize);
        let rows = |(row, (image, hits))| {
            let mut probe = Watched { counts: none(), hits, fault: self.fault };
            self.band(&job, Band { first_row: row, image }, &mut probe);
            probe.counts
        };
        let add = |mut sum: Counts, more: Counts| {
            sum += &more;
            sum
        };
        let length = row_length(view);
        match self.threads_of() {
            Some(pool) => pool.install(|| {
                let hits = hits.par_chunks_mut(length);
                image.par_chunks_mut(length).zip(hits).enumerate().map(rows).reduce(none, add)
            }),
            None => rows((0, (image, hits))),
        }
    }

    fn threads_of(&self) -> Option<&ThreadPool> {
        match self.pool.as_ref()? {
            Pool::Device(pool) => Some(pool),
            Pool::Own(pool) => Some(pool),
        }
    }

    fn band<P: Probe>(&self, job: &Job, band: Band, probe: &mut P) {
        match self.vectors {
            None => sequential::rows(job, band, probe),
            Some((lanes, token)) => token.rows(lanes, job, band, probe),
        }
    }
}

fn row_length(view: &View) -> usize {
    (view.width as usize).max(1)
}
