use super::canvas::{Canvas, LIGHT, polygon};
use super::text;
use crate::color::encoded;
use flip_rs::MAGMA;
use glam::DVec2;

/// A picture on a [`Sheet`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Panel {
    /// Above it, a line each.
    pub lines: Vec<String>,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// 8-bit sRGB, three bytes a pixel.
    pub pixels: Vec<u8>,
    /// Whether single bright pixels matter, so that made smaller the brightest are shown rather than means.
    pub sparse: bool,
}

/// Pictures side by side, with what there is to say of them.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Sheet {
    /// At the top, a line each.
    pub title: Vec<String>,
    /// Row by row.
    pub rows: Vec<Vec<Panel>>,
    /// At the bottom: colours and what they stand for.
    pub key: Vec<([u8; 3], String)>,
    /// Whether a scale of [`decade_color`] is at the bottom too.
    pub decades: bool,
    /// Whether panels are shown pixel by pixel; otherwise large ones are shrunk and small ones enlarged, by whole numbers.
    pub whole: bool,
}

/// Decades of relative difference that [`decade_color`] spans, up to 1.
pub const DECADES: i32 = 7;

/// sRGB that stands for a relative difference, by its logarithm: black up to 10⁻⁷, through violet and orange to nearly white
/// at 1 (the colour map Magma of S. van der Walt and N. Smith, 2015).
pub fn decade_color(relative: f64) -> [u8; 3] {
    let at = (1.0 + relative.log10() / f64::from(DECADES)).clamp(0.0, 1.0);
    if !(relative > 0.0 && at > 0.0) {
        // NaN is as bad as can be.
        return if relative.is_nan() { [255; 3] } else { [0; 3] };
    }
    MAGMA[(255.0 * at) as usize].map(|v| (255.0 * v + 0.5) as u8)
}

/// Panels are shown at least, and at most, about so wide: enlarged or shrunk by whole numbers.
const ACROSS: [u32; 2] = [360, 800];

const BACKGROUND: [u8; 3] = [38, 38, 42];
const EM: f64 = 15.0;
const LEADING: f64 = 1.4 * EM;
const GAP: f64 = 12.0;

impl Sheet {
    /// The picture: width, height, and three bytes of sRGB a pixel.
    ///
    /// # Panics
    /// If a panel has not three bytes a pixel.
    pub fn draw(&self) -> (u32, u32, Vec<u8>) {
        let shown: Vec<Vec<Scaled>> = self
            .rows
            .iter()
            .map(|row| row.iter().map(|panel| Scaled::new(panel, self.whole)).collect())
            .collect();
        let columns = shown.iter().map(Vec::len).max().unwrap_or(0);
        let widths: Vec<f64> = (0..columns)
            .map(|c| {
                shown.iter().filter_map(|row| row.get(c)).map(|p| f64::from(p.width)).fold(0.0, f64::max)
            })
            .collect();
        let of_lines = |count: usize| count as f64 * LEADING;
        let heads: Vec<f64> = self
            .rows
            .iter()
            .map(|row| of_lines(row.iter().map(|p| p.lines.len()).max().unwrap_or(0)))
            .collect();
        let highest = |row: &[Scaled]| row.iter().map(|p| f64::from(p.height)).fold(0.0, f64::max);
        let body: f64 = shown.iter().zip(&heads).map(|(row, head)| head + highest(row) + 2.0 * GAP).sum();
        let foot = of_lines(self.key.len()) + if self.decades { 2.6 * LEADING } else { 0.0 } + GAP;
        let width = (widths.iter().sum::<f64>() + GAP * (columns + 1) as f64).max(480.0);
        let height = GAP + of_lines(self.title.len()) + body + foot;
        let (width, height) = (width.ceil() as u32, height.ceil() as u32);
        let mut pixels: Vec<u8> = BACKGROUND.repeat(width as usize * height as usize);
        // Pictures first, then all that is written, at places that both work out.
        let mut y = GAP + of_lines(self.title.len());
        let mut texts: Vec<(String, f64, DVec2)> = Vec::new();
        let room = f64::from(width) - 2.0 * GAP;
        for (i, line) in self.title.iter().enumerate() {
            texts.push((line.clone(), room, DVec2::new(GAP, GAP + of_lines(i) + EM)));
        }
        for ((row, scaled), head) in self.rows.iter().zip(&shown).zip(&heads) {
            let mut x = GAP;
            for ((panel, picture), column) in row.iter().zip(scaled).zip(&widths) {
                for (i, line) in panel.lines.iter().enumerate() {
                    texts.push((line.clone(), *column, DVec2::new(x, y + GAP + of_lines(i) + 0.7 * EM)));
                }
                picture.copy_to(&mut pixels, width, x as u32, (y + GAP + head) as u32);
                x += column + GAP;
            }
            y += head + highest(scaled) + 2.0 * GAP;
        }
        if let Some(mut canvas) = Canvas::new(width, height, &pixels) {
            for (line, room, at) in &texts {
                let em = EM * (room / text::width(line, EM).max(1.0)).min(1.0);
                text::write(&mut canvas, line, em, *at, LIGHT);
            }
            self.draw_foot(&mut canvas, y, room);
            canvas.write_to(&mut pixels);
        }
        (width, height, pixels)
    }

    fn draw_foot(&self, canvas: &mut Canvas, mut y: f64, room: f64) {
        for (color, line) in &self.key {
            rectangle(canvas, [GAP, y + 2.0], [EM, EM], *color);
            let room = room - 1.6 * EM;
            let em = EM * (room / text::width(line, EM).max(1.0)).min(1.0);
            text::write(canvas, line, em, DVec2::new(GAP + 1.6 * EM, y + EM), LIGHT);
            y += LEADING;
        }
        if !self.decades {
            return;
        }
        let width = room.min(560.0);
        let steps = 280;
        for step in 0..steps {
            let at = (f64::from(step) + 0.5) / f64::from(steps);
            let color = decade_color(10f64.powf(f64::from(DECADES) * (at - 1.0)));
            let left = GAP + width * f64::from(step) / f64::from(steps);
            rectangle(canvas, [left, y + 4.0], [width / f64::from(steps) + 0.5, EM], color);
        }
        for decade in 0..=DECADES {
            let label = super::number::significant(10f64.powi(decade - DECADES), 1);
            let label = if decade == DECADES { "1".to_owned() } else { label };
            let half = 0.5 * text::width(&label, 0.8 * EM);
            let at = GAP + width * f64::from(decade) / f64::from(DECADES);
            let left = (at - half).clamp(GAP, GAP + width - 2.0 * half);
            text::write(canvas, &label, 0.8 * EM, DVec2::new(left, y + 2.3 * EM), LIGHT);
        }
        let what = "difference of light over the reference's peak, the channel that differs most";
        text::write(canvas, what, 0.8 * EM, DVec2::new(GAP, y + 3.5 * EM), LIGHT);
    }
}

fn rectangle(canvas: &mut Canvas, [x, y]: [f64; 2], [width, height]: [f64; 2], [r, g, b]: [u8; 3]) {
    let corners = [(x, y), (x + width, y), (x + width, y + height), (x, y + height)];
    if let Some(path) = polygon(&corners.map(|(x, y)| DVec2::new(x, y))) {
        canvas.fill(&path, [r, g, b, 255]);
    }
}

/// A panel as large as it is shown.
struct Scaled {
    width: u32,
    height: u32,
    pixels: Vec<u8>,
}

impl Scaled {
    fn new(panel: &Panel, whole: bool) -> Self {
        let (width, height) = (panel.width, panel.height);
        assert_eq!(
            panel.pixels.len() as u64,
            3 * u64::from(width) * u64::from(height),
            "three bytes a pixel"
        );
        let side = width.max(height).max(1);
        let [larger, smaller] =
            if whole { [1, 1] } else { [(ACROSS[0] / side).max(1), side.div_ceil(ACROSS[1])] };
        let (across, down) = ((width * larger).div_ceil(smaller), (height * larger).div_ceil(smaller));
        let mut pixels = Vec::with_capacity(3 * across as usize * down as usize);
        for y in 0..down {
            for x in 0..across {
                let range = |at: u32, end: u32| {
                    let from = at * smaller / larger;
                    from..(from + smaller).min(end)
                };
                let block = range(y, height).flat_map(|y| range(x, width).map(move |x| (x, y)));
                let colors = block.map(|(x, y)| {
                    let at = 3 * (y as usize * width as usize + x as usize);
                    [panel.pixels[at], panel.pixels[at + 1], panel.pixels[at + 2]]
                });
                pixels.extend(if panel.sparse { brightest(colors) } else { mean(colors) });
            }
        }
        Self { width: across, height: down, pixels }
    }

    fn copy_to(&self, pixels: &mut [u8], width: u32, x: u32, y: u32) {
        let bytes = 3 * self.width as usize;
        for (row, line) in self.pixels.chunks_exact(bytes.max(1)).enumerate() {
            let start = 3 * ((y as usize + row) * width as usize + x as usize);
            pixels[start..start + bytes].copy_from_slice(line);
        }
    }
}

fn brightest(colors: impl Iterator<Item = [u8; 3]>) -> [u8; 3] {
    colors.max_by_key(|c| c.iter().map(|v| u32::from(*v)).sum::<u32>()).unwrap_or_default()
}

/// Of light, not of its encoding.
fn mean(colors: impl Iterator<Item = [u8; 3]>) -> [u8; 3] {
    let (mut sum, mut count, mut first) = ([0.0; 3], 0.0, [0; 3]);
    for color in colors {
        first = color;
        count += 1.0;
        for (sum, v) in sum.iter_mut().zip(color) {
            *sum += crate::color::linear(v);
        }
    }
    if count == 1.0 { first } else { sum.map(|v| encoded(v / f32::max(count, 1.0))) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_have_colours_by_decade() {
        assert_eq!([decade_color(0.0), decade_color(1e-8), decade_color(-1.0)], [[0; 3]; 3]);
        assert_eq!(decade_color(1.0), decade_color(1e9));
        assert_eq!(decade_color(f64::NAN), [255; 3]);
        let light = |v: f64| decade_color(v).iter().map(|c| u32::from(*c)).sum::<u32>();
        assert!((0..6).all(|i| light(10f64.powi(-i)) > light(10f64.powi(-i - 1))));
    }

    #[test]
    fn a_sheet_has_its_panels_pixels() {
        let panel = |width: u32, height: u32, sparse| {
            let mut pixels = vec![0; 3 * (width * height) as usize];
            pixels[..3].copy_from_slice(&[255, 0, 0]);
            Panel { lines: vec!["a".into(), "b".into()], width, height, pixels, sparse }
        };
        // Enlarged by two; shrunk by two, and there one pixel of four is red, or all of it.
        for (panel, red) in [
            (panel(180, 100, false), vec![255; 4]),
            (panel(1600, 900, false), vec![encoded(0.25)]),
            (panel(1600, 900, true), vec![255]),
        ] {
            let sheet = Sheet { title: vec!["title".into()], rows: vec![vec![panel]], ..Sheet::default() };
            let (width, height, pixels) = sheet.draw();
            assert_eq!(pixels.len() as u64, 3 * u64::from(width) * u64::from(height));
            let found: Vec<u8> = pixels
                .chunks_exact(3)
                .filter(|p| p[0] > 100 && p[1] == 0 && p[2] == 0)
                .map(|p| p[0])
                .collect();
            assert_eq!(found, red);
        }
        let (width, height, _) = Sheet::default().draw();
        assert!(width > 0 && height > 0);
    }
}
