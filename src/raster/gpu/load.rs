use super::cone::{LightCone, Linear};
use super::looks::Looks;
use super::records::{FaceRecord, ShapeRecord, SkyRecord};
use crate::apparent::see_vertices;
use crate::film::Samples;
use crate::light::{Facet, SeenShading, owns_boundary};
use crate::raster::triangle::{Planes, Surface};
use crate::raster::{Bounder, Drawable, Hull, Rect, beside};
use crate::relativity::ApparentMap;
use crate::scene::{Lens, Mesh, Projection};
use glam::DVec3;
use rayon::prelude::*;

/// A body to be drawn uncut.
#[derive(Clone, Copy, Debug)]
pub struct Uncut<'a> {
    /// Index of the body in the scene, and in the shading.
    pub body: usize,
    /// The mesh at rest.
    pub mesh: &'a Mesh,
    /// The map it is seen through.
    pub map: &'a ApparentMap,
}

/// What shaders read of a scene: all that needs more than single precision is done.
#[derive(Default)]
pub(super) struct Load {
    pub skies: Vec<SkyRecord>,
    pub shapes: Vec<ShapeRecord>,
    pub faces: Vec<FaceRecord>,
    /// Quads or polygons.
    pub figures: Vec<[u32; 4]>,
    /// Of polygons; none where quads are drawn.
    pub vertices: Vec<[f32; 4]>,
    pub looks: Looks,
    /// Length of the unit of distances.
    pub unit: f64,
}

/// Triangles prepared as one task.
const TASK: usize = 1 << 12;

/// Vertices of a picture with more pixels a radian are too far apart in single precision.
const MOST_FOCAL: f64 = 2e4;

/// What a task has made; shapes and faces are counted from its first.
#[derive(Default)]
struct Part {
    shapes: Vec<ShapeRecord>,
    faces: Vec<FaceRecord>,
    figures: Vec<[u32; 4]>,
}

/// One body on its way.
struct Subject<'a> {
    body: usize,
    mesh: &'a Mesh,
    map: &'a ApparentMap,
    cone: LightCone,
    unit: f64,
}

impl Load {
    /// Bodies, and nothing of their triangles yet. Distances are in units of the first body's, so that no scene is too large
    /// or too small for single precision.
    fn begun<'a>(bodies: Vec<(usize, &'a Mesh, &'a ApparentMap)>, lens: &Lens) -> (Self, Vec<Subject<'a>>) {
        let distance = bodies.first().map_or(1.0, |(_, mesh, map)| map.see(mesh.centre()).distance);
        let unit = if distance.is_normal() { distance } else { 1.0 };
        let mut load = Self { unit, ..Self::default() };
        let mut subjects = Vec::new();
        for (body, mesh, map) in bodies {
            let cone = LightCone::new(&map.rest_sky(), lens);
            load.skies.resize(load.skies.len().max(body + 1), SkyRecord::default());
            load.skies[body] = cone.record;
            subjects.push(Subject { body, mesh, map, cone, unit });
        }
        (load, subjects)
    }

    /// Triangles of exact shading: tested in the sky of their rest frame, uncut.
    pub fn uncut(bodies: &[Uncut<'_>], lens: &Lens, samples: &Samples, shading: &SeenShading<'_>) -> Self {
        let (mut load, subjects) =
            Self::begun(bodies.iter().map(|b| (b.body, b.mesh, b.map)).collect(), lens);
        let bounder = Bounder::new(lens, samples.range());
        for subject in &subjects {
            let looks = load.looks.add(subject.body, subject.mesh, shading);
            let (seen, _) = see_vertices(subject.mesh, subject.map);
            let axis = subject.map.axis_observer();
            let part = |task: usize| {
                let mut part = Part::default();
                for number in task * TASK..subject.mesh.triangles.len().min((task + 1) * TASK) {
                    let offsets = subject.mesh.corners(number).map(|c| subject.map.offset_rest(c));
                    let one_sided = subject.mesh.is_one_sided(number);
                    let Some(beside) = beside(subject.map, offsets, one_sided) else { continue };
                    let corners = subject.mesh.triangles[number].map(|v| seen[v as usize]);
                    let hull = Hull::new(corners, axis, beside);
                    let points = hull.points();
                    let index = part.shapes.len() as u32;
                    let before = part.figures.len();
                    let mut add = |rect| part.figures.push(quad(rect, index));
                    if lens.projection() == Projection::Pinhole && bounder.projected(&points).is_none() {
                        let whole = Rect { x: [0, lens.width()], y: [0, lens.height()] };
                        split(lens, &points, whole, HALVINGS, &mut add);
                    } else {
                        bounder.of_hull(&hull).into_iter().flatten().for_each(add);
                    }
                    if part.figures.len() == before {
                        continue;
                    }
                    let Some((shape, mut face)) = subject.uncut(number, offsets) else {
                        part.figures.truncate(before);
                        continue;
                    };
                    looks.finish(&mut face);
                    part.shapes.push(ShapeRecord { face: index, ..shape });
                    part.faces.push(FaceRecord { shape: index, ..face });
                }
                part
            };
            let tasks = subject.mesh.triangles.len().div_ceil(TASK);
            load.extend((0..tasks).into_par_iter().map(part).collect());
        }
        load
    }

    /// Pieces of apparent shading, cut as they are. A pinhole's are moved to where they are seen by a shader and drawn as
    /// polygons; before other lenses, where straight lines do not look straight, they are tested by direction.
    pub fn cut(bodies: &[Drawable<'_>], lens: &Lens, samples: &Samples, shading: &SeenShading<'_>) -> Self {
        let (mut load, subjects) =
            Self::begun(bodies.iter().map(|b| (b.body, b.mesh, b.map)).collect(), lens);
        let unit = load.unit;
        let polygons = lens.projection() == Projection::Pinhole && lens.focal().x < MOST_FOCAL;
        let bounder = Bounder::new(lens, samples.range());
        for (subject, drawable) in subjects.iter().zip(bodies) {
            let looks = load.looks.add(subject.body, subject.mesh, shading);
            let seen = drawable.seen;
            let vertices = load.vertices.len() as u32;
            if polygons {
                let vertex = |v: &DVec3| subject.cone.rest_of_point(*v).map(|c| (c / unit) as f32);
                load.vertices.par_extend(seen.vertices.par_iter().map(vertex));
            }
            let part = |task: usize| {
                let mut part = Part::default();
                // The face made last.
                let mut last = None;
                for piece in &seen.triangles[task * TASK..seen.triangles.len().min((task + 1) * TASK)] {
                    let corners = piece.corners.map(|v| seen.vertices[v as usize]);
                    let number = piece.face as usize;
                    let offsets = subject.mesh.corners(number).map(|c| subject.map.offset_rest(c));
                    let Some(mut shape) = subject.piece(offsets, corners) else { continue };
                    if last != Some(number) {
                        let Some((uncut, mut face)) = subject.uncut(number, offsets) else { continue };
                        looks.finish(&mut face);
                        face.shape = part.shapes.len() as u32;
                        part.shapes.push(ShapeRecord { face: part.faces.len() as u32, ..uncut });
                        part.faces.push(face);
                        last = Some(number);
                    }
                    shape.face = part.faces.len() as u32 - 1;
                    let index = part.shapes.len() as u32;
                    part.shapes.push(shape);
                    if polygons {
                        let [a, b, c] = piece.corners.map(|v| v + vertices);
                        part.figures.push([a, b, c, index]);
                    } else {
                        let rects = bounder.bounds([[f32::NAN; 2]; 3], || corners);
                        part.figures.extend(rects.into_iter().flatten().map(|r| quad(r, index)));
                    }
                }
                part
            };
            let tasks = seen.triangles.len().div_ceil(TASK);
            load.extend((0..tasks).into_par_iter().map(part).collect());
        }
        load
    }

    /// Joins what tasks have made, in their order.
    fn extend(&mut self, parts: Vec<Part>) {
        // Where a figure has its shape's number.
        let place = if self.vertices.is_empty() { 2 } else { 3 };
        for part in parts {
            let (shapes, faces) = (self.shapes.len() as u32, self.faces.len() as u32);
            self.shapes.extend(part.shapes.into_iter().map(|s| ShapeRecord { face: s.face + faces, ..s }));
            self.faces.extend(part.faces.into_iter().map(|f| FaceRecord { shape: f.shape + shapes, ..f }));
            self.figures.extend(part.figures.into_iter().map(|mut figure| {
                figure[place] += shapes;
                figure
            }));
        }
    }
}

/// Halvings of a picture's sides, where what crosses the camera plane is looked for.
const HALVINGS: u32 = 3;

/// Those parts of a pinhole's picture in which something of a convex hull may be seen, some of it behind the camera or beside
/// it: not those that have all of it outside one of the planes through the camera and their sides.
fn split(lens: &Lens, points: &[DVec3; 6], rect: Rect, halvings: u32, add: &mut impl FnMut(Rect)) {
    let size = points.iter().fold(0.0f64, |size, p| size.max(p.abs().max_element()));
    let (middle, focal) = (lens.middle(), lens.focal().x);
    // A pixel more on every side than samples lie in.
    let side = |pixel: u32, more: f64, middle: f64| (f64::from(pixel) + more - middle) / focal;
    let [left, right] = [side(rect.x[0], -1.0, middle.x), side(rect.x[1], 1.0, middle.x)];
    let [top, bottom] = [side(rect.y[0], -1.0, middle.y), side(rect.y[1], 1.0, middle.y)];
    let inward = [
        DVec3::new(1.0, 0.0, -left),
        DVec3::new(-1.0, 0.0, right),
        DVec3::new(0.0, -1.0, -top),
        DVec3::new(0.0, 1.0, bottom),
        DVec3::Z,
    ];
    // More than rounding leaves.
    let is_outside = |n: &DVec3| points.iter().all(|p| p.dot(*n) < -1e-9 * size * n.length());
    if inward.iter().any(is_outside) {
        return;
    }
    let [width, height] = [rect.x, rect.y].map(|[from, to]| to - from);
    if halvings == 0 || width < 2 || height < 2 {
        return add(rect);
    }
    let halves = |[from, to]: [u32; 2]| [[from, (from + to) / 2], [(from + to) / 2, to]];
    for y in halves(rect.y) {
        for x in halves(rect.x) {
            split(lens, points, Rect { x, y }, halvings - 1, add);
        }
    }
}

fn quad(Rect { x, y }: Rect, shape: u32) -> [u32; 4] {
    [x[0] | x[1] << 16, y[0] | y[1] << 16, shape, 0]
}

impl Subject<'_> {
    /// The shape of a triangle of the mesh with its face, as if both were the first; none for one seen edge-on.
    fn uncut(&self, number: usize, offsets: [DVec3; 3]) -> Option<(ShapeRecord, FaceRecord)> {
        let Planes { edges, .. } = Planes::new(offsets)?;
        let facet = Facet::new(self.mesh, number, offsets);
        let normal = facet.normal();
        let height = normal.dot(offsets[0]);
        let lines = edges.map(|m| self.cone.of_boosted(self.map.rotate(m)));
        let plane = self.cone.of_boosted(self.map.rotate(normal)).times(self.unit / height);
        let (mut shape, sizes) = self.shape(lines, edges.map(owns_boundary), plane)?;
        shape.greatest = f32::MAX;
        let most = sizes.into_iter().fold(0.0, f64::max);
        let face = FaceRecord {
            weights: sizes.map(|size| (size / most) as f32),
            plane: (height / normal.length() / self.unit).abs() as f32,
            number: number as u32,
            material: self.mesh.material_index(number) as u32,
            ..FaceRecord::default()
        };
        Some((shape, face))
    }

    /// The shape of a piece of a triangle, seen with its corners at these places.
    fn piece(&self, offsets: [DVec3; 3], corners: [DVec3; 3]) -> Option<ShapeRecord> {
        let planes = Planes::new(corners)?;
        let surface = Surface::new(self.map, &self.map.rest_sky(), offsets, corners, &planes);
        let lines = planes.edges.map(|m| self.cone.of_sight(m));
        let plane = self.cone.of_surface(surface.across, surface.along).times(self.unit);
        let (shape, _) = self.shape(lines, planes.edges.map(owns_boundary), plane)?;
        let [least, greatest] = surface.range().map(|r| (r * self.unit) as f32);
        Some(ShapeRecord { least, greatest, ..shape })
    }

    /// With the sizes that edge functions have been divided by.
    fn shape(&self, edges: [Linear; 3], owns: [bool; 3], plane: Linear) -> Option<(ShapeRecord, [f64; 3])> {
        let sizes = edges.map(|edge| edge.size());
        let sound = sizes.iter().all(|size| size.is_normal()) && plane.size().is_finite();
        let edges = [0, 1, 2].map(|i| edges[i].times(1.0 / sizes[i]));
        let single = |f: [f64; 4]| f.map(|v| v as f32);
        let owns = (0..3).map(|i| u32::from(owns[i]) << i).sum::<u32>();
        let shape = ShapeRecord {
            edges: edges.map(|edge| single(edge.factors)),
            edges_constant: edges.map(|edge| edge.constant as f32),
            owns_and_body: owns | (self.body as u32) << 3,
            plane: single(plane.factors),
            plane_constant: plane.constant as f32,
            ..ShapeRecord::default()
        };
        sound.then_some((shape, sizes))
    }
}
