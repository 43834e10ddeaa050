//! What is two-dimensional, on top of a finished picture: a mesh's edges as the curves they look like, captions,
//! the axes, a scale bar, a legend.
//!
//! All of it is drawn on 8-bit sRGB, after the film's light has become colour; the film only says what hides what.
//! Sizes of letters and lines go with the picture's height.

mod axes;
mod canvas;
mod caption;
mod curves;
mod legend;
mod mesh_edges;
pub(crate) mod number;
mod overlay;
mod scale_bar;
mod sheet;
pub(crate) mod text;

pub use caption::{Caption, CaptionError};
pub use mesh_edges::Edges;
pub use overlay::{NoScale, Overlay, OverlayOptions, Shot};
pub use sheet::{DECADES, Panel, Sheet, decade_color};
