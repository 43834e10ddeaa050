//! Films that move: pictures to MP4, GIF or APNG, as they come.

mod apng;
mod avc;
mod change;
mod gif;
mod mp4;
mod rate;
mod yuv;

use self::{apng::Apng, gif::Gif, mp4::Mp4, rate::Rate};
use std::io::{Seek, Write};
use std::path::Path;

/// Formats of moving pictures we write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MovieFormat {
    /// H.264 in MP4: small, plays everywhere, nearly exact.
    Mp4,
    /// At most 256 colours a frame.
    Gif,
    /// Every pixel exact.
    Apng,
}

/// Why a movie could not be written.
#[derive(Debug, thiserror::Error)]
pub enum MovieError {
    /// The place cannot be written to.
    #[error(transparent)]
    Io(#[from] std::io::Error),
    /// A rate the format has no way to say, or that players do not keep.
    #[error("{fps} frames a second: {why}")]
    Rate {
        /// What was asked for.
        fps: f64,
        /// What is possible.
        why: &'static str,
    },
    /// A size the format does not allow.
    #[error("{width}x{height} pixels: {why}")]
    Size {
        /// Pixels across.
        width: usize,
        /// Pixels down.
        height: usize,
        /// What is possible.
        why: &'static str,
    },
    /// A frame that is not of the movie's size.
    #[error("a frame has {got} bytes; one of the movie's size has {expected}")]
    Frame {
        /// Bytes of the movie's frames.
        expected: usize,
        /// Bytes of this one.
        got: usize,
    },
    /// No frame was written.
    #[error("a movie needs at least one frame")]
    Empty,
    /// The encoder gave up.
    #[error("{codec}: {why}")]
    Encoder {
        /// Which one.
        codec: &'static str,
        /// What it said.
        why: String,
    },
}

impl MovieFormat {
    /// By a file's ending, .mp4, .gif or .apng; None on any other.
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_string_lossy().to_lowercase().as_str() {
            "mp4" => Some(Self::Mp4),
            "gif" => Some(Self::Gif),
            "apng" => Some(Self::Apng),
            _ => None,
        }
    }

    /// The rate as a ratio, if players keep it.
    fn rate(self, fps: f64) -> Result<Rate, MovieError> {
        let refuse = |why| Err(MovieError::Rate { fps, why });
        let Some(rate) = Rate::of(fps) else {
            return refuse("a movie has between 1/65535 and 65535");
        };
        match self {
            Self::Gif if fps > 50.0 => {
                refuse("a GIF has at most 50, as players show shorter frames for a tenth of a second")
            }
            Self::Gif if fps < 0.01 => refuse("a GIF has at least one in a hundred seconds"),
            Self::Apng if fps > 90.0 => {
                refuse("an APNG has at most 90, as players show shorter frames for a tenth of a second")
            }
            _ => Ok(rate),
        }
    }
}

/// A movie that is being written, frame by frame; memory for a few frames is all it needs.
///
/// ```
/// use terrell::picture::{Movie, MovieFormat};
///
/// let file = std::io::Cursor::new(Vec::new());
/// let mut movie = Movie::new(MovieFormat::Apng, file, 2, 1, 25.0)?;
/// movie.push(&[255, 0, 0, 0, 0, 255])?;
/// movie.push(&[0, 0, 255, 255, 0, 0])?;
/// let apng = movie.finish()?.into_inner();
/// assert!(apng.starts_with(b"\x89PNG"));
/// # Ok::<(), terrell::picture::MovieError>(())
/// ```
pub struct Movie<W: Write + Seek> {
    writer: Writer<W>,
    width: usize,
    height: usize,
    frames: u64,
}

enum Writer<W: Write + Seek> {
    Mp4(Box<Mp4<W>>),
    Gif(Gif<W>),
    Apng(Apng<W>),
}

impl<W: Write + Seek> Movie<W> {
    /// A movie to an empty file, by its beginning. A buffered one: what is written comes in small pieces.
    ///
    /// The rate is kept exactly where it is a ratio of whole numbers below 65536 (29.97 and 30000/1001 are), else to
    /// one part in 65536 or better; in a GIF as a mean, each frame a whole number of hundredths of a second. In MP4 a last odd
    /// column or row is repeated, as sizes are even there.
    ///
    /// # Errors
    /// On a size or rate the format does not hold (GIF: 50 frames a second at most, APNG: 90; MP4: what a level of
    /// H.264 allows), or if the writer fails.
    pub fn new(format: MovieFormat, to: W, width: u32, height: u32, fps: f64) -> Result<Self, MovieError> {
        let rate = format.rate(fps)?;
        let (width, height) = (width as usize, height as usize);
        if width == 0 || height == 0 {
            return Err(MovieError::Size { width, height, why: "there is nothing to see" });
        }
        let writer = match format {
            MovieFormat::Mp4 => Writer::Mp4(Box::new(Mp4::new(to, width, height, rate)?)),
            MovieFormat::Gif => Writer::Gif(Gif::new(to, width, height, rate)?),
            MovieFormat::Apng => Writer::Apng(Apng::new(to, width, height, rate)?),
        };
        Ok(Self { writer, width, height, frames: 0 })
    }

    /// Adds a frame: 8-bit sRGB, three bytes a pixel, rows from the top
    /// ([`pixels_srgb`](super::pixels_srgb) of a film).
    ///
    /// # Errors
    /// On a wrong number of bytes (the frame is then left out), or if the writer or the encoder fails; the movie
    /// cannot be saved then.
    pub fn push(&mut self, rgb: &[u8]) -> Result<(), MovieError> {
        let expected = 3 * self.width * self.height;
        if rgb.len() != expected {
            return Err(MovieError::Frame { expected, got: rgb.len() });
        }
        match &mut self.writer {
            Writer::Mp4(movie) => movie.push(rgb, self.width)?,
            Writer::Gif(movie) => movie.push(rgb)?,
            Writer::Apng(movie) => movie.push(rgb)?,
        }
        self.frames += 1;
        Ok(())
    }

    /// Ends the movie; it is whole after any number of frames but none. Without it no file is.
    ///
    /// # Errors
    /// If no frame was added, or the writer fails.
    pub fn finish(self) -> Result<W, MovieError> {
        if self.frames == 0 {
            return Err(MovieError::Empty);
        }
        let mut to = match self.writer {
            Writer::Mp4(movie) => movie.finish()?,
            Writer::Gif(movie) => movie.finish()?,
            Writer::Apng(movie) => movie.finish()?,
        };
        to.flush()?;
        Ok(to)
    }
}
