//! The thesis: its published numbers; tables, figures, claims and report from recorded runs.

mod apart; // published and measured numbers, build times of unlike builders
mod claims; // every claim in every verdict, also where it is false
mod command; // the program: broken and empty runs, files, splicing
mod committed; // the runs in git, and what the README shows of them
mod counts; // grid steps and tests along BART's cameras
mod empty; // tables without a measurement, devices and sizes that were chosen
mod figures; // XML, what is drawn and what is not
mod judging; // exceptions, margins, and what is not judged
mod latex; // what a longtable has to have
mod modelled; // claims and the table by the SIMT model
mod published; // every row parses; the memory model against all 27 sizes
mod report; // one page, nothing from outside, everything escaped
mod runs; // which scene, device, variant and conditions a record belongs to
mod synthetic; // runs of its scenes and structures
mod tables; // every table, published and measured, in every format
