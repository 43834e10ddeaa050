use super::MovieError;
use super::change::{Rectangle, changed};
use super::rate::Rate;
use color_quant::NeuQuant;
use gif::{Encoder, EncodingError, Frame, Repeat};
use std::collections::HashMap;
use std::io::Write;

/// NeuQuant learns from about so many pixels; from more it learns little more, but takes longer.
const LESSONS: usize = 20_000;

/// An animated GIF that loops for ever. Pixels that stay as they are are left alone.
pub(super) struct Gif<W: Write> {
    encoder: Encoder<W>,
    width: usize,
    height: usize,
    rate: Rate,
    frames: u64,
    /// The last picture as it was given, and as it is shown: none before the first.
    given: Vec<u8>,
    shown: Vec<u8>,
}

/// Colours and where each stands among them.
struct Palette {
    colors: Vec<[u8; 3]>,
    index: HashMap<[u8; 3], u8>,
}

impl Palette {
    /// All colours there are, if they are no more than 256.
    fn exact(pixels: &[[u8; 3]]) -> Option<Self> {
        let mut palette = Self { colors: Vec::new(), index: HashMap::new() };
        // Colours come in runs.
        let mut last = None;
        for &pixel in pixels {
            if last.replace(pixel) == Some(pixel) || palette.index.contains_key(&pixel) {
                continue;
            }
            palette.index.insert(pixel, u8::try_from(palette.colors.len()).ok()?);
            palette.colors.push(pixel);
        }
        Some(palette)
    }

    /// 255 colours near those there are.
    fn near(pixels: &[[u8; 3]]) -> Self {
        let rgba: Vec<u8> = pixels.iter().flat_map(|&[r, g, b]| [r, g, b, 255]).collect();
        let stride = (pixels.len() / LESSONS).clamp(1, 30) as i32;
        let quantiser = NeuQuant::new(stride, 255, &rgba);
        let colors = quantiser.color_map_rgb().as_chunks().0.to_vec();
        let mut index = HashMap::new();
        for &pixel in pixels {
            let [r, g, b] = pixel;
            index.entry(pixel).or_insert_with(|| quantiser.index_of(&[r, g, b, 255]) as u8);
        }
        Self { colors, index }
    }
}

fn fault(why: EncodingError) -> MovieError {
    match why {
        EncodingError::Io(e) => e.into(),
        other => MovieError::Encoder { codec: "GIF", why: other.to_string() },
    }
}

impl<W: Write> Gif<W> {
    pub fn new(to: W, width: usize, height: usize, rate: Rate) -> Result<Self, MovieError> {
        let (Ok(columns), Ok(rows)) = (u16::try_from(width), u16::try_from(height)) else {
            return Err(MovieError::Size { width, height, why: "a GIF has at most 65535 columns and rows" });
        };
        let mut encoder = Encoder::new(to, columns, rows, &[]).map_err(fault)?;
        encoder.set_repeat(Repeat::Infinite).map_err(fault)?;
        Ok(Self { encoder, width, height, rate, frames: 0, given: Vec::new(), shown: Vec::new() })
    }

    /// Hundredths of a second from the start to a frame, rounded: what delays differ by is spread over the film.
    fn start(&self, frame: u64) -> u64 {
        let rate = u64::from(self.rate.frames);
        (100 * frame * u64::from(self.rate.seconds) + rate / 2) / rate
    }

    pub fn push(&mut self, rgb: &[u8]) -> Result<(), MovieError> {
        let exact = Palette::exact(rgb.as_chunks().0);
        // What is shown differs a little from what was given where there were too many colours; a picture that has
        // few puts that right, one that has many would only flicker.
        let before = if exact.is_some() { &self.shown } else { &self.given };
        let first = before.is_empty();
        let part = if first {
            Rectangle { left: 0, top: 0, width: self.width, height: self.height }
        } else {
            changed(before, rgb, self.width)
        };
        let stays = |at: usize| !first && before[at..at + 3] == rgb[at..at + 3];
        let pixels = || part.rows(self.width).flatten().step_by(3);
        let color = |at: usize| [rgb[at], rgb[at + 1], rgb[at + 2]];
        let palette = exact.unwrap_or_else(|| {
            let new: Vec<_> = pixels().filter(|&at| !stays(at)).map(color).collect();
            Palette::near(&new)
        });
        let transparent = u8::try_from(palette.colors.len()).ok();
        let mut last = ([0; 3], None);
        let mut index = |color: [u8; 3]| {
            if last.0 != color || last.1.is_none() {
                last = (color, palette.index.get(&color).copied());
            }
            last.1.unwrap_or_default()
        };
        let indices: Vec<u8> = pixels()
            .map(|at| match transparent {
                Some(nothing) if stays(at) => nothing,
                _ => index(color(at)),
            })
            .collect();
        self.shown.resize(rgb.len(), 0);
        for (at, &i) in part.rows(self.width).flatten().step_by(3).zip(&indices) {
            if let Some(color) = palette.colors.get(usize::from(i)) {
                self.shown[at..at + 3].copy_from_slice(color);
            }
        }
        let mut colors = palette.colors.concat();
        if transparent.is_some() {
            colors.extend([0; 3]);
        }
        let frame = Frame {
            delay: (self.start(self.frames + 1) - self.start(self.frames)) as u16,
            transparent,
            left: part.left as u16,
            top: part.top as u16,
            width: part.width as u16,
            height: part.height as u16,
            palette: Some(colors),
            buffer: indices.into(),
            ..Frame::default()
        };
        self.encoder.write_frame(&frame).map_err(fault)?;
        self.given.clear();
        self.given.extend_from_slice(rgb);
        self.frames += 1;
        Ok(())
    }

    pub fn finish(self) -> Result<W, MovieError> {
        self.encoder.into_inner().map_err(fault)
    }
}
