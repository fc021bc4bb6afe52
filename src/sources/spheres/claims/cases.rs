//! Cases from frame times, of measured and of printed ones by the same functions.

use super::{Asked, case};
use crate::compare::judge::{Outcome, Uncertain, all, less, less_by};
use crate::report::Form;
use crate::sources::claims::Case;
use crate::sources::spheres::metrics::{less_serial, quotient};
use crate::sources::spheres::scenes::{Role, SceneKey};
use crate::sources::spheres::setting::{Algorithm, Renderer, Stage, Version};
use crate::sources::spheres::tables::fastest;

/// The first version with the exit on a miss alone.
const TWO_PASS_WITH_EXIT: Version = Version { exit_on_miss: true, ..Stage::TwoPass.version() };

/// One pass without any exit.
const ONE_PASS_WITHOUT_EXIT: Version = Version { algorithm: Algorithm::OnePass, ..Stage::TwoPass.version() };

/// "About 1000 times" is taken for at least so many.
pub const ABOUT_A_THOUSAND: f64 = 500.0;

/// "Up to 15 times".
pub const UP_TO: f64 = 15.0;

fn ms(time: Uncertain) -> String {
    Form::Time.write(time.value)
}

/// Two times and their quotient: `SIMD 5918, sequential 1852 ms: 3.20 times`.
fn two((a, of_a): (&str, Uncertain), (b, of_b): (&str, Uncertain)) -> String {
    format!("{a} {}, {b} {} ms: {:.2} times", ms(of_a), ms(of_b), of_a.value / of_b.value)
}

/// A case for each scene that has one.
fn scenes(asked: &Asked, of: impl Fn(&SceneKey) -> Option<Case>) -> Vec<Case> {
    asked.scenes().iter().filter_map(of).collect()
}

/// SIMD alone against sequential in a version; `slower` is the claim.
fn simd_alone(asked: &Asked, stage: Stage, slower: bool) -> Vec<Case> {
    scenes(asked, |scene| {
        let simd = asked.stage(scene, Renderer::Simd, stage)?;
        let sequential = asked.stage(scene, Renderer::Sequential, stage)?;
        let outcome = if slower { less(sequential, simd) } else { less(simd, sequential) };
        let numbers = match slower {
            true => two(("SIMD", simd), ("sequential", sequential)),
            false => two(("sequential", sequential), ("SIMD", simd)),
        };
        Some(case(scene, "", outcome, numbers))
    })
}

/// Claim 1.
pub fn slow_at_first(asked: &Asked) -> Vec<Case> {
    simd_alone(asked, Stage::TwoPass, true)
}

/// Claim 2: speed-up of at least half the number of threads. One thread says nothing.
pub fn threads_work(asked: &Asked) -> Vec<Case> {
    scenes(asked, |scene| {
        let stage = Stage::TwoPass;
        let row = asked.row(scene, Renderer::Threads, stage.version())?;
        let sequential = asked.stage(scene, Renderer::Sequential, stage)?;
        let threads = asked.processors(row).filter(|threads| *threads > 1.0)?;
        let outcome = less_by(row.time(), sequential, threads / 2.0);
        let gain = sequential.value / row.mean_ms;
        Some(case(scene, "", outcome, format!("{gain:.2} times with {threads:.0} threads")))
    })
}

/// Gain of a renderer from one version to another, as the quotient of the earlier to the later time.
fn gain(asked: &Asked, scene: &SceneKey, renderer: Renderer, (from, to): (Version, Version)) -> Option<Uncertain> {
    Some(quotient(asked.time(scene, renderer, from)?, asked.time(scene, renderer, to)?))
}

/// Claim 3: every renderer is faster in one pass, and SIMD gains most.
pub fn one_pass_is_faster(asked: &Asked) -> Vec<Case> {
    let change = (Stage::TwoPass.version(), Stage::OnePass.version());
    let mut cases = Vec::new();
    for scene in asked.scenes() {
        for renderer in Renderer::ALL {
            let times = change.0;
            let both = asked.time(&scene, renderer, times).zip(asked.time(&scene, renderer, change.1));
            let Some((first, then)) = both else { continue };
            let numbers = two(("two-pass", first), ("one-pass", then));
            cases.push(case(&scene, renderer.title(), less(then, first), numbers));
        }
        let of = |renderer| gain(asked, &scene, renderer, change);
        let others = [Renderer::Sequential, Renderer::Threads, Renderer::Gpu].into_iter().filter_map(of);
        let others: Vec<Uncertain> = others.collect();
        let Some(simd) = of(Renderer::Simd).or_else(|| of(Renderer::SimdThreads)) else { continue };
        if let Some(most) = others.iter().max_by(|a, b| a.value.total_cmp(&b.value)) {
            let outcome = all(others.iter().map(|other| less(*other, simd)));
            let numbers = format!("SIMD {:.2} times, the others at most {:.2}", simd.value, most.value);
            cases.push(case(&scene, "SIMD most", outcome, numbers));
        }
    }
    cases
}

/// Claim 4: the exit's part of the gain is larger than that of the algorithm, in either order of the two changes.
pub fn the_exit_is_most(asked: &Asked) -> Vec<Case> {
    let mut cases = Vec::new();
    for scene in asked.scenes() {
        for renderer in Renderer::CPU {
            let time = |version| asked.time(&scene, renderer, version);
            let all_times = time(Stage::TwoPass.version())
                .zip(time(Stage::OnePass.version()))
                .zip(time(TWO_PASS_WITH_EXIT).zip(time(ONE_PASS_WITHOUT_EXIT)));
            let Some(((first, last), (with_exit, one_pass))) = all_times else { continue };
            let (exit_first, then_pass) = (quotient(first, with_exit), quotient(with_exit, last));
            let (pass_first, then_exit) = (quotient(first, one_pass), quotient(one_pass, last));
            // Of no gain there is no part
            let outcome = match less(last, first) {
                Outcome::Agrees => all([less(then_pass, exit_first), less(pass_first, then_exit)]),
                _ => Outcome::Undecided,
            };
            let numbers = format!(
                "exit {:.2} and {:.2} times, one pass {:.2} and {:.2} times, together {:.2}",
                exit_first.value,
                then_exit.value,
                then_pass.value,
                pass_first.value,
                first.value / last.value
            );
            cases.push(case(&scene, renderer.title(), outcome, numbers));
        }
    }
    cases
}

/// Claim 5: at equal exits SIMD gains from one pass, and more than sequential.
pub fn one_pass_alone(asked: &Asked) -> Vec<Case> {
    let changes = [
        ("without exits", (Stage::TwoPass.version(), ONE_PASS_WITHOUT_EXIT)),
        ("exit on a miss", (TWO_PASS_WITH_EXIT, Stage::OnePass.version())),
    ];
    let mut cases = Vec::new();
    for scene in asked.scenes() {
        for (what, change) in changes {
            let of = |renderer| gain(asked, &scene, renderer, change);
            let Some((simd, sequential)) = of(Renderer::Simd).zip(of(Renderer::Sequential)) else { continue };
            let nothing = Uncertain::exact(1.0);
            // Both times' margin is the quotient's, so that the nothing it is compared with has none
            let outcome = all([less(nothing, simd), less(sequential, simd)]);
            let numbers = format!("SIMD {:.2} times, sequential {:.2}", simd.value, sequential.value);
            cases.push(case(&scene, what, outcome, numbers));
        }
    }
    cases
}

/// Claim 6.
pub fn still_slow(asked: &Asked) -> Vec<Case> {
    simd_alone(asked, Stage::OnePass, true)
}

/// Claim 7.
pub fn exits_help(asked: &Asked) -> Vec<Case> {
    let mut cases = Vec::new();
    for scene in asked.scenes() {
        for renderer in [Renderer::Simd, Renderer::SimdThreads] {
            let of = |stage| asked.stage(&scene, renderer, stage);
            let Some((before, after)) = of(Stage::OnePass).zip(of(Stage::Exits)) else { continue };
            let numbers = two(("without", before), ("with", after));
            cases.push(case(&scene, renderer.title(), less(after, before), numbers));
        }
    }
    cases
}

/// Claim 8.
pub fn fast_at_last(asked: &Asked) -> Vec<Case> {
    simd_alone(asked, Stage::Exits, false)
}

/// Claim 9: the greatest gain of SIMD alone over the three scenes.
pub fn first_to_last(asked: &Asked) -> Vec<Case> {
    let of = |role: Role| {
        let scene = asked.view.scene(role)?;
        let first = asked.stage(&scene, Renderer::Simd, Stage::TwoPass)?;
        Some((role, first, asked.stage(&scene, Renderer::Simd, Stage::Exits)?))
    };
    let Some(gains) = Role::PAPER.map(of).into_iter().collect::<Option<Vec<_>>>() else { return Vec::new() };
    let by_gain = |gain: &&(Role, Uncertain, Uncertain)| gain.1.value / gain.2.value;
    let Some((_, first, last)) = gains.iter().max_by(|a, b| by_gain(a).total_cmp(&by_gain(b))) else {
        return Vec::new();
    };
    let words: Vec<String> = gains.iter().map(|gain| format!("{} {:.1}", gain.0.name(), by_gain(&gain))).collect();
    let numbers = format!("{} times", words.join(", "));
    vec![Case {
        scene: "the greatest gain".into(),
        what: String::new(),
        outcome: less_by(*last, *first, UP_TO),
        numbers,
    }]
}

/// Claim 11: nothing is faster than the GPU; with 100 spheres it is about 1000 times as fast as sequential.
pub fn gpu_is_fastest(asked: &Asked) -> Vec<Case> {
    let mut cases = Vec::new();
    for scene in asked.scenes() {
        for stage in Stage::ALL {
            let of = |renderer| asked.stage(&scene, renderer, stage);
            let Some((gpu, sequential)) = of(Renderer::Gpu).zip(of(Renderer::Sequential)) else { continue };
            let others: Vec<Uncertain> = Renderer::CPU.into_iter().filter_map(of).collect();
            let least = others.iter().map(|other| other.value).fold(f64::INFINITY, f64::min);
            let numbers = format!("GPU {}, the fastest other {} ms", ms(gpu), Form::Time.write(least));
            cases.push(case(&scene, stage.title(), all(others.iter().map(|other| less(gpu, *other))), numbers));
            if scene.role == Role::Random100 && stage == Stage::Exits {
                let numbers = format!("{:.1} times sequential", sequential.value / gpu.value);
                cases.push(case(&scene, "about 1000", less_by(gpu, sequential, ABOUT_A_THOUSAND), numbers));
            }
        }
    }
    cases
}

/// Claim 12: Karp-Flatt metrics of GPU and SIMD with threads, and of the first and the last version.
pub fn serial_shares(asked: &Asked) -> Vec<Case> {
    let mut cases = Vec::new();
    for scene in asked.scenes() {
        let of = |renderer, stage| asked.parallel(&scene, renderer, stage);
        for stage in [Stage::TwoPass, Stage::Exits] {
            let both = of(Renderer::Gpu, stage).zip(of(Renderer::SimdThreads, stage));
            let Some((gpu, simd)) = both else { continue };
            let [of_gpu, of_simd] = [gpu, simd].map(|p| Form::Time.write(p.karp_flatt()));
            let what = format!("GPU, {}", stage.title());
            cases.push(case(&scene, what, less_serial(gpu, simd), format!("GPU {of_gpu}, SIMD + threads {of_simd}")));
        }
        let both = of(Renderer::SimdThreads, Stage::TwoPass).zip(of(Renderer::SimdThreads, Stage::Exits));
        if let Some((first, last)) = both {
            let [before, after] = [first, last].map(|p| Form::Time.write(p.karp_flatt()));
            let numbers = format!("first {before}, last {after}");
            cases.push(case(&scene, "SIMD + threads", less_serial(last, first), numbers));
        }
    }
    cases
}

/// Claim 13: SIMD alone stays below half of its lanes, in the paper's structure and in its fastest setting.
pub fn vectors_hardly_pay(asked: &Asked) -> Vec<Case> {
    let mut cases = Vec::new();
    for scene in asked.scenes() {
        let own = asked.row(&scene, Renderer::Simd, Stage::Exits.version());
        let best = fastest(&asked.view, &scene, Renderer::Simd)
            .filter(|best| own.is_some_and(|own| own.setting != best.setting));
        for (what, row) in [("the paper's structure", own), ("the fastest setting", best)] {
            let sequential = asked.stage(&scene, Renderer::Sequential, Stage::Exits);
            let Some((row, sequential)) = row.zip(sequential) else { continue };
            let lanes = row.setting.lanes as f64;
            let outcome = less_by(sequential, row.time(), 2.0 / lanes);
            let numbers = format!("{:.2} times with {lanes:.0} lanes", sequential.value / row.mean_ms);
            cases.push(case(&scene, what, outcome, numbers));
        }
    }
    cases
}
