//! Numbers, indices and counts among the tokens of a text.

use super::tokenizer::Tokenizer;
use super::{Fault, number, odd, quote_bytes};

/// The value of a whole word, see [`odd::value`].
fn value_of(word: &[u8]) -> Option<f64> {
    match number::double(word) {
        Some((value, length)) if length == word.len() => Some(value),
        _ => odd::value(word),
    }
}

impl Tokenizer<'_> {
    /// Reads the next token as a finite number: `1`, `1.`, `.5`, `+1`, `-3e-2`, `1.e5`.
    ///
    /// # Errors
    /// The token is not a finite number.
    #[inline]
    pub fn number(&mut self, context: &str) -> Result<f64, Fault> {
        match self.plain_number() {
            Some(value) => Ok(value),
            None => self.other_number(context),
        }
    }

    /// Reads the next token as a number that is not plain: with an exponent, with many digits, or directly before
    /// punctuation. Everything else is an error.
    fn other_number(&mut self, context: &str) -> Result<f64, Fault> {
        let word = self.need(context)?;
        match value_of(word) {
            Some(value) if value.is_finite() => Ok(value),
            _ => Err(self.no_number(word, context)),
        }
    }

    /// Reads the next token as a number that need not be finite; see [`odd::value`].
    ///
    /// # Errors
    /// The token is not a number in any spelling.
    #[inline]
    pub fn any_number(&mut self, context: &str) -> Result<f64, Fault> {
        match self.plain_number() {
            Some(value) => Ok(value),
            None => {
                let word = self.need(context)?;
                value_of(word).ok_or_else(|| self.no_number(word, context))
            }
        }
    }

    /// Reads `N` numbers that need not be finite.
    ///
    /// # Errors
    /// As [`Tokenizer::any_number`].
    pub fn any_numbers<const N: usize>(&mut self, context: &str) -> Result<[f64; N], Fault> {
        let mut values = [0.0; N];
        for value in &mut values {
            *value = self.any_number(context)?;
        }
        Ok(values)
    }

    #[cold]
    fn no_number(&self, word: &[u8], context: &str) -> Fault {
        let kind = if odd::value(word).is_some() { "a finite number" } else { "a number" };
        self.fault(format!("{context}: {} is not {kind}", quote_bytes(word)), "")
    }

    /// Reads `N` numbers.
    ///
    /// # Errors
    /// As [`Tokenizer::number`].
    pub fn numbers<const N: usize>(&mut self, context: &str) -> Result<[f64; N], Fault> {
        let mut values = [0.0; N];
        for value in &mut values {
            *value = self.number(context)?;
        }
        Ok(values)
    }

    /// Reads the next token as an integer.
    ///
    /// # Errors
    /// The token is not an integer.
    #[inline]
    pub fn integer(&mut self, context: &str) -> Result<i64, Fault> {
        self.seek();
        if let Some((value, length)) = number::integer(&self.bytes[self.at..]) {
            self.line = self.here;
            self.at += length;
            return Ok(value);
        }
        let word = self.need(context)?;
        match number::integer(word) {
            Some((value, length)) if length == word.len() => Ok(value),
            _ => Err(self.fault(format!("{context}: {} is not a whole number", quote_bytes(word)), "")),
        }
    }

    /// Reads the next token as an index below `count`.
    ///
    /// # Errors
    /// The token is not such an index.
    #[inline]
    pub fn index(&mut self, count: usize, context: &str) -> Result<usize, Fault> {
        let index = self.integer(context)?;
        match usize::try_from(index) {
            Ok(index) if index < count => Ok(index),
            _ => {
                let hint = if count == 0 { "there are none".into() } else { format!("give 0 to {}", count - 1) };
                Err(self.fault(format!("{context}: index {index} is out of range"), hint))
            }
        }
    }

    /// Reads the next token as the number of elements that follow. Each of them takes at least `least` bytes; a number
    /// that the rest of the file cannot hold is refused, so that the caller may allocate memory for the elements.
    ///
    /// # Errors
    /// The token is not such a number.
    pub fn count(&mut self, least: usize, context: &str) -> Result<usize, Fault> {
        let count = self.integer(context)?;
        let Ok(wanted) = usize::try_from(count) else {
            return Err(self.fault(format!("{context}: {count} is negative"), "give 0 or more"));
        };
        // The last element may lack the blank after it.
        if wanted.saturating_mul(least) > self.left() + 1 {
            let left = self.left();
            let problem = format!("{context}: {wanted} do not fit into the remaining {left} bytes of the file");
            return Err(self.fault(problem, "the file is truncated or the number is wrong"));
        }
        Ok(wanted)
    }
}
