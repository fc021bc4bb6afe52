//! Main memory that a case takes.

use crate::error::{Error, Result};
use crate::scene::budget;
use crate::workloads::size::Size;

/// Images of a case that are held at once, at 16 bytes a pixel: those of the reference, the renderer's and a copy.
const IMAGES: u64 = 7;

/// Bytes of the images of a case.
pub fn bytes(size: Size) -> u64 {
    IMAGES * 16 * size.pixels() as u64
}

/// Refuses sizes whose images take more than half of the memory that the process may use.
///
/// # Errors
/// [`Error::Refused`], with need and limit.
pub fn check(size: Size) -> Result<()> {
    check_limit(size, budget::process_bytes() as u64 / 2)
}

fn check_limit(size: Size, limit: u64) -> Result<()> {
    let need = bytes(size);
    if need <= limit {
        return Ok(());
    }
    let problem = format!("{} MiB are needed, half of the memory is {} MiB", need >> 20, limit >> 20);
    Err(Error::too_large("the images", problem, "give a smaller --resolution"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_above_the_limit_are_refused() {
        let size = Size { width: 1024, height: 1024 };
        check_limit(size, 112 << 20).unwrap();
        let error = check_limit(size, (112 << 20) - 1).unwrap_err().to_string();
        assert!(error.contains("112 MiB are needed, half of the memory is 111 MiB"), "{error}");
    }
}
