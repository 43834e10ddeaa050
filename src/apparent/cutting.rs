use super::chord::{Cuts, Line, bulge, cuts};
use super::side::Side;
use crate::relativity::ApparentMap;
use crate::scene::{Mesh, Paint};
use glam::DVec3;
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// How a mesh is cut so that flat triangles between apparent vertices are what is seen, in space: everywhere within
/// a tolerance, at one moment or at several. Nothing is left out, neither what faces away nor what is behind.
///
/// Of an edge's chord and of a flat triangle the greatest error is known in closed form, so the tolerance is a
/// bound. Edges are cut from their end points alone, in an order of their own: neighbours cut alike whether or not
/// they share vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cutting {
    /// Vertices beyond the mesh's own, which keep their numbers.
    pub inserted: Vec<Inserted>,
    /// All triangles, in the order of the mesh's own and wound as these are.
    pub triangles: Vec<[u32; 3]>,
    /// For each, the triangle of the mesh it is, or is a piece of.
    pub face: Vec<u32>,
}

/// A vertex between three others: a + v(b − a) + w(c − a), whatever they hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inserted {
    /// a, b, c: vertices of the mesh.
    pub corners: [u32; 3],
    /// v and w.
    pub weights: [f64; 2],
}

/// A body as one observer meets it.
#[derive(Clone, Copy, Debug)]
pub struct Moment<'a> {
    /// At rest; the same vertices and triangles at all moments, in different places if it is animated.
    pub mesh: &'a Mesh,
    /// What the observer sees of it.
    pub map: &'a ApparentMap,
}

/// Why a mesh cannot be cut to a tolerance.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CuttingError {
    /// It would take too much memory.
    #[error(
        "a tolerance of {tolerance} cuts the scene into more than {most} triangles; use a larger tolerance"
    )]
    TooMany {
        /// What was asked, a length.
        tolerance: f64,
        /// The limit.
        most: usize,
    },
    /// Apparent positions are not that exact.
    #[error(
        "a tolerance of {tolerance} is less than 64-bit numbers resolve at this speed and distance; use at least {least:.1e}"
    )]
    BelowDigits {
        /// What was asked, a length.
        tolerance: f64,
        /// What can be had.
        least: f64,
    },
    /// No length.
    #[error("a tolerance of {0} is not above 0")]
    NoLength(f64),
}

/// The middle of an equilateral piece is off by 4/3 of what its sides are.
const OF_SIDES: f64 = 0.75;

/// The most triangles a task works on at once.
const CHUNK: usize = 256;

impl Cutting {
    /// What keeps within `tolerance` (a length; usually a thousandth of the body) at all `moments`. Pieces grow as
    /// 1/tolerance for faces and as its root for edges; where nothing moves the mesh stays as it is.
    ///
    /// # Errors
    /// If it takes more than `most` triangles, or no number of them will do.
    ///
    /// # Panics
    /// If there is no moment.
    pub fn new(moments: &[Moment<'_>], tolerance: f64, most: usize) -> Result<Self, CuttingError> {
        let mesh = moments[0].mesh;
        if tolerance <= 0.0 || tolerance.is_nan() {
            return Err(CuttingError::NoLength(tolerance));
        }
        let count = mesh.triangles.len();
        if moments.iter().all(|m| m.map.speed() == 0.0) {
            let face = (0..count as u32).collect();
            return Ok(Self { inserted: Vec::new(), triangles: mesh.triangles.clone(), face });
        }
        let least = moments.iter().map(noise).fold(0.0, f64::max);
        if tolerance < least {
            return Err(CuttingError::BelowDigits { tolerance, least });
        }
        let fault = CuttingError::TooMany { tolerance, most };
        let edges = Edges::new(moments, tolerance, most).ok_or(fault)?;
        let own = (mesh.vertex_count() + edges.inserted.len()) as u32;
        let made = AtomicUsize::new(0);
        let size = (count / 64).clamp(1, CHUNK);
        let chunks: Vec<Self> = (0..count.div_ceil(size))
            .into_par_iter()
            .map(|chunk| {
                let out = Self::default();
                let (sides, offsets, lines) = (Vec::new(), Vec::new(), Vec::new());
                let edges = &edges;
                let mut cutter =
                    Cutter { moments, tolerance, most, edges, made: &made, own, out, sides, offsets, lines };
                let faces = chunk * size..((chunk + 1) * size).min(count);
                faces.into_iter().try_for_each(|face| cutter.cut(face)).map(|()| cutter.out).ok_or(fault)
            })
            .collect::<Result<_, _>>()?;
        let mut whole = Self { inserted: edges.inserted, ..Self::default() };
        for chunk in chunks {
            let shift = (mesh.vertex_count() + whole.inserted.len()) as u32 - own;
            let moved = |v: u32| if v < own { v } else { v + shift };
            whole.triangles.extend(chunk.triangles.into_iter().map(|t| t.map(moved)));
            whole.face.extend(chunk.face);
            whole.inserted.extend(chunk.inserted);
        }
        Ok(whole)
    }

    /// The mesh in these pieces, still at rest: texture coordinates, normals and colours interpolated there.
    pub fn apply(&self, mesh: &Mesh) -> Mesh {
        fn grow<const N: usize>(values: &[[f32; N]], inserted: &[Inserted]) -> Vec<[f32; N]> {
            if values.is_empty() {
                return Vec::new();
            }
            let between = |i: &Inserted| {
                let [a, b, c] = i.corners.map(|v| values[v as usize].map(f64::from));
                std::array::from_fn(|k| {
                    (a[k] + i.weights[0] * (b[k] - a[k]) + i.weights[1] * (c[k] - a[k])) as f32
                })
            };
            values.iter().copied().chain(inserted.iter().map(between)).collect()
        }
        let coordinate = |values: &[f64]| {
            let between = |i: &Inserted| {
                let [a, b, c] = i.corners.map(|v| values[v as usize]);
                a + i.weights[0] * (b - a) + i.weights[1] * (c - a)
            };
            values.iter().copied().chain(self.inserted.iter().map(between)).collect()
        };
        let of_face = |values: &[u32]| match values {
            [] => Vec::new(),
            _ => self.face.iter().map(|f| values[*f as usize]).collect(),
        };
        let mut normals = grow(&mesh.normals, &self.inserted);
        for normal in normals.iter_mut().skip(mesh.vertex_count()) {
            *normal = glam::Vec3::from(*normal).normalize_or_zero().to_array();
        }
        Mesh {
            clay: mesh.clay,
            x: coordinate(&mesh.x),
            y: coordinate(&mesh.y),
            z: coordinate(&mesh.z),
            triangles: self.triangles.clone(),
            paint: match &mesh.paint {
                Paint::Uniform(color) => Paint::Uniform(*color),
                Paint::Faces(colors) => Paint::Faces(self.face.iter().map(|f| colors[*f as usize]).collect()),
                Paint::Vertices(colors) => Paint::Vertices(grow(colors, &self.inserted)),
            },
            materials: mesh.materials.clone(),
            material: of_face(&mesh.material),
            uv: grow(&mesh.uv, &self.inserted),
            normals,
        }
    }
}

/// What rounding leaves uncertain of apparent positions: that of the distance, and that of the coordinates at rest,
/// stretched.
fn noise(moment: &Moment<'_>) -> f64 {
    let Moment { mesh, map } = moment;
    let of = |v: usize| {
        let x_rest = mesh.vertex(v as u32);
        map.see(x_rest).distance + map.gamma() * x_rest.length()
    };
    64.0 * f64::EPSILON * (0..mesh.vertex_count()).into_par_iter().map(of).reduce(|| 0.0, f64::max)
}

/// The edges of a mesh, cut; each once for all triangles that share both its vertices.
struct Edges {
    /// The smaller vertex first; sorted.
    ends: Vec<[u32; 2]>,
    cuts: Vec<Cuts>,
    /// Number of the first vertex on each.
    first: Vec<u32>,
    /// Whether it is cut from its second end.
    reversed: Vec<bool>,
    inserted: Vec<Inserted>,
}

impl Edges {
    /// None if there are too many pieces.
    fn new(moments: &[Moment<'_>], tolerance: f64, most: usize) -> Option<Self> {
        let mesh = moments[0].mesh;
        let mut ends: Vec<[u32; 2]> = mesh
            .triangles
            .par_iter()
            .flat_map_iter(|&[a, b, c]| [[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)]))
            .collect();
        ends.par_sort_unstable();
        ends.dedup();
        let reversed: Vec<bool> =
            ends.iter().map(|&[a, b]| mesh.vertex(a).to_array() > mesh.vertex(b).to_array()).collect();
        let made = AtomicUsize::new(0);
        let cuts: Vec<Cuts> = ends
            .par_iter()
            .zip(&reversed)
            .map_init(Vec::new, |lines: &mut Vec<Line>, (ends, reversed)| {
                let [from, to] = if *reversed { [ends[1], ends[0]] } else { *ends };
                lines.clear();
                lines.extend(moments.iter().map(|Moment { mesh, map }| {
                    let offset = |v| map.offset_rest(mesh.vertex(v));
                    Line::new(map.speed(), offset(from), offset(to))
                }));
                let cuts = cuts(lines, OF_SIDES * tolerance, most)?;
                // Each will be a corner of a triangle more.
                let made = made.fetch_add(cuts.at.len(), Ordering::Relaxed);
                (made + cuts.at.len() <= most).then_some(cuts)
            })
            .collect::<Option<_>>()?;
        let total: usize = cuts.iter().map(|c| c.at.len()).sum();
        if mesh.vertex_count() + total > (u32::MAX / 2) as usize {
            return None;
        }
        let mut first = Vec::with_capacity(ends.len());
        let mut inserted = Vec::with_capacity(total);
        for ((ends, reversed), cuts) in ends.iter().zip(&reversed).zip(&cuts) {
            first.push((mesh.vertex_count() + inserted.len()) as u32);
            let [from, to] = if *reversed { [ends[1], ends[0]] } else { *ends };
            inserted.extend(cuts.at.iter().map(|t| Inserted { corners: [from, to, to], weights: [*t, 0.0] }));
        }
        Some(Self { ends, cuts, first, reversed, inserted })
    }

    fn between(&self, a: u32, b: u32) -> usize {
        let ends = [a.min(b), a.max(b)];
        self.ends.partition_point(|e| *e < ends)
    }
}

/// A corner of a piece while it is being cut.
#[derive(Clone, Copy)]
struct Corner {
    index: u32,
    /// Barycentric coordinates in the mesh's triangle.
    weights: [f64; 3],
}

fn blend(a: [f64; 3], b: [f64; 3], t: f64) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] + t * (b[i] - a[i]))
}

/// How often a triangle has been cut on the way to a piece.
#[derive(Clone, Copy, Default)]
struct Depth {
    /// Halvings of sides.
    halvings: u32,
    /// Corners put inside: each takes most of what is wrong.
    inner: u32,
}

impl Depth {
    const MOST: Self = Self { halvings: 2000, inner: 60 };
}

struct Cutter<'a> {
    moments: &'a [Moment<'a>],
    tolerance: f64,
    most: usize,
    edges: &'a Edges,
    made: &'a AtomicUsize,
    /// Vertices of the mesh and of its edges; what lies inside triangles comes behind them.
    own: u32,
    out: Cutting,
    sides: Vec<Corner>,
    /// Offsets of the mesh triangle's corners from the observer, at every moment.
    offsets: Vec<[DVec3; 3]>,
    lines: Vec<Line>,
}

impl Cutter<'_> {
    /// Cuts one triangle of the mesh; none when there are too many pieces.
    fn cut(&mut self, face: usize) -> Option<()> {
        let corners = self.moments[0].mesh.triangles[face];
        self.offsets.clear();
        let offsets = |m: &Moment<'_>| m.mesh.corners(face).map(|v| m.map.offset_rest(v));
        self.offsets.extend(self.moments.iter().map(offsets));
        let unit = |i: usize| std::array::from_fn(|k| if k == i { 1.0 } else { 0.0 });
        let nodes = [0, 1, 2].map(|i| Corner { index: corners[i], weights: unit(i) });
        self.sides.clear();
        let sides = [0, 1, 2].map(|i| self.outer_side(nodes[i], nodes[(i + 1) % 3]));
        // What surely is too much is known before it fills the memory: a triangle takes about as many pieces as its
        // longest side times its shortest.
        let extents = sides.map(Side::extent);
        let least =
            extents.into_iter().fold(f64::INFINITY, f64::min) * extents.into_iter().fold(0.0, f64::max);
        if least / 8.0 > self.most as f64 {
            return None;
        }
        self.split(face as u32, nodes, sides, Depth::default())
    }

    fn outer_side(&mut self, a: Corner, b: Corner) -> Side {
        let edge = self.edges.between(a.index, b.index);
        let swapped = (a.index > b.index) != self.edges.reversed[edge];
        let (first, last) = if swapped { (b, a) } else { (a, b) };
        let (cuts, number) = (&self.edges.cuts[edge], self.edges.first[edge]);
        let start = self.sides.len();
        self.sides.push(first);
        self.sides.extend(
            cuts.at
                .iter()
                .zip(number..)
                .map(|(t, index)| Corner { index, weights: blend(first.weights, last.weights, *t) }),
        );
        self.sides.push(last);
        let side = Side { start, pieces: cuts.at.len() + 1, reversed: false, fill: cuts.fill };
        if swapped { side.turned() } else { side }
    }

    fn offset(&self, moment: usize, corner: Corner) -> DVec3 {
        let ([a, b, c], [u, v, w]) = (self.offsets[moment], corner.weights);
        u * a + v * b + w * c
    }

    fn inner_side(&mut self, a: Corner, b: Corner) -> Option<Side> {
        let mut lines = std::mem::take(&mut self.lines);
        lines.clear();
        lines.extend(
            self.moments
                .iter()
                .enumerate()
                .map(|(m, moment)| Line::new(moment.map.speed(), self.offset(m, a), self.offset(m, b))),
        );
        let cuts = cuts(&lines, OF_SIDES * self.tolerance, self.most);
        self.lines = lines;
        let cuts = cuts?;
        let start = self.sides.len();
        self.sides.push(a);
        for t in &cuts.at {
            let corner = self.vertex(blend(a.weights, b.weights, *t));
            self.sides.push(corner);
        }
        self.sides.push(b);
        Some(Side { start, pieces: cuts.at.len() + 1, reversed: false, fill: cuts.fill })
    }

    /// A vertex inside the triangle being cut; its corners are filled in when a piece of it is made.
    fn vertex(&mut self, weights: [f64; 3]) -> Corner {
        let index = self.own + self.out.inserted.len() as u32;
        self.out.inserted.push(Inserted { corners: [0; 3], weights: [weights[1], weights[2]] });
        Corner { index, weights }
    }

    /// Halves the longest side still to be cut, joins the cut to the opposite corner, and goes on with the two
    /// halves.
    fn split(&mut self, face: u32, corners: [Corner; 3], sides: [Side; 3], depth: Depth) -> Option<()> {
        let Some(most) = Side::longest(&sides) else {
            return self.leaf(face, corners, sides, depth);
        };
        if depth.halvings >= Depth::MOST.halvings {
            return None;
        }
        let deeper = Depth { halvings: depth.halvings + 1, ..depth };
        let pieces = sides[most].pieces;
        let half = pieces / 2;
        let [a, b, c] = [corners[most], corners[(most + 1) % 3], corners[(most + 2) % 3]];
        let [ab, bc, ca] = [sides[most], sides[(most + 1) % 3], sides[(most + 2) % 3]];
        let middle = self.sides[ab.node(half)];
        let kept = self.sides.len();
        let across = self.inner_side(middle, c)?;
        self.split(face, [a, middle, c], [ab.part(0, half), across, ca], deeper)?;
        self.split(face, [middle, b, c], [ab.part(half, pieces), bc, across.turned()], deeper)?;
        self.sides.truncate(kept);
        Some(())
    }

    /// A triangle whose three sides are good, unless it is elsewhere between them: then it gets a corner there.
    fn leaf(&mut self, face: u32, corners: [Corner; 3], sides: [Side; 3], depth: Depth) -> Option<()> {
        if let Some([u, v, w]) = self.weakest_point(&corners) {
            if depth.inner >= Depth::MOST.inner {
                return None;
            }
            let deeper = Depth { inner: depth.inner + 1, ..depth };
            let [a, b, c] = corners.map(|corner| corner.weights);
            let middle = self.vertex([0, 1, 2].map(|i| u * a[i] + v * b[i] + w * c[i]));
            let kept = self.sides.len();
            let mut spokes = sides;
            for (spoke, corner) in spokes.iter_mut().zip(corners) {
                *spoke = self.inner_side(middle, corner)?;
            }
            for i in 0..3 {
                let j = (i + 1) % 3;
                let around = [spokes[i], sides[i], spokes[j].turned()];
                self.split(face, [middle, corners[i], corners[j]], around, deeper)?;
            }
            self.sides.truncate(kept);
            return Some(());
        }
        if self.made.fetch_add(1, Ordering::Relaxed) >= self.most {
            return None;
        }
        let mesh_corners = self.moments[0].mesh.triangles[face as usize];
        for corner in corners {
            if let Some(inside) = corner.index.checked_sub(self.own) {
                self.out.inserted[inside as usize].corners = mesh_corners;
            }
        }
        self.out.triangles.push(corners.map(|c| c.index));
        self.out.face.push(face);
        Some(())
    }

    /// Where the flat triangle is farthest from what is seen at any moment, if that is more than allowed.
    fn weakest_point(&self, corners: &[Corner; 3]) -> Option<[f64; 3]> {
        let at = |(m, moment): (usize, &Moment<'_>)| {
            bulge(moment.map.speed(), corners.map(|corner| self.offset(m, corner)))
        };
        let worst = self.moments.iter().enumerate().filter_map(at).max_by(|a, b| a.1.total_cmp(&b.1));
        worst.filter(|(_, off)| *off > self.tolerance).map(|(weights, _)| weights)
    }
}
