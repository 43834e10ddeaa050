use super::mesh_edges::MeshEdges;
use crate::apparent::{Field, Rod};
use crate::film::{Film, NOTHING};
use crate::relativity::ApparentMap;
use crate::scene::{Lens, Mesh, Projection};
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// What a film shows of the edges of one body.
pub(super) struct Curves<'a> {
    pub film: &'a Film,
    pub lens: &'a Lens,
    pub field: &'a Field,
    /// The film's own tolerance, in pixels: how far its outlines may be from where they belong.
    pub tolerance: f64,
    /// Index of the body in the scene.
    pub body: usize,
    pub mesh: &'a Mesh,
    pub map: &'a ApparentMap,
}

/// Points of a curve are so near to each other, in pixels.
const STEP: f64 = 1.0;

/// A line may be hidden for so many points without being broken, and its ends too: faces narrower than a pixel, and
/// every face near its corners, are seen by pixels now and then.
const BRIDGE: usize = 4;

/// Edges shorter than this, in pixels, may belong to triangles so small that no pixel sees them.
const SHORT: f64 = 3.0;

/// What apparent distances in f32 are good to, and the slope within a pixel of a triangle so small.
const SAME_DISTANCE: f64 = 1e-4;

/// Halvings after which a line that still jumps is at a panorama's seam, or behind a fisheye.
const MOST_HALVINGS: u32 = 52;

/// A point of an edge, as it is seen.
#[derive(Clone, Copy)]
struct Node {
    t: f64,
    apparent: DVec3,
    pixel: Option<DVec2>,
}

impl Curves<'_> {
    /// The parts of the edges that are seen, as lines of the picture.
    pub fn seen(&self, edges: &MeshEdges) -> Vec<Vec<DVec2>> {
        let shown = self.faces_shown();
        let lines = (0..edges.len()).into_par_iter().with_min_len(64).flat_map_iter(|index| {
            let (ends, faces) = edges.get(index, self.mesh);
            self.edge(ends, faces, &shown)
        });
        lines.collect()
    }

    /// Which triangles the film shows anything of.
    fn faces_shown(&self) -> Vec<bool> {
        let mut shown = vec![false; self.mesh.triangles.len()];
        for (&body, &face) in self.film.body.iter().zip(&self.film.face) {
            if body == self.body as i32
                && let Some(shown) = usize::try_from(face).ok().and_then(|face| shown.get_mut(face))
            {
                *shown = true;
            }
        }
        shown
    }

    fn edge(&self, ends: [DVec3; 2], faces: &[u32], shown: &[bool]) -> Vec<Vec<DVec2>> {
        let rod = Rod { from: ends[0], to: ends[1] };
        let whole = [0.0, 1.0].map(|t| self.node(&rod, t));
        let short = gap(&whole[0], &whole[1]) < SHORT;
        if !short && !faces.iter().any(|&face| shown[face as usize]) {
            return Vec::new();
        }
        let mut trace = Trace {
            curves: self,
            rod,
            faces,
            short,
            lines: Vec::new(),
            hidden: 0,
            open: false,
            start: Vec::new(),
        };
        let mut last: Option<Node> = None;
        for piece in rod.polyline(self.map, self.field, self.tolerance) {
            let node = Node { t: piece.t, apparent: piece.apparent, pixel: self.lens.pixel(piece.apparent) };
            if let Some(last) = last {
                trace.follow(&last, &node, MOST_HALVINGS);
            }
            last = Some(node);
        }
        trace.finish()
    }

    fn node(&self, rod: &Rod, t: f64) -> Node {
        let apparent = self.map.see(rod.from.lerp(rod.to, t)).position;
        Node { t, apparent, pixel: self.lens.pixel(apparent) }
    }

    /// Whether nothing between two points of a curve can be in the picture.
    fn misses(&self, a: &Node, b: &Node) -> bool {
        // For lines as wide as they are drawn.
        const BESIDE: f64 = 8.0;
        let size = 2.0 * self.lens.middle();
        if self.lens.projection() == Projection::Pinhole {
            let half = (self.lens.middle() + BESIDE) / self.lens.focal();
            let sides = [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)]
                .map(|(x, y)| DVec3::new(x, y, x.abs() * half.x + y.abs() * half.y));
            let outside = |side: DVec3| a.apparent.dot(side) < 0.0 && b.apparent.dot(side) < 0.0;
            return outside(DVec3::Z) || sides.into_iter().any(outside);
        }
        let (Some(p), Some(q)) = (a.pixel, b.pixel) else { return false };
        // What is between leaves the straight line by less than its length.
        let beside = BESIDE + p.distance(q);
        let (low, high) = (p.min(q) - beside, p.max(q) + beside);
        high.cmplt(DVec2::ZERO).any() || low.cmpgt(size).any()
    }

    /// Whether the film shows an edge's point: whether one of the pixels around it sees a triangle the edge belongs
    /// to.
    ///
    /// Comparing distances instead needs a margin for the surface's slope, and near light speed none is right:
    /// there apparent distances of front and back differ by as little as the slope makes in a pixel.
    fn shows(&self, node: &Node, faces: &[u32], short: bool) -> bool {
        let Some(pixel) = node.pixel else { return false };
        let (width, height) = (i64::from(self.film.width), i64::from(self.film.height));
        // The four pixels around it, and what the film's tolerance adds.
        let reach = 1.0 + self.tolerance.min(4.0);
        let range = |at: f64, side: i64| {
            let from = ((at - 0.5 - reach).ceil() as i64).clamp(0, side - 1);
            let to = ((at - 0.5 + reach).floor() as i64).clamp(0, side - 1);
            from..=to
        };
        let own = node.apparent.length();
        range(pixel.y, height).any(|y| {
            range(pixel.x, width).any(|x| {
                let i = (y * width + x) as usize;
                if self.film.body[i] == NOTHING || self.film.body[i] != self.body as i32 {
                    return false;
                }
                let is_own = faces.iter().any(|&face| face as i32 == self.film.face[i]);
                is_own || (short && own <= f64::from(self.film.distance[i]) * (1.0 + SAME_DISTANCE))
            })
        })
    }
}

/// The distance of two points in the picture; infinite where one of them has no place there.
fn gap(a: &Node, b: &Node) -> f64 {
    match (a.pixel, b.pixel) {
        (Some(p), Some(q)) => p.distance(q),
        _ => f64::INFINITY,
    }
}

/// One edge being followed along its image.
struct Trace<'a> {
    curves: &'a Curves<'a>,
    rod: Rod,
    faces: &'a [u32],
    short: bool,
    lines: Vec<Vec<DVec2>>,
    /// How many points at the end of the last line are hidden.
    hidden: usize,
    /// Whether the last line goes on.
    open: bool,
    /// Hidden points from the edge's first end on, while nothing is seen yet.
    start: Vec<DVec2>,
}

impl Trace<'_> {
    /// From one point to the next, by points of the edge itself.
    fn follow(&mut self, a: &Node, b: &Node, halvings: u32) {
        if self.curves.misses(a, b) {
            return self.end_line();
        }
        if gap(a, b) <= STEP {
            if !self.open {
                self.put(a);
            }
            return self.put(b);
        }
        if halvings == 0 {
            return self.end_line();
        }
        let middle = self.curves.node(&self.rod, 0.5 * (a.t + b.t));
        self.follow(a, &middle, halvings - 1);
        self.follow(&middle, b, halvings - 1);
    }

    fn put(&mut self, node: &Node) {
        let Some(pixel) = node.pixel else { return };
        if self.curves.shows(node, self.faces, self.short) {
            if !self.open {
                let start =
                    if self.start.len() <= BRIDGE { std::mem::take(&mut self.start) } else { Vec::new() };
                self.lines.push(start);
                self.open = true;
            }
            self.hidden = 0;
        } else if self.open {
            self.hidden += 1;
            if self.hidden > BRIDGE {
                return self.end_line();
            }
        }
        if self.open
            && let Some(line) = self.lines.last_mut()
        {
            line.push(pixel);
        }
    }

    fn end_line(&mut self) {
        if self.open
            && let Some(line) = self.lines.last_mut()
        {
            line.truncate(line.len() - self.hidden.min(BRIDGE));
        }
        (self.open, self.hidden) = (false, 0);
        self.start.clear();
    }

    fn finish(mut self) -> Vec<Vec<DVec2>> {
        // The last points may be hidden: the edge ends there.
        self.hidden = 0;
        self.end_line();
        // Specks, where an edge grazes what hides it.
        self.lines.retain(|line| self.short || line.len() > BRIDGE);
        self.lines
    }
}
