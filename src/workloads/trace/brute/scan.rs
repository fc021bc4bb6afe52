//! Every triangle: ground truth. Twin of `kernels/trace/brute/scan.wgsl`.

use crate::math::Ray;
use crate::workloads::trace::algorithm::{Algorithm, Traversal};
use crate::workloads::trace::brute::{BUILDER, KIND};
use crate::workloads::trace::count::Count;
use crate::workloads::trace::options::GROUP;
use crate::workloads::trace::simt::{Event::Test, Lockstep, Part::One, repeat};
use crate::workloads::trace::traverse::{Best, TraverseIndependent, Triangles};

/// Brute force, the reference of all others.
pub static BRUTE: Algorithm = Algorithm {
    name: "brute",
    alias: "",
    summary: "no structure: every ray against every triangle (ground truth for small scenes)",
    paper: "",
    builder: &BUILDER,
    traversal: |_| &SCAN,
    options: &[GROUP],
};

/// Tests all triangles in a row.
pub static SCAN: Traversal = Traversal {
    kernel: "trace/brute/scan.wgsl",
    structure: &KIND,
    twin: Some(|input| Ok(input.with(Brute { triangles: input.triangles() }))),
    lockstep: Some(|_| LOCKSTEP),
    ..Traversal::INDEPENDENT
};

/// How its lanes wait for each other.
const LOCKSTEP: Lockstep = Lockstep::apart(&[repeat(&[One(Test)])]);

/// See the module.
pub struct Brute<'a> {
    /// All of them.
    pub triangles: Triangles<'a>,
}

impl TraverseIndependent for Brute<'_> {
    fn traverse<const ANY: bool, C: Count>(&self, ray: &Ray, limit: f32, count: &mut C) -> u32 {
        let mut best = Best::before(limit);
        self.triangles.test::<ANY, C>(ray, 0, self.triangles.triangle_refs.len() as u32, &mut best, count);
        best.triangle_ref
    }
}
