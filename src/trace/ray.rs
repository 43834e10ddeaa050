//! One ray, wherever it comes from.

use super::beam::inverse_unit;
use super::origin::Origin;
use super::tree::{Leaf, Node, Tree};
use crate::light::owns_boundary;
use glam::DVec3;

/// A ray in the rest frame of a body: origin + s·direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ray<'a> {
    pub origin: Origin<'a>,
    pub direction: DVec3,
    /// s begins and ends here, neither included.
    pub range: [f64; 2],
    /// A triangle it does not hit: the one it comes from.
    pub but: Option<u32>,
}

/// What a ray hits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Hit {
    /// s.
    pub at: f64,
    /// Number of the triangle in the tree.
    pub leaf: u32,
}

impl Ray<'_> {
    /// The nearest triangle.
    pub fn nearest(&self, tree: &Tree, stack: &mut Vec<u32>) -> Option<Hit> {
        let mut nearest = None;
        self.visit(tree, stack, |hit| {
            nearest = Some(hit);
            Some(hit.at)
        });
        nearest
    }

    /// Whether there is any triangle.
    pub fn is_blocked(&self, tree: &Tree, stack: &mut Vec<u32>) -> bool {
        let mut blocked = false;
        self.visit(tree, stack, |_| {
            blocked = true;
            None
        });
        blocked
    }

    /// Whether it hits a triangle of a leaf.
    #[inline]
    pub fn hits(&self, leaf: &Leaf) -> bool {
        if self.but == Some(leaf.face) {
            return false;
        }
        let [a, b, c] = &leaf.corners;
        let corners = [self.origin.to(*a), self.origin.to(*b), self.origin.to(*c)];
        meet(corners, self.direction).is_some_and(|at| at > self.range[0] && at < self.range[1])
    }

    /// Shows all triangles hit within the range, roughly the nearest first, until there is none in a range that `seen`
    /// has shortened, or it wants no more.
    fn visit(&self, tree: &Tree, stack: &mut Vec<u32>, mut seen: impl FnMut(Hit) -> Option<f64>) {
        let (place, slack) = self.origin.place(tree);
        let slabs = Slabs { place, slack, inverse: 1.0 / (self.direction * tree.scale) };
        let unit = tree.scale * inverse_unit(place);
        let mut far = self.range[1];
        stack.clear();
        if tree.nodes.first().is_some_and(|root| slabs.enters(root, self.range[0], far).is_some()) {
            stack.push(0);
        }
        while let Some(index) = stack.pop() {
            let node = &tree.nodes[index as usize];
            if node.count == 0 {
                let first = node.first;
                let [a, b] =
                    [0, 1].map(|k| slabs.enters(&tree.nodes[(first + k) as usize], self.range[0], far));
                match (a, b) {
                    (Some(a), Some(b)) if a <= b => stack.extend([first + 1, first]),
                    (Some(_), Some(_)) => stack.extend([first, first + 1]),
                    (Some(_), None) => stack.push(first),
                    (None, Some(_)) => stack.push(first + 1),
                    (None, None) => {}
                }
                continue;
            }
            for number in node.first..node.first + node.count {
                let leaf = &tree.leaf(number);
                if self.but == Some(leaf.face) {
                    continue;
                }
                let corners = leaf.corners.map(|c| self.origin.to(c) * unit);
                let Some(at) = meet(corners, self.direction * unit) else { continue };
                if at > self.range[0] && at < far {
                    match seen(Hit { at, leaf: number }) {
                        Some(shorter) => far = shorter,
                        None => return,
                    }
                }
            }
        }
    }
}

/// s where a ray from the origin hits a triangle.
#[inline]
pub(super) fn meet([a, b, c]: [DVec3; 3], direction: DVec3) -> Option<f64> {
    let planes = [b.cross(c), c.cross(a), a.cross(b)];
    let volume = a.dot(planes[0]);
    let flip = if volume < 0.0 { -1.0 } else { 1.0 };
    let inside = planes.iter().all(|plane| {
        let plane = *plane * flip;
        let e = plane.dot(direction);
        e > 0.0 || (e == 0.0 && owns_boundary(plane))
    });
    if !inside || volume == 0.0 {
        return None;
    }
    let normal = (b - a).cross(c - a);
    let at = normal.dot(a) / normal.dot(direction);
    at.is_finite().then_some(at)
}

/// How a ray meets boxes.
struct Slabs {
    place: DVec3,
    slack: f64,
    /// 1 over the direction, in the tree's units.
    inverse: DVec3,
}

impl Slabs {
    /// s where a ray enters a box; none where it misses it.
    #[inline(always)]
    fn enters(&self, node: &Node, from: f64, to: f64) -> Option<f64> {
        let (mut near, mut far) = (from, to);
        for k in 0..3 {
            let low = f64::from(node.min[k]) - self.place[k] - self.slack;
            let high = f64::from(node.max[k]) - self.place[k] + self.slack;
            // Not a number where it runs in a side of the box; min and max then take the other.
            let (a, b) = (low * self.inverse[k], high * self.inverse[k]);
            near = near.max(a.min(b));
            far = far.min(a.max(b));
        }
        // Rounding, by more than there can be.
        (near <= far * (1.0 + 1e-14) || near <= far).then_some(near)
    }
}
