use super::stage::Target;
use crate::light::{Facet, Glow, SeenShading};
use crate::scene::Colors;
use glam::DVec3;

/// A triangle that is met in a tile.
pub(super) struct Face<'a> {
    /// Of what body: its index on the stage.
    pub target: usize,
    /// Number of the triangle in its tree.
    pub leaf: u32,
    pub facet: Facet<'a>,
    /// Its plane: 1/s of a direction v is v·plane.
    pub plane: DVec3,
    look: Option<Appearance<'a>>,
}

/// What is the same all over a triangle.
#[derive(Clone, Copy)]
pub(super) struct Appearance<'a> {
    pub material: usize,
    /// Its colours, if they are.
    pub plain: Option<Colors>,
    /// All there is to know, if it is.
    pub glow: Option<Glow<'a>>,
}

impl<'a> Face<'a> {
    fn new(index: usize, target: &'a Target, leaf: u32) -> Self {
        let facet = target.facet(leaf);
        let normal = facet.normal();
        let plane = normal / normal.dot(facet.corners()[0]);
        Self { target: index, leaf, facet, plane, look: None }
    }

    /// The mesh's normal at a point of it: of any length, on the side that is seen.
    #[inline]
    pub fn normal_seen(&self, at: DVec3) -> DVec3 {
        if self.facet.mesh().normals.is_empty() { -self.plane } else { self.facet.normal_seen(at) }
    }

    /// The triangle, and what it looks like.
    pub fn appearance(
        &mut self,
        shading: &SeenShading<'a>,
        target: &Target,
    ) -> (&Facet<'a>, &mut Appearance<'a>) {
        let facet = &self.facet;
        let look = self.look.get_or_insert_with(|| {
            let material = target.mesh.material_index(facet.face());
            let plain = facet.plain_colors();
            let glow = plain.as_ref().and_then(|colors| shading.glow(target.body, material, colors));
            Appearance { material, plain, glow }
        });
        (facet, look)
    }
}

/// Slots of the table in which triangles are found again.
const SLOTS: usize = 64;

/// All triangles that are met in a tile, each once or a few times.
pub(super) struct Faces<'a> {
    pub all: Vec<Face<'a>>,
    /// Numbers of those met last, by their last digits.
    slots: [u32; SLOTS],
}

impl Default for Faces<'_> {
    fn default() -> Self {
        Self { all: Vec::new(), slots: [0; SLOTS] }
    }
}

impl<'a> Faces<'a> {
    /// The number of a triangle here.
    #[inline]
    pub fn number(&mut self, index: usize, target: &'a Target, leaf: u32) -> u32 {
        let slot = &mut self.slots[leaf as usize % SLOTS];
        if self.all.get(*slot as usize).is_none_or(|face| face.leaf != leaf || face.target != index) {
            *slot = self.all.len() as u32;
            self.all.push(Face::new(index, target, leaf));
        }
        *slot
    }
}
