//! Strings without quotes, which extend to the next white space, whatever their bytes mean elsewhere.

/// True for the name of a field that has a string.
pub fn is_string(field: &[u8]) -> bool {
    matches!(field, b"description" | b"filename" | b"label" | b"name" | b"string")
}

/// Length of the string without quotes at the start of `bytes`, which end before white space; `None` if they begin
/// with a string in quotes, a list or the end of a node.
///
/// A brace that closes none of the string's ends the node: the reference implementation has it in the string, and then
/// refuses most of these files. For the same reason a comma at the end is not part of the string.
pub fn length(bytes: &[u8]) -> Option<usize> {
    let mut open = 0;
    let node_ends = |&byte: &u8| {
        match byte {
            b'{' => open += 1,
            b'}' => open -= 1,
            _ => {}
        }
        open < 0
    };
    let mut text = &bytes[..bytes.iter().position(node_ends).unwrap_or(bytes.len())];
    while let [shorter @ .., b','] = text {
        text = shorter;
    }
    let is_list = |close: u8| match text.iter().position(|&byte| byte == close) {
        // Brackets in the name of a file: there is more behind them.
        Some(at) => at + 1 == text.len() || text[1] == b'"',
        None => true,
    };
    let other = match *text.first()? {
        b'"' => true,
        b'[' => is_list(b']'),
        b'(' => is_list(b')'),
        _ => false,
    };
    (!other).then_some(text.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strings_extend_to_white_space_unless_they_are_lists_or_end_a_node() {
        for (text, expected) in [
            ("tex(1).rgb", "tex(1).rgb"),
            ("tex{1}.rgb", "tex{1}.rgb"),
            ("tex{1}}", "tex{1}"),
            ("a.rgb}}", "a.rgb"),
            ("a}Cube{}", "a"),
            ("a,b.rgb", "a,b.rgb"),
            ("a.rgb,", "a.rgb"),
            ("[a].rgb", "[a].rgb"),
            ("(a).rgb", "(a).rgb"),
            ("a\"b", "a\"b"),
        ] {
            let found = length(text.as_bytes()).map(|length| &text[..length]);
            assert_eq!(found, Some(expected), "{text}");
        }
        for text in ["", "}", "\"a\"", "[", "[]", "[a]", "[\"a]b\",", "[a,", "(", "(a)}", "[a]}"] {
            assert_eq!(length(text.as_bytes()), None, "{text}");
        }
    }
}
