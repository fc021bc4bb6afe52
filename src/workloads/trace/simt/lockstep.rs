//! How the lanes of a warp go through a kernel's loops, and the replay of their events by it.

use super::reads::{Read, TestReads};
use super::stream::{EVENTS, Event, NO_READ, Stream};
use super::sums::Sums;
use crate::workloads::trace::traverse::{GROUP, Lanes, bits};

/// A part of a kernel, by the events that its lanes report there.
#[derive(Clone, Copy, Debug)]
pub enum Part {
    /// Each lane that is at this event does it; the others wait.
    One(Event),
    /// The same, but every warp of the work-group executes it: barriers keep them together.
    All(Event),
    /// All of these events in turn, shared out among the invocations of the work-group.
    Shared(Event),
    /// A loop, as long as any lane is at one of the events that it can begin with.
    Loop(u16, &'static [Part]),
    /// A branch that is taken by lanes at one of the events that it can begin with.
    Maybe(u16, &'static [Part]),
    /// Branches of which each lane takes at most one.
    Choice(&'static [Part]),
}

/// How a traversal's lanes wait for each other.
#[derive(Clone, Copy, Debug)]
pub struct Lockstep {
    /// What the kernel does, from its begin to its end.
    pub parts: &'static [Part],
    /// True where barriers keep the warps of a work-group together; otherwise each goes through the parts alone.
    pub together: bool,
    /// What its events read, but for tests, which read triangles.
    pub reads: &'static [Read],
}

impl Lockstep {
    /// Warps go alone.
    pub const fn apart(parts: &'static [Part]) -> Lockstep {
        Lockstep { parts, together: false, reads: &[] }
    }

    /// The warps of a work-group wait for each other.
    pub const fn together(parts: &'static [Part]) -> Lockstep {
        Lockstep { parts, together: true, reads: &[] }
    }

    /// The same, with what its events read.
    #[must_use]
    pub const fn reading(self, reads: &'static [Read]) -> Lockstep {
        Lockstep { reads, ..self }
    }
}

/// A loop over these parts.
pub const fn repeat(body: &'static [Part]) -> Part {
    Part::Loop(first(body), body)
}

/// A branch.
pub const fn maybe(body: &'static [Part]) -> Part {
    Part::Maybe(first(body), body)
}

/// Branches, each made by [`maybe`].
pub const fn choice(branches: &'static [Part]) -> Part {
    Part::Choice(branches)
}

/// The events that parts can begin with. An event that is not in a loop or a branch is always there.
const fn first(parts: &[Part]) -> u16 {
    let (mut set, mut i) = (0, 0);
    while i < parts.len() {
        match parts[i] {
            Part::One(event) | Part::All(event) => return set | event.bit(),
            Part::Shared(event) => set |= event.bit(),
            Part::Loop(of_body, _) | Part::Maybe(of_body, _) => set |= of_body,
            Part::Choice(branches) => set |= first(branches),
        }
        i += 1;
    }
    set
}

/// The invocations of a work-group, in warps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Group {
    /// Invocations, at most 64.
    pub size: u32,
    /// Lanes of a warp.
    pub width: u32,
}

impl Group {
    fn warps(self) -> impl Iterator<Item = u64> {
        let all = if self.size >= u64::BITS { u64::MAX } else { (1 << self.size) - 1 };
        let lanes = if self.width >= u64::BITS { u64::MAX } else { (1 << self.width) - 1 };
        (0..self.size).step_by(self.width as usize).map(move |from| lanes << from & all)
    }
}

/// Replays one traversal of a work-group, of which the lanes in `alive` take part, and adds what its warps issue.
///
/// # Errors
/// What does not fit: events that the parts have no place for.
pub fn replay(
    lockstep: &Lockstep,
    group: Group,
    alive: u64,
    (streams, tests): (&Lanes<Stream>, TestReads),
    sums: &mut Sums,
) -> Result<(), String> {
    let reads = lockstep.reads;
    let mut replay = Replay { group, streams, reads, tests, next: [0; GROUP], at: [0; EVENTS.len()], sums };
    bits(alive).for_each(|lane| replay.arrive(lane));
    if lockstep.together {
        replay.sums.warps += if alive == 0 { 0 } else { group.warps().count() as u64 };
        replay.run(lockstep.parts, alive);
    } else {
        for warp in group.warps().filter(|warp| warp & alive != 0) {
            replay.sums.warps += 1;
            replay.run(lockstep.parts, warp & alive);
        }
    }
    let left = bits(alive).find(|&lane| replay.next[lane] < streams[lane].events.len());
    left.map_or(Ok(()), |lane| {
        let (place, events) = (replay.next[lane], &streams[lane].events);
        Err(format!("event {place} of lane {lane}, {:?}, has no place in the loops of the traversal", events[place]))
    })
}

struct Replay<'a> {
    group: Group,
    streams: &'a Lanes<Stream>,
    reads: &'static [Read],
    tests: TestReads<'a>,
    /// Of each lane, the number of its next event.
    next: [usize; GROUP],
    /// By event, the lanes whose next one it is.
    at: [u64; EVENTS.len()],
    sums: &'a mut Sums,
}

impl Replay<'_> {
    /// Notes the next event of a lane.
    fn arrive(&mut self, lane: usize) {
        if let Some(&event) = self.streams[lane].events.get(self.next[lane]) {
            self.at[event as usize] |= 1 << lane;
        }
    }

    /// Lanes at one of these events.
    fn lanes_at(&self, set: u16) -> u64 {
        self.at.iter().enumerate().filter(|(event, _)| set >> event & 1 == 1).fold(0, |all, (_, lanes)| all | lanes)
    }

    /// Warps with one of these lanes.
    fn warps_of(&self, lanes: u64) -> u64 {
        self.group.warps().filter(|warp| warp & lanes != 0).count() as u64
    }

    fn run(&mut self, parts: &'static [Part], mask: u64) {
        for part in parts {
            match *part {
                Part::One(event) => self.one(event, mask),
                Part::All(event) => {
                    self.load_all(event, mask);
                    let lanes = self.pass(event, mask);
                    if lanes != 0 {
                        self.sums.add(event, self.group.warps().count() as u64, u64::from(lanes.count_ones()));
                    }
                }
                Part::Shared(event) => {
                    self.load_shared(event, mask);
                    let events: u64 = bits(mask).map(|lane| self.pass_all(event, lane)).sum();
                    let turns = events.div_ceil(u64::from(self.group.size));
                    self.sums.add(event, turns * self.group.warps().count() as u64, events);
                }
                Part::Loop(_, [Part::One(event)]) => self.many(*event, mask),
                Part::Loop(first, body) => loop {
                    let lanes = mask & self.lanes_at(first);
                    if lanes == 0 {
                        break;
                    }
                    self.run(body, lanes);
                },
                Part::Maybe(first, body) => {
                    let lanes = mask & self.lanes_at(first);
                    if lanes != 0 {
                        self.run(body, lanes);
                    }
                }
                Part::Choice(branches) => {
                    // Who takes which branch is decided before any is taken
                    let mut left = mask;
                    let mut taken = [(0, [].as_slice()); 4];
                    for (branch, taken) in branches.iter().zip(&mut taken) {
                        if let Part::Maybe(first, body) = *branch {
                            *taken = (left & self.lanes_at(first), body);
                            left &= !taken.0;
                        }
                    }
                    for (lanes, body) in taken.into_iter().filter(|(lanes, _)| *lanes != 0) {
                        self.run(body, lanes);
                    }
                }
            }
        }
    }

    /// Lanes at an event go to their next one; which ones they are.
    fn pass(&mut self, event: Event, mask: u64) -> u64 {
        let lanes = mask & self.at[event as usize];
        self.at[event as usize] &= !lanes;
        for lane in bits(lanes) {
            self.next[lane] += 1;
            self.arrive(lane);
        }
        lanes
    }

    /// The number of events of a kind that follow each other.
    fn following(&self, event: Event, lane: usize) -> usize {
        self.streams[lane].events[self.next[lane]..].iter().take_while(|&&next| next == event).count()
    }

    /// A lane passes all events of a kind that follow each other; their number.
    fn pass_all(&mut self, event: Event, lane: usize) -> u64 {
        let count = self.following(event, lane);
        if count > 0 {
            self.at[event as usize] &= !(1 << lane);
            self.next[lane] += count;
            self.arrive(lane);
        }
        count as u64
    }

    fn one(&mut self, event: Event, mask: u64) {
        let at = mask & self.at[event as usize];
        for warp in self.group.warps() {
            self.load(event, bits(warp & at).map(|lane| (lane, 0)));
        }
        let lanes = self.pass(event, mask);
        let warps = self.warps_of(lanes);
        self.sums.add(event, warps, u64::from(lanes.count_ones()));
    }

    /// A loop with nothing but an event: each warp takes as many turns as one of its lanes needs.
    fn many(&mut self, event: Event, mask: u64) {
        let lanes = mask & self.at[event as usize];
        for warp in self.group.warps().filter(|warp| warp & lanes != 0) {
            let mut turns = [0; GROUP];
            let (mut most, mut sum) = (0, 0);
            for lane in bits(warp & lanes) {
                turns[lane] = self.following(event, lane);
                (most, sum) = (most.max(turns[lane]), sum + turns[lane]);
            }
            for turn in 0..most {
                self.load(event, bits(warp & lanes).filter(|&lane| turn < turns[lane]).map(|lane| (lane, turn)));
            }
            bits(warp & lanes).for_each(|lane| {
                self.pass_all(event, lane);
            });
            self.sums.add(event, most as u64, sum as u64);
        }
    }

    /// What the lanes of a warp read for an event, of each lane the one that is so many behind its next one.
    fn load(&mut self, event: Event, lanes: impl Iterator<Item = (usize, usize)>) {
        let read = self.reads.iter().find(|read| read.event == event);
        if read.is_none() && event != Event::Test {
            return;
        }
        let (mut indices, mut length) = ([0; GROUP], 0);
        let index = |(lane, behind): (usize, usize)| self.streams[lane].reads[self.next[lane] + behind];
        for index in lanes.map(index).filter(|&index| index != NO_READ) {
            indices[length] = index;
            length += 1;
        }
        match read {
            Some(read) => {
                self.sums.loads.add(*read, &mut indices[..length]);
            }
            None => self.sums.loads.add_test(self.tests, &mut indices[..length]),
        }
    }

    /// What every warp of the work-group reads for an event: one without a lane at it reads what the others do.
    fn load_all(&mut self, event: Event, mask: u64) {
        let at = mask & self.at[event as usize];
        for warp in self.group.warps() {
            let own = if warp & at == 0 { at & at.wrapping_neg() } else { warp & at };
            self.load(event, bits(own).map(|lane| (lane, 0)));
        }
    }

    /// What warps read for events that are shared out, in the order of lanes.
    fn load_shared(&mut self, event: Event, mask: u64) {
        let of_lane = |lane| (0..self.following(event, lane)).map(move |behind| (lane, behind));
        let all: Vec<(usize, usize)> = bits(mask).flat_map(of_lane).collect();
        for of_group in all.chunks(self.group.size as usize) {
            of_group.chunks(self.group.width as usize).for_each(|warp| self.load(event, warp.iter().copied()));
        }
    }
}
