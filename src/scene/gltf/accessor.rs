//! Reads accessors: typed elements in buffers. Every range is checked before it is read.

use super::Problem;
use super::buffers::Buffers;
use glam::Vec3;
use gltf::Accessor;
use gltf::accessor::{DataType, Dimensions};

/// The largest number of elements of a sparse accessor without a base view, which has no bytes for most elements,
/// unless the buffers have more bytes than this.
const FREE_ELEMENTS: usize = 1 << 16;

/// Reads vectors of three floats.
pub fn vectors(accessor: &Accessor, buffers: &Buffers) -> Result<Vec<Vec3>, Problem> {
    if (accessor.dimensions(), accessor.data_type()) != (Dimensions::Vec3, DataType::F32) {
        return Err(fault(accessor, "must have three floats per element"));
    }
    read(accessor, buffers, 12, |b| {
        let float = |i: usize| f32::from_le_bytes([b[i], b[i + 1], b[i + 2], b[i + 3]]);
        Vec3::new(float(0), float(4), float(8))
    })
}

/// Refuses an accessor with more elements than its bytes, or the file's, can hold. Call this before allocating memory
/// for the elements.
pub fn check(accessor: &Accessor, buffers: &Buffers) -> Result<(), Problem> {
    let (size, count) = (accessor.size(), accessor.count());
    match accessor.view() {
        Some(view) => {
            let bytes = buffers.view(&view)?;
            let fits = slots(bytes, accessor.offset(), view.stride(), size, count).is_some();
            if fits { Ok(()) } else { Err(fault(accessor, BEYOND)) }
        }
        None if accessor.sparse().is_none() => Err(fault(accessor, "has no data")),
        None if count > FREE_ELEMENTS.max(buffers.total()) => {
            Err(fault(accessor, "has more elements than the file can fill"))
        }
        None => Ok(()),
    }
}

const BEYOND: &str = "reaches beyond its buffer view";

/// Like [`check`], for an accessor of indices.
pub fn check_indices(accessor: &Accessor, buffers: &Buffers) -> Result<(), Problem> {
    index(accessor)?;
    check(accessor, buffers)
}

/// Reads indices of one, two or four bytes.
pub fn indices(accessor: &Accessor, buffers: &Buffers) -> Result<Vec<u32>, Problem> {
    let (size, one) = index(accessor)?;
    read(accessor, buffers, size, one)
}

/// Converts the bytes of an index.
type ReadIndex = fn(&[u8]) -> u32;

/// The size of an index in bytes, and its conversion.
fn index(accessor: &Accessor) -> Result<(usize, ReadIndex), Problem> {
    if accessor.dimensions() != Dimensions::Scalar {
        return Err(fault(accessor, "must have one index per element"));
    }
    match accessor.data_type() {
        DataType::U8 => Ok((1, index_u8)),
        DataType::U16 => Ok((2, index_u16)),
        DataType::U32 => Ok((4, index_u32)),
        _ => Err(fault(accessor, "must hold unsigned integers")),
    }
}

fn index_u8(b: &[u8]) -> u32 {
    b[0].into()
}

fn index_u16(b: &[u8]) -> u32 {
    u16::from_le_bytes([b[0], b[1]]).into()
}

fn index_u32(b: &[u8]) -> u32 {
    u32::from_le_bytes([b[0], b[1], b[2], b[3]])
}

fn fault(accessor: &Accessor, problem: &str) -> Problem {
    (format!("accessor {} {problem}", accessor.index()), "export the file again")
}

/// Reads all elements of `size` bytes. Sparse elements replace those of the base; without a base view the base is zero.
fn read<T: Clone>(accessor: &Accessor, buffers: &Buffers, size: usize, one: fn(&[u8]) -> T) -> Result<Vec<T>, Problem> {
    let count = accessor.count();
    let beyond = || fault(accessor, BEYOND);
    check(accessor, buffers)?;
    let mut elements = match accessor.view() {
        Some(view) => {
            let bytes = buffers.view(&view)?;
            slots(bytes, accessor.offset(), view.stride(), size, count).ok_or_else(beyond)?.map(one).collect()
        }
        None => vec![one(&[0; 12][..size]); count],
    };
    if let Some(sparse) = accessor.sparse() {
        use gltf::accessor::sparse::IndexType;
        let (size_of_index, index): (usize, ReadIndex) = match sparse.indices().index_type() {
            IndexType::U8 => (1, index_u8),
            IndexType::U16 => (2, index_u16),
            IndexType::U32 => (4, index_u32),
        };
        let (places, values) = (sparse.indices(), sparse.values());
        let (place_view, value_view) = (places.view(), values.view());
        let place_bytes = buffers.view(&place_view)?;
        let value_bytes = buffers.view(&value_view)?;
        let places = slots(place_bytes, places.offset(), place_view.stride(), size_of_index, sparse.count());
        let values = slots(value_bytes, values.offset(), value_view.stride(), size, sparse.count());
        for (place, value) in places.ok_or_else(beyond)?.zip(values.ok_or_else(beyond)?) {
            let element = elements.get_mut(index(place) as usize);
            *element.ok_or_else(|| fault(accessor, "replaces an element beyond its end"))? = one(value);
        }
    }
    Ok(elements)
}

/// `count` slices of `size` bytes, `stride` apart; `None` if the last does not fit.
fn slots(
    bytes: &[u8],
    offset: usize,
    stride: Option<usize>,
    size: usize,
    count: usize,
) -> Option<impl Iterator<Item = &[u8]>> {
    let stride = stride.unwrap_or(size);
    let end = match count.checked_sub(1) {
        Some(last) => stride.checked_mul(last)?.checked_add(offset)?.checked_add(size)?,
        None => 0,
    };
    // A stride of zero would allow any number of elements in a few bytes.
    if end > bytes.len() || stride < size {
        return None;
    }
    Some((0..count).map(move |i| &bytes[offset + i * stride..][..size]))
}
