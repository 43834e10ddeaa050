use super::page::{Anchor, Ink, Item, Page};
use crate::drawing::text;
use glam::DVec2;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use tiny_skia::{
    FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, Rect, Stroke, StrokeDash, Transform,
};

impl Page {
    /// The page as a picture, `scale` pixels for one of its own: width, height, and three bytes of sRGB a pixel. None if
    /// it has no pixels, or too many.
    pub fn pixels(&self, scale: f64) -> Option<(u32, u32, Vec<u8>)> {
        let [width, height] = (scale * self.size).to_array().map(|v| v.ceil() as u32);
        let mut pixmap = Pixmap::new(width, height)?;
        pixmap.fill(tiny_skia::Color::WHITE);
        let place = Transform::from_scale(scale as f32, scale as f32);
        for item in &self.items {
            paint(&mut pixmap, place, item);
        }
        let pixels = pixmap.data().chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
        Some((width, height, pixels))
    }
}

impl Page {
    /// The [pixels](Self::pixels) as a PNG, as small as can be.
    pub fn png(&self, scale: f64) -> Option<Vec<u8>> {
        let (width, height, pixels) = self.pixels(scale)?;
        let mut png = Vec::new();
        // Areas of one colour are best left as they are.
        PngEncoder::new_with_quality(&mut png, CompressionType::Best, FilterType::NoFilter)
            .write_image(&pixels, width, height, ExtendedColorType::Rgb8)
            .ok()?;
        Some(png)
    }
}

fn paint(pixmap: &mut Pixmap, place: Transform, item: &Item) {
    match item {
        Item::Line { points, width, dash, ink } => {
            let dash = dash.and_then(|d| StrokeDash::new(vec![d as f32; 2], 0.0));
            let line_cap = if dash.is_some() { LineCap::Butt } else { LineCap::Round };
            let stroke = Stroke {
                width: *width as f32,
                line_cap,
                line_join: LineJoin::Round,
                dash,
                ..Stroke::default()
            };
            if let Some(path) = path(points, false) {
                pixmap.stroke_path(&path, &filled(*ink), &stroke, place, None);
            }
        }
        Item::Area { corners, ink } => {
            if let Some(path) = path(corners, true) {
                pixmap.fill_path(&path, &filled(*ink), FillRule::Winding, place, None);
            }
        }
        Item::Text { text, at, em, anchor, upwards, ink } => {
            let before = match anchor {
                Anchor::Start => 0.0,
                Anchor::Middle => 0.5,
                Anchor::End => 1.0,
            };
            let start = DVec2::new(-before * text::width(text, *em), 0.0);
            let Some(outline) = text::outline(text, *em, start) else { return };
            let turned = if *upwards { Transform::from_rotate(-90.0) } else { Transform::identity() };
            let place = turned.post_translate(at.x as f32, at.y as f32).post_concat(place);
            let halo = Stroke { width: HALO * *em as f32, line_join: LineJoin::Round, ..Stroke::default() };
            pixmap.stroke_path(&outline, &filled([255; 3]), &halo, place, None);
            pixmap.fill_path(&outline, &filled(*ink), FillRule::Winding, place, None);
        }
        Item::Cells { at, size, columns, colors } => {
            let rows = colors.len() / (*columns).max(1);
            let cell = *size / DVec2::new(*columns as f64, rows as f64);
            for (i, ink) in colors.iter().enumerate() {
                let corner = *at + cell * DVec2::new((i % columns) as f64, (i / columns) as f64);
                // Cells end where pixels do, so that nothing shows between them.
                let [left, top] = place_of(place, corner).to_array().map(f64::round);
                let [right, bottom] = place_of(place, corner + cell).to_array().map(f64::round);
                if let Some(r) = Rect::from_ltrb(left as f32, top as f32, right as f32, bottom as f32) {
                    pixmap.fill_rect(r, &filled(*ink), Transform::identity(), None);
                }
            }
        }
    }
}

/// White around letters, in ems, both sides together.
pub(super) const HALO: f32 = 0.24;

fn place_of(place: Transform, at: DVec2) -> DVec2 {
    at * DVec2::new(place.sx.into(), place.sy.into())
}

fn filled([r, g, b]: Ink) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color_rgba8(r, g, b, 255);
    paint
}

fn path(points: &[DVec2], closed: bool) -> Option<Path> {
    let mut builder = PathBuilder::new();
    let (first, rest) = points.split_first()?;
    builder.move_to(first.x as f32, first.y as f32);
    rest.iter().for_each(|p| builder.line_to(p.x as f32, p.y as f32));
    if closed {
        builder.close();
    }
    builder.finish()
}
