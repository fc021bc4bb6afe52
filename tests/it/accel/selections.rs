//! Thousands of mutated selections: each is read or refused with one line, what is read is written in one way, and
//! builds a structure that is valid, or says why it does not.

use super::{SELECTIONS, scenes};
use crate::support::random;
use rtbench::workloads::trace::{Selection, algorithms};

/// Mutated texts of each kind.
const VARIANTS: usize = 3_000;

/// Options and values of the tables, put together at random, and values that are at the ends of ranges or beyond them.
fn texts() -> Vec<String> {
    let mut random = random(17);
    let mut below = |limit: usize| ((f64::from(random()) + 1.0) / 2.0 * limit as f64) as usize % limit;
    let odd =
        ["", "0", "-1", "1e39", "nan", "inf", "4294967296", "99999999999999999999", "auto", "on", "\u{e9}", "1,1", "="];
    let mut texts = Vec::new();
    for _ in 0..VARIANTS {
        let algorithm = algorithms()[below(algorithms().len())];
        let options: Vec<_> = algorithm.options().collect();
        let chosen = (0..below(4)).map(|_| {
            let option = options[below(options.len())];
            // The words of an option and the ends of its range, as its help lists them
            let listed = option.values();
            let values: Vec<&str> = listed.split([' ', ',']).filter(|value| !value.is_empty()).collect();
            let value = if below(5) == 0 { odd[below(odd.len())] } else { values[below(values.len())] };
            format!("{}={value}", option.key)
        });
        texts.push(format!("{}:{}", algorithm.name, chosen.collect::<Vec<_>>().join(",")));
    }
    for _ in 0..VARIANTS {
        let mut text: Vec<char> = SELECTIONS[below(SELECTIONS.len())].chars().collect();
        for _ in 0..1 + below(3) {
            let place = below(text.len() + 1);
            match below(3) {
                0 if place < text.len() => drop(text.remove(place)),
                1 => text.insert(place, ['0', '9', ',', ':', '=', '-', '.', '\u{fc}'][below(8)]),
                _ => text.truncate(place),
            }
        }
        texts.push(text.into_iter().collect());
    }
    texts
}

#[test]
fn mutated_selections_are_read_or_refused() {
    let scene = scenes::random("small", 60, 1.0, 0.2, 5);
    let (mut read, mut built) = (0, 0);
    for text in texts() {
        let selection = match Selection::parse(&text) {
            Ok(selection) => selection,
            Err(error) => {
                assert!(!error.to_string().contains('\n') && error.exit_code() == 2, "{text}: {error}");
                continue;
            }
        };
        read += 1;
        let full = selection.full_name();
        assert_eq!(Selection::parse(&full).unwrap(), selection, "{text} is written as {full}");
        match selection.build(&scene, 1) {
            Ok(made) => {
                built += 1;
                made.structure.validate(&scene).unwrap_or_else(|why| panic!("{text}: {why}"));
            }
            Err(error) => assert!(!error.to_string().contains('\n'), "{text}: {error}"),
        }
    }
    assert!(read > VARIANTS / 4 && built > VARIANTS / 4, "{read} read, {built} built: the test sees hardly anything");
}
