//! Rays of neighbouring pixels, which begin in one point, together.

use super::origin::Origin;
use super::tree::{Leaf, Node, Tree};
use glam::DVec3;

/// The most rays of a beam.
pub(super) const RAYS: usize = 64;

/// Rays the processor's vectors are filled with at a time.
const LANES: usize = 8;

/// Nothing found.
pub(super) const NONE: u32 = u32::MAX;

/// Rays from one point whose directions have the same longest component, so that they are points of a plane: slopes
/// (u, v), the longest component being 1.
///
/// A box is met by none of them if it is outside their range of slopes. A triangle is three planes through the origin:
/// its edge functions are formed in f64 for the middle of the beam, and in f32 only for how far a ray is from that, so
/// that they are as exact as f32 is for *parts of the beam*, however large the triangle, however far it is, and however
/// narrow the beam.
pub(super) struct Beam {
    /// The longest component, and the two others.
    order: [usize; 3],
    /// Of the longest component.
    sign: f64,
    /// Slopes.
    slopes: [[f64; RAYS]; 2],
    middle: [f64; 2],
    /// Least and greatest slopes.
    range: [[f64; 2]; 2],
    lanes: Lanes,
    /// How many there are, filled up to whole vectors.
    count: usize,
    stack: Vec<(u32, f64)>,
    pub tested: Tested,
}

/// How much work it was.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tested {
    pub boxes: u64,
    pub triangles: u64,
}

#[repr(align(64))]
struct Lanes {
    /// Slopes from the middle.
    from_middle: [[f32; RAYS]; 2],
    /// 1/t of the nearest hit, t along the longest component.
    nearness: [f32; RAYS],
    found: [u32; RAYS],
}

/// A triangle as a beam meets it: functions c + a·u + b·v of slopes from the middle.
struct Edges {
    /// Positive inside, all three.
    edges: [[f32; 3]; 3],
    /// Where the edge itself belongs to the triangle 0, else the least number above.
    least: [f32; 3],
    /// 1/t.
    nearness: [f32; 3],
}

/// Hits that differ by less, relative, are compared in f64: f32 is good to a few 10⁻⁷.
const CLOSE: f32 = 2e-6;

impl Default for Beam {
    fn default() -> Self {
        Self {
            order: [0, 1, 2],
            sign: 1.0,
            slopes: [[0.0; RAYS]; 2],
            middle: [0.0; 2],
            range: [[0.0; 2]; 2],
            lanes: Lanes { from_middle: [[0.0; RAYS]; 2], nearness: [0.0; RAYS], found: [NONE; RAYS] },
            count: 0,
            stack: Vec::new(),
            tested: Tested::default(),
        }
    }
}

/// The longest component of a direction, and its sign: rays that agree in it can be one beam.
#[inline]
pub(super) fn facing(direction: DVec3) -> (usize, bool) {
    let size = direction.abs();
    let longest = if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    };
    (longest, direction[longest] < 0.0)
}

/// a·b + c, in one step where the processor has one.
#[inline(always)]
fn fused<const FMA: bool>(a: f32, b: f32, c: f32) -> f32 {
    if FMA { a.mul_add(b, c) } else { a * b + c }
}

impl Beam {
    /// Makes it the beam of these rays, which all face the same way. `nearest` gives for each of them 1/s of what is
    /// known to be hit by others, s in units of its direction; 0 for nothing.
    pub fn aim(
        &mut self,
        (longest, backward): (usize, bool),
        rays: impl Iterator<Item = (DVec3, f64)>,
        tree: &Tree,
        origin: &Origin<'_>,
    ) {
        let unit = tree.scale * inverse_unit(origin.place(tree).0);
        self.order = [longest, (longest + 1) % 3, (longest + 2) % 3];
        self.sign = if backward { -1.0 } else { 1.0 };
        self.range = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        let mut count = 0;
        for (direction, nearest) in rays {
            let along = direction[longest].abs();
            for k in 0..2 {
                let slope = direction[self.order[k + 1]] / along;
                self.slopes[k][count] = slope;
                self.range[k] = [self.range[k][0].min(slope), self.range[k][1].max(slope)];
            }
            // A little farther, so that what is as near is found, too, and can be compared exactly.
            let nearness = nearest / (along * unit);
            self.lanes.nearness[count] = (nearness * (1.0 - f64::from(CLOSE))) as f32;
            self.lanes.found[count] = NONE;
            count += 1;
        }
        self.middle = self.range.map(|[low, high]| 0.5 * (low + high));
        let whole = count.next_multiple_of(LANES);
        for k in 0..2 {
            for i in 0..count {
                self.lanes.from_middle[k][i] = (self.slopes[k][i] - self.middle[k]) as f32;
            }
            self.lanes.from_middle[k][count..whole].fill(0.0);
        }
        // They hit nothing.
        self.lanes.nearness[count..whole].fill(f32::INFINITY);
        self.count = whole;
        for [low, high] in &mut self.range {
            *low -= 4.0 * f64::EPSILON * (1.0 + low.abs());
            *high += 4.0 * f64::EPSILON * (1.0 + high.abs());
        }
    }

    /// What the ray of this number hit: a leaf of the tree.
    pub fn found(&self, ray: usize) -> u32 {
        self.lanes.found[ray]
    }

    /// Looks for the nearest triangle for each ray.
    pub fn trace(&mut self, tree: &Tree, origin: &Origin<'_>, vectors: bool) {
        #[cfg(target_arch = "x86_64")]
        if vectors && is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
            // SAFETY: the processor has both.
            return unsafe { self.trace_avx2(tree, origin) };
        }
        let _ = vectors;
        self.trace_with::<false>(tree, origin);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma")]
    fn trace_avx2(&mut self, tree: &Tree, origin: &Origin<'_>) {
        self.trace_with::<true>(tree, origin);
    }

    #[inline(always)]
    fn trace_with<const FMA: bool>(&mut self, tree: &Tree, origin: &Origin<'_>) {
        let (place, slack) = origin.place(tree);
        let unit = tree.scale * inverse_unit(place);
        let boxes = Boxes::new(self, place, slack);
        let mut farthest = self.farthest(place);
        let mut stack = std::mem::take(&mut self.stack);
        stack.clear();
        if let Some(near) = tree.nodes.first().and_then(|root| boxes.enters(root)) {
            stack.push((0, near));
        }
        while let Some((index, near)) = stack.pop() {
            if near > farthest {
                continue;
            }
            let node = &tree.nodes[index as usize];
            if node.count == 0 {
                self.tested.boxes += 2;
                let first = node.first;
                let [a, b] = [0, 1].map(|k| boxes.enters(&tree.nodes[(first + k) as usize]));
                match (a, b) {
                    // The nearer one on top.
                    (Some(a), Some(b)) if a <= b => stack.extend([(first + 1, b), (first, a)]),
                    (Some(a), Some(b)) => stack.extend([(first, a), (first + 1, b)]),
                    (Some(a), None) => stack.push((first, a)),
                    (None, Some(b)) => stack.push((first + 1, b)),
                    (None, None) => {}
                }
                continue;
            }
            let mut any = false;
            for number in node.first..node.first + node.count {
                self.tested.triangles += 1;
                let leaf = &tree.leaves[number as usize];
                let corners = leaf.corners.map(|c| self.turned(origin.to(c) * unit));
                let Some(edges) = self.edges(corners, leaf.one_sided) else { continue };
                let (nearer, doubtful) = self.meet::<FMA>(&edges, number);
                any |= nearer;
                if doubtful {
                    any |= self.settle(tree, origin, unit, &edges, number);
                }
            }
            if any {
                farthest = self.farthest(place);
            }
        }
        self.stack = stack;
    }

    /// The farthest any ray still has to look, in the tree's units.
    #[inline(always)]
    fn farthest(&self, place: DVec3) -> f64 {
        let least = self.lanes.nearness[..self.count].iter().copied().fold(f32::INFINITY, f32::min);
        // f32 may be off by some 10⁻⁷.
        (1.0 + f64::from(CLOSE)) / (f64::from(least) * inverse_unit(place))
    }

    /// Components in the beam's order, the longest positive.
    #[inline(always)]
    fn turned(&self, v: DVec3) -> DVec3 {
        DVec3::new(self.sign * v[self.order[0]], v[self.order[1]], v[self.order[2]])
    }

    /// Of corners as [`turned`](Self::turned), which keeps or changes their winding with the sign; none for a triangle
    /// seen edge-on or from the back it does not have, or one no ray of the beam can hit.
    #[inline(always)]
    fn edges(&self, [a, b, c]: [DVec3; 3], one_sided: bool) -> Option<Edges> {
        let planes = [b.cross(c), c.cross(a), a.cross(b)];
        let volume = a.dot(planes[0]);
        // Also false for NaN.
        if !(volume.abs() > 0.0 && volume < f64::INFINITY) {
            return None;
        }
        if one_sided && volume * self.sign >= 0.0 {
            return None;
        }
        let flip = if volume < 0.0 { -1.0 } else { 1.0 };
        let [u0, v0] = self.middle;
        let half = [0, 1].map(|k| 0.5 * (self.range[k][1] - self.range[k][0]));
        let mut edges = [[0.0; 3]; 3];
        let mut least = [0.0; 3];
        for (i, plane) in planes.iter().enumerate() {
            let m = *plane * flip;
            let middle = m.x + (m.y * u0 + m.z * v0);
            // By more than f32 leaves over.
            if middle + (m.y.abs() * half[0] + m.z.abs() * half[1]) * 1.000_001 < 0.0 {
                return None;
            }
            edges[i] = [middle as f32, m.y as f32, m.z as f32];
            least[i] = if owns(m) { 0.0 } else { f32::from_bits(1) };
        }
        let normal = (b - a).cross(c - a);
        let over = 1.0 / normal.dot(a);
        if !over.is_finite() {
            return None;
        }
        let nearness = [normal.x + (normal.y * u0 + normal.z * v0), normal.y, normal.z];
        Some(Edges { edges, least, nearness: nearness.map(|n| (n * over) as f32) })
    }

    /// Tests all rays; whether any is hit nearer than before, and whether any cannot be told in f32.
    #[inline(always)]
    fn meet<const FMA: bool>(&mut self, triangle: &Edges, number: u32) -> (bool, bool) {
        let Lanes { from_middle: [du, dv], nearness, found } = &mut self.lanes;
        let (mut any, mut doubtful) = (0u32, 0u32);
        let count = self.count;
        let rays = du[..count].chunks_exact(LANES).zip(dv[..count].chunks_exact(LANES));
        let hits = nearness[..count].chunks_exact_mut(LANES).zip(found[..count].chunks_exact_mut(LANES));
        for ((du, dv), (nearness, found)) in rays.zip(hits) {
            for i in 0..LANES {
                let at = |[c, u, v]: [f32; 3]| fused::<FMA>(u, du[i], fused::<FMA>(v, dv[i], c));
                let inside = u32::from(at(triangle.edges[0]) >= triangle.least[0])
                    & u32::from(at(triangle.edges[1]) >= triangle.least[1])
                    & u32::from(at(triangle.edges[2]) >= triangle.least[2]);
                let near = at(triangle.nearness);
                let known = nearness[i];
                let nearer = inside & u32::from(near > known * (1.0 + CLOSE));
                let close = inside & u32::from(near >= known * (1.0 - CLOSE)) & (1 - nearer);
                nearness[i] = if nearer != 0 { near } else { known };
                found[i] = if nearer != 0 { number } else { found[i] };
                any |= nearer;
                doubtful |= close;
            }
        }
        (any != 0, doubtful != 0)
    }

    /// For rays that two triangles are as near to as f32 can tell: compares them in f64.
    #[cold]
    fn settle(&mut self, tree: &Tree, origin: &Origin<'_>, unit: f64, triangle: &Edges, number: u32) -> bool {
        let mut any = false;
        for i in 0..self.count {
            let [du, dv] = self.lanes.from_middle.map(|d| f64::from(d[i]));
            let at = |[c, u, v]: [f32; 3]| f64::from(u) * du + (f64::from(v) * dv + f64::from(c));
            let inside = (0..3).all(|k| at(triangle.edges[k]) >= f64::from(triangle.least[k]));
            let known = f64::from(self.lanes.nearness[i]);
            if !inside || (at(triangle.nearness) - known).abs() > 2.0 * f64::from(CLOSE) * known {
                continue;
            }
            let exact = |number: u32| self.nearness(&tree.leaves[number as usize], origin, unit, i);
            let (new, old) = (exact(number), self.lanes.found[i]);
            let face = |number: u32| tree.leaves[number as usize].face;
            if old == NONE || is_before((new, face(number)), (exact(old), face(old))) {
                self.lanes.nearness[i] = self.lanes.nearness[i].max(new as f32);
                self.lanes.found[i] = number;
                any = true;
            }
        }
        any
    }

    /// 1/t in f64.
    fn nearness(&self, leaf: &Leaf, origin: &Origin<'_>, unit: f64, ray: usize) -> f64 {
        let [a, b, c] = leaf.corners.map(|c| self.turned(origin.to(c) * unit));
        let normal = (b - a).cross(c - a);
        normal.dot(DVec3::new(1.0, self.slopes[0][ray], self.slopes[1][ray])) / normal.dot(a)
    }
}

/// Whether a hit, by 1/s, is the one that is seen of two; where both are in one place, the first of the mesh is.
#[inline]
fn is_before(new: (f64, u32), old: (f64, u32)) -> bool {
    if (new.0 - old.0).abs() <= SAME * old.0 { new.1 < old.1 } else { new.0 > old.0 }
}

/// Nearer to each other, relative, two surfaces are in one place: what f64 leaves over of a plane seen at an angle.
pub(super) const SAME: f64 = 1e-12;

/// Of two triangles at an edge, one owns it.
#[inline(always)]
pub(super) fn owns(m: DVec3) -> bool {
    if m.x != 0.0 {
        m.x > 0.0
    } else if m.y != 0.0 {
        m.y > 0.0
    } else {
        m.z > 0.0
    }
}

/// Far away, lengths are counted in units of the distance, so that squares of them stay within f32.
#[inline(always)]
pub(super) fn inverse_unit(place: DVec3) -> f64 {
    1.0 / (1.0 + place.abs().max_element())
}

/// How a beam meets boxes.
struct Boxes {
    order: [usize; 3],
    backward: bool,
    /// In the beam's order, the tree's units.
    place: [f64; 3],
    slack: f64,
    range: [[f64; 2]; 2],
}

impl Boxes {
    fn new(beam: &Beam, place: DVec3, slack: f64) -> Self {
        Self {
            order: beam.order,
            backward: beam.sign < 0.0,
            place: beam.order.map(|k| place[k]),
            slack,
            range: beam.range,
        }
    }

    /// How near along the longest component a box begins; none if no ray can meet it.
    #[inline(always)]
    fn enters(&self, node: &Node) -> Option<f64> {
        let side = |i: usize| {
            let k = self.order[i];
            let low = f64::from(node.min[k]) - self.place[i] - self.slack;
            let high = f64::from(node.max[k]) - self.place[i] + self.slack;
            [low, high]
        };
        let [low, high] = side(0);
        let [near, far] = if self.backward { [-high, -low] } else { [low, high] };
        if far < 0.0 {
            return None;
        }
        let near = near.max(0.0);
        for k in 0..2 {
            let [low, high] = side(k + 1);
            let [least, greatest] = self.range[k];
            let least = if least >= 0.0 { least * near } else { least * far };
            let greatest = if greatest >= 0.0 { greatest * far } else { greatest * near };
            if high < least || low > greatest {
                return None;
            }
        }
        Some(near)
    }
}
