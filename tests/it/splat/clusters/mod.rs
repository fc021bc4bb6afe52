//! Clusters of samples: keys, their set in three ways, boxes, and nodes.

mod bounds; // boxes contain their samples, masks and nodes against loops
mod device; // kernels against twins, orders of frames
mod faults; // what the comparison must notice
mod kernels; // struct layouts
mod keys; // keys against their parts, slices against their formula
mod support; // views of made-up samples, frames of clusters
mod unique; // sets of keys against a sorted set
