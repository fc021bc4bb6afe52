//! A judgement as text, Markdown and JSON.

use super::{Finding, Judgement};
use serde_json::{Value, json};

/// Findings that text and Markdown list.
const LISTED: usize = 100;

fn headline(judgement: &Judgement) -> String {
    let colour = if judgement.is_green() { "green" } else { "red" };
    let Judgement { failures, rows, rows_compared, exact_compared, .. } = judgement;
    format!(
        "gate: {colour}: {} differences; {exact_compared} exact quantities, {rows_compared} of {rows} rows compared",
        failures.len()
    )
}

/// The difference of two whole numbers, in percent; empty for anything else.
fn change(finding: &Finding) -> String {
    match (finding.old.parse::<u64>(), finding.new.parse::<u64>()) {
        (Ok(old), Ok(new)) if old > 0 => {
            let difference = new as i128 - i128::from(old);
            format!("{difference:+}, {:+.3} %", 100.0 * difference as f64 / old as f64)
        }
        _ => String::new(),
    }
}

/// For a terminal: one line per difference.
pub fn text(judgement: &Judgement) -> String {
    let mut text = headline(judgement) + "\n";
    let line = |word: &str, finding: &Finding| {
        let Finding { row, quantity, old, new } = finding;
        let change = change(finding);
        let change = if change.is_empty() { change } else { format!(" ({change})") };
        format!("{word}: {row}: {quantity}: {old} -> {new}{change}\n")
    };
    for finding in judgement.failures.iter().take(LISTED) {
        text += &line("red", finding);
    }
    if judgement.failures.len() > LISTED {
        text += &format!("red: {} more; JSON has all\n", judgement.failures.len() - LISTED);
    }
    for finding in judgement.ambiguous.iter().take(LISTED) {
        text += &line("ambiguous", finding);
    }
    for announcement in judgement.announcements.iter().take(LISTED) {
        text += &format!("note: {announcement}\n");
    }
    text
}

/// For a comment or a job's summary.
pub fn markdown(judgement: &Judgement) -> String {
    let escape = |text: &str| text.replace('|', "\\|").replace('_', "\\_").replace('*', "\\*");
    let mut text = format!("**{}**\n", headline(judgement));
    let listed = judgement.failures.iter().map(|finding| ("red", finding));
    let listed: Vec<_> = listed.chain(judgement.ambiguous.iter().map(|finding| ("ambiguous", finding))).collect();
    if !listed.is_empty() {
        text += "\n| verdict | row | quantity | old | new | change |\n|:---|:---|:---|---:|---:|---:|\n";
        for (word, finding) in listed.iter().take(LISTED) {
            let [row, quantity, old, new] =
                [&finding.row, &finding.quantity, &finding.old, &finding.new].map(|text| escape(text));
            text += &format!("| {word} | {row} | {quantity} | {old} | {new} | {} |\n", change(finding));
        }
        if listed.len() > LISTED {
            text += &format!("\n{} more differences are in the JSON.\n", listed.len() - LISTED);
        }
    }
    for announcement in judgement.announcements.iter().take(LISTED) {
        text += &format!("\n- {}", escape(announcement));
    }
    if !judgement.announcements.is_empty() {
        text.push('\n');
    }
    text
}

/// For programs.
pub fn json(judgement: &Judgement) -> Value {
    let findings = |findings: &[Finding]| -> Vec<Value> {
        let object = |f: &Finding| json!({"row": f.row, "quantity": f.quantity, "old": f.old, "new": f.new});
        findings.iter().map(object).collect()
    };
    json!({
        "schema": "rtbench-gate/1",
        "green": judgement.is_green(),
        "failures": findings(&judgement.failures),
        "ambiguous": findings(&judgement.ambiguous),
        "announcements": judgement.announcements,
        "rows": judgement.rows,
        "rows_compared": judgement.rows_compared,
        "exact_compared": judgement.exact_compared,
        "hashes_left_out": judgement.hashes_left_out,
    })
}
