//! The HTML report: claims, tables, figures, pictures and provenance of recorded runs on one page.

mod pictures;
mod provenance;

use super::{Options, Results, Rows, Source, claims, without_numbers};
use crate::error::Result;
use crate::report::figure::Missing;
use crate::report::html::{self, capital, escape};
use crate::sources::runs::RecordedRun;

/// A source with the numbers that its part of the page shows.
pub struct Part<'a> {
    /// The source.
    pub source: &'a Source,
    /// Its numbers.
    pub results: &'a dyn Results,
    /// What its tables show.
    pub options: Options,
}

/// Writes the page of these sources. Without runs, it shows the published numbers.
///
/// # Errors
/// A picture cannot be read.
pub fn write(parts: &[Part], runs: &[RecordedRun]) -> Result<String> {
    let titles: Vec<String> = parts.iter().map(|part| title(part, runs)).collect();
    let mut body = String::new();
    for (index, part) in parts.iter().enumerate() {
        body += &part_of(part, runs, &titles[index], parts.len() > 1, index + 1 == parts.len())?;
    }
    Ok(html::page(&titles.join("; "), &body))
}

fn title(part: &Part, runs: &[RecordedRun]) -> String {
    format!("{}, {}", part.source.title, if runs.is_empty() { "as printed" } else { "measured anew" })
}

/// A source's part of the page; pictures and provenance are the runs', so they are in the last one.
fn part_of(part: &Part, runs: &[RecordedRun], title: &str, is_one_of_several: bool, is_last: bool) -> Result<String> {
    let (results, options) = (part.results, &part.options);
    let (figures, missing) = results.figures()?;
    let mut tables = results.tables(part.source.tables, options);
    if options.rows == Rows::Measured {
        tables.retain(|table| !table.rows.is_empty());
    }
    let absent = absent(&without_numbers(results, part.source.tables, options));
    let tables: String = tables.iter().map(html::table).collect();
    let figures: String = figures.iter().map(html::figure).collect();

    let mut sections = vec![
        ("claims", "Claims", "Claims", claims::html(&results.claims(options))),
        ("tables", "Tables", "Tables", tables + &absent),
        ("figures", "Figures", "Figures", figures + &missing.iter().map(not_drawn).collect::<String>()),
    ];
    if is_last {
        sections.push(("pictures", "Pictures", "Pictures", pictures::write(runs)?));
    }
    sections.extend(results.sections(runs).into_iter().map(|s| (s.id, s.name, s.title, s.content)));
    if is_last {
        sections.push(("provenance", "Provenance", "Provenance", provenance::write(runs, part.source)));
    }

    let anchor = |id: &str| if is_one_of_several { format!("{}-{id}", part.source.name) } else { id.to_owned() };
    let links: Vec<String> =
        sections.iter().map(|(id, name, ..)| format!("<a href=\"#{}\">{name}</a>", anchor(id))).collect();
    let sections: String =
        sections.iter().map(|(id, _, title, content)| html::section(&anchor(id), title, content)).collect();
    let lead = results.lead(runs, options.rows);
    Ok(format!("<h1>{}</h1>\n{lead}<nav>{}</nav>\n{sections}", escape(title), links.join(" ")))
}

/// The tables without numbers.
fn absent(ids: &[&str]) -> String {
    if ids.is_empty() {
        return String::new();
    }
    format!("<p class=\"note\">Nothing was measured for: {}.</p>\n", ids.join(", "))
}

fn not_drawn(missing: &Missing) -> String {
    let (what, needs) = (escape(&capital(&missing.what)), escape(missing.needs));
    format!("<p class=\"note\">{what} is not drawn: it needs {needs}.</p>\n")
}
