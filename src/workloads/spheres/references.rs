//! Pictures by the reference, which every renderer's are compared with, and checks of the reference itself.

use super::options::Algorithm;
use super::render::reference::Reference;
use super::render::{exact, reference};
use super::scene::{PackedSphere, Scene};
use super::verify;
use super::view::View;
use crate::record::row::Check;
use crate::workloads::size::Size;
use std::collections::HashMap;
use std::rc::Rc;

/// The small image on which two frames of every case are compared: rows that no vector divides, columns that no
/// work-group does.
pub const SMALL: Size = Size { width: 67, height: 45 };

/// Pictures that are kept: two algorithms, first and last frame of one size.
const KEPT: usize = 4;

/// Most rays along a path where the reference is compared with the model in double precision: every reflection on a
/// sphere enlarges a rounding error several times, so that long paths say nothing.
const EXACT_TRIPS: u32 = 2;

/// A frame of a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Shot {
    /// Image size.
    pub size: Size,
    /// Most rays along a path.
    pub trips: u32,
    /// Which view of the orbit.
    pub frame: usize,
    /// Views of the orbit.
    pub frames: usize,
}

impl Shot {
    /// The view.
    pub fn view(&self, scene: &Scene) -> View {
        View::of(scene, self.size, self.trips, self.frame, self.frames)
    }
}

/// The references of a scene.
#[derive(Default)]
pub struct References {
    pictures: HashMap<(Algorithm, Shot), Rc<Reference>>,
    /// Checks of the reference itself, by the number of trips.
    checks: HashMap<u32, Vec<Check>>,
}

impl References {
    /// The reference of a shot.
    pub fn of(&mut self, scene: &Scene, spheres: &[PackedSphere], algorithm: Algorithm, shot: Shot) -> Rc<Reference> {
        let key = (algorithm, shot);
        if let Some(known) = self.pictures.get(&key) {
            return known.clone();
        }
        if shot.size != SMALL && self.pictures.keys().filter(|(_, known)| known.size != SMALL).count() >= KEPT {
            self.pictures.retain(|(_, known), _| known.size == SMALL);
        }
        let made = Rc::new(reference::render(spheres, &shot.view(scene), algorithm));
        self.pictures.insert(key, made.clone());
        made
    }

    /// Compares the reference with a model in double precision, and its two algorithms with each other, on the small
    /// image.
    pub fn checks(&mut self, scene: &Scene, spheres: &[PackedSphere], trips: u32) -> Vec<Check> {
        if let Some(known) = self.checks.get(&trips) {
            return known.clone();
        }
        let shot = |trips: u32| Shot { size: SMALL, trips, frame: 0, frames: 1 };
        let short = shot(trips.min(EXACT_TRIPS));
        let one = self.of(scene, spheres, Algorithm::OnePass, short);
        let exact = exact::render(spheres, &short.view(scene));
        let mut checks = vec![verify::exact(&one.image, &exact, short.trips)];
        let [one, two] =
            [Algorithm::OnePass, Algorithm::TwoPass].map(|algorithm| self.of(scene, spheres, algorithm, shot(trips)));
        checks.push(verify::algorithms(&one.image, &two.image));
        self.checks.insert(trips, checks.clone());
        checks
    }
}
