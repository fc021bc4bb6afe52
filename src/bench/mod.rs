//! Measuring: the plan of a sweep, verification before timing, statistics, the machine's description. Only here (and
//! in build statistics) is a clock read.

pub mod verify;
