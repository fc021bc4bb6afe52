//! What warps read, in segments of memory: which loads there are, and not what they cost.

use super::stream::Event;
use crate::math::Vertex;
use crate::workloads::trace::TriangleRef;

/// Sizes of segments in bytes. Arrays begin at the border of a segment.
pub const SEGMENTS: [u64; 3] = [32, 64, 128];

/// What an event reads: `bytes` of an array, at `stride` bytes times the index that the twin reports.
#[derive(Clone, Copy, Debug)]
pub struct Read {
    /// The event.
    pub event: Event,
    /// Bytes from an index to the next.
    pub stride: u64,
    /// Bytes that are read.
    pub bytes: u64,
}

impl Read {
    /// An element of an array of `T`.
    pub const fn one<T>(event: Event) -> Read {
        let bytes = size_of::<T>() as u64;
        Read { event, stride: bytes, bytes }
    }

    /// Two elements of an array of `T` that follow each other.
    pub const fn pair<T>(event: Event) -> Read {
        let stride = size_of::<T>() as u64;
        Read { event, stride, bytes: 2 * stride }
    }
}

/// What a triangle test reads.
#[derive(Clone, Copy, Debug)]
pub enum TestReads<'a> {
    /// A triangle reference, and the positions of its vertices.
    Indexed(&'a [TriangleRef]),
    /// Three corners from a copy in leaf order.
    LeafOrder,
}

/// Bytes of a corner, in a vertex or in leaf order.
const CORNER: u64 = 16;

/// Loads of warps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Loads {
    /// Loads that warps issue; what an event reads of an array is one.
    pub issued: u64,
    /// By the size of segments, the distinct segments that the lanes of each load touch.
    pub segments: [u64; SEGMENTS.len()],
}

impl Loads {
    /// The sums of both.
    #[must_use]
    pub fn with(&self, other: &Loads) -> Loads {
        let segments = std::array::from_fn(|i| self.segments[i].saturating_add(other.segments[i]));
        Loads { issued: self.issued.saturating_add(other.issued), segments }
    }

    /// Adds what a test reads; `indices` are the triangle references of a warp's lanes.
    pub(super) fn add_test(&mut self, reads: TestReads, indices: &mut [u32]) {
        match reads {
            TestReads::LeafOrder => {
                self.add(Read { event: Event::Test, stride: 3 * CORNER, bytes: 3 * CORNER }, indices);
            }
            TestReads::Indexed(refs) => {
                let corners = Read { bytes: CORNER, ..Read::one::<Vertex>(Event::Test) };
                let distinct = self.add(Read::one::<TriangleRef>(Event::Test), indices);
                let mut vertices = [0; 64];
                let vertices = &mut vertices[..distinct.len()];
                for corner in 0..3 {
                    let of = distinct.iter().map(|&index| refs.get(index as usize).map_or(0, |r| r.vertices[corner]));
                    vertices.iter_mut().zip(of).for_each(|(vertex, index)| *vertex = index);
                    self.add(corners, vertices);
                }
            }
        }
    }

    /// Adds a load; `indices` are those of a warp's lanes. Returns the distinct ones.
    pub(super) fn add<'a>(&mut self, read: Read, indices: &'a mut [u32]) -> &'a [u32] {
        let distinct = sorted(indices);
        self.issued += u64::from(!distinct.is_empty());
        // Of ascending indices, so that a segment is new if it is behind the last one
        let mut next = [0; SEGMENTS.len()];
        for &index in distinct {
            let from = u64::from(index) * read.stride;
            let last = from + read.bytes - 1;
            for ((segments, next), size) in self.segments.iter_mut().zip(&mut next).zip(SEGMENTS) {
                let (first, end) = ((from / size).max(*next), last / size + 1);
                *segments += end.saturating_sub(first);
                *next = end;
            }
        }
        distinct
    }
}

/// Sorts numbers and removes those that are equal.
fn sorted(numbers: &mut [u32]) -> &[u32] {
    let Some(&first) = numbers.first() else { return &[] };
    if numbers.iter().all(|&number| number == first) {
        return &numbers[..1];
    }
    numbers.sort_unstable();
    let mut length = 1;
    for i in 1..numbers.len() {
        if numbers[i] != numbers[length - 1] {
            numbers[length] = numbers[i];
            length += 1;
        }
    }
    &numbers[..length]
}
