//! Polygon shading on a graphics processor: exact and apparent, through Vulkan, Metal or DirectX 12.
//!
//! What needs more than single precision is done before anything is uploaded: the observer's place in the rest frame, the
//! motion, and for every triangle the functions of a line of sight that say whether and where it is met. They are linear
//! in light-cone coordinates of the body's motion, in which single precision is enough at high γ, too
//! ([`MOST_GAMMA_ON_GPU`](crate::plan::MOST_GAMMA_ON_GPU)). A first pass finds the nearest triangle for one sample of every
//! pixel; a second works out what is seen of it, and adds it to the film. So memory does not grow with the samples. Pictures larger than a target are drawn in parts.

mod cone;
mod device;
mod error;
mod guard;
mod load;
mod looks;
mod pipelines;
mod records;
mod shaders;

use super::Drawable;
use crate::film::{Film, Samples};
use crate::light::SeenShading;
use crate::scene::Lens;
use crate::tone::Development;
pub use device::Gpu;
pub use error::GpuError;
use load::Load;
pub use load::Uncut;
pub use shaders::shaders;

impl Gpu {
    /// Exact shading: draws bodies uncut on a film, which is cleared first; `shading` is for the same observer.
    ///
    /// # Errors
    /// If the device cannot.
    pub fn draw_uncut(
        &self,
        bodies: &[Uncut<'_>],
        lens: &Lens,
        samples: &Samples,
        shading: &SeenShading<'_>,
        film: &mut Film,
    ) -> Result<(), GpuError> {
        self.expose(&Load::uncut(bodies, lens, samples, shading), lens, samples, shading.coloring(), film)
    }

    /// Apparent shading: draws apparent meshes on a film, which is cleared first; `shading` is for the same observer.
    ///
    /// # Errors
    /// If the device cannot.
    pub fn draw(
        &self,
        bodies: &[Drawable<'_>],
        lens: &Lens,
        samples: &Samples,
        shading: &SeenShading<'_>,
        film: &mut Film,
    ) -> Result<(), GpuError> {
        self.expose(&Load::cut(bodies, lens, samples, shading), lens, samples, shading.coloring(), film)
    }

    /// Exact shading straight to a picture, 8-bit sRGB, three bytes a pixel, rows from the top: developed on the device, so
    /// that a seventh of a film is read back.
    ///
    /// # Errors
    /// If the device cannot.
    pub fn picture_uncut(
        &self,
        bodies: &[Uncut<'_>],
        lens: &Lens,
        samples: &Samples,
        shading: &SeenShading<'_>,
        development: &Development,
    ) -> Result<Vec<u8>, GpuError> {
        let load = Load::uncut(bodies, lens, samples, shading);
        self.picture(&load, lens, samples, shading.coloring(), development)
    }
}
