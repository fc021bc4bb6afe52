//! Named and unnamed contexts: the current vertex, colour or material.

use crate::scene::text::{Fault, quote_bytes};
use foldhash::fast::RandomState;
use hashbrown::HashTable;
use std::hash::BuildHasher;

/// All contexts of one kind.
pub struct Contexts<T> {
    names: Names,
    /// Contexts by the number of their name; the first is the unnamed context.
    all: Vec<T>,
    current: usize,
}

/// Names, numbered from 1 in the order of their definition. All names are stored in one buffer: files name nearly every
/// vertex, so that an allocation per name would take more memory than the scene.
struct Names {
    text: Vec<u8>,
    /// End of name `i` in the text; name 0 is empty.
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

    /// Adds a name, unless it exists. Returns its number, and whether it is new.
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
    /// Makes a context current, as the arguments `[id [= [template]]]` demand.
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
                return Err(Fault::new(None, "the arguments do not select a context", hint));
            }
        }
        Ok(())
    }

    fn start(&mut self, place: usize, value: T) {
        self.all[place] = value;
        self.current = place;
    }

    /// The index of the context with this name, which is created if necessary.
    fn place_of_new(&mut self, name: &[u8]) -> Result<usize, Fault> {
        let (place, new) = self.names.add(name)?;
        if new {
            // Grows by a half instead of doubling: this is most of the memory while reading.
            if self.all.len() == self.all.capacity() {
                self.all.reserve_exact(16 + self.all.len() / 2);
            }
            self.all.push(T::default());
        }
        Ok(place)
    }

    /// Makes the context of this name current, which is created with `value` unless it exists.
    pub fn select_or(&mut self, name: &[u8], value: T) -> Result<(), Fault> {
        match self.names.find(name) {
            Some(place) => self.current = place,
            None => {
                let place = self.place_of_new(name)?;
                self.start(place, value);
            }
        }
        Ok(())
    }

    pub fn current(&self) -> &T {
        &self.all[self.current]
    }

    pub fn current_mut(&mut self) -> &mut T {
        &mut self.all[self.current]
    }

    /// A context by name.
    pub fn find(&self, name: &[u8]) -> Result<&T, Fault> {
        self.place(name).map(|place| &self.all[place])
    }

    fn place(&self, name: &[u8]) -> Result<usize, Fault> {
        self.names.find(name).ok_or_else(|| {
            let problem = format!("{} is not defined", quote_bytes(name));
            Fault::new(None, problem, "define it with `NAME =` before it is used")
        })
    }
}
