//! Random scenes: `random:spheres=N,seed=S`. All random numbers are integers of SplitMix64, and what is computed from
//! them is rounded to four digits after the point, so that a scene has the same bits on every machine.

use super::{Camera, Light, MAX_SPHERES, Scene, Sphere};
use crate::error::{Error, Result};
use crate::scene::did_you_mean;
use glam::{DVec3, Vec3};

/// The name before the options.
pub const NAME: &str = "random";

/// The diagonal of the cube that holds all spheres, whatever their number is: more spheres are smaller.
const DIAGONAL: f64 = 20.0;

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

/// Spheres in different cells of a lattice of at least twice as many cells, none of which leaves its cell.
fn generate(count: usize, seed: u64) -> Scene {
    let mut random = Random(seed);
    let side = (1..).find(|n| n * n * n >= 2 * count).unwrap_or(1);
    let size = DIAGONAL / 3_f64.sqrt() / side as f64;
    let mut cells: Vec<u32> = (0..(side * side * side) as u32).collect();
    let mut spheres = Vec::with_capacity(count);
    for index in 0..count {
        let other = index + random.below(cells.len() - index);
        cells.swap(index, other);
        let cell = cells[index] as usize;
        let radius = size * random.between(0.26, 0.48);
        let mut along = |cell: usize| {
            let free = 0.5 * size - radius;
            rounded((cell as f64 + 0.5 - 0.5 * side as f64) * size + random.between(-free, free)) as f32
        };
        let position = Vec3::new(along(cell % side), along(cell / side % side), along(cell / side / side));
        spheres.push(Sphere { position, radius: rounded(radius) as f32, color: colour(&mut random) });
    }
    let camera = Camera {
        position: DVec3::new(0.0, 5.0, 20.0),
        forward: DVec3::new(0.0, -0.25, -1.0),
        fov: 40.0,
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
