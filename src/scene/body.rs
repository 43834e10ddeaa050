use super::Mesh;
use crate::relativity::Motion;
use std::sync::Arc;

/// A mesh in uniform motion.
#[derive(Clone, Debug)]
pub struct Body {
    /// What the scene calls it.
    pub name: String,
    /// At rest, placed by scale and rotation.
    pub mesh: Arc<Mesh>,
    /// How it moves.
    pub motion: Motion,
}
