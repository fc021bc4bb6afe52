//! "Did you mean": the known name that is closest to a mistyped one.

/// A mend for an unknown name: the closest known one, if it is close, and all that exist.
pub(crate) fn did_you_mean(given: &str, known: &[&str]) -> String {
    let all = known.join(", ");
    match closest(given, known) {
        Some(name) => format!("did you mean {name}? There are: {all}"),
        None => format!("there are: {all}"),
    }
}

/// The known name that needs the fewest edits, if they are at most a third of its letters (or one).
fn closest<'a>(given: &str, known: &[&'a str]) -> Option<&'a str> {
    // Nothing that long is a slip of the finger; keeps the table small.
    if given.len() > 64 {
        return None;
    }
    let distance = |name: &str| edits(&given.to_lowercase(), name);
    let best = known.iter().copied().min_by_key(|name| distance(name))?;
    (distance(best) <= (best.len() / 3).max(1)).then_some(best)
}

/// Levenshtein's distance.
fn edits(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, &y) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(x != y);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_slips_and_nothing_else() {
        let known = ["hall", "terrain", "sphereflake"];
        assert_eq!(closest("hal", &known), Some("hall"));
        assert_eq!(closest("sphere-flake", &known), Some("sphereflake"));
        assert_eq!(closest("TERAIN", &known), Some("terrain"));
        assert_eq!(closest("kitchen", &known), None);
        assert_eq!(edits("", "abc"), 3);
        assert_eq!(edits("kitten", "sitting"), 3);
    }
}
