use super::Fault;
use super::source;
use super::values::{count, number, size};
use super::velocity::VelocityFlags;
use clap::{Args, ValueEnum};
use terrell::color::Coloring;
use terrell::render::{Options, Raster};
use terrell::scene::{Choice, Projection, Scene, Speed, View};

/// What there is to see, and how large: what everything made of a scene has in common.
#[derive(Args)]
pub struct SceneFlags {
    #[command(flatten)]
    pub velocity: VelocityFlags,
    /// Seconds of a file's own animation that pass in a unit of time; 0 stops it
    #[arg(long, value_name = "R", value_parser = number)]
    animation_rate: Option<f64>,
    /// Which scene of a glTF file, where it has several; numbers count from 1 [default: the file's own]
    #[arg(long, value_name = "NAME|NUMBER")]
    file_scene: Option<String>,
    /// Which camera of a glTF file's scene; numbers count from 1 [default: the first with perspective]
    #[arg(long, value_name = "NAME|NUMBER")]
    file_camera: Option<String>,
    /// Pixels
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<[u32; 2]>,
    /// Field of view in degrees: vertical (pinhole, fisheye)
    #[arg(long, value_name = "DEG", value_parser = number)]
    fov: Option<f64>,
}

/// How a scene is looked at: what pictures and films have in common.
#[derive(Args)]
pub struct LookFlags {
    #[command(flatten)]
    pub scene: SceneFlags,
    /// Projection
    #[arg(long, value_enum)]
    camera: Option<CameraFlag>,
    /// Largest distance between a drawn edge and its exact image; cost grows as 1/√ for edges, 1/ for faces
    #[arg(long, value_name = "PX", value_parser = number, default_value = "0.25")]
    pub tolerance: f64,
    /// Samples a pixel
    #[arg(long, value_name = "N", value_parser = count, default_value = "1")]
    samples: u32,
    /// What a pixel shows
    #[arg(long, value_enum, default_value = "geometry")]
    color: ColorFlag,
    /// What decides which triangle a pixel sees
    #[arg(long, value_enum, default_value = "cpu")]
    raster: RasterFlag,
}

#[derive(Clone, Copy, ValueEnum)]
enum CameraFlag {
    /// Straight lines stay straight
    Pinhole,
    /// Equidistant
    Fisheye,
    /// Equirectangular, the whole sky
    Panorama,
}

#[derive(Clone, Copy, ValueEnum)]
pub(super) enum ColorFlag {
    /// The meshes' own colours, without shift and beaming
    Geometry,
    /// The Doppler factor in false colour: white 1, blue above, red below
    Doppler,
}

#[derive(Clone, Copy, ValueEnum)]
enum RasterFlag {
    /// A z-buffer: exact
    Cpu,
    /// Triangles painted back to front by tiny-skia: wrong where they pass through each other
    Skia,
}

impl LookFlags {
    pub fn options(&self) -> Result<Options, Fault> {
        if self.tolerance <= 0.0 {
            return Err(format!("--tolerance {} is not above 0 px", self.tolerance).into());
        }
        Ok(Options {
            tolerance: self.tolerance,
            samples: self.samples,
            coloring: self.color.coloring(),
            raster: match self.raster {
                RasterFlag::Cpu => Raster::Cpu,
                RasterFlag::Skia => Raster::Skia,
            },
            ..Options::default()
        })
    }

    /// What the flags say of the projection.
    pub fn set_lens(&self, view: &mut View) {
        if let Some(camera) = self.camera {
            let projection = match camera {
                CameraFlag::Pinhole => Projection::Pinhole,
                CameraFlag::Fisheye => Projection::Fisheye,
                CameraFlag::Panorama => Projection::Panorama,
            };
            if projection != view.projection {
                (view.projection, view.fov_deg) = (projection, None);
            }
        }
    }
}

impl SceneFlags {
    /// The scene, with what the flags say over what it says itself; `set_lens` does more to its lens.
    pub fn open(
        &self,
        scene: &str,
        speed: Option<Speed>,
        set_lens: impl Fn(&mut View),
    ) -> Result<Scene, Fault> {
        let choice = Choice { scene: self.file_scene.clone(), camera: self.file_camera.clone() };
        source::open(scene, speed, &choice, self.animation_rate, |view| {
            set_lens(view);
            view.fov_deg = self.fov.or(view.fov_deg);
            view.size = self.size.unwrap_or(view.size);
        })
    }
}

impl ColorFlag {
    pub fn coloring(self) -> Coloring {
        match self {
            Self::Geometry => Coloring::Geometry,
            Self::Doppler => Coloring::Doppler,
        }
    }
}
