//! The vertices of a shape, found by what makes corners share one.

use crate::math::Vertex;
use foldhash::fast::RandomState;
use hashbrown::HashTable;
use std::collections::HashMap;
use std::hash::BuildHasher;

/// Places that a table keeps for the next shape.
const KEPT: usize = 1024;

/// Bytes per place: an index and the table's own byte, at seven places of eight in use; half as much again while it grows.
const PER_PLACE: usize = 9;

/// The same with a key of eight bytes.
const PER_KEYED_PLACE: usize = 23;

/// Vertices by position and normal, and by the indices that a mesh has for them.
#[derive(Default)]
pub struct Shared {
    hasher: RandomState,
    /// Indices only: what they are compared by stands in the vertices.
    by_place: HashTable<u32>,
    by_indices: HashMap<[u32; 2], u32, RandomState>,
}

impl Shared {
    /// The vertex that is the same to the bit.
    #[inline]
    pub fn find(&self, vertex: &Vertex, vertices: &[Vertex]) -> Option<u32> {
        let bits = bits(vertex);
        let same = |&index: &u32| self::bits(&vertices[index as usize]) == bits;
        self.by_place.find(self.hasher.hash_one(bits), same).copied()
    }

    /// Adds the vertex of that index, of which there is none like it.
    #[inline]
    pub fn insert(&mut self, index: u32, vertices: &[Vertex]) {
        let hash = |&index: &u32| self.hasher.hash_one(bits(&vertices[index as usize]));
        self.by_place.insert_unique(hash(&index), index, hash);
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

fn bits(vertex: &Vertex) -> [u64; 4] {
    bytemuck::cast(*vertex)
}
