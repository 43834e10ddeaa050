use std::time::{Duration, Instant};
use terrell::film::Film;
use terrell::light::DopplerAt;
use terrell::measure::Times;
use terrell::plan::Method;
use terrell::render::{Options, Raster, RenderError, Report, render_again};
use terrell::scene::{Camera, Scene};

/// A way to draw a scene.
pub struct Way {
    /// What it is called, files of it among others.
    pub name: &'static str,
    /// What it is.
    pub about: &'static str,
    /// The options, of which all else stays.
    set: fn(Options) -> Options,
}

/// All there are; the first is what the others are compared with.
pub const WAYS: &[Way] = &[
    // Rays have no vertices to work anything out at.
    Way {
        name: "trace",
        about: "ray tracing",
        set: |o| Options { method: Method::Trace, raster: Raster::Cpu, doppler_at: DopplerAt::Pixel, ..o },
    },
    Way {
        name: "exact",
        about: "exact shading",
        set: |o| Options { method: Method::Exact, raster: Raster::Cpu, doppler_at: DopplerAt::Pixel, ..o },
    },
    Way {
        name: "apparent",
        about: "apparent shading, z-buffer",
        set: |o| Options { method: Method::Apparent, raster: Raster::Cpu, ..o },
    },
    Way {
        name: "painter",
        about: "apparent shading, painter",
        set: |o| Options { method: Method::Apparent, raster: Raster::Skia, ..o },
    },
];

/// What a way made of a scene, and the median times it took.
pub struct Drawn {
    pub film: Film,
    pub report: Report,
    /// What is done once a scene.
    pub once: Duration,
    /// What is done for every picture.
    pub picture: Duration,
}

impl Way {
    /// By its name.
    pub fn named(name: &str) -> Result<&'static Self, String> {
        WAYS.iter().find(|way| way.name == name.trim()).ok_or_else(|| {
            let names: Vec<&str> = WAYS.iter().map(|way| way.name).collect();
            format!("'{}' is no method; there is {}", name.trim(), names.join(", "))
        })
    }

    /// The options it draws with.
    pub fn options(&self, options: &Options) -> Options {
        (self.set)(options.clone())
    }

    /// Draws a scene so many times; `begin` hears of each.
    pub fn draw(
        &self,
        scene: &Scene,
        camera: &Camera,
        options: &Options,
        repeats: u32,
        mut begin: impl FnMut(u32),
    ) -> Result<Drawn, RenderError> {
        let options = self.options(options);
        let (mut film, mut report) = (Film::new(0, 0), Report::default());
        let (mut once, mut picture) = (Vec::new(), Vec::new());
        for run in 0..repeats {
            begin(run);
            let start = Instant::now();
            let prepared = options.prepare(scene, [camera])?;
            once.push(start.elapsed());
            let start = Instant::now();
            report = render_again(scene, camera, &options, &prepared, &mut film, |_| ())?;
            picture.push(start.elapsed());
        }
        Ok(Drawn { film, report, once: Times::new(once).median(), picture: Times::new(picture).median() })
    }
}
