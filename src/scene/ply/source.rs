//! The two kinds of body, text and bytes, behind one interface, so that the mesh is read by one piece of code.

use super::header::Scalar;
use crate::scene::text::number;

/// Why a value could not be read. Small and `Copy`: the text for the user is made by the one who knows the place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bad {
    /// The file ends.
    End,
    /// The line ends before the element does.
    Short,
    /// The line goes on after the element.
    Long,
    /// Not a number.
    Number,
    /// Not a whole number.
    Integer,
    /// A list with a negative number of items.
    Count,
}

/// The rows of a body, value by value.
pub trait Source {
    /// Starts a row.
    fn begin(&mut self) -> Result<(), Bad>;
    /// Ends a row.
    fn end(&mut self) -> Result<(), Bad>;
    /// The next value, rounded to single precision.
    fn float(&mut self, kind: Scalar) -> Result<f32, Bad>;
    /// The next value in double precision, whatever the file declares: text may have more digits than a float.
    fn double(&mut self, kind: Scalar) -> Result<f64, Bad>;
    /// The next value of an integer type.
    fn integer(&mut self, kind: Scalar) -> Result<i64, Bad>;
    /// Passes over `n` values.
    fn skip(&mut self, kind: Scalar, n: u64) -> Result<(), Bad>;
    /// Bytes not yet read, blanks apart.
    fn left(&self) -> usize;
    /// Line of the current row; `None` in a binary file.
    fn line(&self) -> Option<usize>;
    /// The text that was read last, where it is text.
    fn token(&self) -> &[u8];
    /// The least number of bytes that one value takes.
    fn least(kind: Scalar) -> u64;
}

/// Text: a row per line, values between blanks.
pub struct Ascii<'a> {
    bytes: &'a [u8],
    at: usize,
    token_start: usize,
    line: usize,
    newline: u8,
}

impl<'a> Ascii<'a> {
    /// The body `bytes`, which begins at line `line` of the file.
    pub fn new(bytes: &'a [u8], line: usize, newline: u8) -> Self {
        Ascii { bytes, at: 0, token_start: 0, line, newline }
    }

    /// Everything up to the space is a blank, the byte that ends lines apart (so CRLF needs no further care).
    #[inline(always)]
    fn skip_blanks(&mut self) {
        while self.bytes.get(self.at).is_some_and(|&b| b <= b' ' && b != self.newline) {
            self.at += 1;
        }
    }

    /// Goes to the next token of this line.
    #[inline(always)]
    fn seek(&mut self) -> Result<&'a [u8], Bad> {
        self.skip_blanks();
        self.token_start = self.at;
        match self.bytes.get(self.at) {
            None => Err(Bad::End),
            Some(&b) if b == self.newline => Err(Bad::Short),
            Some(_) => Ok(&self.bytes[self.at..]),
        }
    }
}

impl Source for Ascii<'_> {
    fn begin(&mut self) -> Result<(), Bad> {
        loop {
            self.skip_blanks();
            match self.bytes.get(self.at) {
                None => return Err(Bad::End),
                Some(&b) if b == self.newline => {
                    self.at += 1;
                    self.line += 1;
                }
                Some(_) => return Ok(()),
            }
        }
    }

    fn end(&mut self) -> Result<(), Bad> {
        match self.seek() {
            Ok(_) => Err(Bad::Long),
            Err(_) => Ok(()),
        }
    }

    #[inline]
    fn float(&mut self, kind: Scalar) -> Result<f32, Bad> {
        let rest = self.seek()?;
        let (value, length) = match kind {
            Scalar::F32 => number::float(rest),
            _ => number::double(rest).map(|(value, length)| (value as f32, length)),
        }
        .ok_or(Bad::Number)?;
        self.at += length;
        Ok(value)
    }

    #[inline]
    fn double(&mut self, _kind: Scalar) -> Result<f64, Bad> {
        let (value, length) = number::double(self.seek()?).ok_or(Bad::Number)?;
        self.at += length;
        Ok(value)
    }

    #[inline]
    fn integer(&mut self, _kind: Scalar) -> Result<i64, Bad> {
        let (value, length) = number::integer(self.seek()?).ok_or(Bad::Integer)?;
        self.at += length;
        Ok(value)
    }

    fn skip(&mut self, _kind: Scalar, n: u64) -> Result<(), Bad> {
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

    /// A digit and what separates it from the next.
    fn least(_kind: Scalar) -> u64 {
        2
    }
}

/// Bytes, in either order.
pub struct Binary<'a, const BIG_ENDIAN: bool> {
    bytes: &'a [u8],
}

impl<'a, const BIG_ENDIAN: bool> Binary<'a, BIG_ENDIAN> {
    /// The body `bytes`.
    pub fn new(bytes: &'a [u8]) -> Self {
        Binary { bytes }
    }

    #[inline(always)]
    fn take<const N: usize>(&mut self) -> Result<[u8; N], Bad> {
        let (&chunk, rest) = self.bytes.split_first_chunk().ok_or(Bad::End)?;
        self.bytes = rest;
        Ok(chunk)
    }
}

/// Reads one value of type `$type`.
macro_rules! value {
    ($source:expr, $type:ty) => {{
        let bytes = $source.take()?;
        if BIG_ENDIAN { <$type>::from_be_bytes(bytes) } else { <$type>::from_le_bytes(bytes) }
    }};
}

impl<const BIG_ENDIAN: bool> Source for Binary<'_, BIG_ENDIAN> {
    fn begin(&mut self) -> Result<(), Bad> {
        Ok(())
    }

    fn end(&mut self) -> Result<(), Bad> {
        Ok(())
    }

    #[inline]
    fn float(&mut self, kind: Scalar) -> Result<f32, Bad> {
        Ok(match kind {
            Scalar::F32 => value!(self, f32),
            Scalar::F64 => value!(self, f64) as f32,
            _ => self.integer(kind)? as f32,
        })
    }

    #[inline]
    fn double(&mut self, kind: Scalar) -> Result<f64, Bad> {
        Ok(match kind {
            Scalar::F32 => value!(self, f32).into(),
            Scalar::F64 => value!(self, f64),
            _ => self.integer(kind)? as f64,
        })
    }

    #[inline]
    fn integer(&mut self, kind: Scalar) -> Result<i64, Bad> {
        Ok(match kind {
            Scalar::I8 => value!(self, i8).into(),
            Scalar::U8 => value!(self, u8).into(),
            Scalar::I16 => value!(self, i16).into(),
            Scalar::U16 => value!(self, u16).into(),
            Scalar::I32 => value!(self, i32).into(),
            Scalar::U32 => value!(self, u32).into(),
            Scalar::F32 | Scalar::F64 => return Err(Bad::Integer),
        })
    }

    fn skip(&mut self, kind: Scalar, n: u64) -> Result<(), Bad> {
        let length = n.saturating_mul(kind.size() as u64);
        self.bytes = usize::try_from(length).ok().and_then(|n| self.bytes.get(n..)).ok_or(Bad::End)?;
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
