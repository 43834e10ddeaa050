use super::cluster::Cluster;
use super::origin::Origin;
use super::stage::Target;
use super::tile::SIDE;
use crate::raster::{Bounder, Hull, Place, Rect, SLACK_PX, beside, most_beside};
use crate::relativity::{Points, PointsMut};
use crate::scene::{Lens, Projection};
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// Which triangles of one body each tile looks at: those that may be seen in it.
///
/// Where they may be seen needs no cutting: bounds of six points (see [`beside`]), or of three and how far the others may be from
/// them, are all that is needed.
pub(super) struct Lists {
    /// Tiles of a row.
    pub columns: usize,
    samples: [[f64; 2]; 2],
    /// Where the numbers of each tile begin; one more at the end.
    first: Vec<u32>,
    /// Of leaves of the target's tree.
    numbers: Vec<u32>,
    large: Vec<Large>,
}

/// A triangle that may be seen in many tiles.
struct Large {
    number: u32,
    tiles: Rect,
    /// On a pinhole's picture, points it lies within the convex hull of.
    hull: Option<[DVec2; 6]>,
}

/// A triangle in more tiles is kept once, not in every one: memory is bounded by the mesh.
const MANY: u32 = 16;

/// Clusters sorted as one task.
const TASK: usize = 1 << 7;

/// What a task has found: tiles and numbers.
#[derive(Default)]
struct Found {
    /// Tiles of a row.
    columns: u32,
    small: Vec<(u32, u32)>,
    large: Vec<Large>,
}

impl Found {
    /// A triangle that may be seen there, within that.
    #[inline]
    fn add(&mut self, number: u32, Rect { x, y }: Rect, hull: impl FnOnce() -> Option<[DVec2; 6]>) {
        let [x, y] = [x, y].map(|[from, to]| [from / SIDE, to.div_ceil(SIDE)]);
        if (x[1] - x[0]) * (y[1] - y[0]) > MANY {
            self.large.push(Large { number, tiles: Rect { x, y }, hull: hull() });
            return;
        }
        for row in y[0]..y[1] {
            self.small.extend((x[0]..x[1]).map(|column| (row * self.columns + column, number)));
        }
    }
}

impl Lists {
    pub fn new(target: &Target, lens: &Lens, samples: [[f64; 2]; 2]) -> Self {
        let columns = lens.width().div_ceil(SIDE);
        let tiles = columns * lens.height().div_ceil(SIDE);
        let bounds = Bounds::new(target, lens, samples);
        debug_assert!(target.tree.count() == 0 || !target.tree.clusters().is_empty(), "a tree to be listed");
        let found: Vec<Found> = target
            .tree
            .clusters()
            .par_chunks(TASK)
            .map(|clusters| {
                let mut found = Found { columns, ..Found::default() };
                clusters.iter().for_each(|cluster| bounds.add_cluster(cluster, &mut found));
                found
            })
            .collect();
        // Counted, then put in their places.
        let mut first = vec![0u32; tiles as usize + 1];
        for (tile, _) in found.iter().flat_map(|f| &f.small) {
            first[*tile as usize + 1] += 1;
        }
        for tile in 0..tiles as usize {
            first[tile + 1] += first[tile];
        }
        let mut next = first.clone();
        let mut numbers = vec![0; first[tiles as usize] as usize];
        for (tile, number) in found.iter().flat_map(|f| &f.small) {
            let at = &mut next[*tile as usize];
            numbers[*at as usize] = *number;
            *at += 1;
        }
        let large = found.into_iter().flat_map(|f| f.large).collect();
        Self { columns: columns as usize, samples, first, numbers, large }
    }

    /// Those of many tiles that may be seen in a row of tiles, with the columns.
    pub fn large_of_row(&self, row: u32) -> impl Iterator<Item = ([u32; 2], u32)> {
        let of_row = move |large: &&Large| large.tiles.y[0] <= row && row < large.tiles.y[1];
        self.large.iter().filter(of_row).filter_map(move |large| {
            let [from, to] = large.tiles.x;
            let Some(hull) = &large.hull else { return Some(([from, to], large.number)) };
            let [low, high] = self.samples;
            let top = f64::from(row * SIDE);
            let [least, greatest] =
                within(hull, [top + low[1] - SLACK_PX, top + f64::from(SIDE - 1) + high[1] + SLACK_PX])?;
            // Casts end at 0 and at the greatest number.
            let column = |x: f64| (x / f64::from(SIDE)) as u32;
            let from = from.max(column(least - high[0] - SLACK_PX));
            let to = to.min(column(greatest - low[0] + SLACK_PX).saturating_add(1));
            (from < to).then_some(([from, to], large.number))
        })
    }

    /// The others that may be seen in a tile.
    pub fn of_tile(&self, row: u32, column: u32) -> &[u32] {
        let tile = row as usize * self.columns + column as usize;
        &self.numbers[self.first[tile] as usize..self.first[tile + 1] as usize]
    }
}

/// The range of x of a convex hull's part between two y; none if there is none.
fn within(points: &[DVec2; 6], [low, high]: [f64; 2]) -> Option<[f64; 2]> {
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    let mut add = |x: f64| range = [range[0].min(x), range[1].max(x)];
    for (i, a) in points.iter().enumerate() {
        if low <= a.y && a.y <= high {
            add(a.x);
        }
        for b in &points[i + 1..] {
            for y in [low, high] {
                if (a.y < y) != (b.y < y) {
                    add(a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)));
                }
            }
        }
    }
    (range[0] <= range[1]).then_some(range)
}

/// Where the vertices of a target are seen.
enum Seen {
    /// On a pinhole's picture.
    Places(Vec<Place>),
    /// Observer's axes.
    Points(Vec<DVec3>),
}

impl Seen {
    fn new(target: &Target, bounder: &Bounder<'_>, projection: Projection) -> Self {
        match projection {
            Projection::Pinhole => {
                Self::Places(each_seen(target, Place::NOWHERE, |seen| bounder.place(seen)))
            }
            _ => Self::Points(each_seen(target, DVec3::ZERO, |seen| seen)),
        }
    }
}

/// Something of where each vertex is seen, which is `none` before.
fn each_seen<T: Copy + Send>(target: &Target, none: T, of: impl Fn(DVec3) -> T + Sync) -> Vec<T> {
    let mesh = &target.mesh;
    // So many at a time.
    const PART: usize = 1 << 10;
    let mut all = vec![none; mesh.vertex_count()];
    let rest = mesh.x.par_chunks(PART).zip(mesh.y.par_chunks(PART)).zip(mesh.z.par_chunks(PART));
    all.par_chunks_mut(PART).zip(rest).for_each(|(all, ((rx, ry), rz))| {
        let mut parts = [[0.0; PART]; 5];
        let [x, y, z, distance, doppler] = parts.each_mut().map(|part| &mut part[..rx.len()]);
        target.map.see_all(Points { x: rx, y: ry, z: rz }, PointsMut { x, y, z, distance, doppler });
        for (i, at) in all.iter_mut().enumerate() {
            *at = of(DVec3::new(x[i], y[i], z[i]));
        }
    });
    all
}

/// Finds where triangles may be seen.
struct Bounds<'a> {
    bounder: Bounder<'a>,
    seen: Seen,
    /// Of the motion, observer's axes, towards where triangles are seen beside flat ones.
    axis: DVec3,
    /// The sign of areas on the picture of what is seen from behind: fronts turn left where x, y and z of the observer's axes
    /// are left-handed, as they are for pictures.
    back: f32,
    target: &'a Target,
}

impl<'a> Bounds<'a> {
    fn new(target: &'a Target, lens: &'a Lens, samples: [[f64; 2]; 2]) -> Self {
        let bounder = Bounder::new(lens, samples);
        let seen = Seen::new(target, &bounder, lens.projection());
        let back = if target.map.axes().determinant() < 0.0 { 1.0 } else { -1.0 };
        Self { bounder, seen, axis: target.map.axis_observer(), back, target }
    }

    /// Adds those of a cluster that may be seen.
    fn add_cluster(&self, cluster: &Cluster, found: &mut Found) {
        let nearest = cluster.nearest(&Origin::of_observer(&self.target.map));
        let (Seen::Places(places), Some(nearest)) = (&self.seen, nearest) else {
            cluster.leaves.clone().for_each(|number| self.add(number, found));
            return;
        };
        let beside = most_beside(&self.target.map, cluster.side_squared, nearest);
        let back = if cluster.one_sided { self.back } else { 0.0 };
        for number in cluster.leaves.clone() {
            let places = self.corners(number).map(|v| places[v as usize]);
            match self.bounder.of_small(places, beside, back) {
                Some(None) => (),
                Some(Some(rect)) => found.add(number, rect, || self.projected(number)),
                None => self.add(number, found),
            }
        }
    }

    /// Adds a triangle, if it may be seen.
    fn add(&self, number: u32, found: &mut Found) {
        let Some(beside) = self.beside(number) else { return };
        if let Seen::Places(places) = &self.seen {
            let places = self.corners(number).map(|v| places[v as usize]);
            if let Some(rect) = self.bounder.of_small(places, beside, 0.0) {
                if let Some(rect) = rect {
                    found.add(number, rect, || self.projected(number));
                }
                return;
            }
        }
        let hull = self.hull(number, beside);
        for rect in self.bounder.of_hull(&hull).into_iter().flatten() {
            found.add(number, rect, || self.bounder.projected(&hull.points()));
        }
    }

    /// Numbers of a triangle's corners in the mesh.
    #[inline]
    fn corners(&self, number: u32) -> [u32; 3] {
        self.target.mesh.triangles[self.target.tree.face(number)]
    }

    /// How far beside the flat one a triangle is seen at most; none if it is not seen at all.
    fn beside(&self, number: u32) -> Option<f64> {
        let Target { map, tree, .. } = self.target;
        let leaf = tree.leaf(number);
        beside(map, leaf.corners.map(|c| map.offset_rest(c)), leaf.one_sided)
    }

    /// What a triangle is seen within, observer's axes.
    fn hull(&self, number: u32, beside: f64) -> Hull {
        let place = |v: u32| match &self.seen {
            Seen::Places(_) => self.target.map.see(self.target.mesh.vertex(v)).position,
            Seen::Points(points) => points[v as usize],
        };
        Hull::new(self.corners(number).map(place), self.axis, beside)
    }

    /// That on a pinhole's picture.
    fn projected(&self, number: u32) -> Option<[DVec2; 6]> {
        self.bounder.projected(&self.hull(number, self.beside(number)?).points())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::relativity::{ApparentMap, Motion};
    use crate::scene::{Material, Mesh, Projection};
    use crate::trace::beam::tests::random;
    use crate::trace::tree::Tree;
    use crate::trace::{Stage, beam};
    use std::sync::Arc;
    use terrell_geodesic::{Celerity, Event, Tetrad};

    /// Every point of a triangle is seen between the flat one and that moved along the motion, near and far, at any speed,
    /// and in a tile that lists it.
    #[test]
    fn triangles_are_seen_where_lists_say() {
        let mut random = random(11);
        let mut number = move |reach: f64| (random() - 0.5) * reach;
        let left_handed = Tetrad::new(
            Event::origin(),
            Celerity::new(DVec3::new(0.2, -0.4, 0.1)).unwrap(),
            DVec3::new(0.3, 1.0, 0.2),
            DVec3::Z,
        )
        .unwrap();
        let (mut listed, mut large) = (0, 0);
        for round in 0..6000 {
            let speed = [0.0, 0.5, 3.0, 100.0, 1e6][round % 5];
            let projection = [Projection::Pinhole, Projection::Fisheye, Projection::Panorama][round % 3];
            let fov = [120.0, 360.0, 360.0][round % 3];
            let lens = Lens::new(projection, fov, 161, 97).unwrap();
            let observer = if round % 7 < 4 { left_handed } else { Tetrad::of_world(left_handed.event()) };
            let camera = crate::scene::Camera { observer, lens };
            let mut point = |reach: f64| DVec3::new(number(reach), number(reach), number(reach));
            let celerity = Celerity::new(point(1.0).normalize() * speed).unwrap();
            let motion = Motion { celerity, origin: Event::new(0.0, 0.1, 0.2, -0.3) };
            let map = ApparentMap::new(&motion, &observer);
            let middle = map.observer_rest() + point([1.0, 8.0][round % 2]);
            let side = [0.02, 0.2, 1.0, 20.0][round / 3 % 4];
            let corners = [middle + point(side), middle + point(side), middle + point(side)];
            let mut mesh = Mesh::new(&corners, vec![[0, 1, 2]]);
            mesh.materials = vec![Material { one_sided: round % 4 < 2, ..Material::default() }];
            let mesh = Arc::new(mesh);
            let tree = Arc::new(Tree::flat(&mesh).listed());
            let stage = Stage::new(vec![(0, motion, mesh, tree)], &camera, false);
            let target = &stage.targets[0];
            let bounds = Bounds::new(target, &lens, [[0.5; 2]; 2]);
            let lists = Lists::new(target, &lens, [[0.5; 2]; 2]);
            // One that turns its back is not seen.
            let Some(beside) = bounds.beside(0) else { continue };
            let hull = bounds.hull(0, beside).points();
            let most = hull[3] - hull[0];
            for step in 0..200 {
                let (u, v) = (f64::from(step % 14) / 14.0, f64::from(step / 14) / 15.0);
                let weights = if u + v > 1.0 { [1.0 - u, 1.0 - v, u + v - 1.0] } else { [u, v, 1.0 - u - v] };
                let mix = |p: [DVec3; 3]| (0..3).map(|i| weights[i] * p[i]).sum::<DVec3>();
                let (flat, seen) = (mix([hull[0], hull[1], hull[2]]), map.see(mix(corners)).position);
                let beside = seen - flat;
                let along = beside.dot(bounds.axis);
                // What f64 leaves of the differences, at γ times the size.
                let rounding = 1e-12 * (1.0 + map.gamma()) * (seen.length() + flat.length() + side);
                assert!((beside - along * bounds.axis).length() < rounding, "{round}");
                assert!(-rounding < along && along < most.length() + rounding, "{round} {along} {most}");
                let Some(pixel) = lens.pixel(seen) else { continue };
                // The middle of the pixel is seen through, if it is within the triangle.
                let (x, y) = (pixel.x.floor(), pixel.y.floor());
                if !(0.0..161.0).contains(&x) || !(0.0..97.0).contains(&y) {
                    continue;
                }
                let Some(sight) = lens.direction(DVec2::new(x + 0.5, y + 0.5)) else { continue };
                let mut rays = crate::trace::directed::Directed::default();
                rays.push(target.rest_direction(sight, sight.length()), 0.0);
                let origin = crate::trace::origin::Origin::of_observer(&target.map);
                let mut beam = beam::Beam::default();
                beam.trace(rays.facing().unwrap(), &rays, &target.tree, Some(&[0]), &origin, false);
                if beam.found(0) == beam::NONE {
                    continue;
                }
                let (column, row) = (x as u32 / SIDE, y as u32 / SIDE);
                let small = lists.of_tile(row, column).contains(&0);
                let wide = lists.large_of_row(row).any(|([from, to], _)| from <= column && column < to);
                assert!(small || wide, "{round} {pixel}");
                listed += 1;
                large += usize::from(wide);
            }
        }
        assert!(listed > 60_000 && large > 20_000 && listed - large > 10_000, "{listed} {large}");
    }

    #[test]
    fn hulls_are_cut_to_rows() {
        let at = |x: f64, y: f64| DVec2::new(x, y);
        let points = [at(0.0, 0.0), at(10.0, 10.0), at(0.0, 0.0), at(3.0, 9.0), at(10.0, 10.0), at(5.0, 5.0)];
        assert_eq!(within(&points, [2.0, 4.0]).unwrap().map(|x| (x * 3.0).round()), [2.0, 12.0]);
        assert_eq!(within(&points, [9.5, 20.0]).unwrap()[1], 10.0);
        assert_eq!(within(&points, [11.0, 12.0]), None);
    }
}
