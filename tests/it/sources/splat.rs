//! The thesis on photon splatting: its published numbers; tables, figures, claims and report from recorded runs.

mod claims; // every claim in every verdict
mod published; // every row parses; what follows from the printed numbers
mod recomputed; // tables of the committed run, computed again from the text of its journal
mod rows; // which rows are compared, shown and named
mod show; // figures, report, and tables in every format
mod synthetic; // runs of its techniques and options
