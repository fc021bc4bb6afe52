//! A table as such: title, columns with units, rows, notes. How it looks is the business of [`super::format`].

use super::number::Number;

/// A table of the thesis, or one that belongs to it.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Number in the thesis: `5.4`, `B.1`.
    pub id: String,
    /// What it shows.
    pub title: String,
    /// Headings of the columns that name a row.
    pub keys: Vec<String>,
    /// The other columns.
    pub columns: Vec<Column>,
    /// Rows.
    pub rows: Vec<Row>,
    /// Lines below it: what is absent, what was chosen, what to beware of.
    pub notes: Vec<String>,
    /// True if each number stands beside the published one.
    pub beside: bool,
    /// True if its numbers are the thesis's own: a program that reads them must not take them for a run's.
    pub published: bool,
}

/// A column.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// What several columns have in common, such as the structure; may be empty.
    pub group: String,
    /// Heading.
    pub name: String,
    /// Unit; may be empty.
    pub unit: String,
    /// How its numbers are written.
    pub form: Form,
}

/// How numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// A whole number.
    Whole,
    /// With so many decimals.
    Fixed(usize),
    /// At least three significant digits, two decimals where the thesis has them.
    Time,
}

/// A row: what it is about, and a cell per column.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// One per heading in [`Table::keys`].
    pub keys: Vec<String>,
    /// One per column.
    pub cells: Vec<Cell>,
}

/// What stands in a row's column.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// Words.
    Text(String),
    /// A number, with the published one where the table stands beside the thesis; both may be missing.
    Number {
        /// Measured, or published where [`Table::published`] says so.
        value: Option<Number>,
        /// Published.
        thesis: Option<Number>,
    },
}

/// Which line of a row: the numbers themselves, the published ones below them, or the quotient.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Line {
    /// The numbers themselves.
    Value,
    /// The published ones.
    Thesis,
    /// Measured by published.
    Ratio,
}

impl Line {
    /// In the column that tells the lines of a row apart.
    pub fn label(self) -> &'static str {
        match self {
            Line::Value => "run",
            Line::Thesis => "2009",
            Line::Ratio => "ratio",
        }
    }
}

impl Column {
    /// A column outside any group.
    pub fn new(name: &str, unit: &str, form: Form) -> Column {
        Column::of("", name, unit, form)
    }

    /// A column of a group.
    pub fn of(group: &str, name: &str, unit: &str, form: Form) -> Column {
        Column { group: group.into(), name: name.into(), unit: unit.into(), form }
    }

    /// Heading in one line.
    pub fn heading(&self) -> String {
        let unit = if self.unit.is_empty() { String::new() } else { format!("[{}]", self.unit) };
        let words = [self.group.as_str(), self.name.as_str(), unit.as_str()];
        words.into_iter().filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ")
    }
}

impl Form {
    /// A number as it is written.
    pub fn write(self, value: f64) -> String {
        match self {
            Form::Whole => format!("{value:.0}"),
            Form::Fixed(places) => format!("{value:.places$}"),
            Form::Time if value.abs() >= 10_000.0 => format!("{value:.0}"),
            Form::Time if value.abs() >= 1.0 || value == 0.0 => format!("{value:.2}"),
            Form::Time => significant(value),
        }
    }
}

/// Three significant digits of a number below one, without an exponent down to a millionth.
fn significant(value: f64) -> String {
    let places = (2.0 - value.abs().log10().floor()).clamp(2.0, 8.0) as usize;
    format!("{value:.places$}")
}

/// A quotient as it is written.
pub fn ratio(value: f64) -> String {
    match value.abs() {
        v if v >= 100.0 => format!("{value:.0}"),
        v if v >= 10.0 => format!("{value:.1}"),
        v if v >= 0.1 || v == 0.0 => format!("{value:.2}"),
        _ => significant(value),
    }
}

impl Cell {
    /// A number that stands alone.
    pub fn number(value: impl Into<Option<f64>>) -> Cell {
        Cell::Number { value: value.into().map(Number::from), thesis: None }
    }

    /// True if there is something in it from the table's own source.
    pub fn is_filled(&self) -> bool {
        matches!(self, Cell::Text(_) | Cell::Number { value: Some(_), .. })
    }

    /// True if a published number stands beside it.
    pub fn is_published(&self) -> bool {
        matches!(self, Cell::Number { thesis: Some(_), .. })
    }

    /// Measured by published, where there are both and the quotient says something.
    pub fn ratio(&self) -> Option<f64> {
        match self {
            Cell::Number { value: Some(value), thesis: Some(thesis) } if thesis.value != 0.0 => {
                Some(value.value / thesis.value)
            }
            _ => None,
        }
    }

    /// As it is written in a line of its row; `None` where there is nothing.
    pub fn write(&self, form: Form, line: Line) -> Option<String> {
        match (self, line) {
            (Cell::Text(text), Line::Value) => Some(text.clone()),
            (Cell::Text(_), _) => None,
            (Cell::Number { value, .. }, Line::Value) => value.map(|v| v.write(form)),
            (Cell::Number { thesis, .. }, Line::Thesis) => thesis.map(|v| v.write(form)),
            (Cell::Number { .. }, Line::Ratio) => self.ratio().map(ratio),
        }
    }
}

impl Row {
    /// True if any cell has something from the table's own source.
    pub fn is_filled(&self) -> bool {
        self.cells.iter().any(Cell::is_filled)
    }

    /// The lines that it takes.
    pub fn lines(&self, beside: bool) -> Vec<Line> {
        let mut lines = vec![Line::Value];
        if beside && self.cells.iter().any(Cell::is_published) {
            lines.push(Line::Thesis);
            if self.cells.iter().any(|c| c.ratio().is_some()) {
                lines.push(Line::Ratio);
            }
        }
        lines
    }
}

impl Table {
    /// Title with the number in front.
    pub fn caption(&self) -> String {
        format!("Table {}: {}", self.id, self.title)
    }

    /// Headings in one line each; with the column that tells the lines of a row apart, where rows have several.
    pub fn headings(&self) -> Vec<String> {
        let mut headings = self.keys.clone();
        if self.beside {
            headings.push(String::new());
        }
        headings.extend(self.columns.iter().map(Column::heading));
        headings
    }

    /// Columns that name a row: aligned to the left.
    pub fn key_columns(&self) -> usize {
        self.keys.len() + usize::from(self.beside)
    }

    /// Every line as text, with `dash` where there is nothing. A row's name stands in its first line only, and a first
    /// key that repeats the previous row's is left out: one sees where a scene begins.
    pub fn body(&self, dash: &str) -> Vec<Vec<String>> {
        let mut body = Vec::new();
        let mut previous: Option<&Row> = None;
        for row in &self.rows {
            for (index, line) in row.lines(self.beside).into_iter().enumerate() {
                let repeats = |key: usize| {
                    index > 0 || (key == 0 && row.keys.len() > 1 && previous.is_some_and(|p| p.keys[0] == row.keys[0]))
                };
                let names = row.keys.iter().enumerate();
                let mut cells: Vec<String> =
                    names.map(|(key, name)| if repeats(key) { String::new() } else { name.clone() }).collect();
                if self.beside {
                    cells.push(line.label().into());
                }
                let written = row.cells.iter().zip(&self.columns).map(|(cell, column)| cell.write(column.form, line));
                cells.extend(written.map(|text| text.unwrap_or_else(|| dash.into())));
                body.push(cells);
            }
            previous = Some(row);
        }
        body
    }
}
