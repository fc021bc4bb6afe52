//! Events of the exact sweep, and the sweep itself over those of one axis.

use crate::workloads::trace::kdtree::bins::Areas;
use glam::Vec4;

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
pub(crate) fn ordered(event: Event) -> u64 {
    event ^ (((event as i64) >> 63) as u64 >> 32 << 32 | 1 << 63)
}

/// The event whose [`ordered`] form this is.
pub(crate) fn restored(ordered: u64) -> Event {
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

/// The sweep where no triangle lies in a plane of its axis: every event is a candidate by itself, allowed or not.
/// Returns the lowest cost (bits of an f32) and, below it, the event that has it.
///
/// Of several events in one plane, all but the last end and the first start see too many triangles on one side, and so
/// cost more than the plane does; they need no care. With the area `p` on the left and `s - p` on the right (`s` is
/// constant), the cost is `p left + (s - p) right = s right + p (left - right)`, and `left - right` grows by one with
/// every event. Most lists are so short that a mispredicted branch costs more than an event: there is none but the
/// loop's.
///
/// `events` goes on behind the first `own`, by at least [`SPARE`]: four events are read at a time, and those that are
/// not the list's own not regarded.
#[inline(always)]
pub(crate) fn sweep(events: &[Event], own: usize, areas: &Areas, count: usize) -> u64 {
    if own == 0 {
        return u64::MAX;
    }
    let fours = &events.as_chunks::<4>().0[..own.div_ceil(4)];
    let begun: u32 = fours
        .iter()
        .enumerate()
        .map(|(i, four)| {
            let foreign = (4 * i + 4).saturating_sub(own);
            STARTS[starts_of(four) & 15 >> foreign]
        })
        .sum();
    let (mut right, mut difference) = (Vec4::splat(count as f32), Vec4::splat(-(begun as f32)));
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
