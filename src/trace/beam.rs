//! Rays of neighbouring pixels, which begin in one point, together.

use super::directed::Directed;
use super::edges::{Each, EachNarrow, Several, TOGETHER, Window};
use super::lanes::Lanes;
#[cfg(target_arch = "x86_64")]
use super::lanes::x86;
use super::origin::Origin;
use super::tree::{Branch, EachBox, Leaf, Part, Tree, WIDE};
use crate::light::numbers;
use glam::DVec3;

/// The most rays of a beam.
pub(super) const RAYS: usize = 64;

/// The widest vectors there are.
const WIDEST: usize = 8;

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
    rays: Rays,
    /// How many there are, filled up to whole vectors.
    count: usize,
    stack: Vec<Part>,
    ties: Vec<Tie>,
}

/// Rays that a triangle is as near to as another, as far as f32 can tell.
#[derive(Clone, Copy)]
struct Tie {
    /// Of the leaf.
    number: u32,
    /// A bit for each.
    rays: u64,
    /// 1/t, as [`Several`] has it.
    nearness: [f32; 3],
}

#[repr(align(64))]
struct Rays {
    /// Slopes from the middle.
    from_middle: [[f32; RAYS]; 2],
    /// 1/t of the nearest hit, t along the longest component.
    nearness: [f32; RAYS],
    /// Number of the leaf, as bits.
    found: [f32; RAYS],
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
            rays: Rays {
                from_middle: [[0.0; RAYS]; 2],
                nearness: [0.0; RAYS],
                found: [f32::from_bits(NONE); RAYS],
            },
            count: 0,
            stack: Vec::new(),
            ties: Vec::new(),
        }
    }
}

impl Beam {
    /// Makes it the beam of these rays, which all face the same way.
    #[inline(always)]
    fn aim(&mut self, way: (usize, bool), rays: &Directed, tree: &Tree, origin: &Origin<'_>) {
        let (longest, backward) = way;
        let inverse_unit = 1.0 / (tree.scale * inverse_unit(origin.place(tree).0));
        self.order = [longest, (longest + 1) % 3, (longest + 2) % 3];
        self.sign = if backward { -1.0 } else { 1.0 };
        let [along, first, second] = self.order;
        let (count, whole) = (rays.count, rays.count.next_multiple_of(WIDEST));
        // Loops of plain arithmetic, which compilers make vectors of.
        let mut inverse = [1.0; RAYS];
        for (inverse, along) in inverse[..count].iter_mut().zip(&rays.directions[along]) {
            *inverse = 1.0 / along.abs();
        }
        let mut range = [[0.0; 2]; 2];
        for (k, component) in [first, second].into_iter().enumerate() {
            let slopes = &mut self.slopes[k];
            for (i, across) in rays.directions[component][..count].iter().enumerate() {
                slopes[i] = across * inverse[i];
            }
            // What is not a ray is as the first.
            let one = slopes[0];
            slopes[count..whole].fill(one);
            range[k] = least_and_greatest(&slopes[..whole]);
        }
        // A little farther, so that what is as near is found, too, and can be compared exactly.
        let farther = inverse_unit * (1.0 - f64::from(CLOSE));
        for (i, nearness) in self.rays.nearness[..count].iter_mut().enumerate() {
            *nearness = (rays.nearness[i] * inverse[i] * farther) as f32;
        }
        self.rays.found[..whole].fill(f32::from_bits(NONE));
        // They hit nothing.
        self.rays.nearness[count..whole].fill(f32::INFINITY);
        for (k, [low, high]) in range.into_iter().enumerate() {
            let middle = 0.5 * (low + high);
            let from_middle = &mut self.rays.from_middle[k];
            for (from, slope) in from_middle[..count].iter_mut().zip(&self.slopes[k]) {
                *from = (slope - middle) as f32;
            }
            from_middle[count..whole].fill(0.0);
            self.middle[k] = middle;
            let rounding = 4.0 * f64::EPSILON;
            self.range[k] = [low - rounding * (1.0 + low.abs()), high + rounding * (1.0 + high.abs())];
        }
        self.count = whole;
    }

    /// What the ray of this number hit: a leaf of the tree.
    pub fn found(&self, ray: usize) -> u32 {
        self.rays.found[ray].to_bits()
    }

    /// Looks for the nearest triangle for each of some rays that face the same way: among these `leaves`, or, if it is not
    /// known which may be met, through the tree. With AVX2 if `vectors` and there is such.
    pub fn trace(
        &mut self,
        way: (usize, bool),
        rays: &Directed,
        tree: &Tree,
        leaves: Option<&[u32]>,
        origin: &Origin<'_>,
        vectors: bool,
    ) {
        #[cfg(target_arch = "x86_64")]
        {
            if vectors && crate::processor::has_avx2() {
                // SAFETY: the processor has both.
                unsafe { self.trace_avx2(way, rays, tree, leaves, origin) }
            } else {
                // SAFETY: every x86-64 processor has SSE2.
                unsafe { self.trace_with::<x86::Sse2>(way, rays, tree, leaves, origin) }
            }
        }
        #[cfg(not(target_arch = "x86_64"))]
        {
            let _ = vectors;
            // SAFETY: needs nothing.
            unsafe { self.trace_with::<super::lanes::One>(way, rays, tree, leaves, origin) }
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma")]
    fn trace_avx2(
        &mut self,
        way: (usize, bool),
        rays: &Directed,
        tree: &Tree,
        leaves: Option<&[u32]>,
        origin: &Origin<'_>,
    ) {
        // SAFETY: the caller has made sure.
        unsafe { self.trace_with::<x86::Avx2>(way, rays, tree, leaves, origin) }
    }

    #[inline(always)]
    unsafe fn trace_with<L: Lanes>(
        &mut self,
        way: (usize, bool),
        rays: &Directed,
        tree: &Tree,
        leaves: Option<&[u32]>,
        origin: &Origin<'_>,
    ) {
        self.aim(way, rays, tree, origin);
        let (place, slack) = origin.place(tree);
        let unit = tree.scale * inverse_unit(place);
        if let Some(leaves) = leaves {
            for numbers in leaves.chunks(TOGETHER) {
                // SAFETY: as this function.
                unsafe { self.meet_leaves::<L>(tree, origin, unit, numbers) };
            }
            self.settle(tree, origin, unit);
            return;
        }
        let boxes = Boxes::new(self, place, slack);
        let mut farthest = self.farthest(place);
        let mut stack = std::mem::take(&mut self.stack);
        stack.clear();
        stack.extend(tree.root().map(|inside| Part { near: 0.0, inside }));
        // Leaves that wait for others.
        let (mut waiting, mut count) = ([0; TOGETHER], 0);
        while let Some(Part { near, inside }) = stack.pop() {
            if near > farthest {
                continue;
            }
            let leaves = match tree.look(inside) {
                Ok(branch) => {
                    let (near, met) = boxes.enter(branch);
                    tree.push(branch, &near, met, &mut stack);
                    continue;
                }
                Err(leaves) => leaves,
            };
            for number in leaves {
                waiting[count] = number;
                count += 1;
                if count == TOGETHER {
                    count = 0;
                    // SAFETY: as this function.
                    if unsafe { self.meet_leaves::<L>(tree, origin, unit, &waiting) } {
                        farthest = self.farthest(place);
                    }
                }
            }
        }
        // SAFETY: as this function.
        unsafe { self.meet_leaves::<L>(tree, origin, unit, &waiting[..count]) };
        self.stack = stack;
        self.settle(tree, origin, unit);
    }

    /// Whether any of some leaves, up to [`TOGETHER`], is nearer to any ray than what is known.
    #[inline(always)]
    unsafe fn meet_leaves<L: Lanes>(
        &mut self,
        tree: &Tree,
        origin: &Origin<'_>,
        unit: f64,
        numbers: &[u32],
    ) -> bool {
        let mut corners = [[Each::default(); 3]; 3];
        let mut one_sided = [false; TOGETHER];
        for (i, number) in numbers.iter().enumerate() {
            let leaf = tree.leaf(*number);
            one_sided[i] = leaf.one_sided;
            for (of_all, corner) in corners.iter_mut().zip(leaf.corners) {
                let corner = self.turned(origin.to(corner) * unit);
                (of_all[0][i], of_all[1][i], of_all[2][i]) = (corner.x, corner.y, corner.z);
            }
        }
        let several = Several::new(&corners, one_sided, &self.window());
        let mut any = false;
        for (i, number) in numbers.iter().enumerate() {
            if several.is_met[i] {
                // SAFETY: as this function.
                let (nearer, rays) = unsafe { self.meet::<L>(&several, i, *number) };
                any |= nearer;
                if rays != 0 {
                    let nearness = several.nearness.each_ref().map(|c| c[i]);
                    self.ties.push(Tie { number: *number, rays, nearness });
                }
            }
        }
        any
    }

    /// The farthest any ray still has to look, in the tree's units.
    #[inline(always)]
    fn farthest(&self, place: DVec3) -> f64 {
        let mut least = [f32::INFINITY; WIDEST];
        for values in self.rays.nearness[..self.count].chunks_exact(WIDEST) {
            for (least, value) in least.iter_mut().zip(values) {
                *least = if *value < *least { *value } else { *least };
            }
        }
        for half in [4, 2, 1] {
            for i in 0..half {
                least[i] = if least[i + half] < least[i] { least[i + half] } else { least[i] };
            }
        }
        // f32 may be off by some 10⁻⁷.
        (1.0 + f64::from(CLOSE)) / (f64::from(least[0]) * inverse_unit(place))
    }

    /// Components in the beam's order, the longest positive.
    #[inline(always)]
    fn turned(&self, v: DVec3) -> DVec3 {
        DVec3::new(self.sign * v[self.order[0]], v[self.order[1]], v[self.order[2]])
    }

    #[inline(always)]
    fn window(&self) -> Window {
        let half = [0.5 * (self.range[0][1] - self.range[0][0]), 0.5 * (self.range[1][1] - self.range[1][0])];
        Window { sign: self.sign, middle: self.middle, half }
    }

    /// Tests all rays; whether any is hit nearer than before, and which cannot be told in f32: a bit for each.
    #[inline(always)]
    unsafe fn meet<L: Lanes>(&mut self, several: &Several, which: usize, number: u32) -> (bool, u64) {
        let Rays { from_middle: [du, dv], nearness, found } = &mut self.rays;
        // SAFETY: as this function; there are whole vectors of rays.
        unsafe {
            let splat =
                |f: &[EachNarrow; 3]| [L::splat(f[0][which]), L::splat(f[1][which]), L::splat(f[2][which])];
            let least = splat(&several.least);
            let [e0, e1, e2] = &several.functions;
            let [e0, e1, e2] = [splat(e0), splat(e1), splat(e2)];
            let near = splat(&several.nearness);
            let (above, below) = (L::splat(1.0 + CLOSE), L::splat(1.0 - CLOSE));
            let number = L::splat(f32::from_bits(number));
            let (mut any, mut doubtful) = (0, 0u64);
            for i in (0..self.count).step_by(L::COUNT) {
                let (u, v) = (L::load(&du[i..]), L::load(&dv[i..]));
                let inside = at(&e0, u, v)
                    .at_least(least[0])
                    .and(at(&e1, u, v).at_least(least[1]))
                    .and(at(&e2, u, v).at_least(least[2]));
                if inside.bits() == 0 {
                    continue;
                }
                let known = L::load(&nearness[i..]);
                let near = at(&near, u, v);
                let nearer = inside.and(near.above(known.mul(above)));
                let close = inside.and(near.at_least(known.mul(below))).without(nearer);
                nearer.choose(near, known).store(&mut nearness[i..]);
                nearer.choose(number, L::load(&found[i..])).store(&mut found[i..]);
                any |= nearer.bits();
                doubtful |= u64::from(close.bits()) << i;
            }
            (any != 0, doubtful)
        }
    }

    /// Compares in f64 what rays are as near to as f32 can tell, if nothing else turned out to be nearer.
    fn settle(&mut self, tree: &Tree, origin: &Origin<'_>, unit: f64) {
        let ties = std::mem::take(&mut self.ties);
        for Tie { number, rays, nearness: [c, a, b] } in ties.iter().copied() {
            for i in numbers(rays) {
                let near = c + a * self.rays.from_middle[0][i] + b * self.rays.from_middle[1][i];
                if near > self.rays.nearness[i] * (1.0 - 2.0 * CLOSE) {
                    self.compare(tree, origin, unit, number, i);
                }
            }
        }
        self.ties = ties;
        self.ties.clear();
    }

    /// Lets a ray see this leaf, if it does rather than what it has found: in f64.
    #[cold]
    #[inline(never)]
    fn compare(&mut self, tree: &Tree, origin: &Origin<'_>, unit: f64, number: u32, ray: usize) {
        let exact = |number: u32| self.nearness(&tree.leaf(number), origin, unit, ray);
        let face = |number: u32| tree.leaf(number).face;
        let (new, old) = (exact(number), self.found(ray));
        if old == NONE || is_before((new, face(number)), (exact(old), face(old))) {
            self.rays.nearness[ray] = self.rays.nearness[ray].max(new as f32);
            self.rays.found[ray] = f32::from_bits(number);
        }
    }

    /// 1/t in f64.
    fn nearness(&self, leaf: &Leaf, origin: &Origin<'_>, unit: f64, ray: usize) -> f64 {
        let [a, b, c] = leaf.corners.map(|c| self.turned(origin.to(c) * unit));
        let normal = (b - a).cross(c - a);
        normal.dot(DVec3::new(1.0, self.slopes[0][ray], self.slopes[1][ray])) / normal.dot(a)
    }
}

/// Of numbers in whole vectors.
#[inline(always)]
fn least_and_greatest(values: &[f64]) -> [f64; 2] {
    let (mut low, mut high) = ([f64::INFINITY; WIDEST], [f64::NEG_INFINITY; WIDEST]);
    for values in values.chunks_exact(WIDEST) {
        for (i, value) in values.iter().enumerate() {
            low[i] = if *value < low[i] { *value } else { low[i] };
            high[i] = if *value > high[i] { *value } else { high[i] };
        }
    }
    let least = |a: f64, b: f64| if b < a { b } else { a };
    let greatest = |a: f64, b: f64| if b > a { b } else { a };
    [low.into_iter().fold(f64::INFINITY, least), high.into_iter().fold(f64::NEG_INFINITY, greatest)]
}

/// c + a·u + b·v.
///
/// # Safety
/// As the methods of [`Lanes`].
#[inline(always)]
unsafe fn at<L: Lanes>([c, a, b]: &[L; 3], u: L, v: L) -> L {
    // SAFETY: as this function.
    unsafe { a.mul_add(u, b.mul_add(v, *c)) }
}

/// Whether a hit, by 1/s, is the one that is seen of two; where both are in one place, the first of the mesh is.
#[inline]
fn is_before(new: (f64, u32), old: (f64, u32)) -> bool {
    if (new.0 - old.0).abs() <= SAME * old.0 { new.1 < old.1 } else { new.0 > old.0 }
}

/// Nearer to each other, relative, two surfaces are in one place: what f64 leaves over of a plane seen at an angle.
pub(super) const SAME: f64 = 1e-12;

/// Far away, lengths are counted in units of the distance, so that squares of them stay within f32.
#[inline(always)]
pub(super) fn inverse_unit(place: DVec3) -> f64 {
    1.0 / (1.0 + place.abs().max_element())
}

/// How a beam meets boxes.
struct Boxes {
    order: [usize; 3],
    backward: bool,
    /// Where the rays begin, in the beam's order and the tree's units.
    low: [f64; 3],
    /// As `low`; both a little outward.
    high: [f64; 3],
    range: [[f64; 2]; 2],
}

impl Boxes {
    fn new(beam: &Beam, place: DVec3, slack: f64) -> Self {
        Self {
            order: beam.order,
            backward: beam.sign < 0.0,
            low: beam.order.map(|k| place[k] + slack),
            high: beam.order.map(|k| place[k] - slack),
            range: beam.range,
        }
    }

    /// How near along the longest component each box begins, and which a ray may meet. In loops of plain arithmetic, which
    /// compilers make vectors of.
    #[inline(always)]
    fn enter(&self, branch: &Branch) -> (EachBox, [bool; WIDE]) {
        let from = |of: &[[f32; WIDE]; 3], place: &[f64; 3], k: usize| {
            of[self.order[k]].map(|c| f64::from(c) - place[k])
        };
        let (low, high) = (from(&branch.min, &self.low, 0), from(&branch.max, &self.high, 0));
        let (begin, far) = if self.backward { (high.map(|v| -v), low.map(|v| -v)) } else { (low, high) };
        let near = begin.map(|v| if v > 0.0 { v } else { 0.0 });
        let mut met = far.map(|v| v >= 0.0);
        for k in 0..2 {
            let (low, high) = (from(&branch.min, &self.low, k + 1), from(&branch.max, &self.high, k + 1));
            let [least, greatest] = self.range[k];
            let (at_least, at_greatest) =
                (if least >= 0.0 { &near } else { &far }, if greatest >= 0.0 { &far } else { &near });
            for i in 0..WIDE {
                met[i] &= (high[i] >= least * at_least[i]) & (low[i] <= greatest * at_greatest[i]);
            }
        }
        (near, met)
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::directed::facing;
    use super::super::ray::meet;
    use super::*;
    use crate::relativity::{ApparentMap, Motion};
    use crate::scene::Mesh;
    use terrell_geodesic::{Celerity, Event, Tetrad};

    pub fn random(seed: u64) -> impl FnMut() -> f64 {
        let mut state = seed;
        move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 33) as f64 + 0.5) / f64::from(1u32 << 31)
        }
    }

    /// Triangles anywhere in a box, small and large, some without area.
    pub fn soup(count: usize, scale: f64, random: &mut impl FnMut() -> f64) -> Mesh {
        let mut vertices = Vec::new();
        for i in 0..count {
            let mut point = |reach: f64| DVec3::from_array([0; 3].map(|_| random() - 0.5)) * reach * scale;
            let (middle, size) = (point(2.0), [1.0, 0.1, 0.01][i % 3]);
            let a = middle + point(size);
            let b = middle + point(size);
            vertices.extend([a, b, if i % 17 == 16 { a } else { middle + point(size) }]);
        }
        Mesh::new(&vertices, (0..count as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect())
    }

    /// Observers near, far and fast.
    pub fn maps(scale: f64) -> Vec<ApparentMap> {
        [(0.0, [0.3, 0.1, -0.2]), (2.0, [4.0, 1.0, 2.0]), (1e3, [-30.0, 200.0, 7.0])]
            .into_iter()
            .map(|(u, place)| {
                let celerity = Celerity::new(DVec3::new(u, -0.5 * u, 0.1 * u)).unwrap();
                let at = DVec3::from_array(place) * scale;
                ApparentMap::new(
                    &Motion { celerity, origin: Event::at(0.0, at) },
                    &Tetrad::of_world(Event::origin()),
                )
            })
            .collect()
    }

    /// Beams, whatever the vectors, hit what every triangle tried in f64 says.
    #[test]
    fn beams_hit_what_rays_hit() {
        let mut random = random(3);
        let mut beam = Beam::default();
        let [mut hits, mut differ] = [0; 2];
        for (count, scale) in [(1, 1.0), (40, 1e-20), (300, 1.0), (100, 1e12)] {
            let mesh = soup(count, scale, &mut random);
            let tree = Tree::new(&mesh);
            for map in maps(scale) {
                let origin = Origin::of_observer(&map);
                for _ in 0..40 {
                    let mut point = |reach: f64| DVec3::from_array([0; 3].map(|_| random() - 0.5)) * reach;
                    let towards = origin.to(point(2.0) * scale) / scale;
                    let width = [0.5, 0.02, 1e-5][hits % 3];
                    let mut rays = Directed::default();
                    (0..50)
                        .map(|_| towards + point(width))
                        .filter(|direction| facing(*direction) == facing(towards))
                        .for_each(|direction| rays.push(direction, 0.0));
                    if rays.count == 0 {
                        continue;
                    }
                    assert_eq!(rays.facing(), Some(facing(towards)));
                    let expected: Vec<Option<(f64, u32)>> = (0..rays.count)
                        .map(|ray| {
                            let hit = |leaf: &Leaf| {
                                let corners = leaf.corners.map(|c| origin.to(c) / scale);
                                let at = meet(corners, rays.direction(ray)).filter(|at| *at > 0.0)?;
                                Some((at, leaf.face))
                            };
                            tree.leaves().filter_map(|leaf| hit(&leaf)).min_by(|a, b| a.0.total_cmp(&b.0))
                        })
                        .collect();
                    for kind in 0..3 {
                        let way = facing(towards);
                        match kind {
                            0 => beam.trace(way, &rays, &tree, None, &origin, true),
                            1 => beam.trace(way, &rays, &tree, None, &origin, false),
                            // SAFETY: needs nothing.
                            _ => unsafe {
                                beam.trace_with::<super::super::lanes::One>(way, &rays, &tree, None, &origin);
                            },
                        }
                        for (i, expected) in expected.iter().enumerate() {
                            let found = beam.found(i);
                            let face = (found != NONE).then(|| tree.leaf(found).face);
                            hits += usize::from(face.is_some());
                            differ += usize::from(face != expected.map(|(_, face)| face));
                        }
                    }
                }
            }
        }
        // Where a ray runs in an edge to 10⁻⁷ of the beam.
        assert!(hits > 2000 && differ < hits / 5000, "{hits} {differ}");
    }
}
