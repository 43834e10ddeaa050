//! What pictures are drawn on.

use super::{Options, Raster, RenderError};
use crate::plan::{is_worth_a_gpu, not_on_gpu, samples_to_draw};
#[cfg(feature = "gpu")]
use crate::raster::gpu::Gpu;
use crate::scene::{Camera, Scene};
use std::path::Path;
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
        if !is_asked && !may_have_hardware() {
            return Err(OnCpu::NoHardware);
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
    /// The system knows of none.
    #[error("this machine has none")]
    NoHardware,
    /// None could be opened.
    #[error(transparent)]
    None(RenderError),
    /// The one there is.
    #[error("{0} is a program on the CPU, slower than what there is for it")]
    Software(String),
}

/// Whether there is a graphics processor that is more than a program on the CPU.
pub fn has_gpu() -> bool {
    may_have_hardware() && open().is_ok_and(|device| device.is_hardware())
}

/// Whether it is worth asking drivers for a graphics processor. Where Linux shows none there is none, and drivers of software
/// need not be started, which takes a while, and complain of desktops that are not there.
fn may_have_hardware() -> bool {
    const NODES: [&str; 5] = ["/dev/dri", "/dev/nvidiactl", "/dev/dxg", "/dev/kgsl-3d0", "/dev/mali0"];
    !cfg!(target_os = "linux") || NODES.iter().any(|node| Path::new(node).exists())
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
