use super::{Body, Camera, CameraPath, Scene, View, ViewError};
use crate::relativity::ApparentMap;
use std::sync::Arc;
use terrell_geodesic::{Celerity, Event, World};

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
    #[error(
        "nothing moves, so there is nothing to film; give a velocity, a camera path, or a time from and to"
    )]
    Still,
}

/// The most frames of a film.
pub const MAX_FRAMES: u32 = 1_000_000;

/// The speed at which things are filmed for comparison: so slow that nothing of relativity is left (D differs from 1
/// by a millionth).
pub const STANDARD_BETA: f64 = 1e-6;

impl Animation {
    /// The usual film of a scene: its first moving body (its first body, if the camera moves) from where it
    /// appears one picture's width before abreast to one behind; if nothing moves but within itself, the longest
    /// clip once. In 120 frames.
    ///
    /// # Errors
    /// If nothing moves.
    pub fn usual(scene: &Scene) -> Result<Self, AnimationError> {
        let camera = scene.still_camera()?;
        let Some(body) = scene.followed() else {
            let clips = scene.bodies.iter().filter_map(|b| b.clip.as_ref());
            let lengths =
                clips.map(|clip| clip.period / clip.rate.abs()).filter(|t| t.is_finite() && *t > 0.0);
            let longest = lengths.reduce(f64::max).ok_or(AnimationError::Still)?;
            let start = scene.view.event.t();
            return Ok(Self {
                frames: 120,
                fps: 30.0,
                pace: Pace::Clock([start, start + longest]),
                path: None,
            });
        };
        // What is as far away as the body when nearest fills the picture's width.
        let map = ApparentMap::new(&body.motion, &camera.observer);
        let at = map.see(body.centre()).position;
        let across = (at - at.dot(map.axis_observer()) * map.axis_observer()).length();
        let (low, high) = body.mesh.bounds().unwrap_or_default();
        let lens = &camera.lens;
        let half = (0.5 * f64::from(lens.width()) / lens.focal().x).min(3.0);
        let way = across * half + 0.5 * (high - low).length();
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
        (0..self.frames).map(|i| self.camera(scene, scene, 1.0, i)).collect()
    }

    /// The same film in slow motion, as it was thought to look before 1905, and the camera of every frame: where bodies are at the
    /// same places, if frames go by the clock; where the body followed is seen at the same places, if they go by
    /// these.
    ///
    /// # Errors
    /// As [`cameras`](Self::cameras).
    pub fn standard(&self, scene: &Scene) -> Result<(Scene, Vec<Camera>), AnimationError> {
        let fastest = self.path.as_ref().map_or(0.0, CameraPath::greatest_speed);
        let (slow, factor) = scene.standard(fastest);
        let cameras =
            (0..self.frames).map(|i| self.camera(scene, &slow, factor, i)).collect::<Result<_, _>>()?;
        Ok((slow, cameras))
    }

    /// The camera of a frame in `slow`, which is the scene slower by a factor.
    fn camera(&self, scene: &Scene, slow: &Scene, factor: f64, i: u32) -> Result<Camera, AnimationError> {
        let last = f64::from(self.frames - 1).max(1.0);
        let spread = |[from, to]: [f64; 2]| from + (to - from) * (f64::from(i) / last);
        Ok(match &self.pace {
            Pace::Clock(range) => {
                let clock = spread(*range);
                let mut view = match &self.path {
                    Some(path) => path.view(&scene.view, clock),
                    None => scene.view.at_clock(clock)?,
                };
                if factor != 1.0 {
                    slow_down(&mut view.celerity, &mut view.event, factor);
                }
                view.camera(&slow.bodies)?
            }
            Pace::Apparent { body, range } => {
                let view = View { nearest: Some(body.clone()), ..slow.view.clone() };
                view.camera_passed(&slow.bodies, spread(*range))?
            }
        })
    }
}

impl Scene {
    /// The body whose passing is filmed: the first that moves; if none does but the camera, the first.
    pub fn followed(&self) -> Option<&Body> {
        let body = self.bodies.iter().find(|b| b.motion.celerity.moves());
        body.or_else(|| self.bodies.first().filter(|_| self.view.celerity.moves()))
    }

    /// The camera at the event the scene gives, whatever moment is asked for.
    fn still_camera(&self) -> Result<Camera, ViewError> {
        View { nearest: None, ..self.view.clone() }.camera(&self.bodies)
    }

    /// The same scene in slow motion, as it was thought to look before 1905: all velocities smaller by the same
    /// factor, so that the fastest is [`STANDARD_BETA`], and all times longer by it. That factor, too. Of the fastest is
    /// also a camera on a path, whose greatest speed is `path`.
    fn standard(&self, path: f64) -> (Self, f64) {
        let mut slow = self.clone();
        let bodies = slow.bodies.iter().map(|b| &b.motion.celerity);
        let lights = slow.lights.iter().map(|l| &l.motion.celerity);
        let celerities = bodies.chain(lights).chain([&slow.view.celerity]);
        let fastest = celerities.map(|c| c.beta().length()).fold(path, f64::max);
        if fastest == 0.0 {
            return (slow, 1.0);
        }
        let factor = STANDARD_BETA / fastest;
        for body in &mut slow.bodies {
            slow_down(&mut body.motion.celerity, &mut body.motion.origin, factor);
            if let Some(clip) = &mut body.clip {
                Arc::make_mut(clip).rate *= factor;
            }
        }
        for light in &mut slow.lights {
            slow_down(&mut light.motion.celerity, &mut light.motion.origin, factor);
        }
        slow_down(&mut slow.view.celerity, &mut slow.view.event, factor);
        (slow, factor)
    }
}

fn slow_down(celerity: &mut Celerity, event: &mut Event<World>, factor: f64) {
    *celerity = Celerity::from_beta(celerity.beta() * factor).unwrap_or(Celerity::at_rest());
    *event = Event::at(event.t() / factor, event.position());
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Speed, builtin_scene};
    use glam::DVec3;

    fn scene(name: &str) -> Scene {
        builtin_scene(name).unwrap().scene()
    }

    fn seen(scene: &Scene, camera: &Camera) -> DVec3 {
        ApparentMap::new(&scene.bodies[0].motion, &camera.observer).see(scene.bodies[0].centre()).position
    }

    #[test]
    fn frames_at_all_speeds_see_the_body_at_the_same_places() {
        let mut cube = scene("cube");
        let animation = Animation { frames: 5, ..cube.animation.clone().unwrap() };
        let Pace::Apparent { range, .. } = animation.pace.clone() else { panic!() };
        for speed in [1e-6, 0.5, 7.0] {
            cube.set_speed(Speed::Along(speed)).unwrap();
            let (slow, standard) = animation.standard(&cube).unwrap();
            for (i, (camera, standard)) in animation.cameras(&cube).unwrap().iter().zip(&standard).enumerate()
            {
                let x = range[0] + (range[1] - range[0]) * i as f64 / 4.0;
                // Times of slow motion are 1e6 times as long, and have as many digits less.
                assert!((seen(&cube, camera) - DVec3::new(x, 0.0, 3.0)).length() < 1e-7, "{speed} {i}");
                assert!((seen(&slow, standard) - DVec3::new(x, 0.0, 3.0)).length() < 1e-7, "{speed} {i}");
            }
        }
    }

    #[test]
    fn by_the_clock_the_standard_is_at_the_same_places() {
        let gate = scene("gate");
        let animation = Animation { frames: 4, fps: 30.0, pace: Pace::Clock([-2.0, 1.0]), path: None };
        let cameras = animation.cameras(&gate).unwrap();
        let (_, standard) = animation.standard(&gate).unwrap();
        for (i, (camera, standard)) in cameras.iter().zip(&standard).enumerate() {
            let place = camera.observer.event().position();
            let u = gate.view.celerity.vector().x;
            assert!((place - DVec3::new(3.0 + u * (i as f64 - 2.0), 0.0, 4.0)).length() < 1e-9);
            assert!((standard.observer.event().position() - place).length() < 1e-6);
            assert!(standard.observer.celerity().beta().length() <= STANDARD_BETA);
        }
    }

    #[test]
    fn a_scene_without_a_film_of_its_own_has_one() {
        let mut cube = scene("cube");
        cube.animation = None;
        let usual = Animation::usual(&cube).unwrap();
        let cameras = usual.cameras(&cube).unwrap();
        // It comes in at one side and goes out at the other.
        for camera in [&cameras[0], &cameras[119]] {
            let pixel = camera.lens.pixel(seen(&cube, camera)).unwrap();
            assert!(pixel.x < 0.0 || pixel.x > 1280.0, "{pixel}");
        }
        cube.bodies[0].motion.celerity = Celerity::at_rest();
        assert_eq!(Animation::usual(&cube), Err(AnimationError::Still));
        let none = Animation { frames: 0, ..usual };
        assert_eq!(none.cameras(&cube).unwrap_err(), AnimationError::Frames(0));
    }
}
