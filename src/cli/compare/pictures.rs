use super::table::{number, times};
use super::{Drawing, Found};
use std::path::Path;
use terrell::drawing::{Panel, Sheet, decade_color};
use terrell::film::Film;
use terrell::measure::{Disagreement, Mark, Reference};
use terrell::picture::{self, Pending, WriteError};
use terrell::tone::Development;

/// What a mark is shown as, and what it says.
const MARKS: [(Mark, [u8; 3], &str); 5] = [
    (
        Mark::Silhouette,
        [255, 214, 0],
        "another body, within a pixel of where the reference sees it (silhouette)",
    ),
    (Mark::BeyondSilhouette, [255, 40, 40], "another body, beyond that"),
    (
        Mark::Edge,
        [70, 160, 255],
        "another face of the same body, within a pixel of where the reference sees it (edge)",
    ),
    (Mark::BeyondEdge, [255, 60, 255], "another face of the same body, beyond that"),
    (Mark::LeftOut, [70, 70, 130], "the reference has no finite numbers"),
];

/// The films' pictures of a scene, and the composed one, as they grow.
pub struct Pictures<'a> {
    folder: &'a Path,
    exr: bool,
    development: Development,
    sheet: Sheet,
    /// Written, without their names yet.
    pub files: Vec<Pending>,
}

impl<'a> Pictures<'a> {
    pub fn new(folder: &'a Path, exr: bool, development: Development, title: Vec<String>) -> Self {
        let key = MARKS.iter().map(|(_, color, what)| (*color, (*what).to_owned())).collect();
        let sheet = Sheet { title, key, decades: true, ..Sheet::default() };
        Self { folder, exr, development, sheet, files: Vec::new() }
    }

    /// The reference's own.
    pub fn add_reference(&mut self, reference: &Reference, lines: Vec<String>) {
        self.sheet.rows.push(vec![self.shown(&reference.film, lines)]);
    }

    /// A way's film, as a picture (and as EXR).
    pub fn add_film(&mut self, name: &str, film: &Film) -> Result<(), WriteError> {
        for ending in ["png", "exr"].into_iter().take(if self.exr { 2 } else { 1 }) {
            let path = self.folder.join(format!("{name}.{ending}"));
            self.files.push(picture::prepare_picture(film, &self.development, &path)?);
        }
        Ok(())
    }

    /// How a way's film differs.
    pub fn add_difference(
        &mut self,
        drawing: &Drawing,
        film: &Film,
        reference: &Reference,
        found: &Found,
    ) -> Result<(), WriteError> {
        let way = drawing.way;
        let light = found.comparison.whole.radiance;
        let difference = Panel {
            lines: vec![
                format!("{}: difference of light, by its logarithm", way.name),
                format!(
                    "RMS {}, worst {} of the peak; FLIP {}",
                    number(light.relative_rms),
                    number(light.worst),
                    number(found.perceived.mean)
                ),
            ],
            sparse: true,
            ..panel(film, difference(film, reference, &found.comparison.marks, light.peak))
        };
        let shown = self
            .shown(film, vec![format!("{}: {}", way.name, way.about), times(drawing.once, drawing.picture)]);
        let said = |what: &str, found: &Option<Disagreement>| {
            found.as_ref().map(|f| format!("{what} {} px, {} of them beyond", f.pixels, f.beyond))
        };
        let whole = &found.comparison.whole;
        let said: Vec<String> = [said("silhouettes", &whole.silhouette), said("edges", &whole.edges)]
            .into_iter()
            .flatten()
            .collect();
        let seen = Panel {
            lines: vec![
                format!("{}: what is seen", way.name),
                if said.is_empty() { "the reference has no bodies".into() } else { said.join("; ") },
            ],
            sparse: true,
            ..panel(film, marked(&shown.pixels, &found.comparison.marks))
        };
        let alone =
            Sheet { rows: vec![vec![difference.clone()]], decades: true, whole: true, ..Sheet::default() };
        self.write(&format!("difference_{}", way.name), alone.draw())?;
        self.write(&format!("seen_{}", way.name), (seen.width, seen.height, seen.pixels.clone()))?;
        self.sheet.rows.push(vec![shown, difference, seen]);
        Ok(())
    }

    /// The composed picture, and all files.
    pub fn finish(mut self) -> Result<Vec<Pending>, WriteError> {
        let drawn = self.sheet.draw();
        self.write("compare", drawn)?;
        Ok(self.files)
    }

    fn write(&mut self, name: &str, (width, height, pixels): (u32, u32, Vec<u8>)) -> Result<(), WriteError> {
        let path = self.folder.join(format!("{name}.png"));
        let file = picture::prepare(&path, |to| picture::write_png_pixels(width, height, &pixels, to))?;
        self.files.push(file);
        Ok(())
    }

    fn shown(&self, film: &Film, lines: Vec<String>) -> Panel {
        Panel { lines, ..panel(film, picture::pixels_srgb(film, &self.development)) }
    }
}

fn panel(film: &Film, pixels: Vec<u8>) -> Panel {
    Panel { lines: Vec::new(), width: film.width, height: film.height, pixels, sparse: false }
}

fn difference(film: &Film, reference: &Reference, marks: &[Mark], peak: f64) -> Vec<u8> {
    let off = |i: usize| {
        let pairs = film.color[i].into_iter().zip(reference.film.color[i]);
        // NaN is greater than all else.
        pairs.map(|(a, b)| (f64::from(a) - f64::from(b)).abs()).max_by(f64::total_cmp).unwrap_or(0.0)
    };
    let color = |i: usize| match (marks[i], off(i)) {
        (Mark::LeftOut, _) | (_, 0.0) => [0; 3],
        (_, off) => decade_color(off / peak),
    };
    (0..marks.len()).flat_map(color).collect()
}

/// The picture, grey and dark, with what disagrees in colours.
fn marked(pixels: &[u8], marks: &[Mark]) -> Vec<u8> {
    let color = |(pixel, mark): (&[u8], &Mark)| match MARKS.iter().find(|(known, ..)| known == mark) {
        Some((_, color, _)) => *color,
        None => [((u32::from(pixel[0]) + 2 * u32::from(pixel[1]) + u32::from(pixel[2])) / 10) as u8; 3],
    };
    pixels.chunks_exact(3).zip(marks).flat_map(color).collect()
}

/// Pictures of both with what is left out black in both, for whoever compares them.
pub fn pair(reference: &Reference, film: &Film, development: &Development) -> [Vec<u8>; 2] {
    let mut both = [&reference.film, film].map(|film| picture::pixels_srgb(film, development));
    for (i, _) in reference.left_out.iter().enumerate().filter(|(_, left)| **left) {
        both.iter_mut().for_each(|pixels| pixels[3 * i..3 * i + 3].fill(0));
    }
    both
}
