//! Cases of claim 12: the register limit as printed, substitute options as measured.

use super::cases::ms;
use super::{Case, case as new_case, frame_time};
use crate::compare::judge::{Outcome, TIME_MARGIN_PCT};
use crate::sources::thesis::data::{Data, Frame, RegisterLimit};
use crate::sources::thesis::scenes::SceneKey;
use crate::sources::thesis::tables::occupancy::{Substitute, substitutes};

/// "About 20 %": faster by at least and at most so many percent.
pub const ABOUT_20_PCT: (f64, f64) = (10.0, 30.0);

/// Threads of a work-group by default: 8x8.
const DEFAULT_GROUP: u32 = 64;

/// Claim 12. A case has a direction: the choice that lets more threads fit on a processor, against the other one.
pub fn occupancy(data: &Data, device: usize) -> Vec<Case> {
    if data.published {
        let rows = data.register_limit.iter().filter(|row| row.device == device);
        let case = |row: &RegisterLimit| {
            let faster = f64::from(row.speedup?);
            let numbers = format!("{} registers: {}", row.registers, in_words(faster));
            Some(new_case(&SceneKey::Thesis(row.scene), row.structure.clone(), about_20(faster, 0.0), numbers))
        };
        return rows.filter_map(case).collect();
    }
    let pairs = substitutes(data, device);
    let case = |pair: &Substitute| {
        let more_fit = lets_more_fit(&pair.option)?;
        let (default, changed) = ("default", pair.option.as_str());
        let ((more, more_name), (fewer, fewer_name)) = if more_fit {
            ((pair.changed, changed), (pair.base, default))
        } else {
            ((pair.base, default), (pair.changed, changed))
        };
        Some(measured(data, (more, more_name), (fewer, fewer_name), changed))
    };
    pairs.iter().filter_map(case).collect()
}

fn measured(data: &Data, (more, more_name): (&Frame, &str), (fewer, fewer_name): (&Frame, &str), option: &str) -> Case {
    let (a, b) = (frame_time(data, more), frame_time(data, fewer));
    let faster = 100.0 * (1.0 - a.value / b.value);
    let numbers = format!(
        "{more_name} {}, {fewer_name} {}: with more threads fitting {} at {side}x{side}",
        ms(a.value),
        ms(b.value),
        in_words(faster),
        side = more.width
    );
    let outcome = about_20(faster, 100.0 * (a.noise + b.noise));
    new_case(&more.scene, format!("{} {option}", more.structure), outcome, numbers)
}

/// Does an option let more threads fit on a processor than the default? `None` where it makes no difference.
fn lets_more_fit(option: &str) -> Option<bool> {
    match option.split_once('=')? {
        // The stack takes no work-group memory
        ("memory", "private") => Some(true),
        ("group", shape) => {
            let (width, height) = shape.split_once('x')?;
            let threads = width.parse::<u32>().ok()?.checked_mul(height.parse().ok()?)?;
            (threads != DEFAULT_GROUP).then_some(threads < DEFAULT_GROUP)
        }
        _ => None,
    }
}

/// Does a gain in percent agree with [`ABOUT_20_PCT`]? It contradicts if it is outside the band by more than the margin
/// and the noise.
fn about_20(faster: f64, noise: f64) -> Outcome {
    let (low, high) = ABOUT_20_PCT;
    if faster < low - TIME_MARGIN_PCT - noise || faster > high + TIME_MARGIN_PCT + noise {
        Outcome::Contradicts
    } else if (low..=high).contains(&faster) && faster >= noise {
        Outcome::Agrees
    } else {
        Outcome::Undecided
    }
}

fn in_words(faster: f64) -> String {
    if faster < 0.0 { format!("{:.0} % slower", -faster) } else { format!("{faster:.0} % faster") }
}
