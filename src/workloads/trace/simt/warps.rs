//! A traversal whose counting pass is replayed in warps.

use super::lockstep::{Group, Lockstep, replay};
use super::reads::TestReads;
use super::stream::Stream;
use super::sums::Sums;
use crate::math::Ray;
use crate::workloads::trace::count::{ByRayType, Counters};
use crate::workloads::trace::traverse::{GROUP, Lanes, Search, Traverser, bits};
use std::cell::Cell;
use std::sync::{Mutex, PoisonError};

/// See the module.
pub struct InWarps<'a> {
    traversal: &'a dyn Traverser,
    lockstep: Lockstep,
    group: Group,
    tests: TestReads<'a>,
    found: Mutex<Found>,
}

thread_local! {
    /// The streams of a thread's last work-group, whose memory the next one uses.
    static SPARE: Cell<Option<Box<Lanes<Stream>>>> = const { Cell::new(None) };
}

#[derive(Default)]
struct Found {
    sums: ByRayType<Sums>,
    /// The first problem.
    problem: Option<String>,
}

impl<'a> InWarps<'a> {
    /// A traversal that counts in warps whatever it is asked to count.
    pub fn new(traversal: &'a dyn Traverser, lockstep: Lockstep, group: Group, tests: TestReads<'a>) -> InWarps<'a> {
        InWarps { traversal, lockstep, group, tests, found: Mutex::default() }
    }

    /// What its warps have issued, by ray type.
    ///
    /// # Errors
    /// The first event that does not fit the loops of the traversal.
    pub fn sums(self) -> Result<ByRayType<Sums>, String> {
        let Found { sums, problem } = self.found.into_inner().unwrap_or_else(PoisonError::into_inner);
        problem.map_or(Ok(sums), Err)
    }
}

impl Traverser for InWarps<'_> {
    fn uncounted(&self, search: Search, rays: &Lanes<Ray>, alive: u64) -> Lanes<u32> {
        self.traversal.uncounted(search, rays, alive)
    }

    fn counted(
        &self,
        (kind, search): (usize, Search),
        rays: &Lanes<Ray>,
        alive: u64,
        counters: &mut Lanes<Counters>,
    ) -> Lanes<u32> {
        let mut streams = SPARE.take().unwrap_or_else(|| Box::new(std::array::from_fn(|_| Stream::default())));
        streams.iter_mut().zip(&*counters).for_each(|(stream, counters)| stream.begin(*counters));
        let hits = self.traversal.recorded(search, rays, alive, &mut streams);
        for lane in bits(alive) {
            counters[lane] = streams[lane].counters;
        }
        let mut sums = Sums::default();
        let replayed = replay(&self.lockstep, self.group, alive, (&streams, self.tests), &mut sums);
        SPARE.set(Some(streams));
        let mut found = self.found.lock().unwrap_or_else(PoisonError::into_inner);
        found.sums[kind] = found.sums[kind].with(&sums);
        if let Err(problem) = replayed {
            found.problem.get_or_insert(problem);
        }
        hits
    }

    fn recorded(&self, search: Search, rays: &Lanes<Ray>, alive: u64, streams: &mut Lanes<Stream>) -> Lanes<u32> {
        self.traversal.recorded(search, rays, alive, streams)
    }
}

const _: () = assert!(GROUP == 64, "a work-group's lanes are the bits of a word");
