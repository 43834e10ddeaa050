//! Polygon shading: apparent triangles to the film, by a z-buffer.
//!
//! Triangles are tested by the planes through the observer and their edges, in homogeneous form: a triangle
//! that crosses the camera plane or surrounds the camera needs no clipping, and under a fisheye or a panorama
//! its edges are as straight in space as under a pinhole. Depth is apparent depth of all bodies in the one
//! camera frame, whatever their velocities. Work is cut into bands of rows, drawn on all cores.

mod band;
mod bins;
mod bounds;
mod triangle;

use crate::apparent::ApparentMesh;
use crate::color::Coloring;
use crate::film::Film;
use crate::relativity::ApparentMap;
use crate::scene::{Lens, Mesh};
use band::Band;
use rayon::prelude::*;

/// A body ready to be drawn.
#[derive(Clone, Copy, Debug)]
pub struct Drawable<'a> {
    /// Index of the body in the scene.
    pub body: usize,
    /// The mesh at rest, for its colours.
    pub mesh: &'a Mesh,
    /// The map it is seen through, for its Doppler factor.
    pub map: &'a ApparentMap,
    /// The mesh as it is seen.
    pub seen: &'a ApparentMesh,
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

    /// Least and greatest offset, x and y.
    fn range(&self) -> [[f64; 2]; 2] {
        let of = |pick: fn(f64, f64) -> f64| {
            self.0.iter().copied().reduce(|a, b| [pick(a[0], b[0]), pick(a[1], b[1])]).unwrap_or([0.5; 2])
        };
        [of(f64::min), of(f64::max)]
    }
}

/// Rows drawn as one task.
const BAND: u32 = 16;

/// Draws apparent meshes.
pub fn shade(bodies: &[Drawable<'_>], lens: &Lens, samples: &Samples, coloring: Coloring) -> Film {
    let mut film = Film::new(lens.width(), lens.height());
    let bins = bins::Bins::new(bodies, lens, samples);
    let pixels = lens.width() as usize * BAND as usize;
    film.color
        .par_chunks_mut(pixels)
        .zip(film.distance.par_chunks_mut(pixels))
        .zip(film.doppler.par_chunks_mut(pixels))
        .zip(film.body.par_chunks_mut(pixels))
        .zip(film.face.par_chunks_mut(pixels))
        .enumerate()
        .for_each_init(Band::default, |band, (index, ((((color, distance), doppler), body), face))| {
            let out = band::Rows { color, distance, doppler, body, face };
            band.draw(bodies, &bins, lens, samples, coloring, index as u32 * BAND, out);
        });
    film
}
