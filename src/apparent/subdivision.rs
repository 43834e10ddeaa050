use super::arc::MOST_CUTS;
use super::side::Side;
use super::{ApparentMesh, ApparentTriangle, Arc, Field, Rod};
use crate::relativity::{ApparentMap, Points, PointsMut};
use crate::scene::Mesh;
use glam::DVec3;
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// [`ApparentTriangle::piece`] of a triangle that was not cut.
pub const WHOLE: u32 = u32::MAX;

/// How finely a mesh is cut so that flat triangles show what curved surfaces look like.
///
/// Edges are cut where the closed form of their image asks for it ([`Arc`]), each by itself and from its two
/// end points alone, so that two triangles cut a shared edge alike whatever their winding and whether or not
/// they share vertices: no cracks. Interiors follow by halving the longest side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Subdivision {
    /// Largest distance in pixels between a drawn edge and its exact image; usually ¼. Pieces grow as
    /// 1/tolerance for faces and as its root for edges.
    pub tolerance: f64,
    /// The most triangles a body may be cut into; memory is about 120 bytes a triangle.
    pub most: usize,
}

impl Default for Subdivision {
    fn default() -> Self {
        Self { tolerance: 0.25, most: 10_000_000 }
    }
}

/// Points of a surface may be off by this many times the tolerance of outlines. More, and the middles of faces seen nearly
/// edge-on stand out beyond their outlines by more than these are allowed; less, and rounding at γ of 10⁷ makes more pieces.
const WARP: f64 = 1.5;

/// A tolerance that would need more triangles than allowed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "a tolerance of {tolerance} px cuts the scene into more than {most} triangles; use a larger tolerance"
)]
pub struct TooManyPieces {
    /// What was asked, pixels.
    pub tolerance: f64,
    /// The limit.
    pub most: usize,
}

/// How often a triangle has been cut on the way to a piece.
#[derive(Clone, Copy, Default)]
struct Depth {
    /// Halvings of sides: a handful for each doubling of the pieces.
    halvings: u32,
    /// Corners put inside: each takes most of what is wrong, but beside a side of rounding noise it goes on.
    inner: u32,
}

impl Depth {
    const MOST: Self = Self { halvings: 400, inner: 14 };
}

/// The most triangles a task works on at once; few large ones are shared out singly.
const CHUNK: usize = 256;

impl ApparentMesh {
    /// The mesh as it is seen, without cutting anything: right only for triangles that look small.
    pub fn linear(mesh: &Mesh, map: &ApparentMap) -> Self {
        let (vertices, _) = see_vertices(mesh, map);
        let triangles = (0..mesh.triangles.len())
            .filter(|&face| !faces_away(mesh, map, face))
            .map(|face| ApparentTriangle { corners: mesh.triangles[face], face: face as u32, piece: WHOLE })
            .collect();
        Self { vertices, triangles, pieces: Vec::new() }
    }

    /// The mesh as it is seen, cut so that it stays true to the pixel within `field`. Parts outside the
    /// picture may be left out.
    ///
    /// # Errors
    /// If that takes more triangles than allowed.
    pub fn new(
        mesh: &Mesh,
        map: &ApparentMap,
        field: &Field,
        how: &Subdivision,
    ) -> Result<Self, TooManyPieces> {
        let (mut vertices, doppler) = see_vertices(mesh, map);
        if map.speed() == 0.0 {
            return Ok(Self::linear(mesh, map));
        }
        let sky = map.rest_sky();
        let ahead = DVec3::Z - DVec3::Z.dot(sky.axis()) * sky.axis();
        let forward = map.rotate_back(ahead + sky.boosted(DVec3::Z, 1.0).along * sky.axis());
        let made = AtomicUsize::new(0);
        let fault = TooManyPieces { tolerance: how.tolerance, most: how.most };
        let own = vertices.len() as u32;
        let size = (mesh.triangles.len() / 64).clamp(1, CHUNK);
        let chunks: Vec<Chunk> = (0..mesh.triangles.len().div_ceil(size))
            .into_par_iter()
            .map(|chunk| {
                let mut cutter = Cutter {
                    mesh,
                    map,
                    field,
                    how,
                    doppler: &doppler,
                    made: &made,
                    out: Chunk::default(),
                    own,
                    sides: Vec::new(),
                    forward,
                };
                let faces = chunk * size..((chunk + 1) * size).min(mesh.triangles.len());
                faces.into_iter().try_for_each(|face| cutter.cut(face)).map(|()| cutter.out).ok_or(fault)
            })
            .collect::<Result<_, _>>()?;

        let count = |of: fn(&Chunk) -> usize| chunks.iter().map(of).sum::<usize>();
        let mut triangles = Vec::with_capacity(count(|c| c.triangles.len()));
        let mut pieces = Vec::with_capacity(count(|c| c.pieces.len()));
        vertices.reserve(count(|c| c.vertices.len()));
        for chunk in chunks {
            let (vertex_shift, piece_shift) = (vertices.len() as u32 - own, pieces.len() as u32);
            triangles.extend(chunk.triangles.into_iter().map(|mut t| {
                t.corners = t.corners.map(|v| if v < own { v } else { v + vertex_shift });
                t.piece = if t.piece == WHOLE { WHOLE } else { t.piece + piece_shift };
                t
            }));
            vertices.extend(chunk.vertices);
            pieces.extend(chunk.pieces);
        }
        Ok(Self { vertices, triangles, pieces })
    }
}

/// Apparent positions (relative to the observer, in its axes) and Doppler factors of a mesh's own vertices.
pub fn see_vertices(mesh: &Mesh, map: &ApparentMap) -> (Vec<DVec3>, Vec<f64>) {
    const BLOCK: usize = 512;
    let n = mesh.vertex_count();
    let (mut vertices, mut doppler) = (vec![DVec3::ZERO; n], vec![0.0; n]);
    vertices.par_chunks_mut(BLOCK).zip(doppler.par_chunks_mut(BLOCK)).enumerate().for_each(
        |(block, (vertices, doppler))| {
            let at = block * BLOCK..block * BLOCK + vertices.len();
            let mut out = [[0.0; BLOCK]; 4];
            let [x, y, z, distance] = &mut out;
            map.see_all(
                Points { x: &mesh.x[at.clone()], y: &mesh.y[at.clone()], z: &mesh.z[at] },
                PointsMut { x, y, z, distance, doppler },
            );
            for (i, vertex) in vertices.iter_mut().enumerate() {
                *vertex = DVec3::new(out[0][i], out[1][i], out[2][i]);
            }
        },
    );
    (vertices, doppler)
}

/// Facing, decided in the rest frame: (O′ − p′)·n′ > 0 is the front.
fn faces_away(mesh: &Mesh, map: &ApparentMap, face: usize) -> bool {
    if !mesh.is_one_sided(face) {
        return false;
    }
    let [a, b, c] = mesh.corners(face).map(|v| map.offset_rest(v));
    a.dot((b - a).cross(c - a)) >= 0.0
}

#[derive(Default)]
struct Chunk {
    vertices: Vec<DVec3>,
    triangles: Vec<ApparentTriangle>,
    pieces: Vec<[[f32; 2]; 3]>,
}

/// A corner of a piece while it is being cut.
#[derive(Clone, Copy)]
struct Corner {
    /// Index among the apparent vertices.
    index: u32,
    /// Rest frame.
    rest: DVec3,
    /// Barycentric coordinates of the second and third corner of the mesh's triangle.
    weights: [f64; 2],
}

struct Cutter<'a> {
    mesh: &'a Mesh,
    map: &'a ApparentMap,
    field: &'a Field,
    how: &'a Subdivision,
    doppler: &'a [f64],
    made: &'a AtomicUsize,
    out: Chunk,
    /// How many vertices the mesh has of its own.
    own: u32,
    sides: Vec<Corner>,
    /// The middle of the picture, as a direction of the rest frame.
    forward: DVec3,
}

impl Cutter<'_> {
    /// Cuts one triangle of the mesh; none when there are too many pieces.
    fn cut(&mut self, face: usize) -> Option<()> {
        if faces_away(self.mesh, self.map, face) {
            return Some(());
        }
        let indices = self.mesh.triangles[face];
        let rest = self.mesh.corners(face);
        let offsets = rest.map(|v| self.map.offset_rest(v));
        if (0..3).all(|i| {
            let j = (i + 1) % 3;
            self.surely_whole(offsets[i], offsets[j], indices[i], indices[j])
        }) {
            self.out.triangles.push(ApparentTriangle { corners: indices, face: face as u32, piece: WHOLE });
            return self.count(1);
        }
        // Edge-on, or out of the picture.
        if offsets[0].dot(offsets[1].cross(offsets[2])) == 0.0 || self.misses_picture(&offsets) {
            return Some(());
        }
        let weights = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        let corners = [0, 1, 2].map(|i| Corner { index: indices[i], rest: rest[i], weights: weights[i] });
        self.sides.clear();
        let sides = [0, 1, 2].map(|i| self.outer_side(corners[i], corners[(i + 1) % 3]));
        // A triangle takes about as many pieces as its longest side times its shortest (of WARP tolerances each):
        // what surely is too much is known before it fills the memory.
        let extents = sides.map(Side::extent);
        let least =
            extents.into_iter().fold(f64::INFINITY, f64::min) * extents.into_iter().fold(0.0, f64::max);
        let unreachable = sides.iter().any(|side| side.pieces > MOST_CUTS);
        if unreachable || least / (8.0 * WARP) > self.how.most as f64 {
            return None;
        }
        self.split(face as u32, corners, sides, Depth::default())
    }

    /// A bound that needs no trigonometry: the edge surely looks straight.
    #[inline]
    fn surely_whole(&self, a: DVec3, b: DVec3, ia: u32, ib: u32) -> bool {
        let speed = self.map.speed();
        let nearest = a.length_squared().min(b.length_squared()).sqrt();
        let length = (b - a).length();
        // Angle of the edge in the rest sky, from above.
        let angle = 1.1 * length / nearest;
        // D changes by at most a factor e^(γβ·angle) along it.
        if !(angle < 0.25 && angle * speed < 0.25) {
            return false;
        }
        let doppler = 0.75 * self.doppler[ia as usize].min(self.doppler[ib as usize]);
        let apparent = angle / doppler;
        // |N′·û| ≤ 1 and min(1, D) ≤ 1 make one bound for outline and surface.
        speed * apparent * apparent * self.field.focal() * self.field.greatest_scale()
            <= 8.0 * self.how.tolerance
    }

    fn count(&self, pieces: usize) -> Option<()> {
        let made = self.made.fetch_add(pieces, Ordering::Relaxed);
        (made + pieces <= self.how.most).then_some(())
    }

    /// Whether nothing of a triangle (offsets from the observer, rest frame) can be in the picture: its
    /// bounding cone in the rest sky is a cone in ours, aberration being conformal.
    fn misses_picture(&self, offsets: &[DVec3; 3]) -> bool {
        let units = offsets.map(|v| v.normalize_or_zero());
        let sum = units[0] + units[1] + units[2];
        let length = sum.length();
        let axis = sum / length;
        let cosine = units.iter().map(|u| u.dot(axis)).fold(1.0, f64::min) - 1e-12;
        // Wider than a half-sky, a cap need not hold the triangle between its corners.
        if !(length > 1e-6 && cosine > 0.0) {
            return false;
        }
        // n′·axis ≥ cosine, boosted: M·n ≥ −N.
        let (gamma, speed, motion) = (self.map.gamma(), self.map.speed(), self.map.axis_rest());
        let along = axis.dot(motion);
        let m = self.map.rotate(axis + ((gamma - 1.0) * along - speed * cosine) * motion);
        let n = speed * along - gamma * cosine;
        let length = m.length();
        let cos_seen = (-n / length).clamp(-1.0, 1.0);
        let sin_seen = ((1.0 - cosine * cosine).sqrt() / length).min(1.0);
        self.field.misses_cone(m / length, cos_seen, sin_seen)
    }

    fn surface_tolerance(&self) -> f64 {
        WARP * self.how.tolerance
    }

    /// A side of a triangle of the mesh: an outline, cut from its end points in an order of their own, so that
    /// the neighbour cuts alike.
    fn outer_side(&mut self, a: Corner, b: Corner) -> Side {
        let key = |c: &Corner| c.rest.to_array();
        let swapped = key(&a) > key(&b);
        let (first, last) = if swapped { (b, a) } else { (a, b) };
        let (from, to) = (self.map.offset_rest(first.rest), self.map.offset_rest(last.rest));
        let side = match Arc::new(self.map, from, to) {
            Some(arc) => {
                let cuts = arc.surface_cuts(self.field, self.how.tolerance, self.surface_tolerance());
                self.side(first, last, arc.parameters(&cuts), cuts.total)
            }
            None => self.radial_side(first, last),
        };
        if swapped { side.turned() } else { side }
    }

    fn inner_side(&mut self, a: Corner, b: Corner) -> Side {
        match Arc::new(self.map, self.map.offset_rest(a.rest), self.map.offset_rest(b.rest)) {
            Some(arc) => {
                let cuts = arc.inner_cuts(self.field, self.surface_tolerance());
                self.side(a, b, arc.parameters(&cuts), cuts.total)
            }
            None => self.radial_side(a, b),
        }
    }

    /// A side seen end-on.
    fn radial_side(&mut self, a: Corner, b: Corner) -> Side {
        let cut = Rod { from: a.rest, to: b.rest }.through_observer(self.map);
        self.side(a, b, cut.into_iter(), 1.0)
    }

    fn side(&mut self, first: Corner, last: Corner, cuts: impl Iterator<Item = f64>, total: f64) -> Side {
        let start = self.sides.len();
        self.sides.push(first);
        for t in cuts {
            let weights = [0, 1].map(|i| first.weights[i] + t * (last.weights[i] - first.weights[i]));
            let corner = self.vertex(first.rest + t * (last.rest - first.rest), weights);
            self.sides.push(corner);
        }
        self.sides.push(last);
        let pieces = self.sides.len() - start - 1;
        Side { start, pieces, reversed: false, fill: total / pieces as f64 }
    }

    fn vertex(&mut self, rest: DVec3, weights: [f64; 2]) -> Corner {
        let index = self.own + self.out.vertices.len() as u32;
        self.out.vertices.push(self.map.see(rest).position);
        Corner { index, rest, weights }
    }

    /// Halves the longest side still to be cut, joins the cut to the opposite corner, and goes on with the two
    /// halves.
    fn split(&mut self, face: u32, corners: [Corner; 3], sides: [Side; 3], depth: Depth) -> Option<()> {
        let Some(most) = Side::longest(&sides).filter(|_| depth.halvings < Depth::MOST.halvings) else {
            return self.leaf(face, corners, depth);
        };
        let pieces = sides[most].pieces;
        if pieces > 2
            && depth.halvings % 2 == 1
            && self.misses_picture(&corners.map(|c| self.map.offset_rest(c.rest)))
        {
            return Some(());
        }

        let deeper = Depth { halvings: depth.halvings + 1, ..depth };
        let half = pieces / 2;
        let [a, b, c] = [corners[most], corners[(most + 1) % 3], corners[(most + 2) % 3]];
        let [ab, bc, ca] = [sides[most], sides[(most + 1) % 3], sides[(most + 2) % 3]];
        let middle = self.sides[ab.node(half)];
        let kept = self.sides.len();
        let across = self.inner_side(middle, c);
        self.split(face, [a, middle, c], [ab.part(0, half), across, ca], deeper)?;
        self.split(face, [middle, b, c], [ab.part(half, pieces), bc, across.turned()], deeper)?;
        self.sides.truncate(kept);
        Some(())
    }

    /// A triangle whose three sides look straight, unless it is elsewhere between them: then it gets a corner
    /// there.
    fn leaf(&mut self, face: u32, corners: [Corner; 3], depth: Depth) -> Option<()> {
        if depth.inner < Depth::MOST.inner
            && let Some([u, v, w]) = self.weakest_point(&corners)
        {
            let [a, b, c] = corners;
            let weights = [0, 1].map(|i| u * a.weights[i] + v * b.weights[i] + w * c.weights[i]);
            let middle = self.vertex(u * a.rest + v * b.rest + w * c.rest, weights);
            let kept = self.sides.len();
            let spokes = corners.map(|corner| self.inner_side(middle, corner));
            for i in 0..3 {
                let j = (i + 1) % 3;
                let rim = self.side(corners[i], corners[j], std::iter::empty(), 1.0);
                self.split(
                    face,
                    [middle, corners[i], corners[j]],
                    [spokes[i], rim, spokes[j].turned()],
                    Depth { inner: depth.inner + 1, ..depth },
                )?;
            }
            self.sides.truncate(kept);
            return Some(());
        }
        let piece = self.out.pieces.len() as u32;
        self.out.pieces.push(corners.map(|c| c.weights.map(|w| w as f32)));
        self.out.triangles.push(ApparentTriangle { corners: corners.map(|c| c.index), face, piece });
        self.count(1)
    }

    /// Where a flat apparent triangle is off by more than a surface may be: at its middle, at its point nearest to
    /// the observer, where it is met looking along the motion (there aberration spreads a small part of the rest
    /// sky over most of ours), or in the middle of the picture. Barycentric coordinates of the worst; none if
    /// all is well.
    ///
    /// The error is along the motion and exactly γβ(Σ λᵢ r′ᵢ − r′). A flat triangle that shows its other side
    /// (the map keeps facing) surrounds the observer wrongly, and is cut already for a tenth of that.
    fn weakest_point(&self, corners: &[Corner; 3]) -> Option<[f64; 3]> {
        const TURNED: f64 = 0.1;
        let offsets = corners.map(|c| self.map.offset_rest(c.rest));
        let [a, b, c] = offsets;
        let normal = (b - a).cross(c - a);
        let height = normal.dot(a);
        let inside = |direction: DVec3| {
            let at = direction * (height / normal.dot(direction));
            let [p, q, r] = offsets.map(|o| o - at);
            let weights =
                [q.cross(r), r.cross(p), p.cross(q)].map(|area| area.dot(normal) / normal.length_squared());
            let held = at.dot(direction) > 0.0 && weights.iter().all(|w| *w > 1e-6 && *w < 1.0);
            held.then_some(weights)
        };
        let axis = self.map.axis_rest();
        let points =
            [Some([1.0 / 3.0; 3]), inside(normal * height.signum()), inside(axis), inside(self.forward)];
        let worst = points.into_iter().flatten().map(|w| (self.excess(corners, &offsets, w), w));
        let (excess, weights) = worst.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let seen = corners.map(|c| self.map.see(c.rest).position);
        // The observer's axes are left-handed.
        let turned = seen[0].dot(seen[1].cross(seen[2])) * height > 0.0;
        (excess > if turned { TURNED } else { 1.0 }).then_some(weights)
    }

    /// How far a point of the flat triangle is from where it is seen, over what is allowed there.
    fn excess(&self, corners: &[Corner; 3], offsets: &[DVec3; 3], weights: [f64; 3]) -> f64 {
        let mix = |v: [DVec3; 3]| weights[0] * v[0] + weights[1] * v[1] + weights[2] * v[2];
        let middle = mix(*offsets);
        if middle == DVec3::ZERO {
            return if offsets.iter().any(|o| *o != DVec3::ZERO) { f64::INFINITY } else { 0.0 };
        }
        // Distances less what they are along the motion, which is the same for both and at high speed nearly all of them.
        let axis = self.map.axis_rest() * self.map.axis_rest().dot(middle).signum();
        let beyond = |v: DVec3| {
            let (along, length) = (v.dot(axis), v.length());
            if along > 0.0 { v.cross(axis).length_squared() / (length + along) } else { length - along }
        };
        let flat: f64 = (0..3).map(|i| weights[i] * beyond(offsets[i])).sum();
        let at = beyond(middle);
        let sight = self.map.see(mix(corners.map(|c| c.rest)));
        let n = sight.position / sight.distance;
        let off = self.map.speed() * (flat - at) / (sight.doppler.max(1.0) * sight.distance);
        // A triangle's middle is off by 4/3 of what its sides are.
        let allowed = self.field.tolerance_at(n, 4.0 / 3.0 * self.surface_tolerance());
        off * self.field.focal() * self.field.scale(n) / allowed
    }
}
