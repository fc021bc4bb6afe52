//! What a file may grow into: copies of copies must not fill the memory.

use crate::scene::MAX_ELEMENTS;
use crate::scene::text::Fault;

/// Bytes of memory that any file may take, and bytes more for each of its own.
const BASE: usize = 64 << 20;
const PER_BYTE: usize = 16;

/// The memory that is left.
pub struct Limits {
    allowed: usize,
    used: usize,
}

impl Default for Limits {
    fn default() -> Limits {
        Limits { allowed: BASE, used: 0 }
    }
}

impl Limits {
    /// A file of this size has been read.
    pub fn read(&mut self, bytes: usize) {
        // One share is for the file's own bytes
        self.allowed = self.allowed.saturating_add(bytes.saturating_mul(PER_BYTE - 1));
    }

    /// Something of this size is about to be stored for good. A vector that grows takes twice that.
    #[inline]
    pub fn grow(&mut self, bytes: usize) -> Result<(), Fault> {
        self.keep(bytes.saturating_mul(2))
    }

    /// Something is about to be stored for good that takes this much and no more.
    #[inline]
    pub fn keep(&mut self, bytes: usize) -> Result<(), Fault> {
        self.used = self.used.saturating_add(bytes);
        self.passing(0)
    }

    /// What was to [`Limits::grow`] by this size is gone.
    pub fn shrink(&mut self, bytes: usize) {
        self.used = self.used.saturating_sub(bytes.saturating_mul(2));
    }

    /// Holds that many bytes, which are stored for a while, against what is left.
    #[inline]
    pub fn passing(&self, bytes: usize) -> Result<(), Fault> {
        if self.have_room(bytes) { Ok(()) } else { Err(self.exceeded()) }
    }

    #[cold]
    fn exceeded(&self) -> Fault {
        let problem = format!(
            "the geometry needs more than {} MiB of memory: {PER_BYTE} times the file's size and 64 MiB",
            self.allowed >> 20
        );
        Fault::new(None, problem, "are there copies of copies? Otherwise take fewer segments, as in FILE:segments=8")
    }

    /// True if there is room for so many bytes more.
    pub fn have_room(&self, bytes: usize) -> bool {
        self.used.saturating_add(bytes) <= self.allowed
    }

    /// One more vertex, or one more triangle, beside this many.
    #[inline]
    pub fn elements(&self, present: usize) -> Result<(), Fault> {
        if present < MAX_ELEMENTS {
            return Ok(());
        }
        let problem = format!("more than {MAX_ELEMENTS} vertices or triangles");
        Err(Fault::new(None, problem, "simplify the scene"))
    }
}
