use super::{Picture, Texture, Wrap, stars};
use crate::spectrum::Spectrum;
use glam::{DMat3, DVec2, DVec3};
use std::f64::consts::TAU;
use std::sync::Arc;

/// What lies at infinity, in all directions, at rest in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct Sky {
    /// What is on it.
    pub texture: SkyTexture,
    /// The light behind it, as of a material: the texture is a filter before it.
    pub spectrum: Spectrum,
    /// From the sky's own axes to the world's.
    pub rotation: DMat3,
}

/// What is on a sky. All have their equator in the x-y plane of the sky's axes, and north at +z.
#[derive(Clone, Debug, PartialEq)]
pub enum SkyTexture {
    /// Squares of 10°, each quarter of the sky, north and south of the equator, in another colour.
    Checker,
    /// Stars of our own, in all colours.
    Stars,
    /// An equirectangular picture: its middle at +y, +x on the right of that, +z at its upper edge.
    Picture(Texture),
}

/// Degrees of a square of the checker.
const SQUARE_DEG: f64 = 10.0;

/// Colours of the checker's quarters, north and south: from +x towards +y.
const QUARTERS: [[[f32; 3]; 4]; 2] = [
    [[0.75, 0.16, 0.10], [0.80, 0.55, 0.08], [0.15, 0.55, 0.16], [0.10, 0.30, 0.80]],
    [[0.50, 0.12, 0.30], [0.52, 0.36, 0.18], [0.10, 0.42, 0.40], [0.30, 0.20, 0.65]],
];

/// What the light squares have of white, and what the dark ones have of their colour.
const LIGHT: f32 = 0.45;
const DARK: f32 = 0.25;

impl SkyTexture {
    /// A picture wrapped around.
    pub fn picture(picture: Picture) -> Self {
        let mut texture = Texture::of(Arc::new(picture));
        texture.wrap = [Wrap::Repeat, Wrap::Clamp];
        Self::Picture(texture)
    }

    /// What it is called.
    pub fn describe(&self) -> &str {
        match self {
            Self::Checker => "checker",
            Self::Stars => "stars",
            Self::Picture(texture) => &texture.picture.name,
        }
    }
}

impl Sky {
    /// Of white light, not turned.
    pub fn new(texture: SkyTexture) -> Self {
        Self { texture, spectrum: Spectrum::default(), rotation: DMat3::IDENTITY }
    }

    /// Its colour, linear sRGB, in a direction of the world, averaged over a pixel; `steps` are how the direction changes
    /// to the neighbouring pixels.
    pub fn color(&self, direction: DVec3, steps: [DVec3; 2]) -> [f32; 3] {
        let own = self.rotation.transpose();
        let (n, steps) = ((own * direction).normalize_or(DVec3::Z), steps.map(|s| own * s));
        match &self.texture {
            SkyTexture::Stars => stars::radiance(n, steps),
            SkyTexture::Checker => {
                let [at, right, below] = places(n, steps);
                let width = (right - at).abs() + (below - at).abs();
                checker(at * (360.0 / SQUARE_DEG), width * (360.0 / SQUARE_DEG))
            }
            SkyTexture::Picture(texture) => {
                let [at, right, below] = places(n, steps);
                // A quarter further, clockwise, and from the top, a whole height being half a turn.
                let uv = DVec2::new((0.75 - at.x).rem_euclid(1.0), 0.5 - 2.0 * at.y);
                let step = [right, below].map(|p| DVec2::new(at.x - p.x, 2.0 * (at.y - p.y)));
                texture.at(uv, step)
            }
        }
    }
}

/// Longitude and latitude in turns, of a direction and its neighbours, all on the same side of where they begin anew.
fn places(n: DVec3, steps: [DVec3; 2]) -> [DVec2; 3] {
    let place = |v: DVec3| DVec2::new(v.y.atan2(v.x) / TAU, v.z.atan2(v.x.hypot(v.y)) / TAU);
    let at = place(n);
    let near = |step: DVec3| {
        let mut p = place(n + step);
        p.x -= (p.x - at.x).round();
        if p.is_finite() { p } else { at }
    };
    [at, near(steps[0]), near(steps[1])]
}

/// At a place in squares, over a width: every side a square wave, averaged.
fn checker(at: DVec2, width: DVec2) -> [f32; 3] {
    let wave = |x: f64, width: f64| {
        let width = width.max(1e-9);
        // The integral of a square wave of period 2 is a triangle wave.
        let triangle = |x: f64| {
            let t = x.rem_euclid(2.0);
            if t < 1.0 { t } else { 2.0 - t }
        };
        (triangle(x + 0.5 * width) - triangle(x - 0.5 * width)) / width
    };
    let light = (0.5 + 0.5 * wave(at.x, width.x) * wave(at.y, width.y)) as f32;
    // Quarters are as wide as many squares: far wider pixels than a square see their mean.
    let squares = 90.0 / SQUARE_DEG;
    let quarter = (at.x / squares).floor().rem_euclid(4.0) as usize & 3;
    let own = QUARTERS[usize::from(at.y < 0.0)][quarter];
    let all = QUARTERS.as_flattened();
    let mean = [0, 1, 2].map(|i| all.iter().map(|c| c[i]).sum::<f32>() / all.len() as f32);
    let far = ((width.max_element() / squares - 0.5) * 2.0).clamp(0.0, 1.0) as f32;
    [0, 1, 2].map(|i| {
        let color = own[i] + far * (mean[i] - own[i]);
        let bright = LIGHT + (1.0 - LIGHT) * color;
        DARK * color + light * (bright - DARK * color)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(sky: &Sky, lon_deg: f64, lat_deg: f64, step: f64) -> [f32; 3] {
        let (sin_lon, cos_lon) = lon_deg.to_radians().sin_cos();
        let (sin_lat, cos_lat) = lat_deg.to_radians().sin_cos();
        let n = DVec3::new(cos_lat * cos_lon, cos_lat * sin_lon, sin_lat);
        let east = DVec3::new(-sin_lon, cos_lon, 0.0);
        sky.color(n, [east * step, n.cross(east) * step])
    }

    #[test]
    fn squares_are_squares_and_their_mean_from_afar() {
        let sky = Sky::new(SkyTexture::Checker);
        let (light, dark) = (at(&sky, 5.0, 5.0, 1e-4), at(&sky, 15.0, 5.0, 1e-4));
        assert!(light[0] > 2.0 * dark[0], "{light:?} {dark:?}");
        assert_eq!(at(&sky, 25.0, 5.0, 1e-4), light);
        assert_eq!(at(&sky, 15.0, 15.0, 1e-4), light);
        // Twenty degrees are two squares: exactly their mean.
        let wide = at(&sky, 25.0, 25.0, 20f64.to_radians());
        assert!((wide[1] - 0.5 * (light[1] + dark[1])).abs() < 0.05, "{wide:?}");
        // Everywhere, poles and the cut included, it is a colour.
        for i in 0..=36 {
            for j in -9..=9 {
                let color = at(&sky, 10.0 * f64::from(i), 10.0 * f64::from(j), 1e-2);
                assert!(color.iter().all(|v| (0.0..=1.0).contains(v)), "{color:?}");
            }
        }
    }

    #[test]
    fn a_picture_is_wrapped_around() {
        // Left to right: from −y to −x, on to +y, on to +x, and back.
        let texels = vec![[255, 0, 0], [255, 255, 0], [0, 255, 0], [0, 0, 255]];
        let picture = Picture::new("p", 4, 1, texels).unwrap();
        let mut sky = Sky::new(SkyTexture::picture(picture));
        let SkyTexture::Picture(texture) = &mut sky.texture else { panic!() };
        texture.blocky = true;
        assert_eq!(at(&sky, 45.0, 10.0, 1e-6), [0.0, 1.0, 0.0]);
        assert_eq!(at(&sky, -45.0, -10.0, 1e-6), [0.0, 0.0, 1.0]);
        assert_eq!(at(&sky, -135.0, 80.0, 1e-6), [1.0, 0.0, 0.0]);
        assert_eq!(at(&sky, 135.0, 0.0, 1e-6), [1.0, 1.0, 0.0]);
    }
}
