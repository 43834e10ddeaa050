//! Rays from surfaces to lights, which begin in different points, eight at a time.

use super::lanes::Lanes;
#[cfg(target_arch = "x86_64")]
use super::lanes::x86;
use super::ray::Ray;
use super::tree::{Leaf, Node, Tree};
use glam::DVec3;

/// The most rays of a packet.
pub(super) const PACKET: usize = 8;

/// Rays of which is asked only whether anything is in their way.
///
/// Boxes and triangles are first tested in f32, all rays together, by bounds of its rounding: what that leaves is tested in
/// f64.
#[derive(Default)]
pub(super) struct Packet {
    stack: Vec<(u32, u32)>,
    lanes: InLanes,
}

/// In the tree's units.
#[derive(Default)]
#[repr(align(32))]
struct InLanes {
    origin: [[f32; PACKET]; 3],
    direction: [[f32; PACKET]; 3],
    /// 1 over the direction.
    inverse: [[f32; PACKET]; 3],
    /// |direction| at most.
    length: [f32; PACKET],
    /// Where they end.
    far: [f32; PACKET],
    /// What origins are off by, and boxes are larger by.
    slack: f32,
}

/// What f32 leaves over, relative, in a few operations.
const ROUNDING: f32 = 1e-6;

impl Packet {
    /// Which of the rays, at most [`PACKET`], are blocked by what is in the tree: a bit for each. With AVX2 if `vectors`
    /// and there is such.
    pub fn blocked(&mut self, rays: &[Ray<'_>], tree: &Tree, vectors: bool) -> u32 {
        if !self.aim(rays, tree) {
            // Beyond what f32 holds.
            let blocked = |(i, ray): (usize, &Ray<'_>)| u32::from(ray.is_blocked(tree, &mut Vec::new())) << i;
            return rays.iter().enumerate().map(blocked).sum();
        }
        #[cfg(target_arch = "x86_64")]
        {
            if vectors && x86::has_avx2() {
                // SAFETY: the processor has both.
                unsafe { self.blocked_avx2(rays, tree) }
            } else {
                // SAFETY: every x86-64 processor has SSE2.
                unsafe { self.blocked_with::<x86::Sse2>(rays, tree) }
            }
        }
        #[cfg(not(target_arch = "x86_64"))]
        {
            let _ = vectors;
            // SAFETY: needs nothing.
            unsafe { self.blocked_with::<super::lanes::One>(rays, tree) }
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma")]
    fn blocked_avx2(&mut self, rays: &[Ray<'_>], tree: &Tree) -> u32 {
        // SAFETY: the caller has made sure.
        unsafe { self.blocked_with::<x86::Avx2>(rays, tree) }
    }

    /// Whether all of it is within what f32 holds.
    fn aim(&mut self, rays: &[Ray<'_>], tree: &Tree) -> bool {
        let InLanes { origin, direction, inverse, length, far, slack } = &mut self.lanes;
        let mut most = 0.0f64;
        for (i, ray) in rays.iter().enumerate() {
            let place = ray.origin.place(tree).0;
            let along = ray.direction * tree.scale;
            let size = along.abs();
            let (least, greatest) = (size.min_element(), size.max_element());
            // A component that is 0 has an infinite inverse, which is right.
            let fits = greatest > 1e-15 && greatest < 1e15 && (least == 0.0 || least > 1e-30);
            let there = place.abs().max_element();
            if !fits || there.is_nan() || there >= 1e15 {
                return false;
            }
            most = most.max(place.abs().max_element());
            for k in 0..3 {
                origin[k][i] = place[k] as f32;
                direction[k][i] = along[k] as f32;
                inverse[k][i] = (1.0 / along[k]) as f32;
            }
            length[i] = (along.length() * (1.0 + 1e-6)) as f32;
            far[i] = ray.range[1] as f32 * (1.0 + ROUNDING);
        }
        *slack = (most * f64::from(ROUNDING)) as f32;
        true
    }

    #[inline(always)]
    unsafe fn blocked_with<L: Lanes>(&mut self, rays: &[Ray<'_>], tree: &Tree) -> u32 {
        let mut open = (1u32 << rays.len()) - 1;
        let all = open;
        let mut stack = std::mem::take(&mut self.stack);
        stack.clear();
        if !tree.nodes.is_empty() {
            // SAFETY: as this function.
            stack.push((0, unsafe { self.lanes.enter::<L>(&tree.nodes[0]) }));
        }
        while let Some((index, mask)) = stack.pop() {
            if mask & open == 0 {
                continue;
            }
            let node = &tree.nodes[index as usize];
            if node.count == 0 {
                for child in [node.first, node.first + 1] {
                    // SAFETY: as this function.
                    let mask = mask & unsafe { self.lanes.enter::<L>(&tree.nodes[child as usize]) };
                    if mask & open != 0 {
                        stack.push((child, mask));
                    }
                }
                continue;
            }
            for leaf in &tree.leaves[node.first as usize..(node.first + node.count) as usize] {
                // SAFETY: as this function.
                let mut possible = mask & open & unsafe { self.lanes.may_hit::<L>(leaf, tree) };
                while possible != 0 {
                    let i = possible.trailing_zeros();
                    possible &= possible - 1;
                    if rays[i as usize].hits(leaf) {
                        open &= !(1 << i);
                    }
                }
            }
            if open == 0 {
                break;
            }
        }
        self.stack = stack;
        all & !open
    }
}

impl InLanes {
    /// Which rays may enter a box.
    #[inline(always)]
    unsafe fn enter<L: Lanes>(&self, node: &Node) -> u32 {
        let mut bits = 0;
        for i in (0..PACKET).step_by(L::COUNT) {
            // SAFETY: as this function.
            unsafe {
                let (mut near, mut far) = (L::splat(0.0), L::load(&self.far[i..]));
                for k in 0..3 {
                    let (origin, inverse) = (L::load(&self.origin[k][i..]), L::load(&self.inverse[k][i..]));
                    let low = L::splat(node.min[k] - self.slack).sub(origin).mul(inverse);
                    let high = L::splat(node.max[k] + self.slack).sub(origin).mul(inverse);
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

    /// Which rays may hit a triangle: by o + t d = a + u e₁ + v e₂, with bounds of what f32 may be off by.
    #[inline(always)]
    unsafe fn may_hit<L: Lanes>(&self, leaf: &Leaf, tree: &Tree) -> u32 {
        let place = |c: DVec3| (c - tree.centre) * tree.scale;
        let [a, b, c] = &leaf.corners;
        let (a, b, c) = (place(*a), place(*b), place(*c));
        let (e1, e2) = (b - a, c - a);
        let normal = e1.cross(e2);
        let size = e1.abs().element_sum().max(e2.abs().element_sum()) as f32;
        let mut bits = 0;
        for i in (0..PACKET).step_by(L::COUNT) {
            // SAFETY: as this function.
            unsafe {
                let splat = |v: DVec3| [L::splat(v.x as f32), L::splat(v.y as f32), L::splat(v.z as f32)];
                let (a, e1, e2, normal) = (splat(a), splat(e1), splat(e2), splat(normal));
                let d = [0, 1, 2].map(|k| L::load(&self.direction[k][i..]));
                let o = [0, 1, 2].map(|k| L::load(&self.origin[k][i..]));
                let r = [o[0].sub(a[0]), o[1].sub(a[1]), o[2].sub(a[2])];
                let zero = L::splat(0.0);
                let abs = |v: L| v.max(zero.sub(v));
                // What a corner from the origin is off by, and its products with the direction and an edge.
                let off = abs(r[0]).add(abs(r[1])).add(abs(r[2])).mul(L::splat(ROUNDING));
                let off = off.add(L::splat(self.slack + ROUNDING));
                let off = off.mul(L::load(&self.length[i..])).mul(L::splat(4.0 * size));
                let c = [
                    r[1].mul(d[2]).sub(r[2].mul(d[1])),
                    r[2].mul(d[0]).sub(r[0].mul(d[2])),
                    r[0].mul(d[1]).sub(r[1].mul(d[0])),
                ];
                let dot = |a: [L; 3], b: [L; 3]| a[0].mul_add(b[0], a[1].mul_add(b[1], a[2].mul(b[2])));
                let (u, v, det) = (dot(e2, c), zero.sub(dot(e1, c)), zero.sub(dot(d, normal)));
                let back = zero.above(det);
                let turned = |x: L| back.choose(zero.sub(x), x);
                let (u, v, det) = (turned(u), turned(v), turned(det));
                let inside = u.add(off).at_least(zero).and(v.add(off).at_least(zero));
                let inside = inside.and(det.add(off).add(off).at_least(u.add(v)));
                bits |= inside.bits() << i;
            }
        }
        bits
    }
}

#[cfg(test)]
mod tests {
    use super::super::beam::tests::{maps, random, soup};
    use super::super::origin::Origin;
    use super::*;

    /// Eight rays at a time, whatever the vectors, are blocked just where one at a time is by any triangle.
    #[test]
    fn packets_are_blocked_where_rays_are() {
        let mut random = random(5);
        let mut packet = Packet::default();
        let [mut blocked, mut free] = [0, 0];
        for (count, scale) in [(1, 1.0), (40, 1e-20), (300, 1.0), (100, 1e12)] {
            let mesh = soup(count, scale, &mut random);
            let tree = Tree::new(&mesh);
            for map in maps(scale) {
                for _ in 0..100 {
                    let mut point =
                        |reach: f64| DVec3::from_array([0; 3].map(|_| random() - 0.5)) * reach * scale;
                    let origin = Origin::of_observer(&map);
                    let nowhere = Ray { origin, direction: DVec3::X, range: [0.0; 2], but: None };
                    let mut rays = [nowhere; PACKET];
                    for (i, ray) in rays.iter_mut().enumerate() {
                        let (from, to) = (point(3.0), point(3.0));
                        let at = from - map.observer_rest();
                        let direction = if i % 4 == 3 { (to - from) * DVec3::X } else { to - from };
                        let far = if i % 2 == 0 { 1.0 } else { f64::INFINITY };
                        let but = (i == 5).then_some(0);
                        *ray = Ray { origin: Origin::at(&map, at), direction, range: [1e-9, far], but };
                    }
                    let every = |ray: &Ray<'_>| tree.leaves.iter().any(|leaf| ray.hits(leaf));
                    let expected =
                        rays.iter().enumerate().map(|(i, r)| u32::from(every(r)) << i).sum::<u32>();
                    let alone = rays.iter().map(|r| r.is_blocked(&tree, &mut Vec::new()));
                    let alone = alone.enumerate().map(|(i, b)| u32::from(b) << i).sum::<u32>();
                    assert_eq!(alone, expected);
                    for vectors in [false, true] {
                        assert_eq!(packet.blocked(&rays, &tree, vectors), expected);
                    }
                    assert!(packet.aim(&rays, &tree));
                    // SAFETY: needs nothing.
                    let one = unsafe { packet.blocked_with::<super::super::lanes::One>(&rays, &tree) };
                    assert_eq!(one, expected);
                    blocked += expected.count_ones();
                    free += 8 - expected.count_ones();
                }
            }
        }
        assert!(blocked > 1000 && free > 1000, "{blocked} {free}");
    }
}
