//! Counts of warps.

use super::reads::{Loads, SEGMENTS};
use super::stream::{EVENTS, Event};

/// A recorded count that is no whole number.
#[derive(Clone, Copy, Debug)]
pub struct NotWhole;

/// What warps issued, summed over traversals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sums {
    /// Traversals by a warp that has a live ray; by every warp of a work-group whose rays go together.
    pub warps: u64,
    /// By event, how often warps issued it.
    pub issued: [u64; EVENTS.len()],
    /// By event, the lanes that took part.
    pub lanes: [u64; EVENTS.len()],
    /// What they read.
    pub loads: Loads,
}

impl Sums {
    /// Adds an event that `warps` of them issue, for so many lanes.
    pub(super) fn add(&mut self, event: Event, warps: u64, lanes: u64) {
        self.issued[event as usize] += warps;
        self.lanes[event as usize] += lanes;
    }

    /// The sums of both.
    #[must_use]
    pub fn with(&self, other: &Sums) -> Sums {
        Sums {
            warps: self.warps.saturating_add(other.warps),
            issued: std::array::from_fn(|i| self.issued[i].saturating_add(other.issued[i])),
            lanes: std::array::from_fn(|i| self.lanes[i].saturating_add(other.lanes[i])),
            loads: self.loads.with(&other.loads),
        }
    }

    /// Name and value of each count: `warps`, of each event that occurs `issued_EVENT` and `lanes_EVENT`, and where
    /// anything is read `loads` and for each size of segments `segments_BYTES`.
    pub fn values(&self) -> Vec<(String, u64)> {
        let of_event = |(i, event): (usize, &&str)| {
            [(format!("issued_{event}"), self.issued[i]), (format!("lanes_{event}"), self.lanes[i])]
        };
        let occurs = |(i, _): &(usize, &&str)| self.issued[*i] > 0;
        let events = EVENTS.iter().enumerate().filter(occurs).flat_map(of_event);
        let segments = SEGMENTS.iter().zip(self.loads.segments);
        let segments = segments.map(|(bytes, number)| (format!("segments_{bytes}"), number));
        let loads = std::iter::once(("loads".to_owned(), self.loads.issued)).chain(segments);
        let loads = loads.filter(|_| self.loads.issued > 0);
        std::iter::once(("warps".to_owned(), self.warps)).chain(events).chain(loads).collect()
    }

    /// Reads what [`Sums::values`] wrote: `get` has a count by its name, an error for one that is no whole number.
    /// `None` where there are no warps or something is damaged.
    pub fn read(get: impl Fn(&str) -> Result<u64, NotWhole>) -> Option<Sums> {
        let of = |what: &str| -> Result<[u64; EVENTS.len()], NotWhole> {
            let mut counts = [0; EVENTS.len()];
            for (count, event) in counts.iter_mut().zip(EVENTS) {
                *count = get(&format!("{what}_{event}"))?;
            }
            Ok(counts)
        };
        let mut segments = [0; SEGMENTS.len()];
        for (segments, bytes) in segments.iter_mut().zip(SEGMENTS) {
            *segments = get(&format!("segments_{bytes}")).ok()?;
        }
        let loads = Loads { issued: get("loads").ok()?, segments };
        let sums = Sums { warps: get("warps").ok()?, issued: of("issued").ok()?, lanes: of("lanes").ok()?, loads };
        (sums.warps > 0).then_some(sums)
    }

    /// True if no more lanes take part than warps of `width` lanes have.
    pub fn fits(&self, width: u32) -> bool {
        let fits = |(&issued, &lanes): (&u64, &u64)| lanes <= issued.saturating_mul(u64::from(width));
        self.issued.iter().zip(&self.lanes).all(fits)
    }

    /// True for a name that [`Sums::values`] gives.
    pub fn has(name: &str) -> bool {
        let prefixes = ["issued_", "lanes_", "segments_"];
        ["warps", "loads"].contains(&name) || prefixes.iter().any(|prefix| name.starts_with(prefix))
    }

    /// The share of lanes that take part in what warps of `width` lanes issue, 0 to 1; `None` where nothing is issued.
    pub fn utilisation(&self, width: u32) -> Option<f64> {
        let (issued, lanes) = (self.issued.iter().sum::<u64>(), self.lanes.iter().sum::<u64>());
        (issued > 0).then(|| lanes as f64 / (issued * u64::from(width)) as f64)
    }
}
