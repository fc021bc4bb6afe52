//! Rows of unlike conditions are not compared.

use rtbench::compare::pair::{Comparable, Conditions, choose};

fn frames(frames: usize) -> Conditions {
    Conditions { frames, ..Conditions::default() }
}

/// Which rows are kept, given as `(group, conditions, structure, variant)`.
fn kept(rows: &[(u32, &Conditions, &str, u32)]) -> Vec<bool> {
    let rows: Vec<_> = rows
        .iter()
        .map(|(group, conditions, structure, variant)| Comparable { group, conditions, structure, variant })
        .collect();
    choose(&rows).iter().map(Option::is_none).collect()
}

#[test]
fn one_condition_fills_a_group() {
    let (two, three) = (frames(2), frames(3));
    // Most structures, then most variants, then the later.
    assert_eq!(kept(&[(1, &two, "a", 0), (1, &two, "b", 0), (1, &three, "c", 0)]), [true, true, false]);
    assert_eq!(kept(&[(1, &two, "a", 0), (1, &two, "a", 1), (1, &three, "c", 0)]), [true, true, false]);
    assert_eq!(kept(&[(1, &two, "a", 0), (1, &two, "a", 0), (1, &three, "c", 0)]), [false, false, true]);
    assert_eq!(kept(&[(1, &two, "a", 0), (1, &three, "c", 0)]), [false, true]);
    // Groups do not see each other.
    assert_eq!(kept(&[(1, &two, "a", 0), (2, &three, "c", 0)]), [true, true]);
    assert!(kept(&[]).is_empty());
}

#[test]
fn differences_are_named() {
    let one = Conditions { frames: 1, scene: "0123456789".into(), ..Conditions::default() };
    let other = Conditions { path: "orbit".into(), path_hash: "abc".into(), checked: true, ..frames(5) };
    assert_eq!(one.difference_from(&other), "1 frame, camera path , scene 01234567, shader checks off");
    assert_eq!(other.difference_from(&one), "5 frames, camera path orbit abc, scene , shader checks on");
    assert_eq!(one.difference_from(&one), "");
}
