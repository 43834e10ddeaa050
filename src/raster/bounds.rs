use crate::relativity::ApparentMap;
use crate::scene::{Lens, Projection};
use glam::{DVec2, DVec3, Vec4};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Pixels, the ends excluded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Rect {
    pub x: [u32; 2],
    pub y: [u32; 2],
}

/// Finds the pixels a triangle can cover: never too few.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounder<'a> {
    lens: &'a Lens,
    /// Least and greatest offset of a sample in its pixel.
    samples: [DVec2; 2],
}

/// For what single-precision screen positions of vertices may be off by, and more.
pub(crate) const SLACK_PX: f64 = 0.01;

impl<'a> Bounder<'a> {
    pub fn new(lens: &'a Lens, samples: [[f64; 2]; 2]) -> Self {
        Self { lens, samples: samples.map(DVec2::from_array) }
    }

    /// Screen position of a vertex, not a number where it has none.
    pub fn project(&self, vertex: DVec3) -> [f32; 2] {
        match self.lens.projection() {
            Projection::Pinhole => {
                self.lens.pixel(vertex).map_or([f32::NAN; 2], |p| [p.x as f32, p.y as f32])
            }
            // Bounded by cones, not by corners.
            _ => [f32::NAN; 2],
        }
    }

    /// The pixels whose samples may lie in the triangle; two rectangles where it lies across a panorama's seam.
    #[inline]
    pub fn bounds(&self, screen: [[f32; 2]; 3], corners: impl Fn() -> [DVec3; 3]) -> [Option<Rect>; 2] {
        let [a, b, c] = screen;
        if (a[0] + b[0] + c[0]).is_finite() && (a[1] + b[1] + c[1]).is_finite() {
            let range = |i: usize| [f64::from(a[i].min(b[i]).min(c[i])), f64::from(a[i].max(b[i]).max(c[i]))];
            return [self.rect(range(0), range(1)), None];
        }
        match self.lens.projection() {
            Projection::Pinhole if corners().iter().all(|v| v.z <= 0.0) => [None; 2],
            // Across the camera plane: anywhere; bands and rows reject what the planes exclude.
            Projection::Pinhole => [self.everything(), None],
            Projection::Fisheye => self.of_fisheye(cone(&corners())),
            Projection::Panorama => self.of_panorama(cone(&corners())),
        }
    }

    /// Where points are on a pinhole's picture; none if not all of them are well before the camera.
    #[inline]
    pub fn projected(&self, points: &[DVec3; 6]) -> Option<[DVec2; 6]> {
        let [mut nearest, mut size] = [f64::INFINITY, 0.0];
        for p in points {
            // NaN is not less than anything, and shows in the sum.
            nearest = if p.z < nearest { p.z } else { nearest };
            size += p.abs().element_sum();
        }
        // Nearer to the camera plane, rounding is too large on the picture.
        let fits = self.lens.projection() == Projection::Pinhole && nearest > 1e-9 * size && size < 1e300;
        let (focal, middle) = (self.lens.focal().x, self.lens.middle());
        fits.then(|| points.map(|p| middle + DVec2::new(p.x, -p.y) * (focal / p.z)))
    }

    /// The pixels whose samples may see something within a hull, in the camera's axes.
    #[inline]
    pub fn of_hull(&self, hull: &Hull) -> [Option<Rect>; 2] {
        if let Some(rect) = self.of_small(hull.corners.map(|c| self.place(c)), hull.beside, 0.0) {
            return [rect, None];
        }
        let points = &hull.points();
        match self.lens.projection() {
            Projection::Pinhole => {
                if let Some(places) = self.projected(points) {
                    let (mut low, mut high) = (places[0], places[0]);
                    for p in &places[1..] {
                        (low, high) = (low.min(*p), high.max(*p));
                    }
                    return [self.rect([low.x, high.x], [low.y, high.y]), None];
                }
                let size = points.iter().fold(0.0f64, |size, p| size.max(p.abs().max_element()));
                let behind = points.iter().all(|p| p.z < -1e-9 * size);
                [self.everything().filter(|_| !behind), None]
            }
            Projection::Fisheye => self.of_fisheye(cone(points)),
            Projection::Panorama => self.of_panorama(cone(points)),
        }
    }

    /// Where something seen is on a pinhole's picture.
    #[inline]
    pub fn place(&self, seen: DVec3) -> Place {
        let inverse = 1.0 / seen.z;
        let [x, y] = [seen.x, -seen.y].map(|c| c * (self.lens.focal().x * inverse));
        // Also false for NaN.
        let is_near = x.abs() < MOST && y.abs() < MOST && inverse > 1e-30 && inverse < 1e30;
        if self.lens.projection() == Projection::Pinhole && is_near {
            Place(Vec4::new(x as f32, y as f32, 0.0, inverse as f32))
        } else {
            Place::NOWHERE
        }
    }

    /// The pixels whose samples may see a triangle on a pinhole's picture, by where its corners are and how far beside the
    /// flat one it is seen at most: as [`of_hull`](Self::of_hull), where that is less than a pixel; none where it is more, or too
    /// far out to be told. There are no pixels for one that is surely seen from the back it does not have: `back` is the sign of
    /// its area then, from one corner to the next, and 0 if it has one.
    #[inline]
    pub fn of_small(&self, [a, b, c]: [Place; 3], beside: f64, back: f32) -> Option<Option<Rect>> {
        let (low, high) = (a.0.min(b.0).min(c.0), a.0.max(b.0).max(c.0));
        // What is moved by δ at z is seen elsewhere by (δ/z)(f + |place|), to first order, and by a thousandth of it more.
        let moved = beside as f32 * high.w;
        let farthest = high.x.max(high.y).max(-low.x).max(-low.y);
        let off = 1.01 * moved * (self.lens.focal().x as f32 + farthest);
        // Also false for NaN.
        if !(moved < 1e-3 && off < 1.0) {
            return None;
        }
        let (ab, ac, size) = (b.0 - a.0, c.0 - a.0, high - low);
        // Twice its area: sides that are not straight take as much off that as they are long times how far they are off, which
        // single precision adds to.
        let area = ab.x * ac.y - ab.y * ac.x;
        if back * area > 4.0 * (off + SLACK_PX as f32) * (size.x + size.y) {
            return Some(None);
        }
        let (middle, off) = (self.lens.middle(), f64::from(off));
        let [x, y] = [[low.x, high.x], [low.y, high.y]].map(|range| range.map(f64::from));
        let around = |[low, high]: [f64; 2], middle: f64| [low - off + middle, high + off + middle];
        Some(self.rect(around(x, middle.x), around(y, middle.y)))
    }

    fn everything(&self) -> Option<Rect> {
        Some(Rect { x: [0, self.lens.width()], y: [0, self.lens.height()] })
    }

    #[inline]
    fn rect(&self, x: [f64; 2], y: [f64; 2]) -> Option<Rect> {
        let [low, high] = self.samples;
        let pixels = |range: [f64; 2], low: f64, high: f64, side: u32| {
            // Casts truncate; where that differs from rounding up, the slack covers it.
            let from = (range[0] - SLACK_PX - high + 1.0).clamp(0.0, f64::from(side)) as u32;
            let to = (range[1] + SLACK_PX - low + 1.0).clamp(0.0, f64::from(side)) as u32;
            (from < to).then_some([from, to])
        };
        Some(Rect {
            x: pixels(x, low.x, high.x, self.lens.width())?,
            y: pixels(y, low.y, high.y, self.lens.height())?,
        })
    }

    fn of_fisheye(&self, cone: Option<(DVec3, f64)>) -> [Option<Rect>; 2] {
        let Some((axis, half)) = cone else { return [self.everything(), None] };
        let theta = axis.truncate().length().atan2(axis.z);
        if theta + half >= PI {
            return [self.everything(), None];
        }
        let focal = self.lens.focal();
        let middle = self.lens.middle();
        let (near, far) = ((theta - half).max(0.0), theta + half);
        // Azimuth, y down.
        let azimuth = (-axis.y).atan2(axis.x);
        let spread = if theta > half { (half.sin() / theta.sin()).min(1.0).asin() } else { PI };
        let mut points = vec![];
        for radius in [near, far] {
            for angle in [azimuth - spread, azimuth + spread] {
                points.push(radius * DVec2::from_angle(angle));
            }
        }
        for quarter in 0..4 {
            let angle = f64::from(quarter) * FRAC_PI_2;
            let off = (angle - azimuth + PI).rem_euclid(TAU) - PI;
            if off.abs() <= spread {
                points.push(far * DVec2::from_angle(angle));
            }
        }
        let points = points.into_iter().map(|p| middle + focal * p);
        let (low, high) =
            points.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
        [self.rect([low.x, high.x], [low.y, high.y]), None]
    }

    fn of_panorama(&self, cone: Option<(DVec3, f64)>) -> [Option<Rect>; 2] {
        let Some((axis, half)) = cone else { return [self.everything(), None] };
        let (width, height) = (f64::from(self.lens.width()), f64::from(self.lens.height()));
        let latitude = axis.y.clamp(-1.0, 1.0).asin();
        let y = |latitude: f64| (0.5 - latitude / PI) * height;
        let rows = [y(latitude + half), y(latitude - half)];
        if latitude.abs() + half >= FRAC_PI_2 {
            return [self.rect([0.0, width], rows), None];
        }
        let spread = (half.sin() / latitude.cos()).min(1.0).asin() / TAU * width;
        let middle = (0.5 + axis.x.atan2(axis.z) / TAU) * width;
        let [from, to] = [middle - spread, middle + spread];
        if from < SLACK_PX || to > width - SLACK_PX {
            // Around the seam: the two ends of the rows.
            let (low, high) = if from < SLACK_PX { (to, from + width) } else { (to - width, from) };
            if high <= low {
                return [self.rect([0.0, width], rows), None];
            }
            return [self.rect([0.0, low], rows), self.rect([high, width], rows)];
        }
        [self.rect([from, to], rows), None]
    }
}

/// Where something is seen on a pinhole's picture: pixels from the middle to the right and down, nothing, and 1/z; single
/// precision.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place(Vec4);

/// So many pixels from the middle, single precision is good to a twentieth of [`SLACK_PX`].
const MOST: f64 = 1e4;

impl Place {
    /// What is not before the camera, or far out of the picture.
    pub const NOWHERE: Self = Self(Vec4::new(0.0, 0.0, 0.0, f32::INFINITY));
}

/// Where a triangle is seen, observer's axes: in the convex hull of its corners and of those moved along.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hull {
    corners: [DVec3; 3],
    along: DVec3,
    /// The length of that.
    beside: f64,
}

impl Hull {
    /// Of a triangle whose corners are seen there; `axis` is the map's in the observer's axes, and `beside` what [`beside`] says.
    pub fn new(corners: [DVec3; 3], axis: DVec3, beside: f64) -> Self {
        Self { corners, along: axis * beside, beside }
    }

    /// All the points.
    pub fn points(&self) -> [DVec3; 6] {
        let ([a, b, c], along) = (self.corners, self.along);
        [a, b, c, a + along, b + along, c + along]
    }
}

/// How far beside the flat one between the apparent places of its corners a triangle is seen at most; none for one that is
/// not seen at all. Its corners are at `offsets` from the observer in the rest frame.
///
/// That needs no cutting. Between its corners it is seen beside the flat one along the motion, by γβ(linear r′ − r′), which is
/// at most γβ L²/6r for a longest side L that is no nearer than r, since r′ is convex and bends by 1/r at most. So it is seen
/// within what the flat one sweeps when moved that far.
#[inline]
pub(crate) fn beside(map: &ApparentMap, offsets: [DVec3; 3], one_sided: bool) -> Option<f64> {
    let [a, b, c] = offsets;
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(ac);
    let height = normal.dot(a);
    if normal == DVec3::ZERO || (one_sided && height >= 0.0) {
        return None;
    }
    let nearest = a.length_squared().min(b.length_squared()).min(c.length_squared()).sqrt();
    let side_squared = ab.length_squared().max(ac.length_squared()).max((c - b).length_squared());
    let side = side_squared.sqrt();
    let mut nearest = nearest - side;
    if nearest < side {
        // The plane's distance says more.
        nearest = nearest.max((height / normal.length()).abs());
    }
    Some(most_beside(map, side_squared, nearest))
}

/// The same for triangles of no longer sides than that, squared, of which no point is nearer.
#[inline]
pub(crate) fn most_beside(map: &ApparentMap, side_squared: f64, nearest: f64) -> f64 {
    map.speed() * side_squared / (6.0 * nearest) * (1.0 + 1e-9)
}

/// The cone of directions that holds points' convex hull: unit axis and half-angle, a little wide. None where it is not
/// surely narrower than a half-sky.
fn cone<const N: usize>(corners: &[DVec3; N]) -> Option<(DVec3, f64)> {
    let units = corners.map(DVec3::normalize_or_zero);
    let axis = units.iter().sum::<DVec3>().normalize_or_zero();
    let sine_and_cosine = |u: &DVec3| (u.cross(axis).length(), u.dot(axis));
    let half = units.iter().map(sine_and_cosine).map(|(s, c)| s.atan2(c)).fold(0.0, f64::max);
    (axis != DVec3::ZERO && half < 0.45 * PI).then_some((axis, half + 1e-9))
}
