use glam::DVec2;
use tiny_skia::{FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, Stroke, Transform};

/// A finished picture to draw on, and the measures that go with its size.
pub(super) struct Canvas {
    pixmap: Pixmap,
}

/// sRGB and opacity.
pub(super) type Ink = [u8; 4];

pub(super) const LIGHT: Ink = [255, 255, 255, 255];
/// What stands behind light lines and letters, so that they are seen on anything.
pub(super) const SHADE: Ink = [0, 0, 0, 150];

impl Canvas {
    /// The picture of three bytes a pixel; none if it has no pixels or the count of bytes is another.
    pub fn new(width: u32, height: u32, pixels: &[u8]) -> Option<Self> {
        let mut pixmap = Pixmap::new(width, height)?;
        let rgba = pixmap.data_mut();
        if pixels.len() / 3 * 4 != rgba.len() || !pixels.len().is_multiple_of(3) {
            return None;
        }
        for (to, from) in rgba.chunks_exact_mut(4).zip(pixels.chunks_exact(3)) {
            to.copy_from_slice(&[from[0], from[1], from[2], 255]);
        }
        Some(Self { pixmap })
    }

    /// Back to three bytes a pixel.
    pub fn write_to(&self, pixels: &mut [u8]) {
        for (to, from) in pixels.chunks_exact_mut(3).zip(self.pixmap.data().chunks_exact(4)) {
            to.copy_from_slice(&from[..3]);
        }
    }

    pub fn width(&self) -> f64 {
        f64::from(self.pixmap.width())
    }

    pub fn height(&self) -> f64 {
        f64::from(self.pixmap.height())
    }

    /// The size of letters, pixels an em.
    pub fn em(&self) -> f64 {
        (self.height().min(self.width()) / 28.0).max(9.0)
    }

    /// The width of lines.
    pub fn line(&self) -> f64 {
        (self.height().min(self.width()) / 600.0).max(1.0)
    }

    /// Between what is drawn and the picture's sides.
    pub fn margin(&self) -> f64 {
        0.75 * self.em()
    }

    pub fn fill(&mut self, path: &Path, ink: Ink) {
        self.pixmap.fill_path(path, &paint(ink), FillRule::Winding, Transform::identity(), None);
    }

    pub fn stroke(&mut self, path: &Path, width: f64, ink: Ink) {
        let stroke = Stroke {
            width: width as f32,
            line_cap: LineCap::Round,
            line_join: LineJoin::Round,
            ..Stroke::default()
        };
        self.pixmap.stroke_path(path, &paint(ink), &stroke, Transform::identity(), None);
    }

    /// A line over its shade.
    pub fn stroke_shaded(&mut self, path: &Path, width: f64, ink: Ink) {
        self.stroke(path, width + 2.0 * self.line(), SHADE);
        self.stroke(path, width, ink);
    }
}

fn paint(ink: Ink) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color_rgba8(ink[0], ink[1], ink[2], ink[3]);
    paint
}

/// Open lines through the points of each list; none if there is nothing to draw.
pub(super) fn polylines<'a>(lines: impl IntoIterator<Item = &'a [DVec2]>) -> Option<Path> {
    let mut builder = PathBuilder::new();
    for line in lines {
        if let [first, rest @ ..] = line
            && !rest.is_empty()
        {
            builder.move_to(first.x as f32, first.y as f32);
            rest.iter().for_each(|p| builder.line_to(p.x as f32, p.y as f32));
        }
    }
    builder.finish()
}

/// A closed polygon.
pub(super) fn polygon(corners: &[DVec2]) -> Option<Path> {
    let mut builder = PathBuilder::new();
    for (i, p) in corners.iter().enumerate() {
        if i == 0 { builder.move_to(p.x as f32, p.y as f32) } else { builder.line_to(p.x as f32, p.y as f32) }
    }
    builder.close();
    builder.finish()
}
