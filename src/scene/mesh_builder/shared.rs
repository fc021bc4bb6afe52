//! Search tables of the vertices of a shape.

use crate::math::Vertex;
use foldhash::fast::RandomState;
use hashbrown::hash_table::{Entry, HashTable};
use std::collections::HashMap;
use std::hash::{BuildHasher, Hasher};

/// The largest capacity that a table keeps for the next shape.
const KEPT: usize = 1024;

/// The initial capacity of a table: many shapes are small, and growing takes longer than searching.
const FIRST: usize = 112;

/// Upper bound of the memory per slot in bytes: eight, and one of the table, with seven of eight slots in use, and half
/// of it while the table grows.
const PER_SLOT: usize = 16;

/// Upper bound of the memory per slot with a key of eight bytes.
const PER_KEYED_SLOT: usize = 23;

/// An entry for a vertex. It has the hash, so that a growing table does not need to read the vertex.
#[derive(Clone, Copy)]
struct Slot {
    hash: u32,
    index: u32,
}

impl Slot {
    /// The hash spread over 64 bits, as the table needs it.
    fn spread(self) -> u64 {
        u64::from(self.hash).wrapping_mul(0x9e37_79b9_7f4a_7c15)
    }
}

/// The vertices of a shape by position and normal, and by the indices of a mesh.
pub struct Shared {
    hasher: RandomState,
    /// Entries by position and normal, which are compared in the vertices.
    by_bits: HashTable<Slot>,
    by_indices: HashMap<[u32; 2], u32, RandomState>,
}

impl Default for Shared {
    fn default() -> Shared {
        Shared {
            hasher: RandomState::default(),
            by_bits: HashTable::with_capacity(FIRST),
            by_indices: HashMap::with_capacity_and_hasher(FIRST, RandomState::default()),
        }
    }
}

impl Shared {
    /// The index of the vertex that is equal to the bit, otherwise of the one that `add` adds.
    ///
    /// # Errors
    /// Those of `add`.
    #[inline]
    pub fn find_or<E>(
        &mut self,
        vertex: &Vertex,
        vertices: &mut Vec<Vertex>,
        add: impl FnOnce(&mut Vec<Vertex>) -> Result<u32, E>,
    ) -> Result<u32, E> {
        let bits = bits(vertex);
        let slot = self.slot(bits);
        let same = |other: &Slot| other.hash == slot.hash && self::bits(&vertices[other.index as usize]) == bits;
        match self.by_bits.entry(slot.spread(), same, |other| other.spread()) {
            Entry::Occupied(found) => Ok(found.get().index),
            Entry::Vacant(free) => {
                let index = add(vertices)?;
                free.insert(Slot { index, ..slot });
                Ok(index)
            }
        }
    }

    /// The entry for a vertex, without its index.
    #[inline]
    fn slot(&self, bits: [u64; 4]) -> Slot {
        let mut hasher = self.hasher.build_hasher();
        bits.iter().for_each(|&word| hasher.write_u64(word));
        Slot { hash: hasher.finish() as u32, index: 0 }
    }

    /// Adds an existing vertex, which must differ from all others in the table.
    pub fn list(&mut self, index: u32, vertices: &[Vertex]) {
        let slot = Slot { index, ..self.slot(bits(&vertices[index as usize])) };
        self.by_bits.insert_unique(slot.spread(), slot, |other| other.spread());
    }

    /// The vertex with these indices.
    #[inline]
    pub fn find_indices(&self, indices: [u32; 2]) -> Option<u32> {
        self.by_indices.get(&indices).copied()
    }

    /// Adds the vertex with these indices.
    #[inline]
    pub fn insert_indices(&mut self, indices: [u32; 2], index: u32) {
        self.by_indices.insert(indices, index);
    }

    /// Upper bound of the tables' memory in bytes, while they grow.
    pub fn bytes(&self) -> usize {
        self.by_bits.capacity() * PER_SLOT + self.by_indices.capacity() * PER_KEYED_SLOT
    }

    /// Upper bound of the memory in bytes after adding `more` vertices: a growing table doubles its capacity.
    pub fn bytes_with(&self, more: usize) -> usize {
        self.bytes().saturating_add((self.by_bits.len() + more).saturating_mul(2 * PER_SLOT))
    }

    /// Removes all vertices. Large tables are shrunk, because the time of clearing depends on the capacity, and many
    /// small shapes may follow.
    pub fn clear(&mut self) {
        if !self.by_bits.is_empty() {
            self.by_bits.clear();
            // The table is empty, so this hash is never used.
            self.by_bits.shrink_to(KEPT, |_| 0);
        }
        if !self.by_indices.is_empty() {
            self.by_indices.clear();
            self.by_indices.shrink_to(KEPT);
        }
    }
}

/// The bits by which vertices are compared.
pub fn bits(vertex: &Vertex) -> [u64; 4] {
    bytemuck::cast(*vertex)
}
