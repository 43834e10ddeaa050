//! Figures for science: curves and points over axes, heat maps, several panels on a page; as SVG and as pixels.
//!
//! A [`Figure`] is laid out as a [`Page`], a list of lines, areas and texts in pixels of the page, which is written as
//! SVG or painted: both show the same. What is shown is told in numbers; what the numbers are is of no concern here.

mod axis;
mod heat_map;
mod labels;
mod layout;
mod marker;
mod page;
mod painted;
mod panel;
mod svg;
mod words;

pub use axis::{Axis, Scale, power_of_ten};
pub use heat_map::HeatMap;
pub use layout::Figure;
pub use marker::{INKS, Marker};
pub use page::{Anchor, Ink, Item, Page};
pub use panel::{Panel, Point, Series, Stroke};
pub(crate) use svg::{base64, escaped};
