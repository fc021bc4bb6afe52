//! Ray queries of the device: `kernels/trace/query/driver.wgsl`. What a driver does is not known, so there is no twin
//! and nothing is counted but rays.

use crate::device::{Feature, Features};
use crate::workloads::trace::algorithm::{Agreement, Algorithm, Traversal};
use crate::workloads::trace::options::GROUP;
use crate::workloads::trace::query::{BUILDER, KIND};

/// The driver's structure and its traversal.
pub static QUERY: Algorithm = Algorithm {
    name: "query",
    alias: "",
    summary: "the driver's own structure by ray queries, of triangles sorted as in the leaves of bvh",
    paper: "",
    builder: &BUILDER,
    traversal: |_| &DRIVER,
    options: &[GROUP],
};

/// A ray query of each ray.
pub static DRIVER: Traversal = Traversal {
    kernel: "trace/query/driver.wgsl",
    structure: &KIND,
    needs: Features::of(&[Feature::RayQuery]),
    agreement: Agreement::HitsOnly,
    ..Traversal::INDEPENDENT
};
