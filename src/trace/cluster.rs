use super::origin::Origin;
use super::tree::Tree;
use glam::DVec3;
use rayon::prelude::*;
use std::ops::Range;

/// What is known of leaves of a tree that follow each other, so that they need not be asked one by one.
#[derive(Clone, Debug)]
pub(super) struct Cluster {
    pub leaves: Range<u32>,
    /// Of a sphere with all of them in it.
    centre: DVec3,
    radius: f64,
    /// Of the longest side.
    pub side_squared: f64,
    /// Whether only fronts are seen.
    pub one_sided: bool,
}

/// So many leaves.
const SIZE: u32 = 64;

impl Cluster {
    /// All of a tree.
    pub fn of(tree: &Tree) -> Vec<Self> {
        let count = tree.count() as u32;
        let of_number = |number: u32| number * SIZE..count.min((number + 1) * SIZE);
        let all = (0..count.div_ceil(SIZE)).into_par_iter().with_min_len(64);
        all.map(|number| Self::new(tree, of_number(number))).collect()
    }

    fn new(tree: &Tree, leaves: Range<u32>) -> Self {
        let centre = tree.leaf(leaves.start).corners[0];
        let (mut radius_squared, mut side_squared, mut one_sided) = (0.0, 0.0, true);
        // What is no number is no more than anything; such a triangle is not seen.
        let greater = |a: f64, b: f64| if b > a { b } else { a };
        for leaf in leaves.clone().map(|number| tree.leaf(number)) {
            let [a, b, c] = leaf.corners;
            for corner in [a, b, c] {
                radius_squared = greater(radius_squared, (corner - centre).length_squared());
            }
            for side in [b - a, c - b, a - c] {
                side_squared = greater(side_squared, side.length_squared());
            }
            one_sided &= leaf.one_sided;
        }
        Self { leaves, centre, radius: radius_squared.sqrt() * (1.0 + 1e-9), side_squared, one_sided }
    }

    /// How near any point of them can be at least; none if that cannot be told.
    pub fn nearest(&self, origin: &Origin<'_>) -> Option<f64> {
        let distance = origin.to(self.centre).length();
        let nearest = distance * (1.0 - 1e-9) - self.radius;
        // Also false for NaN.
        (nearest > 0.0).then_some(nearest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::relativity::{ApparentMap, Motion};
    use crate::scene::shapes;
    use std::sync::Arc;
    use terrell_geodesic::{Event, Tetrad};

    #[test]
    fn no_triangle_is_nearer_or_larger() {
        let mesh = Arc::new(shapes::sphere(4));
        let tree = Tree::flat(&mesh);
        let observer = Tetrad::of_world(Event::origin());
        for distance in [0.0, 0.9, 2.0] {
            let map = ApparentMap::new(&Motion::at_rest(DVec3::X * distance), &observer);
            let origin = Origin::of_observer(&map);
            let clusters = Cluster::of(&tree);
            let mut told = 0;
            for cluster in &clusters {
                let nearest = cluster.nearest(&origin);
                told += usize::from(nearest.is_some());
                for leaf in cluster.leaves.clone().map(|number| tree.leaf(number)) {
                    let [a, b, c] = leaf.corners.map(|c| origin.to(c));
                    assert!(
                        [b - a, c - b, a - c]
                            .iter()
                            .all(|s| s.length_squared() <= cluster.side_squared * (1.0 + 1e-12))
                    );
                    let middle = (a + b + c) / 3.0;
                    assert!([a, b, c, middle].iter().all(|p| p.length() >= nearest.unwrap_or(0.0)));
                }
            }
            assert!(told > clusters.len() / 2, "{told} {distance}");
            let all = clusters.iter().flat_map(|c| c.leaves.clone());
            assert!(all.eq(0..mesh.triangles.len() as u32));
        }
    }
}
