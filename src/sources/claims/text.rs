//! Findings as text, Markdown and JSON.

use super::{Basis, Finding, apart, line, model_heading, sign, totals};
use crate::compare::judge::Verdict;
use crate::report::html::capital;
use crate::report::wrap::wrap;

/// A form of findings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Form {
    /// For a terminal
    #[default]
    Text,
    /// GitHub's Markdown
    Markdown,
    /// Everything, for other programs
    Json,
}

/// Writes the findings of each source. The first line of a source says what was judged by which numbers.
pub fn write(findings: &[Vec<Finding>], by: &str, form: Form) -> String {
    let join = |write: fn(&[Finding], &str) -> String| {
        findings.iter().map(|of_source| write(of_source, by)).collect::<Vec<_>>().join("\n")
    };
    match form {
        Form::Text => join(text),
        Form::Markdown => join(markdown),
        // Findings are plain data: turning them into JSON cannot fail
        Form::Json => serde_json::to_string_pretty(&findings.concat()).unwrap_or_default() + "\n",
    }
}

/// The number of failed measurements that are spelt out.
const MAX_FAILED: usize = 4;

/// Indent of a claim's statement.
const STATEMENT: &str = "                       ";

/// The first line: whose claims, judged by which numbers, and how many have each verdict.
fn heading(findings: &[&Finding], by: &str) -> String {
    let Some(Finding { document, .. }) = findings.first() else { return "No claims.".into() };
    format!("Claims of {document}, judged by {by} ({}).", totals(findings))
}

/// Measured findings with their heading, then those of the SIMT model, if there are any.
fn parts<'a>(findings: &'a [Finding], by: &str) -> Vec<(String, Vec<&'a Finding>)> {
    let [measured, modelled] = apart(findings);
    let mut parts = vec![(heading(&measured, by), measured)];
    if let Some(first) = modelled.first() {
        parts.push((model_heading(first.document, &modelled), modelled));
    }
    parts
}

fn text(findings: &[Finding], by: &str) -> String {
    let parts: Vec<String> =
        parts(findings, by).into_iter().map(|(heading, of)| wrap(&heading, "") + &text_of(&of)).collect();
    parts.join("\n")
        + "\nBefore a case: + agrees, - contradicts, ? undecided: the difference is within noise and margin.\n"
}

fn text_of(findings: &[&Finding]) -> String {
    let mut text = String::new();
    for finding in findings {
        let verdict = match finding.verdict {
            Verdict::NotMeasured => "[ NOT MEASURED ]".to_owned(),
            verdict => verdict.in_words().to_uppercase(),
        };
        // The statement begins after the verdict and may take several lines
        let statement = wrap(finding.statement, STATEMENT);
        text += &format!("\n{:<4} {verdict:<17} {}", finding.claim, statement.trim_start());
        for line in details(finding) {
            text += &wrap(&line, "       ");
        }
        for case in &finding.cases {
            text += &wrap(&line(case), "         ");
        }
    }
    text
}

/// What a verdict rests on; times of a device that computes on the CPU are named as such.
fn basis(finding: &Finding) -> String {
    let words = finding.basis.in_words();
    if finding.without_gpu { format!("{words} without a GPU") } else { words.to_owned() }
}

/// What a finding rests on, and what to beware of.
pub(super) fn details(finding: &Finding) -> Vec<String> {
    let mut lines = Vec::new();
    let device = match finding.device.as_str() {
        "" => String::new(),
        gpu if finding.basis == Basis::SimtModel => format!(" of {gpu}"),
        device => format!(" on {device}"),
    };
    if finding.verdict == Verdict::NotMeasured {
        lines.push(format!("Nothing was measured that could decide it{device}. It needs {}.", finding.needs));
    } else {
        let noise = if finding.undecided > 0 { format!(", {} undecided", finding.undecided) } else { String::new() };
        let scenes = if finding.scenes == 1 { "1 scene".into() } else { format!("{} scenes", finding.scenes) };
        lines.push(format!(
            "By {}{device}: {} of {} cases agree{noise}; rests on {scenes}.",
            basis(finding),
            finding.agreeing,
            finding.agreeing + finding.contradicting,
        ));
        if !finding.exceptions.is_empty() {
            let (document, exceptions) = (finding.document, finding.exceptions.join(", "));
            lines.push(format!("Except, as in {document}'s own numbers: {exceptions}."));
        }
    }
    lines.extend(finding.left_out.iter().map(|words| format!("{words}.")));
    if !finding.failed.is_empty() {
        let shown = &finding.failed[..finding.failed.len().min(MAX_FAILED)];
        let more = finding.failed.len() - shown.len();
        let more = if more > 0 { format!("; and {more} more") } else { String::new() };
        lines.push(format!("Failed, so that the claim rests on less: {}{more}.", shown.join("; ")));
    }
    if let Some((agreeing, decided)) = finding.published {
        let document = capital(finding.document);
        lines.push(format!("{document}'s own numbers: {agreeing} of {decided} cases agree."));
    }
    if finding.verdict != Verdict::NotMeasured {
        lines.extend(finding.warnings.iter().cloned());
    }
    lines
}

/// One line per finding, as Markdown.
pub fn summary(findings: &[Finding], by: &str) -> String {
    let of_part = |(heading, of): (String, Vec<&Finding>)| format!("{heading}\n\n{}", rows_of(&of));
    parts(findings, by).into_iter().map(of_part).collect::<Vec<_>>().join("\n")
}

fn rows_of(findings: &[&Finding]) -> String {
    let mut text = String::new();
    text += "| claim | verdict | by | scenes | cases | published | statement |\n|:--|:--|:--|--:|--:|--:|:--|\n";
    for finding in findings {
        let measured = finding.verdict != Verdict::NotMeasured;
        let verdict = if measured { format!("**{}**", finding.verdict.in_words()) } else { "*not measured*".into() };
        let of = |agreeing: usize, decided: usize| format!("{agreeing} of {decided}");
        let dash = || "–".to_owned();
        let cases = of(finding.agreeing, finding.agreeing + finding.contradicting);
        text += &format!(
            "| {} | {verdict} | {} | {} | {} | {} | {} |\n",
            finding.claim,
            if measured { basis(finding) } else { dash() },
            if measured { finding.scenes.to_string() } else { dash() },
            if measured { cases } else { dash() },
            finding.published.map_or_else(dash, |(agreeing, decided)| of(agreeing, decided)),
            escape(&[finding.statement, finding.device.as_str()].join(if finding.device.is_empty() {
                ""
            } else {
                " — "
            })),
        );
    }
    text
}

fn markdown(findings: &[Finding], by: &str) -> String {
    let of_part = |(heading, of): (String, Vec<&Finding>)| format!("{heading}\n\n{}{}", rows_of(&of), details_of(&of));
    parts(findings, by).into_iter().map(of_part).collect::<Vec<_>>().join("\n")
}

fn details_of(findings: &[&Finding]) -> String {
    let mut text = String::new();
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
