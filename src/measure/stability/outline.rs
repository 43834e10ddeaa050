//! How far the drawn outline of one triangle is from where it is.

use super::wide::{Vector, cross, dot, offset};
use crate::film::Film;
use crate::relativity::Motion;
use crate::scene::{Camera, Projection};
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use terrell_geodesic::{Lorentz, Observer, Real, Rest, Wide};

/// The outline of a triangle in a pinhole's picture, to 32 digits.
///
/// A line of sight meets the plane through the observer and an edge where N·K′ = 0 in the rest frame; in the observer's, that
/// is the product of K with N boosted: a circle of the sky.
pub(super) struct Outline {
    /// Products with (|v|, v), v a line of sight, positive inside.
    edges: [(Wide, Vector); 3],
    camera: Camera,
}

impl Outline {
    /// Of a triangle of a body, by its corners in the rest frame; none if it is seen edge-on.
    pub fn new(motion: &Motion, camera: &Camera, corners: [DVec3; 3]) -> Option<Self> {
        debug_assert_eq!(camera.lens.projection(), Projection::Pinhole);
        let observer = &camera.observer;
        let [a, b, c] = corners.map(|x| offset(motion, observer.event(), x));
        let planes = [cross(a, b), cross(b, c), cross(c, a)];
        let volume = dot(planes[0], c);
        if volume.high == 0.0 {
            return None;
        }
        let sign = Wide::from(volume.high.signum());
        let rest_from_observer: Lorentz<Rest, Observer, Wide> =
            motion.world_from_rest::<Wide>().inverse() * observer.observer_from_world::<Wide>().inverse();
        let rows = rest_from_observer.rows();
        let edges = planes.map(|plane| {
            let plane = plane.map(|c| c * sign);
            let component = |j: usize| dot(plane, [rows[1][j], rows[2][j], rows[3][j]]);
            (-component(0), [component(1), component(2), component(3)])
        });
        Some(Self { edges, camera: *camera })
    }

    /// How far within the outline a point of the picture is, in pixels; outside, negative.
    fn depth(&self, pixel: DVec2) -> f64 {
        let lens = &self.camera.lens;
        let focal = lens.focal();
        let at = pixel - lens.middle();
        let [x, y] = [Wide::from(at.x) / Wide::from(focal.x), Wide::from(-at.y) / Wide::from(focal.y)];
        let v = [x, y, Wide::from(1.0)];
        let length = dot(v, v).sqrt();
        let depth = |(time, space): &(Wide, Vector)| {
            let value = dot(*space, v) + *time * length;
            let slope = |i: usize| (space[i] + *time * v[i] / length).value();
            let slope = DVec2::new(slope(0), slope(1)) / focal;
            (value / Wide::from(slope.length())).value()
        };
        self.edges.iter().map(depth).fold(f64::INFINITY, f64::min)
    }

    /// The same in f64, and by how much that may be off.
    fn rough_depth(&self, pixel: DVec2) -> (f64, f64) {
        let lens = &self.camera.lens;
        let at = (pixel - lens.middle()) / lens.focal();
        let v = DVec3::new(at.x, -at.y, 1.0);
        let length = v.length();
        let mut least = (f64::INFINITY, 0.0);
        for (time, space) in &self.edges {
            let (time, space) = (time.high, DVec3::from_array(space.map(|c| c.high)));
            let slope = (space + time * v / length).truncate() / lens.focal();
            let (depth, off) =
                (space.dot(v) + time * length, 8.0 * f64::EPSILON * (space.length() + time.abs()) * length);
            let (depth, off) = (depth / slope.length(), off / slope.length());
            if depth - off < least.0 - least.1 || depth.is_nan() {
                least = (depth, off);
            }
        }
        least
    }

    /// The greatest distance from the outline of pixels of a film that see what they should not, or do not see what they
    /// should; `sample` is where in a pixel it looked.
    pub fn error(&self, film: &Film, sample: [f64; 2]) -> f64 {
        let width = film.width as usize;
        let error = |i: usize| {
            let pixel = DVec2::new((i % width) as f64, (i / width) as f64) + DVec2::from_array(sample);
            let seen = film.body[i] >= 0;
            let (rough, off) = self.rough_depth(pixel);
            // 32 digits are asked where the others do not tell.
            let depth = if rough.abs() > 100.0 * off { rough } else { self.depth(pixel) };
            if seen == (depth > 0.0) { 0.0 } else { depth.abs() }
        };
        (0..film.body.len()).into_par_iter().map(error).reduce(|| 0.0, f64::max)
    }
}
