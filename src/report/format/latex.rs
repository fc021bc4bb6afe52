//! Tables as LaTeX: `longtable`, because a float can neither break nor shrink, and some tables have more lines than a
//! page.

use crate::report::table::Table;

/// The line before the first table.
pub const HEADER: &str = "% Needs \\usepackage{longtable} in the preamble.\n";

/// Share of the line that columns of words have together.
const WORDS: f64 = 0.72;
/// Tables with more columns than this have smaller letters, or they would be wider than the text of an article.
const WIDE: usize = 9;

/// Writes a longtable with its title as caption, its headings on every page, and its notes below.
pub fn write(table: &Table) -> String {
    let head = format!("\\hline\n{}\\hline\n", head(table));
    let mut text = format!(
        "\\begingroup\\{}\\setlength{{\\tabcolsep}}{{2.5pt}}\n\\begin{{longtable}}{{{}}}\n\\caption{{{}}}\\\\\n\
         {head}\\endfirsthead\n{head}\\endhead\n\\hline\n\\endfoot\n",
        if table.key_columns() + table.columns.len() > WIDE { "scriptsize" } else { "footnotesize" },
        columns(table),
        escape(&caption(table)),
    );
    let mut lines = table.rows.iter().flat_map(|row| {
        let number = row.lines(table.with_published).len();
        (1..=number).map(move |line| line == number)
    });
    for row in table.body("--") {
        // A page may end below a row, not between its lines
        let end = if lines.next().unwrap_or(true) { "" } else { "*" };
        text += &format!("{} \\\\{end}\n", cells(&row));
    }
    text += "\\end{longtable}\n";
    for note in &table.notes {
        text += &format!("\\noindent {}\\par\n", escape(note));
    }
    text + "\\endgroup\n"
}

/// The caption, which LaTeX prints after its own "Table N:".
fn caption(table: &Table) -> String {
    format!("{} ({} {} {})", table.title, table.origin.source, table.origin.kind, table.id)
}

/// Alignment: keys to the left, numbers to the right, words in columns that break their lines.
fn columns(table: &Table) -> String {
    let share = WORDS / (0..table.columns.len()).filter(|index| table.has_words(*index)).count().max(1) as f64;
    let of = |index| if table.has_words(index) { format!("p{{{share:.2}\\linewidth}}") } else { "r".into() };
    "l".repeat(table.key_columns()) + &(0..table.columns.len()).map(of).collect::<String>()
}

/// The lines of the heading: groups above the columns that they span, names, units. Unused ones are left out.
fn head(table: &Table) -> String {
    let keys = |filled: bool| -> Vec<String> {
        let names = table.keys.iter().map(String::as_str).chain(table.with_published.then_some(""));
        names.map(|name| if filled { escape(name) } else { String::new() }).collect()
    };
    let mut lines = Vec::new();
    if table.columns.iter().any(|column| !column.group.is_empty()) {
        let groups = table.columns.chunk_by(|a, b| a.group == b.group);
        let spans = groups.map(|g| format!("\\multicolumn{{{}}}{{c}}{{{}}}", g.len(), escape(&g[0].group)));
        lines.push([keys(false), spans.collect()].concat());
    }
    lines.push([keys(true), table.columns.iter().map(|column| escape(&column.name)).collect()].concat());
    if table.columns.iter().any(|column| !column.unit.is_empty()) {
        let unit = |text: &str| if text.is_empty() { String::new() } else { format!("{{[}}{}{{]}}", escape(text)) };
        lines.push([keys(false), table.columns.iter().map(|column| unit(&column.unit)).collect()].concat());
    }
    lines.iter().map(|line| format!("{} \\\\\n", line.join(" & "))).collect()
}

fn cells(cells: &[String]) -> String {
    cells.iter().map(|cell| escape(cell)).collect::<Vec<_>>().join(" & ")
}

fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' | '%' | '$' | '#' | '_' | '{' | '}' => escaped.extend(['\\', c]),
            '\\' => escaped += "\\textbackslash{}",
            '~' => escaped += "\\textasciitilde{}",
            '^' => escaped += "\\textasciicircum{}",
            // LaTeX would read a bracket at the beginning of a line as an option of the line before
            '[' => escaped += "{[}",
            ']' => escaped += "{]}",
            '<' => escaped += "$<$",
            '>' => escaped += "$>$",
            // The default fonts have another sign in its place
            '|' => escaped += "\\textbar{}",
            '\n' | '\r' => escaped.push(' '),
            _ => escaped.push(c),
        }
    }
    escaped
}
