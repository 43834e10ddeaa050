//! One ray, wherever it comes from.

use super::beam::inverse_unit;
use super::origin::Origin;
use super::tree::{Branch, EachBox, Leaf, Part, Tree, WIDE};
use crate::light::owns_boundary;
use glam::DVec3;
use std::ops::ControlFlow;

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
    pub fn nearest(&self, tree: &Tree, stack: &mut Vec<Part>) -> Option<Hit> {
        let mut nearest = None;
        self.visit(tree, stack, |hit| {
            nearest = Some(hit);
            Some(hit.at)
        });
        nearest
    }

    /// Whether there is any triangle.
    pub fn is_blocked(&self, tree: &Tree, stack: &mut Vec<Part>) -> bool {
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
    fn visit(&self, tree: &Tree, stack: &mut Vec<Part>, mut seen: impl FnMut(Hit) -> Option<f64>) {
        let (place, slack) = self.origin.place(tree);
        let slabs = Slabs::new(place, slack, self.direction * tree.scale);
        let unit = tree.scale * inverse_unit(place);
        let [from, mut far] = self.range;
        slabs.visit(tree, stack, self.range, |number| {
            let leaf = &tree.leaf(number);
            if self.but == Some(leaf.face) {
                return ControlFlow::Continue(None);
            }
            let corners = leaf.corners.map(|c| self.origin.to(c) * unit);
            let at = meet(corners, self.direction * unit).filter(|at| *at > from && *at < far);
            let Some(at) = at else { return ControlFlow::Continue(None) };
            match seen(Hit { at, leaf: number }) {
                Some(shorter) => far = shorter,
                None => return ControlFlow::Break(()),
            }
            ControlFlow::Continue(Some(far))
        });
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
pub(super) struct Slabs {
    /// Where it begins, in the tree's units; farther out than that by what it may be off, for boxes that lie above.
    low: [f64; 3],
    /// As `low`, of those that lie below.
    high: [f64; 3],
    /// 1 over the direction.
    inverse: [f64; 3],
}

impl Slabs {
    /// Of a ray from `place`, which may be off by `slack`, both and the direction in the tree's units.
    pub fn new(place: DVec3, slack: f64, direction: DVec3) -> Self {
        let [low, high] = [place + slack, place - slack].map(|v| v.to_array());
        Self { low, high, inverse: (1.0 / direction).to_array() }
    }

    /// Shows all triangles in boxes that the ray meets between two s, roughly the nearest first; `seen` says whether the second
    /// is nearer now, and whether it wants more.
    pub fn visit(
        &self,
        tree: &Tree,
        stack: &mut Vec<Part>,
        [from, mut far]: [f64; 2],
        mut seen: impl FnMut(u32) -> ControlFlow<(), Option<f64>>,
    ) {
        stack.clear();
        stack.extend(tree.root().map(|inside| Part { near: from, inside }));
        while let Some(part) = stack.pop() {
            if !overlap(part.near, far) {
                continue;
            }
            match tree.look(part.inside) {
                Ok(branch) => {
                    let (near, met) = self.enter(branch, from, far);
                    tree.push(branch, &near, met, stack);
                }
                Err(leaves) => {
                    for leaf in leaves {
                        match seen(leaf) {
                            ControlFlow::Continue(nearer) => far = nearer.unwrap_or(far),
                            ControlFlow::Break(()) => return,
                        }
                    }
                }
            }
        }
    }

    /// s where a ray enters each box, and which it does enter between two s. In loops of plain arithmetic, which compilers make
    /// vectors of.
    #[inline(always)]
    fn enter(&self, branch: &Branch, from: f64, to: f64) -> (EachBox, [bool; WIDE]) {
        let (mut near, mut far) = ([from; WIDE], [to; WIDE]);
        for k in 0..3 {
            let (below, above) = ((&branch.min[k], self.low[k]), (&branch.max[k], self.high[k]));
            // The side where it enters, and that where it leaves.
            let (enter, leave) = if self.inverse[k] < 0.0 { (above, below) } else { (below, above) };
            for i in 0..WIDE {
                let first = (f64::from(enter.0[i]) - enter.1) * self.inverse[k];
                let last = (f64::from(leave.0[i]) - leave.1) * self.inverse[k];
                // Not a number where it runs in a side, which then has no say.
                near[i] = if first > near[i] { first } else { near[i] };
                far[i] = if last < far[i] { last } else { far[i] };
            }
        }
        (near, std::array::from_fn(|i| overlap(near[i], far[i])))
    }
}

/// Whether something begins before something ends; by more than rounding can be.
#[inline(always)]
fn overlap(near: f64, far: f64) -> bool {
    (near <= far * (1.0 + 1e-14)) | (near <= far)
}
