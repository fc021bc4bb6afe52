//! The sphere tracer: scenes and views, pictures of all renderers, their work, closed forms.

mod checks; // comparisons of pictures, fed with wrong ones
mod closed; // pictures of which a formula says what is to be seen
mod device; // the kernels' bits, work and layouts
mod lanes; // a broken lane is found
mod names; // mutated names of renderers and random scenes
mod orbit; // views over an orbit
mod pictures; // every CPU renderer makes the reference's bits
mod scenes; // scene files, their schema, names, the generator, mutations
mod support; // scenes by hand, views in double precision
mod work; // counters: the same rays and hits from every renderer, exits taken
mod workload; // what is typed, planned, refused and found wrong
