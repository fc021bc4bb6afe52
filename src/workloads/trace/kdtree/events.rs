//! Events of the exact sweep, and the sweep itself over those of one axis.

use crate::math::Aabb;
use crate::workloads::trace::common::prims::Prim;
use crate::workloads::trace::kdtree::bins::Areas;
use crate::workloads::trace::kdtree::cut::List;
use glam::Vec4;
use rayon::prelude::*;

/// A triangle's box begins, lies or ends in a plane: `coordinate (bits) << 32 | kind << 30 | number of the triangle in
/// this subtree`.
pub(crate) type Event = u64;

pub(crate) const END: u32 = 0;
pub(crate) const PLANAR: u32 = 1;
pub(crate) const START: u32 = 2;

pub(crate) fn event(x: f32, kind: u32, local: u32) -> Event {
    u64::from(x.to_bits()) << 32 | u64::from(kind << 30 | local)
}

/// By coordinate, then in the order in which a sweep needs them: bits that compare as the float does (all of a negative
/// one flipped, the sign of a positive one).
fn ordered(event: Event) -> u64 {
    event ^ (((event as i64) >> 63) as u64 >> 32 << 32 | 1 << 63)
}

/// The event whose [`ordered`] form this is.
fn restored(ordered: u64) -> Event {
    ordered ^ (((!ordered as i64) >> 63) as u64 >> 32 << 32 | 1 << 63)
}

#[inline(always)]
pub(crate) fn coordinate(event: Event) -> f32 {
    f32::from_bits((event >> 32) as u32)
}

#[inline(always)]
pub(crate) fn kind(event: Event) -> u32 {
    (event as u32) >> 30
}

#[inline(always)]
pub(crate) fn local(event: Event) -> usize {
    (event as u32 & 0x3fff_ffff) as usize
}

/// The event of the same triangle under another number.
#[inline(always)]
pub(crate) fn renumbered(event: Event, local: u32) -> Event {
    event & !0x3fff_ffff | u64::from(local & 0x3fff_ffff)
}

/// 1 where a triangle begins.
#[inline(always)]
pub(crate) fn starts(event: Event) -> u32 {
    (event as u32) >> 31
}

/// 1 where a triangle begins or lies, 0 where it ends.
#[inline(always)]
pub(crate) fn begun(event: Event) -> u32 {
    (event >> 31 | event >> 30) as u32 & 1
}

/// The events of a cell's triangles on an axis, in order.
#[derive(Default)]
pub(crate) struct Sorted {
    /// [`Sorted::own`] events, and at least [`SPARE`] more that are not this list's.
    pub events: Vec<Event>,
    pub own: usize,
    /// Some triangle lies in a plane.
    pub planar: bool,
}

impl Sorted {
    /// Takes the place of what was there by the events of these triangles, which are known by their numbers.
    ///
    /// Those on or outside the cell's border are never candidates, and the counts know them without: a triangle that
    /// does not begin inside has begun before, one that does not end inside never ends.
    pub fn fill<'a>(&mut self, prims: impl Iterator<Item = (u32, &'a Prim)>, axis: usize, cell: &Aabb) {
        let Sorted { events, own, planar } = self;
        events.clear();
        *planar = false;
        for (local, prim) in prims {
            let (min, max) = (prim.min[axis], prim.max[axis]);
            if min == max {
                events.push(ordered(event(min, PLANAR, local)));
                *planar = true;
                continue;
            }
            if min > cell.min[axis] {
                events.push(ordered(event(min, START, local)));
            }
            if max < cell.max[axis] {
                events.push(ordered(event(max, END, local)));
            }
        }
        events.sort_unstable();
        events.iter_mut().for_each(|e| *e = restored(*e));
        *own = events.len();
        events.extend([0; SPARE]);
    }
}

impl Sorted {
    /// Itself, to be swept.
    pub fn list(&self) -> List<'_> {
        List { padded: &self.events, own: self.own, planar: self.planar }
    }
}

/// Events that are swept by one thread.
const PART: usize = 1 << 16;

/// The sweep where no triangle lies in a plane of its axis: every event is a candidate by itself, allowed or not.
/// Returns the lowest cost (bits of an f32) and, below it, the event that has it.
///
/// `events` goes on behind the first `own`, by at least [`SPARE`]: four events are read at a time, and those that are
/// not the list's own not regarded.
#[inline(always)]
pub(crate) fn sweep(events: &[Event], own: usize, areas: &Areas, count: usize) -> u64 {
    if own <= PART {
        return sweep_part(events, own, areas, count as f32, -(starts_before(events, own) as f32));
    }
    sweep_parts(events, own, areas, count)
}

/// The same for a long list, part by part at the same time.
#[cold]
fn sweep_parts(events: &[Event], own: usize, areas: &Areas, count: usize) -> u64 {
    let firsts: Vec<usize> = (0..own).step_by(PART).collect();
    let part = |first: usize| (&events[first..], PART.min(own - first));
    let count_starts = |&first: &usize| {
        let (events, own) = part(first);
        starts_before(events, own) as usize
    };
    let starts: Vec<usize> = firsts.par_iter().map(count_starts).collect();
    let all: usize = starts.iter().sum();
    let started = starts.iter().scan(0, |sum, &own| Some(std::mem::replace(sum, *sum + own)));
    let begins: Vec<(usize, usize)> = firsts.iter().copied().zip(started).collect();
    let cheapest = |&(first, started): &(usize, usize)| {
        let (events, own) = part(first);
        let (right, difference) = (count - (first - started), first as f32 - all as f32);
        match sweep_part(events, own, areas, right as f32, difference) {
            u64::MAX => u64::MAX,
            found => found + first as u64,
        }
    };
    begins.par_iter().map(cheapest).min().unwrap_or(u64::MAX)
}

/// How many of the first events of a list are starts; none of them is planar.
#[inline(always)]
fn starts_before(events: &[Event], own: usize) -> u32 {
    let fours = &events.as_chunks::<4>().0[..own.div_ceil(4)];
    let counts = fours.iter().enumerate().map(|(i, four)| {
        let foreign = (4 * i + 4).saturating_sub(own);
        STARTS[starts_of(four) & 15 >> foreign]
    });
    counts.sum()
}

/// The sweep of part of a list: `right` triangles are on the right of its first event, `left_minus_right` more on the
/// left.
///
/// Of several events in one plane, all but the last end and the first start see too many triangles on one side, and so
/// cost more than the plane does; they need no care. With the area `p` on the left and `s - p` on the right (`s` is
/// constant), the cost is `p left + (s - p) right = s right + p (left - right)`, and `left - right` grows by one with
/// every event. Most lists are so short that a mispredicted branch costs more than an event: there is none but the
/// loop's.
#[inline(always)]
fn sweep_part(events: &[Event], own: usize, areas: &Areas, right: f32, left_minus_right: f32) -> u64 {
    if own == 0 {
        return u64::MAX;
    }
    let fours = &events.as_chunks::<4>().0[..own.div_ceil(4)];
    let (mut right, mut difference) = (Vec4::splat(right), Vec4::splat(left_minus_right));
    let (mut costs, mut numbers) = (Vec4::INFINITY, Vec4::ZERO);
    let mut left_over = Vec4::splat(own as f32) - Vec4::new(0.0, 1.0, 2.0, 3.0);
    for (number, four) in fours.iter().enumerate() {
        let Ends { ended, steps } = ENDS[starts_of(four)];
        let planes = Vec4::from_array(four.map(coordinate));
        let cost = areas.costs(planes, right - ended, difference + steps);
        let cheaper = cost.cmplt(costs) & left_over.cmpgt(Vec4::ZERO);
        costs = Vec4::select(cheaper, cost, costs);
        // Bits ride along as floats; nothing is computed with them.
        numbers = Vec4::select(cheaper, Vec4::splat(f32::from_bits(number as u32)), numbers);
        right -= Vec4::splat(ended.w);
        difference += 4.0;
        left_over -= 4.0;
    }
    let ranks = [0, 1, 2, 3].map(|lane| ranked(costs[lane], 4 * numbers[lane].to_bits() as usize + lane));
    ranks[0].min(ranks[1]).min(ranks[2].min(ranks[3]))
}

/// Padding that a swept list needs after its own events.
pub(crate) const SPARE: usize = 3;

/// Which of four events are starts (none is planar), as bits.
#[inline(always)]
fn starts_of(four: &[Event; 4]) -> usize {
    // A start's bit is the sign bit.
    Vec4::from_array(four.map(|e| f32::from_bits(e as u32))).is_negative_bitmask() as usize
}

/// How many bits are set. A table, since processors that this is built for need not have an instruction for it.
const STARTS: [u32; 16] = [0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4];

/// What four events do to the numbers of triangles on both sides.
#[derive(Clone, Copy)]
struct Ends {
    /// How many have ended, up to and with each of the four.
    ended: Vec4,
    /// What the left has gained on the right: one with every event, and an end has its effect already in its own plane.
    steps: Vec4,
}

/// By what [`starts_of`] says.
const ENDS: [Ends; 16] = {
    let mut table = [Ends { ended: Vec4::ZERO, steps: Vec4::ZERO }; 16];
    let mut bits = 0;
    while bits < 16 {
        let (mut ended, mut steps) = ([0.0; 4], [0.0; 4]);
        let (mut sum, mut lane) = (0.0, 0);
        while lane < 4 {
            let end = if bits >> lane & 1 == 0 { 1.0 } else { 0.0 };
            sum += end;
            ended[lane] = sum;
            steps[lane] = lane as f32 + end;
            lane += 1;
        }
        table[bits] = Ends { ended: Vec4::from_array(ended), steps: Vec4::from_array(steps) };
        bits += 1;
    }
    table
};

/// Compares by cost, then by position.
#[inline(always)]
fn ranked(cost: f32, position: usize) -> u64 {
    u64::from(cost.max(0.0).to_bits()) << 32 | position as u64
}

/// The sweep for lists with planar triangles or planes at the border, by groups of events in one plane: ends and planar
/// triangles leave the right before the plane is judged, planar ones and starts enter the left after it. Also returns
/// whether planar triangles go left.
#[cold]
pub(crate) fn sweep_with_planar(events: &[Event], areas: &Areas, count: usize) -> (u64, bool) {
    let begun_inside = events.iter().filter(|&&e| kind(e) != END).count();
    let (mut left, mut right) = (count - begun_inside, count);
    let mut cheapest = (u64::MAX, true);
    let mut position = 0;
    for group in events.chunk_by(|a, b| a >> 32 == b >> 32) {
        let of_kind = |k| group.iter().filter(|&&e| kind(e) == k).count();
        let (plane, planar) = (coordinate(group[0]), of_kind(PLANAR));
        right -= of_kind(END) + planar;
        // Planar triangles may lie on the cell's border, which is no candidate.
        if areas.allows(plane) {
            let cost = |left: usize, right: usize| areas.cost(plane, right as f32, left as f32 - right as f32);
            let on_left = (ranked(cost(left + planar, right), position), true);
            let on_right = (ranked(cost(left, right + planar), position), false);
            for candidate in [on_left, on_right] {
                if candidate.0 < cheapest.0 {
                    cheapest = candidate;
                }
            }
        }
        left += planar + of_kind(START);
        position += group.len();
    }
    cheapest
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    /// Part by part or at once, and by the sweep that groups events by plane: the same plane.
    #[test]
    fn a_long_list_is_swept_as_a_short_one() {
        let cell = Aabb { min: Vec3::ZERO, max: Vec3::new(3.0, 1.0, 2.0) };
        let (areas, _) = Areas::new(&cell, 0.5, 0.0).unwrap();
        for count in [PART as u32 / 2, PART as u32, 5 * PART as u32 / 2 + 7] {
            // Most in a slice at one end: the best plane lies behind them, in a later part
            let place = |i: u32| (i.wrapping_mul(0x9e37_79b9) >> 8) as f32 / (1 << 24) as f32;
            let prims = (0..count).map(|i| {
                let x = if i % 5 == 0 { 2.9 * place(i) } else { 0.1 * place(i) };
                Prim { min: Vec3::splat(x).extend(1.0), max: Vec3::splat(x + 0.01).extend(1.0) }
            });
            let prims: Vec<Prim> = prims.collect();
            let mut sorted = Sorted::default();
            sorted.fill((0..).zip(&prims), 0, &cell);
            let Sorted { events, own, .. } = &sorted;
            let begun = starts_before(events, *own) as f32;
            let at_once = sweep_part(events, *own, &areas[0], count as f32, -begun);
            assert_eq!(sweep_parts(events, *own, &areas[0], count as usize), at_once);
            assert_eq!(sweep(events, *own, &areas[0], count as usize), at_once);
            let (grouped, _) = sweep_with_planar(&events[..*own], &areas[0], count as usize);
            let plane = |found: u64| coordinate(events[found as u32 as usize]);
            assert_eq!((grouped >> 32, plane(grouped)), (at_once >> 32, plane(at_once)));
            assert_ne!(sweep_part(events, *own / 2, &areas[0], count as f32, -begun), at_once, "nothing would be seen");
        }
    }
}
