//! Random numbers by counting, and unit vectors made of them. Twin of `kernels/lib/random.wgsl` and
//! `kernels/lib/cosine_direction.wgsl`.
//!
//! The generator is pcg4d of M. Jarzynski and M. Olano, "Hash Functions for GPU Rendering" (2020): integers only, so
//! that every device draws the same.

use glam::Vec3A;

/// Most calls of the hash for a unit vector; each has two candidates, of which 0.785 are inside the circle.
const DRAWS: u32 = 16;

/// Four words of the hash of four words.
pub fn pcg4d(key: [u32; 4]) -> [u32; 4] {
    let mut v = key.map(|word| word.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    stir(&mut v);
    v = v.map(|word| word ^ (word >> 16));
    stir(&mut v);
    v
}

fn stir([x, y, z, w]: &mut [u32; 4]) {
    *x = x.wrapping_add(y.wrapping_mul(*w));
    *y = y.wrapping_add(z.wrapping_mul(*x));
    *z = z.wrapping_add(x.wrapping_mul(*y));
    *w = w.wrapping_add(y.wrapping_mul(*z));
}

/// A number in [-1, 1) with 24 bits; no operation rounds.
fn signed(word: u32) -> f32 {
    (word >> 8) as f32 * (1.0 / 8_388_608.0) - 1.0
}

/// A vector of unit length, uniform over the sphere, after G. Marsaglia, "Choosing a Point from the Surface of a
/// Sphere" (1972). `path` and `bounce` count the vectors of a seed in two ways, such as hits along a path, or samples
/// of a pixel.
pub fn unit_vector(seed: u32, path: u32, bounce: u32) -> Vec3A {
    for draw in 0..DRAWS {
        let [x, y, z, w] = pcg4d([seed, path, bounce, draw]).map(signed);
        for (a, b) in [(x, y), (z, w)] {
            let s = a * a + b * b;
            if s < 1.0 {
                let root = (1.0 - s).sqrt();
                return Vec3A::new(2.0 * a * root, 2.0 * b * root, 1.0 - 2.0 * s);
            }
        }
    }
    Vec3A::Z
}

/// A direction over the hemisphere around a unit normal, distributed as the cosine: the normal plus a vector that is
/// uniform over the sphere, with unit length.
pub fn cosine_direction(normal: Vec3A, vector: Vec3A) -> Vec3A {
    let sum = normal + vector;
    let square = sum.dot(sum);
    if square < 1.0e-12 { normal } else { sum / square.sqrt() }
}
