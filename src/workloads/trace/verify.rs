//! Verification before timing: what a kernel finds is compared with a reference that brute force has checked.
//!
//! The reference is the CPU twin of `bvh-stack`; rays of it are confirmed by testing every triangle, as many as fit
//! [`BRUTE_TESTS`]. Because all traversals agree to the bit ([`crate::math`]), one reference serves all structures.
//!
//! **Limits.** Where device and twins compute alike ([`crate::device::DeviceInfo::agrees_with_twins`]), triangles,
//! distances, counters and the timed kernel's agreement with the counting kernel's are compared to the bit; only
//! colours may differ, by [`COLOUR_LEVELS`], because `pow` is a library's on one side and a driver's on the other.
//! Other devices may contract multiplications and additions and approximate divisions: a ray that passes within
//! rounding of an edge can find the neighbouring triangle. Such rays lie along edges, so that their share is about the
//! width of rounding over the width of a triangle in the image; [`HIT_SHARE`] is far above that and far below any wrong
//! kernel. No ray may lose its hit, except at a silhouette: the watertight test loses none on any device. What really
//! differs is recorded with every row.

use crate::camera::View;
use crate::error::Result;
use crate::math::MISS;
use crate::scene::Scene;
use crate::workloads::trace::backend::{Backend, Config, CountedPixel, GivenRay, Pixel, PixelCounters, Prepared, Size};
use crate::workloads::trace::brute;
use crate::workloads::trace::intersect::TriangleTest;
use crate::workloads::trace::method::Rays;
use crate::workloads::trace::{Agreement, Built, CpuBackend, Method, Parameters, Structure, bvh, path};
use std::sync::Arc;

/// A colour channel may differ by this many of 255 levels: `pow` of both sides is good to a few units in the last
/// place, which moves a rounded channel by one level, and a reflection may add another.
pub const COLOUR_LEVELS: u8 = 2;

/// Share of the primary rays whose triangle may differ on a device that is not exact.
pub const HIT_SHARE: f64 = 1.0e-3;

/// Share of the pixels whose colour may differ by more than [`COLOUR_LEVELS`] on a device that is not exact: a shadow
/// ray that just misses an edge changes a whole pixel, and a pixel has several.
pub const COLOUR_SHARE: f64 = 5.0e-3;

/// Share of the pixels whose counters may differ on a device that is not exact: an interval that rounds differently
/// swaps two children of equal distance. In a packet one such ray can change the counts of all 64.
pub const COUNTER_SHARE: f64 = 5.0e-2;

/// Relative difference of distances up to which they count as the same on a device that is not exact.
pub const DISTANCE_SLACK: f32 = 1.0e-4;

/// By how much rays are turned to find out whether they pass a silhouette: eight roundings of a unit vector.
pub const TURN: f32 = 8.0 * f32::EPSILON;

/// Ray/triangle tests that brute force may spend on one view and size: about half a second on two cores.
pub const BRUTE_TESTS: usize = 1 << 26;

/// The outcome of verifying one configuration at one size.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// True if everything agrees within the stated limits.
    pub ok: bool,
    /// One line: what was compared, or what disagrees.
    pub message: String,
    /// Primary rays compared.
    pub rays: u64,
    /// Of these, how many of the reference's answers brute force has confirmed.
    pub brute_checked: u64,
    /// Primary rays whose triangle or distance differs.
    pub hits_differing: u64,
    /// Of these, how many hit a triangle in the reference, away from silhouettes, and none here. With the watertight
    /// test, no ray may, on any device.
    pub hits_lost: u64,
    /// Pixels whose steps, tests, pops or restarts differ from the CPU twin's (0 where they were not compared).
    pub counters_differing: u64,
    /// Pixels whose colour differs by more than the stated amount.
    pub colours_differing: u64,
    /// Largest difference of a colour channel, of 255.
    pub max_colour_difference: u8,
    /// BLAKE3 of the shaded image (RGBA8, rows from the top), hexadecimal.
    pub image_hash: String,
    /// The shaded image, RGBA8.
    pub image: Vec<u8>,
    /// Where `ok` is false: an RGBA8 image of the same size, red where a hit differs, yellow where a counter, blue
    /// where only the colour differs, over the darkened image.
    pub difference: Option<Vec<u8>>,
}

/// Pixels of one frame with what the counting kernels add.
struct Answers {
    pixels: Vec<Pixel>,
    /// Distances of the primary hits; empty where they are not known.
    distances: Vec<f32>,
    /// Empty where they are not known.
    counters: Vec<PixelCounters>,
}

impl Answers {
    /// By the counting kernel; its counters only where something is compared with them, since they are large.
    fn counted(
        prepared: &mut dyn Prepared,
        (config, view, size): (Config, &View, Size),
        with_counters: bool,
    ) -> Result<Answers> {
        let mut answers = Answers { pixels: Vec::new(), distances: Vec::new(), counters: Vec::new() };
        prepared.counted(config, view, size, &mut |_, band: &[CountedPixel]| {
            answers.pixels.extend(band.iter().map(|p| p.pixel));
            answers.distances.extend(band.iter().map(|p| f32::from_bits(p.t)));
            if with_counters {
                answers.counters.extend(band.iter().map(|p| p.counters));
            }
        })?;
        Ok(answers)
    }
}

/// A reference image and how much of it brute force has confirmed.
struct Reference {
    /// What of the method decides which rays there are.
    rays: Rays,
    config: Config,
    view: View,
    size: Size,
    answers: Answers,
    brute_checked: u64,
    /// Rays for which brute force found something else: then the reference is no reference.
    brute_differing: u64,
}

/// Verifies all configurations of one scene; keeps the references it has computed.
pub struct Verifier {
    pub(super) scene: Arc<Scene>,
    pub(super) cpu: CpuBackend,
    tree: Arc<Built>,
    brute: brute::Brute,
    references: Vec<Reference>,
}

/// Which pixels differ, and how.
struct Differences {
    hits: Vec<bool>,
    counters: Vec<bool>,
    colours: Vec<bool>,
    max_colour: u8,
}

impl Verifier {
    /// A verifier whose reference is traced through `tree`, a BVH, by the CPU twin and checked by brute force.
    ///
    /// # Errors
    /// [`Error::Device`] if no threads can be started.
    pub fn new(scene: Arc<Scene>, tree: Arc<Built>) -> Result<Self> {
        let brute = brute::build::build(&scene)?;
        Ok(Verifier { scene, cpu: CpuBackend::new(0)?, tree, brute, references: Vec::new() })
    }

    /// Verifies one frame. With `twin`, hits and counters are also compared with the CPU twin of the same method on
    /// that structure, pixel by pixel (for small images); without, only with the reference image. `exact` demands
    /// agreement to the bit (see [`crate::device::DeviceInfo::agrees_with_twins`]).
    ///
    /// # Errors
    /// Those of the device. A disagreement is no error but a verdict.
    pub fn check(
        &mut self,
        prepared: &mut dyn Prepared,
        method: Method,
        twin: Option<&dyn Structure>,
        (config, view, size): (Config, &View, Size),
        exact: bool,
    ) -> Result<Verdict> {
        let agreement = method.traversal.agreement;
        let exact = exact && agreement == Agreement::Exact;
        let twin = twin.filter(|_| method.traversal.twin.is_some());
        let timed = prepared.image(config, view, size)?;
        let found = match twin {
            Some(_) => Answers::counted(prepared, (config, view, size), true)?,
            // Hits are compared by their distances, which only the counting kernel tells
            None if agreement == Agreement::HitsOnly => Answers::counted(prepared, (config, view, size), false)?,
            None => Answers { pixels: timed.clone(), distances: Vec::new(), counters: Vec::new() },
        };
        let own = match twin {
            Some(structure) => {
                let mut twin = self.cpu.prepare(&self.scene, structure, method)?;
                Some(Answers::counted(twin.as_mut(), (config, view, size), true)?)
            }
            None => None,
        };
        let reference = self.reference(method, config, view, size)?;
        let missing = missing(&timed, &found, reference);
        let lost = self.not_at_a_silhouette(method, view, size, &missing)?;
        let reference = self.reference(method, config, view, size)?;
        Ok(judge(&timed, &found, own.as_ref(), reference, lost, (exact, agreement)))
    }

    /// How many of these pixels' primary rays hit something however they are turned by a few roundings. A device whose
    /// division is not exact has slightly other rays, of which those at a silhouette may miss; no other ray may.
    fn not_at_a_silhouette(&self, method: Method, view: &View, size: Size, pixels: &[usize]) -> Result<u64> {
        if pixels.is_empty() {
            return Ok(0);
        }
        let turned = |pixel: &usize| {
            let ray = path::primary_ray(method, view, size, *pixel);
            let (x, y) = ray.direction.any_orthonormal_pair();
            let turns =
                [(0.0, 1.0), (1.0, 1.0), (1.0, 0.0), (1.0, -1.0), (0.0, -1.0), (-1.0, -1.0), (-1.0, 0.0), (-1.0, 1.0)];
            turns.map(|(a, b)| GivenRay { direction: ray.direction + (x * a + y * b) * TURN, ..ray })
        };
        let rays: Vec<GivenRay> = pixels.iter().flat_map(turned).collect();
        let own = method.by(&bvh::stack::STACK, bvh::stack::defaults());
        let hits = self.cpu.prepare(&self.scene, &*self.tree.structure, own)?.trace(&rays, false)?;
        Ok(hits.chunks(8).filter(|hits| hits.iter().all(|hit| hit.triangle != MISS)).count() as u64)
    }

    /// The reference for a view; computed the first time.
    fn reference(&mut self, method: Method, config: Config, view: &View, size: Size) -> Result<&Reference> {
        let rays = method.rays();
        let same = |r: &Reference| r.rays == rays && r.config == config && r.size == size && r.view == *view;
        let place = self.references.iter().position(same);
        let place = match place {
            Some(place) => place,
            None => {
                let own = Method { tiles: 1, ..method.by(&bvh::stack::STACK, bvh::stack::defaults()) };
                let answers = {
                    let mut twin = self.cpu.prepare(&self.scene, &*self.tree.structure, own)?;
                    Answers::counted(twin.as_mut(), (config, view, size), false)?
                };
                let (brute_checked, brute_differing) = self.check_by_brute_force(&answers, own, config, view, size)?;
                let view = view.clone();
                self.references.push(Reference { rays, config, view, size, answers, brute_checked, brute_differing });
                self.references.len() - 1
            }
        };
        Ok(&self.references[place])
    }

    /// Tests every triangle for as many primary rays, evenly spread, as [`BRUTE_TESTS`] allows: how many rays were
    /// checked, and for how many the answer differs.
    fn check_by_brute_force(
        &self,
        answers: &Answers,
        method: Method,
        config: Config,
        view: &View,
        size: Size,
    ) -> Result<(u64, u64)> {
        // The same primary rays have been checked for another configuration
        let rays = method.rays();
        let same = |r: &&Reference| {
            Rays { shadows: rays.shadows, ..r.rays } == rays
                && r.size == size
                && r.view.camera == view.camera
                && r.config != config
        };
        let known = self.references.iter().find(same);
        if let Some(known) = known {
            return Ok((known.brute_checked, known.brute_differing));
        }
        let count = (BRUTE_TESTS / self.scene.triangles.len().max(1)).max(64).min(size.pixels());
        let chosen: Vec<usize> =
            (0..count).map(|i| (i as u64 * size.pixels() as u64 / count as u64) as usize).collect();
        let given: Vec<GivenRay> = chosen.iter().map(|&pixel| path::primary_ray(method, view, size, pixel)).collect();
        let hits = self
            .cpu
            .prepare(&self.scene, &self.brute, method.by(&brute::scan::SCAN, Parameters::NONE))?
            .trace(&given, false)?;
        let differing = hits.iter().zip(&chosen).filter(|&(hit, &pixel)| {
            hit.triangle != answers.pixels[pixel].triangle || hit.t.to_bits() != answers.distances[pixel].to_bits()
        });
        Ok((count as u64, differing.count() as u64))
    }
}

/// Pixels that hit a triangle in the reference, and none by the timed or by the counting kernel.
fn missing(timed: &[Pixel], found: &Answers, reference: &Reference) -> Vec<usize> {
    let is_miss = |pixels: &[Pixel], index: usize| pixels.get(index).is_some_and(|p| p.triangle == MISS);
    let expected = reference.answers.pixels.iter().enumerate().filter(|(_, pixel)| pixel.triangle != MISS);
    expected.map(|(index, _)| index).filter(|&i| is_miss(timed, i) || is_miss(&found.pixels, i)).collect()
}

/// Compares the timed kernel's pixels, the counting kernel's answers and the twin's with the reference.
fn judge(
    timed: &[Pixel],
    found: &Answers,
    twin: Option<&Answers>,
    reference: &Reference,
    lost: u64,
    (exact, agreement): (bool, Agreement),
) -> Verdict {
    let pixels = reference.size.pixels();
    let image: Vec<u8> = timed.iter().flat_map(|p| p.rgba.to_le_bytes()).collect();
    let kernels_differing = timed.iter().zip(&found.pixels).filter(|(a, b)| a != b).count();
    let mut differences = Differences {
        hits: vec![false; pixels],
        counters: vec![false; pixels],
        colours: vec![false; pixels],
        max_colour: 0,
    };
    // The reference has been checked by brute force; the twin of the same structure must agree with it as well
    differences.hits_against(&reference.answers, timed, found, (exact, agreement));
    if let Some(twin) = twin {
        differences.hits_against(twin, timed, found, (exact, agreement));
        for (index, (a, b)) in twin.counters.iter().zip(&found.counters).enumerate() {
            differences.counters[index] = a != b;
        }
    }
    differences.colours_against(&reference.answers, timed);

    let count = |set: &[bool]| set.iter().filter(|&&differs| differs).count() as u64;
    let (hits, counters) = (count(&differences.hits), count(&differences.counters));
    let colours = count(&differences.colours);
    let allowed = |share: f64| if exact { 0 } else { (share * pixels as f64).ceil() as u64 };
    let mut problems = Vec::new();
    let mut demand = |differing: u64, share: f64, what: &str| {
        if differing > allowed(share) {
            problems.push(format!("{differing} of {pixels} {what} (allowed: {})", allowed(share)));
        }
    };
    demand(reference.brute_differing, 0.0, "rays of the reference itself differ from brute force");
    let hit_share = if let Agreement::Share(share) = agreement { share } else { HIT_SHARE };
    demand(hits, hit_share, "primary rays hit another triangle or at another distance");
    // A driver's own test may lose rays that run in planes and along edges; those count as hits that differ
    if reference.rays.intersect == TriangleTest::Watertight && agreement != Agreement::HitsOnly {
        demand(lost, 0.0, "primary rays away from silhouettes lost their hit");
    }
    demand(counters, COUNTER_SHARE, "pixels count other steps or tests than the CPU twin");
    demand(colours, COLOUR_SHARE, &format!("colours differ by more than {COLOUR_LEVELS} levels of 255"));
    demand(kernels_differing as u64, HIT_SHARE, "pixels of the counting kernel differ from the timed kernel's");
    if timed.len() != pixels || found.pixels.len() != pixels {
        problems.push(format!("the image has {} pixels instead of {pixels}", timed.len()));
    }

    let ok = problems.is_empty();
    let message = match ok {
        true => format!(
            "{pixels} primary rays agree with the reference{}, {} of them checked by brute force",
            if twin.is_some() { " and the twin's counters" } else { "" },
            reference.brute_checked
        ),
        false => problems.join("; "),
    };
    let difference = (!ok).then(|| differences.picture(&image, pixels));
    Verdict {
        ok,
        message,
        rays: pixels as u64,
        brute_checked: reference.brute_checked,
        hits_differing: hits,
        hits_lost: lost,
        counters_differing: counters,
        colours_differing: colours,
        max_colour_difference: differences.max_colour,
        image_hash: blake3::hash(&image).to_hex().to_string(),
        image,
        difference,
    }
}

impl Differences {
    fn hits_against(
        &mut self,
        expected: &Answers,
        timed: &[Pixel],
        found: &Answers,
        (exact, agreement): (bool, Agreement),
    ) {
        // By hits only, of two triangles at the same distance either may be hit
        let hits_only = agreement == Agreement::HitsOnly;
        let is_other = |a: u32, b: u32| if hits_only { (a == MISS) != (b == MISS) } else { a != b };
        for (index, differs) in self.hits.iter_mut().enumerate() {
            let right = expected.pixels[index].triangle;
            let pixels = [timed.get(index), found.pixels.get(index)];
            let triangles_differ = pixels.iter().any(|p| p.is_none_or(|p| is_other(p.triangle, right)));
            let far_off = match (found.distances.get(index), expected.distances.get(index)) {
                (Some(a), Some(b)) if exact => a.to_bits() != b.to_bits(),
                (Some(a), Some(b)) => a.is_nan() || (a - b).abs() > DISTANCE_SLACK * b.abs(),
                _ => false,
            };
            *differs |= triangles_differ || far_off;
        }
    }

    fn colours_against(&mut self, expected: &Answers, timed: &[Pixel]) {
        for (index, (a, b)) in expected.pixels.iter().zip(timed).enumerate() {
            let channels = a.rgba.to_le_bytes().into_iter().zip(b.rgba.to_le_bytes());
            let worst = channels.map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0);
            self.max_colour = self.max_colour.max(worst);
            self.colours[index] = worst > COLOUR_LEVELS;
        }
    }

    fn picture(&self, image: &[u8], pixels: usize) -> Vec<u8> {
        let mut picture = vec![0; pixels * 4];
        for (index, out) in picture.chunks_exact_mut(4).enumerate() {
            let colour = if self.hits[index] {
                [255, 0, 0, 255]
            } else if self.counters[index] {
                [255, 220, 0, 255]
            } else if self.colours[index] {
                [40, 90, 255, 255]
            } else {
                let shade = |channel: usize| image.get(index * 4 + channel).copied().unwrap_or(0) / 3;
                [shade(0), shade(1), shade(2), 255]
            };
            out.copy_from_slice(&colour);
        }
        picture
    }
}
