//! Lists of numbers that are also found by scene, structure and options, so that tables of many rows take time in
//! proportion to them.

use super::data::{Built, Counts, Frame};
use super::scenes::SceneKey;
use super::variant::Variant;
use foldhash::fast::FixedState;
use std::collections::HashMap;
use std::hash::BuildHasher;
use std::ops::Deref;

/// Something that belongs to a scene, a structure and its options.
pub trait Place {
    /// The three.
    fn place(&self) -> (&SceneKey, &str, &Variant);
}

impl Place for Frame {
    fn place(&self) -> (&SceneKey, &str, &Variant) {
        (&self.scene, &self.structure, &self.variant)
    }
}

impl Place for Counts {
    fn place(&self) -> (&SceneKey, &str, &Variant) {
        (&self.scene, &self.structure, &self.variant)
    }
}

impl Place for Built {
    fn place(&self) -> (&SceneKey, &str, &Variant) {
        (&self.scene, &self.structure, &self.variant)
    }
}

/// A list in its order, with an index by place.
#[derive(Clone, Debug)]
pub struct Indexed<T> {
    items: Vec<T>,
    /// Indices of the items by the hash of their place: the items themselves tell equal hashes apart.
    places: HashMap<u64, Vec<usize>>,
}

impl<T> Default for Indexed<T> {
    fn default() -> Self {
        Indexed { items: Vec::new(), places: HashMap::new() }
    }
}

impl<T> Deref for Indexed<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.items
    }
}

fn hash(place: (&SceneKey, &str, &Variant)) -> u64 {
    FixedState::default().hash_one(place)
}

impl<T: Place> Indexed<T> {
    /// Adds an item at the end.
    pub fn push(&mut self, item: T) {
        self.places.entry(hash(item.place())).or_default().push(self.items.len());
        self.items.push(item);
    }

    /// The items of a place, in their order.
    pub fn of(&self, scene: &SceneKey, structure: &str, variant: &Variant) -> impl DoubleEndedIterator<Item = &T> {
        let indices = self.places.get(&hash((scene, structure, variant))).map_or(&[][..], Vec::as_slice);
        indices.iter().map(|&index| &self.items[index])
    }

    /// Replaces the item of the same place that `is_same` accepts, or adds it. True if it replaced one.
    pub fn put(&mut self, item: T, is_same: impl Fn(&T) -> bool) -> bool {
        let indices = self.places.get(&hash(item.place())).map_or(&[][..], Vec::as_slice);
        let same = |index: &&usize| self.items[**index].place() == item.place() && is_same(&self.items[**index]);
        match indices.iter().find(same) {
            Some(&index) => {
                self.items[index] = item;
                true
            }
            None => {
                self.push(item);
                false
            }
        }
    }
}

impl<T: Place> FromIterator<T> for Indexed<T> {
    fn from_iter<I: IntoIterator<Item = T>>(items: I) -> Indexed<T> {
        let mut indexed = Indexed::default();
        items.into_iter().for_each(|item| indexed.push(item));
        indexed
    }
}
