//! Events of the exact sweep, and the sweep itself over those of one axis.

use super::kdtree_bins::Areas;
use glam::Vec4;

/// A triangle's box begins, lies or ends in a plane: `coordinate (bits) << 32 | kind << 30 | number of the triangle in
/// this subtree`.
pub(super) type Event = u64;

pub(super) const END: u32 = 0;
pub(super) const PLANAR: u32 = 1;
pub(super) const START: u32 = 2;

pub(super) fn event(x: f32, kind: u32, local: u32) -> Event {
    u64::from(x.to_bits()) << 32 | u64::from(kind << 30 | local)
}

/// By coordinate, then in the order in which a sweep needs them: bits that compare as the float does (all of a negative
/// one flipped, the sign of a positive one).
pub(super) fn ordered(event: Event) -> u64 {
    event ^ (((event as i64) >> 63) as u64 >> 32 << 32 | 1 << 63)
}

/// The event whose [`ordered`] form this is.
pub(super) fn restored(ordered: u64) -> Event {
    ordered ^ (((!ordered as i64) >> 63) as u64 >> 32 << 32 | 1 << 63)
}

#[inline(always)]
pub(super) fn coordinate(event: Event) -> f32 {
    f32::from_bits((event >> 32) as u32)
}

#[inline(always)]
pub(super) fn kind(event: Event) -> u32 {
    (event as u32) >> 30
}

#[inline(always)]
pub(super) fn local(event: Event) -> usize {
    (event as u32 & 0x3fff_ffff) as usize
}

/// 1 where a triangle begins or lies, 0 where it ends.
#[inline(always)]
pub(super) fn begun(event: Event) -> u32 {
    (event >> 31 | event >> 30) as u32 & 1
}

/// The sweep where no triangle lies in a plane of its axis: every event is a candidate by itself, allowed or not. Returns
/// the lowest cost (bits of an f32) and, below it, the event that has it.
///
/// Of several events in one plane, all but the last end and the first start see too many triangles on one side, and so
/// cost more than the plane does; they need no care. With the area `p` on the left and `s - p` on the right (`s` is
/// constant), the cost is `p left + (s - p) right = s right + p (left - right)`, and `left - right` grows by one with
/// every event. Most lists are so short that a mispredicted branch costs more than an event: there is none but the
/// loop's.
#[inline(always)]
pub(super) fn sweep(events: &[Event], areas: &Areas, count: usize, begun: u32) -> u64 {
    let (mut right, mut difference) = (count as f32, -(begun as f32));
    let mut cheapest = u64::MAX;
    let (fours, rest) = events.as_chunks::<4>();
    if !fours.is_empty() {
        let (mut costs, mut numbers) = (Vec4::INFINITY, Vec4::ZERO);
        for (number, four) in fours.iter().enumerate() {
            let [a, b, c, d] = four.map(is_end);
            let ended = Vec4::new(a, a + b, a + b + c, a + b + c + d);
            let steps = Vec4::new(a, 1.0 + b, 2.0 + c, 3.0 + d);
            let planes = Vec4::from_array(four.map(coordinate));
            let cost = areas.costs(planes, Vec4::splat(right) - ended, Vec4::splat(difference) + steps);
            let cheaper = cost.cmplt(costs);
            costs = Vec4::select(cheaper, cost, costs);
            // Bits ride along as floats; nothing is computed with them.
            numbers = Vec4::select(cheaper, Vec4::splat(f32::from_bits(number as u32)), numbers);
            right -= ended.w;
            difference += 4.0;
        }
        for lane in 0..4 {
            cheapest = cheapest.min(ranked(costs[lane], 4 * numbers[lane].to_bits() as usize + lane));
        }
    }
    for (i, &e) in rest.iter().enumerate() {
        let end = is_end(e);
        right -= end;
        let cost = areas.cost(coordinate(e), right, difference + end);
        difference += 1.0;
        cheapest = cheapest.min(ranked(cost, 4 * fours.len() + i));
    }
    cheapest
}

/// 1 for an end, 0 for a start, by the start's bit alone.
#[inline(always)]
fn is_end(event: Event) -> f32 {
    f32::from_bits(!((event as i32) >> 31) as u32 & 1_f32.to_bits())
}

/// Compares by cost, then by position.
#[inline(always)]
fn ranked(cost: f32, position: usize) -> u64 {
    u64::from(cost.max(0.0).to_bits()) << 32 | position as u64
}

/// The sweep with care for everything, by groups of events in one plane: ends and planar triangles leave the right before
/// the plane is judged, planar ones and starts enter the left after it. Also returns whether planar triangles go left.
#[cold]
pub(super) fn careful_sweep(events: &[Event], areas: &Areas, count: usize, begun: u32) -> (u64, bool) {
    let (mut left, mut right) = (count - begun as usize, count);
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
