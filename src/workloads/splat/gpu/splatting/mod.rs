//! Passes that bring photons to clusters and samples.
