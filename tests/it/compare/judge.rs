//! What a difference says, given noise and margin, and what cases say together.

use rtbench::compare::judge::{Outcome, Uncertain, Verdict, all, less, less_by, not};

use Outcome::{Agrees, Contradicts, Undecided};

#[test]
fn a_difference_decides_beyond_margin_and_noise() {
    let exact = Uncertain::exact;
    assert_eq!([less(exact(1.0), exact(2.0)), less(exact(2.0), exact(1.0))], [Agrees, Contradicts]);
    // Equal counts are no "less".
    assert_eq!(less(exact(1.0), exact(1.0)), Contradicts);
    // Times: 10 %, and the noise of both.
    let time = |ms, noise| Uncertain::time(ms, noise);
    assert_eq!(less(time(10.0, 0.0), time(11.1, 0.0)), Agrees);
    assert_eq!(less(time(10.0, 0.0), time(10.9, 0.0)), Undecided);
    assert_eq!(less(time(11.1, 0.0), time(10.0, 0.0)), Contradicts);
    assert_eq!(less(time(10.0, 1.0), time(11.1, 2.0)), Undecided);
    // Build times: 20 %. Of two margins the larger counts.
    assert_eq!(less(Uncertain::build(10.0), Uncertain::build(11.9)), Undecided);
    assert_eq!(less(Uncertain::build(10.0), exact(11.9)), Undecided);
    // By a factor.
    assert_eq!(less_by(exact(1.0), exact(2.1), 2.0), Agrees);
    assert_eq!(less_by(time(1.0, 0.0), time(2.1, 0.0), 2.0), Undecided);
    assert_eq!(less_by(time(1.0, 0.0), time(1.5, 0.0), 2.0), Contradicts);
}

#[test]
fn outcomes_combine() {
    assert_eq!([all([]), all([Agrees, Agrees])], [Agrees; 2]);
    assert_eq!(all([Agrees, Undecided]), Undecided);
    assert_eq!(all([Undecided, Contradicts]), Contradicts);
    assert_eq!([Agrees, Contradicts, Undecided].map(not), [Contradicts, Agrees, Undecided]);
}

#[test]
fn exceptions_neither_confirm_nor_refute() {
    let verdict = Verdict::of;
    assert_eq!(verdict(&[], 0), Verdict::NotMeasured);
    assert_eq!(verdict(&[Undecided], 0), Verdict::Undecided);
    assert_eq!(verdict(&[Agrees, Undecided], 0), Verdict::Holds);
    assert_eq!(verdict(&[Agrees, Agrees, Contradicts], 0), Verdict::DoesNotHold);
    assert_eq!(verdict(&[Agrees, Agrees, Contradicts], 1), Verdict::Holds);
    assert_eq!(verdict(&[Agrees, Contradicts], 1), Verdict::Undecided);
}
