//! Findings as text, Markdown and JSON.

use super::{Finding, Outcome, Verdict};
use crate::thesis::format::wrap;

/// A form of findings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Form {
    /// For a terminal
    #[default]
    Text,
    /// GitHub's
    Markdown,
    /// Everything, for other programs
    Json,
}

/// All findings under a line that says whose numbers they judge.
pub fn write(findings: &[Finding], whose: &str, form: Form) -> String {
    match form {
        Form::Text => text(findings, whose),
        Form::Markdown => markdown(findings, whose),
        // Findings are plain data: turning them into JSON cannot fail
        Form::Json => serde_json::to_string_pretty(findings).unwrap_or_default() + "\n",
    }
}

/// The number of findings with each verdict, in words.
pub fn totals(findings: &[Finding]) -> String {
    let all = [Verdict::Holds, Verdict::DoesNotHold, Verdict::Undecided, Verdict::NotMeasured];
    let count = |verdict| findings.iter().filter(|f| f.verdict == verdict).count();
    let words = all.into_iter().filter(|v| count(*v) > 0).map(|v| format!("{}: {}", v.in_words(), count(v)));
    words.collect::<Vec<_>>().join(", ")
}

/// Most failed measurements that are spelt out.
const MAX_FAILED: usize = 4;

/// Columns left of a claim's statement.
const STATEMENT: &str = "                       ";

fn text(findings: &[Finding], whose: &str) -> String {
    let mut text = wrap(&format!("Claims of the thesis, judged by {whose} ({}).", totals(findings)), "");
    for finding in findings {
        let verdict = match finding.verdict {
            Verdict::NotMeasured => "[ NOT MEASURED ]".to_owned(),
            verdict => verdict.in_words().to_uppercase(),
        };
        // The statement stands right of the verdict, on as many lines as it takes
        let statement = wrap(finding.statement, STATEMENT);
        text += &format!("\n{:<4} {verdict:<17} {}", finding.claim, statement.trim_start());
        for line in details(finding) {
            text += &wrap(&line, "       ");
        }
        for case in &finding.cases {
            text += &wrap(&format!("{} {}: {}", sign(case.outcome), case.name(), case.numbers), "         ");
        }
    }
    text + "\nBefore a case: + agrees, - contradicts, ? undecided: the difference is within noise and margin.\n"
}

/// A case's outcome in one character.
pub fn sign(outcome: Outcome) -> char {
    match outcome {
        Outcome::Agrees => '+',
        Outcome::Contradicts => '-',
        Outcome::Undecided => '?',
    }
}

/// What a verdict rests on, in words that do not let times of a processor pass for those of a GPU.
fn by(finding: &Finding) -> String {
    let words = finding.basis.in_words();
    if finding.without_gpu { format!("{words} without a GPU") } else { words.to_owned() }
}

/// What a finding rests on, and what to beware of.
pub fn details(finding: &Finding) -> Vec<String> {
    let mut lines = Vec::new();
    if finding.verdict == Verdict::NotMeasured {
        let device = if finding.device.is_empty() { String::new() } else { format!(" on {}", finding.device) };
        lines.push(format!("Nothing was measured that could decide it{device}. It needs {}.", finding.needs));
    } else {
        let device = if finding.device.is_empty() { String::new() } else { format!(" on {}", finding.device) };
        let noise = if finding.undecided > 0 { format!(", {} undecided", finding.undecided) } else { String::new() };
        let scenes = if finding.scenes == 1 { "1 scene".into() } else { format!("{} scenes", finding.scenes) };
        lines.push(format!(
            "By {}{device}: {} of {} cases agree{noise}; rests on {scenes}.",
            by(finding),
            finding.agreeing,
            finding.agreeing + finding.contradicting,
        ));
        if !finding.exceptions.is_empty() {
            lines.push(format!("Except, as in the thesis's own numbers: {}.", finding.exceptions.join(", ")));
        }
    }
    lines.extend(finding.left_out.iter().map(|words| format!("{words}.")));
    if !finding.failed.is_empty() {
        let shown = &finding.failed[..finding.failed.len().min(MAX_FAILED)];
        let more = finding.failed.len() - shown.len();
        let more = if more > 0 { format!("; and {more} more") } else { String::new() };
        lines.push(format!("Failed, so that the claim rests on less: {}{more}.", shown.join("; ")));
    }
    if let Some((agreeing, decided)) = finding.thesis {
        lines.push(format!("The thesis's own numbers: {agreeing} of {decided} cases agree."));
    }
    if finding.verdict != Verdict::NotMeasured {
        lines.extend(finding.warnings.iter().cloned());
    }
    lines
}

/// One line per finding, as Markdown.
pub fn summary(findings: &[Finding], whose: &str) -> String {
    let mut text = format!("Claims of the thesis, judged by {whose} ({}).\n\n", totals(findings));
    text += "| claim | verdict | by | scenes | cases | thesis's own | statement |\n|:--|:--|:--|--:|--:|--:|:--|\n";
    for finding in findings {
        let measured = finding.verdict != Verdict::NotMeasured;
        let verdict = if measured { format!("**{}**", finding.verdict.in_words()) } else { "*not measured*".into() };
        let of = |agreeing: usize, decided: usize| format!("{agreeing} of {decided}");
        let dash = || "–".to_owned();
        let cases = of(finding.agreeing, finding.agreeing + finding.contradicting);
        text += &format!(
            "| {} | {verdict} | {} | {} | {} | {} | {} |\n",
            finding.claim,
            if measured { by(finding) } else { dash() },
            if measured { finding.scenes.to_string() } else { dash() },
            if measured { cases } else { dash() },
            finding.thesis.map_or_else(dash, |(agreeing, decided)| of(agreeing, decided)),
            escape(&[finding.statement, finding.device.as_str()].join(if finding.device.is_empty() {
                ""
            } else {
                " — "
            })),
        );
    }
    text
}

fn markdown(findings: &[Finding], whose: &str) -> String {
    let mut text = summary(findings, whose);
    for finding in findings {
        text += &format!("\n**{}: {}** ({})\n\n", finding.claim, escape(finding.statement), finding.verdict.in_words());
        let cases = finding.cases.iter().map(|c| format!("`{}` {}: {}", sign(c.outcome), c.name(), c.numbers));
        for line in details(finding).into_iter().chain(cases) {
            text += &format!("* {}\n", escape(&line));
        }
    }
    text
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('|', "\\|").replace('^', "\\^")
}
