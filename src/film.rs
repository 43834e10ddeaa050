//! What every method fills and every output reads.

/// Linear light and geometry, pixel by pixel, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Linear sRGB radiance, averaged over the samples of the pixel.
    pub color: Vec<[f32; 3]>,
    /// Apparent distance r at the pixel's centre; 0 where nothing is seen.
    pub distance: Vec<f32>,
    /// Doppler factor at the pixel's centre; 0 where nothing is seen.
    pub doppler: Vec<f32>,
    /// Index of the body in the scene; [`NOTHING`] where nothing is seen.
    pub body: Vec<i32>,
    /// Index of the triangle in the body's file; [`NOTHING`] where nothing is seen.
    pub face: Vec<i32>,
}

/// Body and face of a pixel where nothing is seen.
pub const NOTHING: i32 = -1;

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
        (self.width, self.height) = (width, height);
        let pixels = width as usize * height as usize;
        self.color.clear();
        self.color.resize(pixels, [0.0; 3]);
        for values in [&mut self.distance, &mut self.doppler] {
            values.clear();
            values.resize(pixels, 0.0);
        }
        for indices in [&mut self.body, &mut self.face] {
            indices.clear();
            indices.resize(pixels, NOTHING);
        }
    }

    /// How many pixels see something.
    pub fn covered(&self) -> usize {
        self.body.iter().filter(|&&b| b != NOTHING).count()
    }
}
