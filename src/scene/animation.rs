use super::{Body, Camera, CameraPath, Scene, View, ViewError};
use crate::relativity::ApparentMap;
use terrell_geodesic::Celerity;

/// How a scene is filmed.
#[derive(Clone, Debug, PartialEq)]
pub struct Animation {
    /// How many frames.
    pub frames: u32,
    /// Frames a second when shown.
    pub fps: f64,
    /// What frames are spread evenly over.
    pub pace: Pace,
    /// The camera's way, unless it moves uniformly.
    pub path: Option<CameraPath>,
}

/// What the frames of a film are spread evenly over, from the first to the last.
#[derive(Clone, Debug, PartialEq)]
pub enum Pace {
    /// The camera's own clock, which agrees with the world's at the event the scene gives.
    Clock([f64; 2]),
    /// Where a body's middle *appears* along its motion relative to the camera, from abreast: frame by frame the
    /// same at every speed.
    Apparent {
        /// Its name.
        body: String,
        /// Lengths beyond abreast; before it, if negative.
        range: [f64; 2],
    },
}

/// Why a scene cannot be filmed so.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AnimationError {
    /// A frame's camera.
    #[error(transparent)]
    View(#[from] ViewError),
    /// Not a number of frames.
    #[error("{0} frames are no film; there can be 1 to {MAX_FRAMES}")]
    Frames(u32),
    /// A path has its own pace.
    #[error("a camera path goes by the camera's clock; it cannot be paced by where a body appears")]
    PathByPosition,
    /// There is nothing to film.
    #[error("nothing moves, so there is nothing to film; give a velocity, or a camera path")]
    Still,
}

/// The most frames of a film.
pub const MAX_FRAMES: u32 = 1_000_000;

/// The speed at which things are filmed for comparison: so slow that nothing of relativity is left (D differs from 1
/// by a millionth).
pub const STANDARD_BETA: f64 = 1e-6;

impl Animation {
    /// The usual film of a scene: its first moving body (its first body, if the camera moves) from where it
    /// appears one picture's width before abreast to one behind, in 120 frames.
    ///
    /// # Errors
    /// If nothing moves.
    pub fn usual(scene: &Scene) -> Result<Self, AnimationError> {
        let camera = scene.still_camera()?;
        let body = scene.followed().ok_or(AnimationError::Still)?;
        // What is as far away as the body when nearest fills the picture's width.
        let map = ApparentMap::new(&body.motion, &camera.observer);
        let at = map.see(body.centre()).position;
        let across = (at - at.dot(map.axis_observer()) * map.axis_observer()).length();
        let (low, high) = body.mesh.bounds().unwrap_or_default();
        let lens = &camera.lens;
        let half = (0.5 * f64::from(lens.width()) / lens.focal().x).min(3.0);
        let way = across * half + (high - low).length();
        let pace = Pace::Apparent { body: body.name.clone(), range: [-way, way] };
        Ok(Self { frames: 120, fps: 30.0, pace, path: None })
    }

    /// The camera of every frame.
    ///
    /// # Errors
    /// If there are no frames or too many, the body does not exist or does not move relative to the camera, or
    /// a view is none.
    pub fn cameras(&self, scene: &Scene) -> Result<Vec<Camera>, AnimationError> {
        if !(1..=MAX_FRAMES).contains(&self.frames) {
            return Err(AnimationError::Frames(self.frames));
        }
        if let Pace::Apparent { .. } = self.pace
            && self.path.is_some()
        {
            return Err(AnimationError::PathByPosition);
        }
        let last = f64::from(self.frames - 1).max(1.0);
        let spread = |[from, to]: [f64; 2], i: u32| from + (to - from) * (f64::from(i) / last);
        let frame = |i: u32| {
            Ok(match &self.pace {
                Pace::Clock(range) => {
                    let clock = spread(*range, i);
                    let view = match &self.path {
                        Some(path) => path.view(&scene.view, clock),
                        None => scene.view.at_clock(clock)?,
                    };
                    view.camera(&scene.bodies)?
                }
                Pace::Apparent { body, range } => {
                    let view = View { nearest: Some(body.clone()), ..scene.view.clone() };
                    view.camera_passed(&scene.bodies, spread(*range, i))?
                }
            })
        };
        (0..self.frames).map(frame).collect()
    }
}

impl Scene {
    /// The body whose passing is filmed: the first that moves; if none does but the camera, the first.
    pub fn followed(&self) -> Option<&Body> {
        let moves = |c: &Celerity| c.direction().is_some();
        let body = self.bodies.iter().find(|b| moves(&b.motion.celerity));
        body.or_else(|| self.bodies.first().filter(|_| moves(&self.view.celerity)))
    }

    /// The camera at the event the scene gives, whatever moment is asked for.
    fn still_camera(&self) -> Result<Camera, ViewError> {
        View { nearest: None, ..self.view.clone() }.camera(&self.bodies)
    }

    /// The same scene in slow motion, as it was thought to look before 1905: every velocity smaller by the same
    /// factor, so that the fastest is [`STANDARD_BETA`].
    pub fn standard(&self) -> Self {
        let mut slow = self.clone();
        let celerities = slow.bodies.iter_mut().map(|b| &mut b.motion.celerity);
        let mut celerities: Vec<_> = celerities.chain([&mut slow.view.celerity]).collect();
        let fastest = celerities.iter().map(|c| c.beta().length()).fold(0.0, f64::max);
        if fastest > 0.0 {
            for celerity in &mut celerities {
                **celerity = Celerity::from_beta(celerity.beta() * (STANDARD_BETA / fastest))
                    .unwrap_or(Celerity::at_rest());
            }
        }
        slow
    }

    /// The camera of the [standard](Self::standard) film of this scene that sees the followed body where
    /// `camera` sees it.
    ///
    /// # Errors
    /// If the view is none.
    pub fn standard_camera(&self, standard: &Self, camera: &Camera) -> Result<Camera, ViewError> {
        let Some(body) = self.followed() else { return standard.still_camera() };
        let map = ApparentMap::new(&body.motion, &camera.observer);
        let passed = map.see(body.centre()).position.dot(map.axis_observer());
        let view = View { nearest: Some(body.name.clone()), ..standard.view.clone() };
        view.camera_passed(&standard.bodies, passed)
    }
}
