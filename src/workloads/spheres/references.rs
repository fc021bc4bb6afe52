//! Pictures by the reference, which every renderer's are compared with, and checks of the reference itself.

use super::count::Counts;
use super::options::Algorithm;
use super::render::reference::Reference;
use super::render::{exact, reference};
use super::scene::{PackedSphere, Scene};
use super::verify;
use super::view::View;
use crate::device::Interrupted;
use crate::error::{Error, Result};
use crate::record::row::Check;
use crate::workloads::size::Size;
use rayon::prelude::*;
use std::collections::HashMap;
use std::ops::Range;
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

/// Rows that are rendered before an interruption is asked for.
const BAND: u32 = 16;

/// Renders rows in parallel, band by band, so that an interruption is noticed.
///
/// # Errors
/// [`Error::Interrupted`].
pub fn in_bands<T: Send>(
    height: u32,
    interrupted: Interrupted,
    row: impl Fn(Range<u32>) -> T + Sync,
) -> Result<Vec<T>> {
    let mut rows = Vec::with_capacity(height as usize);
    for first in (0..height).step_by(BAND as usize) {
        if interrupted() {
            return Err(Error::Interrupted);
        }
        let band = first..height.min(first + BAND);
        rows.par_extend(band.into_par_iter().map(|y| row(y..y + 1)));
    }
    Ok(rows)
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
    ///
    /// # Errors
    /// [`Error::Interrupted`].
    pub fn of(
        &mut self,
        scene: &Scene,
        spheres: &[PackedSphere],
        (algorithm, shot): (Algorithm, Shot),
        interrupted: Interrupted,
    ) -> Result<Rc<Reference>> {
        let key = (algorithm, shot);
        if let Some(known) = self.pictures.get(&key) {
            return Ok(known.clone());
        }
        if shot.size != SMALL && self.pictures.keys().filter(|(_, known)| known.size != SMALL).count() >= KEPT {
            self.pictures.retain(|(_, known), _| known.size == SMALL);
        }
        let view = shot.view(scene);
        let rows = in_bands(view.height, interrupted, |rows| reference::rows(spheres, &view, algorithm, rows))?;
        let mut whole =
            Reference { image: Vec::new(), hits: Vec::new(), counts: Counts::new(view.trips as usize), hits_again: 0 };
        for row in rows {
            whole.image.extend(row.image);
            whole.hits.extend(row.hits);
            whole.counts += &row.counts;
            whole.hits_again += row.hits_again;
        }
        let made = Rc::new(whole);
        self.pictures.insert(key, made.clone());
        Ok(made)
    }

    /// Compares the reference with a model in double precision, and its two algorithms with each other, on the small
    /// image.
    ///
    /// # Errors
    /// [`Error::Interrupted`].
    pub fn checks(
        &mut self,
        scene: &Scene,
        spheres: &[PackedSphere],
        trips: u32,
        interrupted: Interrupted,
    ) -> Result<Vec<Check>> {
        if let Some(known) = self.checks.get(&trips) {
            return Ok(known.clone());
        }
        let shot = |trips: u32| Shot { size: SMALL, trips, frame: 0, frames: 1 };
        let short = shot(trips.min(EXACT_TRIPS));
        let one = self.of(scene, spheres, (Algorithm::OnePass, short), interrupted)?;
        let exact = exact::render(spheres, &short.view(scene));
        let mut checks = vec![verify::exact(&one.image, &exact, short.trips, spheres.len())];
        let one = self.of(scene, spheres, (Algorithm::OnePass, shot(trips)), interrupted)?;
        let two = self.of(scene, spheres, (Algorithm::TwoPass, shot(trips)), interrupted)?;
        checks.push(verify::algorithms(&one.image, &two.image, trips));
        self.checks.insert(trips, checks.clone());
        Ok(checks)
    }
}
