//! What is there: meshes, bodies and the camera.

mod camera;
mod mesh;

pub use camera::{Camera, Lens, LensError, MAX_SIDE, Projection};
pub use mesh::{Mesh, MeshError, Paint};
