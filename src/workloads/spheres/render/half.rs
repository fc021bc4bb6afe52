//! The picture in half precision: every input and the result of every operation is rounded to 16 bits.
//!
//! The operations themselves are single precision's, which has more than twice the digits: rounding a sum, product,
//! quotient or root twice gives what rounding it once does.

use super::super::options::Algorithm;
use super::super::scene::PackedSphere;
use super::super::view::View;
use super::vector::V3;
use glam::Vec3;
use half::f16;
use std::ops::Range;

type Half = V3<f16>;

/// The view, rounded. `far` becomes infinite.
struct HalfView {
    origin: Half,
    corner: Half,
    right: Half,
    down: Half,
    light: Half,
    light_color: Half,
    ambient: Half,
    epsilon: f16,
    intensity: f16,
    half: f16,
    two: f16,
    far: f16,
}

/// A sphere, rounded.
struct HalfSphere {
    center: Half,
    radius2: f16,
    color: Half,
}

/// A live hit, for the way back.
struct Step {
    direction: Half,
    normal: Half,
    color: Half,
}

/// Linear RGBA, rows from the top. A colour that overflowed is infinite or NaN.
pub fn render(spheres: &[PackedSphere], view: &View, algorithm: Algorithm) -> Vec<[f32; 4]> {
    rows(spheres, view, algorithm, 0..view.height)
}

/// Some rows of the picture.
pub fn rows(spheres: &[PackedSphere], view: &View, algorithm: Algorithm, rows: Range<u32>) -> Vec<[f32; 4]> {
    let sphere = |s: &PackedSphere| HalfSphere {
        center: rounded(s.center),
        radius2: f16::from_f32(s.radius2),
        color: rounded(s.color),
    };
    let spheres: Vec<HalfSphere> = spheres.iter().map(sphere).collect();
    let half = HalfView::new(view);
    let pixels = rows.flat_map(|y| (0..view.width).map(move |x| (x, y)));
    let color = |(x, y)| {
        let c = half.pixel(&spheres, x, y, view.trips, algorithm).map_to(f16::to_f32);
        [c[0], c[1], c[2], 1.0]
    };
    pixels.map(color).collect()
}

fn rounded(v: Vec3) -> Half {
    V3 { x: f16::from_f32(v.x), y: f16::from_f32(v.y), z: f16::from_f32(v.z) }
}

fn root(x: f16) -> f16 {
    f16::from_f32(x.to_f32().sqrt())
}

fn normalized(v: Half) -> Half {
    v / root(v.dot(v))
}

impl Half {
    fn map_to<T>(self, f: impl Fn(f16) -> T) -> [T; 3] {
        [f(self.x), f(self.y), f(self.z)]
    }
}

impl HalfView {
    fn new(view: &View) -> HalfView {
        HalfView {
            origin: rounded(view.origin),
            corner: rounded(view.corner),
            right: rounded(view.right),
            down: rounded(view.down),
            light: rounded(view.light),
            light_color: rounded(view.light_color),
            ambient: rounded(view.ambient),
            epsilon: f16::from_f32(view.epsilon),
            intensity: f16::from_f32(view.intensity),
            half: f16::from_f32(view.half),
            two: f16::from_f32(view.two),
            far: f16::from_f32(view.far),
        }
    }

    /// A path ends at its first miss: dead paths do not show.
    fn pixel(&self, spheres: &[HalfSphere], x: u32, y: u32, trips: u32, algorithm: Algorithm) -> Half {
        let (px, py) = (f16::from_f32(x as f32) + self.half, f16::from_f32(y as f32) + self.half);
        let mut direction = normalized((self.corner + self.right * px) + self.down * py);
        let mut origin = self.origin;
        let black = rounded(Vec3::ZERO);
        let (mut color, mut throughput) = (black, rounded(Vec3::ONE));
        let mut steps = Vec::new();
        for _ in 0..trips {
            let Some((t, sphere)) = self.nearest(spheres, origin, direction) else {
                break;
            };
            let position = origin + direction * t;
            let step = Step { direction, normal: normalized(position - sphere.center), color: sphere.color };
            let dn = direction.dot(step.normal);
            direction = normalized(direction - step.normal * (self.two * dn));
            origin = position;
            if algorithm == Algorithm::OnePass {
                color = color + throughput * self.lighting(&step);
                throughput = throughput * (step.color * self.intensity);
            }
            steps.push(step);
        }
        if algorithm == Algorithm::TwoPass {
            for step in steps.iter().rev() {
                color = ((color * self.intensity) * step.color) + self.lighting(step);
            }
        }
        color
    }

    fn nearest<'s>(&self, spheres: &'s [HalfSphere], origin: Half, d: Half) -> Option<(f16, &'s HalfSphere)> {
        let a = d.dot(d);
        let (mut best, mut nearest) = (self.far, None);
        for sphere in spheres {
            let oc = sphere.center - origin;
            let b = oc.dot(d);
            let q = oc.dot(oc) - sphere.radius2;
            let discriminant = b * b - a * q;
            if discriminant > f16::ZERO {
                let s = root(discriminant);
                let mut t = (b - s) / a;
                if !(t > self.epsilon) {
                    t = (b + s) / a;
                }
                if t > self.epsilon && t < best {
                    best = t;
                    nearest = Some((t, sphere));
                }
            }
        }
        nearest
    }

    fn lighting(&self, step: &Step) -> Half {
        let nl = step.normal.dot(self.light);
        let lit = nl > f16::ZERO;
        let diffuse = if lit { nl } else { f16::ZERO };
        let mirrored = step.normal * (self.two * nl) - self.light;
        let rv = -mirrored.dot(step.direction);
        let mut specular = if lit && rv > f16::ZERO { rv } else { f16::ZERO };
        for _ in 0..5 {
            specular = specular * specular;
        }
        (step.color * (self.ambient + self.light_color * diffuse)) + self.light_color * specular
    }
}
