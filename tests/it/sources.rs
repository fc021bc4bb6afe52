//! Sources: documents with published numbers, and their tables, figures and claims from recorded runs.

mod rt2; // the thesis of 2010 on RT2
mod select; // sources, tables and devices by name
mod spheres; // the term paper on spheres
mod splat; // the thesis on photon splatting
mod structures; // the structures of today
mod synthetic; // runs with known content
mod thesis; // the thesis of 2009
