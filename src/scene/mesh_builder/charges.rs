//! Memory that readers need in addition to the mesh, and the limits that it counts against.

use super::MeshBuilder;
use crate::scene::text::Fault;

impl MeshBuilder {
    /// Adds the size of a file, which raises the limits. An included file must be added only once.
    pub fn read(&mut self, bytes: usize) {
        self.limits.read(bytes);
        self.triangulator.read(bytes);
    }

    /// Charges memory that a reader needs in addition to the mesh for what a file declares.
    ///
    /// # Errors
    /// The limit is exceeded.
    pub fn charge(&mut self, bytes: usize) -> Result<(), Fault> {
        self.limits.grow(bytes)
    }

    /// Charges memory that a reader needs in addition to the mesh for every repetition.
    ///
    /// # Errors
    /// The limit is exceeded.
    pub fn charge_repeated(&mut self, bytes: usize) -> Result<(), Fault> {
        self.limits.repeat(2 * bytes)
    }

    /// The factor by which limits on the time of repetitions grow with their memory, at least 1.
    pub fn work_factor(&self) -> usize {
        self.limits.work_factor()
    }

    /// Releases memory that was charged.
    pub fn discharge(&mut self, bytes: usize) {
        self.limits.shrink(bytes);
    }

    /// Checks that a reader may allocate this much temporary memory.
    ///
    /// # Errors
    /// The limit is exceeded.
    pub fn check_temporary(&self, bytes: usize) -> Result<(), Fault> {
        self.limits.check_temporary(bytes)
    }
}
