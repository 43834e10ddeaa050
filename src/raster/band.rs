use super::bins::{Binned, Bins};
use super::triangle::{Linear, Planes, owns_boundary};
use super::{BAND, Drawable, Samples};
use crate::color::Coloring;
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

    /// Row by row: each edge function is linear in x, so that what it admits is a half-line whose end is
    /// guessed by division and settled by the function itself.
    fn fill_pinhole(&mut self, planes: &Planes, lens: &Lens, offset: DVec2, triangle: u32, window: &Window) {
        let (width, height, focal) = (f64::from(lens.width()), f64::from(lens.height()), lens.focal().x);
        let linear = |m: DVec3| Linear::of_pinhole(m, width, height, focal);
        let edges = planes.edges.map(linear);
        let owns = planes.edges.map(owns_boundary);
        let nearness = linear(planes.nearness);
        for y in window.y[0]..window.y[1] {
            let at_y = f64::from(y) + offset.y;
            let base = (y - window.top) as usize * window.width;
            let [mut from, mut to] = window.x;
            for (edge, owns) in edges.iter().zip(owns) {
                let row = edge.row(at_y);
                let inside = |x: u32| {
                    let e = edge.a * (f64::from(x) + offset.x) + row;
                    e > 0.0 || (owns && e == 0.0)
                };
                if from >= to {
                    break;
                }
                if edge.a == 0.0 {
                    if !inside(from) {
                        to = from;
                    }
                    continue;
                }
                let crossing = (-row / edge.a - offset.x).clamp(f64::from(from) - 1.0, f64::from(to) + 1.0);
                if edge.a > 0.0 {
                    let mut first = crossing.ceil().max(f64::from(from)) as u32;
                    while first > from && inside(first - 1) {
                        first -= 1;
                    }
                    while first < to && !inside(first) {
                        first += 1;
                    }
                    from = first;
                } else {
                    let mut end = (crossing.floor() + 1.0).clamp(f64::from(from), f64::from(to)) as u32;
                    while end < to && inside(end) {
                        end += 1;
                    }
                    while end > from && !inside(end - 1) {
                        end -= 1;
                    }
                    to = end;
                }
            }
            if from < to {
                let start = nearness.a * (f64::from(from) + offset.x) + nearness.row(at_y);
                let span = base + from as usize..base + to as usize;
                let depths = self.nearness[span.clone()].iter_mut().zip(&mut self.triangle[span]);
                for (i, (depth, id)) in depths.enumerate() {
                    let here = (start + nearness.a * i as f64) as f32;
                    if here > *depth {
                        *depth = here;
                        *id = triangle;
                    }
                }
            }
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
                    let here = planes.nearness.dot(n) as f32;
                    if here > self.nearness[at] {
                        self.nearness[at] = here;
                        self.triangle[at] = triangle;
                    }
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
        let mut last: Option<(u32, usize, usize, Planes)> = None;
        for (i, &number) in self.triangle.iter().enumerate() {
            if number == NONE {
                continue;
            }
            let direction = match self.directions.get(i) {
                Some(n) => *n,
                None => lens.direction(pixel(i, width, top) + offset).unwrap_or(DVec3::Z),
            };
            if last.is_none_or(|(n, ..)| n != number) {
                let (body, triangle) = bins.locate(number);
                let seen = bodies[body].seen;
                let corners = seen.triangles[triangle].corners.map(|v| seen.vertices[v as usize]);
                last = Planes::new(corners).map(|planes| (number, body, triangle, planes));
            }
            let Some((_, body, triangle, planes)) = &last else { continue };
            let Drawable { body: body_index, mesh, map, seen } = bodies[*body];
            let piece = seen.triangles[*triangle];
            let face = piece.face as usize;

            let length = direction.length();
            let doppler = map.doppler_towards(direction / length);
            let own = if mesh.paint.is_of_faces() {
                mesh.paint.at(face, [0; 3], [1.0; 3])
            } else {
                let e = planes.edges.map(|m| m.dot(direction));
                let sum = e[0] + e[1] + e[2];
                mesh.paint.at(face, mesh.triangles[face], seen.rest_weights(&piece, e.map(|e| e / sum)))
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

/// Upper left corner of the i-th pixel of a band.
#[inline]
fn pixel(i: usize, width: usize, top: u32) -> DVec2 {
    DVec2::new((i % width) as f64, f64::from(top) + (i / width) as f64)
}
