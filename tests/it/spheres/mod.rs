//! The sphere tracer: pictures of all renderers, their work, closed forms.

mod pictures; // every CPU renderer makes the reference's bits
mod support; // scenes by hand, views in double precision
