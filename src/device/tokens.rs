//! WGSL reduced to its tokens, for identities that do not depend on comments or layout.

/// The text without comments, and with white space only where joining its neighbours would make another token. Two
/// texts with equal results have equal tokens.
pub(super) fn tokens(text: &str) -> String {
    let text = without_comments(text);
    let mut tokens = String::with_capacity(text.len());
    for word in text.split_whitespace() {
        let joins = |before: char, after: char| {
            (is_word(before) && is_word(after)) || (is_operator(before) && is_operator(after))
        };
        if let (Some(before), Some(after)) = (tokens.chars().last(), word.chars().next())
            && joins(before, after)
        {
            tokens.push(' ');
        }
        tokens.push_str(word);
    }
    tokens
}

/// Replaces each comment by a space. Line comments end with their line; block comments nest. WGSL has no strings.
fn without_comments(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find("//").into_iter().chain(rest.find("/*")).min() {
        out.push_str(&rest[..at]);
        out.push(' ');
        rest = &rest[at..];
        let length = if rest.starts_with("//") { rest.find('\n').unwrap_or(rest.len()) } else { block_length(rest) };
        rest = &rest[length..];
    }
    out + rest
}

/// Bytes of the block comment that `text` begins with; all of it where the comment does not end.
fn block_length(text: &str) -> usize {
    let (mut depth, mut at) = (0, 0);
    let bytes = text.as_bytes();
    while at < bytes.len() {
        match &bytes[at..bytes.len().min(at + 2)] {
            b"/*" => depth += 1,
            b"*/" => depth -= 1,
            _ => {
                at += 1;
                continue;
            }
        }
        at += 2;
        if depth == 0 {
            return at;
        }
    }
    bytes.len()
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_' || c == '.'
}

fn is_operator(c: char) -> bool {
    "+-*/%&|^!<>=:".contains(c)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_and_layout_make_no_difference() {
        let plain = "fn f(a: u32) -> u32 { return a - 1u; }";
        for same in [
            "fn f(a: u32) -> u32 { // what it does\n    return a - 1u;\n}\n",
            "fn f( a : u32 )->u32{return a-1u;}",
            "/* a /* nested */ one */ fn f(a: u32) /**/ -> u32 { return/**/a - 1u; }",
        ] {
            assert_eq!(tokens(same), tokens(plain), "{same}");
        }
    }

    #[test]
    fn other_tokens_make_a_difference() {
        let plain = tokens("let a = b - -c; let d = e < f;");
        for other in ["let a = b - c; let d = e < f;", "let a = b --c; let d = e < f;", "let ab - -c; let d = e < f;"] {
            assert_ne!(tokens(other), plain, "{other}");
        }
        assert_ne!(tokens("a b"), tokens("ab"));
        assert_ne!(tokens("1 .5"), tokens("1.5"));
        assert_ne!(tokens("a /b"), tokens("a //b"));
    }

    #[test]
    fn a_comment_without_an_end_takes_the_rest() {
        assert_eq!(tokens("a /* b"), "a");
        assert_eq!(tokens("a /*/"), "a");
        assert_eq!(tokens("a // b"), "a");
    }
}
