//! The vertices of a shape, found by what makes corners share one.

use crate::math::Vertex;
use foldhash::fast::RandomState;
use hashbrown::hash_table::{Entry, HashTable};
use std::collections::HashMap;
use std::hash::{BuildHasher, Hasher};

/// Places that a table keeps for the next shape.
const KEPT: usize = 1024;

/// Places that it begins with: many shapes are small, and growing takes longer than finding.
const FIRST: usize = 112;

/// Bytes per place: its eight and the table's own byte, at seven places of eight in use; half as much again while it grows.
const PER_PLACE: usize = 16;

/// The same with a key of eight bytes.
const PER_KEYED_PLACE: usize = 23;

/// A vertex: its hash, so that a growing table need not look at it, and its index.
#[derive(Clone, Copy)]
struct Place {
    hash: u32,
    index: u32,
}

impl Place {
    /// The hash over all 64 bits, as the table wants it.
    fn spread(self) -> u64 {
        u64::from(self.hash).wrapping_mul(0x9e37_79b9_7f4a_7c15)
    }
}

/// Vertices by position and normal, and by the indices that a mesh has for them.
pub struct Shared {
    hasher: RandomState,
    /// What they are compared by stands in the vertices.
    by_place: HashTable<Place>,
    by_indices: HashMap<[u32; 2], u32, RandomState>,
}

impl Default for Shared {
    fn default() -> Shared {
        Shared {
            hasher: RandomState::default(),
            by_place: HashTable::with_capacity(FIRST),
            by_indices: HashMap::with_capacity_and_hasher(FIRST, RandomState::default()),
        }
    }
}

impl Shared {
    /// The vertex that is the same to the bit, or else the one that `add` adds.
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
        let place = self.place(bits);
        let same = |other: &Place| other.hash == place.hash && self::bits(&vertices[other.index as usize]) == bits;
        match self.by_place.entry(place.spread(), same, |other| other.spread()) {
            Entry::Occupied(found) => Ok(found.get().index),
            Entry::Vacant(free) => {
                let index = add(vertices)?;
                free.insert(Place { index, ..place });
                Ok(index)
            }
        }
    }

    /// The place of a vertex that has no index yet.
    #[inline]
    fn place(&self, bits: [u64; 4]) -> Place {
        let mut hasher = self.hasher.build_hasher();
        bits.iter().for_each(|&word| hasher.write_u64(word));
        Place { hash: hasher.finish() as u32, index: 0 }
    }

    /// Lists a vertex that is there already, and differs from all that are listed.
    pub fn list(&mut self, index: u32, vertices: &[Vertex]) {
        let place = Place { index, ..self.place(bits(&vertices[index as usize])) };
        self.by_place.insert_unique(place.spread(), place, |other| other.spread());
    }

    /// The vertex of these indices.
    #[inline]
    pub fn find_indices(&self, indices: [u32; 2]) -> Option<u32> {
        self.by_indices.get(&indices).copied()
    }

    /// Adds the vertex of these indices.
    #[inline]
    pub fn insert_indices(&mut self, indices: [u32; 2], index: u32) {
        self.by_indices.insert(indices, index);
    }

    /// Memory, also for growing.
    pub fn bytes(&self) -> usize {
        self.by_place.capacity() * PER_PLACE + self.by_indices.capacity() * PER_KEYED_PLACE
    }

    /// The same with so many vertices more, at the most: where the table grows, it grows to twice of what it holds.
    pub fn bytes_with(&self, more: usize) -> usize {
        self.bytes().saturating_add((self.by_place.len() + more).saturating_mul(2 * PER_PLACE))
    }

    /// Forgets all. Clearing takes as long as a table is large: a large one must not stay behind for many small shapes.
    pub fn clear(&mut self) {
        if !self.by_place.is_empty() {
            self.by_place.clear();
            // Nothing is left that could be hashed
            self.by_place.shrink_to(KEPT, |_| 0);
        }
        if !self.by_indices.is_empty() {
            self.by_indices.clear();
            self.by_indices.shrink_to(KEPT);
        }
    }
}

/// What vertices are compared by.
pub fn bits(vertex: &Vertex) -> [u64; 4] {
    bytemuck::cast(*vertex)
}
