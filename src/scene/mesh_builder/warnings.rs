//! Collects the warnings of a reader; repeated warnings are counted.

/// The largest number of different warnings.
const MAX_WARNINGS: usize = 40;

/// Warnings in the order of their first occurrence.
#[derive(Default)]
pub struct Warnings {
    /// Texts, with the number of their occurrences.
    found: Vec<(String, usize)>,
    /// Number of further warnings beyond [`MAX_WARNINGS`].
    omitted: usize,
}

impl Warnings {
    /// Adds a warning, or counts it if it exists.
    pub fn add(&mut self, text: &str) {
        match self.found.iter().position(|(known, _)| known == text) {
            Some(index) => self.found[index].1 += 1,
            None if self.found.len() < MAX_WARNINGS => self.found.push((text.to_owned(), 1)),
            None => self.omitted += 1,
        }
    }

    /// The warnings as text, one line each.
    pub fn lines(self) -> Vec<String> {
        let times = |(text, times): (String, usize)| if times > 1 { format!("{text} ({times} times)") } else { text };
        let mut lines: Vec<String> = self.found.into_iter().map(times).collect();
        if self.omitted > 0 {
            lines.push(format!("and {} more warnings of other kinds", self.omitted));
        }
        lines
    }
}
