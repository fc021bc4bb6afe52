//! Sources: documents with published numbers, and their tables, figures and claims from recorded runs.

mod select; // sources, tables and devices by name
mod synthetic; // runs with known content
mod thesis; // the thesis of 2009
