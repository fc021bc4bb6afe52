//! A table: title, columns with units, rows, notes. [`super::format`] and [`super::html`] write it.

use super::number::{Form, Number, ratio};

/// A table of a source, filled with measured or published values.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// The source that has this table.
    pub origin: Origin,
    /// The table's number in its source: `5.4`, `B.1`.
    pub id: String,
    /// What the table shows.
    pub title: String,
    /// Headings of the columns that name a row.
    pub keys: Vec<String>,
    /// The other columns.
    pub columns: Vec<Column>,
    /// The rows, each with a cell per column.
    pub rows: Vec<Row>,
    /// Lines below the table: what is absent, what was chosen, what to beware of.
    pub notes: Vec<String>,
    /// True if each number is shown with the published one.
    pub with_published: bool,
    /// True if the numbers themselves are published ones: no program may read them as a run's.
    pub is_published: bool,
}

/// How a source and its values are named in a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Origin {
    /// The source's name, as `--source` takes it.
    pub source: &'static str,
    /// What the table's number is a number of: `table`, or `section` for a table that the source does not print.
    pub kind: &'static str,
    /// The label of a row's published line.
    pub published: &'static str,
}

/// A column of numbers or words.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// What several columns have in common, such as the structure; may be empty.
    pub group: String,
    /// The column's own heading.
    pub name: String,
    /// The unit; may be empty.
    pub unit: String,
    /// How the numbers are written.
    pub form: Form,
}

/// A row: the keys that name it, and a cell per column.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// One per heading in [`Table::keys`].
    pub keys: Vec<String>,
    /// One per column.
    pub cells: Vec<Cell>,
}

/// The content of a row in a column.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// Words.
    Text(String),
    /// Words and the published ones that they are compared with; both may be missing.
    Words {
        /// The words of what was measured, or published ones where [`Table::is_published`] says so.
        value: Option<String>,
        /// The published words for comparison.
        published: Option<String>,
    },
    /// A number and the published one that it is compared with; both may be missing.
    Number {
        /// The measured number, or a published one where [`Table::is_published`] says so.
        value: Option<Number>,
        /// The published number for comparison.
        published: Option<Number>,
    },
}

/// A line of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Line {
    /// The numbers themselves.
    Value,
    /// The published numbers.
    Published,
    /// Measured by published.
    Ratio,
}

impl Line {
    /// The line's label, in the column that distinguishes the lines of a row.
    fn label(self, origin: Origin) -> &'static str {
        match self {
            Line::Value => "run",
            Line::Published => origin.published,
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

    /// The heading on one line, with the unit.
    pub(crate) fn heading(&self) -> String {
        let unit = if self.unit.is_empty() { String::new() } else { format!("[{}]", self.unit) };
        let words = [self.group.as_str(), self.name.as_str(), unit.as_str()];
        words.into_iter().filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ")
    }
}

impl Cell {
    /// A number without a published one.
    pub fn number(value: impl Into<Option<f64>>) -> Cell {
        Cell::Number { value: value.into().map(Number::from), published: None }
    }

    /// True if the cell has words or a number of the table's own.
    pub fn is_filled(&self) -> bool {
        matches!(self, Cell::Text(_) | Cell::Words { value: Some(_), .. } | Cell::Number { value: Some(_), .. })
    }

    /// True if the cell has a published number, or published words, for comparison.
    pub fn has_published(&self) -> bool {
        matches!(self, Cell::Words { published: Some(_), .. } | Cell::Number { published: Some(_), .. })
    }

    /// True for words, also where there are none.
    pub fn is_words(&self) -> bool {
        matches!(self, Cell::Text(_) | Cell::Words { .. })
    }

    /// Measured by published, where both are known and the quotient is finite.
    pub fn ratio(&self) -> Option<f64> {
        match self {
            Cell::Number { value: Some(value), published: Some(published) } if published.value != 0.0 => {
                Some(value.value / published.value)
            }
            _ => None,
        }
    }

    /// Writes the cell in a line of its row; `None` where it has nothing for that line.
    pub fn write(&self, form: Form, line: Line) -> Option<String> {
        match (self, line) {
            (Cell::Text(text), Line::Value) => Some(text.clone()),
            (Cell::Text(_), _) => None,
            (Cell::Words { value, .. }, Line::Value) => value.clone(),
            (Cell::Words { published, .. }, Line::Published) => published.clone(),
            (Cell::Words { .. }, Line::Ratio) => None,
            (Cell::Number { value, .. }, Line::Value) => value.map(|v| v.write(form)),
            (Cell::Number { published, .. }, Line::Published) => published.map(|v| v.write(form)),
            (Cell::Number { .. }, Line::Ratio) => self.ratio().filter(|_| form != Form::Gain).map(ratio),
        }
    }
}

impl Row {
    /// True if any cell is filled.
    pub fn is_filled(&self) -> bool {
        self.cells.iter().any(Cell::is_filled)
    }

    /// The lines that the row takes.
    pub(crate) fn lines(&self, with_published: bool) -> Vec<Line> {
        let mut lines = vec![Line::Value];
        if with_published && self.cells.iter().any(Cell::has_published) {
            lines.push(Line::Published);
            if self.cells.iter().any(|c| c.ratio().is_some()) {
                lines.push(Line::Ratio);
            }
        }
        lines
    }
}

impl Table {
    /// The title after the table's number.
    pub(crate) fn caption(&self) -> String {
        format!("Table {}: {}", self.id, self.title)
    }

    /// Headings on one line each, with an empty one for the column that distinguishes the lines of a row.
    pub(crate) fn headings(&self) -> Vec<String> {
        let mut headings = self.keys.clone();
        if self.with_published {
            headings.push(String::new());
        }
        headings.extend(self.columns.iter().map(Column::heading));
        headings
    }

    /// The number of columns that name a row; they are aligned to the left.
    pub(crate) fn key_columns(&self) -> usize {
        self.keys.len() + usize::from(self.with_published)
    }

    /// True if a column has words in any row.
    pub(crate) fn has_words(&self, column: usize) -> bool {
        self.rows.iter().any(|row| row.cells.get(column).is_some_and(Cell::is_words))
    }

    /// Every line as text, with `dash` where there is nothing. A row is named on its first line only, and a first key
    /// that repeats the previous row's is left out, so that a reader sees where a scene begins.
    pub(crate) fn body(&self, dash: &str) -> Vec<Vec<String>> {
        let mut body = Vec::new();
        let mut previous: Option<&Row> = None;
        for row in &self.rows {
            for (index, line) in row.lines(self.with_published).into_iter().enumerate() {
                let repeats = |key: usize| {
                    index > 0 || (key == 0 && row.keys.len() > 1 && previous.is_some_and(|p| p.keys[0] == row.keys[0]))
                };
                let names = row.keys.iter().enumerate();
                let mut cells: Vec<String> =
                    names.map(|(key, name)| if repeats(key) { String::new() } else { name.clone() }).collect();
                if self.with_published {
                    cells.push(line.label(self.origin).into());
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
