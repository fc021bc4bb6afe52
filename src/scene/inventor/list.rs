//! The values of a field while they are parsed.

use super::node_type::NotANumber;
use super::tree::Values;
use crate::scene::text::{number, odd};

/// True for a word that begins like a number.
pub fn is_number(word: &[u8]) -> bool {
    matches!(word[0], b'0'..=b'9' | b'+' | b'-' | b'.')
}

/// Parses a number, decimal or hexadecimal.
#[inline]
pub fn value(word: &[u8]) -> Option<f64> {
    match number::double(word) {
        Some((value, length)) if length == word.len() => value.is_finite().then_some(value),
        _ => {
            let digits = word.strip_prefix(b"0x").or(word.strip_prefix(b"0X"))?;
            u32::from_str_radix(std::str::from_utf8(digits).ok()?, 16).ok().map(f64::from)
        }
    }
}

/// The values of a field while it is parsed.
pub struct List {
    /// False if the values are skipped.
    pub wanted: bool,
    pub rule: NotANumber,
    pub numbers: Vec<f64>,
    pub words: Vec<Box<[u8]>>,
    pub node: Option<u32>,
}

impl List {
    pub fn new(known: Option<&'static str>) -> List {
        let rule = known.map_or(NotANumber::Word, NotANumber::of);
        List { wanted: known.is_some(), rule, numbers: Vec::new(), words: Vec::new(), node: None }
    }

    /// True if a word begins a list of numbers; otherwise it is a string without quotes.
    pub fn begins(&self, word: &[u8]) -> bool {
        match self.rule {
            NotANumber::Word => {
                !self.wanted && is_number(word) && (value(word).is_some() || odd::value(word).is_some())
            }
            _ => self.continues(word),
        }
    }

    /// True for a word that is a further number of a list without brackets.
    pub fn continues(&self, word: &[u8]) -> bool {
        let odd = matches!(self.rule, NotANumber::Position | NotANumber::Default);
        is_number(word) || odd && odd::value(word).is_some()
    }

    #[inline]
    pub fn number(&mut self, value: f64) {
        if self.wanted {
            self.numbers.push(value);
        }
    }

    /// The values of the field. A list of numbers and words becomes words, which are refused if numbers are needed.
    pub fn values(self) -> Option<Values> {
        match self {
            List { wanted: false, .. } => None,
            List { node: Some(node), .. } => Some(Values::Node(node)),
            List { words, numbers, .. } if !words.is_empty() || numbers.is_empty() => Some(Values::Words(words.into())),
            List { numbers, .. } => Some(Values::Numbers(numbers.into())),
        }
    }
}
