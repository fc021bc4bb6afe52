//! Limits on the memory of a scene in relation to its files: nested copies must not fill the memory.

use crate::scene::MAX_ELEMENTS;
use crate::scene::text::Fault;

/// The limit of memory is `BASE` bytes plus `PER_BYTE` times the size of the files.
const BASE: usize = 64 << 20;
const PER_BYTE: usize = 16;

/// The allowed and the used memory in bytes.
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
    /// Adds the size of a file, which raises the limit.
    pub fn read(&mut self, bytes: usize) {
        // One share is taken by the file's bytes in memory.
        self.allowed = self.allowed.saturating_add(bytes.saturating_mul(PER_BYTE - 1));
    }

    /// Charges an element of this size in a growing vector, which takes up to twice the memory.
    ///
    /// # Errors
    /// The limit is exceeded; so for the following functions.
    #[inline]
    pub fn grow(&mut self, bytes: usize) -> Result<(), Fault> {
        self.keep(bytes.saturating_mul(2))
    }

    /// Charges this memory.
    #[inline]
    pub fn keep(&mut self, bytes: usize) -> Result<(), Fault> {
        self.used = self.used.saturating_add(bytes);
        self.check_temporary(0)
    }

    /// Releases memory that was charged by [`Limits::grow`].
    pub fn shrink(&mut self, bytes: usize) {
        self.used = self.used.saturating_sub(bytes.saturating_mul(2));
    }

    /// Checks that this much temporary memory is available, without charging it.
    #[inline]
    pub fn check_temporary(&self, bytes: usize) -> Result<(), Fault> {
        if self.have_room(bytes) { Ok(()) } else { Err(self.exceeded()) }
    }

    #[cold]
    fn exceeded(&self) -> Fault {
        let problem = format!(
            "the geometry needs more than {} MiB of memory: {PER_BYTE} times the file's size and 64 MiB",
            self.allowed >> 20
        );
        Fault::new(None, problem, "reduce nested copies, or the segments of curved surfaces, as in FILE:segments=8")
    }

    /// True if this much memory is available.
    pub fn have_room(&self, bytes: usize) -> bool {
        self.used.saturating_add(bytes) <= self.allowed
    }

    /// Checks that one more vertex or triangle is allowed in addition to `present`.
    #[inline]
    pub fn elements(&self, present: usize) -> Result<(), Fault> {
        if present < MAX_ELEMENTS {
            return Ok(());
        }
        let problem = format!("there are more than {MAX_ELEMENTS} vertices or triangles");
        Err(Fault::new(None, problem, "simplify the scene"))
    }
}
