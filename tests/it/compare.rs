//! Comparing measurements: statistics against known answers, pairs, judgements.

mod judge; // margins, noise, verdicts of cases
mod pair; // rows of unlike conditions
mod rounds; // interleaved rounds and their null band
mod runs; // whole runs: conditions, verdicts, formats, memory
mod statistics; // paired ratios, the sign test's interval, ranks
