//! The parts of a cache one behind the other: read, hashed and looked through in pieces that stay in the processor's cache.

use super::pages;
use crate::scene::extent::Extent;
use bytemuck::Pod;
use rayon::prelude::*;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;
use twox_hash::XxHash3_128;

/// Bytes of a piece, rounded down to whole elements.
const PIECE: usize = 1 << 20;

/// Elements in a piece, of which one has so many bytes.
fn piece(size: usize) -> usize {
    PIECE / size
}

/// A checksum in the making: a hash of the header and of the pieces' hashes.
pub struct Checksum {
    hashes: Vec<u8>,
}

impl Checksum {
    /// Begins with the header.
    pub fn new(header: &[u8]) -> Checksum {
        Checksum { hashes: header.to_vec() }
    }

    /// Adds the bytes of a part whose elements have so many each.
    pub fn add(&mut self, part: &[u8], size: usize) {
        part.chunks(piece(size) * size).for_each(|piece| self.add_hash(XxHash3_128::oneshot(piece)));
    }

    fn add_hash(&mut self, hash: u128) {
        self.hashes.extend(hash.to_le_bytes());
    }

    /// The checksum.
    pub fn finish(&self) -> [u8; 16] {
        XxHash3_128::oneshot(&self.hashes).to_le_bytes()
    }
}

/// Reads parts.
pub struct Parts<'a> {
    pub path: &'a Path,
    /// Where the next part begins.
    pub at: u64,
    pub checksum: Checksum,
    /// Of all that has been read.
    pub extent: Extent,
}

impl Parts<'_> {
    /// The next `count` elements, straight into their memory, and what `look` says of them. Pieces are worked on by all
    /// threads, each by a handle of its own, since a handle has one position.
    pub fn next<T: Pod + Send + Sync>(&mut self, count: u64, look: fn(&[T]) -> Extent) -> std::io::Result<Vec<T>> {
        let mut elements: Vec<T> = bytemuck::zeroed_vec(count as usize);
        pages::prefer_large(bytemuck::cast_slice_mut(&mut elements));
        let piece = piece(size_of::<T>());
        let (start, step) = (self.at, (piece * size_of::<T>()) as u64);
        let read = |(i, piece): (usize, &mut [T])| {
            let mut file = File::open(self.path)?;
            file.seek(SeekFrom::Start(start + i as u64 * step))?;
            file.read_exact(bytemuck::cast_slice_mut(piece))?;
            Ok((XxHash3_128::oneshot(bytemuck::cast_slice(piece)), look(piece)))
        };
        let pieces = elements.par_chunks_mut(piece).enumerate().map(read);
        for (hash, extent) in pieces.collect::<std::io::Result<Vec<_>>>()? {
            self.checksum.add_hash(hash);
            self.extent = self.extent.and(extent);
        }
        self.at += count * size_of::<T>() as u64;
        Ok(elements)
    }
}
