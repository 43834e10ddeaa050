//! How far pictures of one scene are apart: silhouettes, surfaces, light, and what an eye sees of it.
//!
//! Pure functions of two films. What they are compared with is a [`Reference`]: a film, or what a file has of one.

mod comparison;
mod deflection;
mod flip;
mod geodesics;
mod marks;
mod pareto;
mod reference;
mod timing;

pub use comparison::{Comparison, Disagreement, Figures, Radiance, SizesDiffer, Worst};
pub use deflection::schwarzschild_deflection;
pub use flip::{FlipError, Perceived, flip};
pub use geodesics::{GeodesicPoint, GeodesicSweep};
pub use marks::{Faces, Mark};
pub use pareto::pareto_front;
pub use reference::{Corners, Known, Reference};
pub use timing::{Times, interleaved};
