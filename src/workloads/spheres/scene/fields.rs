//! Values of a scene's file, each checked where it is read, so that a message has its line.

use super::{MAX_SPHERES, file};
use serde::de::value::MapAccessDeserializer;
use serde::de::{DeserializeOwned, DeserializeSeed, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt::Formatter;
use std::marker::PhantomData;

/// Largest magnitude of a number: products of two differences are single-precision numbers still.
pub const MAX: f64 = 1e18;

/// An object: unlike what is derived, a list of its values in their order is refused.
pub fn object<'de, D: Deserializer<'de>, T: DeserializeOwned>(deserializer: D) -> Result<T, D::Error> {
    struct Object<T>(PhantomData<T>);
    impl<'de, T: DeserializeOwned> Visitor<'de> for Object<T> {
        type Value = T;

        fn expecting(&self, f: &mut Formatter) -> std::fmt::Result {
            f.write_str("an object")
        }

        fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<T, A::Error> {
            T::deserialize(MapAccessDeserializer::new(map))
        }
    }
    deserializer.deserialize_map(Object(PhantomData))
}

/// What is wrong with a number, if anything.
type Check = fn(f64) -> Option<String>;

/// A number that is checked before the reader goes on, so that the message has its line.
struct Number(Check);

impl<'de> DeserializeSeed<'de> for Number {
    type Value = f64;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<f64, D::Error> {
        deserializer.deserialize_f64(self)
    }
}

impl Visitor<'_> for Number {
    type Value = f64;

    fn expecting(&self, f: &mut Formatter) -> std::fmt::Result {
        f.write_str("a number")
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<f64, E> {
        (self.0)(number).map_or(Ok(number), |problem| Err(E::custom(problem)))
    }

    fn visit_u64<E: Error>(self, number: u64) -> Result<f64, E> {
        self.visit_f64(number as f64)
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<f64, E> {
        self.visit_f64(number as f64)
    }
}

/// Three numbers, each of which is checked, and then all of them.
struct Three(Check, fn(&[f64; 3]) -> Option<&'static str>);

impl<'de> Visitor<'de> for Three {
    type Value = [f64; 3];

    fn expecting(&self, f: &mut Formatter) -> std::fmt::Result {
        f.write_str("a list of three numbers")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<[f64; 3], A::Error> {
        let mut vector = [0.0; 3];
        for (index, component) in vector.iter_mut().enumerate() {
            let next = list.next_element_seed(Number(self.0))?;
            *component = next.ok_or_else(|| A::Error::invalid_length(index, &self))?;
        }
        if list.next_element::<IgnoredAny>()?.is_some() {
            return Err(A::Error::custom("there are more than three numbers"));
        }
        (self.1)(&vector).map_or(Ok(vector), |problem| Err(A::Error::custom(problem)))
    }
}

fn within(number: f64) -> Option<String> {
    (number.abs() > MAX).then(|| format!("{number:e} is beyond 1e18"))
}

fn is_share(number: f64) -> Option<String> {
    (!(0.0..=1.0).contains(&number)).then(|| format!("{number:e} is not 0 to 1"))
}

fn is_zero(vector: &[f64; 3]) -> Option<&'static str> {
    (*vector == [0.0; 3]).then_some("the direction is zero")
}

/// A number that single precision has.
pub fn number<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Number(within).deserialize(deserializer)
}

/// Three numbers.
pub fn vector<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[f64; 3], D::Error> {
    deserializer.deserialize_seq(Three(within, |_| None))
}

/// A direction, which is not zero.
pub fn direction<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[f64; 3], D::Error> {
    deserializer.deserialize_seq(Three(within, is_zero))
}

/// A direction in which a camera can look that is upright.
pub fn forward<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[f64; 3], D::Error> {
    let check = |vector: &[f64; 3]| {
        // As the camera computes it, scaled by the largest component
        let largest = vector.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
        let vertical = vector[0] / largest == 0.0 && vector[2] / largest == 0.0;
        is_zero(vector).or(vertical.then_some("the direction is vertical, which is the camera's up axis"))
    };
    deserializer.deserialize_seq(Three(within, check))
}

/// The field of view in degrees.
pub fn fov<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    let check = |fov: f64| {
        let problem = || format!("a field of view of {fov} degrees is not between 0 and 180");
        (!(fov > 0.0 && fov < 180.0)).then(problem)
    };
    Number(check).deserialize(deserializer)
}

/// A share, 0 to 1.
pub fn share<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Number(is_share).deserialize(deserializer)
}

/// Light, which is not negative.
pub fn light<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[f64; 3], D::Error> {
    let check = |x: f64| within(x).or((x < 0.0).then(|| format!("{x:e} is negative; light is 0 or more")));
    deserializer.deserialize_seq(Three(check, |_| None))
}

/// The colour of a surface, which reflects nothing to everything.
pub fn colour<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[f64; 3], D::Error> {
    deserializer.deserialize_seq(Three(is_share, |_| None))
}

/// The least radius: single precision has its square as a normal number.
const MIN_RADIUS: f64 = 1.1e-19;

/// A radius of which single precision has the square.
pub fn radius<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    let check = |radius: f64| {
        let wrong = !(MIN_RADIUS..=MAX).contains(&radius);
        wrong.then(|| format!("a radius of {radius:e} is not between 1.1e-19 and 1e18"))
    };
    Number(check).deserialize(deserializer)
}

/// The spheres, at least one and not too many of them.
pub fn spheres<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<file::FileSphere>, D::Error> {
    /// One sphere.
    #[derive(Deserialize)]
    #[serde(transparent)]
    struct One(#[serde(deserialize_with = "object")] file::FileSphere);

    struct Spheres;
    impl<'de> Visitor<'de> for Spheres {
        type Value = Vec<file::FileSphere>;

        fn expecting(&self, f: &mut Formatter) -> std::fmt::Result {
            f.write_str("a list of spheres")
        }

        fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Self::Value, A::Error> {
            let mut spheres = Vec::new();
            while let Some(One(sphere)) = list.next_element()? {
                if spheres.len() == MAX_SPHERES {
                    return Err(A::Error::custom("there are more than 100000 spheres"));
                }
                spheres.push(sphere);
            }
            if spheres.is_empty() { Err(A::Error::custom("there are no spheres")) } else { Ok(spheres) }
        }
    }
    deserializer.deserialize_seq(Spheres)
}
