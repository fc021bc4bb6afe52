//! Random scenes: `random:spheres=N,seed=S`. All random numbers are integers of SplitMix64, and what is computed from
//! them is rounded to four digits after the point, so that a scene has the same bits on every machine.

use super::{Camera, Light, MAX_SPHERES, Scene, Sphere};
use crate::error::{Error, Result};
use crate::scene::did_you_mean;
use glam::{DVec3, Vec3};

/// The name before the options.
pub const NAME: &str = "random";

/// Radius and half height of the cylinder that holds all spheres, whatever their number is: more spheres are smaller.
/// The diagonal of its box is 20.
const RADIUS: f64 = 6.6;
const HALF_HEIGHT: f64 = 3.6;

/// The radii at first, in units of the side of the cube that a sphere has on average.
const SMALLEST: f64 = 0.24;
const LARGEST: f64 = 0.55;

/// SplitMix64, by Steele, Lea and Flood (2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A whole number from 0 to below `n`.
    fn below(&mut self, n: usize) -> usize {
        ((u128::from(self.next()) * n as u128) >> 64) as usize
    }

    /// A number from `from` to below `to`.
    fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * ((self.next() >> 11) as f64 / (1_u64 << 53) as f64)
    }
}

/// The scene of this name, options included.
pub fn load(spec: &str) -> Result<Scene> {
    let (spheres, seed) = parse(spec)?;
    Ok(generate(spheres, seed))
}

/// Number of spheres and seed.
fn parse(spec: &str) -> Result<(usize, u64)> {
    const KEYS: [&str; 2] = ["spheres", "seed"];
    const EXAMPLE: &str = "write for instance random:spheres=100,seed=1";
    let (_, settings) = spec.split_once(':').unwrap_or((spec, "spheres=100"));
    let mut values: [Option<u64>; 2] = [None; 2];
    for setting in settings.split(',') {
        let Some((key, text)) = setting.split_once('=').map(|(key, text)| (key.trim(), text.trim())) else {
            return Err(Error::argument(spec, format!("`{setting}` is not of the form key=value"), EXAMPLE));
        };
        let Some(index) = KEYS.iter().position(|known| *known == key) else {
            let problem = format!("random scenes have no option `{key}`");
            return Err(Error::argument(spec, problem, did_you_mean(key, &KEYS)));
        };
        let Ok(value) = text.parse() else {
            let hint = ["give a number from 1 to 100000", "give a number from 0 to 2^64 - 1"][index];
            return Err(Error::argument(spec, format!("{key}: `{text}` is not such a whole number"), hint));
        };
        if values[index].replace(value).is_some() {
            return Err(Error::argument(spec, format!("{key} is given twice"), "give it once"));
        }
    }
    match values {
        [Some(spheres), seed] if (1..=MAX_SPHERES as u64).contains(&spheres) => {
            Ok((spheres as usize, seed.unwrap_or(1)))
        }
        [Some(spheres), _] => {
            let problem = format!("spheres={spheres} is out of range");
            Err(Error::argument(spec, problem, "a scene has 1 to 100000 spheres"))
        }
        [None, _] => Err(Error::argument(spec, "the number of spheres is missing", EXAMPLE)),
    }
}

/// Four digits after the point.
fn rounded(x: f64) -> f64 {
    (x * 1e4).round() / 1e4
}

/// The spheres placed so far, by the cubic cell of their centres, so that few are compared.
struct Placed {
    cell: f64,
    side: usize,
    cells: Vec<Vec<u32>>,
    spheres: Vec<([f64; 3], f64)>,
}

impl Placed {
    /// `cell` is at least twice the largest radius.
    fn new(cell: f64) -> Placed {
        let side = (2.0 * RADIUS / cell) as usize + 1;
        Placed { cell, side, cells: vec![Vec::new(); side * side * side], spheres: Vec::new() }
    }

    fn coordinates(&self, place: [f64; 3]) -> [usize; 3] {
        place.map(|x| (((x + RADIUS) / self.cell) as usize).min(self.side - 1))
    }

    /// Adds a sphere unless it meets another one.
    fn add(&mut self, place: [f64; 3], radius: f64) -> bool {
        let [x, y, z] = self.coordinates(place);
        let near = |c: usize| c.saturating_sub(1)..=(c + 1).min(self.side - 1);
        let index = |x: usize, y: usize, z: usize| (x * self.side + y) * self.side + z;
        let cells = near(x).flat_map(|x| near(y).flat_map(move |y| near(z).map(move |z| (x, y, z))));
        let meets = |&other: &u32| {
            let (center, other) = self.spheres[other as usize];
            let [x, y, z] = [0, 1, 2].map(|axis| center[axis] - place[axis]);
            x * x + y * y + z * z < (radius + other) * (radius + other)
        };
        if cells.into_iter().any(|(x, y, z)| self.cells[index(x, y, z)].iter().any(meets)) {
            return false;
        }
        let cell = index(x, y, z);
        self.cells[cell].push(self.spheres.len() as u32);
        self.spheres.push((place, radius));
        true
    }
}

/// Spheres at random places of an upright cylinder, none of which meets another one: those that find no place become
/// smaller.
fn generate(count: usize, seed: u64) -> Scene {
    let mut random = Random(seed);
    let size = libm::cbrt(4.0 * RADIUS * RADIUS * 2.0 * HALF_HEIGHT / count as f64).min(5.5);
    let mut placed = Placed::new(LARGEST * size * 2.0 + 0.001);
    let mut spheres = Vec::with_capacity(count);
    for _ in 0..count {
        let mut radius = rounded(size * random.between(SMALLEST, LARGEST));
        let place = loop {
            let [x, z] = [0, 1].map(|_| rounded(random.between(radius - RADIUS, RADIUS - radius)));
            let y = rounded(random.between(radius - HALF_HEIGHT, HALF_HEIGHT - radius));
            let inside = x * x + z * z <= (RADIUS - radius) * (RADIUS - radius);
            if inside && placed.add([x, y, z], radius) {
                break Vec3::new(x as f32, y as f32, z as f32);
            }
            radius = rounded((radius * 0.99).max(0.0001));
        };
        spheres.push(Sphere { position: place, radius: radius as f32, color: colour(&mut random) });
    }
    let camera = Camera {
        position: DVec3::new(0.0, 4.5, 18.0),
        forward: DVec3::new(0.0, -0.25, -1.0),
        fov: 32.0,
        focus_point: DVec3::ZERO,
        orbit_velocity: 0.5,
    };
    let light = Light { direction: DVec3::new(-0.6, -1.0, -0.5), color: Vec3::splat(0.8), ambient: Vec3::splat(0.15) };
    let name = format!("{NAME}:spheres={count},seed={seed}");
    Scene::new(&name, camera, light, (super::file::INTENSITY, super::file::EPSILON), spheres)
}

/// A bright colour: one component is large, one is small, and the third one is anything between.
fn colour(random: &mut Random) -> Vec3 {
    let components = [0.95, rounded(random.between(0.2, 0.95)) as f32, 0.2];
    let first = random.below(3);
    let second = (first + 1 + random.below(2)) % 3;
    let third = 3 - first - second;
    Vec3::new(components[first], components[second], components[third])
}
