//! The encoding of a text: UTF-16 is converted to UTF-8, and a text with a zero byte inside a word is refused.

use super::Fault;

/// A UTF-8 byte order mark.
const UTF8: &[u8] = b"\xef\xbb\xbf";

/// Converts a text with a byte order mark to UTF-8 without one. A text without a mark is returned unchanged, in any
/// encoding that extends ASCII.
///
/// # Errors
/// The text is UTF-32, or not valid UTF-16.
pub fn to_utf8(mut bytes: Vec<u8>) -> Result<Vec<u8>, Fault> {
    let refuse = |encoding: &str| {
        Err(Fault::new(Some(1), format!("the text is {encoding}"), "save it in another encoding, such as UTF-8"))
    };
    match bytes.as_slice() {
        [0xff, 0xfe, 0, 0, ..] | [0, 0, 0xfe, 0xff, ..] => refuse("encoded in UTF-32"),
        [0xff, 0xfe, rest @ ..] => utf16(rest, u16::from_le_bytes).map_or_else(|| refuse("not valid UTF-16"), Ok),
        [0xfe, 0xff, rest @ ..] => utf16(rest, u16::from_be_bytes).map_or_else(|| refuse("not valid UTF-16"), Ok),
        _ if bytes.starts_with(UTF8) => {
            bytes.drain(..UTF8.len());
            Ok(bytes)
        }
        _ => Ok(bytes),
    }
}

fn utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Option<Vec<u8>> {
    let (pairs, odd) = bytes.as_chunks();
    let text: Result<String, _> = char::decode_utf16(pairs.iter().map(|&pair| unit(pair))).collect();
    text.ok().filter(|_| odd.is_empty()).map(String::into_bytes)
}

/// Refuses a text with zero bytes inside a word, as UTF-16 without a byte order mark has them. Comments, which a word
/// with `#` or `%` begins, may have them.
///
/// # Errors
/// The first line with such a word.
pub fn refuse_zeros(bytes: &[u8]) -> Result<(), Fault> {
    if bytes.contains(&0) { find_zero(bytes).map_or(Ok(()), |line| Err(zero_in(line))) } else { Ok(()) }
}

/// The error that a line has a zero byte inside a word.
fn zero_in(line: usize) -> Fault {
    let hint = "if the text is UTF-16, save it as UTF-8; a binary file has another format";
    Fault::new(Some(line), "there is a zero byte inside a word", hint)
}

/// The line of the first zero byte between two bytes of a word that is not in a comment.
#[cold]
fn find_zero(bytes: &[u8]) -> Option<usize> {
    // Lines are counted by the rule of all text formats: LF, CRLF or CR.
    let (mut line, mut comment, mut before, mut zeros) = (1, false, b' ', false);
    for (i, &byte) in bytes.iter().enumerate() {
        match byte {
            b'\n' | b'\r' => {
                line += usize::from(!(byte == b'\r' && bytes.get(i + 1) == Some(&b'\n')));
                (comment, before, zeros) = (false, b' ', false);
            }
            0 => zeros = true,
            1..=b' ' => (before, zeros) = (b' ', false),
            _ => {
                comment |= before == b' ' && matches!(byte, b'#' | b'%');
                if zeros && before != b' ' && !comment {
                    return Some(line);
                }
                (before, zeros) = (byte, false);
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_with_a_byte_order_mark_become_utf8() {
        let text = "v 12 0\n# ü😀\n";
        let units: Vec<u16> = std::iter::once(0xfeff).chain(text.encode_utf16()).collect();
        let little: Vec<u8> = units.iter().flat_map(|unit| unit.to_le_bytes()).collect();
        let big: Vec<u8> = units.iter().flat_map(|unit| unit.to_be_bytes()).collect();
        for bytes in [little.clone(), big, text.into(), [UTF8, text.as_bytes()].concat()] {
            assert_eq!(to_utf8(bytes).unwrap(), text.as_bytes());
        }
        assert_eq!(to_utf8(b"caf\xe9".to_vec()).unwrap(), b"caf\xe9");
        for broken in [&little[..little.len() - 1], b"\xff\xfe\0\xd8", b"\xff\xfe\0\0v\0\0\0", b"\0\0\xfe\xff\0\0\0v"] {
            assert!(to_utf8(broken.to_vec()).unwrap_err().problem.contains("UTF-"), "{broken:?}");
        }
    }

    #[test]
    fn only_zeros_inside_words_are_refused() {
        for text in ["", "v 1 2\0", "v 1 2\0\0\n\0\0v 3\0", "# a\0b\nv 1", "v 1 # a\0b", "% a\0b", "v\0 1\0 2"] {
            assert_eq!(refuse_zeros(text.as_bytes()), Ok(()), "{text:?}");
        }
        for (text, line) in [("1\x002", 1), ("a\r\nb\r\rv 1\0\x002", 4), ("#\n a\0b", 2), ("a#b\0c", 1)] {
            assert_eq!(refuse_zeros(text.as_bytes()).unwrap_err().line, Some(line), "{text:?}");
        }
    }
}
