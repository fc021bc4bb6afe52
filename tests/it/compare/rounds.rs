//! Interleaved rounds: verdicts, the null band, and how often both are wrong.

use crate::support::random;
use rtbench::compare::rounds::{CellTimes, RoundsJudgement, judge, rounds_needed};
use rtbench::compare::runs::Verdict;

/// Rounds of a side `factor` times as slow, on a machine with this relative noise that both sides of a round share in
/// part.
fn rounds(random: &mut impl FnMut() -> f32, count: usize, factor: f64, noise: f64) -> CellTimes {
    let mut cell = CellTimes { label: "case".into(), ..CellTimes::default() };
    for _ in 0..count {
        // The machine's state, which a round's sides have in common
        let state = 2.0 + f64::from(random());
        let mut time = |factor: f64| state * factor * (1.0 + 0.5 * noise * f64::from(random()));
        cell.a.push(time(1.0));
        cell.b.push(time(factor));
        cell.null.push(time(1.0));
    }
    cell
}

fn verdict(judgement: &RoundsJudgement) -> &Verdict {
    &judgement.cells[0].verdict
}

#[test]
fn a_real_difference_is_found_and_none_is_invented() {
    let mut random = random(42);
    let (mut found, mut invented, mut held) = (0, 0, 0);
    let trials = 600;
    for _ in 0..trials {
        let slower = judge(&[rounds(&mut random, 12, 1.05, 0.04)], 1.0).unwrap();
        found += usize::from(*verdict(&slower) == Verdict::Slower);
        held += usize::from((slower.cells[0].ratio.low..=slower.cells[0].ratio.high).contains(&1.05));
        let same = judge(&[rounds(&mut random, 12, 1.0, 0.04)], 1.0).unwrap();
        invented += usize::from(matches!(verdict(&same), Verdict::Slower | Verdict::Faster));
    }
    // Five percent at four percent of noise, twelve rounds: nearly always
    assert!(found > trials * 9 / 10, "{found} of {trials}");
    // An interval of 12 rounds holds with 96.1 %; four standard deviations of 600 trials are 3.2 %
    assert!(held > trials * 92 / 100, "{held} of {trials}");
    // Interval, margin and null band together: far less than one in twenty
    assert!(invented <= trials / 50, "{invented} of {trials}");
}

#[test]
fn faster_is_faster() {
    let judgement = judge(&[rounds(&mut random(1), 10, 0.5, 0.02)], 1.0).unwrap();
    assert_eq!(*verdict(&judgement), Verdict::Faster);
    assert!((judgement.mean - 0.5).abs() < 0.02, "{}", judgement.mean);
    assert!((judgement.null_mean - 1.0).abs() < 0.02, "{}", judgement.null_mean);
    let judgement = judge(&[rounds(&mut random(1), 10, 1.0, 0.001)], 1.0).unwrap();
    assert_eq!(*verdict(&judgement), Verdict::Same);
}

#[test]
fn a_side_that_differs_from_itself_makes_everything_ambiguous() {
    let mut biased = rounds(&mut random(2), 12, 0.5, 0.001);
    biased.null.iter_mut().for_each(|time| *time *= 1.1);
    let clean = rounds(&mut random(3), 12, 0.5, 0.001);
    let judgement = judge(&[biased, clean], 1.0).unwrap();
    assert!(judgement.is_biased);
    assert!(judgement.cells.iter().all(|cell| cell.verdict == Verdict::Ambiguous));
}

#[test]
fn an_effect_within_the_null_band_is_ambiguous() {
    let mut cell = rounds(&mut random(4), 12, 1.03, 0.001);
    // A differs from itself by up to 5 %, in both directions
    let noisy = |(round, time): (usize, &mut f64)| *time *= if round % 2 == 0 { 1.05 } else { 0.95 };
    cell.null.iter_mut().enumerate().for_each(noisy);
    let judgement = judge(&[cell], 1.0).unwrap();
    assert!(!judgement.is_biased);
    assert_eq!(*verdict(&judgement), Verdict::Ambiguous);
}

#[test]
fn more_cases_need_more_rounds() {
    assert_eq!([1, 25, 26, 100].map(rounds_needed), [10, 10, 11, 12]);
    let cells: Vec<CellTimes> = (0..26).map(|seed| rounds(&mut random(seed), 10, 2.0, 0.001)).collect();
    let judgement = judge(&cells, 1.0).unwrap();
    assert!(!judgement.has_intervals);
    assert!(judgement.cells.iter().all(|cell| cell.verdict == Verdict::Ambiguous));
    assert_eq!(judge(&[], 1.0), None);
}
