//! Parses numbers at the start of a slice of bytes; each function returns the value and the length of its text.
//!
//! Almost every coordinate in a file has few digits. Its mantissa and its power of ten are then exact floats, so that
//! one division rounds correctly (Clinger 1990). All other numbers are parsed by the standard library, which gives the
//! same bits.

/// Powers of ten that are exact in single precision (5^10 < 2^24).
const EXACT_F32: [f32; 11] = [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10];

/// Powers of ten that are exact in double precision (5^22 < 2^53).
const EXACT_F64: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20,
    1e21, 1e22,
];

/// Length of the token at the start: all bytes above the space.
#[inline]
pub fn token_length(bytes: &[u8]) -> usize {
    bytes.iter().position(|&b| is_blank(b)).unwrap_or(bytes.len())
}

/// True for a byte that ends a token.
#[inline(always)]
fn is_blank(byte: u8) -> bool {
    byte <= b' '
}

/// True if a number ends at `at`: there is a blank byte, or the end of the slice.
#[inline(always)]
fn ends(bytes: &[u8], at: usize, blank: impl Fn(u8) -> bool) -> bool {
    bytes.get(at).is_none_or(|&b| blank(b))
}

/// A plain decimal: digits with at most one point, no exponent, at most 19 digits.
struct Decimal {
    negative: bool,
    mantissa: u64,
    /// Number of digits after the point.
    places: usize,
    length: usize,
}

/// Parses a [`Decimal`] that is followed by a `blank` byte or the end of the slice.
#[inline(always)]
fn decimal(bytes: &[u8], blank: impl Fn(u8) -> bool) -> Option<Decimal> {
    let negative = bytes.first() == Some(&b'-');
    let mut at = usize::from(negative);
    let mut mantissa = 0u64;
    let start = at;
    while let Some(digit) = bytes.get(at).map(|b| b.wrapping_sub(b'0')).filter(|&d| d < 10) {
        mantissa = mantissa.wrapping_mul(10).wrapping_add(digit.into());
        at += 1;
    }
    let mut digits = at - start;
    let mut places = 0;
    if bytes.get(at) == Some(&b'.') {
        at += 1;
        let start = at;
        while let Some(digit) = bytes.get(at).map(|b| b.wrapping_sub(b'0')).filter(|&d| d < 10) {
            mantissa = mantissa.wrapping_mul(10).wrapping_add(digit.into());
            at += 1;
        }
        places = at - start;
        digits += places;
    }
    ((1..=19).contains(&digits) && ends(bytes, at, blank)).then_some(Decimal { negative, mantissa, places, length: at })
}

/// Parses a number in single precision, correctly rounded. The texts `inf` and `NaN` are accepted.
#[inline]
pub fn float(bytes: &[u8]) -> Option<(f32, usize)> {
    match decimal(bytes, is_blank) {
        Some(d) if d.mantissa <= 1 << 24 && d.places < EXACT_F32.len() => {
            let value = d.mantissa as f32 / EXACT_F32[d.places];
            Some((if d.negative { -value } else { value }, d.length))
        }
        _ => by_standard_library(bytes),
    }
}

/// Parses a number in double precision with few digits, no exponent, and a blank after it, as most numbers are. `None`
/// does not mean that there is no number.
#[inline(always)]
pub fn plain_double(bytes: &[u8], blank: impl Fn(u8) -> bool) -> Option<(f64, usize)> {
    let d = decimal(bytes, blank)?;
    (d.mantissa <= 1 << 53 && d.places < EXACT_F64.len()).then(|| {
        let value = d.mantissa as f64 / EXACT_F64[d.places];
        (if d.negative { -value } else { value }, d.length)
    })
}

/// Parses a number in double precision, correctly rounded. The texts `inf` and `NaN` are accepted.
#[inline]
pub fn double(bytes: &[u8]) -> Option<(f64, usize)> {
    plain_double(bytes, is_blank).or_else(|| by_standard_library(bytes))
}

/// Parses an integer of at most 18 digits.
#[inline]
pub fn integer(bytes: &[u8]) -> Option<(i64, usize)> {
    let negative = bytes.first() == Some(&b'-');
    let mut at = usize::from(negative || bytes.first() == Some(&b'+'));
    let start = at;
    let mut value = 0i64;
    while let Some(digit) = bytes.get(at).map(|b| b.wrapping_sub(b'0')).filter(|&d| d < 10) {
        value = value.wrapping_mul(10).wrapping_add(digit.into());
        at += 1;
    }
    ((1..=18).contains(&(at - start)) && ends(bytes, at, is_blank))
        .then_some((if negative { value.wrapping_neg() } else { value }, at))
}

#[cold]
fn by_standard_library<T: std::str::FromStr>(bytes: &[u8]) -> Option<(T, usize)> {
    let length = token_length(bytes);
    let value = std::str::from_utf8(&bytes[..length]).ok()?.parse().ok()?;
    Some((value, length))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_the_standard_library() {
        let texts = "0 -0 1 +1 -.5 .5 5. 1.e5 1e-3 -1E+3 16777216 16777217 0.1 3.4028235e38 1e39 1e-45 0.0503644 \
            -123456.789012345678 99999999999999999999999 00000000000000000000001 0.00000000001 1e-400 9007199254740993";
        for text in texts.split_ascii_whitespace() {
            let line = format!("{text} 7");
            let expected: f32 = text.parse().unwrap();
            let (value, length) = float(line.as_bytes()).expect(text);
            assert_eq!((value.to_bits(), length), (expected.to_bits(), text.len()), "{text}");
            let expected: f64 = text.parse().unwrap();
            let (value, length) = double(line.as_bytes()).expect(text);
            assert_eq!((value.to_bits(), length), (expected.to_bits(), text.len()), "{text}");
        }
    }

    /// Covers all numbers of digits before and after the point, followed by every kind of byte or by the end of the
    /// slice.
    #[test]
    fn any_number_of_digits_is_parsed() {
        let pool = "9182736450918273645";
        for whole in 0..=pool.len() {
            for places in 0..=pool.len() - whole {
                let point = if places > 0 { "." } else { "" };
                let text = format!("{}{point}{}", &pool[..whole], &pool[whole..whole + places]);
                let expected: Option<f64> = text.parse().ok();
                for behind in ["", " ", "\n7", "\t00000000000", " \u{e9}\u{ffff}-----"] {
                    let line = format!("{text}{behind}");
                    assert_eq!(double(line.as_bytes()), expected.map(|x| (x, text.len())), "{line}");
                    let whole: Option<i64> = text.parse().ok().filter(|_| text.len() <= 18);
                    assert_eq!(integer(line.as_bytes()), whole.map(|x| (x, text.len())), "{line}");
                }
                // Bytes on either side of the digits
                for byte in (0..=255).filter(|b| *b > b' ' && !b"0123456789.eE+-".contains(b)) {
                    let line = [text.as_bytes(), &[byte], b"12345678"].concat();
                    assert_eq!((double(&line), integer(&line)), (None, None), "{text} {byte}");
                }
            }
        }
    }

    #[test]
    fn refuses_other_texts() {
        for text in ["", "-", "+", ".", "-.", "1..2", "1,5", "1e", "0x10", "one", "1-", "--1", "1_000"] {
            assert!(float(text.as_bytes()).is_none(), "{text}");
            assert!(double(text.as_bytes()).is_none(), "{text}");
        }
        for text in ["", "-", "1.0", "1e3", "12a", "1234567890123456789", "+-1"] {
            assert!(integer(text.as_bytes()).is_none(), "{text}");
        }
        assert_eq!(integer(b"-17\n"), Some((-17, 3)));
        assert_eq!(integer(b"+17"), Some((17, 3)));
    }
}
