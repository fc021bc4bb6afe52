//! Several pixels of a row at once: the same operations in the same order on every lane, branches become masks.

use super::super::options::{Lanes, Options};
use super::super::scene::PackedSphere;
use super::super::view::View;
use super::mode::{Mode, by_mode};
use super::probe::{Exit, MAX_LANES, Probe};
use super::vector::V3;
use super::{Band, Job};
use fearless_simd::{Select, Simd, SimdFloat, SimdMask, f32x4, f32x8, f32x16};
use glam::Vec3;

/// What is kept of a hit, by lane. Where a search misses, a lane keeps its values.
#[derive(Clone, Copy)]
struct Hit<F> {
    position: V3<F>,
    normal: V3<F>,
    color: V3<F>,
}

/// A trip of a vector of paths, for the way back; `M` is a mask.
#[derive(Clone, Copy)]
struct Step<F, M> {
    direction: V3<F>,
    hit: Hit<F>,
    live: M,
}

/// The view with all numbers that sums need in registers.
struct Wide<'a, S, F> {
    simd: S,
    view: &'a View,
    zero: F,
    two: F,
    epsilon: F,
    intensity: F,
    light: V3<F>,
    light_color: V3<F>,
    ambient: V3<F>,
}

/// Renders a band of rows, so many pixels at once.
pub fn rows<S: Simd, P: Probe>(simd: S, lanes: Lanes, job: &Job, band: Band, probe: &mut P) {
    match lanes {
        Lanes::Four => rows_of::<S, f32x4<S>, P>(simd, job, band, probe),
        Lanes::Eight => rows_of::<S, f32x8<S>, P>(simd, job, band, probe),
        Lanes::Sixteen => rows_of::<S, f32x16<S>, P>(simd, job, band, probe),
    }
}

fn rows_of<S: Simd, F: SimdFloat<S, Element = f32>, P: Probe>(simd: S, job: &Job, band: Band, probe: &mut P) {
    by_mode!(P::WATCHES, &job.options, mode => rows_by::<S, F, P, _>(simd, job, band, probe, mode))
}

/// `vectorize` lets the compiler use the level's instructions in everything that is inlined into its closure.
#[inline(always)]
fn rows_by<S, F, P, M>(simd: S, job: &Job, band: Band, probe: &mut P, mode: M)
where
    S: Simd,
    F: SimdFloat<S, Element = f32>,
    P: Probe,
    M: Mode,
{
    simd.vectorize(
        #[inline(always)]
        || {
            let wide = Wide::<S, F>::new(simd, job.view);
            let none = wide.nothing();
            let direction = V3 { x: wide.zero, y: wide.zero, z: wide.zero };
            let step = Step { direction, hit: none, live: F::Mask::splat(simd, false) };
            let mut steps = vec![step; job.view.trips as usize];
            let width = job.view.width as usize;
            for (row, image) in band.image.chunks_mut(width).enumerate() {
                for (vector, pixels) in image.chunks_mut(F::LEN).enumerate() {
                    let first = wide.primary(vector * F::LEN, band.first_row + row);
                    let at = row * width + vector * F::LEN;
                    wide.paths(job, first, pixels, at, &mut steps, probe, mode);
                }
            }
        },
    );
}

impl<S: Simd, F: SimdFloat<S, Element = f32>> Wide<'_, S, F> {
    #[inline(always)]
    fn new(simd: S, view: &View) -> Wide<'_, S, F> {
        let splat = |value| F::splat(simd, value);
        let wide = |v: Vec3| V3 { x: splat(v.x), y: splat(v.y), z: splat(v.z) };
        Wide {
            simd,
            view,
            zero: splat(0.0),
            two: splat(view.two),
            epsilon: splat(view.epsilon),
            intensity: splat(view.intensity),
            light: wide(view.light),
            light_color: wide(view.light_color),
            ambient: wide(view.ambient),
        }
    }

    #[inline(always)]
    fn splat(&self, value: f32) -> F {
        F::splat(self.simd, value)
    }

    #[inline(always)]
    fn wide(&self, v: Vec3) -> V3<F> {
        V3 { x: self.splat(v.x), y: self.splat(v.y), z: self.splat(v.z) }
    }

    #[inline(always)]
    fn nothing(&self) -> Hit<F> {
        let zero = V3 { x: self.zero, y: self.zero, z: self.zero };
        Hit { position: self.wide(self.view.origin), normal: zero, color: zero }
    }

    /// The directions of the first rays of a row's pixels from `x` on; some may lie beyond its end.
    #[inline(always)]
    fn primary(&self, x: usize, y: usize) -> V3<F> {
        let view = self.view;
        let px = F::from_fn(self.simd, |lane| (x + lane) as f32 + view.half);
        let py = self.splat(y as f32 + view.half);
        let d = (self.wide(view.corner) + self.wide(view.right) * px) + self.wide(view.down) * py;
        d / d.dot(d).sqrt()
    }

    /// The paths of `pixels`, which are at most as many as there are lanes; those of the other lanes are dead.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)]
    fn paths<P: Probe, M: Mode>(
        &self,
        job: &Job,
        mut d: V3<F>,
        pixels: &mut [[f32; 4]],
        at: usize,
        steps: &mut [Step<F, F::Mask>],
        probe: &mut P,
        mode: M,
    ) {
        let view = self.view;
        let mut origin = self.wide(view.origin);
        let mut hit = self.nothing();
        let mut live = F::Mask::from_bitmask(self.simd, !(!0 << pixels.len()));
        let (mut color, mut throughput) = (hit.normal, self.wide(Vec3::splat(view.one)));
        let mut hits = [0; MAX_LANES];
        let mut made = 0;
        for step in steps.iter_mut() {
            let found = self.search(job, origin, d, &mut hit, probe, mode.in_loop());
            probe.searched(F::LEN);
            live &= found;
            made += 1;
            if P::WATCHES {
                let bits = live.to_bitmask();
                hits.iter_mut().enumerate().for_each(|(lane, hits)| *hits += (bits >> lane & 1) as u32);
            }
            if mode.two_pass() {
                *step = Step { direction: d, hit, live };
            } else {
                let more = color + throughput * self.lighting(d, &hit);
                color = more.zip(color, |more, color| live.select(more, color));
                let less = throughput * (hit.color * self.intensity);
                throughput = less.zip(throughput, |less, throughput| live.select(less, throughput));
            }
            if job.options.exit_on_miss && !probe.any(Exit::Miss, live) {
                if made < view.trips {
                    probe.exited(Exit::Miss);
                }
                break;
            }
            let dn = d.dot(hit.normal);
            d = d - hit.normal * (self.two * dn);
            d = d / d.dot(d).sqrt();
            origin = hit.position;
        }
        if mode.two_pass() {
            // Stores that nothing reads would be left out, and with them what is to be measured
            let steps = &*std::hint::black_box(steps);
            for step in steps.iter().take(made as usize).rev() {
                let lighting = self.lighting(step.direction, &step.hit);
                let more = ((color * self.intensity) * step.hit.color) + lighting;
                color = more.zip(color, |more, color| step.live.select(more, color));
            }
        }
        let (red, green, blue) = (color.x.as_slice(), color.y.as_slice(), color.z.as_slice());
        for (lane, pixel) in pixels.iter_mut().enumerate() {
            *pixel = [red[lane], green[lane], blue[lane], 1.0];
            probe.pixel(at + lane, hits[lane]);
        }
    }

    /// The lanes that hit; for those `hit` is the nearest one.
    #[inline(always)]
    fn search<P: Probe>(
        &self,
        job: &Job,
        origin: V3<F>,
        d: V3<F>,
        hit: &mut Hit<F>,
        probe: &mut P,
        in_loop: bool,
    ) -> F::Mask {
        let (simd, far) = (self.simd, self.splat(self.view.far));
        let a = d.dot(d);
        let mut best = far;
        // Indices as the bits of numbers: they are only chosen from, so that one kind of register is enough
        let mut nearest = self.zero;
        let Options { skip_no_hit, skip_no_discriminant, .. } = job.options;
        for (index, sphere) in (0_u32..).zip(job.spheres) {
            // From the centre to the origin and so with the other sign, which changes no bit of what follows: one
            // instruction then reads a number, spreads and subtracts it
            let co = origin - self.wide(sphere.center);
            let minus_b = co.dot(d);
            let q = co.dot(co) - self.splat(sphere.radius2);
            let discriminant = minus_b * minus_b - a * q;
            let positive = discriminant.simd_gt(self.zero);
            let (mask, t) = if skip_no_discriminant && !probe.any(Exit::NoDiscriminant, positive) {
                probe.exited(Exit::NoDiscriminant);
                (F::Mask::splat(simd, false), far)
            } else {
                let root = discriminant.sqrt();
                let (near, far) = ((-minus_b - root) / a, (root - minus_b) / a);
                let t = probe.distance(simd, near.simd_gt(self.epsilon).select(near, far));
                (positive & t.simd_gt(self.epsilon) & t.simd_lt(best), t)
            };
            let mask = probe.nearest(simd, mask);
            if skip_no_hit && !probe.any(Exit::NoHit, mask) {
                probe.exited(Exit::NoHit);
                continue;
            }
            best = mask.select(t, best);
            if in_loop {
                let center = self.wide(sphere.center);
                self.record(hit, mask, origin, d, t, center, self.wide(sphere.color));
            } else {
                nearest = mask.select(self.splat(f32::from_bits(index)), nearest);
            }
        }
        let found = best.simd_lt(far);
        if !in_loop {
            let lane = |lane: usize| -> &PackedSphere { &job.spheres[nearest[lane].to_bits() as usize] };
            let center = V3 {
                x: F::from_fn(simd, |i| lane(i).center.x),
                y: F::from_fn(simd, |i| lane(i).center.y),
                z: F::from_fn(simd, |i| lane(i).center.z),
            };
            let color = V3 {
                x: F::from_fn(simd, |i| lane(i).color.x),
                y: F::from_fn(simd, |i| lane(i).color.y),
                z: F::from_fn(simd, |i| lane(i).color.z),
            };
            self.record(hit, found, origin, d, best, center, color);
        }
        found
    }

    /// Overwrites a hit in the lanes of the mask.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)]
    fn record(&self, hit: &mut Hit<F>, mask: F::Mask, origin: V3<F>, d: V3<F>, t: F, center: V3<F>, color: V3<F>) {
        let position = origin + d * t;
        let normal = position - center;
        let normal = normal / normal.dot(normal).sqrt();
        hit.position = position.zip(hit.position, |new, old| mask.select(new, old));
        hit.normal = normal.zip(hit.normal, |new, old| mask.select(new, old));
        hit.color = color.zip(hit.color, |new, old| mask.select(new, old));
    }

    /// Phong: ambient, diffuse, and the light's mirror image.
    #[inline(always)]
    fn lighting(&self, d: V3<F>, hit: &Hit<F>) -> V3<F> {
        let nl = hit.normal.dot(self.light);
        let lit = nl.simd_gt(self.zero);
        let diffuse = lit.select(nl, self.zero);
        let mirrored = hit.normal * (self.two * nl) - self.light;
        let rv = -mirrored.dot(d);
        let mut specular = (lit & rv.simd_gt(self.zero)).select(rv, self.zero);
        for _ in 0..5 {
            specular = specular * specular;
        }
        (hit.color * (self.ambient + self.light_color * diffuse)) + self.light_color * specular
    }
}
