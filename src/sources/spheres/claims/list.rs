//! The claims, in the order in which docs/spheres.md lists them.

use super::{Asked, cases, pictures};
use crate::sources::claims::{Basis, Case};
use crate::sources::spheres::setting::Renderer;

/// Which devices a claim is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum About {
    /// Renderers on the processor.
    Cpu,
    /// The GPU.
    Gpu,
    /// All renderers; most of them on the processor.
    Both,
}

/// A claim, and how its cases are found.
pub struct Claim {
    /// The claim's number; a letter where it has two halves.
    pub id: &'static str,
    /// The claim itself.
    pub statement: &'static str,
    /// What has to be measured.
    pub needs: &'static str,
    /// What it is judged by.
    pub basis: Basis,
    /// Whose times.
    pub about: About,
    /// Its cases.
    pub cases: fn(&Asked) -> Vec<Case>,
    /// Renderers whose failed measurements are named.
    pub renderers: &'static [Renderer],
    /// What is not judged, with the reason.
    pub left_out: fn(&Asked) -> Vec<String>,
    /// A warning about its cases.
    pub remark: &'static str,
}

/// What most claims have in common.
const CLAIM: Claim = Claim {
    id: "",
    statement: "",
    needs: "",
    basis: Basis::FrameTimes,
    about: About::Cpu,
    cases: |_| Vec::new(),
    renderers: &SIMD,
    left_out: |_| Vec::new(),
    remark: "",
};

const SIMD: [Renderer; 2] = [Renderer::Sequential, Renderer::Simd];

/// Said of every claim that compares SIMD with another renderer.
const STRUCTURE: &str = "In the paper's structure: 4 lanes, the hit stored in the loop.";

/// A claim without processors of the GPU leaves it out.
fn gpu_without_processors(asked: &Asked) -> Vec<String> {
    let has_gpu = asked.view.rows().any(|m| m.setting.renderer == Renderer::Gpu);
    let is_left_out = has_gpu && asked.gpu_processors.is_none();
    is_left_out.then(|| "The GPU's is not judged: --processors N says how many it has".to_owned()).into_iter().collect()
}

/// All claims.
pub const CLAIMS: [Claim; 14] = [
    Claim {
        id: "1",
        statement: "Two-pass: SIMD alone is slower than sequential, about 3 times",
        needs: "sequential and simd:lanes=4, two-pass without exits, hit=in-loop",
        cases: cases::slow_at_first,
        remark: STRUCTURE,
        ..CLAIM
    },
    Claim {
        id: "2",
        statement: "Threads are not what is wrong: alone they gain at least half of their number",
        needs: "sequential and threads with at least two threads, two-pass without exits, hit=in-loop",
        cases: cases::threads_work,
        renderers: &[Renderer::Sequential, Renderer::Threads],
        ..CLAIM
    },
    Claim {
        id: "3",
        statement: "One pass with its exit is faster than two passes in every renderer, and SIMD gains most",
        needs: "each renderer, two-pass without exits and one-pass with the exit on a miss, hit=in-loop",
        about: About::Both,
        cases: cases::one_pass_is_faster,
        renderers: &Renderer::ALL,
        ..CLAIM
    },
    Claim {
        id: "4",
        statement: "Most of what one pass gained is the exit on a miss",
        needs: "two-pass and one-pass, each with and without the exit on a miss, hit=in-loop, no skips",
        cases: cases::the_exit_is_most,
        renderers: &Renderer::CPU,
        remark: "The paper says it as a conjecture: it changed both together. Agrees if the exit gains more than the \
                 algorithm whichever of the two is changed first.",
        ..CLAIM
    },
    Claim {
        id: "5",
        statement: "At equal exits SIMD gains from one pass, and more than sequential does (arrays spill registers)",
        needs: "sequential and simd:lanes=4, two-pass and one-pass at equal exits, hit=in-loop, no skips",
        cases: cases::one_pass_alone,
        remark: "The paper says it as a conjecture.",
        ..CLAIM
    },
    Claim {
        id: "6",
        statement: "One-pass without the skips: SIMD alone is still slower than sequential",
        needs: "sequential and simd:lanes=4, one-pass with the exit on a miss, hit=in-loop, no skips",
        cases: cases::still_slow,
        remark: STRUCTURE,
        ..CLAIM
    },
    Claim {
        id: "7",
        statement: "The two skips make SIMD faster, alone and with threads (1.9 to 2.6 times)",
        needs: "simd or simd-threads, lanes=4, one-pass with the exit on a miss, with and without both skips, \
                hit=in-loop",
        cases: cases::exits_help,
        renderers: &[Renderer::Simd, Renderer::SimdThreads],
        remark: STRUCTURE,
        ..CLAIM
    },
    Claim {
        id: "8",
        statement: "With the skips SIMD alone is faster than sequential (1.2 to 1.5 times)",
        needs: "sequential and simd:lanes=4 with both skips, one-pass with the exit on a miss, hit=in-loop",
        cases: cases::fast_at_last,
        remark: STRUCTURE,
        ..CLAIM
    },
    Claim {
        id: "9",
        statement: "From the first to the last version SIMD alone became up to 15 times as fast",
        needs: "simd:lanes=4, first and last version, on default, random20 and random100",
        cases: cases::first_to_last,
        renderers: &[Renderer::Simd],
        remark: "Judged by the greatest gain of the three scenes: more than 15 times, with the margin.",
        ..CLAIM
    },
    Claim {
        id: "10a",
        statement: "Half precision makes SIMD twice as fast",
        needs: "a device with arithmetic of half precision, precision f16 and f32; emulated arithmetic has no speed \
                worth a number",
        about: About::Gpu,
        cases: pictures::speed,
        renderers: &[],
        left_out: pictures::converted,
        remark: "Taken for twice: at least 1.6 times. No processor here computes in half precision: a GPU's rows are \
                 judged.",
        ..CLAIM
    },
    Claim {
        id: "10b",
        statement: "Half precision spoils the picture",
        needs: "rows of precision f16",
        basis: Basis::Pictures,
        cases: pictures::spoilt,
        renderers: &[],
        remark: "The paper shows a picture and no number. Unusable begins here below 30 dB of peak signal to noise, an \
                 RMSE of 0.032 of 1, in linear RGB.",
        ..CLAIM
    },
    Claim {
        id: "11",
        statement: "The GPU is the fastest everywhere, with 100 spheres about 1000 times as fast as sequential",
        needs: "gpu and sequential in the three versions",
        about: About::Gpu,
        cases: cases::gpu_is_fastest,
        renderers: &Renderer::ALL,
        remark: "Taken for about 1000: at least 500 times.",
        ..CLAIM
    },
    Claim {
        id: "12",
        statement: "The GPU's Karp-Flatt metric is below that of SIMD with threads, which falls from the first version \
                    to the last",
        needs: "sequential and simd-threads:lanes=4 in the first and the last version; for the GPU --processors N",
        about: About::Both,
        cases: cases::serial_shares,
        renderers: &[Renderer::Sequential, Renderer::SimdThreads, Renderer::Gpu],
        left_out: gpu_without_processors,
        remark: "By the formula, not by the printed values, which do not follow from it. The metric is a serial share \
                 for equal processors only; lanes and a GPU's units are not.",
        ..CLAIM
    },
    Claim {
        id: "13",
        statement: "Vectors hardly pay: SIMD alone stays below half of its lanes",
        needs: "sequential and simd with both skips, one-pass with the exit on a miss, hit=in-loop",
        cases: cases::vectors_hardly_pay,
        remark: "In the paper's structure, and in the fastest setting that was measured.",
        ..CLAIM
    },
];
