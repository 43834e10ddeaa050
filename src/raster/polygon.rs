use crate::scene::{Lens, Projection};
use glam::{DVec2, DVec3};

/// The image of a flat apparent triangle as a polygon of the picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Polygon {
    /// Corners; for a panorama its x may go beyond the picture, whose width it is to be taken modulo.
    pub points: Vec<DVec2>,
    /// Whether what is *outside* is the image: of a triangle that surrounds the back of a whole fisheye.
    pub inverted: bool,
}

/// How far a side drawn straight may be from where it is, in pixels.
const FLAT: f64 = 1.0 / 32.0;

/// Sides are halved so often at least, where they are longer than this many pixels: seen symmetrically, a side's
/// middle may lie where a straight line's would.
const LEAST_HALVINGS: u32 = 3;
const LONG: f64 = 2.0;

/// And so often at most: at a fisheye's back and a panorama's poles.
const MOST_HALVINGS: u32 = 24;

/// Pixels beyond the picture to which polygons are clipped.
pub(super) const BEYOND: f64 = 2.0;

impl Polygon {
    /// None of a triangle that has no image. Two triangles that share an edge, to the bit, share its image.
    pub fn new(lens: &Lens, corners: [DVec3; 3]) -> Option<Self> {
        let polygon = match lens.projection() {
            Projection::Pinhole => Self::clipped(lens, corners),
            Projection::Fisheye => Self::of_fisheye(lens, corners),
            Projection::Panorama => Self::of_panorama(lens, corners),
        };
        (polygon.points.len() > 2 && polygon.points.iter().all(|p| p.is_finite())).then_some(polygon)
    }

    /// Clipped by planes through the observer, a little outside the picture's sides; together they also leave out
    /// what is behind.
    fn clipped(lens: &Lens, corners: [DVec3; 3]) -> Self {
        let half = (lens.middle() + BEYOND) / lens.focal();
        let sides = [
            DVec3::new(1.0, 0.0, half.x),
            DVec3::new(-1.0, 0.0, half.x),
            DVec3::new(0.0, 1.0, half.y),
            DVec3::new(0.0, -1.0, half.y),
        ];
        let mut corners = corners.to_vec();
        for side in sides {
            corners = clip(&corners, |v| v.dot(side));
        }
        // The observer itself has no place in the picture.
        let points = corners.into_iter().filter_map(|v| lens.pixel(v)).collect();
        Self { points, inverted: false }
    }

    fn of_fisheye(lens: &Lens, corners: [DVec3; 3]) -> Self {
        Self { points: outline(lens, corners), inverted: surrounds(corners, DVec3::NEG_Z) }
    }

    fn of_panorama(lens: &Lens, corners: [DVec3; 3]) -> Self {
        let (width, height) = (f64::from(lens.width()), f64::from(lens.height()));
        let mut points = outline(lens, corners);
        let Some(&first) = points.first() else { return Self::default() };
        // Each point on the same side of the seam as the one before.
        let mut turns = 0.0;
        let mut last = first.x;
        for point in points.iter_mut().chain([&mut first.clone()]) {
            let raw = point.x;
            turns -= ((raw - last) / width).round();
            last = raw;
            point.x += turns * width;
        }
        if turns != 0.0 {
            // Around a pole, which is drawn as a line.
            let pole = if surrounds(corners, DVec3::Y) { -BEYOND } else { height + BEYOND };
            let end = first.x + turns * width;
            points.extend([DVec2::new(end, first.y), DVec2::new(end, pole), DVec2::new(first.x, pole)]);
        }
        Self { points, inverted: false }
    }

    /// What of it is in the picture, or close by: for a panorama once for every time it comes round.
    pub fn parts(&self, lens: &Lens) -> Vec<Vec<DVec2>> {
        let size = 2.0 * lens.middle();
        let rounds = match lens.projection() {
            Projection::Pinhole => return vec![self.points.clone()],
            Projection::Fisheye => 0..=0,
            Projection::Panorama => {
                let x = || self.points.iter().map(|p| p.x);
                let round = |x: f64| (x / size.x).floor() as i64;
                round(x().fold(f64::INFINITY, f64::min) - BEYOND)..=round(x().fold(0.0, f64::max) + BEYOND)
            }
        };
        let part = |round: i64| {
            let shift = DVec2::X * (round as f64 * size.x);
            let moved: Vec<_> = self.points.iter().map(|p| *p - shift).collect();
            let right = clip(&moved, |p| p.x + BEYOND);
            let left = clip(&right, |p| size.x + BEYOND - p.x);
            let below = clip(&left, |p| p.y + BEYOND);
            clip(&below, |p| size.y + BEYOND - p.y)
        };
        rounds.map(part).filter(|part| part.len() > 2).collect()
    }
}

/// A point, of space or of the picture.
trait Point:
    Copy + std::ops::Add<Output = Self> + std::ops::Sub<Output = Self> + std::ops::Mul<f64, Output = Self>
{
    fn comes_before(&self, other: &Self) -> bool;
}

impl Point for DVec3 {
    fn comes_before(&self, other: &Self) -> bool {
        self.to_array() <= other.to_array()
    }
}

impl Point for DVec2 {
    fn comes_before(&self, other: &Self) -> bool {
        self.to_array() <= other.to_array()
    }
}

/// The part of a polygon on one side of a plane or line (Sutherland and Hodgman 1974). A side is cut at the same
/// point whichever way it goes, so that neighbours stay so.
fn clip<P: Point>(corners: &[P], height: impl Fn(P) -> f64) -> Vec<P> {
    let mut kept = Vec::with_capacity(corners.len() + 1);
    for (i, &to) in corners.iter().enumerate() {
        let from = corners[(i + corners.len() - 1) % corners.len()];
        if (height(from) >= 0.0) != (height(to) >= 0.0) {
            let (a, b) = in_order(from, to);
            let (here, there) = (height(a), height(b));
            kept.push(a + (b - a) * (here / (here - there)));
        }
        if height(to) >= 0.0 {
            kept.push(to);
        }
    }
    kept
}

fn in_order<P: Point>(a: P, b: P) -> (P, P) {
    if a.comes_before(&b) { (a, b) } else { (b, a) }
}

/// Whether a direction is within the triangle.
fn surrounds([a, b, c]: [DVec3; 3], direction: DVec3) -> bool {
    let inside = [a.cross(b), b.cross(c), c.cross(a)].map(|plane| plane.dot(direction));
    let volume = a.cross(b).dot(c);
    inside.iter().all(|side| side * volume.signum() > 0.0)
}

/// The sides as curves of the picture, one after the other; each begins with its corner and lacks its end.
fn outline(lens: &Lens, corners: [DVec3; 3]) -> Vec<DVec2> {
    let units = corners.map(DVec3::normalize);
    let mut points = Vec::new();
    for i in 0..3 {
        let (from, to) = (units[i], units[(i + 1) % 3]);
        let (a, b) = in_order(from, to);
        let mut side = Vec::new();
        if let (Some(start), Some(end)) = (lens.pixel(a), lens.pixel(b)) {
            side.push(start);
            bend(lens, (a, start), (b, end), 0, &mut side);
            side.push(end);
        }
        if a != from {
            side.reverse();
        }
        side.pop();
        points.extend(side);
    }
    points
}

/// The points between two of a side.
fn bend(lens: &Lens, a: (DVec3, DVec2), b: (DVec3, DVec2), halvings: u32, out: &mut Vec<DVec2>) {
    let direction = (a.0 + b.0).normalize();
    let Some(pixel) = lens.pixel(direction) else { return };
    let middle = (direction, pixel);
    let (before, after) = (step(lens, a.1, middle.1), step(lens, middle.1, b.1));
    let length = before.length() + after.length();
    let flat = 0.5 * (before - after).length() <= FLAT && (halvings >= LEAST_HALVINGS || length <= LONG);
    if flat
        || halvings >= MOST_HALVINGS
        || !length.is_finite()
        || (halvings > LEAST_HALVINGS && is_far(lens, a.1, b.1, length))
    {
        return;
    }
    bend(lens, a, middle, halvings + 1, out);
    out.push(middle.1);
    bend(lens, middle, b, halvings + 1, out);
}

/// From one point of the picture to another, the shorter way around a panorama.
fn step(lens: &Lens, from: DVec2, to: DVec2) -> DVec2 {
    let mut step = to - from;
    if lens.projection() == Projection::Panorama {
        let width = f64::from(lens.width());
        step.x -= (step.x / width).round() * width;
    }
    step
}

/// Whether a curve of this length is outside the picture.
fn is_far(lens: &Lens, a: DVec2, b: DVec2, length: f64) -> bool {
    let size = 2.0 * lens.middle();
    let (low, high) = (a.min(b) - length - BEYOND, a.max(b) + length + BEYOND);
    lens.projection() != Projection::Panorama && (high.cmplt(DVec2::ZERO).any() || low.cmpgt(size).any())
}
