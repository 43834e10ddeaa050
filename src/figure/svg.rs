use super::page::{Anchor, Ink, Item, Page};
use super::painted::HALO;
use crate::picture::write_png_pixels;
use glam::DVec2;
use std::fmt::Write;

/// The font of the painted pages first; what stands in for it is no wider.
const FONTS: &str = "DejaVu Sans, Verdana, Helvetica, Arial, sans-serif";

impl Page {
    /// The page as SVG, for itself: texts are texts, and nothing is fetched.
    pub fn svg(&self) -> String {
        let [width, height] = self.size.to_array().map(f64::ceil);
        let mut svg = format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
             <svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" role=\"img\" font-family=\"{FONTS}\">\n\
             <title>{}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
            escaped(&self.title)
        );
        for item in &self.items {
            // Text takes whatever is written to it.
            let _ = write(&mut svg, item);
        }
        svg.push_str("</svg>\n");
        svg
    }
}

fn write(svg: &mut String, item: &Item) -> std::fmt::Result {
    match item {
        Item::Line { points, width, dash, ink } => {
            let dash = dash.map_or_else(String::new, |d| format!(" stroke-dasharray=\"{}\"", rounded(d)));
            let cap = if dash.is_empty() { "round" } else { "butt" };
            writeln!(
                svg,
                "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" \
                 stroke-linejoin=\"round\" stroke-linecap=\"{cap}\"{dash}/>",
                list(points),
                hex(*ink),
                rounded(*width)
            )
        }
        Item::Area { corners, ink } => {
            writeln!(svg, "<polygon points=\"{}\" fill=\"{}\"/>", list(corners), hex(*ink))
        }
        Item::Text { text, at, em, anchor, upwards, ink } => {
            let anchor = match anchor {
                Anchor::Start => "start",
                Anchor::Middle => "middle",
                Anchor::End => "end",
            };
            let (x, y) = (rounded(at.x), rounded(at.y));
            let turn = if *upwards { format!(" transform=\"rotate(-90 {x} {y})\"") } else { String::new() };
            writeln!(
                svg,
                "<text x=\"{x}\" y=\"{y}\" font-size=\"{}\" text-anchor=\"{anchor}\" fill=\"{}\" \
                 stroke=\"#fff\" stroke-width=\"{}\" stroke-linejoin=\"round\" paint-order=\"stroke\"{turn}>{}</text>",
                rounded(*em),
                hex(*ink),
                rounded(f64::from(HALO) * em),
                escaped(text)
            )
        }
        Item::Cells { at, size, columns, colors } => {
            let rows = colors.len() / (*columns).max(1);
            let mut png = Vec::new();
            let written = write_png_pixels(*columns as u32, rows as u32, colors.as_flattened(), &mut png);
            written.map_err(|_| std::fmt::Error)?;
            writeln!(
                svg,
                "<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" preserveAspectRatio=\"none\" \
                 style=\"image-rendering:pixelated\" href=\"data:image/png;base64,{}\"/>",
                rounded(at.x),
                rounded(at.y),
                rounded(size.x),
                rounded(size.y),
                base64(&png)
            )
        }
    }
}

/// To a hundredth of a pixel.
fn rounded(value: f64) -> f64 {
    (100.0 * value).round() / 100.0
}

fn list(points: &[DVec2]) -> String {
    let texts: Vec<String> = points.iter().map(|p| format!("{},{}", rounded(p.x), rounded(p.y))).collect();
    texts.join(" ")
}

fn hex([r, g, b]: Ink) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

pub(crate) fn escaped(text: &str) -> String {
    let plain: String = text.chars().filter(|c| !c.is_control()).collect();
    plain.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

pub(crate) fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let bits = (0..3).fold(0, |bits, i| bits << 8 | u32::from(*three.get(i).unwrap_or(&0)));
        for i in 0..4 {
            let digit = DIGITS[(bits >> (18 - 6 * i) & 63) as usize];
            text.push(if i <= three.len() { digit.into() } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_as_text() {
        // RFC 4648, section 10.
        for (bytes, text) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
        ] {
            assert_eq!(base64(bytes.as_bytes()), text);
        }
    }

    #[test]
    fn what_xml_takes_for_its_own_is_written_otherwise() {
        let mut page =
            Page { size: DVec2::new(20.0, 10.0), title: "a < b & \"c\"".into(), ..Page::default() };
        page.text("x > \u{1}y", DVec2::ONE, 5.0, Anchor::Start, [0; 3]);
        let svg = page.svg();
        assert!(
            svg.contains("<title>a &lt; b &amp; &quot;c&quot;</title>") && svg.contains(">x &gt; y</text>")
        );
    }
}
