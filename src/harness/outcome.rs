//! What is left of a run when it ends.

use crate::record::journal::Journal;
use crate::record::row::Status;

/// What a run has measured until its end.
#[derive(Debug)]
pub struct Outcome {
    /// Everything that was recorded.
    pub journal: Journal,
}

impl Outcome {
    /// Number of rows of a status.
    pub fn count(&self, status: Status) -> usize {
        self.journal.rows.iter().filter(|row| row.status == status).count()
    }
}
