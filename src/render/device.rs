//! What pictures are drawn on.

use super::{Options, Raster, RenderError};
use crate::plan::{is_worth_a_gpu, not_on_gpu, samples_to_draw};
#[cfg(feature = "gpu")]
use crate::raster::gpu::Gpu;
use crate::scene::{Camera, Scene};
#[cfg(feature = "gpu")]
use std::sync::Arc;

impl Options {
    /// The graphics processor to draw with, if one is to.
    pub(super) fn gpu(&self, scene: &Scene, cameras: &[&Camera]) -> Result<Option<Device>, RenderError> {
        match self.find_gpu(scene, cameras) {
            Ok(gpu) => Ok(Some(gpu)),
            Err(OnCpu::NotOnGpu(reason)) if self.raster == Raster::Wgpu => Err(RenderError::NotOnGpu(reason)),
            Err(OnCpu::None(fault)) if self.raster == Raster::Wgpu => Err(fault),
            Err(_) => Ok(None),
        }
    }

    /// The same, or why there is none.
    fn find_gpu(&self, scene: &Scene, cameras: &[&Camera]) -> Result<Device, OnCpu> {
        if matches!(self.raster, Raster::Cpu | Raster::Skia) {
            return Err(OnCpu::NotAsked);
        }
        if let Some(reason) = not_on_gpu(scene, cameras, self.method, self.coloring, self.doppler_at) {
            return Err(OnCpu::NotOnGpu(reason));
        }
        let is_asked = self.raster == Raster::Wgpu;
        if !is_asked && !is_worth_a_gpu(cameras, self.samples) {
            return Err(OnCpu::NotWorth(samples_to_draw(cameras, self.samples)));
        }
        let gpu = open().map_err(OnCpu::None)?;
        if is_asked || gpu.is_hardware() { Ok(gpu) } else { Err(OnCpu::Software(gpu.name().to_owned())) }
    }

    /// The name of the graphics processor that pictures of a scene by these cameras are drawn on, or why none is. One is
    /// looked for where drawing would look for one.
    ///
    /// # Errors
    /// Why the CPU draws.
    pub fn device(&self, scene: &Scene, cameras: &[&Camera]) -> Result<String, OnCpu> {
        self.find_gpu(scene, cameras).map(|gpu| gpu.name().to_owned())
    }
}

/// Why the CPU draws.
#[derive(Clone, Debug, thiserror::Error)]
pub enum OnCpu {
    /// Nothing else is asked for.
    #[error("not asked for")]
    NotAsked,
    /// What a graphics processor is not for.
    #[error("{0}")]
    NotOnGpu(&'static str),
    /// So many samples are too few.
    #[error("not looked for: {0} samples are drawn sooner than one is opened")]
    NotWorth(u64),
    /// There is none.
    #[error(transparent)]
    None(RenderError),
    /// The one there is.
    #[error("{0} is a program on the CPU, slower than what there is for it")]
    Software(String),
}

/// A graphics processor that pictures can be drawn on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Adapter {
    /// What it calls itself.
    pub name: String,
    /// Whether it is more than a program on the CPU.
    pub is_hardware: bool,
}

impl Adapter {
    /// The one there is.
    ///
    /// # Errors
    /// Why there is none, for people to read.
    pub fn find() -> Result<Self, String> {
        let device = open().map_err(|e| e.to_string())?;
        Ok(Self { name: device.name().to_owned(), is_hardware: device.is_hardware() })
    }
}

#[cfg(feature = "gpu")]
pub(super) type Device = Arc<Gpu>;

#[cfg(feature = "gpu")]
fn open() -> Result<Device, RenderError> {
    Ok(Gpu::shared()?)
}

/// There is none.
#[cfg(not(feature = "gpu"))]
#[derive(Clone, Debug)]
pub(super) enum Device {}

#[cfg(not(feature = "gpu"))]
impl Device {
    fn is_hardware(&self) -> bool {
        match *self {}
    }

    fn name(&self) -> &str {
        match *self {}
    }
}

#[cfg(not(feature = "gpu"))]
fn open() -> Result<Device, RenderError> {
    Err(RenderError::NotOnGpu("this program was built without the feature gpu"))
}
