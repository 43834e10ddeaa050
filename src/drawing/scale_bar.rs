use super::canvas::{Canvas, LIGHT, polylines};
use super::{Shot, number, text};
use crate::relativity::ApparentMap;
use crate::scene::{Lens, Projection};
use glam::DVec2;

/// How long things at one distance are in the picture.
///
/// The bar is as long as a length at right angles to the line of sight, at that apparent distance, in the middle of
/// the picture. It measures where things are *seen*, in the camera's frame: a moving body's own lengths along its
/// motion look longer or shorter than they are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ScaleBar {
    /// A round number of the scene's units of length.
    pub length: f64,
    /// Apparent distance from the camera.
    pub distance: f64,
    pub pixels: f64,
}

/// The bar is no longer than this part of the picture's width.
const MOST: f64 = 0.22;

impl ScaleBar {
    /// The bar for what is seen in the middle of the picture; if nothing is, for the nearest body whose middle is in
    /// the picture; none if there is none.
    pub fn of(shot: &Shot<'_>) -> Option<Self> {
        let film = shot.film;
        let middle = (film.height / 2 * film.width + film.width / 2) as usize;
        let distance = film.distance.get(middle).copied().filter(|d| *d > 0.0).map(f64::from);
        let distance = distance.or_else(|| nearest_middle(shot))?;
        Self::at(&shot.camera.lens, distance)
    }

    fn at(lens: &Lens, distance: f64) -> Option<Self> {
        let focal = lens.focal().x;
        let most = MOST * f64::from(lens.width());
        let pixels = |length: f64| match lens.projection() {
            Projection::Pinhole => focal * length / distance,
            _ => focal * 2.0 * (0.5 * length / distance).atan(),
        };
        let longest = match lens.projection() {
            Projection::Pinhole => most / focal * distance,
            // No length subtends more than half the sky.
            _ => 2.0 * distance * (0.5 * most / focal).min(1.0).tan(),
        };
        let power = 10f64.powf(longest.log10().floor());
        let round = [5.0, 2.0, 1.0].map(|n| n * power).into_iter().find(|l| *l <= longest);
        let length = round.unwrap_or(power);
        let bar = Self { length, distance, pixels: pixels(length) };
        (bar.pixels.is_finite() && bar.pixels > 0.0).then_some(bar)
    }

    fn label(&self) -> String {
        let [length, distance] =
            [(self.length, 1), (self.distance, 3)].map(|(v, n)| number::significant(v, n));
        format!("{length} at distance {distance}")
    }

    /// At the lower right; returns how wide bar and label are.
    pub fn draw(&self, canvas: &mut Canvas) -> f64 {
        let margin = canvas.margin();
        let label = self.label();
        let natural = text::width(&label, canvas.em());
        let em = canvas.em() * (0.45 * canvas.width() / natural).min(0.8);
        let width = text::width(&label, em);
        let tick = 0.3 * em;
        let (right, y) = (canvas.width() - margin, canvas.height() - margin - tick);
        let left = right - self.pixels;
        let point = |x, dy| DVec2::new(x, y + dy);
        let lines = [
            [point(left, 0.0), point(right, 0.0)],
            [point(left, -tick), point(left, tick)],
            [point(right, -tick), point(right, tick)],
        ];
        if let Some(path) = polylines(lines.iter().map(|l| &l[..])) {
            canvas.stroke_shaded(&path, 1.5 * canvas.line(), LIGHT);
        }
        let start = (0.5 * (left + right - width)).min(right - width);
        text::write(canvas, &label, em, point(start, -tick - 0.35 * em), LIGHT);
        width.max(self.pixels)
    }
}

/// Apparent distance of the nearest body whose middle is in the picture.
fn nearest_middle(shot: &Shot<'_>) -> Option<f64> {
    let lens = &shot.camera.lens;
    let inside = |pixel: DVec2| pixel.cmpge(DVec2::ZERO).all() && pixel.cmple(2.0 * lens.middle()).all();
    let seen = shot.scene.bodies.iter().filter_map(|body| {
        let map = ApparentMap::new(&body.motion, &shot.camera.observer);
        let sight = map.see(body.mesh.centre());
        lens.pixel(sight.position).is_some_and(inside).then_some(sight.distance)
    });
    seen.filter(|d| *d > 0.0).min_by(f64::total_cmp)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::Coloring;
    use crate::film::Film;
    use crate::scene::{Camera, Scene, builtin_scenes};
    use crate::tone::Development;

    #[test]
    fn the_bar_is_what_a_ruler_there_would_be() {
        for (projection, fov) in [(Projection::Pinhole, 36.0), (Projection::Fisheye, 180.0)] {
            let lens = Lens::new(projection, fov, 1280, 720).unwrap();
            for distance in [3.0, 0.02, 7e5] {
                let bar = ScaleBar::at(&lens, distance).unwrap();
                let end = |x: f64| lens.pixel(glam::DVec3::new(x, 0.0, distance)).unwrap().x;
                let ruler = end(0.5 * bar.length) - end(-0.5 * bar.length);
                assert!((bar.pixels / ruler - 1.0).abs() < 1e-12, "{bar:?} {ruler}");
                assert!(bar.pixels <= 0.22 * 1280.0 + 1e-9 && bar.pixels > 0.22 * 1280.0 / 3.0, "{bar:?}");
                let mantissa = format!("{:e}", bar.length);
                assert!(
                    mantissa.starts_with(['1', '2', '5']) && mantissa[1..].starts_with('e'),
                    "{mantissa}"
                );
            }
        }
    }

    #[test]
    fn the_middle_decides_and_then_the_nearest_body() {
        let scene = builtin_scenes()[0].scene();
        let camera = scene.camera().unwrap();
        let mut film = Film::new(1280, 720);
        fn shot<'a>(scene: &'a Scene, camera: &'a Camera, film: &'a Film) -> Shot<'a> {
            let (coloring, development) = (Coloring::Geometry, Development::default());
            Shot { scene, camera, film, tolerance: 0.25, coloring, development }
        }
        let of = |film: &Film| ScaleBar::of(&shot(&scene, &camera, film));
        // Its centre is seen abreast at a distance of 3.
        assert!((of(&film).unwrap().distance - 3.0).abs() < 1e-12);
        assert_eq!(of(&film).unwrap().label(), "0.5 at distance 3");
        film.distance[360 * 1280 + 640] = 2.5;
        assert_eq!(of(&film).unwrap().distance, 2.5);
        let mut away = scene.clone();
        away.view.set_time(100.0).unwrap();
        let camera = away.camera().unwrap();
        let film = Film::new(1280, 720);
        assert_eq!(ScaleBar::of(&shot(&away, &camera, &film)), None);
    }
}
