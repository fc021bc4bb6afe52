//! Rust sources reduced to their tokens, so that what is derived from them does not depend on comments or layout.

use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};

/// Rust source as the text of its tokens, doc comments left out; the source itself where it is no Rust.
pub fn of(source: &str) -> String {
    match source.parse::<TokenStream>() {
        Ok(stream) => without_docs(stream).to_string(),
        Err(_) => source.to_owned(),
    }
}

/// Leaves out every `#[doc = ..]`, which is what a doc comment is to the compiler.
fn without_docs(stream: TokenStream) -> TokenStream {
    let mut kept: Vec<TokenTree> = Vec::new();
    for token in stream {
        let TokenTree::Group(group) = &token else {
            kept.push(token);
            continue;
        };
        let is_doc = matches!(group.stream().into_iter().next(), Some(TokenTree::Ident(name)) if name == "doc");
        if is_doc && group.delimiter() == Delimiter::Bracket {
            // And the `#` or `#!` in front of it
            while matches!(kept.last(), Some(TokenTree::Punct(p)) if ['#', '!'].contains(&p.as_char())) {
                kept.pop();
            }
        } else {
            kept.push(TokenTree::Group(Group::new(group.delimiter(), without_docs(group.stream()))));
        }
    }
    kept.into_iter().collect()
}
