//! Tests of tokens, line numbers, numbers and counts.

use super::*;

static AFF: Syntax = Syntax::new(b"#%", b"{}");
static INVENTOR: Syntax = Syntax::new(b"#", b"{}[],\"");

fn all<'a>(text: &'a [u8], syntax: &'a Syntax) -> Vec<(String, usize)> {
    let mut tokens = Tokenizer::new(text, syntax);
    let mut found = Vec::new();
    while let Some(word) = tokens.next() {
        found.push((String::from_utf8_lossy(word).into_owned(), tokens.line()));
    }
    found
}

#[test]
fn tokens_have_their_lines_for_all_line_ends() {
    for end in ["\n", "\r\n", "\r"] {
        let text = ["k a{", "", "% no } word", "1.5#, nor this", "}"].join(end);
        let expected = [("k", 1), ("a", 1), ("{", 1), ("1.5", 4), ("}", 5)];
        let found = all(text.as_bytes(), &AFF);
        assert_eq!(found, expected.map(|(word, line)| (word.to_owned(), line)), "{end:?}");
    }
    assert!(all(b"", &AFF).is_empty());
    assert!(all(b" \n\t#", &AFF).is_empty());
}

#[test]
fn strings_are_one_token_and_may_span_lines() {
    let found = all(b"Info { string \"a {\r\n\\\" b\" } [1,-1]\n\"open", &INVENTOR);
    let tokens: Vec<&str> = found.iter().map(|(word, _)| word.as_str()).collect();
    assert_eq!(tokens, ["Info", "{", "string", "\"a {\r\n\\\" b\"", "}", "[", "1", ",", "-1", "]", "\"open"]);
    assert_eq!([found[3].1, found[4].1, found[10].1], [1, 2, 3]);
    assert_eq!(all(b"\"\\", &INVENTOR).len(), 1, "a backslash at the very end");
}

#[test]
fn a_word_may_contain_any_byte() {
    let mut tokens = Tokenizer::new(b"k M\xfcnch\xc3\xa9n 1", &AFF);
    assert_eq!(tokens.next(), Some(&b"k"[..]));
    let fault = tokens.number("k").unwrap_err();
    assert_eq!(fault.problem, "k: `M\u{fffd}nchén` is not a number");
    assert_eq!(tokens.number("k"), Ok(1.0));
}

#[test]
fn tokens_can_be_read_from_the_same_line_only() {
    let mut tokens = Tokenizer::new(b"l 1 # one\n2 3\n4 5", &AFF);
    assert_eq!(tokens.next_on_line(), Some(&b"l"[..]));
    assert_eq!(tokens.peek_on_line(), Some(&b"1"[..]));
    assert_eq!(tokens.next_on_line(), Some(&b"1"[..]));
    assert_eq!(tokens.peek_on_line(), None);
    assert_eq!(tokens.next_on_line(), None);
    assert_eq!(tokens.line(), 1);
    assert_eq!(tokens.next(), Some(&b"2"[..]));
    tokens.skip_line();
    assert_eq!(tokens.next(), Some(&b"4"[..]));
    assert!(tokens.skip(1, "x").is_ok() && tokens.skip(1, "x").is_err());
}

#[test]
fn numbers_in_all_notations_are_read_and_others_refused() {
    let mut tokens = Tokenizer::new(b"1 1. .5 -.5 1.e5 -3e-2 +1 1E+2 0x1 nan inf 1e400 1,5", &AFF);
    let expected = [1.0, 1.0, 0.5, -0.5, 1e5, -0.03, 1.0, 100.0];
    assert_eq!(tokens.numbers::<8>("x").unwrap(), expected);
    for words_of_error in [
        "`0x1` is not a number",
        "`nan` is not a finite",
        "`inf` is not a finite",
        "`1e400` is not a finite",
        "`1,5` is not a number",
        "ends within x",
    ] {
        let fault = tokens.number("x").unwrap_err();
        assert!(fault.problem.contains(words_of_error), "{}", fault.problem);
    }
}

#[test]
fn counts_are_compared_with_the_file_and_indices_with_counts() {
    let mut tokens = Tokenizer::new(b"3 1 2 3 4 1000000000 -1 99999999999999999999 2 1 7 -1 1.0", &AFF);
    assert_eq!(tokens.count(2, "n"), Ok(3));
    assert_eq!(tokens.numbers::<4>("n"), Ok([1.0, 2.0, 3.0, 4.0]));
    assert!(tokens.count(1, "n").unwrap_err().problem.contains("1000000000 do not fit into the remaining"));
    assert!(tokens.count(1, "n").unwrap_err().problem.contains("negative"));
    assert!(tokens.count(1, "n").unwrap_err().problem.contains("not a whole number"));
    assert_eq!(tokens.index(3, "i"), Ok(2));
    assert_eq!(tokens.index(3, "i"), Ok(1));
    for _ in 0..2 {
        assert!(tokens.index(3, "i").unwrap_err().problem.contains("out of range"));
    }
    assert!(tokens.index(3, "i").unwrap_err().problem.contains("`1.0` is not a whole number"));
}

#[test]
fn the_numbers_of_a_line_are_read_completely_or_not_at_all() {
    static LINES: Syntax = Syntax::new(b"", b"").with_continued_lines();
    for (text, numbers) in [
        ("p 1 -2.5 3\nq", true),
        ("p 1 \\\n -2.5 3", true),
        ("p\t1 -2.5 3 \r\n\r\n4", true),
        ("p 1 -2.5\n3", false),
        ("p\n1 -2.5 3", false),
        ("p 1 -2.5 3 4\n", false),
        ("p 1 -2.5 3 x\n", false),
        ("p 1 -2.5 x\n", false),
        ("p 1 -2.5 3e0\n", false),
        ("p 1 -2.5", false),
        ("p", false),
    ] {
        let mut tokens = Tokenizer::new(text.as_bytes(), &LINES);
        tokens.next();
        let (before, line) = (tokens.left(), tokens.line());
        let found = tokens.plain_numbers_on_line();
        assert_eq!(found, numbers.then_some([1.0, -2.5, 3.0]), "{text:?}");
        assert!(numbers || (tokens.left(), tokens.line()) == (before, line), "{text:?}: nothing is read");
        assert!(!numbers || tokens.next_on_line().is_none(), "{text:?}: the whole line is read");
    }
}
