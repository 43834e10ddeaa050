//! How bright a scene is to be shown.

use crate::color::Coloring;
use crate::film::Film;
use crate::render::{Options, Raster, RenderError, render_again};
use crate::scene::{Camera, Scene};
use crate::tone::{Development, Tone};

/// How an exposure is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exposure {
    /// This EV: light times two to its power.
    Fixed(f32),
    /// What [metering](Tone::metered) says of the same views as they would be without shifts and beaming.
    Rest,
    /// What metering says of the picture; of a film, of some of its frames together, so that nothing flickers.
    Auto,
}

/// Frames of a film that are metered, at most.
const METERED: usize = 9;

/// Pixels across of pictures that are drawn only to be metered, at most.
const ACROSS: u32 = 200;

impl Exposure {
    /// Brightness that goes with the shift needs metering, and so does that of lights; surfaces' own colours are as they
    /// are.
    pub fn usual(coloring: Coloring, scene: &Scene) -> Self {
        let lit = coloring == Coloring::Geometry && !scene.lights.is_empty();
        if coloring.is_beamed() || lit { Self::Auto } else { Self::Fixed(0.0) }
    }

    /// For a picture that is there.
    ///
    /// # Errors
    /// If the scene cannot be drawn without shifts.
    pub fn of_picture(
        self,
        tone: Tone,
        scene: &Scene,
        camera: &Camera,
        options: &Options,
        film: &Film,
    ) -> Result<Development, RenderError> {
        match self {
            Self::Auto => Ok(Development { ev: tone.metered(film.color.iter().copied()), tone }),
            _ => self.of_film(tone, scene, std::slice::from_ref(camera), options),
        }
    }

    /// For a film of all these frames.
    ///
    /// # Errors
    /// If a frame cannot be drawn.
    pub fn of_film(
        self,
        tone: Tone,
        scene: &Scene,
        cameras: &[Camera],
        options: &Options,
    ) -> Result<Development, RenderError> {
        let coloring = match self {
            Self::Fixed(ev) => return Ok(Development { ev, tone }),
            Self::Rest => Coloring::Geometry,
            Self::Auto => options.coloring,
        };
        // Outlines matter less than the time; paths need a few to be near the truth.
        let samples = if options.paths.bounces > 0 { 8 } else { 1 };
        // So few pixels are the CPU's, unless another is asked for.
        let raster = if options.raster == Raster::Auto { Raster::Cpu } else { options.raster };
        let tolerance = options.tolerance.max(1.0);
        let options = Options { coloring, samples, tolerance, raster, ..options.clone() };
        let count = cameras.len().min(METERED);
        let place = |i: usize| if count > 1 { i * (cameras.len() - 1) / (count - 1) } else { 0 };
        let prepared = options.prepare(scene, cameras)?;
        let (mut film, mut light) = (Film::new(0, 0), Vec::new());
        for camera in (0..count).map(|i| &cameras[place(i)]) {
            let camera = Camera { lens: camera.lens.within(ACROSS), ..*camera };
            render_again(scene, &camera, &options, &prepared, &mut film, |_| ())?;
            light.extend(film.color.iter().copied());
        }
        Ok(Development { ev: tone.metered(light), tone })
    }
}
