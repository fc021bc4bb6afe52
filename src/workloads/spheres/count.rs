//! What a frame's work consists of, exactly.

use std::ops::AddAssign;

/// Sums over the pixels of a frame.
///
/// A path is live until its first miss. `rays`, `hits` and tests of live rays are the same for every renderer and every
/// switch; the other counters say what a renderer does in addition.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Live rays of each trip; as long as `hits`.
    pub rays: Vec<u64>,
    /// Live rays of each trip that hit.
    pub hits: Vec<u64>,
    /// Searches of a single lane or pixel, those for dead paths and for lanes beyond the end of a row among them.
    pub searches: u64,
    /// Searches of whole vectors; 0 for scalar renderers.
    pub vectors: u64,
    /// Paths (SIMD: vectors of paths) that ended at a miss before their last trip, by the switch.
    pub exits_on_miss: u64,
    /// Spheres of a vector's search for which nothing was stored, by the switch.
    pub skips_no_hit: u64,
    /// Spheres of a vector's search without root and division, by the switch.
    pub skips_no_discriminant: u64,
}

impl Counts {
    /// No work, for so many trips.
    pub fn new(trips: usize) -> Counts {
        Counts { rays: vec![0; trips], hits: vec![0; trips], ..Counts::default() }
    }

    /// Adds a path of `hits` hits with at most `trips` rays: it is live in one ray more, unless the trips are used up.
    pub fn add_path(&mut self, hits: usize) {
        for trip in 0..self.rays.len() {
            self.rays[trip] += u64::from(trip <= hits);
            self.hits[trip] += u64::from(trip < hits);
        }
    }
}

impl AddAssign<&Counts> for Counts {
    fn add_assign(&mut self, other: &Counts) {
        let trips = self.rays.len().max(other.rays.len());
        self.rays.resize(trips, 0);
        self.hits.resize(trips, 0);
        self.rays.iter_mut().zip(&other.rays).for_each(|(sum, n)| *sum += n);
        self.hits.iter_mut().zip(&other.hits).for_each(|(sum, n)| *sum += n);
        self.searches += other.searches;
        self.vectors += other.vectors;
        self.exits_on_miss += other.exits_on_miss;
        self.skips_no_hit += other.skips_no_hit;
        self.skips_no_discriminant += other.skips_no_discriminant;
    }
}
