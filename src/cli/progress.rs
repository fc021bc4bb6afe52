//! Progress on standard error: a bar on a terminal, lines elsewhere.

use super::output;
use crate::harness::summary;
use crate::harness::workload::{Event, Workload};
use crate::record::row::{Row, Status};
use crate::record::statistics;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// The progress of a sweep, in rays and in rows.
pub struct Progress {
    workload: &'static dyn Workload,
    /// `None` where standard error is no terminal.
    bar: Option<ProgressBar>,
    quiet: bool,
    rows: usize,
    finished: usize,
    work: u64,
    done: u64,
    /// Message of the last row without a result: many cases may lack the same input.
    message: String,
    /// Work done when the last row was finished, and the time of that.
    last: (u64, Instant),
    /// Moving average of seconds per unit of work.
    pace: Option<f64>,
}

impl Progress {
    /// For `rows` cases of a workload with about so much work.
    pub fn new(workload: &'static dyn Workload, rows: usize, work: u64, quiet: bool) -> Progress {
        let bar = (!quiet && std::io::stderr().is_terminal()).then(|| {
            let bar = ProgressBar::with_draw_target(Some(work.max(1)), ProgressDrawTarget::stderr());
            // The template is a constant: an error in it would show in every run.
            let style = ProgressStyle::with_template("{bar:24} {msg}").unwrap_or_else(|_| ProgressStyle::default_bar());
            bar.set_style(style);
            bar.enable_steady_tick(Duration::from_millis(500));
            bar
        });
        Progress {
            workload,
            bar,
            quiet,
            rows,
            finished: 0,
            work,
            done: 0,
            message: String::new(),
            last: (0, Instant::now()),
            pace: None,
        }
    }

    /// Updates the display after an event of the sweep.
    pub fn event(&mut self, event: Event) {
        match event {
            Event::Work(work) => {
                self.done = (self.done + work).min(self.work);
                if let Some(bar) = &self.bar {
                    bar.set_position(self.done);
                }
            }
            Event::Doing(task) => {
                if let Some(bar) = &self.bar {
                    bar.set_message(format!("{}/{}{} {task}", self.finished, self.rows, self.estimate()));
                }
            }
            Event::Building(task) => match &self.bar {
                Some(_) => self.event(Event::Doing(task)),
                None if self.quiet => {}
                None => line(None, &task),
            },
            Event::Finished(row) => self.finished(row),
            Event::Kept(work) => {
                self.finished += 1;
                self.done = (self.done + work).min(self.work);
                self.last = (self.done, Instant::now());
            }
            Event::Note(text) => line(self.bar.as_ref(), &text),
        }
    }

    /// What prints lines that stay, as this does, on other threads as well; nothing if it is to be quiet.
    pub fn line_printer(&self) -> impl Fn(&str) + Send + use<> {
        let (bar, quiet) = (self.bar.clone(), self.quiet);
        move |text| {
            if !quiet {
                line(bar.as_ref(), text);
            }
        }
    }

    fn finished(&mut self, row: &Row) {
        self.finished += 1;
        let (before, since) = self.last;
        let seconds = since.elapsed().as_secs_f64();
        let work = self.done.saturating_sub(before);
        if work > 0 {
            // The newest row has half the weight: structures differ much in speed, and one must not decide the
            // estimate.
            let newest = seconds / work as f64;
            self.pace = Some(self.pace.map_or(newest, |pace| 0.5 * (pace + newest)));
        }
        self.last = (self.done, Instant::now());
        let what = summary::label(self.workload, row);
        let message = std::mem::replace(&mut self.message, row.message.clone());
        let place = format!("{}/{} {what}", self.finished, self.rows);
        match row.status {
            Status::Ok if self.quiet || self.bar.is_some() => {}
            Status::Ok => {
                let mean = row.timed().and_then(statistics::frames).map_or(0.0, |frames| frames.mean_ms);
                line(None, &format!("{place}: {mean:.2} ms{}", self.estimate()));
            }
            Status::Skipped if self.quiet => {}
            Status::Skipped | Status::Failed if row.message == message => {}
            Status::Skipped => line(self.bar.as_ref(), &format!("{place}: skipped: {}", row.message)),
            Status::Wrong => line(self.bar.as_ref(), &format!("{place}: WRONG: {}", row.message)),
            Status::Failed => line(self.bar.as_ref(), &format!("{place}: FAILED: {}", row.message)),
        }
    }

    /// The estimated remaining time as text; empty if it is unknown.
    fn estimate(&self) -> String {
        let Some(pace) = self.pace.filter(|_| self.finished < self.rows) else { return String::new() };
        let seconds = (pace * self.work.saturating_sub(self.done) as f64).round() as u64;
        match seconds {
            0..90 => format!(", about {seconds} s left"),
            90..5400 => format!(", about {} min left", (seconds + 30) / 60),
            _ => format!(", about {:.1} h left", seconds as f64 / 3600.0),
        }
    }

    /// Removes the bar from the terminal.
    pub fn end(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// Shows that a structure is being built: an elapsed-time display on a terminal, a line elsewhere. Dropping it ends the
/// display.
pub struct Building(Option<ProgressBar>);

impl Building {
    /// Shows `structure` as being built until this is dropped.
    pub fn begin(structure: &str) -> Building {
        let task = format!("building {structure}");
        if !std::io::stderr().is_terminal() {
            line(None, &task);
            return Building(None);
        }
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
        let style =
            ProgressStyle::with_template("{msg} {elapsed}").unwrap_or_else(|_| ProgressStyle::default_spinner());
        bar.set_style(style);
        bar.set_message(task);
        bar.enable_steady_tick(Duration::from_millis(500));
        Building(Some(bar))
    }
}

impl Drop for Building {
    fn drop(&mut self) {
        if let Some(bar) = &self.0 {
            bar.finish_and_clear();
        }
    }
}

/// Prints a permanent line, above the bar if there is one.
fn line(bar: Option<&ProgressBar>, text: &str) {
    match bar {
        Some(bar) => bar.println(format!("rtbench: {text}")),
        None => output::note(text),
    }
}
