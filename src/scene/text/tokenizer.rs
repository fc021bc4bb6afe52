//! Splits a text into tokens with line numbers, without copying. The text may have any encoding that extends ASCII.

use super::{Fault, quote_bytes};
use super::{number, odd};

/// The meaning of a byte.
#[derive(Clone, Copy, PartialEq, Eq)]
enum ByteClass {
    /// A part of a word.
    Word,
    /// Separates tokens.
    Blank,
    /// Separates tokens, and ends a line and a comment.
    LineEnd,
    /// A token of one byte, which also ends the token before it.
    Punctuation,
    /// Starts a comment until the end of the line, even directly after a word.
    Comment,
    /// Starts a string, which ends with the next quotation mark.
    Quotation,
    /// Directly before the end of a line it turns that into a blank; elsewhere it is a part of a word.
    Continuation,
}

/// The meaning of all bytes in a format. All bytes up to the space are blanks.
pub struct Syntax {
    classes: [ByteClass; 256],
}

impl Syntax {
    /// The bytes in `comments` start a comment, those in `punctuation` are tokens. A quotation mark in `punctuation`
    /// starts a string: one token, which includes both marks, and in which a backslash escapes the next byte.
    pub const fn new(comments: &[u8], punctuation: &[u8]) -> Syntax {
        let mut classes = [ByteClass::Word; 256];
        let mut byte = 0;
        while byte <= b' ' as usize {
            classes[byte] = ByteClass::Blank;
            byte += 1;
        }
        classes[b'\n' as usize] = ByteClass::LineEnd;
        classes[b'\r' as usize] = ByteClass::LineEnd;
        let mut i = 0;
        while i < comments.len() {
            classes[comments[i] as usize] = ByteClass::Comment;
            i += 1;
        }
        let mut i = 0;
        while i < punctuation.len() {
            let class = if punctuation[i] == b'"' { ByteClass::Quotation } else { ByteClass::Punctuation };
            classes[punctuation[i] as usize] = class;
            i += 1;
        }
        Syntax { classes }
    }

    /// Makes the bytes in `blanks` separate tokens, as spaces do.
    pub const fn with_blanks(mut self, blanks: &[u8]) -> Syntax {
        let mut i = 0;
        while i < blanks.len() {
            self.classes[blanks[i] as usize] = ByteClass::Blank;
            i += 1;
        }
        self
    }

    /// Makes a backslash directly before the end of a line continue the line, and also a comment.
    pub const fn with_continued_lines(mut self) -> Syntax {
        self.classes[b'\\' as usize] = ByteClass::Continuation;
        self
    }

    #[inline(always)]
    fn class(&self, byte: u8) -> ByteClass {
        self.classes[byte as usize]
    }
}

/// Reads the tokens of a text in order. Lines end with LF, CRLF or CR.
#[derive(Clone)]
pub struct Tokenizer<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) syntax: &'a Syntax,
    pub(super) at: usize,
    /// Line of the byte at `at`, counted from 1.
    pub(super) here: usize,
    /// Line in which the last token began.
    pub(super) line: usize,
    /// Number of line ends so far that a backslash removed.
    pub(super) joined: usize,
}

impl<'a> Tokenizer<'a> {
    /// A tokenizer at the start of `bytes`.
    pub fn new(bytes: &'a [u8], syntax: &'a Syntax) -> Tokenizer<'a> {
        Tokenizer { bytes, syntax, at: 0, here: 1, line: 1, joined: 0 }
    }

    /// Line of the last token, counted from 1.
    pub fn line(&self) -> usize {
        self.line
    }

    /// Number of bytes that have not been read.
    pub fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// An error in the line of the last token.
    #[cold]
    pub fn fault(&self, problem: impl Into<String>, hint: impl Into<String>) -> Fault {
        Fault::new(Some(self.line), problem, hint)
    }

    /// Counts the end of a line at `at`.
    #[inline(always)]
    fn end_line(&mut self) {
        // In CRLF only the second byte is counted.
        let half = self.bytes[self.at] == b'\r' && self.bytes.get(self.at + 1) == Some(&b'\n');
        self.here += usize::from(!half);
    }

    /// Advances to the next token.
    #[inline]
    pub(super) fn seek(&mut self) {
        while let Some(&byte) = self.bytes.get(self.at) {
            match self.syntax.class(byte) {
                ByteClass::Blank => {}
                ByteClass::LineEnd => self.end_line(),
                ByteClass::Comment => {
                    while self.bytes.get(self.at + 1).is_some_and(|&b| self.syntax.class(b) != ByteClass::LineEnd) {
                        self.at += 1;
                    }
                }
                ByteClass::Continuation if self.continues() => self.join(),
                ByteClass::Word | ByteClass::Punctuation | ByteClass::Quotation | ByteClass::Continuation => return,
            }
            self.at += 1;
        }
    }

    /// True if the byte at `at`, a backslash, is the last of its line.
    fn continues(&self) -> bool {
        is_last(self.syntax, &self.bytes[self.at..])
    }

    /// Advances from a backslash to the last byte of the line end that it removes.
    #[cold]
    fn join(&mut self) {
        let ends = &self.bytes[self.at + 1..];
        if !ends.is_empty() {
            self.at += if ends.starts_with(b"\r\n") { 2 } else { 1 };
            self.here += 1;
            self.joined += 1;
        }
    }

    /// The token that starts at `at`; empty at the end of the text.
    #[inline]
    fn word(&self) -> &'a [u8] {
        let rest = &self.bytes[self.at..];
        let length = match rest.first().map(|&b| self.syntax.class(b)) {
            Some(ByteClass::Word) => {
                let length = rest.iter().position(|&b| self.syntax.class(b) != ByteClass::Word).unwrap_or(rest.len());
                match rest.get(length).map(|&b| self.syntax.class(b)) {
                    Some(ByteClass::Continuation) => length_with_backslashes(self.syntax, rest),
                    Some(ByteClass::Comment | ByteClass::Punctuation) if matches!(rest[length], b'#' | b'(') => {
                        length_of_none(rest, length)
                    }
                    _ => length,
                }
            }
            Some(ByteClass::Continuation) => length_with_backslashes(self.syntax, rest),
            Some(ByteClass::Quotation) => string_length(rest),
            Some(_) => 1,
            None => 0,
        };
        &rest[..length]
    }

    /// Advances past the token that starts at `at`.
    #[inline]
    fn pass(&mut self, word: &[u8]) {
        self.line = self.here;
        if word[0] == b'"' {
            for _ in 0..word.len() {
                if self.syntax.class(self.bytes[self.at]) == ByteClass::LineEnd {
                    self.end_line();
                }
                self.at += 1;
            }
        } else {
            self.at += word.len();
        }
    }

    /// The next token; the position does not change.
    #[inline]
    pub fn peek(&mut self) -> Option<&'a [u8]> {
        self.seek();
        Some(self.word()).filter(|word| !word.is_empty())
    }

    /// Reads the next token; `None` at the end of the text.
    #[allow(clippy::should_implement_trait)] // A loop over an iterator could not read numbers in its body.
    #[inline]
    pub fn next(&mut self) -> Option<&'a [u8]> {
        let word = self.peek()?;
        self.pass(word);
        Some(word)
    }

    /// The bytes from the start of the next token to white space, whatever they mean; the position does not change.
    pub fn peek_to_space(&mut self) -> &'a [u8] {
        self.seek();
        let rest = &self.bytes[self.at..];
        &rest[..rest.iter().position(|&byte| byte <= b' ').unwrap_or(rest.len())]
    }

    /// Reads the next `length` bytes of [`Tokenizer::peek_to_space`] as one token.
    pub fn take(&mut self, length: usize) -> &'a [u8] {
        self.line = self.here;
        self.at += length;
        &self.bytes[self.at - length..self.at]
    }

    /// Reads the next token if it is in the line of the last one.
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

    /// The next token if it is in the line of the last one; the position does not change.
    pub fn peek_on_line(&mut self) -> Option<&'a [u8]> {
        let (at, here, line, joined) = (self.at, self.here, self.line, self.joined);
        let word = self.next_on_line();
        (self.at, self.here, self.line, self.joined) = (at, here, line, joined);
        word
    }

    /// Skips this number of tokens.
    ///
    /// # Errors
    /// The text ends before.
    pub fn skip(&mut self, count: usize, context: &str) -> Result<(), Fault> {
        (0..count).try_for_each(|_| self.need(context).map(|_| ()))
    }

    /// Skips the rest of the line.
    pub fn skip_line(&mut self) {
        while let Some(&byte) = self.bytes.get(self.at) {
            match self.syntax.class(byte) {
                ByteClass::LineEnd => return,
                ByteClass::Continuation if self.continues() => self.join(),
                _ => {}
            }
            self.at += 1;
        }
    }

    /// Reads the next token. In this and the following functions `context` names the construct for messages.
    ///
    /// # Errors
    /// The text ends.
    #[inline]
    pub fn need(&mut self, context: &str) -> Result<&'a [u8], Fault> {
        self.next().ok_or_else(|| self.fault(format!("the file ends within {context}"), "the file is truncated"))
    }

    /// Reads the token `expected`.
    ///
    /// # Errors
    /// The next token is another one.
    pub fn expect(&mut self, expected: &str, context: &str) -> Result<(), Fault> {
        let word = self.need(context)?;
        if word == expected.as_bytes() {
            return Ok(());
        }
        Err(self.fault(format!("{context} needs `{expected}` here, but there is {}", quote_bytes(word)), ""))
    }

    /// Reads the next token if it is a number that [`number::plain_double`] can parse; otherwise reads nothing.
    #[inline]
    pub fn plain_number(&mut self) -> Option<f64> {
        self.seek();
        // A number that ends at a blank is a whole token, so its end need not be searched first.
        let blank = |byte| matches!(self.syntax.class(byte), ByteClass::Blank | ByteClass::LineEnd);
        let (value, length) = number::plain_double(&self.bytes[self.at..], blank)?;
        self.line = self.here;
        self.at += length;
        Some(value)
    }

    /// Reads the rest of the line if it is exactly `N` numbers that [`number::plain_double`] can parse; otherwise reads
    /// nothing.
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
}

/// True if a backslash at the start is the last byte of its line or of the text.
fn is_last(syntax: &Syntax, bytes: &[u8]) -> bool {
    bytes.get(1).is_none_or(|&b| syntax.class(b) == ByteClass::LineEnd)
}

/// Length of a word with backslashes; a backslash that continues the line is not part of it.
#[cold]
fn length_with_backslashes(syntax: &Syntax, bytes: &[u8]) -> usize {
    let ends = |at: usize| match syntax.class(bytes[at]) {
        ByteClass::Word => false,
        ByteClass::Continuation => is_last(syntax, &bytes[at..]),
        _ => true,
    };
    (0..bytes.len()).find(|&at| ends(at)).unwrap_or(bytes.len())
}

/// Length of a word that ends at `length` with `#` or `(`, unless these are parts of a number that is none, such as
/// `-1.#IND` and `-nan(ind)`.
#[cold]
fn length_of_none(bytes: &[u8], length: usize) -> usize {
    let end = bytes[length..].iter().position(|&b| b <= b' ').map_or(bytes.len(), |at| length + at);
    let whole = match bytes[length] {
        b'(' => bytes[length..end].iter().position(|&b| b == b')').map(|at| length + at + 1),
        _ => {
            let letters = bytes[length + 1..end].iter().take_while(|b| b.is_ascii_alphanumeric() || b"+-".contains(b));
            Some(length + 1 + letters.count())
        }
    };
    let none = |end: &usize| odd::value(&bytes[..*end]).is_some();
    whole.filter(none).unwrap_or(length)
}

/// Length of a string, including its quotation marks. An unterminated string extends to the end of the text.
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
