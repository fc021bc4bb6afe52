//! Claims and tables by the SIMT model: verdicts of their own, next to those of measurements.

use rtbench::compare::judge::Verdict;
use rtbench::report::Cell;
use rtbench::sources::claims::{self, Basis, Finding, Form};
use rtbench::sources::rt2;
use rtbench::sources::runs::RecordedRun;
use rtbench::sources::thesis::{self, Numbers};
use rtbench::sources::{Options, Results};
use rtbench::workloads::trace::simt::Event;
use std::path::Path;

fn committed(name: &str) -> RecordedRun {
    RecordedRun::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("results").join(name)).unwrap()
}

fn findings(run: &RecordedRun) -> Vec<Finding> {
    Numbers::of(std::slice::from_ref(run)).claims(&Options::default())
}

fn modelled<'a>(findings: &'a [Finding], claim: &str, gpu: &str) -> Option<&'a Finding> {
    findings.iter().find(|f| (f.basis, f.claim, f.device.as_str()) == (Basis::SimtModel, claim, gpu))
}

const GTX280: &str = "GeForce GTX 280";

#[test]
fn claims_about_gpus_have_a_verdict_of_their_own() {
    let findings = findings(&committed("simt-2026-11-30"));
    for claim in ["3", "4", "5", "6a", "6b"] {
        for gpu in [GTX280, "GeForce 8600 GT"] {
            let finding = modelled(&findings, claim, gpu).unwrap_or_else(|| panic!("{claim} {gpu}"));
            assert!(finding.verdict != Verdict::NotMeasured && !finding.without_gpu, "{finding:?}");
        }
        let measured = findings.iter().filter(|f| f.claim == claim && f.basis != Basis::SimtModel);
        assert_eq!(measured.count(), 1, "{claim}");
    }
    // Sizes, build times and registers are not the model's
    for claim in ["1", "2", "12"] {
        assert!(modelled(&findings, claim, GTX280).is_none(), "{claim}");
    }
    let text = claims::write(std::slice::from_ref(&findings), "1 run", Form::Text);
    let (measured, by_model) = text.split_once("Claims of the thesis by the SIMT model").unwrap();
    assert!(measured.contains("judged by 1 run") && !measured.contains("SIMT"), "{measured}");
    assert!(by_model.contains("In place of times") && by_model.contains("By the SIMT model of GeForce GTX 280"));
    assert!(!by_model.contains(" ms"), "a model's numbers are no times: {by_model}");
    let markdown = claims::write(std::slice::from_ref(&findings), "1 run", Form::Markdown);
    let (measured, by_model) = markdown.split_once("Claims of the thesis by the SIMT model").unwrap();
    assert!(!measured.contains("SIMT") && by_model.contains("\n**3: ") && measured.contains("\n**3: "), "{markdown}");
    let summary = claims::summary(&findings, "1 run");
    assert_eq!(summary.matches("| claim | verdict |").count(), 2, "{summary}");
    assert!(claims::html(&findings).contains("<h3>By the SIMT model</h3>"));
}

#[test]
fn a_verdict_follows_what_warps_issue() {
    let mut run = committed("simt-2026-11-30");
    let before = findings(&run);
    let verdict = |findings: &[Finding], claim| modelled(findings, claim, GTX280).unwrap().verdict;
    for record in run.journal.configurations.iter_mut().filter(|record| record.structure == "grid") {
        record.issued.iter_mut().flatten().for_each(|sums| sums.issued[Event::Step as usize] *= 100);
    }
    let slow_grid = findings(&run);
    assert_eq!(verdict(&slow_grid, "5"), Verdict::Holds, "{:?}", modelled(&slow_grid, "5", GTX280));
    for record in run.journal.configurations.iter_mut().filter(|record| record.structure == "bvh") {
        record.issued.iter_mut().flatten().for_each(|sums| sums.issued[Event::Step as usize] *= 10_000);
    }
    assert_eq!(verdict(&findings(&run), "5"), Verdict::DoesNotHold);
    assert_eq!(verdict(&findings(&run), "3"), Verdict::DoesNotHold);
    // Measured verdicts do not change with them
    let measured = |findings: &[Finding]| -> Vec<Finding> {
        findings.iter().filter(|f| f.basis != Basis::SimtModel).cloned().collect()
    };
    assert_eq!(measured(&before), measured(&findings(&run)));
    // Warps of another width than the GPU's, and none at all
    run.journal.configurations.iter_mut().for_each(|record| record.warp_width = Some(64));
    assert!(findings(&run).iter().all(|f| f.basis != Basis::SimtModel));
    let without = findings(&committed("lavapipe-2core-2026-11-29"));
    assert!(without.iter().all(|f| f.basis != Basis::SimtModel));
    assert!(!claims::write(&[without], "1 run", Form::Text).contains("SIMT"));
}

#[test]
fn the_table_shows_work_next_to_printed_times() {
    let numbers = Numbers::of(&[committed("simt-2026-11-30")]);
    let tables = numbers.tables(&["simt"], &Options { published: true, ..Options::default() });
    assert_eq!(tables.len(), 2);
    for table in &tables {
        let row = table.rows.iter().find(|row| row.keys == ["museum", "P", "512"]).unwrap();
        let least = |of: fn(&Cell) -> Option<f64>| row.cells.iter().filter_map(of).fold(f64::INFINITY, f64::min);
        let value = |cell: &Cell| if let Cell::Number { value, .. } = cell { value.map(|v| v.value) } else { None };
        let published =
            |cell: &Cell| if let Cell::Number { published, .. } = cell { published.map(|v| v.value) } else { None };
        assert_eq!([least(value), least(published)], [1.0, 1.0], "{}", table.title);
        assert!(table.notes.iter().any(|note| note.contains("no times")), "{:?}", table.notes);
    }
    let tables = Numbers::of(&[committed("lavapipe-2core-2026-11-29")]).tables(&["simt"], &Options::default());
    assert!(tables[0].rows.is_empty() && tables[0].notes[0].contains("--warp-width 32"), "{:?}", tables[0].notes);
}

/// The table of verdicts in docs/simt-model.md.
#[test]
fn the_document_has_the_verdicts_of_the_committed_run() {
    let run = committed("simt-2026-11-30");
    let numbers = [&thesis::SOURCE, &rt2::SOURCE].map(|source| (source.read)(std::slice::from_ref(&run)));
    let findings: Vec<Finding> = numbers.iter().flat_map(|numbers| numbers.claims(&Options::default())).collect();
    let modelled = findings.iter().filter(|finding| finding.basis == Basis::SimtModel);
    let mut found: Vec<[String; 2]> = Vec::new();
    for finding in modelled {
        let (of, verdict) = (format!("{} {}", finding.source, finding.claim), finding.verdict.in_words());
        match found.iter_mut().find(|[known, _]| *known == of) {
            // The GPUs are in one order in all claims
            Some([_, verdicts]) => *verdicts += &format!(" | {verdict}"),
            None => found.push([of, verdict.to_owned()]),
        }
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/simt-model.md");
    let text = std::fs::read_to_string(path).unwrap();
    for [of, verdicts] in &found {
        assert!(text.contains(&format!("| {of} | {verdicts} |")), "{of}: {verdicts}");
    }
    assert_eq!(found.len(), 16, "{found:?}");
}
