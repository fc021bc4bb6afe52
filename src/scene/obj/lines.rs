//! Splits OBJ and MTL files into lines and words.

use super::Fault;
use crate::scene::mesh_builder::{is_valid, narrow};
use crate::scene::placement::MAX_COORDINATE;
use crate::scene::text::{number, odd};
use glam::{DVec3, Vec3};
use std::borrow::Cow;

/// The largest valid position.
const LARGEST: DVec3 = DVec3::splat(MAX_COORDINATE);

/// Reads a text line by line and word by word. A backslash before the end of a line continues the line.
#[derive(Clone)]
pub struct Lines<'a> {
    bytes: &'a [u8],
    at: usize,
    line: usize,
    /// The first line with a number in an unusual notation, such as commas between numbers.
    pub unusual: Option<usize>,
}

impl<'a> Lines<'a> {
    /// A reader at the start of the text.
    pub fn new(bytes: &'a [u8]) -> Lines<'a> {
        Lines { bytes, at: 0, line: 1, unusual: None }
    }

    /// The current line, counted from 1.
    pub fn line(&self) -> usize {
        self.line
    }

    /// Number of bytes that have not been read.
    pub fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// Reads the first word of the next line that is neither empty nor a comment.
    pub fn keyword(&mut self) -> Option<&'a [u8]> {
        loop {
            self.skip_blanks();
            match *self.bytes.get(self.at)? {
                b'\n' | b'\r' | b'#' => self.skip_line(),
                _ => return self.word(),
            }
        }
    }

    /// Reads the next word of this line.
    #[inline]
    pub fn word(&mut self) -> Option<&'a [u8]> {
        self.skip_blanks();
        let rest = self.bytes.get(self.at..).filter(|rest| rest.first().is_some_and(|&b| b > b' ' && b != b'#'))?;
        let mut word = &rest[..number::token_length(rest)];
        if let [kept @ .., b'\\'] = word
            && ends_line(&rest[word.len()..])
        {
            word = kept;
        }
        self.at += word.len();
        Some(word)
    }

    /// Reads the rest of the line and its continuation lines, trimmed. It keeps comments, because names of materials
    /// may contain `#`; see [`without_comment`].
    pub fn rest(&mut self) -> Cow<'a, [u8]> {
        let (piece, continued) = self.piece();
        if !continued {
            return Cow::Borrowed(piece.trim_ascii());
        }
        let mut whole = piece.to_vec();
        loop {
            self.skip_line();
            let (piece, continued) = self.piece();
            whole.push(b' ');
            whole.extend(piece);
            if !continued {
                return Cow::Owned(whole.trim_ascii().to_vec());
            }
        }
    }

    /// Reads the rest of this line without its continuation lines and without the backslash, and whether there is one.
    fn piece(&mut self) -> (&'a [u8], bool) {
        let rest = &self.bytes[self.at..];
        let end = rest.iter().position(|&b| b == b'\n' || b == b'\r').unwrap_or(rest.len());
        self.at += end;
        let piece = &rest[..end];
        match if piece.last() == Some(&b' ') { piece.trim_ascii_end() } else { piece } {
            [kept @ .., b'\\'] => (kept, true),
            _ => (piece, false),
        }
    }

    /// The part of the last word before a comment, with which the next word begins.
    #[cold]
    pub fn before_comment(&mut self, word: &'a [u8]) -> &'a [u8] {
        let length = without_attached_comment(word).len();
        self.at -= word.len() - length;
        &word[..length]
    }

    /// Skips the rest of the line and its continuation lines. A backslash at the end of a comment does not continue the
    /// line, because it may be the end of a folder's name.
    #[inline]
    pub fn end_statement(&mut self) {
        loop {
            let (piece, continued) = self.piece();
            self.skip_line();
            if !continued || piece.contains(&b'#') {
                return;
            }
        }
    }

    /// Skips the rest of the line. Lines end with LF, CRLF or CR.
    #[inline]
    pub fn skip_line(&mut self) {
        let rest = &self.bytes[self.at..];
        let Some(end) = rest.iter().position(|&b| b == b'\n' || b == b'\r') else {
            self.at = self.bytes.len();
            return;
        };
        self.at += end + if rest[end..].starts_with(b"\r\n") { 2 } else { 1 };
        self.line += 1;
    }

    /// Skips blanks, and line ends after a backslash.
    #[inline]
    fn skip_blanks(&mut self) {
        while let Some(&b) = self.bytes.get(self.at) {
            if b == b'\\' && ends_line(&self.bytes[self.at + 1..]) {
                self.at += 1;
                self.skip_line();
            } else if b <= b' ' && b != b'\n' && b != b'\r' {
                self.at += 1;
            } else {
                return;
            }
        }
    }

    #[inline]
    fn float(&mut self, context: &str) -> Result<f32, Fault> {
        self.skip_blanks();
        if let Some((value, length)) = self.bytes.get(self.at..).and_then(number::float) {
            self.at += length;
            return Ok(value);
        }
        self.other_float(context)
    }

    #[inline]
    fn double(&mut self, context: &str) -> Result<f64, Fault> {
        self.skip_blanks();
        if let Some((value, length)) = self.bytes.get(self.at..).and_then(number::double) {
            self.at += length;
            return Ok(value);
        }
        let word = self.word();
        word.and_then(number::double).map(|(value, _)| value).ok_or_else(|| self.no_number(word, context))
    }

    /// Reads a number that is followed by a backslash, or in an unusual notation; other words are errors.
    #[cold]
    fn other_float(&mut self, context: &str) -> Result<f32, Fault> {
        let line = self.line;
        let word = self.word().map(|word| self.before_comment(word));
        let value = word.and_then(|word| odd::value(word.strip_suffix(b",").unwrap_or(word)));
        match value {
            Some(value) => {
                if value.is_finite() && word.and_then(number::double).is_none() {
                    self.unusual.get_or_insert(line);
                }
                Ok(value as f32)
            }
            None => Err(self.no_number(word, context)),
        }
    }

    #[cold]
    fn no_number(&self, word: Option<&[u8]>, context: &str) -> Fault {
        let (problem, hint) = match word {
            Some(word) if word.contains(&b',') => {
                (format!("{context}: `{}` is not a number", printable(word)), "write decimals with a point")
            }
            Some(word) => (format!("{context}: `{}` is not a number", printable(word)), "three numbers are needed"),
            None => (format!("{context} has too few numbers"), "three numbers are needed"),
        };
        Fault::new(self.line, problem, hint)
    }

    #[inline]
    fn three(&mut self, context: &str) -> Result<Vec3, Fault> {
        Ok(Vec3::new(self.float(context)?, self.float(context)?, self.float(context)?))
    }

    /// Reads three numbers in unusual notations: with commas between them, with Fortran's exponents, or not finite.
    #[cold]
    fn odd_three(&mut self, context: &str) -> Result<DVec3, Fault> {
        let line = self.line;
        let mut words: Vec<&[u8]> = Vec::new();
        while let Some(word) = self.word() {
            words.push(self.before_comment(word));
            if words.len() == MANY_WORDS {
                break;
            }
        }
        // In a single word commas can only separate numbers; in others they may be decimal commas.
        let mut pieces: Vec<&[u8]> = match words.as_slice() {
            [word] => word.split(|&b| b == b',').collect(),
            words => {
                let without = |word: &&'a [u8]| word.strip_suffix(b",").unwrap_or(word);
                words.iter().map(without).map(|word| word.strip_prefix(b",").unwrap_or(word)).collect()
            }
        };
        pieces.retain(|piece| !piece.is_empty());
        let mut found = [0.0; 3];
        for (i, number) in found.iter_mut().enumerate() {
            let piece = pieces.get(i).copied();
            *number = piece.and_then(odd::value).ok_or_else(|| Fault { line, ..self.no_number(piece, context) })?;
        }
        let usual = |word: &&[u8]| odd::value(word).is_some_and(|value| !value.is_finite()) || is_number(word);
        if !words.iter().take(3).all(usual) {
            self.unusual.get_or_insert(line);
        }
        Ok(DVec3::from(found))
    }

    /// Reads a position and subtracts `offset`, in double precision unless it is zero. A position that is not finite,
    /// or beyond the largest coordinate, is not valid, see [`is_valid`].
    #[inline]
    pub fn position(&mut self, offset: DVec3) -> Result<Vec3, Fault> {
        let start = self.clone();
        if offset == DVec3::ZERO {
            match self.three(VERTEX) {
                Ok(position) if is_valid(position) => return Ok(position),
                _ => {}
            }
        } else if let [Ok(x), Ok(y), Ok(z)] = [self.double(VERTEX), self.double(VERTEX), self.double(VERTEX)] {
            let v = DVec3::new(x, y, z);
            if v.abs().cmple(LARGEST).all() {
                return Ok((v - offset).as_vec3());
            }
        }
        *self = start;
        self.odd_position(offset)
    }

    #[cold]
    fn odd_position(&mut self, offset: DVec3) -> Result<Vec3, Fault> {
        let v = self.odd_three(VERTEX)?;
        Ok(narrow(if v.abs().cmple(LARGEST).all() { v - offset } else { v }))
    }

    /// Reads a normal; `None` if it is not three finite numbers.
    #[inline]
    pub fn normal(&mut self) -> Option<Vec3> {
        let start = self.clone();
        match self.three(NORMAL) {
            Ok(normal) if normal.is_finite() => Some(normal),
            _ => {
                *self = start;
                self.odd_three(NORMAL).ok().map(|normal| normal.as_vec3()).filter(|normal| normal.is_finite())
            }
        }
    }

    /// Reads a finite number; `context` is its name for messages.
    pub fn number(&mut self, context: &str) -> Result<f32, Fault> {
        let line = self.line;
        let value = self.float(context)?;
        if value.is_finite() {
            Ok(value)
        } else {
            Err(Fault::new(line, format!("{context} is not finite"), "repair it"))
        }
    }

    /// Reads a colour: one number for a grey, or three for red, green and blue. Negative numbers are clamped to zero.
    pub fn colour(&mut self, context: &str) -> Result<Vec3, Fault> {
        let red = self.number(context)?;
        let mut colour = Vec3::splat(red);
        if let Some(word) = self.word() {
            self.at -= word.len();
            colour = Vec3::new(red, self.number(context)?, self.number(context)?);
        }
        Ok(colour.max(Vec3::ZERO))
    }
}

/// The fault of a vertex that is not valid, see [`is_valid`].
#[cold]
pub fn invalid_vertex(line: usize, v: Vec3) -> Fault {
    let (fault, hint) = match v.is_finite() && v.abs().max_element() < f32::MAX {
        true => ("exceed the largest coordinate 1e18", "scale the mesh down, or remove the vertex"),
        false => ("are not finite", "remove it or repair the export"),
    };
    Fault::new(line, format!("a vertex has the values ({}, {}, {}), which {fault}", v.x, v.y, v.z), hint)
}

/// The names of statements for messages.
const VERTEX: &str = "a vertex";
const NORMAL: &str = "a normal";

/// The largest number of words of a statement that are searched for numbers in unusual notations.
const MANY_WORDS: usize = 16;

fn is_number(word: &[u8]) -> bool {
    number::double(word).is_some_and(|(_, length)| length == word.len())
}

/// True if only blanks are left in the line.
#[cold]
fn ends_line(bytes: &[u8]) -> bool {
    bytes.iter().find(|&&b| b > b' ' || b == b'\n' || b == b'\r').is_none_or(|&b| b <= b' ')
}

/// A word without the comment that follows it directly, as in `3#c`. A `#` of a number that is none (`-1.#IND`) begins
/// no comment.
fn without_attached_comment(word: &[u8]) -> &[u8] {
    let begins = |&at: &usize| {
        let digits = |end: usize| word[..end].iter().rposition(|b| !b.is_ascii_digit()).map_or(0, |before| before + 1);
        word[at] == b'#' && at.checked_sub(1).is_none_or(|end| odd::after_hash(&word[digits(end)..]).is_none())
    };
    (0..word.len()).find(begins).map_or(word, |at| &word[..at])
}

/// A name without the comment after it.
pub fn without_comment(name: &[u8]) -> &[u8] {
    let begins = |&at: &usize| name[at] == b'#' && (at == 0 || name[at - 1].is_ascii_whitespace());
    (0..name.len()).find(begins).map_or(name, |at| name[..at].trim_ascii_end())
}

/// Formats a piece of the file for a message: without control characters, and truncated to 80 characters.
pub fn printable(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(200)]);
    text.chars().filter(|c| !c.is_control()).take(80).collect()
}
