//! Reads accessors: typed elements in buffers. Every range is checked before it is read.

use super::buffers::{Buffers, Bytes};
use super::json::{List, Whole};
use super::schema;
use crate::scene::mesh_builder::Limits;
use crate::scene::text::Fault;
use foldhash::fast::RandomState;
use glam::{DQuat, Vec3};
use std::collections::HashMap;
use std::fmt::Display;

/// The largest number of elements of an accessor without a base view, which has no bytes for most elements, unless the
/// files have more bytes than this.
const FREE_ELEMENTS: usize = 1 << 16;

/// The type of a component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
    Other,
}

impl Component {
    fn of(code: usize) -> Component {
        match code {
            5120 => Component::I8,
            5121 => Component::U8,
            5122 => Component::I16,
            5123 => Component::U16,
            5125 => Component::U32,
            5126 => Component::F32,
            _ => Component::Other,
        }
    }

    /// Size in bytes.
    fn size(self) -> usize {
        match self {
            Component::I8 | Component::U8 => 1,
            Component::I16 | Component::U16 => 2,
            Component::U32 | Component::F32 | Component::Other => 4,
        }
    }

    /// The component at this index of an element. With `unit`, integers are mapped to -1..1 or 0..1.
    fn read(self, element: &[u8], index: usize, unit: bool) -> f32 {
        let b = &element[index * self.size()..];
        let (value, largest) = match self {
            Component::I8 => (f32::from(b[0] as i8), 127.0),
            Component::U8 => (f32::from(b[0]), 255.0),
            Component::I16 => (f32::from(i16::from_le_bytes([b[0], b[1]])), 32767.0),
            Component::U16 => (f32::from(u16::from_le_bytes([b[0], b[1]])), 65535.0),
            _ => return f32::from_le_bytes([b[0], b[1], b[2], b[3]]),
        };
        if unit { (value / largest).max(-1.0) } else { value }
    }

    fn read_index(self, element: &[u8]) -> u32 {
        match self {
            Component::I8 | Component::U8 => element[0].into(),
            Component::I16 | Component::U16 => u16::from_le_bytes([element[0], element[1]]).into(),
            _ => u32::from_le_bytes([element[0], element[1], element[2], element[3]]),
        }
    }
}

/// An accessor, checked: its bytes exist.
#[derive(Clone, Copy)]
pub struct Accessor {
    index: usize,
    pub count: usize,
    view: Option<usize>,
    offset: usize,
    component: Component,
    unit: bool,
    /// Number of components; 0 for matrices.
    dimensions: usize,
    sparse: Option<schema::Sparse>,
}

impl Accessor {
    /// True if it has bytes of its own.
    pub fn has_bytes(&self) -> bool {
        self.view.is_some() || self.sparse.is_some()
    }

    fn size(&self) -> usize {
        self.component.size() * self.dimensions
    }

    fn fault(&self, problem: &str) -> Fault {
        Fault::new(None, format!("accessor {} {problem}", self.index), "export the file again")
    }
}

const BEYOND: &str = "reaches beyond its buffer view";

/// The use of an accessor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    /// Three floats or small integers.
    Vectors,
    /// Three floats or small signed integers.
    Normals,
    /// Four floats or small signed integers.
    Rotations,
    /// One unsigned integer.
    Indices,
}

/// The accessors of a file and their bytes.
pub struct Accessors<'a> {
    list: List<'a>,
    pub buffers: Buffers<'a>,
    known: HashMap<usize, Accessor, RandomState>,
}

/// Memory of an entry of the table in bytes, while the table grows.
const PER_ENTRY: usize = 3 * size_of::<(usize, Accessor)>();

impl<'a> Accessors<'a> {
    pub fn new(list: List<'a>, buffers: Buffers<'a>) -> Accessors<'a> {
        Accessors { list, buffers, known: HashMap::default() }
    }

    /// The accessor that `from` names, for this use. Call this before allocating memory for the elements.
    ///
    /// # Errors
    /// It does not exist, has another type, or more elements than its bytes, or the file's, can hold.
    pub fn get(&mut self, index: usize, used: Use, from: impl Display, limits: &mut Limits) -> Result<Accessor, Fault> {
        if let Some(known) = self.known.get(&index) {
            return fits(known, used).map(|()| *known);
        }
        let schema::Accessor { buffer_view, byte_offset, component_type, normalized, count, dimensions, sparse } =
            self.list.get(index, from)?;
        let dimensions = match &*dimensions.0 {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 0,
        };
        let found = Accessor {
            index,
            count: count.0,
            view: buffer_view.map(|Whole(view)| view),
            offset: byte_offset.unwrap_or_default().0,
            component: Component::of(component_type.0),
            unit: normalized.given() == Some(true),
            dimensions,
            sparse,
        };
        fits(&found, used)?;
        match found.view {
            Some(view) => {
                let bytes = self.buffers.view(view, &format!("accessors[{index}]"), limits)?;
                let fits = slots(&bytes, found.offset, found.size(), found.count).is_some();
                fits.then_some(()).ok_or_else(|| found.fault(BEYOND))?;
            }
            None if found.count > FREE_ELEMENTS.max(self.buffers.file_bytes) => {
                return Err(found.fault("has more elements than the file can fill"));
            }
            None => {}
        }
        limits.keep(PER_ENTRY)?;
        self.known.insert(index, found);
        Ok(found)
    }

    /// Reads vectors of three components.
    pub fn vectors(&mut self, accessor: Accessor, limits: &mut Limits) -> Result<Vec<Vec3>, Fault> {
        let Accessor { component, unit, .. } = accessor;
        if component == Component::F32 {
            let float = |b: &[u8], i: usize| f32::from_le_bytes([b[i], b[i + 1], b[i + 2], b[i + 3]]);
            return self.read(accessor, limits, |b| Vec3::new(float(b, 0), float(b, 4), float(b, 8)));
        }
        let part = |b: &[u8], i: usize| component.read(b, i, unit);
        self.read(accessor, limits, |b| Vec3::new(part(b, 0), part(b, 1), part(b, 2)))
    }

    /// Reads rotations as unit quaternions. Integers are directions, so it does not matter whether they are normalized.
    pub fn rotations(&mut self, accessor: Accessor, limits: &mut Limits) -> Result<Vec<DQuat>, Fault> {
        let part = |b: &[u8], i: usize| f64::from(accessor.component.read(b, i, true));
        self.read(accessor, limits, |b| {
            let rotation = DQuat::from_xyzw(part(b, 0), part(b, 1), part(b, 2), part(b, 3));
            if rotation.length_squared() > 0.0 { rotation.normalize() } else { DQuat::IDENTITY }
        })
    }

    /// Reads indices of one, two or four bytes.
    pub fn indices(&mut self, accessor: Accessor, limits: &mut Limits) -> Result<Vec<u32>, Fault> {
        self.read(accessor, limits, |b| accessor.component.read_index(b))
    }

    /// Reads all elements. Sparse elements replace those of the base; without a base view the base is zero.
    fn read<T: Clone>(
        &mut self,
        accessor: Accessor,
        limits: &mut Limits,
        one: impl Fn(&[u8]) -> T,
    ) -> Result<Vec<T>, Fault> {
        let (size, count) = (accessor.size(), accessor.count);
        let beyond = || accessor.fault(BEYOND);
        let from = format!("accessors[{}]", accessor.index);
        let mut elements = match accessor.view {
            Some(view) => {
                let bytes = self.buffers.view(view, &from, limits)?;
                slots(&bytes, accessor.offset, size, count).ok_or_else(beyond)?.map(&one).collect()
            }
            None => vec![one(&[0; 16][..size]); count],
        };
        if let Some(schema::Sparse { count: Whole(count), indices, values }) = accessor.sparse {
            let kind = Component::of(indices.component_type.unwrap_or_default().0);
            if !matches!(kind, Component::U8 | Component::U16 | Component::U32) {
                return Err(accessor.fault("has sparse indices that are not unsigned integers"));
            }
            // This bounds the time: many nodes may share many elements that replace few.
            limits.keep(count / 2)?;
            let places = self.buffers.view(indices.buffer_view.0, &format!("{from}.sparse.indices"), limits)?;
            let news = self.buffers.view(values.buffer_view.0, &format!("{from}.sparse.values"), limits)?;
            let places = slots(&places, indices.byte_offset.unwrap_or_default().0, kind.size(), count);
            let news = slots(&news, values.byte_offset.unwrap_or_default().0, size, count);
            for (place, new) in places.ok_or_else(beyond)?.zip(news.ok_or_else(beyond)?) {
                let element = elements.get_mut(kind.read_index(place) as usize);
                *element.ok_or_else(|| accessor.fault("replaces an element beyond its end"))? = one(new);
            }
        }
        Ok(elements)
    }
}

/// Checks that an accessor has a type for this use.
fn fits(accessor: &Accessor, used: Use) -> Result<(), Fault> {
    use Component::{F32, I8, I16, U8, U16, U32};
    let (dimensions, components, problem): (usize, &[Component], &str) = match used {
        Use::Vectors => (3, &[F32, I8, U8, I16, U16], "must have three floats, bytes or shorts per element"),
        Use::Normals => (3, &[F32, I8, I16], "must have three floats, signed bytes or signed shorts per element"),
        Use::Rotations => (4, &[F32, I8, I16], "must have four floats, signed bytes or signed shorts per element"),
        Use::Indices if accessor.dimensions != 1 => return Err(accessor.fault("must have one index per element")),
        Use::Indices => (1, &[U8, U16, U32], "must hold unsigned integers"),
    };
    let right = accessor.dimensions == dimensions && components.contains(&accessor.component);
    if right { Ok(()) } else { Err(accessor.fault(problem)) }
}

/// `count` slices of `size` bytes, the stride of the view apart; `None` if the last does not fit.
fn slots<'b>(bytes: &'b Bytes, offset: usize, size: usize, count: usize) -> Option<impl Iterator<Item = &'b [u8]>> {
    let stride = bytes.stride.unwrap_or(size);
    let bytes = bytes.bytes();
    let end = match count.checked_sub(1) {
        Some(last) => stride.checked_mul(last)?.checked_add(offset)?.checked_add(size)?,
        None => 0,
    };
    // A stride of less would allow any number of elements in a few bytes.
    if end > bytes.len() || stride < size {
        return None;
    }
    Some((0..count).map(move |i| &bytes[offset + i * stride..][..size]))
}
