//! Exact quantities: whole numbers that were counted or measured in bytes, and hashes of what was computed.

use crate::record::stream::{LeanRow, Name, Names};

/// The value of an exact quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// A whole number.
    Count(u64),
    /// A hash.
    Hash(Name),
    /// The row has no such quantity.
    Absent,
}

impl Quantity {
    /// As text; a hash by its first eight digits.
    pub fn write(self, names: &Names) -> String {
        match self {
            Quantity::Count(value) => value.to_string(),
            Quantity::Hash(name) => names.text(name).get(..8).unwrap_or(names.text(name)).to_owned(),
            Quantity::Absent => "-".to_owned(),
        }
    }
}

/// An exact quantity that differs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change {
    /// Index of the row.
    pub row: usize,
    /// Name of the quantity.
    pub quantity: Name,
    /// Value on the older side.
    pub old: Quantity,
    /// Value on the newer side.
    pub new: Quantity,
}

/// Compares the exact quantities of two rows with results. Returns how many were compared.
pub fn compare(
    index: usize,
    old: &LeanRow,
    new: &LeanRow,
    machine: &[Name],
    with_hashes: bool,
    changes: &mut Vec<Change>,
) -> usize {
    let mut compared = 0;
    let mut add = |quantity: Name, old: Quantity, new: Quantity| {
        compared += 1;
        if old != new {
            changes.push(Change { row: index, quantity, old, new });
        }
    };
    let counts = |old: &[(Name, u64)], new: &[(Name, u64)], add: &mut dyn FnMut(Name, Quantity, Quantity)| {
        merge(old, new, machine, &mut |name, old, new| {
            let quantity = |value: Option<u64>| value.map_or(Quantity::Absent, Quantity::Count);
            add(name, quantity(old), quantity(new));
        });
    };
    counts(&old.exact, &new.exact, &mut add);
    if with_hashes {
        merge(&old.outputs, &new.outputs, machine, &mut |name, old, new| {
            let quantity = |value: Option<Name>| value.map_or(Quantity::Absent, Quantity::Hash);
            add(name, quantity(old), quantity(new));
        });
    }
    compared
}

/// Calls `each` with the values of each name on both sides. Rows mostly list them in the same order.
fn merge<T: Copy>(
    old: &[(Name, T)],
    new: &[(Name, T)],
    left_out: &[Name],
    each: &mut dyn FnMut(Name, Option<T>, Option<T>),
) {
    for (index, &(name, value)) in old.iter().enumerate().filter(|(_, (name, _))| !left_out.contains(name)) {
        let other = match new.get(index) {
            Some((same, other)) if *same == name => Some(*other),
            _ => new.iter().find(|(other, _)| *other == name).map(|(_, value)| *value),
        };
        each(name, Some(value), other);
    }
    for (index, &(name, value)) in new.iter().enumerate().filter(|(_, (name, _))| !left_out.contains(name)) {
        let is_known = old.get(index).is_some_and(|(same, _)| *same == name);
        if !is_known && !old.iter().any(|(other, _)| *other == name) {
            each(name, None, Some(value));
        }
    }
}
