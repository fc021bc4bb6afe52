//! Photon splatting: twins, kernels, references, and the workload.

mod catalogue; // the catalogue's radiometry against the files, mutated tables
mod clustered; // rows of techniques with clusters: every option, planted faults, overflows
mod clusters; // keys, their set, boxes and nodes: closed forms, loops, kernels, planted faults
mod device; // the bits of the twins from every kernel, structure and size; limits
mod frames; // scenes with light, frames on both devices, the comparison of all that frames make
mod light; // what --light says, mutated; lights and albedos of scenes
mod memory; // peak memory of frames against their buffers
mod proof; // photons and estimates against closed forms and against paths from the eye
mod rows; // requests, devices and rows
mod scan; // prefix sums of any length against a loop, totals at the limit
mod scenes; // the built-in scenes for light: closed, exact answers possible
mod shares; // how lights share paths
mod splat_kernels; // kernels through naga, struct layouts
mod splatting; // photons in lists and buckets against plain loops and on devices
mod support; // mutations of texts
mod twins; // one photon, one light and the generator against formulas
mod views; // frames with clusters, one after another
mod workload; // what is typed, planned, wrong, or cannot be
