//! Comparing measurements: statistics against known answers, pairs, judgements.

mod judge; // margins, noise, verdicts of cases
mod pair; // rows of unlike conditions
mod statistics; // paired ratios, the sign test's interval
