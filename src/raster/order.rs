use super::bounds::Rect;
use super::triangle::{Planes, Surface};
use crate::relativity::RestSky;
use glam::DVec3;
use rayon::prelude::*;
use std::collections::BinaryHeap;

/// A triangle that waits for its place in the painter's order.
pub(super) struct Waiting<'a> {
    /// Apparent corners.
    pub corners: [DVec3; 3],
    /// The planes through the observer and its sides.
    pub planes: Planes,
    /// Where lines of sight meet it.
    pub surface: Surface,
    /// Of its body.
    pub sky: &'a RestSky,
    /// Pixels it may cover.
    pub rects: [Option<Rect>; 2],
    /// Apparent distance of its centroid.
    pub depth: f64,
}

/// Side of the squares of the picture within which triangles are compared.
const TILE: u32 = 16;

/// The most pairs that are compared; beyond, centroids decide.
const MOST_PAIRS: usize = 100_000_000;

/// Triangles back to front, by their indices: of two that overlap, seen from the observer, the farther first, where
/// they overlap; otherwise, and where that goes round in circles, the one with the farther centroid.
pub(super) fn back_to_front(triangles: &[Waiting<'_>]) -> Vec<u32> {
    let mut by_centroid: Vec<u32> = (0..triangles.len() as u32).collect();
    let depth = |i: u32| triangles[i as usize].depth;
    by_centroid.par_sort_by(|a, b| depth(*b).total_cmp(&depth(*a)));
    let Some(pairs) = overlapping(triangles) else { return by_centroid };
    sorted(&by_centroid, &pairs)
}

/// Pairs, the first behind the second; none if there are too many to be compared.
fn overlapping(triangles: &[Waiting<'_>]) -> Option<Vec<[u32; 2]>> {
    let rects = || {
        let all = triangles.iter().enumerate();
        all.flat_map(|(i, t)| t.rects.iter().flatten().map(move |rect| (i as u32, *rect)))
    };
    let [columns, rows] = [|r: &Rect| r.x[1], |r: &Rect| r.y[1]].map(|end: fn(&Rect) -> u32| {
        rects().map(|(_, r)| end(&r)).max().unwrap_or(0).div_ceil(TILE) as usize
    });
    let mut tiles: Vec<Vec<(u32, Rect)>> = vec![Vec::new(); columns * rows];
    for (i, rect) in rects() {
        for y in rect.y[0] / TILE..rect.y[1].div_ceil(TILE) {
            for x in rect.x[0] / TILE..rect.x[1].div_ceil(TILE) {
                tiles[y as usize * columns + x as usize].push((i, rect));
            }
        }
    }
    if tiles.iter().map(|t| t.len() * t.len() / 2).sum::<usize>() > MOST_PAIRS {
        return None;
    }
    let compare = |(tile, inside): (usize, &Vec<(u32, Rect)>)| {
        let [x, y] = [tile % columns, tile / columns].map(|c| c as u32 * TILE);
        let mut pairs = Vec::new();
        for (k, (i, a)) in inside.iter().enumerate() {
            for (j, b) in &inside[k + 1..] {
                // Once, in the tile where what they share begins.
                let from = [a.x[0].max(b.x[0]), a.y[0].max(b.y[0])];
                let share = from[0] < a.x[1].min(b.x[1]) && from[1] < a.y[1].min(b.y[1]);
                if i != j && share && [from[0] / TILE * TILE, from[1] / TILE * TILE] == [x, y] {
                    let [p, q] = [i, j].map(|n| &triangles[*n as usize]);
                    match is_behind(p, q) {
                        Some(true) => pairs.push([*i, *j]),
                        Some(false) => pairs.push([*j, *i]),
                        None => {}
                    }
                }
            }
        }
        pairs
    };
    let mut pairs: Vec<_> = tiles.par_iter().enumerate().flat_map_iter(compare).collect();
    pairs.par_sort_unstable();
    pairs.dedup();
    Some(pairs)
}

/// Whether one is behind the other in a direction in which both are seen; none if there is no such direction, or
/// they are at one there.
fn is_behind(one: &Waiting<'_>, other: &Waiting<'_>) -> Option<bool> {
    /// Sides that two triangles share are no overlap.
    const INSIDE: f64 = 1e-7;
    let holds = |t: &Waiting<'_>, n: DVec3, least: f64| {
        t.planes.edges.iter().all(|e| e.dot(n) > least * e.length() * n.length())
    };
    let mut middle = DVec3::ZERO;
    for (a, b) in [(one, other), (other, one)] {
        let corners = a.corners.iter().filter(|c| holds(b, **c, -INSIDE));
        middle += corners.map(|c| c.normalize_or_zero()).sum::<DVec3>();
    }
    for e in one.planes.edges {
        for f in other.planes.edges {
            let crossing = e.cross(f);
            for n in [crossing, -crossing] {
                let length = n.length();
                // In floating point a direction on a side is on either side of it.
                if length > 1e-12 * e.length() * f.length() && holds(one, n, -1e-9) && holds(other, n, -1e-9)
                {
                    middle += n / length;
                }
            }
        }
    }
    let n = middle.normalize_or_zero();
    if n == DVec3::ZERO || !holds(one, n, INSIDE) || !holds(other, n, INSIDE) {
        return None;
    }
    let nearness = |t: &Waiting<'_>| t.surface.nearness(n, 1.0, t.sky.boosted(n, 1.0).along);
    let (a, b) = (nearness(one), nearness(other));
    ((a - b).abs() > 1e-9 * b.abs()).then_some(a < b)
}

/// The order by centroids, changed so that the first of every pair comes before the second (A. B. Kahn 1962).
fn sorted(by_centroid: &[u32], pairs: &[[u32; 2]]) -> Vec<u32> {
    let count = by_centroid.len();
    let mut place = vec![0u32; count];
    by_centroid.iter().enumerate().for_each(|(at, i)| place[*i as usize] = at as u32);
    let mut behind = vec![0u32; count];
    let mut starts = vec![0usize; count + 1];
    for [first, second] in pairs {
        behind[*second as usize] += 1;
        starts[*first as usize + 1] += 1;
    }
    (0..count).for_each(|i| starts[i + 1] += starts[i]);
    // The farthest that has nothing behind it is next.
    let ready = |i: u32| std::cmp::Reverse((place[i as usize], i));
    let mut heap: BinaryHeap<_> = (0..count as u32).filter(|i| behind[*i as usize] == 0).map(ready).collect();
    let mut done = vec![false; count];
    let mut out = Vec::with_capacity(count);
    let mut rest = by_centroid.iter();
    while out.len() < count {
        let next = match heap.pop() {
            Some(std::cmp::Reverse((_, i))) => i,
            // A cycle: it is cut at the farthest.
            None => match rest.find(|i| !done[**i as usize]) {
                Some(i) => *i,
                None => break,
            },
        };
        if std::mem::replace(&mut done[next as usize], true) {
            continue;
        }
        out.push(next);
        for [_, second] in &pairs[starts[next as usize]..starts[next as usize + 1]] {
            let left = &mut behind[*second as usize];
            *left -= 1;
            if *left == 0 && !done[*second as usize] {
                heap.push(ready(*second));
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_overrule_centroids_and_cycles_end() {
        assert_eq!(sorted(&[2, 0, 1], &[]), [2, 0, 1]);
        assert_eq!(sorted(&[2, 0, 1], &[[1, 2]]), [0, 1, 2]);
        let round = sorted(&[0, 1, 2, 3], &[[0, 1], [1, 2], [2, 0], [2, 3]]);
        assert_eq!(round, [0, 1, 2, 3]);
    }
}
