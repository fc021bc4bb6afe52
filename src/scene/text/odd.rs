//! Numbers in notations that no format defines, but that programs write: what `printf` makes of a number that is none,
//! and Fortran's exponents.

use super::number;

/// The spellings of a number that is none, in lower case and without a sign. Scripting languages write the words of the
/// second line.
const NONE: [&[u8]; 11] = [
    b"nan",
    b"qnan",
    b"snan",
    b"nanq",
    b"nans",
    b"ind", //
    b"null",
    b"none",
    b"undefined",
    b"n/a",
    b"#n/a",
];

/// The letters after `1.#`, as the C library of Windows writes them; digits and exponents may follow.
const AFTER_HASH: [&[u8]; 6] = [b"ind", b"qnan", b"snan", b"inf", b"nan", b"j"];

/// The value of a word that is no number in the usual notation: NaN or infinity for the spellings of those, a number
/// for Fortran's exponents (`2.5D+01`). `None` for every other word.
#[cold]
pub fn value(word: &[u8]) -> Option<f64> {
    let whole = |found: (f64, usize)| (found.1 == word.len()).then_some(found.0);
    if let Some(value) = number::double(word).and_then(whole) {
        return Some(value);
    }
    if is_none(word) {
        return Some(f64::NAN);
    }
    let (negative, unsigned) = split_sign(word);
    let infinite = after_hash(unsigned).is_some_and(|letters| starts_with(letters, b"inf"));
    if infinite {
        return Some(if negative { f64::NEG_INFINITY } else { f64::INFINITY });
    }
    fortran(word)
}

/// True for the spellings of a number that is none: `nan`, `-nan(ind)`, `1.#QNAN`, `-1.#IND00`, `*****` and others.
fn is_none(word: &[u8]) -> bool {
    let (_, word) = split_sign(word);
    let plain = |word: &[u8]| NONE.iter().any(|none| word.eq_ignore_ascii_case(none));
    let in_parentheses = |word: &[u8]| match word.iter().position(|&b| b == b'(') {
        Some(at) => plain(&word[..at]) && word.ends_with(b")"),
        None => false,
    };
    let windows = after_hash(word).is_some_and(|letters| !starts_with(letters, b"inf"));
    let overflow = word.len() > 1 && word.iter().all(|&b| b == b'*');
    plain(word) || in_parentheses(word) || windows || overflow
}

/// The bytes after `1.#`, if they begin with the letters of a number that is none.
pub fn after_hash(word: &[u8]) -> Option<&[u8]> {
    let hash = word.iter().position(|&b| b == b'#')?;
    let [digits @ .., b'.' | b','] = &word[..hash] else { return None };
    let letters = &word[hash + 1..];
    let known = AFTER_HASH.iter().any(|known| starts_with(letters, known));
    (known && !digits.is_empty() && digits.iter().all(u8::is_ascii_digit)).then_some(letters)
}

/// A number with the exponent letter D, as Fortran writes double precision.
fn fortran(word: &[u8]) -> Option<f64> {
    let at = word.iter().position(|b| b.eq_ignore_ascii_case(&b'd'))?;
    let mut word = word.to_vec();
    word[at] = b'e';
    number::double(&word).filter(|&(_, length)| length == word.len()).map(|(value, _)| value)
}

fn starts_with(word: &[u8], start: &[u8]) -> bool {
    word.get(..start.len()).is_some_and(|begin| begin.eq_ignore_ascii_case(start))
}

/// Whether the word has a minus sign, and the word without its sign.
pub fn split_sign(word: &[u8]) -> (bool, &[u8]) {
    match word {
        [b'-', rest @ ..] => (true, rest),
        [b'+', rest @ ..] => (false, rest),
        _ => (false, word),
    }
}

/// An index or a count that is written as a number with decimals, such as `3.0`.
#[cold]
pub fn whole(word: &[u8]) -> Option<i64> {
    let (value, length) = number::double(word)?;
    (length == word.len() && value.fract() == 0.0 && value.abs() < 1e15).then_some(value as i64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_are_none_are_recognised_in_every_spelling() {
        for word in
            "nan NaN -nan +NAN nan(ind) -nan(ind) -nan(snan) nan(0x8000000000000) NaNQ 1.#QNAN -1.#IND -1.#IND00 \
            1.#SNAN 1.#QNAN0 1.#NAN -1.#J 1,#QNAN *** null undefined"
                .split_ascii_whitespace()
        {
            assert!(value(word.as_bytes()).is_some_and(f64::is_nan), "{word}");
        }
        for (word, infinite) in [
            ("inf", f64::INFINITY),
            ("-Infinity", f64::NEG_INFINITY),
            ("1.#INF", f64::INFINITY),
            ("-1.#INF000e+000", f64::NEG_INFINITY),
            ("1e999", f64::INFINITY),
        ] {
            assert_eq!(value(word.as_bytes()), Some(infinite), "{word}");
        }
    }

    #[test]
    fn fortran_exponents_are_numbers_and_other_words_are_not() {
        for (word, number) in [("2.0D0", 2.0), ("3.0d+00", 3.0), ("-1.5D-01", -0.15), ("1D2", 100.0)] {
            assert_eq!(value(word.as_bytes()), Some(number), "{word}");
        }
        for word in
            ["", "-", "zero", "1..2", "1-2", "d", "1d", "1d2d3", "1.#", "1.#X", "a.#IND", "nan)", "nan(", "*", "0x1"]
        {
            assert_eq!(value(word.as_bytes()), None, "{word}");
        }
        assert_eq!([whole(b"3.0"), whole(b"-1.00"), whole(b"1e3")], [Some(3), Some(-1), Some(1000)]);
        assert_eq!([whole(b"1.5"), whole(b"nan"), whole(b"1e300"), whole(b"x")], [None; 4]);
    }
}
