//! Two sides that were measured interleaved, round by round: `rtbench ab`. Every round also measures the first side a
//! second time; what differs between its two times is the false-alarm band.

use super::runs::Verdict;
use crate::record::statistics::{Estimate, geometric_mean, median, paired_ratio_at, sign_test_rank_at};
use crate::report::{Cell, Column, Form, Origin, Row, Table};
use serde::Serialize;
use serde_json::{Value, json};

/// Fewest rounds.
pub const LEAST_ROUNDS: usize = 10;

/// Ratios within this many percent of 1 count as the same unless the user says otherwise.
pub const MARGIN_PCT: f64 = 1.0;

/// Error probability of all intervals together.
const ALPHA: f64 = 0.05;

/// The times of one case on both sides, one per round, in milliseconds.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct CellTimes {
    /// Which case.
    pub label: String,
    /// The first side.
    pub a: Vec<f64>,
    /// The second side.
    pub b: Vec<f64>,
    /// The first side again.
    pub null: Vec<f64>,
}

/// What the rounds of a case say.
#[derive(Clone, Debug, PartialEq)]
pub struct CellJudgement {
    /// Which case.
    pub label: String,
    /// Medians of both sides in milliseconds.
    pub medians_ms: [f64; 2],
    /// Second by first side.
    pub ratio: Estimate,
    /// First side by first side.
    pub null: Estimate,
    /// Rounds in which both sides took the same time, to the clock's resolution.
    pub tied: usize,
    /// What it says about the second side.
    pub verdict: Verdict,
}

/// What all rounds say.
#[derive(Clone, Debug, PartialEq)]
pub struct RoundsJudgement {
    /// The cases.
    pub cells: Vec<CellJudgement>,
    /// Geometric mean of their ratios.
    pub mean: f64,
    /// Geometric mean of their null ratios.
    pub null_mean: f64,
    /// Rounds of each case.
    pub rounds: usize,
    /// True if a case's null interval is on one side of 1: nothing of these rounds is trusted.
    pub is_biased: bool,
    /// False if there are too few rounds for an interval that holds for all cases together.
    pub has_intervals: bool,
}

/// The rounds that so many cases need at least for intervals that hold for all of them together (Bonferroni).
pub fn rounds_needed(cells: usize) -> usize {
    let alpha = ALPHA / cells.max(1) as f64;
    (LEAST_ROUNDS..).find(|&rounds| sign_test_rank_at(rounds, alpha) > 0).unwrap_or(LEAST_ROUNDS)
}

/// Judges the rounds of all cases; `None` without any.
pub fn judge(cells: &[CellTimes], margin_pct: f64) -> Option<RoundsJudgement> {
    let alpha = ALPHA / cells.len().max(1) as f64;
    let margin = margin_pct / 100.0;
    let mut judged = Vec::new();
    let mut has_intervals = true;
    for cell in cells {
        let (ratio, has_interval) = paired_ratio_at(&cell.b, &cell.a, alpha)?;
        let (null, _) = paired_ratio_at(&cell.null, &cell.a, alpha)?;
        has_intervals &= has_interval;
        let band = null.low.ln().abs().max(null.high.ln().abs());
        let mut verdict = Verdict::of_interval(ratio.value, ratio.low, ratio.high, margin);
        let is_beyond = ratio.value.ln().abs() > band;
        if !has_interval || (matches!(verdict, Verdict::Faster | Verdict::Slower) && !is_beyond) {
            verdict = Verdict::Ambiguous;
        }
        judged.push(CellJudgement {
            label: cell.label.clone(),
            medians_ms: [median(&cell.a)?, median(&cell.b)?],
            ratio,
            null,
            tied: cell.a.iter().zip(&cell.b).filter(|(a, b)| a == b).count(),
            verdict,
        });
    }
    let is_biased = has_intervals && judged.iter().any(|cell| cell.null.low > 1.0 || cell.null.high < 1.0);
    if is_biased {
        judged.iter_mut().for_each(|cell| cell.verdict = Verdict::Ambiguous);
    }
    let of = |pick: fn(&CellJudgement) -> f64| geometric_mean(&judged.iter().map(pick).collect::<Vec<_>>());
    Some(RoundsJudgement {
        mean: of(|cell| cell.ratio.value)?,
        null_mean: of(|cell| cell.null.value)?,
        rounds: cells.iter().map(|cell| cell.a.len()).min()?,
        cells: judged,
        is_biased,
        has_intervals,
    })
}

/// The judgement as a table.
pub fn table(judgement: &RoundsJudgement, [a, b]: [&str; 2]) -> Table {
    let interval = |estimate: &Estimate| Cell::Text(format!("{:.3}..{:.3}", estimate.low, estimate.high));
    let row = |cell: &CellJudgement| Row {
        keys: vec![cell.label.clone()],
        cells: vec![
            Cell::number(cell.medians_ms[0]),
            Cell::number(cell.medians_ms[1]),
            Cell::number(cell.ratio.value),
            interval(&cell.ratio),
            interval(&cell.null),
            Cell::Text(cell.verdict.describe()),
        ],
    };
    let ms = |name: &str| Column::of("median frame", name, "ms", Form::Time);
    let text = |name: &str| Column::new(name, "", Form::Whole);
    let mut notes = vec![
        format!("A: {a}"),
        format!("B: {b}"),
        format!(
            "{} rounds, interleaved; geometric mean of B/A {:.4}, of the null run A/A {:.4}",
            judgement.rounds, judgement.mean, judgement.null_mean,
        ),
        match judgement.has_intervals {
            true => format!("sign-test intervals that hold with 95 % for all {} cases together", judgement.cells.len()),
            false => "instead of intervals, the smallest and the largest ratio of the rounds".to_owned(),
        },
    ];
    if judgement.is_biased {
        notes.push("A differs from itself: every verdict is ambiguous; measure again on a quiet machine".into());
    }
    if !judgement.has_intervals {
        let needed = rounds_needed(judgement.cells.len());
        notes.push(format!("{needed} rounds are needed for verdicts about so many cases: give --rounds {needed}"));
    }
    let tied: usize = judgement.cells.iter().map(|cell| cell.tied).sum();
    if tied > 0 {
        notes.push(format!(
            "in {tied} rounds both sides took the same time: the clock is too coarse, or frames too short"
        ));
    }
    Table {
        origin: Origin { source: "ab", kind: "table", published: "" },
        id: "1".into(),
        title: "Interleaved rounds".into(),
        keys: vec!["case".into()],
        columns: vec![
            ms("A"),
            ms("B"),
            Column::new("B/A", "", Form::Fixed(3)),
            text("interval"),
            text("null A/A"),
            text("verdict"),
        ],
        rows: judgement.cells.iter().map(row).collect(),
        notes,
        with_published: false,
        is_published: false,
    }
}

/// The judgement as JSON.
pub fn json(judgement: &RoundsJudgement, [a, b]: [&str; 2]) -> Value {
    let estimate = |e: &Estimate| json!({"value": e.value, "low": e.low, "high": e.high});
    let cells = judgement.cells.iter().map(|cell| {
        json!({"case": cell.label, "median_ms": cell.medians_ms, "ratio": estimate(&cell.ratio),
            "null": estimate(&cell.null), "tied_rounds": cell.tied, "verdict": cell.verdict.word()})
    });
    json!({
        "schema": "rtbench-ab/1", "a": a, "b": b, "rounds": judgement.rounds, "measured": "interleaved",
        "cells": cells.collect::<Vec<_>>(), "geometric_mean": judgement.mean, "null_geometric_mean": judgement.null_mean,
        "is_biased": judgement.is_biased, "has_intervals": judgement.has_intervals,
    })
}
