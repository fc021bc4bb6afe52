//! The thesis of 2010 on RT2: its published orders and percentages; tables, figures, claims and report from recorded
//! runs.

mod claims; // every claim in every verdict, by times and by steps
mod published; // every row parses; both readings of a percentage
mod recomputed; // tables 4.4 to 4.6 of a run, computed again from the text of its journal
mod rows; // which model, structure and run a row belongs to
mod show; // figures and report
mod synthetic; // runs of its scenes and structures
mod tables; // every table, published and measured, in every format
