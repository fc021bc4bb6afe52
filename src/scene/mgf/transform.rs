//! Transforms with arrays, such as `-t 1 0 0 -a 5 -rz 30 -i 1 -s 2`.

use crate::scene::text::{Fault, number, odd, quote_bytes};
use glam::{DAffine3, DMat3, DVec3};

/// The largest number of instances of one transform.
const MAX_COPIES: usize = 100_000;

/// Parses an argument as a finite number.
pub fn number_of(word: &[u8]) -> Result<f64, Fault> {
    match any_number_of(word) {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(Fault::new(None, format!("{} is not a finite number", quote_bytes(word)), "")),
    }
}

/// Parses an argument as a number that need not be finite.
pub fn any_number_of(word: &[u8]) -> Result<f64, Fault> {
    match number::double(word) {
        Some((value, length)) if length == word.len() => Ok(value),
        _ => odd::value(word)
            .ok_or_else(|| Fault::new(None, format!("{} is not a finite number", quote_bytes(word)), "")),
    }
}

/// A sequence of arguments that is applied repeatedly.
struct Repeat {
    transform: DAffine3,
    times: usize,
    /// True for an array, in which copy `i` is transformed `i` times; false if everything is transformed `times` times.
    array: bool,
}

/// The transforms of all instances of an `xf` or an include.
pub struct InstanceTransforms {
    /// Arrays of one copy are omitted, since they have no effect, and adjacent repeats that are not arrays are merged.
    /// So there are few repeats even for a very long line.
    repeats: Vec<Repeat>,
    count: usize,
}

impl InstanceTransforms {
    /// Parses the arguments of `xf`, or those after the file name of an include. Without arrays there is one instance.
    pub fn new(arguments: &[&[u8]]) -> Result<InstanceTransforms, Fault> {
        let mut instances = InstanceTransforms { repeats: Vec::new(), count: 1 };
        let mut repeat = Repeat { transform: DAffine3::IDENTITY, times: 1, array: false };
        let mut rest = arguments.iter();
        while let Some(&option) = rest.next() {
            let mut number = || -> Result<f64, Fault> {
                let end = || Fault::new(None, format!("{} needs more numbers", quote_bytes(option)), "");
                number_of(rest.next().ok_or_else(end)?)
            };
            let step = match option {
                b"-t" => DAffine3::from_translation(DVec3::new(number()?, number()?, number()?)),
                b"-rx" => DAffine3::from_mat3(DMat3::from_rotation_x(number()?.to_radians())),
                b"-ry" => DAffine3::from_mat3(DMat3::from_rotation_y(number()?.to_radians())),
                b"-rz" => DAffine3::from_mat3(DMat3::from_rotation_z(number()?.to_radians())),
                b"-s" => DAffine3::from_scale(DVec3::splat(number()?)),
                b"-mx" => DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0)),
                b"-my" => DAffine3::from_scale(DVec3::new(1.0, -1.0, 1.0)),
                b"-mz" => DAffine3::from_scale(DVec3::new(1.0, 1.0, -1.0)),
                b"-a" | b"-i" => {
                    let count = number()?;
                    if !(count >= 0.0 && count <= MAX_COPIES as f64 && count.fract() == 0.0) {
                        let problem = format!("{} {count}: this is not a number of copies", quote_bytes(option));
                        return Err(Fault::new(None, problem, format!("give 0 to {MAX_COPIES}")));
                    }
                    instances.add(repeat)?;
                    repeat = Repeat { transform: DAffine3::IDENTITY, times: count as usize, array: option == b"-a" };
                    continue;
                }
                other => {
                    let hint = "options are -t, -rx, -ry, -rz, -s, -mx, -my, -mz, -i and -a";
                    return Err(Fault::new(None, format!("{} is not a part of a transform", quote_bytes(other)), hint));
                }
            };
            repeat.transform = step * repeat.transform;
        }
        instances.add(repeat)?;
        Ok(instances)
    }

    fn add(&mut self, Repeat { transform, times, array }: Repeat) -> Result<(), Fault> {
        if array {
            self.count = self.count.saturating_mul(times);
            if self.count > MAX_COPIES {
                return Err(Fault::new(
                    None,
                    format!("there are more than {MAX_COPIES} copies"),
                    "reduce the repetitions",
                ));
            }
            if times != 1 {
                self.repeats.push(Repeat { transform, times, array });
            }
            return Ok(());
        }
        let power = power(transform, times);
        match self.repeats.last_mut().filter(|last| !last.array) {
            Some(last) => last.transform = power * last.transform,
            None => self.repeats.push(Repeat { transform: power, times: 1, array }),
        }
        Ok(())
    }

    /// Memory of all transforms in bytes.
    pub fn bytes(&self) -> usize {
        self.count * size_of::<DAffine3>()
    }

    /// All transforms; the copies of the first array are adjacent.
    pub fn all(&self) -> Vec<DAffine3> {
        if self.count == 0 {
            return Vec::new();
        }
        let mut places = vec![DAffine3::IDENTITY];
        for &Repeat { transform, times, array } in &self.repeats {
            if array {
                let mut all = Vec::with_capacity(places.len() * times);
                for _ in 0..times {
                    all.extend_from_slice(&places);
                    places.iter_mut().for_each(|place| *place = transform * *place);
                }
                places = all;
            } else {
                places.iter_mut().for_each(|place| *place = transform * *place);
            }
        }
        places
    }
}

/// A power of a transform, by repeated squaring.
fn power(mut base: DAffine3, mut exponent: usize) -> DAffine3 {
    let mut result = DAffine3::IDENTITY;
    while exponent > 0 {
        if exponent % 2 == 1 {
            result = base * result;
        }
        base = base * base;
        exponent /= 2;
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    fn origins(text: &str) -> Vec<[i64; 3]> {
        let words: Vec<&[u8]> = text.split_ascii_whitespace().map(str::as_bytes).collect();
        let round = |v: DVec3| v.to_array().map(|x| (x * 1000.0).round() as i64);
        InstanceTransforms::new(&words)
            .unwrap()
            .all()
            .iter()
            .map(|place| round(place.transform_point3(DVec3::X)))
            .collect()
    }

    #[test]
    fn steps_are_applied_in_order() {
        assert_eq!(origins(""), [[1000, 0, 0]]);
        assert_eq!(origins("-t 1 0 0 -rz 90"), [[0, 2000, 0]]);
        assert_eq!(origins("-rz 90 -t 1 0 0"), [[1000, 1000, 0]]);
        assert_eq!(origins("-rx 20 -ry 90 -s 2 -mz -my"), [[0, 0, 2000]]);
        assert_eq!(origins("-i 3 -t 1 0 0 -i 1 -s 2"), [[8000, 0, 0]]);
        assert_eq!(origins("-i 100000 -rz 1"), [[174, -985, 0]], "280 degrees and full turns");
    }

    #[test]
    fn arrays_multiply_and_their_first_copy_is_not_moved() {
        assert_eq!(origins("-a 3 -t 1 0 0"), [[1000, 0, 0], [2000, 0, 0], [3000, 0, 0]]);
        assert_eq!(
            origins("-t 1 0 0 -a 2 -t 0 1 0 -a 2 -rz 180 -i 1 -t 0 0 5"),
            [[2000, 0, 5000], [2000, 1000, 5000], [-2000, 0, 5000], [-2000, -1000, 5000]]
        );
        assert!(origins("-a 0 -t 1 0 0").is_empty() && origins("-a 5 -t 1 0 0 -a 0").is_empty());
    }

    #[test]
    fn a_long_line_has_few_repeats() {
        let line = "-a 1 -t 1 0 0 -i 1 -mx ".repeat(1001);
        let words: Vec<&[u8]> = line.split_ascii_whitespace().map(str::as_bytes).collect();
        assert_eq!(InstanceTransforms::new(&words).unwrap().repeats.len(), 1);
        assert_eq!(origins(&line), [[-1000, 0, 0]], "mirrored an odd number of times, not moved");
    }

    #[test]
    fn invalid_arguments_are_refused() {
        for text in ["-t 1 0", "-x 1", "-a 1.5", "-a -1", "-a 1e9", "-a 1000 -mx -a 101", "-s nan", "1 0 0", "-i 2e6"] {
            let words: Vec<&[u8]> = text.split_ascii_whitespace().map(str::as_bytes).collect();
            assert!(InstanceTransforms::new(&words).is_err(), "{text}");
        }
    }
}
