//! Tables as LaTeX.

use super::synthetic::everything;
use super::tables::{compared, tables};
use rtbench::report::format::{self, Format};
use rtbench::sources::thesis::measured;
use rtbench::sources::thesis::tables::IDS;

fn latex(ids: &[&str]) -> String {
    format::write(&tables(&measured::data(&everything()), &compared(), ids), Format::Latex)
}

#[test]
fn long_tables_break_between_rows_and_repeat_their_headings() {
    let text = latex(&["B.1"]);
    assert!(text.contains("\\begin{longtable}{lllrrrrrrrrr}\n"), "{text}");
    // A float cannot break.
    assert!(!text.contains("\\begin{table}") && text.starts_with("% Needs \\usepackage{longtable}"), "{text}");
    assert_eq!(text.matches("scene & side &  & min").count(), 2, "once above, once for further pages: {text}");
    assert!(text.contains("\\endfirsthead") && text.contains("\\endhead") && text.contains("\\endfoot"));
    assert!(text.contains(" &  &  & \\multicolumn{3}{c}{grid} & \\multicolumn{3}{c}{kd-tree}"), "{text}");
    // No page ends between the lines of a row.
    let end = |words: &str| text.lines().find(|line| line.contains(words)).unwrap().to_owned();
    assert!(end("bunny & 256 & run").ends_with("\\\\*") && end("& ratio &").ends_with(" \\\\"), "{text}");
}

#[test]
fn captions_leave_the_number_to_latex() {
    let text = latex(&IDS);
    assert!(text.contains("\\caption{Scenes (thesis table 5.1)}"), "{text}");
    assert!(text.contains("\\caption{Speed-up of Fast GPU over Slow GPU (thesis section 5.3.4)}"), "{text}");
    assert!(!text.contains("\\caption{Table"), "{text}");
    for environment in ["longtable", "group"] {
        let (begin, end) = match environment {
            "group" => ("\\begingroup".to_owned(), "\\endgroup".to_owned()),
            other => (format!("\\begin{{{other}}}"), format!("\\end{{{other}}}")),
        };
        assert_eq!(text.matches(&begin).count(), text.matches(&end).count(), "{environment}");
    }
    // Every line of a table has as many columns as its first.
    for table in text.split("\\begin{longtable}").skip(1) {
        let columns = |line: &str| {
            let spans = line.matches("\\multicolumn{2}").count() + 2 * line.matches("\\multicolumn{3}").count();
            line.replace("\\&", "").matches('&').count() + spans
        };
        let lines: Vec<&str> = table.lines().filter(|l| l.contains(" & ") && l.contains("\\\\")).collect();
        assert!(lines.iter().all(|line| columns(line) == columns(lines[0])), "{table}");
    }
}
