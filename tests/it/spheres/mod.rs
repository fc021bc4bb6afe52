//! The sphere tracer.

mod device; // the kernels' bits, work and layouts
mod orbit; // views over an orbit
mod scenes; // scene files, their schema, names, the generator, mutations
