//! The sphere tracer.

mod orbit; // views over an orbit
mod scenes; // scene files, their schema, names, the generator, mutations
