use super::MovieError;
use super::change::{Rectangle, changed};
use super::rate::Rate;
use std::io::{Seek, SeekFrom, Write};

/// An animated PNG that loops for ever: 8-bit sRGB, exact. Of each picture the rectangle that changed is written.
pub(super) struct Apng<W> {
    to: W,
    width: usize,
    height: usize,
    rate: Rate,
    frames: u32,
    /// Of fcTL and fdAT chunks, which are counted together.
    sequence: u32,
    /// Where the number of frames stands.
    control: u64,
    given: Vec<u8>,
}

const SIGNATURE: &[u8; 8] = b"\x89PNG\r\n\x1a\n";

fn fault(why: png::EncodingError) -> MovieError {
    match why {
        png::EncodingError::IoError(e) => e.into(),
        other => MovieError::Encoder { codec: "PNG", why: other.to_string() },
    }
}

impl<W: Write + Seek> Apng<W> {
    pub fn new(mut to: W, width: usize, height: usize, rate: Rate) -> Result<Self, MovieError> {
        let (Ok(columns), Ok(rows)) = (i32::try_from(width), i32::try_from(height)) else {
            return Err(MovieError::Size {
                width,
                height,
                why: "a PNG has at most 2³¹ − 1 columns and rows",
            });
        };
        to.write_all(SIGNATURE)?;
        let mut movie =
            Self { to, width, height, rate, frames: 0, sequence: 0, control: 0, given: Vec::new() };
        // Eight bits, RGB, and the only ways there are to compress, filter and order rows.
        let header = [&columns.to_be_bytes()[..], &rows.to_be_bytes(), &[8, 2, 0, 0, 0]].concat();
        movie.chunk(b"IHDR", &header)?;
        movie.control = movie.to.stream_position()?;
        movie.write_control()?;
        // Perceptual intent.
        movie.chunk(b"sRGB", &[0])?;
        Ok(movie)
    }

    fn chunk(&mut self, kind: &[u8; 4], contents: &[u8]) -> Result<(), MovieError> {
        let mut sum = crc32fast::Hasher::new();
        sum.update(kind);
        sum.update(contents);
        self.to.write_all(&(contents.len() as u32).to_be_bytes())?;
        self.to.write_all(kind)?;
        self.to.write_all(contents)?;
        Ok(self.to.write_all(&sum.finalize().to_be_bytes())?)
    }

    fn write_control(&mut self) -> Result<(), MovieError> {
        // Played 0 times: for ever.
        let contents = [self.frames.to_be_bytes(), [0; 4]].concat();
        self.chunk(b"acTL", &contents)
    }

    fn next_in_sequence(&mut self) -> [u8; 4] {
        self.sequence += 1;
        (self.sequence - 1).to_be_bytes()
    }

    pub fn push(&mut self, rgb: &[u8]) -> Result<(), MovieError> {
        let part = if self.given.is_empty() {
            Rectangle { left: 0, top: 0, width: self.width, height: self.height }
        } else {
            changed(&self.given, rgb, self.width)
        };
        let pixels = part.rows(self.width).flat_map(|row| &rgb[row]).copied().collect::<Vec<u8>>();
        let place = [part.width, part.height, part.left, part.top].map(|v| (v as u32).to_be_bytes()).concat();
        let delay = [self.rate.seconds.to_be_bytes(), self.rate.frames.to_be_bytes()].concat();
        let sequence = self.next_in_sequence();
        // Left as it is, written over what was there.
        self.chunk(b"fcTL", &[&sequence[..], &place, &delay, &[0, 0]].concat())?;
        for data in compressed(part, &pixels)? {
            if self.frames == 0 {
                self.chunk(b"IDAT", &data)?;
            } else {
                let sequence = self.next_in_sequence();
                self.chunk(b"fdAT", &[&sequence[..], &data].concat())?;
            }
        }
        self.given.clear();
        self.given.extend_from_slice(rgb);
        self.frames += 1;
        Ok(())
    }

    pub fn finish(mut self) -> Result<W, MovieError> {
        self.chunk(b"IEND", &[])?;
        self.to.seek(SeekFrom::Start(self.control))?;
        self.write_control()?;
        self.to.seek(SeekFrom::End(0))?;
        Ok(self.to)
    }
}

/// The image data of a PNG of these pixels, chunk by chunk.
fn compressed(part: Rectangle, pixels: &[u8]) -> Result<Vec<Vec<u8>>, MovieError> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, part.width as u32, part.height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Balanced);
    let mut writer = encoder.write_header().map_err(fault)?;
    writer.write_image_data(pixels).map_err(fault)?;
    writer.finish().map_err(fault)?;
    let (mut data, mut rest) = (Vec::new(), &file[SIGNATURE.len()..]);
    // Length, kind, contents, checksum.
    while let Some((length, after)) = rest.split_first_chunk::<4>() {
        let (chunk, after) = after.split_at(4 + u32::from_be_bytes(*length) as usize);
        if chunk.starts_with(b"IDAT") {
            data.push(chunk[4..].to_vec());
        }
        rest = &after[4..];
    }
    Ok(data)
}
