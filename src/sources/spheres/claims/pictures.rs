//! Half precision: pictures, and the speed where a device has it.

use super::{Asked, case};
use crate::compare::judge::{Uncertain, less, less_by};
use crate::sources::claims::Case;
use crate::sources::spheres::data::{Data, HalfPicture, Measurement, Place};
use crate::sources::spheres::setting::{Renderer, Setting};

/// Ratio of peak signal to noise in decibels below which a picture counts as unusable.
pub const UNUSABLE_DB: f64 = 30.0;

/// An error within so much of the one at [`UNUSABLE_DB`] decides nothing.
const PICTURE_MARGIN: f64 = 0.1;

/// So many times as fast is taken for twice, so that noise and margin do not decide it.
pub const TWICE: f64 = 1.6;

/// Ratio of peak signal to noise in decibels of an error whose peak is 1; `None` for equal pictures.
pub fn psnr(rmse: f64) -> Option<f64> {
    (rmse > 0.0).then(|| -20.0 * rmse.log10())
}

/// The pictures of a place.
pub fn half_pictures(data: &Data, place: Place) -> Vec<&HalfPicture> {
    data.halves.iter().filter(|half| place.has(half.machine, half.device)).collect()
}

/// The row in single precision that is otherwise the same.
pub fn single_of<'a>(data: &'a Data, half: &HalfPicture) -> Option<&'a Measurement> {
    let single = Setting { half: false, ..half.setting.clone() };
    same(data, half, &single)
}

fn same<'a>(data: &'a Data, half: &HalfPicture, setting: &Setting) -> Option<&'a Measurement> {
    data.measurements.iter().find(|m| {
        (m.machine, m.device, m.terms) == (half.machine, half.device, half.terms)
            && m.scene == half.scene
            && m.setting == *setting
    })
}

fn of_paper<'a>(asked: &Asked<'a>) -> Vec<&'a HalfPicture> {
    let mut halves = half_pictures(asked.view.data, asked.view.place);
    halves.retain(|half| half.scene.is_of_paper());
    halves
}

/// True if a software driver converts to and from half precision, which tells nothing about its speed.
fn is_converted(data: &Data, half: &HalfPicture) -> bool {
    let is_software = data.devices.get(half.device).is_some_and(|device| device.is_software());
    half.setting.renderer == Renderer::Gpu && is_software
}

/// Says that rows of a software driver are not judged, where there are such rows.
pub fn converted(asked: &Asked) -> Vec<String> {
    let data = asked.view.data;
    let halves = of_paper(asked);
    let rows = halves.iter().filter(|half| is_converted(data, half) && same(data, half, &half.setting).is_some());
    let names: Vec<&str> =
        rows.filter_map(|half| data.devices.get(half.device)).map(|device| device.label.as_str()).collect();
    let said = |label: &&str| {
        format!(
            "{} rows of {label} are not judged: it computes on the CPU, by conversions to half precision",
            names.len()
        )
    };
    names.first().map(said).into_iter().collect()
}

/// Claim 10a: half precision is twice as fast.
pub fn speed(asked: &Asked) -> Vec<Case> {
    let of = |half: &&HalfPicture| {
        let data = asked.view.data;
        let (fast, single) = (same(data, half, &half.setting)?, single_of(data, half)?);
        let numbers = format!("{:.2} times as fast", single.mean_ms / fast.mean_ms);
        Some(case(&half.scene, half.setting.to_string(), less_by(fast.time(), single.time(), TWICE), numbers))
    };
    let data = asked.view.data;
    of_paper(asked).iter().filter(|half| !is_converted(data, half)).filter_map(of).collect()
}

/// Claim 10b: its picture is unusable.
pub fn spoilt(asked: &Asked) -> Vec<Case> {
    let limit = 10f64.powf(-UNUSABLE_DB / 20.0);
    let uncertain = |value| Uncertain { value, noise: 0.0, margin: PICTURE_MARGIN };
    let of = |half: &&HalfPicture| {
        // An error of nothing at all has no quotient
        let outcome = less(uncertain(limit), uncertain(half.rmse.max(f64::MIN_POSITIVE)));
        let decibels = psnr(half.rmse).map_or("equal pictures".to_owned(), |db| format!("{db:.1} dB"));
        let numbers = format!("RMSE {:.4} ({decibels}), unusable above {limit:.4}", half.rmse);
        case(&half.scene, half.setting.to_string(), outcome, numbers)
    };
    of_paper(asked).iter().map(of).collect()
}
