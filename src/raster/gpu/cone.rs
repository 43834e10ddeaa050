use super::records::SkyRecord;
use crate::relativity::RestSky;
use crate::scene::{Lens, Projection};
use glam::{DVec2, DVec3};

/// Light-cone coordinates of a body's motion: of a line of sight v of length L, (v·e₁, v·e₂, L + v·û, L − v·û).
///
/// The boost multiplies the third by k and divides the fourth by it, so that whatever a line of sight meets in the rest
/// frame is linear in the four. Single precision is enough for them, at any γ, if they are counted from the pole of the
/// motion from which everything spreads, −û, near which most of the rest sky is crowded: there all four, and what is
/// linear in them, keep their digits. Where a pinhole's picture is far from that pole they are counted from its middle.
pub(super) struct LightCone {
    first: DVec3,
    second: DVec3,
    axis: DVec3,
    stretches: [f64; 2],
    /// The coordinates of the place they are counted from.
    place: [f64; 4],
    pub record: SkyRecord,
}

/// A pole at so many half diagonals from a pinhole's middle, or nearer, is what is counted from.
const NEAR: f64 = 4.0;

/// A pole as near to a fisheye's middle, or to what is behind, in radians, is one with it: single precision of a unit vector
/// is enough there.
const MIDDLE: f64 = 1e-3;

impl LightCone {
    pub fn new(sky: &RestSky, lens: &Lens) -> Self {
        let axis = sky.axis();
        let pole = lens.pixel(-axis).filter(|p| p.is_finite());
        let (first, second) = axis.any_orthonormal_pair();
        let mut cone = Self {
            first,
            second,
            axis,
            stretches: sky.stretches(),
            place: [0.0; 4],
            record: SkyRecord::default(),
        };
        match lens.projection() {
            Projection::Pinhole => cone.count_from(lens, pole),
            Projection::Fisheye => cone.turn_to(lens, pole),
            Projection::Panorama => {
                // East and north.
                let across = DVec2::new(-axis.x, -axis.z);
                let mut pixel = pole.unwrap_or_default();
                let (sine, cosine) =
                    if across == DVec2::ZERO { (0.0, 1.0) } else { across.normalize().into() };
                if across == DVec2::ZERO {
                    pixel.x = lens.middle().x;
                }
                cone.first = DVec3::new(cosine, 0.0, -sine);
                cone.second = DVec3::new(axis.y * sine, across.length(), axis.y * cosine);
                cone.set_pixel(pixel);
                cone.record.place[0] = -axis.y as f32;
            }
        }
        let [k, inverse_k] = cone.stretches;
        cone.record.first = cone.first.as_vec3().to_array();
        cone.record.second = cone.second.as_vec3().to_array();
        cone.record.axis = axis.as_vec3().to_array();
        (cone.record.k, cone.record.inverse_k) = (k as f32, inverse_k as f32);
        cone
    }

    fn set_pixel(&mut self, pixel: DVec2) {
        self.record.pixel = pixel.floor().as_vec2().to_array();
        self.record.beside = (pixel - pixel.floor()).as_vec2().to_array();
    }

    /// Of a pinhole.
    fn count_from(&mut self, lens: &Lens, pole: Option<DVec2>) {
        let middle = lens.middle();
        let pole = pole.filter(|p| (*p - middle).length() <= NEAR * middle.length());
        let pixel = pole.unwrap_or(middle);
        self.set_pixel(pixel);
        let v = lens.direction(pixel).unwrap_or(DVec3::Z);
        let length = v.length();
        self.place = match pole {
            Some(_) => [0.0, 0.0, 0.0, 2.0 * length],
            None => self.coordinates(v),
        };
        self.record.from_pole = u32::from(pole.is_some());
        let [k, inverse_k] = self.stretches;
        let rest_length = 0.5 * (k * self.place[2] + inverse_k * self.place[3]);
        self.record.place = [v.x as f32, v.y as f32, length as f32, rest_length as f32];
    }

    /// Of a fisheye: away from the middle, and across that.
    fn turn_to(&mut self, lens: &Lens, pole: Option<DVec2>) {
        let Some(pixel) = pole else { return };
        let at = (pixel - lens.middle()) / lens.focal();
        let theta = at.length();
        if !(MIDDLE..std::f64::consts::PI - MIDDLE).contains(&theta) {
            return;
        }
        let (sine, cosine) = theta.sin_cos();
        let out = at / theta;
        self.first = DVec3::new(cosine * out.x, -cosine * out.y, -sine);
        self.second = DVec3::new(-out.y, -out.x, 0.0);
        self.set_pixel(pixel);
        self.record.from_pole = 1;
        self.record.place = [at.x as f32, at.y as f32, theta as f32, cosine as f32];
    }

    fn coordinates(&self, v: DVec3) -> [f64; 4] {
        let (length, along) = (v.length(), v.dot(self.axis));
        [v.dot(self.first), v.dot(self.second), length + along, length - along]
    }

    /// The product of a vector of the rest frame, in the observer's axes, with boosted lines of sight.
    #[inline]
    pub fn of_boosted(&self, m: DVec3) -> Linear {
        let along = 0.5 * m.dot(self.axis);
        let [k, inverse_k] = self.stretches;
        self.linear([m.dot(self.first), m.dot(self.second), k * along, -inverse_k * along])
    }

    /// The product of a vector with lines of sight.
    #[inline]
    pub fn of_sight(&self, m: DVec3) -> Linear {
        let along = 0.5 * m.dot(self.axis);
        self.linear([m.dot(self.first), m.dot(self.second), along, -along])
    }

    /// `across` times the line of sight plus `along` times the boosted one's part along the motion.
    #[inline]
    pub fn of_surface(&self, across: DVec3, along: f64) -> Linear {
        let [k, inverse_k] = self.stretches;
        let (there, along) = (0.5 * across.dot(self.axis), 0.5 * along);
        let [plus, minus] = [there + k * along, -there - inverse_k * along];
        self.linear([across.dot(self.first), across.dot(self.second), plus, minus])
    }

    #[inline]
    fn linear(&self, factors: [f64; 4]) -> Linear {
        let constant = (0..4).map(|i| factors[i] * self.place[i]).sum();
        Linear { factors, constant }
    }

    /// The coordinates in the rest frame of a point that is seen at a place.
    #[inline]
    pub fn rest_of_point(&self, seen: DVec3) -> [f64; 4] {
        let [first, second] = [seen.dot(self.first), seen.dot(self.second)];
        let (length, along) = (seen.length(), seen.dot(self.axis));
        let larger = length + along.abs();
        let smaller = if larger > 0.0 { (first * first + second * second) / larger } else { 0.0 };
        let [plus, minus] = if along < 0.0 { [smaller, larger] } else { [larger, smaller] };
        let [k, inverse_k] = self.stretches;
        [first, second, k * plus, inverse_k * minus]
    }
}

/// A function of light-cone coordinates, less those of their place.
#[derive(Clone, Copy)]
pub(super) struct Linear {
    pub factors: [f64; 4],
    pub constant: f64,
}

impl Linear {
    /// Times a number.
    pub fn times(self, by: f64) -> Self {
        Self { factors: self.factors.map(|f| f * by), constant: self.constant * by }
    }

    /// The greatest of the factors.
    pub fn size(&self) -> f64 {
        self.factors.iter().fold(0.0, |size, f| size.max(f.abs()))
    }
}
