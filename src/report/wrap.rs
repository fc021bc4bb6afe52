//! Text broken into lines for a terminal.

/// Columns of a terminal that text and tables are made to fit.
pub(crate) const WIDTH: usize = 100;

/// Breaks a text at spaces; every line begins with `indent`. A word longer than a line has a line of its own.
pub fn wrap(text: &str, indent: &str) -> String {
    let (mut out, mut line) = (String::new(), String::new());
    for word in text.split_whitespace() {
        if !line.is_empty() && indent.len() + line.chars().count() + 1 + word.chars().count() > WIDTH {
            out += &format!("{indent}{line}\n");
            line.clear();
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line += word;
    }
    out + indent + &line + "\n"
}
