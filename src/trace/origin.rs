use super::tree::Tree;
use crate::relativity::ApparentMap;
use glam::DVec3;

/// Where rays begin, in the rest frame of a body: the observer's place, which at high speed needs more digits than
/// f64 has, and how far from it they begin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Origin<'a> {
    map: &'a ApparentMap,
    offset: DVec3,
}

impl<'a> Origin<'a> {
    /// At the observer's event itself.
    pub fn of_observer(map: &'a ApparentMap) -> Self {
        Self { map, offset: DVec3::ZERO }
    }

    /// So far from the observer.
    pub fn at(map: &'a ApparentMap, offset: DVec3) -> Self {
        Self { map, offset }
    }

    /// From the origin to a point of the body.
    #[inline]
    pub fn to(&self, x_rest: DVec3) -> DVec3 {
        self.map.offset_rest(x_rest) - self.offset
    }

    /// The origin in a tree's units, and how far that may be off.
    #[inline]
    pub fn place(&self, tree: &Tree) -> (DVec3, f64) {
        let place = self.to(tree.centre) * -tree.scale;
        (place, 4.0 * f64::EPSILON * place.abs().max_element())
    }
}
