//! Splits OBJ and MTL files into lines and words.

use super::Fault;
use crate::scene::placement::MAX_COORDINATE;
use crate::scene::text::number;
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
}

impl<'a> Lines<'a> {
    /// A reader at the start of the text.
    pub fn new(bytes: &'a [u8]) -> Lines<'a> {
        Lines { bytes, at: 0, line: 1 }
    }

    /// The current line, counted from 1.
    pub fn line(&self) -> usize {
        self.line
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
            && matches!(rest.get(word.len()), Some(b'\n' | b'\r'))
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
        match &rest[..end] {
            [kept @ .., b'\\'] if end < rest.len() => (kept, true),
            piece => (piece, false),
        }
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
            if b == b'\\' && matches!(self.bytes.get(self.at + 1), Some(b'\n' | b'\r')) {
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

    /// Reads a number that is followed by a backslash; other words are errors.
    #[cold]
    fn other_float(&mut self, context: &str) -> Result<f32, Fault> {
        let word = self.word();
        word.and_then(number::float).map(|(value, _)| value).ok_or_else(|| self.no_number(word, context))
    }

    #[cold]
    fn no_number(&self, word: Option<&[u8]>, context: &str) -> Fault {
        let problem = match word {
            Some(word) => format!("{context}: `{}` is not a number", printable(word)),
            None => format!("{context} has too few numbers"),
        };
        Fault::new(self.line, problem, "three numbers are needed")
    }

    #[inline]
    fn three(&mut self, context: &str) -> Result<Vec3, Fault> {
        Ok(Vec3::new(self.float(context)?, self.float(context)?, self.float(context)?))
    }

    /// Reads a position and subtracts `offset`, in double precision unless it is zero.
    #[inline]
    pub fn position(&mut self, offset: DVec3) -> Result<Vec3, Fault> {
        const CONTEXT: &str = "a vertex";
        if offset == DVec3::ZERO {
            let v = self.three(CONTEXT)?;
            return if v.abs().cmple(LARGEST.as_vec3()).all() { Ok(v) } else { Err(self.too_far(v)) };
        }
        let v = DVec3::new(self.double(CONTEXT)?, self.double(CONTEXT)?, self.double(CONTEXT)?);
        if v.abs().cmple(LARGEST).all() { Ok((v - offset).as_vec3()) } else { Err(self.too_far(v.as_vec3())) }
    }

    #[cold]
    fn too_far(&self, v: Vec3) -> Fault {
        let (fault, hint) = match v.is_finite() {
            true => ("exceed the largest coordinate 1e18", "scale the mesh down, or remove the vertex"),
            false => ("are not finite", "remove it or repair the export"),
        };
        let problem = format!("a vertex has the values ({}, {}, {}), which {fault}", v.x, v.y, v.z);
        Fault::new(self.line, problem, hint)
    }

    /// Reads a normal; a normal that is not finite is replaced by zero, and computed later.
    #[inline]
    pub fn normal(&mut self) -> Result<Vec3, Fault> {
        self.three("a normal").map(|v| if v.is_finite() { v } else { Vec3::ZERO })
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
