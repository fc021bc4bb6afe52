//! The frame of an HTML page, and its elements. A page needs no network, no script and no other file.

mod table;

pub use table::write as table;

use super::figure::{self, Figure};

const STYLE: &str = include_str!("style.css");

/// Escapes text for an element or an attribute.
pub fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped += "&amp;",
            '<' => escaped += "&lt;",
            '>' => escaped += "&gt;",
            '"' => escaped += "&quot;",
            '\'' => escaped += "&#39;",
            _ => escaped.push(c),
        }
    }
    escaped
}

/// A section with an anchor that the navigation names.
pub fn section(id: &str, title: &str, content: &str) -> String {
    format!("<section id=\"{id}\">\n<h2>{}</h2>\n{content}</section>\n", escape(title))
}

/// An entry of a description list; nothing if the value is empty.
pub fn entry(name: &str, value: &str) -> String {
    if value.is_empty() {
        return String::new();
    }
    format!("<dt>{}</dt><dd>{}</dd>\n", escape(name), escape(value))
}

/// The whole document.
pub fn page(title: &str, body: &str) -> String {
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n\
         <title>{}</title>\n<style>\n{STYLE}{}\n</style>\n</head>\n\
         <body>\n<main>\n{body}</main>\n</body>\n</html>\n",
        escape(title),
        figure::style_sheet(),
    )
}

/// A figure with its caption.
pub fn figure(figure: &Figure) -> String {
    format!(
        "<figure><div class=\"wide\">{}</div><figcaption>{}</figcaption></figure>\n",
        inline(&figure.svg),
        escape(&figure.caption)
    )
}

/// An SVG document as a part of the page: the page has the style sheet, and HTML needs no name space.
fn inline(svg: &str) -> String {
    let without_style = match (svg.find("<style>"), svg.find("</style>")) {
        (Some(from), Some(to)) => [&svg[..from], &svg[to + "</style>".len()..]].concat(),
        _ => svg.to_owned(),
    };
    without_style.replacen(" xmlns=\"http://www.w3.org/2000/svg\"", "", 1)
}

/// A text with a capital at its beginning.
pub fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
