//! What every method fills and every output reads.

use rayon::prelude::*;

/// Linear light and geometry, pixel by pixel, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Linear sRGB radiance, averaged over the samples of the pixel.
    pub color: Vec<[f32; 3]>,
    /// Apparent distance r at the pixel's centre; 0 where no body is seen. In curved spacetime the affine parameter in
    /// units in which the observer sees frequency 1.
    pub distance: Vec<f32>,
    /// Doppler factor at the pixel's centre; 0 where nothing is seen.
    pub doppler: Vec<f32>,
    /// Index of the body in the scene; [`NOTHING`], [`HOLE`], [`FAILED`] or [`IMPOSSIBLE`] where there is none.
    pub body: Vec<i32>,
    /// Index of the triangle in the body's file; [`NOTHING`] where nothing is seen.
    pub face: Vec<i32>,
}

/// Where in a pixel its samples lie, in pixels from its upper left corner.
#[derive(Clone, Debug, PartialEq)]
pub struct Samples(Vec<[f64; 2]>);

impl Samples {
    /// The most samples a pixel can have.
    pub const MOST: u32 = 1024;

    /// `count` samples a pixel, spread evenly (the R₂ sequence of M. Roberts, 2018, shifted so that one
    /// sample is the pixel's centre).
    pub fn new(count: u32) -> Self {
        // Reciprocals of the plastic number and its square.
        const STEP: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3];
        Self(
            (0..count.clamp(1, Self::MOST)).map(|i| STEP.map(|s| (0.5 + s * f64::from(i)).fract())).collect(),
        )
    }

    /// They themselves; the first is the pixel's centre.
    pub fn offsets(&self) -> &[[f64; 2]] {
        &self.0
    }

    /// Least and greatest offset, x and y.
    pub(crate) fn range(&self) -> [[f64; 2]; 2] {
        let of = |pick: fn(f64, f64) -> f64| {
            self.0.iter().copied().reduce(|a, b| [pick(a[0], b[0]), pick(a[1], b[1])]).unwrap_or([0.5; 2])
        };
        [of(f64::min), of(f64::max)]
    }
}

/// Some rows of a film, to be filled.
pub(crate) struct Rows<'a> {
    pub color: &'a mut [[f32; 3]],
    pub distance: &'a mut [f32],
    pub doppler: &'a mut [f32],
    pub body: &'a mut [i32],
    pub face: &'a mut [i32],
}

impl Rows<'_> {
    /// Takes off everything.
    pub fn clear(&mut self) {
        self.color.fill([0.0; 3]);
        self.distance.fill(0.0);
        self.doppler.fill(0.0);
        self.body.fill(NOTHING);
        self.face.fill(NOTHING);
    }
}

/// Body and face of a pixel where nothing is seen, or the sky.
pub const NOTHING: i32 = -1;

/// Body of a pixel that sees a black hole; its face is [`NOTHING`].
pub const HOLE: i32 = -2;

/// Body of a pixel whose ray could not be followed, so that what it sees is not known; its face is [`NOTHING`].
pub const FAILED: i32 = -3;

/// Body of a pixel that sees what cannot be: a surface that would move faster than light where it is. Its face is
/// [`NOTHING`].
pub const IMPOSSIBLE: i32 = -4;

/// Colour of pixels that have no right one, conspicuous: magenta.
pub const FLAGGED: [f32; 3] = [1.0, 0.0, 1.0];

impl Film {
    /// A film on which nothing is seen.
    pub fn new(width: u32, height: u32) -> Self {
        let pixels = width as usize * height as usize;
        Self {
            width,
            height,
            color: vec![[0.0; 3]; pixels],
            distance: vec![0.0; pixels],
            doppler: vec![0.0; pixels],
            body: vec![NOTHING; pixels],
            face: vec![NOTHING; pixels],
        }
    }

    /// Takes off everything, and takes the given size; what memory there is stays.
    pub fn clear(&mut self, width: u32, height: u32) {
        self.resize(width, height);
        self.bands(16).for_each(|mut rows| rows.clear());
    }

    /// Takes the given size. What is there then means nothing: who draws a part clears it first, which is quicker than clearing
    /// all at once.
    pub(crate) fn resize(&mut self, width: u32, height: u32) {
        (self.width, self.height) = (width, height);
        let pixels = width as usize * height as usize;
        self.color.resize(pixels, [0.0; 3]);
        self.distance.resize(pixels, 0.0);
        self.doppler.resize(pixels, 0.0);
        self.body.resize(pixels, NOTHING);
        self.face.resize(pixels, NOTHING);
    }

    /// The film in bands of so many rows, to be filled by all threads.
    pub(crate) fn bands(&mut self, rows: u32) -> impl IndexedParallelIterator<Item = Rows<'_>> {
        let pixels = (self.width as usize * rows as usize).max(1);
        self.color
            .par_chunks_mut(pixels)
            .zip(self.distance.par_chunks_mut(pixels))
            .zip(self.doppler.par_chunks_mut(pixels))
            .zip(self.body.par_chunks_mut(pixels))
            .zip(self.face.par_chunks_mut(pixels))
            .map(|((((color, distance), doppler), body), face)| Rows { color, distance, doppler, body, face })
    }

    /// How many pixels see a body.
    pub fn covered(&self) -> usize {
        self.body.iter().filter(|&&b| b >= 0).count()
    }

    /// Whether a pixel has no right colour.
    #[inline]
    pub fn is_flagged(&self, pixel: usize) -> bool {
        matches!(self.body[pixel], FAILED | IMPOSSIBLE)
    }
}
