//! One photon on its way through the hierarchy to the boxes that it touches. Twin of
//! `kernels/splat/splatting/walk.wgsl`.

use super::facets::facets;
use crate::error::{Error, Result};
use crate::math::Aabb;
use crate::workloads::splat::clusters::layout::LEVELS;
use crate::workloads::splat::clusters::{Bounds, Clusters, KeyLayout, Lookup, Nodes, Placement};
use crate::workloads::splat::photons::Photons;
use glam::{Vec3, Vec3A, Vec4};

/// What photons are tested against.
pub struct Walk<'a> {
    clusters: &'a Clusters,
    layout: &'a KeyLayout,
    placement: &'a Placement,
    reach2: f32,
    /// Empty where keys have no normals.
    facets: Vec<Vec4>,
    level: u32,
    lookup: Lookup,
}

/// The tests of a photon.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tests {
    /// Distances to boxes.
    pub boxes: u64,
    /// Clusters that were left out because their normals face away.
    pub cones: u64,
}

/// Square of the distance of a point from a box; 0 inside.
pub fn square_distance(point: Vec3A, bounds: &Bounds) -> f32 {
    let way = point - point.max(bounds.min.into()).min(bounds.max.into());
    way.dot(way)
}

impl<'a> Walk<'a> {
    /// A walk of photons with a radius to clusters (level 5) or to nodes of a level from 1 on.
    ///
    /// # Errors
    /// [`Error::Refused`] for nodes where there is no hierarchy.
    pub fn new(
        clusters: &'a Clusters,
        layout: &'a KeyLayout,
        placement: &'a Placement,
        radius: f32,
        level: u32,
    ) -> Result<Walk<'a>> {
        if level < LEVELS && clusters.nodes.is_none() {
            return Err(no_nodes(level));
        }
        Ok(Walk {
            clusters,
            layout,
            placement,
            reach2: placement.reach2(radius),
            facets: facets(layout.bits[3]),
            level,
            lookup: clusters.lookup(),
        })
    }

    /// Clusters, or nodes of the level.
    pub fn targets(&self) -> usize {
        match self.level {
            LEVELS => self.clusters.cluster_keys.len(),
            level => self.layout.level_nodes(level) as usize,
        }
    }

    /// The target of a sample's cluster.
    pub fn target_of(&self, identifier: u32) -> usize {
        target_of(self.clusters, self.level, identifier)
    }

    /// The box of a target.
    pub fn bounds(&self, target: u32) -> Bounds {
        match &self.clusters.nodes {
            Some(nodes) if self.level < LEVELS => nodes.boxes[(self.layout.level_offset(self.level) + target) as usize],
            _ => self.clusters.boxes[target as usize],
        }
    }

    /// A point along the axes of the boxes.
    pub fn placed(&self, point: Vec3) -> Vec3A {
        self.placement.placed(point.into())
    }

    /// Calls `visit` with every target that a photon touches.
    pub fn photon(&self, photons: &Photons, photon: usize, visit: impl FnMut(u32)) -> Tests {
        let point = self.placed(photons.positions[photon].truncate());
        let direction = photons.directions[photon].truncate().into();
        match &self.clusters.nodes {
            Some(nodes) => self.descend(nodes, point, direction, visit),
            None => self.all(point, direction, visit),
        }
    }

    fn touches(&self, point: Vec3A, bounds: &Bounds) -> bool {
        square_distance(point, bounds) < self.reach2
    }

    /// True if all normals of a key's cell face away from where a photon came from.
    fn faces_away(&self, key: u32, direction: Vec3A) -> bool {
        let facet = self.facets.get((key & ((1 << self.layout.bits[3]) - 1)) as usize);
        facet.is_some_and(|&facet| Vec3A::from_vec4(facet).dot(direction) >= facet.w)
    }

    fn descend(&self, nodes: &Nodes, point: Vec3A, direction: Vec3A, mut visit: impl FnMut(u32)) -> Tests {
        let mut tests = Tests::default();
        let mut masks = [0; LEVELS as usize];
        let (mut level, mut key) = (0, 0);
        masks[0] = nodes.masks[0];
        loop {
            let mask = masks[level as usize];
            if mask == 0 {
                if level == 0 {
                    return tests;
                }
                level -= 1;
                key >>= 5;
                continue;
            }
            masks[level as usize] = mask & (mask - 1);
            let child = key << 5 | mask.trailing_zeros();
            tests.boxes += 1;
            if level == LEVELS - 1 {
                let Some(identifier) = self.lookup.identifier_of(child) else { continue };
                if self.touches(point, &self.clusters.boxes[identifier as usize]) {
                    if self.faces_away(child, direction) {
                        tests.cones += 1;
                    } else {
                        visit(identifier);
                    }
                }
                continue;
            }
            let node = (self.layout.level_offset(level + 1) + child) as usize;
            if self.touches(point, &nodes.boxes[node]) {
                if level + 1 == self.level {
                    visit(child);
                } else {
                    (level, key) = (level + 1, child);
                    masks[level as usize] = nodes.masks[node];
                }
            }
        }
    }

    fn all(&self, point: Vec3A, direction: Vec3A, mut visit: impl FnMut(u32)) -> Tests {
        let mut tests = Tests::default();
        for (identifier, (bounds, &key)) in self.clusters.boxes.iter().zip(&self.clusters.cluster_keys).enumerate() {
            tests.boxes += 1;
            if self.touches(point, bounds) {
                if self.faces_away(key, direction) {
                    tests.cones += 1;
                } else {
                    visit(identifier as u32);
                }
            }
        }
        tests
    }
}

/// The cluster of an identifier, or the node of a level above it.
pub fn target_of(clusters: &Clusters, level: u32, identifier: u32) -> usize {
    match level {
        LEVELS => identifier as usize,
        level => (clusters.cluster_keys[identifier as usize] >> (25 - 5 * level)) as usize,
    }
}

/// The refusal of buckets at nodes that do not exist.
pub fn no_nodes(level: u32) -> Error {
    Error::unsupported(format!(
        "buckets of nodes (level={level}) without a hierarchy (give --hierarchy masks, or level=5)"
    ))
}

/// The centre of a box.
pub fn centre(bounds: &Bounds) -> Vec3A {
    Aabb { min: bounds.min, max: bounds.max }.center().into()
}
