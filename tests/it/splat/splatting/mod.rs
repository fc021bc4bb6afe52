//! Photons on their way to clusters and samples.

mod assignments; // lists against plain loops over clusters and photons, irradiance against the reference
mod density; // buckets on a plane against the area that photons come from, and in the integrating sphere
mod devices; // lists, buckets and irradiance of a device against the twins, limits
mod faults; // what is planted into lists, buckets and images, and found
mod given; // samples, photons and clusters, and passes over them
mod layouts; // structs of kernels, bindings
