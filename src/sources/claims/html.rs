//! Findings on a page.

use super::text::details;
use super::{Finding, apart, line, model_heading, totals};
use crate::compare::judge::Verdict;
use crate::report::html::{capital, escape};

/// Writes all findings.
pub fn write(findings: &[Finding]) -> String {
    let [measured, modelled] = apart(findings);
    let mut html = format!("<p>{}.</p>\n", escape(&capital(&totals(&measured)))) + &divisions(&measured);
    if let Some(first) = modelled.first() {
        html += &format!("<h3>By the SIMT model</h3>\n<p>{}</p>\n", escape(&model_heading(first.document, &modelled)));
        html += &divisions(&modelled);
    }
    html + "<p class=\"note\">Before a case: + agrees, - contradicts, ? undecided: within noise and margin.</p>\n"
}

fn divisions(findings: &[&Finding]) -> String {
    let mut html = String::new();
    for finding in findings {
        let class = match finding.verdict {
            Verdict::Holds => "holds",
            Verdict::DoesNotHold => "does-not-hold",
            Verdict::Undecided => "undecided",
            Verdict::NotMeasured => "not-measured",
        };
        html += &format!(
            "<div class=\"claim\">\n<h3><span class=\"verdict {class}\">{}</span> {} {}</h3>\n",
            finding.verdict.in_words(),
            finding.claim,
            escape(finding.statement)
        );
        html += &details(finding).iter().map(|line| format!("<p>{}</p>\n", escape(line))).collect::<String>();
        if !finding.cases.is_empty() {
            html += &format!("<details><summary>{}</summary>\n<ul>\n", number(finding.cases.len()));
            for case in &finding.cases {
                html += &format!("<li>{}</li>\n", escape(&line(case)));
            }
            html += "</ul></details>\n";
        }
        html += "</div>\n";
    }
    html
}

fn number(cases: usize) -> String {
    if cases == 1 { "1 case".into() } else { format!("{cases} cases") }
}
