use super::bins::{Binned, Bins};
use super::triangle::{HalfPlane, Linear, Planes, Surface};
use super::{BAND, Drawable};
use crate::film::{Rows, Samples};
use crate::light::{DopplerAt, Facet, SeenShading, clamped, owns_boundary};
use crate::relativity::RestSky;
use crate::scene::{Lens, Projection};
use glam::{DVec2, DVec3};

/// What one thread draws a band in, used again for the next.
#[derive(Default)]
pub(super) struct Band {
    /// 1/z (pinhole) or 1/r of the nearest so far.
    nearness: Vec<f32>,
    /// Number of its triangle.
    triangle: Vec<u32>,
    /// Directions of the samples, where they are not a pinhole's; NaN where there is no sky.
    directions: Vec<DVec3>,
    /// Their lengths: of (X, Y, 1) for a pinhole, else 1.
    lengths: Vec<f64>,
    /// v′·û of the body being drawn, in its columns.
    along: Vec<f64>,
    /// A row of the triangle being drawn.
    fresh: Vec<f32>,
}

/// A triangle being drawn.
struct Fragment<'a> {
    stage: &'a Stage<'a>,
    sampling: &'a Sampling<'a>,
    surface: &'a Surface,
    triangle: u32,
}

/// Nearest points of two triangles that differ by less, relative, are one: rounding.
const SAME_POINT: f64 = 1e-9;

/// Planes nearer to each other, relative, are in one place, where the first of two triangles is seen: what f64 leaves over.
const SAME_PLANE: f64 = 1e-13;

/// Whether two surfaces at a pixel are so near to each other that outlines drawn too wide could matter; never
/// where nothing is drawn yet.
#[inline]
fn is_close(a: f32, b: f32) -> bool {
    (a - b).abs() < 0.02 * b
}

/// What is drawn.
#[derive(Clone, Copy)]
struct Stage<'a> {
    bodies: &'a [Drawable<'a>],
    skies: &'a [RestSky],
    bins: &'a Bins,
}

impl<'a> Stage<'a> {
    fn seen(&self, number: u32) -> Option<Seen<'a>> {
        let (body, triangle) = self.bins.locate(number);
        Seen::new(&self.bodies[body], &self.skies[body], triangle)
    }
}

/// A sample grid of the band: where its lines of sight go.
#[derive(Clone, Copy)]
struct Sampling<'a> {
    lens: &'a Lens,
    top: u32,
    offset: DVec2,
}

impl Sampling<'_> {
    fn width(&self) -> usize {
        self.lens.width() as usize
    }

    /// Line of sight of a column and a line of the band.
    #[inline]
    fn direction(&self, x: usize, line: usize) -> Option<DVec3> {
        self.towards(x, line, 0.0, 0.0)
    }

    /// Line of sight some pixels beside it.
    #[inline]
    fn towards(&self, x: usize, line: usize, dx: f64, dy: f64) -> Option<DVec3> {
        let at = DVec2::new(x as f64 + dx, f64::from(self.top) + line as f64 + dy);
        self.lens.direction(at + self.offset)
    }
}

const NONE: u32 = u32::MAX;

/// Triangles of so few columns are tested pixel by pixel.
const NARROW: u32 = 4;

/// Rows and columns of a rectangle within the band.
struct Window {
    width: usize,
    x: [u32; 2],
    y: [u32; 2],
}

impl Band {
    #[allow(clippy::too_many_arguments, reason = "one call, from the one place that has all of it")]
    pub fn draw(
        &mut self,
        bodies: &[Drawable<'_>],
        bins: &Bins,
        lens: &Lens,
        samples: &Samples,
        shading: &SeenShading<'_>,
        top: u32,
        mut rows: Rows<'_>,
    ) {
        let weight = 1.0 / samples.offsets().len() as f32;
        let skies: Vec<RestSky> = bodies.iter().map(|b| b.map.rest_sky()).collect();
        let columns = bins.columns(top / BAND, bodies.len());
        let stage = Stage { bodies, skies: &skies, bins };
        for (index, &offset) in samples.offsets().iter().enumerate() {
            let sampling = Sampling { lens, top, offset: DVec2::from_array(offset) };
            self.clear(&sampling, rows.color.len());
            self.rasterise(&stage, &columns, &sampling);
            // The first sample is the pixel's centre.
            self.develop(&stage, shading, &sampling, weight, index == 0, &mut rows);
        }
    }

    /// Fills the rows with what given triangles look like: the number of one for each pixel, none where
    /// `number` says so. One call a sample; the first is the pixel's centre.
    #[allow(clippy::too_many_arguments, reason = "one call, from the one place that has all of it")]
    pub fn draw_known(
        &mut self,
        bodies: &[Drawable<'_>],
        bins: &Bins,
        lens: &Lens,
        samples: &Samples,
        index: usize,
        shading: &SeenShading<'_>,
        top: u32,
        number: impl Fn(usize) -> Option<u32>,
        mut rows: Rows<'_>,
    ) {
        let skies: Vec<RestSky> = bodies.iter().map(|b| b.map.rest_sky()).collect();
        let stage = Stage { bodies, skies: &skies, bins };
        let sampling = Sampling { lens, top, offset: DVec2::from_array(samples.offsets()[index]) };
        self.clear(&sampling, rows.color.len());
        for (i, triangle) in self.triangle.iter_mut().enumerate() {
            let is_sky = self.directions.get(i).is_none_or(|n| !n.is_nan());
            *triangle = if is_sky { number(i).unwrap_or(NONE) } else { NONE };
        }
        let weight = 1.0 / samples.offsets().len() as f32;
        self.develop(&stage, shading, &sampling, weight, index == 0, &mut rows);
    }

    fn clear(&mut self, sampling: &Sampling<'_>, pixels: usize) {
        self.nearness.clear();
        self.nearness.resize(pixels, 0.0);
        self.triangle.clear();
        self.triangle.resize(pixels, NONE);
        self.along.resize(pixels, 0.0);
        self.lengths.clear();
        self.directions.clear();
        let width = sampling.width();
        if sampling.lens.projection() == Projection::Pinhole {
            let direction = |i: usize| sampling.direction(i % width, i / width).unwrap_or(DVec3::Z);
            for line in 0..pixels / width {
                let row = direction(line * width);
                let (across, step) = (row.y * row.y + 1.0, 1.0 / sampling.lens.focal().x);
                self.lengths.extend((0..width).map(|x| {
                    let at = row.x + x as f64 * step;
                    (at * at + across).sqrt()
                }));
            }
        } else {
            let direction = |i: usize| sampling.direction(i % width, i / width).unwrap_or(DVec3::NAN);
            self.directions.extend((0..pixels).map(direction));
            self.lengths.resize(pixels, 1.0);
        }
    }

    fn rasterise(&mut self, stage: &Stage<'_>, columns: &[[u32; 2]], sampling: &Sampling<'_>) {
        let Stage { bodies, skies, bins } = *stage;
        let lens = sampling.lens;
        let pinhole = lens.projection() == Projection::Pinhole;
        let height = (self.nearness.len() / sampling.width()) as u32;
        let mut current = None;
        for &Binned { triangle, x, y } in bins.of_band(sampling.top / BAND) {
            let (body, number) = bins.locate(triangle);
            let Drawable { mesh, map, seen, .. } = bodies[body];
            let piece = seen.triangles[number];
            let corners = piece.corners.map(|v| seen.vertices[v as usize]);
            let Some(planes) = Planes::new(corners) else { continue };
            if current.replace(body) != Some(body) {
                self.boost_lines_of_sight(&skies[body], columns[body], sampling);
            }
            let rest = mesh.corners(piece.face as usize).map(|v| map.offset_rest(v));
            let surface = Surface::new(map, &skies[body], rest, corners, &planes);
            let y = [y[0].max(sampling.top), y[1].min(sampling.top + height)];
            let window = Window { width: sampling.width(), x, y };
            let fragment = Fragment { stage, sampling, surface: &surface, triangle };
            if pinhole {
                self.fill_pinhole(&planes, &fragment, &window);
            } else {
                self.fill_directions(&planes, &fragment, &window);
            }
        }
    }

    /// v′·û of a body for every sample it may cover.
    fn boost_lines_of_sight(&mut self, sky: &RestSky, [from, to]: [u32; 2], sampling: &Sampling<'_>) {
        let width = sampling.width();
        let step = 1.0 / sampling.lens.focal().x;
        for line in 0..self.along.len() / width {
            let row = line * width + from as usize..line * width + to as usize;
            let lengths = &self.lengths[row.clone()];
            let along = &mut self.along[row.clone()];
            if self.directions.is_empty() {
                // Along a row the line of sight changes by the same vector from pixel to pixel.
                let first = sampling.direction(from as usize, line).unwrap_or(DVec3::Z);
                let (along_first, along_step) = (first.dot(sky.axis()), step * sky.axis().x);
                let (cross_first, cross_step) = (first.cross(sky.axis()), step * DVec3::X.cross(sky.axis()));
                for (i, (along, &length)) in along.iter_mut().zip(lengths).enumerate() {
                    let i = i as f64;
                    let square = (cross_first + i * cross_step).length_squared();
                    *along = sky.boosted_parts(along_first + i * along_step, square, length).along;
                }
            } else {
                for (along, &n) in along.iter_mut().zip(&self.directions[row]) {
                    *along = sky.boosted(n, 1.0).along;
                }
            }
        }
    }

    /// Row by row: what three half-planes have in common is a run of pixels.
    fn fill_pinhole(&mut self, planes: &Planes, fragment: &Fragment<'_>, window: &Window) {
        let Fragment { sampling, surface, triangle, .. } = *fragment;
        let Sampling { lens, top, offset } = *sampling;
        let (middle, inverse_focal) = (lens.middle(), 1.0 / lens.focal().x);
        let edges = planes.edges.map(|m| HalfPlane::new(m, middle, inverse_focal));
        let nearness = Linear::of_pinhole(surface.across, middle, inverse_focal);
        let narrow = window.x[1] - window.x[0] <= NARROW;
        for y in window.y[0]..window.y[1] {
            let at_y = f64::from(y) + offset.y;
            let base = (y - top) as usize * window.width;
            let rows = edges.map(|edge| edge.row(at_y));
            let near_row = nearness.row(at_y);
            if narrow {
                for x in window.x[0]..window.x[1] {
                    let at_x = f64::from(x) + offset.x;
                    if (0..3).all(|i| edges[i].holds(rows[i], at_x)) {
                        let at = base + x as usize;
                        let here = nearness.a * at_x + near_row + surface.along * self.along[at];
                        self.put(at, surface.clamped(here, self.lengths[at]) as f32, fragment);
                    }
                }
                continue;
            }
            let mut run = window.x;
            for i in 0..3 {
                run = edges[i].clip(rows[i], offset.x, run);
            }
            let [from, to] = run;
            if from >= to {
                continue;
            }
            let start = nearness.a * (f64::from(from) + offset.x) + near_row;
            let span = base + from as usize..base + to as usize;
            self.fresh.clear();
            let sight = self.along[span.clone()].iter().zip(&self.lengths[span.clone()]);
            self.fresh.extend(sight.enumerate().map(|(i, (along, length))| {
                surface.clamped(start + nearness.a * i as f64 + surface.along * along, *length) as f32
            }));
            let fought = self.fresh.iter().zip(&self.nearness[span.clone()]).any(|(h, d)| is_close(*h, *d));
            if fought {
                for (i, at) in span.enumerate() {
                    self.put(at, self.fresh[i], fragment);
                }
                continue;
            }
            let depths = self.nearness[span.clone()].iter_mut().zip(&mut self.triangle[span]);
            for ((depth, id), &here) in depths.zip(&self.fresh) {
                let nearer = here > *depth;
                *depth = if nearer { here } else { *depth };
                *id = if nearer { triangle } else { *id };
            }
        }
    }

    fn fill_directions(&mut self, planes: &Planes, fragment: &Fragment<'_>, window: &Window) {
        let owns = planes.edges.map(owns_boundary);
        for y in window.y[0]..window.y[1] {
            let base = (y - fragment.sampling.top) as usize * window.width;
            for at in base + window.x[0] as usize..base + window.x[1] as usize {
                let n = self.directions[at];
                let inside = |i: usize| {
                    let e = planes.edges[i].dot(n);
                    e > 0.0 || (owns[i] && e == 0.0)
                };
                if inside(0) && inside(1) && inside(2) {
                    let here = fragment.surface.nearness(n, 1.0, self.along[at]) as f32;
                    self.put(at, here, fragment);
                }
            }
        }
    }

    #[inline]
    fn put(&mut self, at: usize, nearness: f32, fragment: &Fragment<'_>) {
        let there = self.nearness[at];
        let wins =
            if is_close(nearness, there) { self.hides(at, nearness, fragment) } else { nearness > there };
        if wins {
            self.nearness[at] = nearness;
            self.triangle[at] = fragment.triangle;
        }
    }

    /// Whether a fragment hides what is there already and nearly as near, which at high speed is nearer than f32 can tell.
    /// Outlines are drawn up to the tolerance too wide, and there the planes of two faces that meet in the outline have
    /// changed places: if the line of sight passes beside both, and the point nearest to it is one for both, the face whose
    /// plane is farther out here is the nearer one inside.
    #[cold]
    fn hides(&self, at: usize, nearness: f32, fragment: &Fragment<'_>) -> bool {
        let Fragment { stage, sampling, triangle, .. } = fragment;
        let (x, line) = (at % sampling.width(), at / sampling.width());
        let direction = match self.directions.get(at) {
            Some(n) => *n,
            None => sampling.direction(x, line).unwrap_or(DVec3::Z),
        };
        let length = self.lengths[at];
        // Plane, and nearest point beside it.
        let meet = |number: u32| {
            let seen = stage.seen(number)?;
            let along = seen.sky.boosted(direction, length).along;
            let plane = seen.surface.nearness(direction, length, along);
            Some((plane, seen.beside(direction, length, along, plane), seen.drawable.body))
        };
        let (Some((plane, beside, body)), Some((old_plane, old_beside, old_body))) =
            (meet(*triangle), meet(self.triangle[at]))
        else {
            return nearness > self.nearness[at];
        };
        match (beside, old_beside) {
            (Some(new), Some(old)) if body == old_body && (new - old).abs() < SAME_POINT * old => {
                plane < old_plane
            }
            _ if (plane - old_plane).abs() < SAME_PLANE * old_plane => *triangle < self.triangle[at],
            _ => plane > old_plane,
        }
    }

    /// Looks up what the nearest triangles look like.
    fn develop(
        &self,
        stage: &Stage<'_>,
        shading: &SeenShading<'_>,
        sampling: &Sampling<'_>,
        weight: f32,
        centre: bool,
        rows: &mut Rows<'_>,
    ) {
        let width = sampling.width();
        // Each of many samples stands for a part of the pixel.
        let spread = f64::from(weight.sqrt());
        let mut last: Option<(u32, Seen<'_>)> = None;
        for (line, numbers) in self.triangle.chunks(width).enumerate() {
            for (x, &number) in numbers.iter().enumerate() {
                if number == NONE {
                    continue;
                }
                let i = line * width + x;
                let direction = match self.directions.get(i) {
                    Some(n) => *n,
                    None => sampling.direction(x, line).unwrap_or(DVec3::Z),
                };
                if last.as_ref().is_none_or(|(n, _)| *n != number) {
                    last = stage.seen(number).map(|seen| (number, seen));
                }
                let Some((_, seen)) = &last else { continue };
                let length = self.lengths[i];
                let rest = seen.sky.boosted(direction, length);
                let nearness = seen.surface.nearness(direction, length, rest.along);
                let doppler = match shading.doppler_at() {
                    DopplerAt::Pixel => length / rest.length,
                    DopplerAt::Vertex => seen.doppler_of_vertices(direction),
                };
                let v_rest = seen.rest_direction(direction, rest.along);
                let at = v_rest / nearness;
                let sights = || {
                    // A look along the line of sight itself where there is no neighbour: as sharp as can be.
                    let to =
                        |dx, dy| sampling.towards(x, line, dx * spread, dy * spread).unwrap_or(direction);
                    [v_rest, seen.in_rest_frame(to(1.0, 0.0)), seen.in_rest_frame(to(0.0, 1.0))]
                };
                let light = shading.radiance(
                    seen.drawable.body,
                    seen.drawable.mesh.material_index(seen.facet.face()),
                    doppler,
                    || seen.facet.colors(at, sights),
                    || seen.facet.point(at),
                );
                let color = &mut rows.color[i];
                *color = [0, 1, 2].map(|c| color[c] + weight * light[c]);
                if centre {
                    rows.distance[i] = (length / nearness) as f32;
                    rows.doppler[i] = doppler as f32;
                    rows.body[i] = seen.drawable.body as i32;
                    rows.face[i] = seen.facet.face() as i32;
                }
            }
        }
    }
}

/// The triangle a pixel sees.
struct Seen<'a> {
    drawable: &'a Drawable<'a>,
    sky: &'a RestSky,
    /// The mesh's triangle, in the rest frame.
    facet: Facet<'a>,
    /// Corners of the piece, as it is seen.
    corners: [DVec3; 3],
    surface: Surface,
}

impl<'a> Seen<'a> {
    fn new(drawable: &'a Drawable<'a>, sky: &'a RestSky, triangle: usize) -> Option<Self> {
        let Drawable { mesh, map, seen, .. } = drawable;
        let piece = seen.triangles[triangle];
        let face = piece.face as usize;
        let corners = piece.corners.map(|v| seen.vertices[v as usize]);
        let rest = mesh.corners(face).map(|v| map.offset_rest(v));
        let surface = Surface::new(map, sky, rest, corners, &Planes::new(corners)?);
        Some(Self { drawable, sky, facet: Facet::new(mesh, face, rest), corners, surface })
    }

    /// For a line of sight beside the triangle, 1/s of the triangle's point nearest to it; none inside.
    fn beside(&self, v: DVec3, length: f64, rest_along: f64, plane: f64) -> Option<f64> {
        let v_rest = self.rest_direction(v, rest_along);
        let weights = self.facet.weights(v_rest / plane);
        let v_rest = v_rest.normalize();
        let away = |p: DVec3| p - v_rest * p.dot(v_rest);
        let corners = self.drawable.mesh.corners(self.facet.face());
        let rest = self.facet.corners();
        let nearest_of = |i: usize| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let (from, along) = (away(rest[j]), away(rest[k] - rest[j]));
            let t = (-from.dot(along) / along.length_squared()).clamp(0.0, 1.0);
            (
                (from + t * along).length() / (rest[j].length() + rest[k].length()),
                corners[j].lerp(corners[k], t),
            )
        };
        let (_, point) =
            (0..3).filter(|&i| weights[i] < 0.0).map(nearest_of).min_by(|a, b| a.0.total_cmp(&b.0))?;
        Some(length / self.drawable.map.see(point).distance)
    }

    /// The Doppler factors of the piece's corners, interpolated to where a line of sight meets it.
    fn doppler_of_vertices(&self, v: DVec3) -> f64 {
        let [a, b, c] = self.corners;
        // Beside its outline as at it.
        let flip = if a.dot(b.cross(c)) < 0.0 { -1.0 } else { 1.0 };
        let weights = clamped([b.cross(c), c.cross(a), a.cross(b)].map(|edge| flip * edge.dot(v)));
        let doppler = self.corners.map(|v| {
            let length = v.length();
            length / self.sky.boosted(v, length).length
        });
        weights[0] * doppler[0] + weights[1] * doppler[1] + weights[2] * doppler[2]
    }

    /// A line of sight, boosted.
    fn in_rest_frame(&self, v: DVec3) -> DVec3 {
        let along = self.sky.boosted(v, v.length()).along;
        self.rest_direction(v, along)
    }

    /// A line of sight in the rest frame, given its part along the motion there.
    #[inline]
    fn rest_direction(&self, v: DVec3, rest_along: f64) -> DVec3 {
        let across = v - v.dot(self.sky.axis()) * self.sky.axis();
        self.drawable.map.rotate_back(across + rest_along * self.sky.axis())
    }
}
