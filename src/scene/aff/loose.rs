//! Reads what is not geometry, of which a part may be missing or unreadable: it never takes what belongs to the next
//! entity.

use crate::scene::text::{Fault, Tokenizer, odd};

/// The words that begin or end something else.
const KEYWORDS: [&[u8]; 28] = [
    b"v", b"b", b"l", b"la", b"f", b"fm", b"s", b"c", b"p", b"pp", b"am", b"a", b"d", b"i", b"k", b"m", b"tpa", b"tt",
    b"ttp", b"x", b"xs", b"{", b"}", b"from", b"at", b"up", b"angle", b"hither",
];

/// Reads up to `N` numbers, which need not be finite and may be on several lines, and returns how many there are.
pub fn numbers<const N: usize>(tokens: &mut Tokenizer, context: &str) -> Result<([f64; N], usize), Fault> {
    let (mut numbers, mut given) = ([0.0; N], 0);
    while given < N {
        // A look at the next line would move to it.
        let before = tokens.clone();
        if tokens.peek().is_none_or(|word| odd::value(word).is_none()) {
            *tokens = before;
            break;
        }
        numbers[given] = tokens.any_number(context)?;
        given += 1;
    }
    Ok((numbers, given))
}

/// The next word of this line, unless something else begins with it.
pub fn peek<'a>(tokens: &mut Tokenizer<'a>) -> Option<&'a [u8]> {
    tokens.peek_on_line().filter(|word| !KEYWORDS.contains(word) && *word != b"resolution")
}

/// True for the words that end a part of a viewpoint.
pub fn ends_view(word: &[u8]) -> bool {
    matches!(word, b"{" | b"}" | b"from" | b"at" | b"up" | b"angle" | b"hither" | b"resolution")
}

/// Skips the words of this line up to the next keyword, and returns the first of them.
pub fn skip_words<'a>(tokens: &mut Tokenizer<'a>) -> Result<Option<&'a [u8]>, Fault> {
    let first = peek(tokens);
    while peek(tokens).is_some() {
        tokens.skip(1, "an entity")?;
    }
    Ok(first)
}

/// Reads three words as a normal. A word that is no number is NaN.
///
/// # Errors
/// The text ends.
pub fn normal(tokens: &mut Tokenizer, context: &str) -> Result<glam::DVec3, Fault> {
    let mut normal = [0.0; 3];
    for part in &mut normal {
        *part = match tokens.plain_number() {
            Some(number) => number,
            None => odd::value(tokens.need(context)?).unwrap_or(f64::NAN),
        };
    }
    Ok(normal.into())
}
