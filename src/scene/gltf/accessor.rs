//! Accessors: typed elements in buffers, every place checked before it is read.

use super::Fault;
use super::buffers::Buffers;
use glam::Vec3;
use gltf::Accessor;
use gltf::accessor::{DataType, Dimensions};

/// Elements that need no bytes (sparse ones over zeros) are believed up to this number, or the size of the buffers.
const FREE_ELEMENTS: usize = 1 << 16;

/// Vectors of three floats.
pub fn vectors(accessor: &Accessor, buffers: &Buffers) -> Result<Vec<Vec3>, Fault> {
    if (accessor.dimensions(), accessor.data_type()) != (Dimensions::Vec3, DataType::F32) {
        return Err(fault(accessor, "must have three floats per element"));
    }
    read(accessor, buffers, 12, |b| {
        let float = |i: usize| f32::from_le_bytes([b[i], b[i + 1], b[i + 2], b[i + 3]]);
        Vec3::new(float(0), float(4), float(8))
    })
}

/// Refuses an accessor that has more elements than its bytes, or the file, can have. To be asked before memory is set aside
/// for them.
pub fn check(accessor: &Accessor, buffers: &Buffers) -> Result<(), Fault> {
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

/// The same for what must be indices.
pub fn check_indices(accessor: &Accessor, buffers: &Buffers) -> Result<(), Fault> {
    index(accessor)?;
    check(accessor, buffers)
}

/// Indices of one, two or four bytes.
pub fn indices(accessor: &Accessor, buffers: &Buffers) -> Result<Vec<u32>, Fault> {
    let (size, one) = index(accessor)?;
    read(accessor, buffers, size, one)
}

/// How an index is read from its bytes.
type ReadIndex = fn(&[u8]) -> u32;

/// Bytes of an index, and how it is read.
fn index(accessor: &Accessor) -> Result<(usize, ReadIndex), Fault> {
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

fn fault(accessor: &Accessor, problem: &str) -> Fault {
    (format!("accessor {} {problem}", accessor.index()), "export the file again")
}

/// All elements of `size` bytes; sparse ones replace those of the base, which is zero if there is none.
fn read<T: Clone>(accessor: &Accessor, buffers: &Buffers, size: usize, one: fn(&[u8]) -> T) -> Result<Vec<T>, Fault> {
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
            *element.ok_or_else(|| fault(accessor, "replaces an element that it does not have"))? = one(value);
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
    // A stride of zero would make any number of elements out of nothing.
    if end > bytes.len() || stride < size {
        return None;
    }
    Some((0..count).map(move |i| &bytes[offset + i * stride..][..size]))
}
