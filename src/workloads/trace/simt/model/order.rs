//! The order of structures, and how sure it is.

use super::super::stream::{EVENTS, Event};
use super::super::sums::Sums;
use super::gpu::Gpu;
use super::weights::{EVENT_FACTOR, KernelFacts, Weights};
use crate::error::Result;
use crate::record::row::Status;
use crate::workloads::trace::Selection;
use crate::workloads::trace::rays::Config;
use crate::workloads::trace::record::ConfigurationRecord;

/// Structures whose work per resident warp differs by less are too close to be told apart.
pub const CLOSE: f64 = 1.15;

/// Draws of weights for the band.
const DRAWS: usize = 200;

/// What is known of a structure's row.
#[derive(Clone, Debug)]
pub struct Modelled {
    /// Name with its options.
    pub name: String,
    /// What warps issue in all frames, by ray type.
    pub sums: Vec<Sums>,
    /// Of its kernel.
    pub weights: Weights,
    /// Resident warps of a multiprocessor.
    pub warps: u32,
    /// Frames that were counted.
    pub frames: usize,
}

/// A structure in the order of a GPU.
#[derive(Clone, Debug, PartialEq)]
pub struct Ranked {
    /// Its place in what was given.
    pub index: usize,
    /// The least time of a frame, on average, in milliseconds.
    pub bound_ms: f64,
    /// Instructions over resident warps, as a multiple of the first one's.
    pub relative: f64,
    /// The same with 5 % and 95 % of all draws of weights within a factor of [`EVENT_FACTOR`].
    pub band: (f64, f64),
    /// True if it is too close to the first one of its place.
    pub close: bool,
}

impl Modelled {
    /// Counted frames on a GPU, by the weights of their kernel.
    ///
    /// # Errors
    /// Those of [`KernelFacts::of`].
    pub fn new(
        gpu: &Gpu,
        selection: &Selection,
        config: Config,
        (sums, frames): (Vec<Sums>, usize),
    ) -> Result<Modelled> {
        let KernelFacts { weights, workgroup_bytes } = KernelFacts::of(selection, config)?;
        let warps = gpu.resident_warps(selection, workgroup_bytes);
        Ok(Modelled { name: selection.full_name(), sums, weights, warps, frames: frames.max(1) })
    }

    /// What a recorded row counted, on a GPU; `None` where it has no result, or no warps of its width were counted.
    ///
    /// # Errors
    /// [`crate::Error::Input`] for a structure that this program does not have.
    pub fn of(record: &ConfigurationRecord, gpu: &Gpu) -> Result<Option<Modelled>> {
        let is_usable = record.status == Status::Ok && record.verified && record.warp_width == Some(gpu.warp_width);
        let Some(sums) = record.issued.filter(|_| is_usable) else { return Ok(None) };
        let selection = selection_of(record)?;
        Modelled::new(gpu, &selection, record.config, (sums.to_vec(), record.frames)).map(Some)
    }

    /// Instructions that warps issue for a frame, on average.
    pub fn instructions(&self) -> f64 {
        self.weights.instructions(&self.sums) / self.frames as f64
    }

    /// Instructions of a frame over resident warps, on average.
    pub fn work(&self) -> f64 {
        self.instructions() / f64::from(self.warps)
    }

    /// The same of all frames, by other weights.
    fn work_by(&self, weights: &Weights) -> f64 {
        weights.instructions(&self.sums) / f64::from(self.warps)
    }
}

/// The selection of a row.
///
/// # Errors
/// [`crate::Error::Input`] for a structure that this program does not have.
pub fn selection_of(record: &ConfigurationRecord) -> Result<Selection> {
    let ConfigurationRecord { structure, variant, .. } = record;
    Selection::parse(&if variant == "default" { structure.clone() } else { format!("{structure}:{variant}") })
}

/// Structures in the order of their work per resident warp, least first.
pub fn rank(gpu: &Gpu, rows: &[Modelled]) -> Vec<Ranked> {
    let works: Vec<f64> = rows.iter().map(|row| row.work_by(&row.weights)).collect();
    let mut order: Vec<usize> = (0..rows.len()).collect();
    order.sort_by(|&a, &b| works[a].total_cmp(&works[b]));
    let Some(&first) = order.first() else { return Vec::new() };
    let mut random = draws(1);
    let mut of_row: Vec<_> = rows.iter().map(|row| draws(seed(&row.name))).collect();
    // Of each row, its work as a multiple of the first one's, for each draw. A step is another one in each kernel;
    // what else there is, such as a triangle test, is alike in all of them, and is drawn together.
    let mut drawn: Vec<Vec<f64>> = vec![Vec::with_capacity(DRAWS); rows.len()];
    for _ in 0..DRAWS {
        let common: [f64; EVENTS.len() + 1] = std::array::from_fn(|_| random());
        let drawn_work = |(row, of_row): (&Modelled, &mut dyn FnMut() -> f64)| {
            let mut factors = common;
            factors[1 + Event::Step as usize] = of_row();
            row.work_by(&row.weights.scaled(&factors))
        };
        let works: Vec<f64> = rows.iter().zip(&mut of_row).map(|(row, draw)| drawn_work((row, draw))).collect();
        drawn.iter_mut().zip(&works).for_each(|(drawn, work)| drawn.push(work / works[first]));
    }
    // The first one of those that are too close to each other
    let mut front: Option<f64> = None;
    let ranked = order.into_iter().map(|index| {
        drawn[index].sort_by(f64::total_cmp);
        let close = front.is_some_and(|front| works[index] < front * CLOSE);
        if !close {
            front = Some(works[index]);
        }
        Ranked {
            index,
            bound_ms: gpu.issue_ms(rows[index].instructions()),
            relative: works[index] / works[first],
            band: (drawn[index][DRAWS / 20], drawn[index][DRAWS - 1 - DRAWS / 20]),
            close,
        }
    });
    ranked.collect()
}

/// A number that follows from a name (FNV-1a): a row's draws are its own, whatever other rows there are.
fn seed(name: &str) -> u32 {
    name.bytes().fold(0x811c_9dc5, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193))
}

/// Factors from 1 / [`EVENT_FACTOR`] to [`EVENT_FACTOR`], the same ones each time for a seed.
fn draws(seed: u32) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let share = f64::from(state >> 8) / f64::from(1_u32 << 24);
        EVENT_FACTOR.powf(2.0 * share - 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(name: &str, steps: u64, tests: u64, warps: u32) -> Modelled {
        let mut sums = Sums { warps: 100, ..Sums::default() };
        sums.issued[Event::Step as usize] = steps;
        sums.issued[Event::Test as usize] = tests;
        let weights = Weights::by_hand(10.0, &[(Event::Step, 20.0), (Event::Test, 60.0)]);
        Modelled { name: name.into(), sums: vec![sums], weights, warps, frames: 2 }
    }

    #[test]
    fn less_work_per_resident_warp_is_first() {
        let gpu = Gpu::load("gtx280").unwrap();
        let rows = [row("a", 1000, 1000, 8), row("b", 1000, 1000, 16), row("c", 1100, 1000, 16), row("d", 9000, 0, 8)];
        let ranked = rank(&gpu, &rows);
        assert_eq!(ranked.iter().map(|r| r.index).collect::<Vec<_>>(), [1, 2, 0, 3]);
        assert_eq!(ranked.iter().map(|r| r.close).collect::<Vec<_>>(), [false, true, false, false]);
        assert_eq!((ranked[0].relative, ranked[0].band), (1.0, (1.0, 1.0)));
        // The same sums with half of the warps: only what a step costs in each kernel matters
        assert!((ranked[2].relative - 2.0).abs() < 1e-12);
        let width = |ranked: &Ranked| ranked.band.1 / ranked.band.0;
        assert!(ranked[2].band.0 < 2.0 && ranked[2].band.1 > 2.0 && width(&ranked[2]) < width(&ranked[3]));
        // 81,000 instructions of two frames
        assert!((ranked[0].bound_ms - gpu.issue_ms(81_000.0) / 2.0).abs() < 1e-12);
        assert!(rank(&gpu, &[]).is_empty());
        // 10 % and 20 % behind the first one: the third is not too close to it
        let row = |name, steps| row(name, steps, 0, 16);
        let ranked = rank(&gpu, &[row("a", 10_000), row("b", 11_000), row("c", 12_000)]);
        assert_eq!(ranked.iter().map(|r| r.close).collect::<Vec<_>>(), [false, true, false]);
    }
}
