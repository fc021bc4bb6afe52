//! The cheapest plane of a node by the exact sweep, and what it does to the node's triangles.

use crate::math::Aabb;
use crate::workloads::trace::kdtree::bins::Areas;
use crate::workloads::trace::kdtree::build::{Builder, both};
use crate::workloads::trace::kdtree::events::{
    Event, PLANAR, begun, coordinate, kind, local, starts, sweep, sweep_with_planar,
};
use std::ops::Range;

/// Sides that a triangle goes to, as bits.
pub(crate) const LEFT: u8 = 1;
pub(crate) const RIGHT: u8 = 2;

/// The axes of nodes of more triangles are swept at the same time.
const TASK: usize = 8192;

/// The events of a node on one axis, in order: those strictly inside its cell, and all of planar triangles.
#[derive(Clone, Copy)]
pub(crate) struct List<'a> {
    /// Its own events, and behind them at least [`super::events::SPARE`] that are not.
    pub padded: &'a [Event],
    /// How many are its own.
    pub own: usize,
    /// Triangles may lie in a plane of the axis.
    pub planar: bool,
}

impl<'a> List<'a> {
    pub fn events(&self) -> &'a [Event] {
        &self.padded[..self.own]
    }

    /// The lowest cost of a plane (bits of an f32) and, below it, an event that lies there; and whether planar
    /// triangles go left.
    #[inline(always)]
    fn cheapest(&self, areas: &Areas, count: usize) -> (u64, bool) {
        let events = self.events();
        let planar = self.planar && events.iter().any(|&e| kind(e) == PLANAR);
        let found = if planar { u64::MAX } else { sweep(self.padded, self.own, areas, count) };
        // Seldom is the cheapest plane one that would cut off too thin a slice: then again, without such.
        if planar || (found != u64::MAX && !areas.allows(coordinate(events[found as u32 as usize]))) {
            return sweep_with_planar(events, areas, count);
        }
        (found, true)
    }
}

/// A plane that pays.
pub(crate) struct Cut {
    pub axis: usize,
    pub plane: f32,
    /// Side of the triangles that lie in the plane.
    pub planar_left: bool,
    /// The events of the axis that lie in the plane.
    pub here: Range<usize>,
}

/// Sweeps all three axes for the cheapest plane; `None` if it does not pay. `unit` is about 1 over the extent of a
/// larger cell.
#[inline(always)]
pub(crate) fn find(builder: &Builder, cell: &Aabb, unit: f32, count: usize, lists: &[List; 3]) -> Option<Cut> {
    let (areas, area) = Areas::new(cell, unit, builder.thin)?;
    let on = |axis: usize| lists[axis].cheapest(&areas[axis], count);
    let found = if count > TASK {
        let (x, (y, z)) = both(true, || on(0), || both(true, || on(1), || on(2)));
        [x, y, z]
    } else {
        [on(0), on(1), on(2)]
    };
    let (mut axis, mut cheapest, mut planar_left) = (0, u64::MAX, true);
    for (a, (cost, left)) in found.into_iter().enumerate() {
        if cost < cheapest {
            (axis, cheapest, planar_left) = (a, cost, left);
        }
    }
    let cost = f32::from_bits((cheapest >> 32) as u32);
    if cheapest == u64::MAX || !builder.pays(count, f64::from(cost), f64::from(area)) {
        return None;
    }
    let (events, at) = (lists[axis].events(), cheapest as u32 as usize);
    let plane = coordinate(events[at]);
    let before = events[..at].iter().rev().take_while(|&&e| coordinate(e) == plane).count();
    let after = events[at..].iter().take_while(|&&e| coordinate(e) == plane).count();
    Some(Cut { axis, plane, planar_left, here: at - before..at + after })
}

impl Cut {
    /// Decides where every triangle of the node goes: to both sides, which `side` says already, unless an event of the
    /// cut's axis says otherwise.
    #[inline(always)]
    pub fn classify(&self, list: &List, side: &mut [u8]) {
        let events = list.events();
        // What ends here or below does not reach the right; what begins here or above does not reach the left.
        for &e in &events[..self.here.end] {
            side[local(e)] &= LEFT | (starts(e) << 1) as u8;
        }
        for &e in &events[self.here.start..] {
            side[local(e)] &= RIGHT | (1 - begun(e)) as u8;
        }
        if list.planar {
            let own = if self.planar_left { LEFT } else { RIGHT };
            self.planar(events).for_each(|e| side[local(e)] = own);
        }
    }

    /// The events of triangles that lie in the plane.
    pub fn planar(&self, events: &[Event]) -> impl Iterator<Item = Event> {
        events[self.here.clone()].iter().copied().filter(|&e| kind(e) == PLANAR)
    }
}
