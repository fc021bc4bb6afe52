//! The term paper on spheres: its published times and metrics; tables, figures, claims and report from recorded runs.

mod claims; // every claim in every verdict
mod published; // every row parses; what follows from the printed times, and what does not
mod recomputed; // tables, metrics and verdicts of a run, computed again from the text of its journal
mod runs; // which source, machine, scene and setting a row belongs to
mod show; // figures, report, and tables in every format
mod synthetic; // runs of its scenes and settings
