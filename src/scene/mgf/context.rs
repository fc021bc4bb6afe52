//! Named and unnamed contexts: the current vertex, colour or material.

use crate::scene::text::{Fault, quote_bytes};
use foldhash::fast::RandomState;
use std::collections::HashMap;

/// The contexts of one kind.
pub struct Contexts<T> {
    /// Places in `all`.
    named: HashMap<Box<[u8]>, u32, RandomState>,
    /// The one without a name comes first.
    all: Vec<T>,
    current: usize,
}

impl<T: Default> Default for Contexts<T> {
    fn default() -> Contexts<T> {
        Contexts { named: HashMap::default(), all: vec![T::default()], current: 0 }
    }
}

impl<T: Clone + Default> Contexts<T> {
    /// `[id [= [template]]]`: makes a context current, an old one or a new one.
    pub fn select(&mut self, arguments: &[&[u8]]) -> Result<(), Fault> {
        match *arguments {
            [] => self.start(0, T::default()),
            [name] => self.current = self.place(name)?,
            [name, b"="] => {
                let place = self.place_of_new(name);
                self.start(place, T::default());
            }
            [name, b"=", template] => {
                let value = self.find(template)?.clone();
                let place = self.place_of_new(name);
                self.start(place, value);
            }
            _ => {
                let mend = "write nothing, a name, `name =` or `name = template`";
                return Err(Fault::new(None, "this selects no context", mend));
            }
        }
        Ok(())
    }

    fn start(&mut self, place: usize, value: T) {
        self.all[place] = value;
        self.current = place;
    }

    /// The place of a name, which may be new.
    fn place_of_new(&mut self, name: &[u8]) -> usize {
        if let Some(&place) = self.named.get(name) {
            return place as usize;
        }
        let place = self.all.len();
        self.all.push(T::default());
        // A file of 2^32 names would not fit into memory
        self.named.insert(name.into(), place as u32);
        place
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
        self.named.get(name).map(|&place| place as usize).ok_or_else(|| {
            let problem = format!("{} is not defined", quote_bytes(name));
            Fault::new(None, problem, "define it before, with `NAME =`")
        })
    }
}
