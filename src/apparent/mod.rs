//! The paper's transformer: a mesh moved to where it is seen, split so that straight edges become the
//! hyperbolas they look like.

mod arc;
mod field;
mod mesh;
mod rod;
mod subdivision;

pub use arc::Arc;
pub use field::Field;
pub use mesh::{ApparentMesh, ApparentTriangle};
pub use rod::{Piece, Rod};
pub use subdivision::{Subdivision, TooManyPieces, WHOLE};
