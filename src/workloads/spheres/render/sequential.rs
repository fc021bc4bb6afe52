//! One pixel at a time.

use super::super::scene::PackedSphere;
use super::super::view::View;
use super::mode::{Mode, by_mode};
use super::probe::{Exit, Probe};
use super::{Band, Job};
use glam::Vec3;

/// What is kept of a hit. Where a search misses it keeps its values, and the next ray is made from them all the same.
#[derive(Clone, Copy)]
struct Hit {
    position: Vec3,
    normal: Vec3,
    color: Vec3,
}

/// A trip of a path, for the way back.
#[derive(Clone, Copy)]
struct Step {
    direction: Vec3,
    hit: Hit,
    live: bool,
}

/// Renders a band of rows.
pub fn rows<P: Probe>(job: &Job, band: Band, probe: &mut P) {
    by_mode!(P::WATCHES, &job.options, mode => rows_by(job, band, probe, mode))
}

#[inline(always)]
fn rows_by<P: Probe, M: Mode>(job: &Job, band: Band, probe: &mut P, mode: M) {
    let Job { spheres, view, options } = *job;
    let zero = Hit { position: view.origin, normal: Vec3::ZERO, color: Vec3::ZERO };
    let mut steps = vec![Step { direction: Vec3::ZERO, hit: zero, live: false }; view.trips as usize];
    let width = view.width as usize;
    for (at, pixel) in band.image.iter_mut().enumerate() {
        let (mut origin, mut d) = (view.origin, primary(view, at % width, band.first_row + at / width));
        let (mut hit, mut live, mut hits) = (zero, true, 0);
        let (mut color, mut throughput) = (Vec3::ZERO, Vec3::splat(view.one));
        let mut made = 0;
        for step in &mut steps {
            let found = search(spheres, view, origin, d, &mut hit, mode.in_loop());
            probe.searched(1);
            live &= found;
            hits += u32::from(live);
            made += 1;
            if mode.two_pass() {
                *step = Step { direction: d, hit, live };
            } else if live {
                color += throughput * lighting(view, d, &hit);
                throughput *= hit.color * view.intensity;
            }
            if !live && options.exit_on_miss {
                if made < view.trips {
                    probe.exited(Exit::Miss);
                }
                break;
            }
            let dn = dot(d, hit.normal);
            d -= hit.normal * (view.two * dn);
            d /= dot(d, d).sqrt();
            origin = hit.position;
        }
        if mode.two_pass() {
            // Stores that nothing reads would be left out, and with them what is to be measured
            let steps = &*std::hint::black_box(&mut steps);
            for step in steps.iter().take(made as usize).rev().filter(|step| step.live) {
                color = ((color * view.intensity) * step.hit.color) + lighting(view, step.direction, &step.hit);
            }
        }
        *pixel = [color.x, color.y, color.z, 1.0];
        probe.pixel(at, hits);
    }
}

#[inline(always)]
fn dot(a: Vec3, b: Vec3) -> f32 {
    (a.x * b.x + a.y * b.y) + a.z * b.z
}

/// The direction of a pixel's first ray.
#[inline(always)]
fn primary(view: &View, x: usize, y: usize) -> Vec3 {
    let (px, py) = (x as f32 + view.half, y as f32 + view.half);
    let d = (view.corner + view.right * px) + view.down * py;
    d / dot(d, d).sqrt()
}

/// True where the ray hits; then `hit` is the nearest one.
#[inline(always)]
fn search(spheres: &[PackedSphere], view: &View, origin: Vec3, d: Vec3, hit: &mut Hit, in_loop: bool) -> bool {
    let a = dot(d, d);
    let mut best = view.far;
    let mut nearest = None;
    for sphere in spheres {
        let oc = sphere.center - origin;
        let b = dot(oc, d);
        let q = dot(oc, oc) - sphere.radius2;
        let discriminant = b * b - a * q;
        if discriminant > 0.0 {
            let root = discriminant.sqrt();
            let mut t = (b - root) / a;
            if !(t > view.epsilon) {
                t = (b + root) / a;
            }
            if t > view.epsilon && t < best {
                best = t;
                nearest = Some(sphere);
                if in_loop {
                    *hit = record(origin, d, t, sphere);
                }
            }
        }
    }
    match nearest {
        Some(sphere) => {
            if !in_loop {
                *hit = record(origin, d, best, sphere);
            }
            true
        }
        None => false,
    }
}

#[inline(always)]
fn record(origin: Vec3, d: Vec3, t: f32, sphere: &PackedSphere) -> Hit {
    let position = origin + d * t;
    let normal = position - sphere.center;
    Hit { position, normal: normal / dot(normal, normal).sqrt(), color: sphere.color }
}

/// Phong: ambient, diffuse, and the light's mirror image.
#[inline(always)]
fn lighting(view: &View, d: Vec3, hit: &Hit) -> Vec3 {
    let nl = dot(hit.normal, view.light);
    let lit = nl > 0.0;
    let diffuse = if lit { nl } else { 0.0 };
    let mirrored = hit.normal * (view.two * nl) - view.light;
    let rv = -dot(mirrored, d);
    let mut specular = if lit && rv > 0.0 { rv } else { 0.0 };
    for _ in 0..5 {
        specular *= specular;
    }
    (hit.color * (view.ambient + view.light_color * diffuse)) + view.light_color * specular
}
