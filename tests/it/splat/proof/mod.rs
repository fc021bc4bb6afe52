//! Photons and their estimates against closed forms and against paths from the eye.

mod balance; // a closed room keeps all flux, a hole loses its share
mod cached; // the reference's cache, whole and broken
mod convergence; // means and the order of convergence, box and sponza
mod faults; // planted faults are found
mod grid; // the estimate by cells against the plain loop
mod path_traced; // the reference against a closed form, and its standard error
mod pixels; // the fixed pixels
mod scenes; // a sphere and a room by hand, with light
mod sphere; // the integrating sphere
mod statistics; // chi-square, means with standard errors, slopes
