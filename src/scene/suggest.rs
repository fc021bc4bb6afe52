//! Suggestions ("did you mean") for mistyped names.

/// The hint for an unknown name: the closest known name, if it is close, and all known names.
pub(crate) fn did_you_mean(given: &str, known: &[&str]) -> String {
    let all = known.join(", ");
    match closest(given, known) {
        Some(name) => format!("did you mean {name}? There are: {all}"),
        None => format!("there are: {all}"),
    }
}

/// The known name with the smallest edit distance, if that is at most a third of its length (or 1).
fn closest<'a>(given: &str, known: &[&'a str]) -> Option<&'a str> {
    // A name this long is not a typing error. The limit keeps the table of the edit distance small.
    if given.len() > 64 {
        return None;
    }
    let distance = |name: &str| edits(&given.to_lowercase(), name);
    let best = known.iter().copied().min_by_key(|name| distance(name))?;
    (distance(best) <= (best.len() / 3).max(1)).then_some(best)
}

/// The Levenshtein distance of two names.
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
    fn finds_typing_errors_and_nothing_else() {
        let known = ["hall", "terrain", "sphereflake"];
        assert_eq!(closest("hal", &known), Some("hall"));
        assert_eq!(closest("sphere-flake", &known), Some("sphereflake"));
        assert_eq!(closest("TERAIN", &known), Some("terrain"));
        assert_eq!(closest("kitchen", &known), None);
        assert_eq!(edits("", "abc"), 3);
        assert_eq!(edits("kitten", "sitting"), 3);
    }
}
