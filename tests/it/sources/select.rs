//! Sources, tables and published devices by name.

use rtbench::sources::{ALL, select, select_device, select_tables};
use rtbench::workloads::trace;

#[test]
fn every_source_fits_its_description() {
    let mut names: Vec<&str> = ALL.iter().map(|source| source.name).collect();
    names.dedup();
    assert_eq!(names.len(), ALL.len());
    for source in ALL {
        let results = (source.read)(&[]);
        let tables = results.tables(source.tables, &Default::default());
        assert!(tables.iter().all(|table| table.origin.source == source.name && table.is_published), "{}", source.name);
        for id in source.tables {
            assert!(tables.iter().any(|table| table.id == *id), "{} {id}", source.name);
        }
        assert!(results.claims(&Default::default()).iter().all(|finding| finding.source == source.name));
    }
}

#[test]
fn the_published_devices_are_those_of_the_data() {
    let data = rtbench::sources::thesis::published::data();
    let labels: Vec<&str> = data.devices.iter().map(|device| device.label.as_str()).collect();
    assert_eq!(labels, rtbench::sources::thesis::SOURCE.devices);
}

#[test]
fn names_select_sources_and_devices() {
    let named = |names: &[&str]| {
        let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
        select(&names, &[]).map(|sources| sources.iter().map(|source| source.name).collect::<Vec<_>>())
    };
    // The structures of today have no published numbers to show without a run
    assert_eq!(named(&[]).unwrap(), ["thesis", "rt2", "spheres", "splat"]);
    assert_eq!(named(&["structures"]).unwrap(), ["structures"]);
    assert_eq!(named(&["thesis", "thesis"]).unwrap(), ["thesis"]);
    let error = named(&["2009"]).unwrap_err();
    assert_eq!((error.exit_code(), error.to_string().contains("one of thesis, rt2")), (2, true), "{error}");
    assert_eq!(select_device(&ALL, "8600gt").unwrap(), [Some(1), None, None, None, None]);
    assert_eq!(select_device(&ALL, "amd radeon rx 480").unwrap(), [None, None, None, Some(1), None]);
    assert!(select_device(&ALL, "RTX").unwrap_err().to_string().contains("GTX280, 8600GT"));
    let error = select_device(&[&rtbench::sources::rt2::SOURCE], "RTX").unwrap_err().to_string();
    assert!(error.contains("rt2 published times of no device"), "{error}");
    assert_eq!(select_tables(&ALL, "5.4,4.6").unwrap(), [vec!["5.4"], vec!["4.6"], vec![], vec![], vec![]]);
}

/// What the thesis's source says of a structure by its name holds for structures that there are; others need no entry.
#[test]
fn structures_that_are_known_can_be_measured() {
    use rtbench::sources::thesis::structures::{KNOWN, Step, step};
    assert_eq!((step("grid-packet"), step("kdtree"), step("no longer there")), (Step::Cell, Step::Node, Step::Node));
    for structure in KNOWN {
        assert!(trace::algorithms().iter().any(|variant| variant.name == structure.name), "{}", structure.name);
        assert!(KNOWN.iter().filter(|other| other.colour == structure.colour).count() == 1, "{}", structure.name);
    }
}
