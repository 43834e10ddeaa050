use crate::color::Coloring;
use crate::detectors;
use crate::exposure::Exposure;
use crate::figure::Figure;
use crate::film::Film;
use crate::measure::SweepError;
use crate::picture::{Movie, MovieError, MovieFormat, pixels_srgb, write_png_pixels};
use crate::plan::{Method, cheapest};
use crate::render::{Options, RenderError, render_again};
use crate::scene::{AnimationError, Camera, LensError, NoSuchScene, Scene, SceneError, ViewError};
use crate::tone::Tone;
use crate::transform::TransformError;
use std::fmt::{Debug, Formatter};
use std::rc::Rc;
use terrell_geodesic::{CelerityError, DistantCameraError, KerrError, TetradError};

/// Something to see, not drawn yet.
#[derive(Debug)]
pub struct Plate {
    /// Of its files, without ending.
    pub name: String,
    /// What it shows.
    pub caption: String,
    /// How it is made.
    pub what: What,
}

/// How something to see is made.
#[derive(Debug)]
pub enum What {
    /// A picture of a scene.
    Shot(Box<Shot>),
    /// A figure.
    Figure(Box<Figure>),
    /// A film.
    Reel(Reel),
}

/// A scene and how it is photographed.
#[derive(Clone, Debug)]
pub struct Shot {
    /// What is there, its view's moment included.
    pub scene: Scene,
    /// What a pixel shows.
    pub coloring: Coloring,
    /// How bright; if not said, as is usual.
    pub exposure: Option<Exposure>,
    /// The curve from light to what is shown; if not said, as is usual.
    pub tone: Option<Tone>,
    /// How what a pixel sees is found; if not said, by the cheapest way that is right.
    pub method: Option<Method>,
    /// Samples a pixel.
    pub samples: u32,
}

/// Frames one after the other.
pub struct Reel {
    /// How many there are.
    pub frames: usize,
    /// How many are shown in a second.
    pub fps: f64,
    /// Makes all that is the same for all of them, and then what draws them.
    pub open: Box<dyn Fn() -> Result<Box<Frame>, TeachError>>,
}

/// Draws the frame of a number: width, height, and three bytes of sRGB a pixel.
pub type Frame = dyn Fn(usize) -> Result<Pixels, TeachError>;

/// Width, height, and three bytes of sRGB a pixel.
pub type Pixels = (u32, u32, Vec<u8>);

/// A file to be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Drawn {
    /// Of what kind it is.
    pub kind: Kind,
    /// What it holds.
    pub bytes: Vec<u8>,
}

/// Kinds of files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A picture.
    Png,
    /// A figure of lines and letters.
    Svg,
    /// A film.
    Mp4,
}

/// Why a lesson's picture could not be made.
#[derive(Debug, thiserror::Error)]
pub enum TeachError {
    /// A scene that could not be drawn.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// A camera that cannot be.
    #[error(transparent)]
    View(#[from] ViewError),
    /// A scene that is none.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A scene that does not ship.
    #[error(transparent)]
    NoSuchScene(#[from] NoSuchScene),
    /// A velocity that cannot be.
    #[error(transparent)]
    Celerity(#[from] CelerityError),
    /// A lens that cannot be.
    #[error(transparent)]
    Lens(#[from] LensError),
    /// A black hole that cannot be.
    #[error(transparent)]
    Kerr(#[from] KerrError),
    /// A ray of a distant camera that cannot be.
    #[error(transparent)]
    DistantCamera(#[from] DistantCameraError),
    /// Axes that cannot be.
    #[error(transparent)]
    Tetrad(#[from] TetradError),
    /// A film that cannot be.
    #[error(transparent)]
    Animation(#[from] AnimationError),
    /// A film that could not be written.
    #[error(transparent)]
    Movie(#[from] MovieError),
    /// A picture that could not be written.
    #[error(transparent)]
    Io(#[from] std::io::Error),
    /// Ways to draw that could not be compared.
    #[error(transparent)]
    Sweep(#[from] SweepError),
    /// Shapes that could not be had.
    #[error(transparent)]
    Transform(#[from] TransformError),
    /// A page without room.
    #[error("a page of no size")]
    Empty,
}

impl Kind {
    /// The ending of a file's name.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Svg => "svg",
            Self::Mp4 => "mp4",
        }
    }

    /// What it is to a browser.
    pub(super) fn media_type(self) -> &'static str {
        match self {
            Self::Png => "image/png",
            Self::Svg => "image/svg+xml",
            Self::Mp4 => "video/mp4",
        }
    }
}

impl Plate {
    pub(super) fn shot(name: &str, caption: impl Into<String>, shot: Shot) -> Self {
        Self { name: name.into(), caption: caption.into(), what: What::Shot(Box::new(shot)) }
    }

    pub(super) fn figure(name: &str, caption: impl Into<String>, figure: Figure) -> Self {
        Self { name: name.into(), caption: caption.into(), what: What::Figure(Box::new(figure)) }
    }

    pub(super) fn reel(name: &str, caption: impl Into<String>, reel: Reel) -> Self {
        Self { name: name.into(), caption: caption.into(), what: What::Reel(reel) }
    }

    /// Makes its files, the one to be shown on pages first.
    ///
    /// # Errors
    /// If it cannot be drawn.
    pub fn draw(&self) -> Result<Vec<Drawn>, TeachError> {
        Ok(match &self.what {
            What::Shot(shot) => vec![png(shot.pixels()?)?],
            What::Figure(figure) => {
                let page = figure.page();
                let bytes = page.png(2.0).ok_or(TeachError::Empty)?;
                vec![
                    Drawn { kind: Kind::Svg, bytes: page.svg().into_bytes() },
                    Drawn { kind: Kind::Png, bytes },
                ]
            }
            What::Reel(reel) => reel.film()?,
        })
    }
}

fn png((width, height, pixels): Pixels) -> Result<Drawn, TeachError> {
    let mut bytes = Vec::new();
    write_png_pixels(width, height, &pixels, &mut bytes)?;
    Ok(Drawn { kind: Kind::Png, bytes })
}

/// Pixels across and down of a lesson's pictures.
const SIZE: [u32; 2] = [640, 360];

impl Shot {
    /// Of a scene's shapes, by the colours surfaces have.
    pub fn new(mut scene: Scene) -> Self {
        scene.view.size = SIZE;
        let (exposure, tone, method) = Default::default();
        Self { scene, coloring: Coloring::Geometry, exposure, tone, method, samples: 4 }
    }

    /// The same with another coloring.
    pub fn colored(self, coloring: Coloring) -> Self {
        Self { coloring, ..self }
    }

    /// The shapes seen, as detectors of the camera's frame have them, from aside.
    pub fn from_aside(mut self) -> Result<Self, TeachError> {
        let camera = self.scene.camera()?;
        self.scene = detectors::seen_from(&self.scene, &camera, None, self.coloring, None)?;
        self.coloring = Coloring::Geometry;
        Ok(self)
    }

    fn options(&self) -> Options {
        let method = self.method.unwrap_or_else(|| cheapest(&self.scene, self.coloring).0);
        Options { method, coloring: self.coloring, samples: self.samples, ..Options::default() }
    }

    fn tone(&self) -> Tone {
        self.tone.unwrap_or(if self.coloring.is_beamed() { Tone::Filmic } else { Tone::Linear })
    }

    fn exposure(&self) -> Exposure {
        self.exposure.unwrap_or_else(|| Exposure::usual(self.coloring, &self.scene))
    }

    /// Draws it.
    ///
    /// # Errors
    /// If its scene cannot be drawn.
    pub fn pixels(&self) -> Result<Pixels, TeachError> {
        let camera = self.scene.camera()?;
        let frames = self.frames(vec![camera])?;
        frames(0)
    }

    /// As a film of the scene's own animation, or of the usual one, in so many frames.
    ///
    /// # Errors
    /// If there is no such film.
    pub fn reel(mut self, frames: u32, fps: f64) -> Result<Reel, TeachError> {
        let mut animation = match self.scene.animation.take() {
            Some(animation) => animation,
            None => crate::scene::Animation::usual(&self.scene)?,
        };
        animation.frames = frames;
        let cameras = animation.cameras(&self.scene)?;
        let open = move || Ok::<Box<Frame>, _>(Box::new(self.frames(cameras.clone())?));
        Ok(Reel { frames: frames as usize, fps, open: Box::new(open) })
    }

    /// What draws the pictures of these cameras, at one exposure.
    fn frames(
        &self,
        cameras: Vec<Camera>,
    ) -> Result<impl Fn(usize) -> Result<Pixels, TeachError> + use<>, TeachError> {
        let options = self.options();
        let shot = self.clone();
        let prepared = options.prepare(&shot.scene, &cameras)?;
        let development = self.exposure().of_film(self.tone(), &self.scene, &cameras, &options)?;
        Ok(move |i: usize| {
            let mut film = Film::new(0, 0);
            render_again(&shot.scene, &cameras[i], &options, &prepared, &mut film, |_| ())?;
            let pixels = pixels_srgb(&film, &development);
            Ok((film.width, film.height, pixels))
        })
    }
}

impl Reel {
    /// Of figures, drawn frame by frame.
    pub(super) fn of_figures(frames: usize, fps: f64, figure: impl Fn(usize) -> Figure + 'static) -> Self {
        let figure = Rc::new(figure);
        let open = move || {
            let figure = figure.clone();
            let frame = move |i: usize| figure(i).page().pixels(1.0).ok_or(TeachError::Empty);
            Ok::<Box<Frame>, _>(Box::new(frame))
        };
        Self { frames, fps, open: Box::new(open) }
    }

    /// The film, as MP4, and the frame in its middle, to stand for it.
    fn film(&self) -> Result<Vec<Drawn>, TeachError> {
        let frame = (self.open)()?;
        let mut poster = frame(0)?;
        let to = std::io::Cursor::new(Vec::new());
        let mut movie = Movie::new(MovieFormat::Mp4, to, poster.0, poster.1, self.fps)?;
        movie.push(&poster.2)?;
        for i in 1..self.frames {
            let pixels = frame(i)?;
            movie.push(&pixels.2)?;
            if i == self.frames / 2 {
                poster = pixels;
            }
        }
        Ok(vec![Drawn { kind: Kind::Mp4, bytes: movie.finish()?.into_inner() }, png(poster)?])
    }
}

impl Debug for Reel {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Reel").field("frames", &self.frames).field("fps", &self.fps).finish_non_exhaustive()
    }
}
