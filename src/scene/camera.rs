use glam::{DVec2, DVec3};
use terrell_geodesic::Tetrad;

/// How directions become points of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Projection {
    /// Straight lines stay straight; the field is the full *vertical* angle.
    Pinhole,
    /// Equidistant: angle from the axis is distance from the middle; the field is the full angle over the
    /// picture's height.
    Fisheye,
    /// Equirectangular: the whole sky, 360° wide and 180° high.
    Panorama,
}

impl std::fmt::Display for Projection {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Pinhole => "pinhole",
            Self::Fisheye => "fisheye",
            Self::Panorama => "panorama",
        })
    }
}

/// The lens and the film's size: maps directions in the observer's axes (x right, y up, z forward) to pixels
/// (x right, y down, centres at +0.5) and back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    projection: Projection,
    width: u32,
    height: u32,
    /// Pixels a unit of tan θ (pinhole) or a radian, horizontally and vertically.
    focal: DVec2,
}

/// Why a lens cannot be built.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum LensError {
    /// No pixels, or more than a picture can have.
    #[error(
        "a picture of {0}x{1} pixels cannot be made; each side must lie between 1 and {MAX_SIDE}, and there can be at most {MAX_PIXELS} in all"
    )]
    Size(u32, u32),
    /// A field the projection cannot show.
    #[error("a {projection} cannot have a field of {fov_deg}°; {allowed}")]
    Field {
        /// Which.
        projection: Projection,
        /// What was asked, degrees.
        fov_deg: f64,
        /// What is possible.
        allowed: &'static str,
    },
}

/// The longest side of a picture, in pixels.
pub const MAX_SIDE: u32 = 32_768;

/// The most pixels of a picture: a film of so many takes 4 GB.
pub const MAX_PIXELS: u64 = 1 << 27;

/// The least field, degrees: below, pixels are closer together than f64 tells directions apart.
const MIN_FOV_DEG: f64 = 1e-6;

impl Lens {
    /// A lens of the given full field in degrees (see [`Projection`] for what it spans; a panorama's is 360).
    ///
    /// # Errors
    /// On an empty or huge picture and on fields the projection cannot show.
    pub fn new(projection: Projection, fov_deg: f64, width: u32, height: u32) -> Result<Self, LensError> {
        let sides = [width, height].iter().all(|side| (1..=MAX_SIDE).contains(side));
        if !sides || u64::from(width) * u64::from(height) > MAX_PIXELS {
            return Err(LensError::Size(width, height));
        }
        let field = |allowed| LensError::Field { projection, fov_deg, allowed };
        let (w, h) = (f64::from(width), f64::from(height));
        let half = 0.5 * fov_deg.to_radians();
        let focal = match projection {
            Projection::Pinhole if !(MIN_FOV_DEG..=175.0).contains(&fov_deg) => {
                return Err(field("it needs 0.000001° to 175° (beyond, use a fisheye or a panorama)"));
            }
            Projection::Pinhole => DVec2::splat(0.5 * h / half.tan()),
            Projection::Fisheye if !(MIN_FOV_DEG..=360.0).contains(&fov_deg) => {
                return Err(field("it needs 0.000001° to 360°"));
            }
            Projection::Fisheye => DVec2::splat(0.5 * h / half),
            Projection::Panorama if fov_deg != 360.0 => return Err(field("it always shows 360°")),
            Projection::Panorama => DVec2::new(w / std::f64::consts::TAU, h / std::f64::consts::PI),
        };
        Ok(Self { projection, width, height, focal })
    }

    /// The same field on a picture of at most so many pixels across.
    pub fn within(&self, across: u32) -> Self {
        let width = self.width.min(across.max(1));
        let factor = f64::from(width) / f64::from(self.width);
        let height = ((f64::from(self.height) * factor).round() as u32).max(1);
        let factors = DVec2::new(factor, f64::from(height) / f64::from(self.height));
        // A pinhole's and a fisheye's pixels are square.
        let focal = match self.projection {
            Projection::Panorama => self.focal * factors,
            _ => self.focal * factor,
        };
        Self { width, height, focal, ..*self }
    }

    /// Which projection.
    pub fn projection(&self) -> Projection {
        self.projection
    }

    /// Pixels across.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Pixels down.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Pixels a radian in the middle of the picture, horizontally and vertically.
    pub fn focal(&self) -> DVec2 {
        self.focal
    }

    /// The picture's middle, in pixels.
    pub fn middle(&self) -> DVec2 {
        0.5 * DVec2::new(f64::from(self.width), f64::from(self.height))
    }

    /// The direction seen at a point of the picture, unit length except for a pinhole, whose z is 1; none
    /// beyond the edge of a fisheye's sky.
    #[inline]
    pub fn direction(&self, pixel: DVec2) -> Option<DVec3> {
        let at = (pixel - self.middle()) / self.focal;
        match self.projection {
            Projection::Pinhole => Some(DVec3::new(at.x, -at.y, 1.0)),
            Projection::Fisheye => {
                let theta = at.length();
                let (sin, cos) = theta.sin_cos();
                let scale = if theta > 0.0 { sin / theta } else { 1.0 };
                (theta <= std::f64::consts::PI).then(|| DVec3::new(at.x * scale, -at.y * scale, cos))
            }
            Projection::Panorama => {
                let ((sin_lon, cos_lon), (sin_lat, cos_lat)) = (at.x.sin_cos(), at.y.sin_cos());
                Some(DVec3::new(cos_lat * sin_lon, -sin_lat, cos_lat * cos_lon))
            }
        }
    }

    /// The point of the picture at which a direction of any length is seen; none for a pinhole where it
    /// points backwards.
    pub fn pixel(&self, direction: DVec3) -> Option<DVec2> {
        let DVec3 { x, y, z } = direction;
        let at = match self.projection {
            Projection::Pinhole if z <= 0.0 => return None,
            Projection::Pinhole => DVec2::new(x / z, -y / z),
            Projection::Fisheye => {
                let across = x.hypot(y);
                let theta = across.atan2(z);
                let scale = if across > 0.0 { theta / across } else { 0.0 };
                DVec2::new(x * scale, -y * scale)
            }
            Projection::Panorama => DVec2::new(x.atan2(z), -y.atan2(x.hypot(z))),
        };
        Some(self.middle() + at * self.focal)
    }

    /// Cosine of the angle between the axis and the farthest corner of the picture; −1 where it shows the
    /// whole sky.
    pub fn cos_corner(&self) -> f64 {
        let corner = (self.middle() / self.focal).length();
        match self.projection {
            Projection::Pinhole => 1.0 / (1.0 + corner * corner).sqrt(),
            Projection::Fisheye => corner.min(std::f64::consts::PI).cos(),
            Projection::Panorama => -1.0,
        }
    }
}

/// An observer with a lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Event, motion and axes.
    pub observer: Tetrad,
    /// Projection and size of the picture.
    pub lens: Lens,
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn lenses() -> [Lens; 4] {
        [
            Lens::new(Projection::Pinhole, 60.0, 160, 120).unwrap(),
            Lens::new(Projection::Fisheye, 180.0, 200, 200).unwrap(),
            Lens::new(Projection::Fisheye, 360.0, 64, 80).unwrap(),
            Lens::new(Projection::Panorama, 360.0, 360, 180).unwrap(),
        ]
    }

    #[test]
    fn what_no_lens_can_show_is_refused() {
        let make = |p, fov| Lens::new(p, fov, 4, 4);
        for fov in [0.0, -10.0, 180.0, 200.0, f64::NAN] {
            assert!(make(Projection::Pinhole, fov).is_err(), "{fov}");
        }
        assert!(make(Projection::Fisheye, 361.0).is_err());
        assert!(make(Projection::Panorama, 180.0).is_err());
        assert_eq!(Lens::new(Projection::Pinhole, 60.0, 0, 5), Err(LensError::Size(0, 5)));
        assert!(Lens::new(Projection::Pinhole, 60.0, 5, MAX_SIDE + 1).is_err());
    }

    proptest! {
        #[test]
        fn a_pixel_looks_where_it_is_seen(x in 0.0..1.0f64, y in 0.0..1.0f64) {
            for lens in lenses() {
                let pixel = DVec2::new(x * f64::from(lens.width()), y * f64::from(lens.height()));
                if let Some(direction) = lens.direction(pixel) {
                    let back = lens.pixel(direction).unwrap();
                    prop_assert!((back - pixel).length() < 1e-9, "{lens:?} {pixel} {back}");
                }
            }
        }
    }
}
