//! A frame is a list of passes, each with the label of its stage; a frame's time is also given stage by stage.

use serde::{Deserialize, Serialize};

/// Asked between submissions; true ends the work with [`crate::Error::Interrupted`].
pub type Interrupted<'a> = &'a dyn Fn() -> bool;

/// The label of passes whose times are added up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Stage(pub &'static str);

/// One dispatch of a frame.
#[derive(Clone, Copy, Debug)]
pub struct Pass<W> {
    /// Label.
    pub stage: Stage,
    /// The work of the pass, in the form that its device takes.
    pub work: W,
}

/// How the passes of a frame are handed to the driver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Submissions {
    /// One submission per pass. A driver's watchdog sees each pass alone, and an interruption is noticed between
    /// passes.
    PerPass,
    /// One submission for the whole frame. The host's work between short passes does not show in the device's times.
    PerFrame,
}

/// Passes that run one after another; each finds what those before it wrote.
#[derive(Clone, Debug)]
pub struct Frame<W> {
    /// In the order of execution.
    pub passes: Vec<Pass<W>>,
    /// How they are handed over.
    pub submissions: Submissions,
}

/// The time of one frame.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct FrameTime {
    /// Nanoseconds by the host's clock, from the previous frame's completion (or the start) to this one's.
    pub wall_ns: u64,
    /// Nanoseconds by the device's timestamps, from the begin of the first pass to the end of the last; `None` without
    /// timestamps.
    pub device_ns: Option<u64>,
    /// Nanoseconds of each of [`Frame::stages`] by the device's timestamps; empty without timestamps. Their sum lacks
    /// what lies between stages.
    pub stages: Vec<u64>,
}

/// The timestamps that a pass writes: indices into those of its frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct PassTimer {
    pub begin: Option<u32>,
    pub end: Option<u32>,
}

impl<W> Frame<W> {
    /// A frame whose passes are submitted one by one.
    pub fn new(passes: Vec<Pass<W>>) -> Frame<W> {
        Frame { passes, submissions: Submissions::PerPass }
    }

    /// The stages of the frame, each once, in the order of their first passes.
    pub fn stages(&self) -> Vec<Stage> {
        let mut stages = Vec::new();
        for pass in &self.passes {
            if !stages.contains(&pass.stage) {
                stages.push(pass.stage);
            }
        }
        stages
    }

    /// The stages of uninterrupted runs of passes of one stage. Each run has two timestamps.
    fn runs(&self) -> impl Iterator<Item = Stage> {
        self.passes.chunk_by(|a, b| a.stage == b.stage).map(|run| run[0].stage)
    }

    /// Timestamps of the frame.
    pub(super) fn timestamps(&self) -> usize {
        2 * self.runs().count()
    }

    /// Which timestamps each pass writes: a run's first pass at its begin, a run's last pass at its end.
    pub(super) fn timers(&self) -> Vec<PassTimer> {
        let mut timers = Vec::with_capacity(self.passes.len());
        for (index, run) in self.passes.chunk_by(|a, b| a.stage == b.stage).enumerate() {
            let first = timers.len();
            timers.resize(first + run.len(), PassTimer::default());
            timers[first].begin = Some(2 * index as u32);
            timers[first + run.len() - 1].end = Some(2 * index as u32 + 1);
        }
        timers
    }

    /// The frame's time from the ticks of its timestamps; without ticks only the host's clock counts.
    pub(super) fn time(&self, wall_ns: u64, ticks: &[u64], period_ns: f32) -> FrameTime {
        let (Some(first), Some(last)) = (ticks.first(), ticks.last()) else {
            return FrameTime { wall_ns, ..FrameTime::default() };
        };
        // A clock that runs backwards gives centuries; the harness then takes the time of the wall
        let span = |begin: u64, end: u64| (end.wrapping_sub(begin) as f64 * f64::from(period_ns)) as u64;
        let labels = self.stages();
        let mut stages = vec![0u64; labels.len()];
        for (stage, run) in self.runs().zip(ticks.chunks_exact(2)) {
            if let Some(index) = labels.iter().position(|&label| label == stage) {
                stages[index] = stages[index].saturating_add(span(run[0], run[1]));
            }
        }
        FrameTime { wall_ns, device_ns: Some(span(*first, *last)), stages }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(stages: &[&'static str]) -> Frame<()> {
        Frame::new(stages.iter().map(|&stage| Pass { stage: Stage(stage), work: () }).collect())
    }

    #[test]
    fn tiles_of_one_stage_are_timed_as_one() {
        let tiles = frame(&["render"; 3]);
        assert_eq!(tiles.timestamps(), 2);
        let timer = |begin, end| PassTimer { begin, end };
        assert_eq!(tiles.timers(), [timer(Some(0), None), timer(None, None), timer(None, Some(1))]);
        let time = tiles.time(100, &[10, 50], 2.0);
        assert_eq!(time, FrameTime { wall_ns: 100, device_ns: Some(80), stages: vec![80] });
    }

    #[test]
    fn passes_of_a_stage_are_added_up() {
        let frame = frame(&["sort", "scan", "sort"]);
        assert_eq!(frame.stages(), [Stage("sort"), Stage("scan")]);
        assert_eq!(frame.timestamps(), 6);
        assert!(frame.timers().iter().all(|timer| timer.begin.is_some() && timer.end.is_some()));
        let time = frame.time(100, &[0, 10, 12, 15, 20, 27], 1.0);
        assert_eq!((time.device_ns, time.stages), (Some(27), vec![17, 3]));
    }

    #[test]
    fn without_timestamps_there_is_the_wall_only() {
        let time = frame(&["render"]).time(7, &[], 1.0);
        assert_eq!(time, FrameTime { wall_ns: 7, device_ns: None, stages: Vec::new() });
    }

    #[test]
    fn a_clock_that_runs_backwards_is_not_hidden() {
        let time = frame(&["a", "b"]).time(7, &[10, 5, 5, 4], 1.0);
        assert!(time.device_ns > Some(1 << 60) && time.stages.iter().all(|&ns| ns > 1 << 60), "{time:?}");
    }
}
