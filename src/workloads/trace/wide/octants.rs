//! Children at places that tell in which order a ray visits them, by the signs of its direction alone.
//!
//! H. Ylitie, T. Karras and S. Laine 2017, section 3.2: each of eight places is a corner of the node's box, and a child
//! lies near its own. A ray visits places in the order of their numbers, with those bits flipped whose axes it goes
//! backwards. Their assignment is by auction; this one is greedy, as in obvhs. Ours: nodes of four children, whose
//! places are corners in two axes, those of the scene's greatest extents.

use crate::math::Aabb;
use glam::DVec3;

/// The axes of the bits of a place's number, lowest bit first.
pub fn axes(width: usize, bounds: Aabb) -> Vec<usize> {
    let mut axes = vec![2, 1, 0];
    if width == 4 {
        // The axis of the least extent is left out; of equal extents, the last one
        let extent = bounds.max.as_dvec3() - bounds.min.as_dvec3();
        let least = (0..3).fold(0, |least, axis| if extent[axis] <= extent[least] { axis } else { least });
        axes.retain(|axis| *axis != least);
    }
    axes
}

/// A place for each of some boxes, none taken twice: at most as many boxes as corners in these axes.
pub fn places(boxes: &[Aabb], axes: &[usize]) -> Vec<usize> {
    let centre = |b: &Aabb| b.min.as_dvec3() + b.max.as_dvec3();
    let middle = centre(&boxes.iter().fold(Aabb::EMPTY, |all, b| all.union(*b)));
    // The farther a child lies towards a corner, the less it costs there
    let cost = |b: &Aabb, place: usize| {
        let from_middle: DVec3 = centre(b) - middle;
        axes.iter().enumerate().map(|(bit, &axis)| from_middle[axis] * [1.0, -1.0][place >> bit & 1]).sum::<f64>()
    };
    let corners = 1 << axes.len();
    let mut pairs: Vec<(f64, usize, usize)> = (0..boxes.len())
        .flat_map(|child| (0..corners).map(move |place| (child, place)))
        .map(|(child, place)| (cost(&boxes[child], place), child, place))
        .collect();
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let (mut places, mut taken) = (vec![usize::MAX; boxes.len()], vec![false; corners]);
    for (_, child, place) in pairs {
        if places[child] == usize::MAX && !taken[place] {
            (places[child], taken[place]) = (place, true);
        }
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn a_ray_meets_what_lies_in_front_first() {
        let at = |x: f32, y: f32, z: f32| Aabb { min: Vec3::new(x, y, z), max: Vec3::new(x, y, z) + 0.1 };
        let corner = |i: usize| [4, 2, 1].map(|bit| if i & bit != 0 { 1.0 } else { 0.0 });
        let all: Vec<Aabb> = (0..8).map(|i| at(corner(i)[0], corner(i)[1], corner(i)[2])).collect();
        assert_eq!(places(&all, &[2, 1, 0]), [0, 1, 2, 3, 4, 5, 6, 7]);
        let two = [at(5.0, 0.0, 0.0), at(0.0, 0.0, 0.0)];
        let places = places(&two, &[2, 1, 0]);
        assert!(places[0] & 4 == 4 && places[1] & 4 == 0, "{places:?}");
    }

    #[test]
    fn four_places_leave_the_shortest_axis_out() {
        let bounds = |x, y, z| Aabb { min: Vec3::ZERO, max: Vec3::new(x, y, z) };
        assert_eq!(axes(4, bounds(3.0, 1.0, 2.0)), [2, 0]);
        assert_eq!(axes(4, bounds(1.0, 1.0, 1.0)), [1, 0]);
        assert_eq!(axes(8, bounds(3.0, 1.0, 2.0)), [2, 1, 0]);
    }
}
