//! Tables as LaTeX: plain `tabular`, no packages.

use crate::thesis::table::Table;

/// A table environment with its title as caption and its notes below.
pub fn write(table: &Table) -> String {
    let headings = table.headings();
    let columns: String = (0..headings.len()).map(|i| if i < table.key_columns() { 'l' } else { 'r' }).collect();
    let mut text = format!("\\begin{{table}}\n\\caption{{{}}}\n", escape(&table.caption()));
    text += &format!("\\begin{{tabular}}{{{columns}}}\n\\hline\n{}\\hline\n", line(&headings));
    for row in table.body("--") {
        text += &line(&row);
    }
    text += "\\hline\n\\end{tabular}\n";
    for note in &table.notes {
        text += &format!("\\par {{\\footnotesize {}}}\n", escape(note));
    }
    text + "\\end{table}\n"
}

fn line(cells: &[String]) -> String {
    format!("{} \\\\\n", cells.iter().map(|cell| escape(cell)).collect::<Vec<_>>().join(" & "))
}

fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' | '%' | '$' | '#' | '_' | '{' | '}' => escaped.extend(['\\', c]),
            '\\' => escaped += "\\textbackslash{}",
            '~' => escaped += "\\textasciitilde{}",
            '^' => escaped += "\\textasciicircum{}",
            // A line that begins with a bracket would be taken for an option of the one before
            '[' => escaped += "{[}",
            ']' => escaped += "{]}",
            '<' => escaped += "$<$",
            '>' => escaped += "$>$",
            '\n' | '\r' => escaped.push(' '),
            _ => escaped.push(c),
        }
    }
    escaped
}
