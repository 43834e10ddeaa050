use crate::scene::{Lens, Projection};
use glam::DVec3;

/// What subdivision must know of the picture: how many pixels a small angle is worth, and where the picture
/// ends.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    projection: Projection,
    /// Pixels a radian in the middle.
    focal: f64,
    /// Cosine of the angle of the farthest corner from the axis.
    cos_corner: f64,
    /// Inward unit normals of the planes through the observer and the picture's sides (pinhole only).
    sides: [DVec3; 4],
}

/// How the tolerance grows beyond the picture's corner: a piece may be off by a quarter of its distance from
/// the picture and still not reach into it, ...
const SLACK_OUTSIDE: f64 = 0.25;

/// ... but it grows gently, by e in an eighth of a radian at first, or the count of pieces (an integral) would
/// have a corner there that needs as fine a quadrature as the tolerance.
const GROWTH_OUTSIDE: f64 = 4.0;

/// The most a pixel's angle is magnified: the poles of a panorama and the back of a full fisheye are single
/// points drawn as lines, where no tolerance in pixels can be held.
const MAX_SCALE: f64 = 16.0;

impl Field {
    /// The field of a lens.
    pub fn new(lens: &Lens) -> Self {
        let half = |side: u32, focal: f64| 0.5 * f64::from(side) / focal;
        let focal = lens.focal();
        let (x, y) = (half(lens.width(), focal.x), half(lens.height(), focal.y));
        let sides = [
            DVec3::new(1.0, 0.0, x),
            DVec3::new(-1.0, 0.0, x),
            DVec3::new(0.0, 1.0, y),
            DVec3::new(0.0, -1.0, y),
        ];
        Self {
            projection: lens.projection(),
            focal: focal.max_element(),
            cos_corner: lens.cos_corner(),
            sides: sides.map(DVec3::normalize),
        }
    }

    /// Pixels a radian in the middle of the picture.
    pub fn focal(&self) -> f64 {
        self.focal
    }

    /// Tolerance in pixels at a direction `n` when `tolerance` holds inside the picture.
    #[inline]
    pub(super) fn tolerance_at(&self, n: DVec3, tolerance: f64) -> f64 {
        // cos a − cos b ≤ b − a: never more than the angle beyond the corner.
        let beyond = (self.cos_corner - n.z).max(0.0);
        let gentle = tolerance * (1.0 + GROWTH_OUTSIDE * beyond).powi(2);
        gentle.min(tolerance + SLACK_OUTSIDE * self.focal * beyond)
    }

    /// Pixels on the picture that a small angle across a curve through `n` spans, over pixels a radian in the
    /// middle. `binormal` is the unit vector of the sky at right angles to `n` and to the curve.
    #[inline]
    pub(super) fn scale_across(&self, n: DVec3, binormal: DVec3) -> f64 {
        match self.projection {
            Projection::Pinhole => {
                // Area is magnified by L³ and length along the curve by L²√(1 − b²), with L = 1/cos θ: what
                // is left for the width across. At most L².
                let secant = 1.0 / n.z.max(self.cos_corner);
                let along = (1.0 - binormal.z * binormal.z).max(0.0).sqrt();
                secant * (1.0 / along).min(secant)
            }
            _ => self.scale(n),
        }
    }

    /// The greatest magnification of a small angle at `n`, in any direction.
    #[inline]
    pub(super) fn scale(&self, n: DVec3) -> f64 {
        match self.projection {
            Projection::Pinhole => n.z.max(self.cos_corner).powi(-2),
            Projection::Fisheye => {
                let z = n.z.max(self.cos_corner);
                let sine = (1.0 - z * z).max(0.0).sqrt();
                if sine < 1e-4 {
                    if z > 0.0 { 1.0 } else { MAX_SCALE }
                } else {
                    (sine.atan2(z) / sine).min(MAX_SCALE)
                }
            }
            Projection::Panorama => 1.0 / (1.0 - n.y * n.y).max(1.0 / (MAX_SCALE * MAX_SCALE)).sqrt(),
        }
    }

    /// The greatest magnification anywhere in the picture.
    #[inline]
    pub(super) fn greatest_scale(&self) -> f64 {
        match self.projection {
            Projection::Pinhole => self.cos_corner.powi(-2),
            Projection::Fisheye => {
                self.scale(DVec3::new((1.0 - self.cos_corner * self.cos_corner).sqrt(), 0.0, self.cos_corner))
            }
            Projection::Panorama => MAX_SCALE,
        }
    }

    /// Whether a direction is farther from the axis than the picture's corners.
    pub(super) fn is_outside(&self, n: DVec3) -> bool {
        n.z < self.cos_corner
    }

    /// Largest distance in pixels, inside the picture, between the chord from `n0` to `n1` and a curve that
    /// leaves it most at `n_sky` on the sky (where its binormal is `binormal`) and at `n_screen` on the picture.
    pub(super) fn deviation(
        &self,
        [n0, n1]: [DVec3; 2],
        n_sky: DVec3,
        binormal: DVec3,
        n_screen: DVec3,
        outside: bool,
    ) -> f64 {
        let plane = n0.cross(n1);
        let length = plane.length();
        if length == 0.0 {
            return 0.0;
        }
        if self.projection == Projection::Pinhole && !self.is_outside(n_screen) {
            let across = plane.truncate().length();
            return self.focal * (plane.dot(n_screen) / n_screen.z).abs() / across;
        }
        let scale = if outside {
            self.scale_across(n_sky, binormal)
        } else {
            self.scale(n_sky).max(self.scale(n0)).max(self.scale(n1))
        };
        self.focal * scale * (plane.dot(n_sky).abs() / length).min(1.0).asin()
    }

    /// Whether nothing of the cone around the unit vector `axis` (half-angle given by its cosine and sine) can
    /// be in the picture.
    pub(super) fn misses_cone(&self, axis: DVec3, cosine: f64, sine: f64) -> bool {
        if cosine <= 0.0 {
            return false;
        }
        // A cone's edge of rounding noise.
        const NOISE: f64 = 1e-9;
        match self.projection {
            Projection::Pinhole => self.sides.iter().any(|side| axis.dot(*side) < -sine - NOISE),
            Projection::Fisheye => {
                // cos(corner + half-angle), where that is less than 180°.
                let sin_corner = (1.0 - self.cos_corner * self.cos_corner).max(0.0).sqrt();
                let sum_below_pi = sin_corner * cosine + self.cos_corner * sine > 0.0;
                sum_below_pi && axis.z < self.cos_corner * cosine - sin_corner * sine - NOISE
            }
            Projection::Panorama => false,
        }
    }
}
