//! `Array` and `MultipleCopy`. Copies that exceed a limit together are refused after the first.

use super::InventorReader;
use super::state::State;
use super::transform::{PROJECTION, affine};
use super::traverse::FileContext;
use super::tree::Node;
use crate::scene::text::{Fault, ReadError};
use glam::{DAffine3, DVec3};

/// The processed values and the triangles before the first copy.
#[derive(Clone, Copy)]
struct Before {
    work: usize,
    triangles: usize,
}

impl InventorReader {
    /// Traverses the children of an `Array` once for each of its copies, along one to three axes. The number of the
    /// copy is what a switch with `whichChild -2` inherits.
    pub(super) fn array<'t>(
        &mut self,
        file: FileContext<'t, '_>,
        node: &Node,
        state: &mut State<'t>,
    ) -> Result<(), ReadError> {
        let axes = [
            ("numElements1", "separation1", DVec3::X),
            ("numElements2", "separation2", DVec3::Y),
            ("numElements3", "separation3", DVec3::Z),
        ];
        let (mut counts, mut steps, mut start) = ([0; 3], [DVec3::ZERO; 3], DVec3::ZERO);
        for (axis, (number, separation, default)) in axes.into_iter().enumerate() {
            counts[axis] = node.integer(number, 1)?;
            steps[axis] = node.vector(separation, default)?;
            let last = steps[axis] * counts[axis].saturating_sub(1).max(0) as f64;
            match node.word("origin")? {
                Some(b"CENTER") => start -= last / 2.0,
                Some(b"LAST") => start -= last,
                _ => {}
            }
        }
        // An empty row makes the array empty; the loops over rows would still take time.
        if counts.iter().any(|&count| count < 1) {
            return Ok(());
        }
        let copies = counts.iter().fold(1, |all: usize, &count| all.saturating_mul(count as usize));
        let before = self.before_copies(file, node, copies)?;
        let mut number = 0;
        for k in 0..counts[2] {
            for j in 0..counts[1] {
                for i in 0..counts[0] {
                    self.count_work(1)?;
                    let [i, j, k] = [i, j, k].map(|index| index as f64);
                    let place = start + steps[0] * i + steps[1] * j + steps[2] * k;
                    let mut copy = *state;
                    copy.transform *= DAffine3::from_translation(place);
                    copy.selected_child = number;
                    number += 1;
                    self.children(file, node, 0..node.children.len(), &mut copy)?;
                    if number == 1 {
                        self.after_first_copy(file, node, copies, before)?;
                    }
                }
            }
        }
        Ok(())
    }

    /// Traverses the children of a `MultipleCopy` once for each of its matrices, the number of which a switch inherits.
    pub(super) fn copies<'t>(
        &mut self,
        file: FileContext<'t, '_>,
        node: &Node,
        state: &mut State<'t>,
    ) -> Result<(), ReadError> {
        let identity = glam::DMat4::IDENTITY.to_cols_array();
        let matrices = node.tuples("matrix", 16)?.unwrap_or(&identity);
        let matrices = matrices.as_chunks().0;
        let before = self.before_copies(file, node, matrices.len())?;
        for (number, matrix) in matrices.iter().enumerate() {
            let mut copy = *state;
            copy.selected_child = number as i64;
            copy.transform *=
                affine(matrix).ok_or_else(|| Fault::new(None, PROJECTION, "projections cannot be traced"))?;
            self.children(file, node, 0..node.children.len(), &mut copy)?;
            if number == 0 {
                self.after_first_copy(file, node, matrices.len(), before)?;
            }
        }
        Ok(())
    }

    /// Checks the values that all copies need at least.
    fn before_copies(&self, file: FileContext, node: &Node, copies: usize) -> Result<Before, Fault> {
        let costs = node.children.iter().map(|&child| file.tree.node(child).cost);
        self.check_work(copies.saturating_mul(costs.fold(1, usize::saturating_add)))?;
        Ok(Before { work: self.work, triangles: self.mesh.triangles() })
    }

    /// Checks that the other copies, which are as large as the first, do not exceed a limit.
    fn after_first_copy(&self, file: FileContext, node: &Node, copies: usize, before: Before) -> Result<(), Fault> {
        if node.children.iter().any(|&child| file.tree.node(child).varies) {
            return Ok(());
        }
        let others = copies - 1;
        self.mesh.check_triangles(others.saturating_mul(self.mesh.triangles() - before.triangles))?;
        self.check_work(others.saturating_mul(self.work - before.work))
    }
}
