//! Progress of a sweep on standard error: a bar on a terminal, plain lines elsewhere.

use super::output;
use crate::harness::sweep::Event;
use crate::record::schema::{ConfigurationRecord, Status};
use crate::record::summary;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// How far a sweep is: planned work in rays, and rows.
pub struct Progress {
    /// `None` where standard error is no terminal.
    bar: Option<ProgressBar>,
    quiet: bool,
    rows: usize,
    finished: usize,
    work: u64,
    done: u64,
    /// Work behind us when the last row was finished, and when that was.
    last: (u64, Instant),
    /// Seconds per unit of work, lately.
    pace: Option<f64>,
}

impl Progress {
    /// For `rows` configurations that trace about `work` rays.
    pub fn new(rows: usize, work: u64, quiet: bool) -> Progress {
        let bar = (!quiet && std::io::stderr().is_terminal()).then(|| {
            let bar = ProgressBar::with_draw_target(Some(work.max(1)), ProgressDrawTarget::stderr());
            // The template is a constant; a typing error in it would show in every run.
            let style = ProgressStyle::with_template("{bar:24} {msg}").unwrap_or_else(|_| ProgressStyle::default_bar());
            bar.set_style(style);
            bar.enable_steady_tick(Duration::from_millis(500));
            bar
        });
        Progress { bar, quiet, rows, finished: 0, work, done: 0, last: (0, Instant::now()), pace: None }
    }

    /// Takes note of an event.
    pub fn event(&mut self, event: Event) {
        match event {
            Event::Work(work) => {
                self.done = (self.done + work).min(self.work);
                if let Some(bar) = &self.bar {
                    bar.set_position(self.done);
                }
            }
            Event::Doing(what) => {
                if let Some(bar) = &self.bar {
                    bar.set_message(format!("{}/{}{} {what}", self.finished, self.rows, self.estimate()));
                }
            }
            Event::Building(what) => match &self.bar {
                Some(_) => self.event(Event::Doing(what)),
                None if self.quiet => {}
                None => line(None, &what),
            },
            Event::Built(_) => {}
            Event::Finished(record) => self.finished(record),
            Event::Kept(work) => {
                self.finished += 1;
                self.done = (self.done + work).min(self.work);
                self.last = (self.done, Instant::now());
            }
            Event::Note(text) => line(self.bar.as_ref(), &text),
        }
    }

    /// What prints lines that stay, as this does, on other threads as well; nothing if it is to be quiet.
    pub fn teller(&self) -> impl Fn(&str) + Send + use<> {
        let (bar, quiet) = (self.bar.clone(), self.quiet);
        move |text| {
            if !quiet {
                line(bar.as_ref(), text);
            }
        }
    }

    fn finished(&mut self, record: &ConfigurationRecord) {
        self.finished += 1;
        let (before, since) = self.last;
        let seconds = since.elapsed().as_secs_f64();
        let work = self.done.saturating_sub(before);
        if work > 0 {
            // Half the weight for the newest row: structures differ much, a single one must not rule the estimate.
            let newest = seconds / work as f64;
            self.pace = Some(self.pace.map_or(newest, |pace| 0.5 * (pace + newest)));
        }
        self.last = (self.done, Instant::now());
        let variant = if record.variant == "default" { String::new() } else { format!(":{}", record.variant) };
        let what = format!(
            "{} {}{variant} {:?} {}x{}",
            record.scene.name, record.structure, record.config, record.width, record.height
        );
        if record.status == Status::Error {
            line(self.bar.as_ref(), &format!("{}/{} {what}: ERROR: {}", self.finished, self.rows, record.message));
        } else if self.bar.is_none() && !self.quiet {
            let mean = summary::frame_statistics(record).map_or(0.0, |s| s.mean_ms);
            line(
                self.bar.as_ref(),
                &format!("{}/{} {what}: {mean:.2} ms{}", self.finished, self.rows, self.estimate()),
            );
        }
    }

    /// The time that is left, in words.
    fn estimate(&self) -> String {
        let Some(pace) = self.pace.filter(|_| self.finished < self.rows) else { return String::new() };
        let seconds = (pace * self.work.saturating_sub(self.done) as f64).round() as u64;
        match seconds {
            0..90 => format!(", about {seconds} s left"),
            90..5400 => format!(", about {} min left", (seconds + 30) / 60),
            _ => format!(", about {:.1} h left", seconds as f64 / 3600.0),
        }
    }

    /// Takes the bar away.
    pub fn end(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// Says that a structure is being built: a clock that runs on a terminal, a line elsewhere. It ends when this is dropped.
pub struct Building(Option<ProgressBar>);

impl Building {
    /// `what` is being built from now on.
    pub fn begin(what: &str) -> Building {
        let what = format!("building {what}");
        if !std::io::stderr().is_terminal() {
            line(None, &what);
            return Building(None);
        }
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
        let style =
            ProgressStyle::with_template("{msg} {elapsed}").unwrap_or_else(|_| ProgressStyle::default_spinner());
        bar.set_style(style);
        bar.set_message(what);
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

/// A line that stays, above the bar if there is one.
fn line(bar: Option<&ProgressBar>, text: &str) {
    match bar {
        Some(bar) => bar.println(format!("rtbench: {text}")),
        None => output::note(text),
    }
}
