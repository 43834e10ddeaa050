use super::bins::{Binned, Bins};
use super::triangle::{HalfPlane, Linear, Planes, owns_boundary};
use super::{BAND, Drawable, Samples};
use crate::apparent::ApparentTriangle;
use crate::color::Coloring;
use crate::relativity::DopplerSky;
use crate::scene::{Lens, Projection};
use glam::{DVec2, DVec3};

/// The film's rows to fill.
pub(super) struct Rows<'a> {
    pub color: &'a mut [[f32; 3]],
    pub distance: &'a mut [f32],
    pub doppler: &'a mut [f32],
    pub body: &'a mut [i32],
    pub face: &'a mut [i32],
}

/// What one thread draws a band in, used again for the next.
#[derive(Default)]
pub(super) struct Band {
    /// 1/z (pinhole) or 1/r of the nearest so far.
    nearness: Vec<f32>,
    /// Number of its triangle.
    triangle: Vec<u32>,
    /// Directions of the samples, where they are not a pinhole's; NaN where there is no sky.
    directions: Vec<DVec3>,
}

const NONE: u32 = u32::MAX;

/// Triangles of so few columns are tested pixel by pixel.
const NARROW: u32 = 4;

/// Rows and columns of a rectangle within the band.
struct Window {
    width: usize,
    x: [u32; 2],
    y: [u32; 2],
    top: u32,
}

impl Band {
    #[allow(clippy::too_many_arguments, reason = "one call, from the one place that has all of it")]
    pub fn draw(
        &mut self,
        bodies: &[Drawable<'_>],
        bins: &Bins,
        lens: &Lens,
        samples: &Samples,
        coloring: Coloring,
        top: u32,
        mut rows: Rows<'_>,
    ) {
        let weight = 1.0 / samples.0.len() as f32;
        for (index, &offset) in samples.0.iter().enumerate() {
            let offset = DVec2::from_array(offset);
            self.rasterise(bodies, bins, lens, top, offset, rows.color.len());
            // The first sample is the pixel's centre.
            self.develop(bodies, bins, lens, coloring, top, offset, weight, index == 0, &mut rows);
        }
    }

    fn rasterise(
        &mut self,
        bodies: &[Drawable<'_>],
        bins: &Bins,
        lens: &Lens,
        top: u32,
        offset: DVec2,
        pixels: usize,
    ) {
        self.nearness.clear();
        self.nearness.resize(pixels, 0.0);
        self.triangle.clear();
        self.triangle.resize(pixels, NONE);
        let pinhole = lens.projection() == Projection::Pinhole;
        if !pinhole {
            self.directions.clear();
            self.directions.extend((0..pixels).map(|i| {
                let at = pixel(i, lens.width() as usize, top);
                lens.direction(at + offset).unwrap_or(DVec3::NAN)
            }));
        }
        let height = (pixels / lens.width() as usize) as u32;
        for &Binned { triangle, x, y } in bins.of_band(top / BAND) {
            let (body, number) = bins.locate(triangle);
            let seen = bodies[body].seen;
            let corners = seen.triangles[number].corners.map(|v| seen.vertices[v as usize]);
            let Some(planes) = Planes::new(corners) else { continue };
            let y = [y[0].max(top), y[1].min(top + height)];
            let window = Window { width: lens.width() as usize, x, y, top };
            if pinhole {
                self.fill_pinhole(&planes, lens, offset, triangle, &window);
            } else {
                self.fill_directions(&planes, triangle, &window);
            }
        }
    }

    /// Row by row: what three half-planes have in common is a run of pixels.
    fn fill_pinhole(&mut self, planes: &Planes, lens: &Lens, offset: DVec2, triangle: u32, window: &Window) {
        let (middle, inverse_focal) = (lens.middle(), 1.0 / lens.focal().x);
        let edges = planes.edges.map(|m| HalfPlane::new(m, middle, inverse_focal));
        let nearness = Linear::of_pinhole(planes.nearness, middle, inverse_focal);
        let narrow = window.x[1] - window.x[0] <= NARROW;
        for y in window.y[0]..window.y[1] {
            let at_y = f64::from(y) + offset.y;
            let base = (y - window.top) as usize * window.width;
            let rows = edges.map(|edge| edge.row(at_y));
            let near_row = nearness.row(at_y);
            if narrow {
                for x in window.x[0]..window.x[1] {
                    let at_x = f64::from(x) + offset.x;
                    if (0..3).all(|i| edges[i].holds(rows[i], at_x)) {
                        self.put(base + x as usize, (nearness.a * at_x + near_row) as f32, triangle);
                    }
                }
                continue;
            }
            let mut run = window.x;
            for i in 0..3 {
                run = edges[i].clip(rows[i], offset.x, run);
            }
            let [from, to] = run;
            if from < to {
                let start = nearness.a * (f64::from(from) + offset.x) + near_row;
                let span = base + from as usize..base + to as usize;
                let depths = self.nearness[span.clone()].iter_mut().zip(&mut self.triangle[span]);
                for (i, (depth, id)) in depths.enumerate() {
                    let here = (start + nearness.a * i as f64) as f32;
                    let nearer = here > *depth;
                    *depth = if nearer { here } else { *depth };
                    *id = if nearer { triangle } else { *id };
                }
            }
        }
    }

    #[inline]
    fn put(&mut self, at: usize, nearness: f32, triangle: u32) {
        if nearness > self.nearness[at] {
            self.nearness[at] = nearness;
            self.triangle[at] = triangle;
        }
    }

    fn fill_directions(&mut self, planes: &Planes, triangle: u32, window: &Window) {
        let owns = planes.edges.map(owns_boundary);
        for y in window.y[0]..window.y[1] {
            let base = (y - window.top) as usize * window.width;
            for at in base + window.x[0] as usize..base + window.x[1] as usize {
                let n = self.directions[at];
                let inside = |i: usize| {
                    let e = planes.edges[i].dot(n);
                    e > 0.0 || (owns[i] && e == 0.0)
                };
                if inside(0) && inside(1) && inside(2) {
                    self.put(at, planes.nearness.dot(n) as f32, triangle);
                }
            }
        }
    }

    /// Looks up what the nearest triangles look like.
    #[allow(clippy::too_many_arguments, reason = "the other half of draw")]
    fn develop(
        &self,
        bodies: &[Drawable<'_>],
        bins: &Bins,
        lens: &Lens,
        coloring: Coloring,
        top: u32,
        offset: DVec2,
        weight: f32,
        centre: bool,
        rows: &mut Rows<'_>,
    ) {
        let width = lens.width() as usize;
        let skies: Vec<DopplerSky> = bodies.iter().map(|b| b.map.doppler_sky()).collect();
        let mut last: Option<(u32, usize, ApparentTriangle, Planes)> = None;
        for (line, numbers) in self.triangle.chunks(width).enumerate() {
            for (x, &number) in numbers.iter().enumerate() {
                if number == NONE {
                    continue;
                }
                let i = line * width + x;
                let direction = match self.directions.get(i) {
                    Some(n) => *n,
                    None => {
                        let corner = DVec2::new(x as f64, f64::from(top) + line as f64);
                        lens.direction(corner + offset).unwrap_or(DVec3::Z)
                    }
                };
                if last.is_none_or(|(n, ..)| n != number) {
                    let (body, triangle) = bins.locate(number);
                    let seen = bodies[body].seen;
                    let triangle = seen.triangles[triangle];
                    let corners = triangle.corners.map(|v| seen.vertices[v as usize]);
                    last = Planes::new(corners).map(|planes| (number, body, triangle, planes));
                }
                let Some((_, body, piece, planes)) = &last else { continue };
                let Drawable { body: body_index, mesh, seen, .. } = bodies[*body];
                let face = piece.face as usize;

                let length = direction.length();
                let doppler = skies[*body].towards(direction, length);
                let own = if mesh.paint.is_of_faces() {
                    mesh.paint.at(face, [0; 3], [1.0; 3])
                } else {
                    let e = planes.edges.map(|m| m.dot(direction));
                    let sum = e[0] + e[1] + e[2];
                    mesh.paint.at(face, mesh.triangles[face], seen.rest_weights(piece, e.map(|e| e / sum)))
                };
                let light = coloring.light(own, doppler);
                let color = &mut rows.color[i];
                *color = [0, 1, 2].map(|c| color[c] + weight * light[c]);
                if centre {
                    rows.distance[i] = (length / planes.nearness.dot(direction)) as f32;
                    rows.doppler[i] = doppler as f32;
                    rows.body[i] = body_index as i32;
                    rows.face[i] = face as i32;
                }
            }
        }
    }
}

/// Upper left corner of the i-th pixel of a band.
#[inline]
fn pixel(i: usize, width: usize, top: u32) -> DVec2 {
    DVec2::new((i % width) as f64, f64::from(top) + (i / width) as f64)
}
