//! What a ray does, in its order.

use crate::workloads::trace::count::{Count, Counters};

/// Something that a warp issues.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Event {
    /// An inner node is visited, or a cell of a grid.
    Step,
    /// A leaf is visited.
    Leaf,
    /// A triangle is tested.
    Test,
    /// An entry is taken from a stack.
    Pop,
    /// A search begins anew at or below the root.
    Restart,
    /// A rope or a link to a parent is followed.
    Rope,
    /// A search by ropes is given up.
    Fallback,
    /// A packet chooses between two children.
    Vote,
    /// A turn of a loop that visits no node of its own: a box is tested, a leaf is put off, a packet has its next cell.
    Turn,
    /// A child's box is tested, in a loop over children.
    Child,
}

/// Names of the events, in the order of [`Event`].
pub const EVENTS: [&str; 10] = ["step", "leaf", "test", "pop", "restart", "rope", "fallback", "vote", "turn", "child"];

/// What a twin reports that no counter counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// [`Event::Vote`].
    Vote,
    /// [`Event::Turn`].
    Turn,
}

impl Event {
    /// Its bit in a set of events.
    pub const fn bit(self) -> u16 {
        1 << self as u16
    }
}

/// A ray's events and counters.
#[derive(Clone, Debug, Default)]
pub struct Stream {
    /// What the ray has counted.
    pub counters: Counters,
    /// In their order.
    pub events: Vec<Event>,
    /// Of each event, the index of what it reads, or [`NO_READ`].
    pub reads: Vec<u32>,
}

/// No index.
pub const NO_READ: u32 = u32::MAX;

impl Stream {
    /// Begins anew, with a ray that goes on counting.
    pub fn begin(&mut self, counters: Counters) {
        self.counters = counters;
        self.events.clear();
        self.reads.clear();
    }

    /// Adds an event that reads nothing.
    pub fn push(&mut self, event: Event) {
        self.events.push(event);
        self.reads.push(NO_READ);
    }
}

impl Count for Stream {
    fn ray(&mut self) {
        self.counters.ray();
    }
    fn inner(&mut self) {
        self.counters.inner();
        self.push(Event::Step);
    }
    fn leaf(&mut self) {
        self.counters.leaf();
        self.push(Event::Leaf);
    }
    fn test(&mut self) {
        self.counters.test();
        self.push(Event::Test);
    }
    fn pop(&mut self) {
        self.counters.pop();
        self.push(Event::Pop);
    }
    fn restart(&mut self) {
        self.counters.restart();
        self.push(Event::Restart);
    }
    fn rope(&mut self) {
        self.counters.rope();
        self.push(Event::Rope);
    }
    fn fallback(&mut self) {
        self.counters.fallback();
        self.push(Event::Fallback);
    }
    // A part of a visit
    fn skip(&mut self) {
        self.counters.skip();
    }
    fn box_test(&mut self) {
        self.counters.box_test();
        self.push(Event::Child);
    }
    // A part of a visit: no loop
    fn box_tests(&mut self, tests: u32) {
        (0..tests).for_each(|_| self.counters.box_test());
    }
    fn mark(&mut self, mark: Mark) {
        self.push(match mark {
            Mark::Vote => Event::Vote,
            Mark::Turn => Event::Turn,
        });
    }
    fn read(&mut self, index: u32) {
        if let Some(read) = self.reads.last_mut() {
            *read = index;
        }
    }
}
