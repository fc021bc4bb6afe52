//! Words of a text in any encoding that agrees with ASCII, read in place, each with its line.

use super::number;
use super::{Fault, quote_bytes};

/// What a byte means.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Class {
    /// Part of a word.
    Word,
    /// Between words.
    Blank,
    /// Between words, and the end of a line and of a comment.
    LineEnd,
    /// A word of its own, which also ends the word before it.
    Punctuation,
    /// Starts a comment that ends with the line, also right behind a word.
    Comment,
    /// Starts a word that ends with the next quotation mark.
    Quotation,
    /// Right before the end of a line, makes a blank of that; part of a word elsewhere.
    Continuation,
}

/// What the bytes of a format mean. Everything up to the space is a blank.
pub struct Syntax {
    classes: [Class; 256],
}

impl Syntax {
    /// The bytes in `comments` start a comment, those in `punctuation` are words of their own. A quotation mark among
    /// `punctuation` starts a string: one word, with both of its marks, in which a backslash guards the next byte.
    pub const fn new(comments: &[u8], punctuation: &[u8]) -> Syntax {
        let mut classes = [Class::Word; 256];
        let mut byte = 0;
        while byte <= b' ' as usize {
            classes[byte] = Class::Blank;
            byte += 1;
        }
        classes[b'\n' as usize] = Class::LineEnd;
        classes[b'\r' as usize] = Class::LineEnd;
        let mut i = 0;
        while i < comments.len() {
            classes[comments[i] as usize] = Class::Comment;
            i += 1;
        }
        let mut i = 0;
        while i < punctuation.len() {
            let class = if punctuation[i] == b'"' { Class::Quotation } else { Class::Punctuation };
            classes[punctuation[i] as usize] = class;
            i += 1;
        }
        Syntax { classes }
    }

    /// The same, but the bytes in `blanks` stand between words as spaces do.
    pub const fn with_blanks(mut self, blanks: &[u8]) -> Syntax {
        let mut i = 0;
        while i < blanks.len() {
            self.classes[blanks[i] as usize] = Class::Blank;
            i += 1;
        }
        self
    }

    /// The same, but a backslash right before the end of a line continues the line, comments included.
    pub const fn with_continued_lines(mut self) -> Syntax {
        self.classes[b'\\' as usize] = Class::Continuation;
        self
    }

    #[inline(always)]
    fn class(&self, byte: u8) -> Class {
        self.classes[byte as usize]
    }
}

/// The words of a file, one after another. Lines end with LF, CRLF or CR.
#[derive(Clone)]
pub struct Words<'a> {
    bytes: &'a [u8],
    syntax: &'a Syntax,
    at: usize,
    /// Line of the byte at `at`.
    here: usize,
    /// Line in which the word that was read last began.
    line: usize,
    /// Ends of lines so far that a backslash took away.
    joined: usize,
}

impl<'a> Words<'a> {
    /// The words of `bytes`, from line 1.
    pub fn new(bytes: &'a [u8], syntax: &'a Syntax) -> Words<'a> {
        Words { bytes, syntax, at: 0, here: 1, line: 1, joined: 0 }
    }

    /// Line of the word that was read last.
    pub fn line(&self) -> usize {
        self.line
    }

    /// Bytes not yet read.
    pub fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// A fault in the line of the word that was read last.
    #[cold]
    pub fn fault(&self, problem: impl Into<String>, hint: impl Into<String>) -> Fault {
        Fault::new(Some(self.line), problem, hint)
    }

    /// Counts the line that ends with the byte at `at`.
    #[inline(always)]
    fn end_line(&mut self) {
        // Of CRLF the second byte counts
        let half = self.bytes[self.at] == b'\r' && self.bytes.get(self.at + 1) == Some(&b'\n');
        self.here += usize::from(!half);
    }

    /// Goes to the next word.
    #[inline]
    fn seek(&mut self) {
        while let Some(&byte) = self.bytes.get(self.at) {
            match self.syntax.class(byte) {
                Class::Blank => {}
                Class::LineEnd => self.end_line(),
                Class::Comment => {
                    while self.bytes.get(self.at + 1).is_some_and(|&b| self.syntax.class(b) != Class::LineEnd) {
                        self.at += 1;
                    }
                }
                Class::Continuation if self.continues() => self.join(),
                Class::Word | Class::Punctuation | Class::Quotation | Class::Continuation => return,
            }
            self.at += 1;
        }
    }

    /// True if the byte at `at`, a backslash, is the last of its line.
    fn continues(&self) -> bool {
        is_last(self.syntax, &self.bytes[self.at..])
    }

    /// Goes from a backslash to the last byte of the end of line that it takes away.
    #[cold]
    fn join(&mut self) {
        let ends = &self.bytes[self.at + 1..];
        if !ends.is_empty() {
            self.at += if ends.starts_with(b"\r\n") { 2 } else { 1 };
            self.here += 1;
            self.joined += 1;
        }
    }

    /// The word at `at`, which must be the start of one.
    #[inline]
    fn word(&self) -> &'a [u8] {
        let rest = &self.bytes[self.at..];
        let length = match rest.first().map(|&b| self.syntax.class(b)) {
            Some(Class::Word) => {
                let length = rest.iter().position(|&b| self.syntax.class(b) != Class::Word).unwrap_or(rest.len());
                match rest.get(length).map(|&b| self.syntax.class(b)) {
                    Some(Class::Continuation) => length_with_backslashes(self.syntax, rest),
                    _ => length,
                }
            }
            Some(Class::Continuation) => length_with_backslashes(self.syntax, rest),
            Some(Class::Quotation) => string_length(rest),
            Some(_) => 1,
            None => 0,
        };
        &rest[..length]
    }

    /// Passes over a word that begins at `at`.
    #[inline]
    fn pass(&mut self, word: &[u8]) {
        self.line = self.here;
        if word[0] == b'"' {
            for _ in 0..word.len() {
                if self.syntax.class(self.bytes[self.at]) == Class::LineEnd {
                    self.end_line();
                }
                self.at += 1;
            }
        } else {
            self.at += word.len();
        }
    }

    /// The next word, which stays.
    #[inline]
    pub fn peek(&mut self) -> Option<&'a [u8]> {
        self.seek();
        Some(self.word()).filter(|word| !word.is_empty())
    }

    /// The next word.
    #[allow(clippy::should_implement_trait)] // An iterator lends itself to loops that could not ask for numbers.
    #[inline]
    pub fn next(&mut self) -> Option<&'a [u8]> {
        let word = self.peek()?;
        self.pass(word);
        Some(word)
    }

    /// The next word, if it stands in the line of the word that was read last.
    #[inline]
    pub fn next_on_line(&mut self) -> Option<&'a [u8]> {
        let (at, here, joined) = (self.at, self.here, self.joined);
        match self.peek() {
            Some(word) if self.here - self.joined == here - joined => {
                self.pass(word);
                Some(word)
            }
            _ => {
                (self.at, self.here, self.joined) = (at, here, joined);
                None
            }
        }
    }

    /// The next word, which stays, if it stands in the line of the word that was read last.
    pub fn peek_on_line(&mut self) -> Option<&'a [u8]> {
        let (at, here, line, joined) = (self.at, self.here, self.line, self.joined);
        let word = self.next_on_line();
        (self.at, self.here, self.line, self.joined) = (at, here, line, joined);
        word
    }

    /// Passes over as many words.
    ///
    /// # Errors
    /// The file ends.
    pub fn skip(&mut self, words: usize, what: &str) -> Result<(), Fault> {
        (0..words).try_for_each(|_| self.need(what).map(|_| ()))
    }

    /// Passes over the rest of the line.
    pub fn skip_line(&mut self) {
        while let Some(&byte) = self.bytes.get(self.at) {
            match self.syntax.class(byte) {
                Class::LineEnd => return,
                Class::Continuation if self.continues() => self.join(),
                _ => {}
            }
            self.at += 1;
        }
    }

    /// The next word; `what` says for whom.
    ///
    /// # Errors
    /// The file ends.
    #[inline]
    pub fn need(&mut self, what: &str) -> Result<&'a [u8], Fault> {
        self.next().ok_or_else(|| self.fault(format!("the file ends within {what}"), "the file is truncated"))
    }

    /// Passes over a word that must be `expected`.
    ///
    /// # Errors
    /// It is another one.
    pub fn expect(&mut self, expected: &str, what: &str) -> Result<(), Fault> {
        let word = self.need(what)?;
        if word == expected.as_bytes() {
            return Ok(());
        }
        Err(self.fault(format!("{what} needs `{expected}` here, but there is {}", quote_bytes(word)), ""))
    }

    /// The next word as a finite number: `1`, `1.`, `.5`, `+1`, `-3e-2`, `1.e5`.
    ///
    /// # Errors
    /// It is none; `what` says for whom it was.
    #[inline]
    pub fn number(&mut self, what: &str) -> Result<f64, Fault> {
        match self.plain_number() {
            Some(value) => Ok(value),
            None => self.other_number(what),
        }
    }

    /// The next word as a number, if it is of the kind that most are. Otherwise, whatever it is, it stays.
    #[inline]
    pub fn plain_number(&mut self) -> Option<f64> {
        self.seek();
        // A number that ends at a blank is a word of its own: no need to look for its end first
        let blank = |byte| matches!(self.syntax.class(byte), Class::Blank | Class::LineEnd);
        let (value, length) = number::plain_double(&self.bytes[self.at..], blank)?;
        self.line = self.here;
        self.at += length;
        Some(value)
    }

    /// The numbers in the rest of the line of the word that was read last, if they are so many and of the kind that most
    /// are. Otherwise all of the line stays.
    #[inline]
    pub fn plain_numbers_on_line<const N: usize>(&mut self) -> Option<[f64; N]> {
        let (at, here, line, joined) = (self.at, self.here, self.line, self.joined);
        let mut values = [0.0; N];
        let read = values.iter_mut().all(|value| {
            self.plain_number().map(|number| *value = number).is_some() && self.here - self.joined == here - joined
        });
        if read && self.peek_on_line().is_none() {
            return Some(values);
        }
        (self.at, self.here, self.line, self.joined) = (at, here, line, joined);
        None
    }

    /// Numbers with an exponent or many digits, right before punctuation, not finite, or none at all.
    fn other_number(&mut self, what: &str) -> Result<f64, Fault> {
        let word = self.need(what)?;
        match number::double(word) {
            Some((value, length)) if length == word.len() && value.is_finite() => Ok(value),
            _ => Err(self.no_number(word, what)),
        }
    }

    #[cold]
    fn no_number(&self, word: &[u8], what: &str) -> Fault {
        let kind = if number::double(word).is_some() { "a finite number" } else { "a number" };
        self.fault(format!("{what}: {} is not {kind}", quote_bytes(word)), "")
    }

    /// As many numbers.
    ///
    /// # Errors
    /// As [`Words::number`].
    pub fn numbers<const N: usize>(&mut self, what: &str) -> Result<[f64; N], Fault> {
        let mut values = [0.0; N];
        for value in &mut values {
            *value = self.number(what)?;
        }
        Ok(values)
    }

    /// The next word as a whole number, which may be negative.
    ///
    /// # Errors
    /// It is none.
    #[inline]
    pub fn integer(&mut self, what: &str) -> Result<i64, Fault> {
        self.seek();
        if let Some((value, length)) = number::integer(&self.bytes[self.at..]) {
            self.line = self.here;
            self.at += length;
            return Ok(value);
        }
        let word = self.need(what)?;
        match number::integer(word) {
            Some((value, length)) if length == word.len() => Ok(value),
            _ => Err(self.fault(format!("{what}: {} is not a whole number", quote_bytes(word)), "")),
        }
    }

    /// The next word as an index below `count`.
    ///
    /// # Errors
    /// It is none.
    #[inline]
    pub fn index(&mut self, count: usize, what: &str) -> Result<usize, Fault> {
        let index = self.integer(what)?;
        match usize::try_from(index) {
            Ok(index) if index < count => Ok(index),
            _ => {
                let hint = if count == 0 { "there are none".into() } else { format!("give 0 to {}", count - 1) };
                Err(self.fault(format!("{what}: index {index} is out of range"), hint))
            }
        }
    }

    /// The next word as a number of things that follow, each of `least` bytes or more: so many that the rest of the file
    /// can hold them, so that memory may be set aside for them.
    ///
    /// # Errors
    /// It is no such number.
    pub fn count(&mut self, least: usize, what: &str) -> Result<usize, Fault> {
        let count = self.integer(what)?;
        let Ok(wanted) = usize::try_from(count) else {
            return Err(self.fault(format!("{what}: {count} is negative"), "write a number of 0 or more"));
        };
        // The last one may lack the blank behind it
        if wanted.saturating_mul(least) > self.left() + 1 {
            let left = self.left();
            let problem = format!("{what}: {wanted} cannot stand in the {left} bytes that are left of the file");
            return Err(self.fault(problem, "the file is truncated or the number is wrong"));
        }
        Ok(wanted)
    }
}

/// True if a backslash at the start is the last byte of its line, or of the file.
fn is_last(syntax: &Syntax, bytes: &[u8]) -> bool {
    bytes.get(1).is_none_or(|&b| syntax.class(b) == Class::LineEnd)
}

/// Length of a word that may have backslashes in it, but does not end with one that continues the line.
#[cold]
fn length_with_backslashes(syntax: &Syntax, bytes: &[u8]) -> usize {
    let ends = |at: usize| match syntax.class(bytes[at]) {
        Class::Word => false,
        Class::Continuation => is_last(syntax, &bytes[at..]),
        _ => true,
    };
    (0..bytes.len()).find(|&at| ends(at)).unwrap_or(bytes.len())
}

/// Length of a string with its marks; one that does not end goes to the end of the file.
fn string_length(bytes: &[u8]) -> usize {
    let mut at = 1;
    while let Some(&byte) = bytes.get(at) {
        match byte {
            b'"' => return at + 1,
            b'\\' => at += 2,
            _ => at += 1,
        }
    }
    bytes.len()
}

#[cfg(test)]
mod tests;
