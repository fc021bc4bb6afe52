//! Limits on the memory of a scene: nested copies must not fill the memory.
//!
//! There are two budgets. What a file *declares* (counts in its header, tables, the elements of its lists) must be
//! backed by its bytes: it may take [`PER_BYTE`] times the size of the files and [`BASE`] bytes. What a file *repeats*
//! (instances, arrays, surfaces that are tessellated) may take the memory of [`Options::repeatable_bytes`] in addition.

use crate::scene::text::Fault;
use crate::scene::{MAX_ELEMENTS, Options};

/// What a file declares may take `BASE` bytes plus `PER_BYTE` times the size of the files.
const BASE: usize = 64 << 20;
const PER_BYTE: usize = 16;

/// The largest factor by which the limits on repeated work grow with the memory.
const MAX_WORK_FACTOR: usize = 64;

/// The allowed and the used memory in bytes.
pub struct Limits {
    /// Memory that grows with the size of the files; both budgets have it.
    backed: usize,
    /// Memory of what a file repeats, beyond `backed`.
    repeatable: usize,
    /// Charged memory of what the file declares.
    declared: usize,
    /// All charged memory.
    used: usize,
}

impl Default for Limits {
    /// The limits of a format that cannot repeat anything.
    fn default() -> Limits {
        Limits { backed: 0, repeatable: BASE, declared: 0, used: 0 }
    }
}

impl Limits {
    /// The limits of a format that can repeat parts of its files.
    pub fn new(options: &Options) -> Limits {
        Limits { repeatable: options.repeatable_bytes(), ..Limits::default() }
    }

    /// Adds the size of a file, which raises the limits.
    pub fn read(&mut self, bytes: usize) {
        // One share is taken by the file's bytes in memory.
        self.backed = self.backed.saturating_add(bytes.saturating_mul(PER_BYTE - 1));
    }

    /// Charges a declared element of this size in a growing vector, which takes up to twice the memory.
    ///
    /// # Errors
    /// A limit is exceeded; so for the following functions.
    #[inline]
    pub fn grow(&mut self, bytes: usize) -> Result<(), Fault> {
        self.keep(bytes.saturating_mul(2))
    }

    /// Charges this memory of something declared.
    #[inline]
    pub fn keep(&mut self, bytes: usize) -> Result<(), Fault> {
        self.declared = self.declared.saturating_add(bytes);
        self.used = self.used.saturating_add(bytes);
        self.check_temporary(0)
    }

    /// Releases memory that was charged by [`Limits::grow`].
    pub fn shrink(&mut self, bytes: usize) {
        self.declared = self.declared.saturating_sub(bytes.saturating_mul(2));
        self.used = self.used.saturating_sub(bytes.saturating_mul(2));
    }

    /// Charges this memory of something that may be a repetition.
    #[inline]
    pub fn repeat(&mut self, bytes: usize) -> Result<(), Fault> {
        self.used = self.used.saturating_add(bytes);
        self.check_room(0)
    }

    /// Checks that a declared element may take this much temporary memory, without charging it.
    #[inline]
    pub fn check_temporary(&self, bytes: usize) -> Result<(), Fault> {
        if self.declared.saturating_add(bytes) <= BASE.saturating_add(self.backed) {
            self.check_room(bytes)
        } else {
            Err(self.undeclarable())
        }
    }

    /// Checks that this much memory is available, without charging it.
    #[inline]
    pub fn check_room(&self, bytes: usize) -> Result<(), Fault> {
        if self.have_room(bytes) { Ok(()) } else { Err(self.exceeded()) }
    }

    #[cold]
    fn undeclarable(&self) -> Fault {
        let allowed = BASE.saturating_add(self.backed);
        let problem = format!(
            "the geometry needs more than {} MiB of memory: {PER_BYTE} times the file's size and 64 MiB",
            allowed >> 20
        );
        Fault::new(None, problem, "split the file, or reduce the segments of curved surfaces, as in FILE:segments=8")
    }

    #[cold]
    fn exceeded(&self) -> Fault {
        let allowed = self.repeatable.saturating_add(self.backed);
        let problem = format!("the geometry, with every repetition, needs more than {} MiB of memory", allowed >> 20);
        let hint = "allow more with the option memory=SIZE, as in FILE:memory=8G, or reduce copies and segments";
        Fault::new(None, problem, hint)
    }

    /// True if this much memory is available.
    pub fn have_room(&self, bytes: usize) -> bool {
        self.used.saturating_add(bytes) <= self.repeatable.saturating_add(self.backed)
    }

    /// The factor by which the limits on the time of repetitions grow with the memory that they may take, at least 1.
    pub fn work_factor(&self) -> usize {
        (self.repeatable / BASE).clamp(1, MAX_WORK_FACTOR)
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
