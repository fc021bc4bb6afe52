//! Memory that readers need in addition to the mesh, and the limits that it counts against.

use super::MeshBuilder;
use crate::scene::Triangle;
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

    /// Checks that this many more triangles, of which the vertices are not counted, do not exceed a limit.
    ///
    /// # Errors
    /// They do.
    pub fn check_triangles(&self, more: usize) -> Result<(), Fault> {
        if more > 0 {
            self.limits.elements(self.triangles.len().saturating_add(more - 1))?;
        }
        self.limits.check_room(more.saturating_mul(2 * size_of::<Triangle>()))
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
