//! Named and unnamed contexts: the current vertex, colour or material.

use crate::scene::text::{Fault, quote_bytes};
use foldhash::fast::RandomState;
use hashbrown::HashTable;
use std::hash::BuildHasher;

/// The contexts of one kind.
pub struct Contexts<T> {
    names: Names,
    /// By the names' numbers; the one without a name comes first.
    all: Vec<T>,
    current: usize,
}

/// Names, numbered from 1 in the order in which they come. One text holds them all: files name nearly every vertex, and
/// an allocation and a key for each would take more memory than the scene.
struct Names {
    text: Vec<u8>,
    /// Where name `i` ends in the text; name 0 is nobody's.
    ends: Vec<u32>,
    numbers: HashTable<u32>,
    hasher: RandomState,
}

impl Default for Names {
    fn default() -> Names {
        Names { text: Vec::new(), ends: vec![0], numbers: HashTable::new(), hasher: RandomState::default() }
    }
}

impl Names {
    fn find(&self, name: &[u8]) -> Option<usize> {
        self.find_hashed(name, self.hasher.hash_one(name))
    }

    fn find_hashed(&self, name: &[u8], hash: u64) -> Option<usize> {
        let found = self.numbers.find(hash, |&number| nth(&self.text, &self.ends, number) == name);
        found.map(|&number| number as usize)
    }

    /// The number of a name, and whether it is new.
    fn add(&mut self, name: &[u8]) -> Result<(usize, bool), Fault> {
        let hash = self.hasher.hash_one(name);
        if let Some(number) = self.find_hashed(name, hash) {
            return Ok((number, false));
        }
        let Names { text, ends, numbers, hasher } = self;
        let Ok(end) = u32::try_from(text.len() + name.len()) else {
            return Err(Fault::new(None, "names take more than 4 GiB", "split the file"));
        };
        text.extend_from_slice(name);
        let number = ends.len() as u32;
        ends.push(end);
        numbers.insert_unique(hash, number, |&number: &u32| hasher.hash_one(nth(text, ends, number)));
        Ok((number as usize, true))
    }
}

fn nth<'t>(text: &'t [u8], ends: &[u32], number: u32) -> &'t [u8] {
    let number = number as usize;
    &text[ends[number - 1] as usize..ends[number] as usize]
}

impl<T: Default> Default for Contexts<T> {
    fn default() -> Contexts<T> {
        Contexts { names: Names::default(), all: vec![T::default()], current: 0 }
    }
}

impl<T: Clone + Default> Contexts<T> {
    /// `[id [= [template]]]`: makes a context current, an old one or a new one.
    pub fn select(&mut self, arguments: &[&[u8]]) -> Result<(), Fault> {
        match *arguments {
            [] => self.start(0, T::default()),
            [name] => self.current = self.place(name)?,
            [name, b"="] => {
                let place = self.place_of_new(name)?;
                self.start(place, T::default());
            }
            [name, b"=", template] => {
                let value = self.find(template)?.clone();
                let place = self.place_of_new(name)?;
                self.start(place, value);
            }
            _ => {
                let hint = "write nothing, a name, `name =` or `name = template`";
                return Err(Fault::new(None, "this selects no context", hint));
            }
        }
        Ok(())
    }

    fn start(&mut self, place: usize, value: T) {
        self.all[place] = value;
        self.current = place;
    }

    /// The place of a name, which may be new.
    fn place_of_new(&mut self, name: &[u8]) -> Result<usize, Fault> {
        let (place, new) = self.names.add(name)?;
        if new {
            // Half as much again, not twice as much: this is most of what reading takes
            if self.all.len() == self.all.capacity() {
                self.all.reserve_exact(16 + self.all.len() / 2);
            }
            self.all.push(T::default());
        }
        Ok(place)
    }

    /// The current context.
    pub fn current(&self) -> &T {
        &self.all[self.current]
    }

    /// The current context, to be changed.
    pub fn change(&mut self) -> &mut T {
        &mut self.all[self.current]
    }

    /// A context by name.
    pub fn find(&self, name: &[u8]) -> Result<&T, Fault> {
        self.place(name).map(|place| &self.all[place])
    }

    fn place(&self, name: &[u8]) -> Result<usize, Fault> {
        self.names.find(name).ok_or_else(|| {
            let problem = format!("{} is not defined", quote_bytes(name));
            Fault::new(None, problem, "define it before, with `NAME =`")
        })
    }
}
