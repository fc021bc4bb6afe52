//! Tables in GitHub's Markdown.

use crate::report::table::Table;

/// Writes a table with its title above and its notes below.
pub fn write(table: &Table) -> String {
    let mut text = format!("**{}**\n\n", escape(&table.caption()));
    let headings = table.headings();
    let rule = |index: usize| if index < table.key_columns() { ":---" } else { "---:" };
    text += &line(&headings);
    text += &format!("|{}|\n", (0..headings.len()).map(rule).collect::<Vec<_>>().join("|"));
    for row in table.body("–") {
        text += &line(&row);
    }
    for note in &table.notes {
        text += &format!("\n{}\n", escape(note));
    }
    text
}

fn line(cells: &[String]) -> String {
    format!("| {} |\n", cells.iter().map(|cell| escape(cell)).collect::<Vec<_>>().join(" | "))
}

/// Escapes what Markdown, or HTML inside it, would read as markup.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '<' => escaped += "&lt;",
            '>' => escaped += "&gt;",
            '&' => escaped += "&amp;",
            '\n' | '\r' => escaped.push(' '),
            '|' | '*' | '_' | '`' | '[' | ']' | '\\' | '#' | '~' => escaped.extend(['\\', c]),
            _ => escaped.push(c),
        }
    }
    escaped
}
