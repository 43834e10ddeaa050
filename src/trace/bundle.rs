//! Rays from surfaces to a light, which begin in different points, all those of a tile together.

use super::lanes::Lanes;
#[cfg(target_arch = "x86_64")]
use super::lanes::x86;
use super::origin::Origin;
use super::ray::Ray;
use super::stage::{CLOSE, Stage, Target, Way};
use super::tree::{Branch, Inside, Leaf, Tree, WIDE};
use crate::light::{POINTS, Points, Ways, bits, component, numbers, vector};
use glam::{DVec3, Vec3};

/// Rays that are tested together.
const GROUP: usize = 8;

/// How many such.
const GROUPS: usize = POINTS / GROUP;

/// Rays of which is asked only whether anything is in their way.
///
/// Boxes are tested by the ranges of all rays' origins and directions first, then by groups of rays up to the first that
/// may enter; triangles by groups, in f32, by bounds of its rounding. What that leaves is tested in f64.
///
/// Who is outside of something closed, and sees a point of anything, is joined to it by a line that goes into the closed thing
/// as often as out of it; so is the point to a light that is outside, too. Where triangles are closed, and eye and light outside
/// of the box around all of them, a ray therefore hits none unless it hits one from the front, and the others need not be
/// looked at: what is lit, and all that is near it, shows the light its front. (Only fronts are met more often than backs where
/// backs were looked through.) That is so but for rounding: what begins within that of an edge is in its surface's shadow, or not.
#[derive(Default)]
pub(super) struct Bundle {
    /// What is in boxes that are still to be looked at, and the first group that may enter them.
    stack: Vec<(Inside, usize)>,
    lanes: InLanes,
}

/// In the tree's units.
#[repr(align(64))]
struct InLanes {
    origin: [[f32; POINTS]; 3],
    direction: [[f32; POINTS]; 3],
    /// 1 over the direction.
    inverse: [[f32; POINTS]; 3],
    /// |direction| at most.
    length: [f32; POINTS],
    /// Where they end.
    far: f32,
    /// They end no nearer.
    near_far: f32,
    /// What origins are off by, and boxes are larger by.
    slack: f32,
    /// How near to where a ray begins it hits nothing, at most.
    close: f32,
    /// Along which directions they go, where only fronts need be looked at.
    towards: Option<Towards>,
    axes: [Axis; 3],
}

/// Along one axis.
#[derive(Clone, Copy, Default)]
struct Axis {
    /// Whether all rays go backward: then all of this is with the axis turned.
    backward: bool,
    /// Least and greatest.
    origin: [f32; 2],
    /// The middle of the least and the greatest, unturned.
    direction: f32,
    /// Least and greatest 1 over the direction; none if rays go both ways.
    inverse: Option<[f32; 2]>,
    /// All rays lie between.
    swept: [f32; 2],
}

/// Directions up to an angle from an axis.
#[derive(Clone, Copy)]
struct Towards {
    axis: [f32; 3],
    cosine: f32,
    sine: f32,
}

/// The rays of a bundle before they are in lanes.
#[derive(Clone, Copy)]
struct Rays<'a> {
    stage: &'a Stage,
    points: &'a Points,
    ways: &'a Ways,
    /// Of the target they come from, and of that they may hit.
    from: usize,
    to: usize,
}

/// Rays that go farther apart go every way.
const LEAST_COSINE: f32 = 0.5;

/// What f32 leaves over, relative, in a few operations.
const ROUNDING: f32 = 1e-6;

impl Default for InLanes {
    fn default() -> Self {
        let three = [[0.0; POINTS]; 3];
        let (length, axes) = ([0.0; POINTS], Default::default());
        let (far, near_far, slack, close) = (0.0, 0.0, 0.0, 0.0);
        Self {
            origin: three,
            direction: three,
            inverse: three,
            length,
            far,
            near_far,
            slack,
            close,
            towards: None,
            axes,
        }
    }
}

impl<'a> Rays<'a> {
    fn target(&self) -> &'a Target {
        &self.stage.targets[self.to]
    }

    /// One of them.
    fn ray(&self, i: usize) -> Ray<'a> {
        let Self { points, ways, from, .. } = *self;
        let (event, back) = (points.event(i), vector(&ways.backs, i));
        self.stage.ray(
            &Way { from, face: points.faces[i], event, back, far: ways.far },
            self.to,
            self.target(),
        )
    }

    /// Which of some rays something stands in, one by one.
    fn blocked_singly(&self, some: u64) -> u64 {
        let (tree, mut stack) = (&self.target().tree, Vec::new());
        numbers(some).fold(0, |bits, i| bits | u64::from(self.ray(i).is_blocked(tree, &mut stack)) << i)
    }

    /// Which of some rays begin into the surface they come from, as they do where interpolated normals face a light and the
    /// triangle itself does not.
    fn entering(&self, some: u64) -> u64 {
        let mesh = &self.stage.targets[self.from].mesh;
        if mesh.normals.is_empty() {
            return 0;
        }
        let enters = |i: usize| {
            let [a, b, c] = mesh.corners(self.points.faces[i] as usize);
            let normal = (b - a).cross(c - a);
            let [sight, back] = [self.points.event(i), vector(&self.ways.backs, i)].map(|v| v.xyz());
            (normal.dot(sight) > 0.0) == (normal.dot(back) > 0.0)
        };
        numbers(some).fold(0, |bits, i| bits | u64::from(enters(i)) << i)
    }
}

impl Bundle {
    /// Which of the open ways from points of a target to a light something stands in: a bit for each. With AVX2 if
    /// `vectors` and there is such.
    pub fn blocked(
        &mut self,
        stage: &Stage,
        from: usize,
        points: &Points,
        ways: &Ways,
        vectors: bool,
    ) -> u64 {
        let mut open = ways.open;
        for to in 0..stage.targets.len() {
            if open == 0 {
                break;
            }
            open &= !self.blocked_by(&Rays { stage, points, ways, from, to }, open, vectors);
        }
        ways.open & !open
    }

    fn blocked_by(&mut self, rays: &Rays<'_>, open: u64, vectors: bool) -> u64 {
        #[cfg(target_arch = "x86_64")]
        {
            if vectors && crate::processor::has_avx2() {
                // SAFETY: the processor has both.
                unsafe { self.blocked_avx2(rays, open) }
            } else {
                // SAFETY: every x86-64 processor has SSE2.
                unsafe { self.blocked_with::<x86::Sse2>(rays, open) }
            }
        }
        #[cfg(not(target_arch = "x86_64"))]
        {
            let _ = vectors;
            // SAFETY: needs nothing.
            unsafe { self.blocked_with::<super::lanes::One>(rays, open) }
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma")]
    fn blocked_avx2(&mut self, rays: &Rays<'_>, open: u64) -> u64 {
        // SAFETY: the caller has made sure.
        unsafe { self.blocked_with::<x86::Avx2>(rays, open) }
    }

    #[inline(always)]
    unsafe fn blocked_with<L: Lanes>(&mut self, rays: &Rays<'_>, all: u64) -> u64 {
        let tree: &Tree = &rays.target().tree;
        if !self.lanes.aim(rays, all) {
            // Beyond what f32 holds.
            return rays.blocked_singly(all);
        }
        let fronts = self.lanes.towards.map_or(&[][..], |_| tree.fronts());
        // Those are not outside where they begin.
        let single = if fronts.is_empty() { 0 } else { rays.entering(all) };
        let mut open = all & !single;
        let mut stack = std::mem::take(&mut self.stack);
        stack.clear();
        stack.extend(tree.root().map(|inside| (inside, 0)));
        while let Some((inside, first)) = stack.pop() {
            let Ok(branch) = tree.look(inside) else { continue };
            let mut may_enter = self.lanes.may_enter(branch);
            if let (Some(towards), Some(fronts)) = (&self.lanes.towards, fronts.get(inside.number())) {
                let behind = fronts.are_behind(towards.axis, towards.cosine, towards.sine);
                may_enter = std::array::from_fn(|i| may_enter[i] & !behind[i]);
            }
            for i in (0..WIDE).filter(|i| may_enter[*i]) {
                let mut groups = first..GROUPS;
                // SAFETY: as this function.
                let entering = |group: usize| unsafe { self.lanes.enter::<L>(branch, i, group) };
                let entering = |group: usize| of_group(open, group) & entering(group);
                let first = groups.find_map(|g| Some((g, entering(g))).filter(|(_, some)| *some != 0));
                let Some((first, some)) = first else { continue };
                let inside = branch.inside(i);
                let leaves = match tree.look(inside) {
                    Ok(_) => {
                        tree.fetch(inside);
                        stack.push((inside, first));
                        continue;
                    }
                    Err(leaves) => leaves,
                };
                let mut masks = [0; GROUPS];
                masks[first] = some;
                for group in groups {
                    masks[group] = entering(group);
                }
                for leaf in leaves.map(|number| tree.leaf(number)) {
                    let triangle = Triangle::new(&leaf, tree);
                    for (group, mask) in masks.iter().enumerate().skip(first) {
                        let mask = mask & of_group(open, group);
                        if mask == 0 {
                            continue;
                        }
                        // SAFETY: as this function.
                        let hit = unsafe { self.lanes.may_hit::<L>(&triangle, group) };
                        let [mut possible, certain] = hit.map(|hit| hit & mask);
                        while possible != 0 {
                            let (bit, i) = (
                                possible & possible.wrapping_neg(),
                                GROUP * group + possible.trailing_zeros() as usize,
                            );
                            possible &= possible - 1;
                            if rays.points.faces[i] != leaf.face || rays.from != rays.to {
                                let hit = certain & bit != 0 || rays.ray(i).hits(&leaf);
                                open &= !(u64::from(hit) << i);
                            }
                        }
                    }
                }
            }
            if open == 0 {
                break;
            }
        }
        self.stack = stack;
        all & !single & !open | rays.blocked_singly(single)
    }
}

/// The bits of a group's rays.
#[inline(always)]
fn of_group(bits: u64, group: usize) -> u32 {
    (bits >> (GROUP * group)) as u32 & 0xff
}

/// A triangle in the tree's units.
struct Triangle {
    corner: [f32; 3],
    /// From there to the two others.
    edges: [[f32; 3]; 2],
    normal: [f32; 3],
    /// Of the longer edge, at most.
    size: f32,
}

impl Triangle {
    #[inline(always)]
    fn new(leaf: &Leaf, tree: &Tree) -> Self {
        let place = |c: DVec3| (c - tree.centre) * tree.scale;
        let [a, b, c] = &leaf.corners;
        let (a, b, c) = (place(*a), place(*b), place(*c));
        let (e1, e2) = (b - a, c - a);
        let size = e1.abs().element_sum().max(e2.abs().element_sum()) as f32;
        let narrow = |v: DVec3| v.as_vec3().to_array();
        Self { corner: narrow(a), edges: [narrow(e1), narrow(e2)], normal: narrow(e1.cross(e2)), size }
    }
}

impl InLanes {
    /// Takes rays into a target's rest frame and its tree's units; whether all of them, those that are not `open` aside, are
    /// within what f32 holds.
    #[inline(always)]
    fn aim(&mut self, rays: &Rays<'_>, open: u64) -> bool {
        let Rays { stage, points, ways, from, to } = *rays;
        let (receiver, target) = (&stage.targets[from], rays.target());
        let centre = target.map.offset_rest(target.tree.centre);
        let scale = target.tree.scale;
        let map = (target.motion != receiver.motion).then(|| stage.between(to, from));
        // Loops of plain arithmetic, which compilers make vectors of.
        for k in 0..3 {
            // The same frame up to where its origin is, or another.
            let [boosted_at, boosted_back];
            let [at, back] = match &map {
                None => [&points.events[k + 1], &ways.backs[k + 1]],
                Some(map) => {
                    let row = map.rows()[k + 1];
                    [boosted_at, boosted_back] =
                        [component(row, &points.events), component(row, &ways.backs)];
                    [&boosted_at, &boosted_back]
                }
            };
            for i in 0..POINTS {
                self.origin[k][i] = ((at[i] - centre[k]) * scale) as f32;
                self.direction[k][i] = (back[i] * scale) as f32;
            }
        }
        // What is no number makes it all none.
        let (mut sum, mut within) = ([0f32; POINTS], [false; POINTS]);
        for k in 0..3 {
            for (i, sum) in sum.iter_mut().enumerate() {
                let along = self.direction[k][i];
                *sum += self.origin[k][i].abs() + along.abs();
                // Infinite where it is so little that nothing comes of it.
                self.inverse[k][i] = 1.0 / along;
            }
        }
        for i in 0..POINTS {
            let [x, y, z] = &self.direction;
            let length = (x[i] * x[i] + y[i] * y[i] + z[i] * z[i]).sqrt();
            within[i] = (sum[i] < 1e15) & (length > 1e-15);
            self.length[i] = length * (1.0 + 4.0 * ROUNDING);
        }
        if bits(&within) & open != open {
            return false;
        }
        // Those that are not open do what one does that is.
        let one = open.trailing_zeros() as usize % POINTS;
        for i in numbers(!open) {
            for values in self.origin.iter_mut().chain(&mut self.direction).chain(&mut self.inverse) {
                values[i] = values[one];
            }
            self.length[i] = self.length[one];
        }
        self.far = ways.far as f32 * (1.0 + ROUNDING);
        self.near_far = ways.far as f32 * (1.0 - 4.0 * ROUNDING);
        let origins = self.origin.each_ref().map(range);
        let most = origins.iter().flatten().fold(0f32, |most, c| most.max(c.abs()));
        self.slack = most * ROUNDING;
        // As the rays themselves have it, by a bound of how far their origins are from the observer.
        self.close = (CLOSE * (2.0 * f64::from(most) + centre.length() * scale + 1.0)) as f32;
        for (k, origin) in origins.into_iter().enumerate() {
            let direction = range(&self.direction[k]);
            let middle = 0.5 * direction[0] + 0.5 * direction[1];
            let backward = direction[1] < 0.0;
            let turned = |[low, high]: [f32; 2]| if backward { [-high, -low] } else { [low, high] };
            let (origin, direction) = (turned(origin), turned(direction));
            let inverse = [1.0 / direction[1], 1.0 / direction[0]];
            self.axes[k] = Axis {
                backward,
                origin,
                direction: middle,
                inverse: (direction[0] > 0.0).then_some(inverse),
                swept: [
                    origin[0] + (direction[0] * self.far).min(0.0) * (1.0 + ROUNDING),
                    origin[1] + (direction[1] * self.far).max(0.0) * (1.0 + ROUNDING),
                ],
            };
        }
        self.towards = self.only_fronts(rays).then(|| self.towards()).flatten();
        true
    }

    /// Whether rays hit nothing unless they hit something from the front.
    fn only_fronts(&self, rays: &Rays<'_>) -> bool {
        let Target { tree, map, .. } = rays.target();
        let (eye, off) = Origin::of_observer(map).place(tree);
        let off = off as f32 + self.slack;
        // Of each component the least and the greatest.
        let outside = |ranges: [[f32; 2]; 3]| {
            let about = |c: f32, way: f32| c + way * (ROUNDING * c.abs() + off);
            tree.is_outside(ranges.map(|[low, _]| about(low, -1.0)), ranges.map(|[_, high]| about(high, 1.0)))
        };
        let far = rays.ways.far as f32;
        let end = |k: usize| {
            let mut ends = [0.0; POINTS];
            for (i, end) in ends.iter_mut().enumerate() {
                *end = self.origin[k][i] + self.direction[k][i] * far;
            }
            range(&ends)
        };
        // What comes from infinity comes from outside.
        outside(eye.as_vec3().to_array().map(|c| [c; 2]))
            && !tree.fronts().is_empty()
            && (far == f32::INFINITY || outside([end(0), end(1), end(2)]))
    }

    /// Which way they all go, if that is one way.
    #[inline(always)]
    fn towards(&self) -> Option<Towards> {
        let [x, y, z] = &self.direction;
        let middle = Vec3::from_array(self.axes.map(|axis| axis.direction)).normalize_or_zero();
        let mut cosines = [0.0; POINTS];
        for (i, cosine) in cosines.iter_mut().enumerate() {
            // A little less than it is.
            *cosine = (x[i] * middle.x + y[i] * middle.y + z[i] * middle.z) / self.length[i] - ROUNDING;
        }
        let [cosine, _] = range(&cosines);
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        (cosine > LEAST_COSINE).then_some(Towards { axis: middle.to_array(), cosine, sine })
    }

    /// Whether any ray might enter boxes, by their ranges.
    #[inline(always)]
    fn may_enter(&self, branch: &Branch) -> [bool; WIDE] {
        let (mut near, mut far, mut within) = ([0f32; WIDE], [self.far; WIDE], [true; WIDE]);
        for (k, axis) in self.axes.iter().enumerate() {
            let (low, high) = (branch.min[k].map(|c| c - self.slack), branch.max[k].map(|c| c + self.slack));
            let (low, high) = if axis.backward { (high.map(|c| -c), low.map(|c| -c)) } else { (low, high) };
            match axis.inverse {
                Some([least, greatest]) => {
                    for i in 0..WIDE {
                        let (from, to) = (low[i] - axis.origin[1], high[i] - axis.origin[0]);
                        near[i] = near[i].max(from * if from >= 0.0 { least } else { greatest });
                        far[i] = far[i].min(to * if to >= 0.0 { greatest } else { least });
                    }
                }
                None => {
                    for i in 0..WIDE {
                        within[i] &= (low[i] <= axis.swept[1]) & (high[i] >= axis.swept[0]);
                    }
                }
            }
        }
        std::array::from_fn(|i| within[i] & (near[i] <= far[i] * (1.0 + 4.0 * ROUNDING)))
    }

    /// Which rays of a group may enter one of the boxes.
    #[inline(always)]
    unsafe fn enter<L: Lanes>(&self, branch: &Branch, of: usize, group: usize) -> u32 {
        let mut bits = 0;
        for i in (0..GROUP).step_by(L::COUNT) {
            let lane = GROUP * group + i;
            // SAFETY: as this function.
            unsafe {
                let (mut near, mut far) = (L::splat(0.0), L::splat(self.far));
                for k in 0..3 {
                    let (origin, inverse) =
                        (L::load(&self.origin[k][lane..]), L::load(&self.inverse[k][lane..]));
                    let low = L::splat(branch.min[k][of] - self.slack).sub(origin).mul(inverse);
                    let high = L::splat(branch.max[k][of] + self.slack).sub(origin).mul(inverse);
                    // Where one is not a number, a ray runs in a side of the box: it has no say then.
                    near = low.min(high).max(near);
                    far = low.max(high).min(far);
                }
                let rounding = L::splat(1.0 + ROUNDING);
                bits |= far.mul(rounding).at_least(near).bits() << i;
            }
        }
        bits
    }

    /// Which rays of a group may hit a triangle, and which certainly do: by o + t d = a + u e₁ + v e₂, with bounds of what f32
    /// may be off by.
    #[inline(always)]
    unsafe fn may_hit<L: Lanes>(&self, triangle: &Triangle, group: usize) -> [u32; 2] {
        let [mut possible, mut certain] = [0; 2];
        for i in (0..GROUP).step_by(L::COUNT) {
            let lane = GROUP * group + i;
            // SAFETY: as this function.
            unsafe {
                let Triangle { corner, edges: [e1, e2], normal, size } = triangle;
                let (a, e1, e2, normal) =
                    (splat::<L>(corner), splat::<L>(e1), splat::<L>(e2), splat::<L>(normal));
                let (d, o) = (load::<L>(&self.direction, lane), load::<L>(&self.origin, lane));
                let r = [o[0].sub(a[0]), o[1].sub(a[1]), o[2].sub(a[2])];
                let zero = L::splat(0.0);
                // What a corner from the origin is off by, and its products with the direction and an edge.
                let far =
                    r[0].max(zero.sub(r[0])).add(r[1].max(zero.sub(r[1]))).add(r[2].max(zero.sub(r[2])));
                let off_by = far.mul_add(L::splat(ROUNDING), L::splat(self.slack + ROUNDING));
                let off = off_by.mul(L::load(&self.length[lane..])).mul(L::splat(4.0 * size));
                let c = [
                    r[1].mul(d[2]).sub(r[2].mul(d[1])),
                    r[2].mul(d[0]).sub(r[0].mul(d[2])),
                    r[0].mul(d[1]).sub(r[1].mul(d[0])),
                ];
                let (u, v, det) = (dot(e2, c), zero.sub(dot(e1, c)), zero.sub(dot(d, normal)));
                let back = zero.above(det);
                let turned = |value: L| back.choose(zero.sub(value), value);
                let (u, v, det) = (turned(u), turned(v), turned(det));
                let inside = u.add(off).at_least(zero).and(v.add(off).at_least(zero));
                let inside = inside.and(det.add(off).add(off).at_least(u.add(v)));
                let inside = if self.towards.is_some() {
                    inside.without(back.and(det.above(off.add(off))))
                } else {
                    inside
                };
                if inside.bits() == 0 {
                    continue;
                }
                possible |= inside.bits() << i;
                // t det, which is off by this.
                let t = turned(dot(r, normal));
                let off_t = off_by.mul_add(L::splat(4.0), L::splat(self.close)).mul(L::splat(size * size));
                let on = t.above(off_t).and(det.sub(off).mul(L::splat(self.near_far)).above(t.add(off_t)));
                let inside = u.above(off).and(v.above(off)).and(det.sub(off).sub(off).above(u.add(v)));
                certain |= inside.and(on).bits() << i;
            }
        }
        [possible, possible & certain]
    }
}

/// # Safety
/// As the methods of [`Lanes`].
#[inline(always)]
unsafe fn splat<L: Lanes>(v: &[f32; 3]) -> [L; 3] {
    // SAFETY: as this function.
    unsafe { [L::splat(v[0]), L::splat(v[1]), L::splat(v[2])] }
}

/// # Safety
/// As the methods of [`Lanes`].
#[inline(always)]
unsafe fn load<L: Lanes>(of: &[[f32; POINTS]; 3], lane: usize) -> [L; 3] {
    // SAFETY: as this function.
    unsafe { [L::load(&of[0][lane..]), L::load(&of[1][lane..]), L::load(&of[2][lane..])] }
}

/// # Safety
/// As the methods of [`Lanes`].
#[inline(always)]
unsafe fn dot<L: Lanes>(a: [L; 3], b: [L; 3]) -> L {
    // SAFETY: as this function.
    unsafe { a[0].mul_add(b[0], a[1].mul_add(b[1], a[2].mul(b[2]))) }
}

/// Least and greatest.
#[inline(always)]
fn range(values: &[f32; POINTS]) -> [f32; 2] {
    let (mut low, mut high) = ([f32::INFINITY; GROUP], [f32::NEG_INFINITY; GROUP]);
    for values in values.chunks_exact(GROUP) {
        for (i, value) in values.iter().enumerate() {
            low[i] = if *value < low[i] { *value } else { low[i] };
            high[i] = if *value > high[i] { *value } else { high[i] };
        }
    }
    for half in [4, 2, 1] {
        for i in 0..half {
            low[i] = if low[i + half] < low[i] { low[i + half] } else { low[i] };
            high[i] = if high[i + half] > high[i] { high[i + half] } else { high[i] };
        }
    }
    [low[0], high[0]]
}

#[cfg(test)]
mod tests {
    use super::super::beam::tests::{random, soup};
    use super::*;
    use crate::relativity::Motion;
    use crate::scene::{Camera, Lens, Material, Mesh, Projection, shapes};
    use std::sync::Arc;
    use terrell_geodesic::{Celerity, Event, FourVector, Tetrad};

    /// Rays together, whatever the vectors, are blocked just where one at a time is by any triangle: from a body to itself,
    /// to one in its frame and to moving ones, near and far, ending or not, along an axis or nearly so, some of them left out.
    #[test]
    fn bundles_are_blocked_where_rays_are() {
        let mut random = random(5);
        let mut bundle = Bundle::default();
        let (mut points, mut ways) = (Points::default(), Ways::default());
        let observer = Tetrad::of_world(Event::origin());
        let camera = Camera { observer, lens: Lens::new(Projection::Pinhole, 45.0, 8, 8).unwrap() };
        let [mut blocked, mut free] = [0, 0];
        for (count, scale) in [(1, 1.0), (40, 1e-20), (300, 1.0), (100, 1e12)] {
            let mesh = Arc::new(soup(count, scale, &mut random));
            let tree = Arc::new(Tree::new(&mesh));
            let bodies = [(0.0, 0.3), (0.0, -0.2), (2.0, 4.0), (30.0, 1.0)].into_iter().enumerate();
            let bodies = bodies.map(|(i, (u, place))| {
                let celerity = Celerity::new(DVec3::new(u, -0.5 * u, 0.1 * u)).unwrap();
                let motion = Motion { celerity, origin: Event::at(0.0, DVec3::splat(place) * scale) };
                (i, motion, mesh.clone(), tree.clone())
            });
            let stage = Stage::new(bodies.collect(), &camera, true);
            for round in 0..40 {
                let width = [1.0, 0.05, 1e-4][round % 3];
                let mut point =
                    |reach: f64| DVec3::from_array([0; 3].map(|_| random() - 0.5)) * reach * scale;
                let (from, to) = (point(3.0), point(3.0));
                let number = POINTS - round % 2 * 5;
                for i in 0..POINTS {
                    let way = to + point(width) - (from + point(width));
                    let way = match round % 8 {
                        3 => way * DVec3::X,
                        5 => way * DVec3::new(1.0, 1e-35, 1e-42),
                        _ => way,
                    };
                    let at = from + point(width);
                    let (event, back) = (
                        FourVector::<terrell_geodesic::Rest>::from_parts(-at.length(), at),
                        FourVector::<terrell_geodesic::Rest>::from_parts(-way.length(), way),
                    );
                    points.events[0][i] = event.t;
                    ways.backs[0][i] = back.t;
                    for k in 0..3 {
                        points.events[k + 1][i] = event.xyz()[k];
                        ways.backs[k + 1][i] = back.xyz()[k];
                    }
                    points.faces[i] = (i % count) as u32;
                }
                ways.far = if round % 4 < 2 { 1.0 } else { f64::INFINITY };
                ways.open =
                    (!0 >> (POINTS - number)) & if round % 5 == 4 { 0x0123_4567_89ab_cdef } else { !0 };
                for (from, to) in (0..4).flat_map(|from| (0..4).map(move |to| (from, to))) {
                    let rays = Rays { stage: &stage, points: &points, ways: &ways, from, to };
                    let every = |i: usize| tree.leaves().any(|leaf| rays.ray(i).hits(&leaf));
                    let expected = (0..POINTS)
                        .filter(|&i| ways.open >> i & 1 == 1 && every(i))
                        .fold(0, |bits, i| bits | 1 << i);
                    for vectors in [false, true] {
                        assert_eq!(bundle.blocked_by(&rays, ways.open, vectors), expected);
                    }
                    assert!(bundle.lanes.aim(&rays, ways.open));
                    // SAFETY: needs nothing.
                    let one = unsafe { bundle.blocked_with::<super::super::lanes::One>(&rays, ways.open) };
                    assert_eq!(one, expected);
                    blocked += expected.count_ones();
                    free += (ways.open & !expected).count_ones();
                }
                let [one, all] = [bundle.blocked(&stage, 0, &points, &ways, true), ways.open];
                let any = |i: usize| {
                    (0..4).any(|to| {
                        let rays = Rays { stage: &stage, points: &points, ways: &ways, from: 0, to };
                        tree.leaves().any(|leaf| rays.ray(i).hits(&leaf))
                    })
                };
                assert_eq!(
                    one,
                    (0..POINTS).filter(|&i| all >> i & 1 == 1 && any(i)).fold(0, |b, i| b | 1 << i)
                );
            }
        }
        assert!(blocked > 5000 && free > 10_000, "{blocked} {free}");
    }

    /// Fronts alone say what all triangles say, of points that are seen from outside: of balls and cubes, with normals that lean
    /// or none, turned inside out, seen through their backs or not, and of a patch that lies on one.
    #[test]
    fn fronts_do_where_meshes_are_closed() {
        let mut random = random(8);
        let observer = Tetrad::of_world(Event::origin());
        let camera = Camera { observer, lens: Lens::new(Projection::Pinhole, 45.0, 8, 8).unwrap() };
        let inside_out = |mut mesh: Mesh| {
            mesh.triangles.iter_mut().for_each(|t| t.swap(0, 1));
            mesh
        };
        let smooth = |mut mesh: Mesh| {
            let normal = |i| mesh.vertex(i).normalize().as_vec3().to_array();
            mesh.normals = (0..mesh.vertex_count() as u32).map(normal).collect();
            mesh
        };
        let one_sided = |mut mesh: Mesh| {
            mesh.materials = vec![Material { one_sided: true, ..Material::default() }];
            mesh
        };
        let mut patch = smooth(shapes::sphere(2));
        patch.triangles.truncate(60);
        let room = one_sided(smooth(inside_out(shapes::sphere(2))));
        let meshes = [patch, smooth(shapes::sphere(2)), room, inside_out(shapes::cube()), shapes::cube()];
        let places = [
            (0.0, DVec3::ZERO),
            (0.0, DVec3::ZERO),
            (0.0, DVec3::new(1.3, 0.6, 0.3)),
            (2.0, DVec3::new(-1.0, 0.8, -1.5)),
            (0.5, DVec3::new(0.3, -1.2, -0.8)),
        ];
        let bodies = meshes.into_iter().zip(places).enumerate().map(|(i, (mesh, (u, place)))| {
            let celerity = Celerity::new(DVec3::new(u, -0.2 * u, 0.1 * u)).unwrap();
            let motion = Motion { celerity, origin: Event::at(-5.0, place + DVec3::Z * 6.0) };
            let mesh = Arc::new(mesh);
            (i, motion, mesh.clone(), Arc::new(Tree::new(&mesh)))
        });
        let stage = Stage::new(bodies.collect(), &camera, true);
        let mut bundle = Bundle::default();
        let (mut points, mut ways) = (Points::default(), Ways::default());
        let [mut culled, mut blocked, mut free, mut entering] = [0; 4];
        for round in 0..400 {
            let from = round % 5;
            let target = &stage.targets[from];
            let mut point = || DVec3::from_array([0; 3].map(|_| random() - 0.5));
            let middle = target.map.offset_rest(target.tree.centre) + 1.5 * point();
            // At rest there, now and then far away.
            let lamp = target.map.offset_rest(8.0 * point()) * [1.0, 1.0, 1e3][round % 3];
            (points.mask, ways.open, ways.far) = (0, 0, if round % 7 == 0 { f64::INFINITY } else { 1.0 });
            for i in 0..POINTS {
                let direction = middle + [0.02, 0.5][round % 2] * point();
                let sight = FourVector::from_parts(-direction.length(), direction);
                // The first of all bodies' triangles that is seen.
                let seen = |leaf: &Leaf, target: &Target, direction: DVec3| {
                    let [a, b, c] = leaf.corners.map(|c| target.map.offset_rest(c));
                    let is_front = (b - a).cross(c - a).dot(a) < 0.0;
                    let at = super::super::ray::meet([a, b, c], direction)?;
                    (at > 0.0 && (is_front || !leaf.one_sided)).then_some(at)
                };
                let nearest = (0..5)
                    .flat_map(|index| {
                        let target = &stage.targets[index];
                        let back = stage.between(index, from) * sight;
                        target
                            .tree
                            .leaves()
                            .filter_map(move |leaf| Some((seen(&leaf, target, back.xyz())?, index, leaf)))
                    })
                    .min_by(|a, b| a.0.total_cmp(&b.0));
                let Some((at, index, leaf)) = nearest.filter(|(_, index, _)| *index == from) else {
                    continue;
                };
                assert_eq!(index, from);
                let xyz = direction * at;
                let way = lamp - xyz;
                let [first, ..] = target.mesh.triangles[leaf.face as usize];
                let normal = match target.mesh.normals.get(first as usize) {
                    None => (leaf.corners[1] - leaf.corners[0]).cross(leaf.corners[2] - leaf.corners[0]),
                    Some(normal) => glam::Vec3::from(*normal).as_dvec3(),
                };
                // On the side that is seen.
                let turned = if normal.dot(xyz) > 0.0 { -normal } else { normal };
                if turned.dot(way) <= 0.0 {
                    continue;
                }
                ways.open |= 1 << i;
                points.faces[i] = leaf.face;
                for (k, (at, back)) in xyz.to_array().into_iter().zip(way.to_array()).enumerate() {
                    (points.events[k + 1][i], ways.backs[k + 1][i]) = (at, back);
                }
                (points.events[0][i], ways.backs[0][i]) = (-xyz.length(), -way.length());
            }
            for to in (0..5).filter(|_| ways.open != 0) {
                let rays = Rays { stage: &stage, points: &points, ways: &ways, from, to };
                let tree = &stage.targets[to].tree;
                let every = |i: usize| tree.leaves().any(|leaf| rays.ray(i).hits(&leaf));
                let expected = numbers(ways.open).filter(|i| every(*i)).fold(0, |bits, i| bits | 1 << i);
                for vectors in [false, true] {
                    assert_eq!(bundle.blocked_by(&rays, ways.open, vectors), expected, "{round} {from} {to}");
                }
                if bundle.lanes.towards.is_some() {
                    culled += 1;
                    entering += rays.entering(ways.open).count_ones();
                    blocked += expected.count_ones();
                    free += (ways.open & !expected).count_ones();
                }
            }
        }
        println!("{culled} {blocked} {free} {entering}");
        assert!(
            culled > 200 && blocked > 500 && free > 2000 && entering > 50,
            "{culled} {blocked} {free} {entering}"
        );
    }
}
