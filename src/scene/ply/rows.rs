//! A common interface for the rows of ASCII and binary bodies, and binary bodies.

use super::header::Scalar;
use crate::scene::mesh_builder::narrow_number;

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
    /// Reads a component of a normal. A text that is no number is NaN.
    fn normal(&mut self, kind: Scalar) -> Result<f32, RowError>;
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
    /// Lines with warnings about them.
    fn warnings(&self) -> Vec<(usize, String)> {
        Vec::new()
    }
    /// The smallest size of a value in bytes.
    fn least(kind: Scalar) -> u64;
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

/// A float that is a whole number.
#[cold]
fn whole(value: f64) -> Result<i64, RowError> {
    if value.fract() == 0.0 && value.abs() < 1e15 { Ok(value as i64) } else { Err(RowError::Integer) }
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
            Scalar::F64 => match value!(self, f64) {
                value if (value as f32).is_infinite() => narrow_number(value),
                value => value as f32,
            },
            _ => self.integer(kind)? as f32,
        })
    }

    #[inline]
    fn normal(&mut self, kind: Scalar) -> Result<f32, RowError> {
        self.float(kind)
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
            Scalar::I64 => value!(self, i64),
            Scalar::U64 => i64::try_from(value!(self, u64)).unwrap_or(i64::MAX),
            Scalar::F32 => whole(value!(self, f32).into())?,
            Scalar::F64 => whole(value!(self, f64))?,
            Scalar::Other => return Err(RowError::Integer),
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
