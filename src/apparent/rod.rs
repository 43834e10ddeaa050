use super::{Arc, Field};
use crate::relativity::ApparentMap;
use glam::DVec3;

/// A straight rod at rest in a moving body, drawn as the hyperbola it looks like (Nollert et al. 2000, Eq. 2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rod {
    /// One end, rest frame.
    pub from: DVec3,
    /// The other end.
    pub to: DVec3,
}

/// A node of a rod's polyline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// Position along the rod, 0 to 1.
    pub t: f64,
    /// Apparent position relative to the observer, in the observer's axes.
    pub apparent: DVec3,
}

impl Rod {
    /// The nodes of the polyline, ends included, that stays within `tolerance` pixels of the rod's image
    /// everywhere in the picture, corners included, with equal error in every piece. Straight lines between
    /// the apparent nodes are meant, clipped only after this.
    ///
    /// `tolerance` is in pixels, usually ¼; the number of pieces grows as 1/√tolerance, and is within a few
    /// per cent of the least possible.
    pub fn polyline(&self, map: &ApparentMap, field: &Field, tolerance: f64) -> Vec<Piece> {
        let node = |t: f64| Piece { t, apparent: map.see(self.from.lerp(self.to, t)).position };
        let mut nodes = vec![node(0.0)];
        match Arc::new(map, map.offset_rest(self.from), map.offset_rest(self.to)) {
            Some(arc) => nodes.extend(arc.parameters(&arc.outline_cuts(field, tolerance)).map(node)),
            None => nodes.extend(self.through_observer(map).map(node)),
        }
        nodes.push(node(1.0));
        nodes
    }

    /// Where the rod passes through the observer, if it does: its image has a corner there.
    pub(super) fn through_observer(&self, map: &ApparentMap) -> Option<f64> {
        let (from, to) = (map.offset_rest(self.from), map.offset_rest(self.to));
        let (start, end) = (from.length(), to.length());
        let t = start / (start + end);
        // Not again for an end that is at the observer already.
        (from.dot(to) < -0.5 * start * end && t > 1e-9 && t < 1.0 - 1e-9).then_some(t)
    }
}
