//! From surfaces to the observer: what they shine with and reflect, shifted and beamed.
//!
//! [`Shading`] is made once a scene: what every body's materials and lights are in its own rest frame, with tables of
//! their colours under any shift. [`SeenShading`] is that for one moment of an observer. How a pixel has found the point
//! of the surface does not matter here.

mod ambient;
mod arrivals;
mod facet;
pub(crate) mod gloss;
mod incidence;
mod logarithm;
mod point;
mod points;
mod seen;
mod shading;
mod tables;
mod trail;

pub(crate) use arrivals::{Arrivals, Diffuse};
pub use facet::Facet;
pub(crate) use facet::{clamped, owns_boundary};
pub(crate) use logarithm::logarithms;
pub use point::Point;
pub(crate) use points::{POINTS, Points, Ways, bits, component, numbers, vector};
pub use seen::{Approach, SeenShading};
pub(crate) use seen::{Glow, SurfaceLight};
pub use shading::{DopplerAt, Shading, ShadingError, has_shadows};
pub use tables::TableInfo;
pub(crate) use trail::{Source, Trail};
