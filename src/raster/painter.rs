use super::bins::Bins;
use super::bounds::Bounder;
use super::order::{Waiting, back_to_front};
use super::polygon::{BEYOND, Polygon};
use super::triangle::{Planes, Surface};
use super::{Drawable, each_band};
use crate::film::Film;
use crate::film::Samples;
use crate::light::SeenShading;
use crate::relativity::RestSky;
use crate::scene::Lens;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use tiny_skia::{BlendMode, FillRule, Paint, Path, PathBuilder, Pixmap, Rect, Transform};

/// The most triangles that can be painted: a pixel's three bytes hold the number of one.
pub const MOST_PAINTED: usize = (1 << 24) - 1;

/// More triangles than a painted pixel can tell apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{0} triangles after cutting cannot be painted: {MOST_PAINTED} is the most; use the z-buffer (--raster cpu) or a larger tolerance"
)]
pub struct TooManyToPaint(pub usize);

/// Draws apparent meshes on a new film by the painter's algorithm: triangles filled back to front by tiny-skia,
/// without anti-aliasing, each with its number for a colour; then, as with [`shade`](super::shade), what a pixel
/// shows is the exact surface of the triangle whose number is there. Only which triangle a pixel sees is decided
/// in another way.
///
/// Of two triangles that overlap the one farther away, where they overlap, is painted first; all others in the order of
/// their centroids' apparent distances. It is wrong where triangles pass through each other or overlap in a cycle;
/// and where there are so many in one place that pairs cannot be compared (some millions), so that only centroids are
/// left, also where one reaches much farther along the line of sight than what it overlaps.
///
/// # Errors
/// If there are more than [`MOST_PAINTED`] triangles.
pub fn paint(
    bodies: &[Drawable<'_>],
    lens: &Lens,
    samples: &Samples,
    shading: &SeenShading<'_>,
) -> Result<Film, TooManyToPaint> {
    let count = bodies.iter().map(|b| b.seen.triangles.len()).sum();
    check_count(count)?;
    let mut film = Film::new(lens.width(), lens.height());
    // With a margin that holds all of every polygon: where tiny-skia clips, neighbours part.
    let Some(mut pixmap) = Pixmap::new(lens.width() + 2 * MARGIN, lens.height() + 2 * MARGIN) else {
        return Ok(film);
    };
    let bins = Bins::unbinned(bodies);
    let images = images(bodies, lens, samples);
    for (index, &offset) in samples.offsets().iter().enumerate() {
        pixmap.data_mut().fill(0);
        // Pixels are filled by their centres.
        let shift = 0.5 + f64::from(MARGIN) - DVec2::from_array(offset);
        for image in &images {
            image.fill(&mut pixmap, shift);
        }
        let (painted, stride) = (pixmap.data(), pixmap.width() as usize);
        let (width, margin) = (lens.width() as usize, MARGIN as usize);
        each_band(&mut film, |band, top, rows| {
            let number = |i: usize| {
                let at = (top as usize + i / width + margin) * stride + i % width + margin;
                number_of(&painted[4 * at..][..4])
            };
            band.draw_known(bodies, &bins, lens, samples, index, shading, top, number, rows);
        });
    }
    Ok(film)
}

/// Pixels beyond the picture's sides: more than polygons and a sample's place take.
const MARGIN: u32 = BEYOND as u32 + 2;

fn check_count(count: usize) -> Result<(), TooManyToPaint> {
    if count > MOST_PAINTED { Err(TooManyToPaint(count)) } else { Ok(()) }
}

/// A triangle ready to be painted.
struct Image {
    number: u32,
    path: Path,
    rule: FillRule,
}

/// All triangles that have an image, back to front.
fn images(bodies: &[Drawable<'_>], lens: &Lens, samples: &Samples) -> Vec<Image> {
    let bounder = Bounder::new(lens, samples.range());
    let skies: Vec<RestSky> = bodies.iter().map(|b| b.map.rest_sky()).collect();
    let mut images = Vec::new();
    let mut first = 0;
    for (body, sky) in bodies.iter().zip(&skies) {
        let triangles = body.seen.triangles.par_iter().enumerate().with_min_len(1024);
        let image = |(i, triangle): (usize, &crate::apparent::ApparentTriangle)| {
            let corners = triangle.corners.map(|v| body.seen.vertices[v as usize]);
            let screen = corners.map(|v| bounder.project(v));
            let rects = bounder.bounds(screen, || corners);
            rects.iter().flatten().next()?;
            // What is seen edge-on has no surface to look up.
            let planes = Planes::new(corners)?;
            let (path, rule) = path(lens, &Polygon::new(lens, corners)?)?;
            let rest = body.mesh.corners(triangle.face as usize).map(|v| body.map.offset_rest(v));
            let surface = Surface::new(body.map, sky, rest, corners, &planes);
            let depth = depth(corners);
            let waiting = Waiting { corners, planes, surface, sky, rects, depth };
            Some((waiting, Some(Image { number: first + i as u32, path, rule })))
        };
        images.par_extend(triangles.filter_map(image));
        first += body.seen.triangles.len() as u32;
    }
    let (waiting, mut images): (Vec<_>, Vec<_>) = images.into_iter().unzip();
    back_to_front(&waiting).into_iter().filter_map(|i| images[i as usize].take()).collect()
}

/// Apparent distance of the centroid.
fn depth([a, b, c]: [DVec3; 3]) -> f64 {
    ((a + b + c) / 3.0).length()
}

fn path(lens: &Lens, polygon: &Polygon) -> Option<(Path, FillRule)> {
    let mut builder = PathBuilder::new();
    for part in polygon.parts(lens) {
        for (i, p) in part.iter().enumerate() {
            let (x, y) = (p.x as f32, p.y as f32);
            if i == 0 { builder.move_to(x, y) } else { builder.line_to(x, y) }
        }
        builder.close();
    }
    if !polygon.inverted {
        return Some((builder.finish()?, FillRule::Winding));
    }
    let size = 2.0 * lens.middle();
    builder.push_rect(Rect::from_ltrb(-1.0, -1.0, size.x as f32 + 1.0, size.y as f32 + 1.0)?);
    Some((builder.finish()?, FillRule::EvenOdd))
}

impl Image {
    fn fill(&self, pixmap: &mut Pixmap, shift: DVec2) {
        let mut paint = Paint { anti_alias: false, blend_mode: BlendMode::Source, ..Paint::default() };
        let [red, green, blue, _] = (self.number + 1).to_le_bytes();
        paint.set_color_rgba8(red, green, blue, 255);
        let place = Transform::from_translate(shift.x as f32, shift.y as f32);
        pixmap.fill_path(&self.path, &paint, self.rule, place, None);
    }
}

/// The triangle whose number was painted.
fn number_of(rgba: &[u8]) -> Option<u32> {
    u32::from_le_bytes([rgba[0], rgba[1], rgba[2], 0]).checked_sub(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_painted_to_the_bit() {
        let mut pixmap = Pixmap::new(3, 3).unwrap();
        let path = PathBuilder::from_rect(Rect::from_ltrb(0.0, 0.0, 3.0, 3.0).unwrap());
        let last = MOST_PAINTED as u32 - 1;
        for number in (0..last).step_by(65_521).chain([1, 254, 255, 256, 65_535, 65_536, last]) {
            let image = Image { number, path: path.clone(), rule: FillRule::Winding };
            image.fill(&mut pixmap, DVec2::ZERO);
            assert!(pixmap.data().chunks(4).all(|rgba| number_of(rgba) == Some(number)), "{number}");
        }
        assert_eq!(number_of(&[0; 4]), None);
    }

    #[test]
    fn more_than_a_pixel_can_number_are_refused() {
        assert_eq!(check_count(MOST_PAINTED), Ok(()));
        let refusal = check_count(MOST_PAINTED + 1).unwrap_err();
        assert_eq!(refusal, TooManyToPaint(16_777_216));
        assert!(refusal.to_string().contains("16777216") && refusal.to_string().contains("--raster cpu"));
    }
}
