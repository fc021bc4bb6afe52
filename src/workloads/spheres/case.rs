//! A case of the sphere tracer, typed; the harness knows it as axes.

use super::options::{Algorithm, HitRecord, MAX_TRIPS, Options, Precision, Renderer};
use super::renderer::{OPTIONS, typed};
use crate::error::{Error, Result};
use crate::harness::parse_list;
use crate::harness::workload::{Case, Part};
use crate::workloads::size::{Size, parse_size};
use crate::workloads::words::{flag, name, word};

/// What one row measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SpheresCase {
    /// Who renders.
    pub renderer: Renderer,
    /// The switches.
    pub options: Options,
    /// Arithmetic.
    pub precision: Precision,
    /// Most rays along a path, 1 to [`MAX_TRIPS`].
    pub trips: u32,
    /// Image size.
    pub size: Size,
    /// Views, evenly over a period of the orbit.
    pub frames: usize,
}

/// Values of the axes that have words, as they are typed. The first one is the default.
const ALGORITHMS: [(&str, Algorithm); 2] = [("one-pass", Algorithm::OnePass), ("two-pass", Algorithm::TwoPass)];
const HITS: [(&str, HitRecord); 2] = [("index", HitRecord::Index), ("in-loop", HitRecord::InLoop)];
const PRECISIONS: [(&str, Precision); 2] = [("f32", Precision::F32), ("f16", Precision::F16)];
const SWITCH: [(&str, bool); 2] = [("on", true), ("off", false)];

/// The numbers of trips where none are given.
const TRIPS: &str = "5";

/// Frames where none are given.
const FRAMES: usize = 4;

/// The values of an axis, or its default.
fn words<T: Copy + PartialEq>(part: &Part, axis: &str, all: &[(&str, T)]) -> Result<Vec<T>> {
    match part.of(axis) {
        [] => Ok(vec![all[0].1]),
        texts => parse_list(texts, |text| word(axis, all, text)),
    }
}

fn parse_trips(text: &str) -> Result<u32> {
    let number = text.parse().ok().filter(|number| (1..=MAX_TRIPS).contains(number));
    number.ok_or_else(|| {
        Error::argument(
            "--trips",
            format!("'{text}' is no number of rays along a path"),
            format!("give 1 to {MAX_TRIPS}"),
        )
    })
}

impl Options {
    /// The same without the switches that a renderer does not have.
    #[must_use]
    pub fn of(self, renderer: Renderer) -> Options {
        let has = renderer.is_simd();
        let hit = if renderer == Renderer::Gpu { HitRecord::Index } else { self.hit };
        let (skip_no_hit, skip_no_discriminant) = (self.skip_no_hit && has, self.skip_no_discriminant && has);
        Options { skip_no_hit, skip_no_discriminant, hit, ..self }
    }
}

impl SpheresCase {
    /// Every combination of the values of a part, each once.
    ///
    /// # Errors
    /// [`Error::Input`] for the first value that cannot be, and for a switch given by the user that no renderer of the
    /// part has.
    pub fn all(part: &Part) -> Result<Vec<SpheresCase>> {
        let needed = |axis: &str| match part.of(axis) {
            [] => Err(Error::argument(format!("--{axis}"), format!("no {axis} is given"), format!("give --{axis}"))),
            texts => Ok(texts),
        };
        let mut renderers: Vec<Renderer> = Vec::new();
        for renderer in parse_list(needed("renderer")?, Renderer::parse_all)?.concat() {
            if !renderers.contains(&renderer) {
                renderers.push(renderer);
            }
        }
        check_switches(part, &renderers)?;
        let sizes = parse_list(needed("resolution")?, parse_size)?;
        let trips = match part.of("trips") {
            [] => vec![parse_trips(TRIPS)?],
            texts => parse_list(texts, parse_trips)?,
        };
        let frames = part.frames.unwrap_or(FRAMES);
        let mut cases = Vec::new();
        for options in switches(part)? {
            for &precision in &words(part, "precision", &PRECISIONS)? {
                for (&size, &trips) in sizes.iter().flat_map(|size| trips.iter().map(move |trips| (size, trips))) {
                    for &renderer in &renderers {
                        let options = options.of(renderer);
                        let case = SpheresCase { renderer, options, precision, trips, size, frames };
                        if !cases.contains(&case) {
                            cases.push(case);
                        }
                    }
                }
            }
        }
        Ok(cases)
    }

    /// Ray/sphere tests of one pass over the frames, if no path ends early.
    pub fn tests(&self, spheres: usize) -> u64 {
        let rays = self.size.pixels() as u64 * u64::from(self.trips) * self.frames as u64;
        rays.saturating_mul(spheres as u64)
    }

    /// For the harness.
    pub fn to_case(self, scene: &str, spheres: usize) -> Case {
        let SpheresCase { renderer, options, precision, trips, size, frames } = self;
        let resolution = format!("{}x{}", size.width, size.height);
        let of_simd = |switch: bool| if renderer.is_simd() { name(&SWITCH, switch) } else { "" };
        let hit = if renderer == Renderer::Gpu { "" } else { name(&HITS, options.hit) };
        let axes = [
            ("scene", scene.to_owned()),
            ("renderer", renderer.name().to_owned()),
            ("algorithm", name(&ALGORITHMS, options.algorithm).to_owned()),
            ("exit_on_miss", name(&SWITCH, options.exit_on_miss).to_owned()),
            ("skip_no_hit", of_simd(options.skip_no_hit).to_owned()),
            ("skip_no_discriminant", of_simd(options.skip_no_discriminant).to_owned()),
            ("hit", hit.to_owned()),
            ("precision", name(&PRECISIONS, precision).to_owned()),
            ("trips", trips.to_string()),
            ("resolution", resolution.clone()),
            ("frames", frames.to_string()),
        ];
        let axes = axes.into_iter().chain(renderer.axes()).map(|(axis, value)| (axis.to_owned(), value));
        Case {
            axes: axes.collect(),
            input: scene.to_owned(),
            group: [renderer.to_string(), self.switches()].join(" "),
            turn: format!("{resolution}, {trips} trips, {frames} frames"),
            device: usize::from(renderer == Renderer::Gpu),
            work: self.tests(spheres),
        }
    }

    /// Algorithm, precision and the switches that are on, in a few words.
    pub fn switches(&self) -> String {
        let Options { algorithm, exit_on_miss, skip_no_hit, skip_no_discriminant, hit } = self.options;
        let mut words = vec![name(&ALGORITHMS, algorithm)];
        words.extend(exit_on_miss.then_some("exit-on-miss"));
        words.extend(skip_no_hit.then_some("skip-no-hit"));
        words.extend(skip_no_discriminant.then_some("skip-no-discriminant"));
        words.extend((hit == HitRecord::InLoop).then_some("in-loop"));
        words.extend((self.precision == Precision::F16).then_some("f16"));
        words.join(" ")
    }

    /// Reads what [`SpheresCase::to_case`] wrote.
    ///
    /// # Errors
    /// [`Error::Input`] for a case of another origin.
    pub fn parse(case: &Case) -> Result<SpheresCase> {
        let on = |axis: &str| match case.axis(axis) {
            "" => Ok(false),
            text => word(axis, &SWITCH, text),
        };
        let frames = case.axis("frames");
        Ok(SpheresCase {
            renderer: Renderer::parse(&typed(case.axis("renderer"), &OPTIONS.map(|key| (key, case.axis(key)))))?,
            options: Options {
                algorithm: word("algorithm", &ALGORITHMS, case.axis("algorithm"))?,
                exit_on_miss: on("exit_on_miss")?,
                skip_no_hit: on("skip_no_hit")?,
                skip_no_discriminant: on("skip_no_discriminant")?,
                hit: match case.axis("hit") {
                    "" => HitRecord::Index,
                    text => word("hit", &HITS, text)?,
                },
            },
            precision: word("precision", &PRECISIONS, case.axis("precision"))?,
            trips: parse_trips(case.axis("trips"))?,
            size: parse_size(case.axis("resolution"))?,
            frames: frames.parse().map_err(|_| Error::argument("--frames", format!("{frames:?}"), ""))?,
        })
    }
}

/// Every combination of the switches.
fn switches(part: &Part) -> Result<Vec<Options>> {
    let mut all = Vec::new();
    for algorithm in words(part, "algorithm", &ALGORITHMS)? {
        for exit_on_miss in words(part, "exit_on_miss", &SWITCH)? {
            for skip_no_hit in words(part, "skip_no_hit", &SWITCH)? {
                for skip_no_discriminant in words(part, "skip_no_discriminant", &SWITCH)? {
                    for hit in words(part, "hit", &HITS)? {
                        all.push(Options { algorithm, exit_on_miss, skip_no_hit, skip_no_discriminant, hit });
                    }
                }
            }
        }
    }
    Ok(all)
}

/// Refuses switches of the command line that none of the renderers has.
fn check_switches(part: &Part, renderers: &[Renderer]) -> Result<()> {
    let wrong = |axis: &str, who: &str| {
        Error::argument(flag(axis), format!("it is for {who} only"), "leave it out, or name such a --renderer")
    };
    let is_given = |axis: &str| part.given.contains(axis);
    if !renderers.iter().any(|renderer| renderer.is_simd())
        && let Some(axis) = ["skip_no_hit", "skip_no_discriminant"].into_iter().find(|axis| is_given(axis))
    {
        return Err(wrong(axis, "simd and simd-threads"));
    }
    if renderers.iter().all(|renderer| *renderer == Renderer::Gpu) && is_given("hit") {
        return Err(wrong("hit", "renderers on the CPU"));
    }
    Ok(())
}

/// The scenes of a part, each once.
///
/// # Errors
/// [`Error::Input`] if there is none.
pub fn scenes(part: &Part) -> Result<Vec<String>> {
    // A file's name may have commas: each value is one scene, as on every workload
    let mut scenes: Vec<String> = Vec::new();
    for scene in part.of("scene") {
        if !scenes.contains(scene) {
            scenes.push(scene.clone());
        }
    }
    match scenes.is_empty() {
        true => Err(Error::argument("--scene", "no scene is given", "give --scene")),
        false => Ok(scenes),
    }
}
