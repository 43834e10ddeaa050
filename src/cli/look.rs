use super::Fault;
use super::source;
use super::values::{count, number, size, when};
use super::velocity::VelocityFlags;
use clap::{Args, ValueEnum};
use terrell::color::Coloring;
use terrell::exposure::Exposure;
use terrell::light::DopplerAt;
use terrell::plan::{Method, USUAL_BOUNCES, USUAL_PATHS, cheapest, has_reflections};
use terrell::render::{Options, Raster};
use terrell::scene::{Choice, Projection, Scene, Speed, View};
use terrell::tone::Tone;
use terrell::trace::Paths;

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

/// When a picture is taken.
#[derive(Args)]
pub struct MomentFlags {
    /// World time of the picture; a moving camera goes along its world line
    #[arg(long, value_name = "T", value_parser = number, conflicts_with = "when")]
    time: Option<f64>,
    /// Take the picture when a body appears abreast: "nearest BODY"
    #[arg(long, value_name = "\"nearest BODY\"", value_parser = when)]
    when: Option<String>,
}

impl MomentFlags {
    /// Sets a scene's camera to the moment asked for.
    pub fn set(&self, scene: &mut Scene) -> Result<(), Fault> {
        source::set_moment(scene, self.time, self.when.as_deref())
    }
}

/// How a scene is looked at: what pictures and films have in common.
#[derive(Args)]
pub struct LookFlags {
    #[command(flatten)]
    pub scene: SceneFlags,
    /// Projection
    #[arg(long, value_enum)]
    camera: Option<CameraFlag>,
    /// Largest distance between a drawn edge and its exact image, where triangles are cut: asks for --method apparent. Cost
    /// grows as 1/√ for edges, 1/ for faces [default: 0.25]
    #[arg(long, value_name = "PX", value_parser = number)]
    tolerance: Option<f64>,
    /// Samples a pixel [default: 1, or 64 where paths are traced]
    #[arg(long, value_name = "N", value_parser = count)]
    samples: Option<u32>,
    /// How many reflections from surface to surface are followed, where rays are traced [default: 4 where there are
    /// mirrors, or surfaces that others light, else 0]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=64))]
    bounces: Option<u32>,
    /// Which chance decides where reflected rays go
    #[arg(long, value_name = "N", default_value = "0")]
    seed: u64,
    /// What a pixel shows [default: spectral; geometry with --detectors]
    #[arg(long, value_enum)]
    color: Option<ColorFlag>,
    /// Where the Doppler factor is worked out
    #[arg(long, value_name = "WHERE", value_enum, default_value = "pixel")]
    doppler: DopplerFlag,
    #[command(flatten)]
    pub develop: DevelopFlags,
    /// How what a pixel sees is found
    #[arg(long, value_enum, default_value = "auto")]
    method: MethodFlag,
    /// What decides which triangle a pixel sees
    #[arg(long, value_enum, default_value = "auto")]
    raster: RasterFlag,
}

/// How light becomes a picture.
#[derive(Args)]
#[command(next_help_heading = "Brightness")]
pub struct DevelopFlags {
    /// EV (light times two to its power), auto, rest, or for films each [default: auto where brightness goes with the
    /// shift or there are lights, else 0]
    ///
    /// auto makes all of a picture but one in twenty of its points darker than white; of a film, of frames from all of
    /// it together, so that nothing flickers. each meters every frame of a film by itself. rest is auto for the same view
    /// without shifts and beaming. EXR files have the light as it is.
    #[arg(long, value_name = "EV|auto|rest|each", value_parser = exposure)]
    exposure: Option<ExposureFlag>,
    /// Curve from light to what is shown [default: filmic where brightness goes with the shift, else linear]
    #[arg(long, value_enum)]
    tone: Option<ToneFlag>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum ExposureFlag {
    Chosen(Exposure),
    Each,
}

fn exposure(text: &str) -> Result<ExposureFlag, String> {
    Ok(match text.trim() {
        "auto" => ExposureFlag::Chosen(Exposure::Auto),
        "rest" => ExposureFlag::Chosen(Exposure::Rest),
        "each" => ExposureFlag::Each,
        number => {
            let ev = self::number(number).ok().filter(|ev| ev.abs() <= 100.0);
            let ev = ev.ok_or_else(|| {
                format!("'{number}' is no EV between -100 and 100, and not auto, rest or each")
            })?;
            ExposureFlag::Chosen(Exposure::Fixed(ev as f32))
        }
    })
}

#[derive(Clone, Copy, ValueEnum)]
enum ToneFlag {
    /// As it is, clipped at white
    Linear,
    /// As film: soft shoulders, the brightest colours turn white
    Filmic,
    /// By the logarithm, twelve octaves
    Log,
}

impl DevelopFlags {
    /// How the exposure is chosen.
    pub fn exposure(&self, coloring: Coloring, scene: &Scene) -> Exposure {
        match self.exposure {
            Some(ExposureFlag::Chosen(exposure)) => exposure,
            Some(ExposureFlag::Each) => Exposure::Auto,
            None => Exposure::usual(coloring, scene),
        }
    }

    /// Whether every frame of a film is metered by itself.
    pub fn is_each(&self) -> bool {
        self.exposure == Some(ExposureFlag::Each)
    }

    /// The curve.
    pub fn tone(&self, coloring: Coloring) -> Tone {
        match self.tone {
            Some(ToneFlag::Linear) => Tone::Linear,
            Some(ToneFlag::Filmic) => Tone::Filmic,
            Some(ToneFlag::Log) => Tone::Log,
            None if coloring.is_beamed() => Tone::Filmic,
            None => Tone::Linear,
        }
    }
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum MethodFlag {
    /// The cheapest that is right for the scene
    Auto,
    /// Every triangle tested where it may be seen, exactly: with shadows, before the sky, in flat spacetime
    Exact,
    /// Polygons, moved to where they are seen, to a tolerance: without shadows, in flat spacetime
    Apparent,
    /// Rays, followed back in time: with shadows, before the sky, past black holes
    Trace,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum DopplerFlag {
    /// Exactly, in every pixel
    Pixel,
    /// At the vertices drawn, interpolated between, as in Nollert et al. 2000
    Vertex,
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
    /// What the eye sees: spectra shifted and beamed
    Spectral,
    /// Every spectrum taken for flat: colours stay, brightness goes with D³
    Flat,
    /// Radiance over all wavelengths, grey: D⁴
    Bolometric,
    /// Surfaces' own colours, without shift and beaming
    Geometry,
    /// The Doppler factor in false colour: white 1, blue above, red below
    Doppler,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum RasterFlag {
    /// A graphics processor if there is one, it can draw the scene, and there is much to draw; else the CPU
    Auto,
    /// The CPU: exact
    Cpu,
    /// Triangles painted back to front by tiny-skia (--method apparent): wrong where they pass through each other
    Skia,
    /// A graphics processor, a software one if there is no other: what shines by itself, to single precision
    Wgpu,
}

impl LookFlags {
    /// The scene at the moment asked for, with what the flags say over what it says itself.
    pub fn open(&self, scene: &str, moment: &MomentFlags) -> Result<Scene, Fault> {
        let mut scene = self.scene.open(scene, self.scene.velocity.speed()?, |view| self.set_lens(view))?;
        moment.set(&mut scene)?;
        Ok(scene)
    }

    pub fn options(&self) -> Result<Options, Fault> {
        let usual = Options::default();
        let tolerance = self.tolerance.unwrap_or(usual.tolerance);
        if tolerance <= 0.0 {
            return Err(format!("--tolerance {tolerance} is not above 0 px").into());
        }
        Ok(Options {
            tolerance,
            samples: self.samples.unwrap_or(1),
            coloring: self.color.map_or(usual.coloring, ColorFlag::coloring),
            doppler_at: match self.doppler {
                DopplerFlag::Pixel => DopplerAt::Pixel,
                DopplerFlag::Vertex => DopplerAt::Vertex,
            },
            raster: match self.raster {
                RasterFlag::Auto => Raster::Auto,
                RasterFlag::Cpu => Raster::Cpu,
                RasterFlag::Skia => Raster::Skia,
                RasterFlag::Wgpu => Raster::Wgpu,
            },
            ..usual
        })
    }

    /// Chooses the method for a scene; why, if it was not asked for.
    pub fn choose(&self, options: &mut Options, scene: &Scene) -> Result<Option<&'static str>, Fault> {
        // What only polygons have.
        let of_polygons = if self.raster == RasterFlag::Skia {
            Some("--raster skia")
        } else if self.tolerance.is_some() {
            Some("--tolerance")
        } else if self.doppler == DopplerFlag::Vertex {
            Some("--doppler vertex")
        } else {
            None
        };
        let (method, why) = match (self.method, of_polygons) {
            (MethodFlag::Apparent, _) | (MethodFlag::Auto, Some(_)) => (Method::Apparent, None),
            (MethodFlag::Trace, Some(flag)) => {
                return Err(format!("{flag} is about polygons; rays (--method trace) have none").into());
            }
            (MethodFlag::Exact, Some(flag)) => {
                return Err(format!("{flag} is about polygons that are cut; --method exact cuts none").into());
            }
            (MethodFlag::Trace, None) => (Method::Trace, None),
            (MethodFlag::Exact, None) => (Method::Exact, None),
            (MethodFlag::Auto, None) if self.bounces.is_some_and(|n| n > 0) => (Method::Trace, None),
            (MethodFlag::Auto, None) => {
                let (method, why) = cheapest(scene, options.coloring);
                (method, Some(why))
            }
        };
        if scene.spacetime.is_curved() && method != Method::Trace {
            let flag = of_polygons.map_or_else(|| format!("--method {method}"), str::to_owned);
            let why =
                "is for flat spacetime; in curved spacetime only rays show what is seen, so leave it out";
            return Err(format!("{flag} {why}").into());
        }
        if method == Method::Trace && self.raster == RasterFlag::Wgpu {
            let why = why.map_or_else(String::new, |why| format!(", which this scene needs: {why}"));
            return Err(format!("--raster wgpu is for shading; rays are traced on the CPU{why}").into());
        }
        scene.check_spacetime()?;
        if scene.spacetime.is_curved() && self.bounces.is_some_and(|n| n > 0) {
            return Err("--bounces is for flat spacetime; in curved spacetime surfaces do not light each other, so leave it out".into());
        }
        options.method = method;
        match method {
            Method::Trace => self.set_paths(options, scene),
            Method::Exact | Method::Apparent if self.bounces.is_some_and(|n| n > 0) => {
                let flag = of_polygons.map_or_else(|| format!("--method {method}"), str::to_owned);
                return Err(
                    format!("--bounces is about rays; with {flag} surfaces do not light each other").into()
                );
            }
            Method::Exact | Method::Apparent => {}
        }
        Ok(why)
    }

    /// How paths are traced in a scene, and how many.
    pub fn set_paths(&self, options: &mut Options, scene: &Scene) {
        let usual = if has_reflections(scene) { USUAL_BOUNCES } else { 0 };
        options.paths = Paths { bounces: self.bounces.unwrap_or(usual), seed: self.seed };
        let usual = if options.paths.bounces > 0 { USUAL_PATHS } else { 1 };
        options.samples = self.samples.unwrap_or(usual);
    }

    /// For shapes seen from aside, by a lens of their own: their colouring, and that no lens is asked for.
    pub fn coloring_of_shapes(&self) -> Result<Coloring, Fault> {
        if self.camera.is_some() {
            return Err("--detectors draws shapes by a pinhole; leave out --camera".into());
        }
        Ok(self.color.map_or(Coloring::Geometry, ColorFlag::coloring))
    }

    /// For what draws by several methods: that none of them is asked for.
    pub fn check_no_method(&self) -> Result<(), Fault> {
        if self.method != MethodFlag::Auto || self.raster != RasterFlag::Auto {
            return Err("--method and --raster choose one way to draw, and here all are compared; --methods says which of them".into());
        }
        Ok(())
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
                if projection == Projection::Panorama {
                    // As wide as before, and a degree as long across as down.
                    view.size[1] = view.size[0].div_ceil(2);
                }
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
            Self::Spectral => Coloring::Spectral,
            Self::Flat => Coloring::Flat,
            Self::Bolometric => Coloring::Bolometric,
            Self::Geometry => Coloring::Geometry,
            Self::Doppler => Coloring::Doppler,
        }
    }
}
