//! ASCII bodies: rows of values between blanks.

use super::header::Scalar;
use super::rows::{RowError, RowReader};
use crate::scene::mesh_builder::narrow_number;
use crate::scene::text::{number, odd};

/// The relation of rows and lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// A row per line, as the format demands.
    Lines,
    /// A row over several lines, or several rows in a line. A line that begins within a row ends with it, so that a
    /// missing value cannot be taken from the next row.
    Free,
    /// A row per line; further values in the line are ignored.
    Surplus,
}

/// An ASCII body.
pub struct Ascii<'a> {
    bytes: &'a [u8],
    at: usize,
    token_start: usize,
    line: usize,
    newline: u8,
    layout: Layout,
    /// True if the current row began at the start of a line.
    whole_line: bool,
    /// True if the current row extends over several lines.
    crossed: bool,
    /// The number of lines with ignored values, and the first of them.
    surplus: Option<(usize, usize)>,
    /// The first line with a number in an unusual notation.
    unusual: Option<usize>,
}

impl<'a> Ascii<'a> {
    /// A reader of `bytes`, which begin at line `line` of the file.
    pub fn new(bytes: &'a [u8], line: usize, newline: u8, layout: Layout) -> Self {
        Ascii {
            bytes,
            at: 0,
            token_start: 0,
            line,
            newline,
            layout,
            whole_line: true,
            crossed: false,
            surplus: None,
            unusual: None,
        }
    }

    /// Skips bytes up to the space, except the byte that ends lines. In CRLF, CR is therefore a blank.
    #[inline(always)]
    fn skip_blanks(&mut self) {
        while self.bytes.get(self.at).is_some_and(|&b| b <= b' ' && b != self.newline) {
            self.at += 1;
        }
    }

    /// Advances to the next token of this row.
    #[inline(always)]
    fn seek(&mut self) -> Result<&'a [u8], RowError> {
        self.skip_blanks();
        self.token_start = self.at;
        match self.bytes.get(self.at) {
            None => Err(RowError::End),
            Some(&b) if b == self.newline => self.cross(),
            Some(_) => Ok(&self.bytes[self.at..]),
        }
    }

    /// Advances from the end of a line to the next token of this row.
    #[cold]
    fn cross(&mut self) -> Result<&'a [u8], RowError> {
        if self.layout != Layout::Free || !self.whole_line {
            return Err(RowError::Short);
        }
        self.crossed = true;
        self.skip_lines()?;
        self.token_start = self.at;
        Ok(&self.bytes[self.at..])
    }

    /// Skips blanks and ends of lines.
    #[inline(always)]
    fn skip_lines(&mut self) -> Result<(), RowError> {
        loop {
            self.skip_blanks();
            match self.bytes.get(self.at) {
                None => return Err(RowError::End),
                Some(&b) if b == self.newline => {
                    self.at += 1;
                    self.line += 1;
                    self.whole_line = true;
                }
                Some(_) => return Ok(()),
            }
        }
    }

    /// Handles further values in the line after a row.
    #[cold]
    fn further(&mut self) -> Result<(), RowError> {
        match self.layout {
            Layout::Lines => Err(RowError::Long),
            Layout::Free if self.crossed => Err(RowError::Long),
            Layout::Free => {
                self.whole_line = false;
                Ok(())
            }
            Layout::Surplus => {
                self.surplus.get_or_insert((0, self.line)).0 += 1;
                let rest = &self.bytes[self.at..];
                self.at += rest.iter().position(|&b| b == self.newline).unwrap_or(rest.len());
                Ok(())
            }
        }
    }

    /// Reads a value in an unusual notation, or one that is not finite.
    #[cold]
    fn odd_value(&mut self, rest: &[u8]) -> Result<f64, RowError> {
        let token = &rest[..number::token_length(rest)];
        let value = odd::value(token.strip_suffix(b",").unwrap_or(token)).ok_or(RowError::Number)?;
        if value.is_finite() && number::double(token).is_none() {
            self.unusual.get_or_insert(self.line);
        }
        self.at += token.len();
        Ok(value)
    }
}

impl RowReader for Ascii<'_> {
    #[inline(always)]
    fn begin(&mut self) -> Result<(), RowError> {
        self.crossed = false;
        self.skip_lines()
    }

    #[inline(always)]
    fn end(&mut self) -> Result<(), RowError> {
        self.skip_blanks();
        self.token_start = self.at;
        match self.bytes.get(self.at) {
            Some(&b) if b != self.newline => self.further(),
            _ => Ok(()),
        }
    }

    #[inline]
    fn float(&mut self, kind: Scalar) -> Result<f32, RowError> {
        let rest = self.seek()?;
        let found = match kind {
            Scalar::F32 => number::float(rest),
            _ => number::double(rest).map(|(value, length)| (value as f32, length)),
        };
        match found {
            Some((value, length)) if !value.is_infinite() => {
                self.at += length;
                Ok(value)
            }
            _ => self.odd_value(rest).map(narrow_number),
        }
    }

    #[inline]
    fn normal(&mut self, kind: Scalar) -> Result<f32, RowError> {
        match self.float(kind) {
            Err(RowError::Number) => {
                self.at += number::token_length(&self.bytes[self.at..]);
                Ok(f32::NAN)
            }
            found => found,
        }
    }

    #[inline]
    fn double(&mut self, _kind: Scalar) -> Result<f64, RowError> {
        let rest = self.seek()?;
        match number::double(rest) {
            Some((value, length)) => {
                self.at += length;
                Ok(value)
            }
            None => self.odd_value(rest),
        }
    }

    #[inline]
    fn integer(&mut self, _kind: Scalar) -> Result<i64, RowError> {
        let rest = self.seek()?;
        if let Some((value, length)) = number::integer(rest) {
            self.at += length;
            return Ok(value);
        }
        let token = &rest[..number::token_length(rest)];
        let value = odd::whole(token.strip_suffix(b",").unwrap_or(token)).ok_or(RowError::Integer)?;
        self.unusual.get_or_insert(self.line);
        self.at += token.len();
        Ok(value)
    }

    fn skip(&mut self, _kind: Scalar, n: u64) -> Result<(), RowError> {
        for _ in 0..n {
            self.at += number::token_length(self.seek()?);
        }
        Ok(())
    }

    fn left(&self) -> usize {
        let rest = &self.bytes[self.at..];
        rest.len() - rest.iter().take_while(|&&b| b <= b' ').count()
    }

    fn line(&self) -> Option<usize> {
        Some(self.line)
    }

    fn token(&self) -> &[u8] {
        let rest = &self.bytes[self.token_start..];
        &rest[..number::token_length(rest)]
    }

    fn warnings(&self) -> Vec<(usize, String)> {
        let surplus = self.surplus.map(|(count, line)| {
            (line, format!("the row has more values than declared: those of {count} rows are ignored"))
        });
        let unusual = self.unusual.map(|line| {
            let text = "a number has a comma, a Fortran exponent or decimals that are not usual: it is read";
            (line, text.to_owned())
        });
        surplus.into_iter().chain(unusual).collect()
    }

    /// A digit and a separator.
    fn least(_kind: Scalar) -> u64 {
        2
    }
}
