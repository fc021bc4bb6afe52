//! Which errors are rows.

use crate::error::{Error, Result};
use crate::record::row::Status;

/// What an error makes of a row. Errors that are not about the case end the run.
pub(super) fn failure(error: Error) -> Result<(Status, String)> {
    match error {
        Error::Refused(_) => Ok((Status::Skipped, error.to_string())),
        Error::Device(_) | Error::DeviceLost(_) | Error::Input(_) => Ok((Status::Failed, error.to_string())),
        other => Err(other),
    }
}
