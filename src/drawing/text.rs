use super::canvas::{Canvas, Ink, SHADE};
use ab_glyph::{Font, FontRef, GlyphId, OutlineCurve};
use glam::DVec2;
use std::sync::LazyLock;
use tiny_skia::{Path, PathBuilder};

/// DejaVu Sans, so that pictures look the same everywhere; its licence is beside it.
static FONT: LazyLock<FontRef<'static>> = LazyLock::new(|| {
    FontRef::try_from_slice(include_bytes!("../../assets/font/DejaVuSans.ttf"))
        .expect("the font that ships is read by every test that draws")
});

/// The first character the font has no glyph for.
pub(super) fn without_glyph(text: &str) -> Option<char> {
    text.chars().find(|&c| c != '\n' && FONT.glyph_id(c) == GlyphId(0))
}

/// The glyphs of a line, each with its place: font units from the line's start.
fn glyphs(text: &str) -> impl Iterator<Item = (GlyphId, f32)> {
    let (mut last, mut at) = (None, 0.0);
    text.chars().map(move |c| {
        let id = FONT.glyph_id(c);
        at += last.map_or(0.0, |last| FONT.h_advance_unscaled(last) + FONT.kern_unscaled(last, id));
        last = Some(id);
        (id, at)
    })
}

/// Pixels a font unit for letters of `em` pixels.
fn scale(em: f64) -> f32 {
    em as f32 / FONT.units_per_em().unwrap_or(2048.0)
}

/// Width of a line in pixels, letters of `em` pixels.
pub(crate) fn width(text: &str, em: f64) -> f64 {
    let end = glyphs(text).last().map_or(0.0, |(id, at)| at + FONT.h_advance_unscaled(id));
    f64::from(end * scale(em))
}

/// The outline of a line whose base line begins at `at`.
pub(crate) fn outline(text: &str, em: f64, at: DVec2) -> Option<Path> {
    let scale = scale(em);
    let mut builder = PathBuilder::new();
    for (id, start) in glyphs(text) {
        let Some(outline) = FONT.outline(id) else { continue };
        let place = |p: ab_glyph::Point| (at.x as f32 + scale * (start + p.x), at.y as f32 - scale * p.y);
        let mut pen = None;
        for curve in outline.curves {
            let (from, to) = match curve {
                OutlineCurve::Line(a, b) | OutlineCurve::Quad(a, _, b) | OutlineCurve::Cubic(a, _, _, b) => {
                    (a, b)
                }
            };
            // Curves follow each other; where they do not, a new contour begins.
            if pen != Some(from) {
                if pen.is_some() {
                    builder.close();
                }
                let (x, y) = place(from);
                builder.move_to(x, y);
            }
            let (x, y) = place(to);
            match curve {
                OutlineCurve::Line(..) => builder.line_to(x, y),
                OutlineCurve::Quad(_, c, _) => {
                    let (cx, cy) = place(c);
                    builder.quad_to(cx, cy, x, y);
                }
                OutlineCurve::Cubic(_, c, d, _) => {
                    let ((cx, cy), (dx, dy)) = (place(c), place(d));
                    builder.cubic_to(cx, cy, dx, dy, x, y);
                }
            }
            pen = Some(to);
        }
        if pen.is_some() {
            builder.close();
        }
    }
    builder.finish()
}

/// Writes a line whose base line begins at `at`, legible on anything.
pub(super) fn write(canvas: &mut Canvas, text: &str, em: f64, at: DVec2, ink: Ink) {
    if let Some(path) = outline(text, em, at) {
        canvas.stroke(&path, (0.22 * em).max(2.5), SHADE);
        canvas.fill(&path, ink);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_font_has_what_formulas_need() {
        assert_eq!(without_glyph("βγθλνΔ·×−°⊥∥≈√′⁻⁰¹²³⁴⁵⁶⁷⁸⁹₀₁½ °∞ äßéñ Доплер"), None);
        assert_eq!(without_glyph("c = 1 字"), Some('字'));
    }

    #[test]
    fn letters_follow_each_other_and_grow_with_their_size() {
        let (one, two) = (width("m", 20.0), width("mm", 20.0));
        assert!((two / one - 2.0).abs() < 1e-6 && one > 15.0 && one < 25.0, "{one} {two}");
        assert!((width("γβ", 40.0) / width("γβ", 20.0) - 2.0).abs() < 1e-6);
        assert_eq!(width("", 20.0), 0.0);
        // Within its own box: an H is as high as capitals are, 0.729 em.
        let bounds = outline("H", 100.0, DVec2::new(10.0, 200.0)).unwrap().bounds();
        assert!((bounds.bottom() - 200.0).abs() < 0.1 && (bounds.height() - 72.9).abs() < 0.2, "{bounds:?}");
    }
}
