//! How far pictures of one scene are apart: silhouettes, surfaces, light, and what an eye sees of it.
//!
//! Pure functions of two films. What they are compared with is a [`Reference`]: a film, or what a file has of one.

mod comparison;
mod flip;
mod marks;
mod reference;

pub use comparison::{Comparison, Disagreement, Figures, Radiance, SizesDiffer, Worst};
pub use flip::{FlipError, Perceived, flip};
pub use marks::{Faces, Mark};
pub use reference::{Corners, Known, Reference};
