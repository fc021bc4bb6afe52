//! Reads, hashes and checks the parts of a cache file one after another, in pieces that fit into the processor's cache.

use super::pages;
use crate::scene::extent::Extent;
use bytemuck::Pod;
use rayon::prelude::*;
use std::fs::File;
use std::io;
use twox_hash::XxHash3_128;

/// Size of a piece in bytes; it is rounded down to whole elements.
const PIECE: usize = 1 << 20;

/// Number of elements of `size` bytes in a piece.
fn piece(size: usize) -> usize {
    PIECE / size
}

/// A checksum under construction: the hashes of the pieces so far.
#[derive(Default)]
pub struct Checksum {
    hashes: Vec<u8>,
}

impl Checksum {
    /// Adds the bytes of a part with elements of `size` bytes.
    pub fn add(&mut self, part: &[u8], size: usize) {
        part.chunks(piece(size) * size).for_each(|piece| self.add_hash(XxHash3_128::oneshot(piece)));
    }

    fn add_hash(&mut self, hash: u128) {
        self.hashes.extend(hash.to_le_bytes());
    }

    /// The checksum of `start` and of everything that was added so far.
    pub fn with(&self, start: &[u8]) -> [u8; 16] {
        XxHash3_128::oneshot(&[start, &self.hashes].concat()).to_le_bytes()
    }
}

/// Reads the parts of a cache in their order.
pub struct Parts<'a> {
    pub file: &'a File,
    /// Offset of the next part in the file, in bytes.
    pub at: u64,
    pub checksum: Checksum,
    /// Union of the extents of all parts read so far.
    pub extent: Extent,
}

impl Parts<'_> {
    /// Reads the next `count` elements on all threads, and adds their `extent_of` to [`Parts::extent`].
    pub fn next<T: Pod + Send + Sync>(&mut self, count: u64, extent_of: fn(&[T]) -> Extent) -> io::Result<Vec<T>> {
        let mut elements: Vec<T> = bytemuck::zeroed_vec(count as usize);
        pages::prefer_large(bytemuck::cast_slice_mut(&mut elements));
        let piece = piece(size_of::<T>());
        let (start, step) = (self.at, (piece * size_of::<T>()) as u64);
        let read = |(i, piece): (usize, &mut [T])| {
            read_exact_at(self.file, bytemuck::cast_slice_mut(piece), start + i as u64 * step)?;
            Ok((XxHash3_128::oneshot(bytemuck::cast_slice(piece)), extent_of(piece)))
        };
        let pieces = elements.par_chunks_mut(piece).enumerate().map(read);
        for (hash, extent) in pieces.collect::<io::Result<Vec<_>>>()? {
            self.checksum.add_hash(hash);
            self.extent = self.extent.union(extent);
        }
        self.at += count * size_of::<T>() as u64;
        Ok(elements)
    }
}

/// Fills the buffer from an offset in the file. It does not use the handle's position, which threads share.
#[cfg(unix)]
fn read_exact_at(file: &File, buffer: &mut [u8], at: u64) -> io::Result<()> {
    std::os::unix::fs::FileExt::read_exact_at(file, buffer, at)
}

#[cfg(windows)]
fn read_exact_at(file: &File, mut buffer: &mut [u8], mut at: u64) -> io::Result<()> {
    while !buffer.is_empty() {
        match std::os::windows::fs::FileExt::seek_read(file, buffer, at)? {
            0 => return Err(io::ErrorKind::UnexpectedEof.into()),
            read => (buffer, at) = (&mut buffer[read..], at + read as u64),
        }
    }
    Ok(())
}
