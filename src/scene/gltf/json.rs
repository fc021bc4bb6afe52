//! Parses the JSON in pieces: each list is indexed when it is first needed, and each element parsed when it is used. So
//! what is never used is never validated, and an index takes four bytes per element.

use super::shown;
use crate::scene::text::Fault;
use serde::de::{Error, IgnoredAny, SeqAccess, Unexpected, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::value::RawValue;
use std::fmt::{Display, Formatter};

/// What to do about JSON that is not glTF.
const EXPORT: &str = "export the file again";

/// The text of the JSON.
#[derive(Clone, Copy)]
pub struct Json<'a> {
    text: &'a str,
    /// True if messages have the number of the line: the file is text.
    lines: bool,
}

/// The elements of a list in the JSON.
pub struct List<'a> {
    /// Name of the list, such as `nodes`, and of an element.
    pub name: &'static str,
    element: &'static str,
    json: Json<'a>,
    /// Where each element begins, relative to the first.
    starts: Vec<u32>,
    /// Where the first element begins.
    first: usize,
}

impl<'a> Json<'a> {
    pub fn new(text: &'a str, lines: bool) -> Json<'a> {
        Json { text, lines }
    }

    /// Parses the whole text.
    ///
    /// # Errors
    /// It is not JSON, or not of this type; so for the following functions.
    pub fn root<T: Deserialize<'a>>(self) -> Result<T, Fault> {
        serde_json::from_str(self.text).map_err(|error| {
            let problem = format!("the JSON is not glTF: {}", message(&error));
            Fault::new(self.lines.then(|| error.line()), problem, EXPORT)
        })
    }

    /// Parses a value at this place.
    pub fn value<T: Deserialize<'a>>(self, place: impl Display, raw: &'a RawValue) -> Result<T, Fault> {
        self.at(place, self.offset(raw))
    }

    /// Indexes a list; without one it is empty.
    pub fn list(self, name: &'static str, element: &'static str, raw: Option<&'a RawValue>) -> Result<List<'a>, Fault> {
        let Starts { first, starts } = match raw {
            Some(raw) => self.value(name, raw)?,
            None => Starts::default(),
        };
        let first = first.map_or(0, |raw| self.offset(raw));
        Ok(List { name, element, json: self, starts, first })
    }

    /// Where a piece of the text begins.
    fn offset(self, raw: &RawValue) -> usize {
        raw.get().as_ptr() as usize - self.text.as_ptr() as usize
    }

    /// Parses the value that begins here.
    fn at<T: Deserialize<'a>>(self, place: impl Display, start: usize) -> Result<T, Fault> {
        let rest = &self.text[start..];
        let parsed = T::deserialize(&mut serde_json::Deserializer::from_str(rest));
        parsed.map_err(|_| {
            // The path inside of the value costs time, so it is only searched after an error.
            let again = serde_path_to_error::deserialize::<_, T>(&mut serde_json::Deserializer::from_str(rest));
            let (path, problem, line) = match again {
                Ok(_) => (String::new(), "invalid".to_owned(), 1),
                Err(error) => (error.path().to_string(), message(error.inner()), error.inner().line()),
            };
            let dot = if path.starts_with(['.', '[']) { "" } else { "." };
            let path = if path.is_empty() || path == "." { String::new() } else { format!("{dot}{path}") };
            let above = || self.text[..start].bytes().filter(|&b| b == b'\n').count();
            let problem = format!("{place}{}: {problem}", shown(&path, 80));
            Fault::new(self.lines.then(|| above() + line), problem, EXPORT)
        })
    }
}

/// The message of an error without its position.
fn message(error: &serde_json::Error) -> String {
    let text = error.to_string();
    shown(text.rsplit_once(" at line ").map_or(text.as_str(), |(message, _)| message), 160)
}

impl<'a> List<'a> {
    pub fn len(&self) -> usize {
        self.starts.len()
    }

    /// Parses an element; `None` if it does not exist or has another type. In contrast to [`List::get`], a failure
    /// costs no time.
    pub fn parse<T: Deserialize<'a>>(&self, index: usize) -> Option<T> {
        let start = self.first + *self.starts.get(index)? as usize;
        T::deserialize(&mut serde_json::Deserializer::from_str(&self.json.text[start..])).ok()
    }

    /// The problem of an element that [`List::parse`] does not give.
    pub fn problem<T: Deserialize<'a>>(&self, index: usize, from: impl Display) -> String {
        self.get::<T>(index, from).map_or_else(|fault| fault.problem, |_| String::new())
    }

    /// Parses an element; `from` is the place that names it.
    ///
    /// # Errors
    /// It does not exist, or has another type.
    pub fn get<T: Deserialize<'a>>(&self, index: usize, from: impl Display) -> Result<T, Fault> {
        match self.starts.get(index) {
            Some(&start) => self.json.at(format_args!("{}[{index}]", self.name), self.first + start as usize),
            None => {
                let problem = format!("{from} names {} {index}, which does not exist", self.element);
                Err(Fault::new(None, problem, EXPORT))
            }
        }
    }
}

/// The beginnings of the elements of a list.
#[derive(Default)]
struct Starts<'a> {
    first: Option<&'a RawValue>,
    starts: Vec<u32>,
}

impl<'de: 'a, 'a> Deserialize<'de> for Starts<'a> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Elements;
        impl<'de> Visitor<'de> for Elements {
            type Value = Starts<'de>;

            fn expecting(&self, f: &mut Formatter) -> std::fmt::Result {
                f.write_str("an array")
            }

            fn visit_unit<E>(self) -> Result<Starts<'de>, E> {
                Ok(Starts::default())
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Starts<'de>, A::Error> {
                let mut found = Starts::default();
                while let Some(element) = seq.next_element::<&'de RawValue>()? {
                    let first = *found.first.get_or_insert(element);
                    let start = element.get().as_ptr() as usize - first.get().as_ptr() as usize;
                    found.starts.push(u32::try_from(start).map_err(|_| A::Error::custom("more than 4 GiB"))?);
                }
                Ok(found)
            }
        }
        deserializer.deserialize_any(Elements)
    }
}

/// A whole number of at least 0, which may be written as 3.0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Whole(pub usize);

impl<'de> Deserialize<'de> for Whole {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Whole, D::Error> {
        struct Number;
        impl Visitor<'_> for Number {
            type Value = Whole;

            fn expecting(&self, f: &mut Formatter) -> std::fmt::Result {
                f.write_str("a whole number of at least 0")
            }

            fn visit_u64<E: Error>(self, n: u64) -> Result<Whole, E> {
                Ok(Whole(usize::try_from(n).unwrap_or(usize::MAX)))
            }

            fn visit_i64<E: Error>(self, n: i64) -> Result<Whole, E> {
                u64::try_from(n).map_or(Err(E::invalid_value(Unexpected::Signed(n), &self)), |n| self.visit_u64(n))
            }

            fn visit_f64<E: Error>(self, x: f64) -> Result<Whole, E> {
                let whole = x >= 0.0 && x.fract() == 0.0 && x < u64::MAX as f64;
                if whole { self.visit_u64(x as u64) } else { Err(E::invalid_value(Unexpected::Float(x), &self)) }
            }
        }
        deserializer.deserialize_any(Number)
    }
}

/// A list of indices, four bytes each.
#[derive(Default)]
pub struct Indices(pub Vec<u32>);

impl<'de> Deserialize<'de> for Indices {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Indices, D::Error> {
        struct Numbers;
        impl<'de> Visitor<'de> for Numbers {
            type Value = Indices;

            fn expecting(&self, f: &mut Formatter) -> std::fmt::Result {
                f.write_str("an array of whole numbers")
            }

            fn visit_unit<E>(self) -> Result<Indices, E> {
                Ok(Indices::default())
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Indices, A::Error> {
                let mut found = Vec::new();
                while let Some(Whole(index)) = seq.next_element()? {
                    // No list is so long: an index that does not fit is refused where it is used.
                    found.push(u32::try_from(index).unwrap_or(u32::MAX));
                }
                Ok(Indices(found))
            }
        }
        deserializer.deserialize_any(Numbers)
    }
}

/// A value that concerns no geometry, so that one of another type is not an error.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Loose<T> {
    #[default]
    Absent,
    Given(T),
    Malformed,
}

impl<T> Loose<T> {
    pub fn given(self) -> Option<T> {
        match self {
            Loose::Given(value) => Some(value),
            Loose::Absent | Loose::Malformed => None,
        }
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Loose<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Loose<T>, D::Error> {
        let Some(raw) = Option::<&'de RawValue>::deserialize(deserializer)? else { return Ok(Loose::Absent) };
        Ok(serde_json::from_str(raw.get()).map_or(Loose::Malformed, Loose::Given))
    }
}

/// True if a property is present and not null.
#[derive(Clone, Copy, Default)]
pub struct Present(pub bool);

impl<'de> Deserialize<'de> for Present {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Present, D::Error> {
        Ok(Present(Option::<IgnoredAny>::deserialize(deserializer)?.is_some()))
    }
}
