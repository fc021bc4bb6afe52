//! Warnings of a reader, each once with how often it came.

/// Most different warnings: a broken file must not drown the user.
const MOST: usize = 40;

/// Warnings in the order in which they first came.
#[derive(Default)]
pub struct Warnings {
    found: Vec<(String, usize)>,
    left_out: usize,
}

impl Warnings {
    /// Adds a warning, or counts it if it has come before.
    pub fn add(&mut self, text: &str) {
        match self.found.iter().position(|(known, _)| known == text) {
            Some(index) => self.found[index].1 += 1,
            None if self.found.len() < MOST => self.found.push((text.to_owned(), 1)),
            None => self.left_out += 1,
        }
    }

    /// One line each.
    pub fn lines(self) -> Vec<String> {
        let times = |(text, times): (String, usize)| if times > 1 { format!("{text} ({times} times)") } else { text };
        let mut lines: Vec<String> = self.found.into_iter().map(times).collect();
        if self.left_out > 0 {
            lines.push(format!("and {} more warnings of other kinds", self.left_out));
        }
        lines
    }
}
