//! How results are shown: tables and their formats, figures as SVG, the frame of an HTML page, and parts of a document
//! that a command keeps up to date.
//!
//! Nothing here knows what is shown. Titles, names, colours of series and what a published value is called come from
//! the caller ([`crate::sources`]).

pub mod embed;
pub mod figure;
pub mod format;
pub mod html;
pub mod number;
pub mod splice;
pub mod table;
pub mod wrap;

pub use number::{Form, Number};
pub use table::{Cell, Column, Line, Origin, Row, Table};
