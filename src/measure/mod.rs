//! How far pictures of one scene are apart: silhouettes, surfaces, light, and what an eye sees of it.
//!
//! Of two films, by pure functions; what they are compared with is a [`Reference`]: a film, or what a file has of one. And
//! what ways to draw a scene ([`Sweep`]) or to follow light ([`GeodesicSweep`]) take for the errors they make.

mod comparison;
mod deflection;
mod displacement;
mod flip;
mod geodesics;
mod marks;
mod pareto;
mod reference;
pub mod stability;
mod sweep;
mod timing;

pub use comparison::{Comparison, Disagreement, Figures, Radiance, SizesDiffer, Worst};
pub use deflection::schwarzschild_deflection;
pub use displacement::{Displacement, beyond_faces, edge_displacement, f32_displacement, in_f32};
pub use flip::{FlipError, Perceived, flip};
pub use geodesics::{GeodesicPoint, GeodesicSweep};
pub use marks::{Faces, Mark};
pub use pareto::pareto_front;
pub use reference::{Corners, Known, Reference};
pub use sweep::{
    Measured, ON_GPU, Sweep, SweepError, SweepPoint, SweepWay, Vertices, series_names, usual_ways,
};
pub use timing::{Times, interleaved};
