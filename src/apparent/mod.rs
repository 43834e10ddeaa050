//! The paper's transformer: a mesh moved to where it is seen, split so that straight edges become the
//! hyperbolas they look like.
//!
//! [`ApparentMesh`] is cut for one picture, to pixels; a [`Cutting`] for its shape in space, to lengths.

mod arc;
mod chord;
mod cutting;
mod field;
mod mesh;
mod rod;
mod side;
mod subdivision;

pub use arc::Arc;
pub use cutting::{Cutting, CuttingError, Inserted, Moment};
pub use field::Field;
pub use mesh::{ApparentMesh, ApparentTriangle};
pub use rod::{Piece, Rod};
pub use subdivision::{Subdivision, TooManyPieces, WHOLE, see_vertices};
