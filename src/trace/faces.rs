use super::stage::Target;
use crate::light::{Diffuse, Facet, Glow, SeenShading};
use crate::scene::Colors;
use crate::spectrum::NearRows;
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
    /// All there is to know, if it shines by itself.
    pub glow: Option<Glow<'a>>,
    /// If it only reflects, and has no gloss.
    pub diffuse: Option<Diffuse<'a>>,
    /// Of what is kept of tables for its one colour, if it has one, one a light: the number of the first.
    pub tables: usize,
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
    pub fn normal_seen(&self, at: impl FnOnce() -> DVec3) -> DVec3 {
        if self.facet.mesh().normals.is_empty() {
            return -self.plane;
        }
        let normal = self.facet.normal_seen(at());
        // One that is no direction is the triangle's own.
        if normal.length_squared().is_normal() { normal } else { -self.plane }
    }

    /// The triangle, and what it looks like. `kept` are tables of all that were looked at.
    #[inline]
    pub fn appearance(
        &mut self,
        shading: &SeenShading<'a>,
        target: &Target,
        kept: &mut Vec<NearRows>,
    ) -> (&Facet<'a>, &mut Appearance<'a>) {
        let facet = &self.facet;
        (facet, self.look.get_or_insert_with(|| Appearance::new(facet, shading, target, kept)))
    }
}

impl<'a> Appearance<'a> {
    #[inline(never)]
    fn new(facet: &Facet<'a>, shading: &SeenShading<'a>, target: &Target, kept: &mut Vec<NearRows>) -> Self {
        let material = target.mesh.material_index(facet.face());
        let plain = facet.plain_colors();
        let glow = plain.as_ref().and_then(|colors| shading.glow(target.body, material, colors));
        let dark = plain.is_none_or(|colors| colors.emission == [0.0; 3]);
        let diffuse = shading.diffuse(target.body, material).filter(|_| dark);
        let tables = kept.len();
        if diffuse.is_some() && plain.is_some() {
            kept.resize(tables + shading.lights(), NearRows::default());
        }
        Self { material, plain, glow, diffuse, tables }
    }
}

/// Slots of the table in which triangles are found again.
const SLOTS: usize = 64;

/// Triangles that are met in a tile, each once, or more often where there are many.
pub(super) struct Faces<'a> {
    pub all: Vec<Face<'a>>,
    /// Of those that only reflect: see [`Appearance::tables`].
    pub tables: Vec<NearRows>,
    /// Numbers of those met last, by their last digits.
    slots: [u32; SLOTS],
}

impl Default for Faces<'_> {
    fn default() -> Self {
        Self { all: Vec::new(), tables: Vec::new(), slots: [0; SLOTS] }
    }
}

impl<'a> Faces<'a> {
    /// Forgets them.
    pub fn clear(&mut self) {
        self.all.clear();
        self.tables.clear();
    }

    /// Forgets them before another sample, where they are too many to be found again.
    pub fn limit(&mut self) {
        if self.all.len() > 4 * SLOTS {
            self.clear();
        }
    }

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

#[cfg(test)]
mod tests {
    use super::super::stage::Stage;
    use super::super::tree::Tree;
    use super::*;
    use crate::relativity::Motion;
    use crate::scene::{Camera, Lens, Projection, shapes};
    use std::sync::Arc;
    use terrell_geodesic::{Event, Tetrad};

    /// However many share a slot, and whatever was met before.
    #[test]
    fn numbers_are_those_of_the_triangles_asked_for() {
        let mesh = Arc::new(shapes::sphere(2));
        let tree = Arc::new(Tree::new(&mesh));
        let camera = Camera {
            observer: Tetrad::of_world(Event::origin()),
            lens: Lens::new(Projection::Pinhole, 45.0, 8, 8).unwrap(),
        };
        let body = |i: usize| (i, Motion::at_rest(DVec3::splat(3.0 + i as f64)), mesh.clone(), tree.clone());
        let stage = Stage::new(vec![body(0), body(1)], &camera, false);
        let mut faces = Faces::default();
        let mut random = super::super::beam::tests::random(3);
        let mut most = 0;
        for step in 0..5000 {
            if step % 100 == 0 {
                faces.limit();
            }
            if step % 300 == 0 {
                faces.clear();
            }
            let index = usize::from(random() < 0.5);
            let leaf = (random() * tree.count() as f64) as u32;
            let number = faces.number(index, &stage.targets[index], leaf);
            assert_eq!(number, faces.number(index, &stage.targets[index], leaf));
            let face = &faces.all[number as usize];
            assert_eq!((face.target, face.leaf), (index, leaf));
            let corner = stage.targets[index].map.offset_rest(tree.leaf(leaf).corners[1]);
            assert!((face.plane.dot(corner) - 1.0).abs() < 1e-9);
            most = most.max(faces.all.len());
        }
        assert!(most > SLOTS && most <= 4 * SLOTS + 100, "{most}");
    }
}
