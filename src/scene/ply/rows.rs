//! A common interface for the rows of ASCII and binary bodies.

use super::header::Scalar;
use crate::scene::text::number;

/// The error of a value. It is small and `Copy`; the caller knows the position and formats the message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowError {
    /// The file ends within the row.
    End,
    /// The line has fewer values than the row.
    Short,
    /// The line has more values than the row.
    Long,
    /// The value is not a number.
    Number,
    /// The value is not an integer.
    Integer,
    /// A list has a negative number of items.
    Count,
}

/// Reads the rows of a body value by value.
pub trait RowReader {
    /// Must be called before the first value of a row.
    fn begin(&mut self) -> Result<(), RowError>;
    /// Must be called after the last value of a row; checks that the row has no more values.
    fn end(&mut self) -> Result<(), RowError>;
    /// Reads a value, rounded to single precision.
    fn float(&mut self, kind: Scalar) -> Result<f32, RowError>;
    /// Reads a value in double precision, even if its declared type is a float: text can have more digits.
    fn double(&mut self, kind: Scalar) -> Result<f64, RowError>;
    /// Reads a value of an integer type.
    fn integer(&mut self, kind: Scalar) -> Result<i64, RowError>;
    /// Skips `n` values.
    fn skip(&mut self, kind: Scalar, n: u64) -> Result<(), RowError>;
    /// Number of bytes that have not been read, without blanks.
    fn left(&self) -> usize;
    /// Line of the current row; `None` in a binary file.
    fn line(&self) -> Option<usize>;
    /// The text of the last value; empty in a binary file.
    fn token(&self) -> &[u8];
    /// The smallest size of a value in bytes.
    fn least(kind: Scalar) -> u64;
}

/// An ASCII body: a row per line, with values between blanks.
pub struct Ascii<'a> {
    bytes: &'a [u8],
    at: usize,
    token_start: usize,
    line: usize,
    newline: u8,
}

impl<'a> Ascii<'a> {
    /// A reader of `bytes`, which begin at line `line` of the file.
    pub fn new(bytes: &'a [u8], line: usize, newline: u8) -> Self {
        Ascii { bytes, at: 0, token_start: 0, line, newline }
    }

    /// Skips bytes up to the space, except the byte that ends lines. In CRLF, CR is therefore a blank.
    #[inline(always)]
    fn skip_blanks(&mut self) {
        while self.bytes.get(self.at).is_some_and(|&b| b <= b' ' && b != self.newline) {
            self.at += 1;
        }
    }

    /// Advances to the next token of this line.
    #[inline(always)]
    fn seek(&mut self) -> Result<&'a [u8], RowError> {
        self.skip_blanks();
        self.token_start = self.at;
        match self.bytes.get(self.at) {
            None => Err(RowError::End),
            Some(&b) if b == self.newline => Err(RowError::Short),
            Some(_) => Ok(&self.bytes[self.at..]),
        }
    }
}

impl RowReader for Ascii<'_> {
    fn begin(&mut self) -> Result<(), RowError> {
        loop {
            self.skip_blanks();
            match self.bytes.get(self.at) {
                None => return Err(RowError::End),
                Some(&b) if b == self.newline => {
                    self.at += 1;
                    self.line += 1;
                }
                Some(_) => return Ok(()),
            }
        }
    }

    fn end(&mut self) -> Result<(), RowError> {
        match self.seek() {
            Ok(_) => Err(RowError::Long),
            Err(_) => Ok(()),
        }
    }

    #[inline]
    fn float(&mut self, kind: Scalar) -> Result<f32, RowError> {
        let rest = self.seek()?;
        let (value, length) = match kind {
            Scalar::F32 => number::float(rest),
            _ => number::double(rest).map(|(value, length)| (value as f32, length)),
        }
        .ok_or(RowError::Number)?;
        self.at += length;
        Ok(value)
    }

    #[inline]
    fn double(&mut self, _kind: Scalar) -> Result<f64, RowError> {
        let (value, length) = number::double(self.seek()?).ok_or(RowError::Number)?;
        self.at += length;
        Ok(value)
    }

    #[inline]
    fn integer(&mut self, _kind: Scalar) -> Result<i64, RowError> {
        let (value, length) = number::integer(self.seek()?).ok_or(RowError::Integer)?;
        self.at += length;
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

    /// A digit and a separator.
    fn least(_kind: Scalar) -> u64 {
        2
    }
}

/// A binary body.
pub struct Binary<'a, const BIG_ENDIAN: bool> {
    bytes: &'a [u8],
}

impl<'a, const BIG_ENDIAN: bool> Binary<'a, BIG_ENDIAN> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Binary { bytes }
    }

    #[inline(always)]
    fn take<const N: usize>(&mut self) -> Result<[u8; N], RowError> {
        let (&chunk, rest) = self.bytes.split_first_chunk().ok_or(RowError::End)?;
        self.bytes = rest;
        Ok(chunk)
    }
}

/// Reads a value of type `$type`.
macro_rules! value {
    ($source:expr, $type:ty) => {{
        let bytes = $source.take()?;
        if BIG_ENDIAN { <$type>::from_be_bytes(bytes) } else { <$type>::from_le_bytes(bytes) }
    }};
}

impl<const BIG_ENDIAN: bool> RowReader for Binary<'_, BIG_ENDIAN> {
    fn begin(&mut self) -> Result<(), RowError> {
        Ok(())
    }

    fn end(&mut self) -> Result<(), RowError> {
        Ok(())
    }

    #[inline]
    fn float(&mut self, kind: Scalar) -> Result<f32, RowError> {
        Ok(match kind {
            Scalar::F32 => value!(self, f32),
            Scalar::F64 => value!(self, f64) as f32,
            _ => self.integer(kind)? as f32,
        })
    }

    #[inline]
    fn double(&mut self, kind: Scalar) -> Result<f64, RowError> {
        Ok(match kind {
            Scalar::F32 => value!(self, f32).into(),
            Scalar::F64 => value!(self, f64),
            _ => self.integer(kind)? as f64,
        })
    }

    #[inline]
    fn integer(&mut self, kind: Scalar) -> Result<i64, RowError> {
        Ok(match kind {
            Scalar::I8 => value!(self, i8).into(),
            Scalar::U8 => value!(self, u8).into(),
            Scalar::I16 => value!(self, i16).into(),
            Scalar::U16 => value!(self, u16).into(),
            Scalar::I32 => value!(self, i32).into(),
            Scalar::U32 => value!(self, u32).into(),
            Scalar::F32 | Scalar::F64 => return Err(RowError::Integer),
        })
    }

    fn skip(&mut self, kind: Scalar, n: u64) -> Result<(), RowError> {
        let length = n.saturating_mul(kind.size() as u64);
        self.bytes = usize::try_from(length).ok().and_then(|n| self.bytes.get(n..)).ok_or(RowError::End)?;
        Ok(())
    }

    fn left(&self) -> usize {
        self.bytes.len()
    }

    fn line(&self) -> Option<usize> {
        None
    }

    fn token(&self) -> &[u8] {
        &[]
    }

    fn least(kind: Scalar) -> u64 {
        kind.size() as u64
    }
}
