//! The ray/triangle test against exact arithmetic, which shares no code with it: every float is an integer times
//! 2^-149, so that intersections are quotients of integers.

use crate::meshes::{Aim, aimed, icosphere, lattice, room};
use crate::support::random;
use glam::{DVec3, Vec3, Vec3A, Vec3Swizzles};
use num_bigint::BigInt;
use rtbench::math::{Ray, T_MAX};
use rtbench::scene::Scene;
use rtbench::workloads::trace::backend::GivenRay;
use rtbench::workloads::trace::intersect::{TriangleHit, watertight};

/// A ray/triangle test: the one of the program, or a mutant of it.
type Test = dyn Fn(&Ray, [Vec3A; 3]) -> Option<TriangleHit>;

/// Rays that pass every edge at more than this many roundings are compared in full. A rounding is 2^-24 of the largest
/// coordinate difference between origin and corners.
const ROUNDINGS: f64 = 8.0;

type Point = [BigInt; 3];

/// `x * 2^149`.
fn integer(x: f32) -> BigInt {
    let (bits, negative) = (x.to_bits() & 0x7fff_ffff, x.is_sign_negative());
    let (exponent, fraction) = (bits >> 23, bits & 0x007f_ffff);
    assert!(exponent < 255, "{x} is not finite");
    let value = match exponent {
        0 => BigInt::from(fraction),
        _ => BigInt::from(fraction | 0x0080_0000) << (exponent - 1),
    };
    if negative { -value } else { value }
}

fn point(v: Vec3) -> Point {
    v.to_array().map(integer)
}

fn minus(a: &Point, b: &Point) -> Point {
    std::array::from_fn(|i| &a[i] - &b[i])
}

fn cross(a: &Point, b: &Point) -> Point {
    std::array::from_fn(|i| &a[(i + 1) % 3] * &b[(i + 2) % 3] - &a[(i + 2) % 3] * &b[(i + 1) % 3])
}

fn dot(a: &Point, b: &Point) -> BigInt {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

/// The nearest float of a quotient.
fn quotient(a: &BigInt, b: &BigInt) -> f64 {
    let shift = a.bits().max(b.bits()).saturating_sub(900);
    let float = |x: &BigInt| (x >> shift).to_string().parse::<f64>().unwrap();
    float(a) / float(b)
}

/// The exact hit: `Some` where the ray's line meets the closed triangle at `t > 0` and is not parallel to its plane.
fn exact(ray: &GivenRay, corners: [Vec3; 3]) -> Option<[f64; 3]> {
    let zero = BigInt::ZERO;
    let (origin, direction) = (point(ray.origin), point(ray.direction));
    let [a, b, c] = corners.map(point);
    let (e1, e2, s) = (minus(&b, &a), minus(&c, &a), minus(&origin, &a));
    let (p, q) = (cross(&direction, &e2), cross(&s, &e1));
    let (mut det, mut u, mut v, mut t) = (dot(&e1, &p), dot(&s, &p), dot(&direction, &q), dot(&e2, &q));
    if det < zero {
        (det, u, v, t) = (-det, -u, -v, -t);
    }
    let hit = det > zero && u >= zero && v >= zero && &u + &v <= det && t > zero;
    hit.then(|| [quotient(&t, &det), quotient(&u, &det), quotient(&v, &det)])
}

/// How a ray passes a triangle, in doubles, across the ray's largest component.
struct Passage {
    /// Distance to the nearest edge line, positive inside, in roundings.
    clearance: f64,
    /// A rounding over the triangle's smallest height: the error of a barycentric coordinate.
    error: f64,
}

fn passage(ray: &GivenRay, corners: [Vec3; 3]) -> Passage {
    let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let k = (0..3).max_by(|&a, &b| d[a].abs().total_cmp(&d[b].abs())).unwrap();
    let (i, j) = ((k + 1) % 3, (k + 2) % 3);
    let mut reach: f64 = 0.0;
    let q = corners.map(|corner| {
        let s: DVec3 = corner.as_dvec3() - o;
        reach = reach.max(s.abs().max_element());
        [s[i] - d[i] / d[k] * s[k], s[j] - d[j] / d[k] * s[k]]
    });
    let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
    let less = |a: [f64; 2], b: [f64; 2]| [a[0] - b[0], a[1] - b[1]];
    let area = cross(less(q[1], q[0]), less(q[2], q[0]));
    let rounding = reach * 2.0_f64.powi(-24);
    let (mut clearance, mut longest) = (f64::INFINITY, 0.0_f64);
    for (a, b) in [(q[0], q[1]), (q[1], q[2]), (q[2], q[0])] {
        let edge = less(b, a);
        let length = edge[0].hypot(edge[1]);
        longest = longest.max(length);
        clearance = clearance.min(cross(a, b) * area.signum() / length / rounding);
    }
    Passage { clearance, error: rounding * longest / area.abs() }
}

/// Compares a test with exact arithmetic over all rays; what is wrong, one line each. In a `closed` mesh every ray that
/// starts inside must hit.
fn faults(test: &Test, scene: &Scene, rays: &[GivenRay], closed: bool) -> Vec<String> {
    let mut faults = Vec::new();
    for given in rays {
        let ray = Ray::new(given.origin.into(), given.direction.into());
        let mut any = false;
        for triangle in 0..scene.triangles.len() as u32 {
            let corners = scene.corners(triangle).map(Vec3::from);
            let found = test(&ray, corners.map(Vec3A::from));
            any |= found.is_some();
            let passage = passage(given, corners);
            if passage.clearance < -ROUNDINGS && found.is_none() {
                continue; // both say so, and doubles are exact enough for that
            }
            if !(passage.clearance.abs() > ROUNDINGS) {
                continue; // too near an edge, or edge-on: only `any` counts
            }
            let exact = exact(given, corners);
            let fault = match (exact, found) {
                (None, None) => continue,
                (Some(_), None) => "lost".to_owned(),
                (None, Some(hit)) => format!("found {hit:?} outside"),
                (Some([t, u, v]), Some(hit)) => {
                    let distances = corners.map(|c| (c.as_dvec3() - given.origin.as_dvec3()).length());
                    let range = distances.iter().fold(0.0, |most: f64, d| most.max((d - distances[0]).abs()));
                    let weight = 8.0 * passage.error + 1e-6;
                    let far = (f64::from(hit.t) - t).abs()
                        > 1e-5 * t + 2.0 * weight * range / given.direction.as_dvec3().length();
                    let off = |a: f32, b: f64| (f64::from(a) - b).abs() > weight;
                    if !far && !off(hit.u, u) && !off(hit.v, v) {
                        continue;
                    }
                    format!("found {hit:?}, exactly t {t} u {u} v {v}")
                }
            };
            faults.push(format!("{given:?} triangle {triangle} {corners:?}: {fault}"));
        }
        if closed && !any {
            faults.push(format!("{given:?}: no triangle of a closed mesh is hit"));
        }
    }
    faults
}

/// Meshes with rays, and whether every ray must hit.
fn cases(count: usize) -> Vec<(Scene, Vec<GivenRay>, bool)> {
    let mut cases = Vec::new();
    let center = Vec3::new(0.25, -0.5, 0.125);
    for mesh in [icosphere(1, center, 1.0), room(3, Vec3::new(1.0, 0.5, 2.0)), room(1, Vec3::new(30.0, 1.0, 1.0))] {
        for aim in [Aim::Vertex, Aim::Edge, Aim::Face] {
            let middle = mesh.bounds().center();
            for (distance, closed) in [(0.3, true), (50.0, false)] {
                let rays = aimed(&mesh, aim, (middle, distance), count, 5);
                cases.push((mesh.clone(), rays, closed));
            }
        }
    }
    // Along axes and in lattice planes
    let mesh = lattice(60, 6, 9);
    let mut random = random(3);
    let mut whole = || (random() * 6.0).round();
    let rays = (0..count)
        .map(|_| GivenRay {
            origin: Vec3::new(whole(), whole(), whole()) * 2.0,
            direction: Vec3::new(whole(), whole(), whole()),
        })
        .filter(|ray| ray.direction != Vec3::ZERO)
        .collect();
    cases.push((mesh, rays, false));
    cases
}

#[test]
fn the_test_agrees_with_exact_arithmetic() {
    let test = |ray: &Ray, corners: [Vec3A; 3]| watertight::intersect(ray, corners, T_MAX);
    let mut compared = 0;
    for (scene, rays, closed) in cases(400) {
        let faults = faults(&test, &scene, &rays, closed);
        assert!(faults.is_empty(), "{}: {} faults, the first: {}", scene.name, faults.len(), faults[0]);
        compared += rays.len() * scene.triangles.len();
    }
    assert!(compared > 100_000, "only {compared} pairs compared");
}

/// A way to get the test wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Mutation {
    None,
    /// Edges belong to no triangle.
    Strict,
    /// One of the two products of an edge function is not rounded.
    Fused,
    /// The second corner's position is rounded once, at the end.
    CornerApart,
    /// Triangles seen from the back are missed.
    BackFacesCulled,
    /// The weights of the second and the third corner change places.
    WeightsSwapped,
}

/// The test of [`watertight`] once more, with a mutation.
fn mutant(ray: &Ray, corners: [Vec3A; 3], mutation: Mutation) -> Option<TriangleHit> {
    let p = corners.map(|corner| (corner - ray.origin) * ray.inv_direction);
    let k = ray.major;
    let mut q = p.map(|p| p * ray.scale - Vec3A::splat(p[k]) * ray.shear);
    if mutation == Mutation::CornerApart {
        let [s, inv, scale, shear] =
            [corners[1] - ray.origin, ray.inv_direction, ray.scale, ray.shear].map(|v| Vec3::from(v).as_dvec3());
        q[1] = (s * inv * scale - shear * (s[k] * inv[k])).as_vec3a();
    }
    let side = |b: Vec3A, c: Vec3A| {
        let (p, q) = (b.yzx() * c.zxy(), b.zxy() * c.yzx());
        let signed = match mutation {
            Mutation::Fused => Vec3A::from_array(std::array::from_fn(|i| b.yzx()[i].mul_add(c.zxy()[i], -q[i]))),
            _ => p - q,
        };
        (p, q, signed)
    };
    let sides = [side(q[1], q[2]), side(q[2], q[0]), side(q[0], q[1])];
    let (positive, negative) = match mutation {
        Mutation::Strict => (sides.iter().all(|s| s.0[k] > s.1[k]), sides.iter().all(|s| s.0[k] < s.1[k])),
        Mutation::Fused => (sides.iter().all(|s| s.2[k] >= 0.0), sides.iter().all(|s| s.2[k] <= 0.0)),
        _ => (sides.iter().all(|s| s.0[k] >= s.1[k]), sides.iter().all(|s| s.0[k] <= s.1[k])),
    };
    if positive == negative || (mutation == Mutation::BackFacesCulled && positive) {
        return None;
    }
    let near = (p[0].min(p[1]).min(p[2]) - ray.slack).max_element();
    let far = (p[0].max(p[1]).max(p[2]) + ray.slack).min_element();
    let e = sides.map(|s| s.2[k]);
    let sum = e[0] + e[1] + e[2];
    let scale = 1.0 / if sum == 0.0 { 1.0 } else { sum };
    let t = ((e[0] * p[0][k] + e[1] * p[1][k] + e[2] * p[2][k]) * scale).max(near).min(far);
    let (u, v) = if mutation == Mutation::WeightsSwapped { (e[2], e[1]) } else { (e[1], e[2]) };
    (near <= far && t > 0.0).then_some(TriangleHit { t, u: u * scale, v: v * scale, w: e[0] * scale })
}

#[test]
fn every_mutant_of_the_test_is_found() {
    let is_found = |mutation| {
        let test = move |ray: &Ray, corners: [Vec3A; 3]| mutant(ray, corners, mutation);
        cases(2_000).iter().any(|(scene, rays, closed)| !faults(&test, scene, rays, *closed).is_empty())
    };
    assert!(!is_found(Mutation::None), "the copy without a mutation has faults");
    for mutation in
        [Mutation::Strict, Mutation::Fused, Mutation::CornerApart, Mutation::BackFacesCulled, Mutation::WeightsSwapped]
    {
        assert!(is_found(mutation), "{mutation:?} is not found");
    }
}

/// The copy that is mutated is the test of the program.
#[test]
fn the_copy_without_a_mutation_is_the_test() {
    for (scene, rays, _) in cases(50) {
        for given in &rays {
            let ray = Ray::new(given.origin.into(), given.direction.into());
            for triangle in 0..scene.triangles.len() as u32 {
                let corners = scene.corners(triangle);
                let expected = watertight::intersect(&ray, corners, T_MAX);
                assert_eq!(mutant(&ray, corners, Mutation::None), expected, "{given:?} triangle {triangle}");
            }
        }
    }
}
