use super::{Body, Camera, Lens, LensError, Projection, Stance};
use crate::relativity::{ApparentMap, Motion};
use glam::DVec3;
use terrell_geodesic::{Celerity, Event, Tetrad, TetradError, World};

/// The camera of a scene: its world line, what it looks at, and when.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// One event of its world line; the picture is taken here unless another moment is asked for.
    pub event: Event<World>,
    /// Its motion.
    pub celerity: Celerity,
    /// How it is there, in curved spacetime.
    pub stance: Stance,
    /// Where it looks.
    pub aim: Aim,
    /// What is up in the picture, in the camera's (unrotated) axes.
    pub up: DVec3,
    /// The lens.
    pub projection: Projection,
    /// Full field in degrees; none for the projection's usual one.
    pub fov_deg: Option<f64>,
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Name of the body that is to be seen abreast when the picture is taken.
    pub nearest: Option<String>,
}

/// Where a camera looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Aim {
    /// A direction in the camera's own frame, reached from the world's by a pure boost.
    Forward(DVec3),
    /// Where a point at rest in the world is seen (aberration included, if the camera moves).
    LookAt(DVec3),
}

/// Why there is no such view.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ViewError {
    /// The lens.
    #[error(transparent)]
    Lens(#[from] LensError),
    /// The axes.
    #[error("the camera cannot be set up: {0}")]
    Axes(#[from] TetradError),
    /// `look_at` is where the camera is.
    #[error("look_at is the camera's own position; it has no direction")]
    LooksAtItself,
    /// No body of that name.
    #[error("nearest {name}: there is no body of that name; there is {known}")]
    NoSuchBody {
        /// What was asked for.
        name: String,
        /// What there is.
        known: String,
    },
    /// The body does not move relative to the camera.
    #[error(
        "nearest {0}: that body and the camera are at rest relative to each other, so it is never seen to pass; give a velocity, or a time instead"
    )]
    NeverPasses(String),
    /// A time that is no number.
    #[error("the time {0} is not finite or beyond 1e100")]
    Time(f64),
}

impl Default for View {
    fn default() -> Self {
        Self {
            event: Event::origin(),
            celerity: Celerity::at_rest(),
            stance: Stance::Moving,
            aim: Aim::Forward(DVec3::Y),
            up: DVec3::Z,
            projection: Projection::Pinhole,
            fov_deg: None,
            size: [1280, 720],
            nearest: None,
        }
    }
}

impl View {
    /// Moves the camera along its world line to the world time `t`.
    ///
    /// # Errors
    /// If `t` is not finite, or so large that squares of it leave the range of f64.
    pub fn set_time(&mut self, t: f64) -> Result<(), ViewError> {
        if t.is_nan() || t.abs() >= 1e100 {
            return Err(ViewError::Time(t));
        }
        let elapsed = t - self.event.t();
        self.event = Event::at(t, self.event.position() + self.celerity.beta() * elapsed);
        self.nearest = None;
        Ok(())
    }

    /// The usual field of a projection, degrees.
    pub fn usual_fov_deg(projection: Projection) -> f64 {
        match projection {
            Projection::Pinhole => 60.0,
            Projection::Fisheye => 180.0,
            Projection::Panorama => 360.0,
        }
    }

    /// The view when the camera's own clock shows `clock`; it agrees with the world's at [`event`](Self::event).
    ///
    /// # Errors
    /// As [`set_time`](Self::set_time).
    pub fn at_clock(&self, clock: f64) -> Result<Self, ViewError> {
        let start = self.event.t();
        let mut view = self.clone();
        view.set_time(start + (clock - start) * self.celerity.gamma())?;
        Ok(view)
    }

    pub(super) fn camera(&self, bodies: &[Body]) -> Result<Camera, ViewError> {
        self.camera_passed(bodies, 0.0)
    }

    /// The camera when the body asked for, if any is, appears so far beyond abreast.
    pub(super) fn camera_passed(&self, bodies: &[Body], passed: f64) -> Result<Camera, ViewError> {
        let fov_deg = self.fov_deg.unwrap_or(Self::usual_fov_deg(self.projection));
        let lens = Lens::new(self.projection, fov_deg, self.size[0], self.size[1])?;
        // Axes matter neither for the moment nor for where a point is seen.
        let (up, any_forward) = (self.up, self.up.any_orthogonal_vector());
        let mut observer = Tetrad::new(self.event, self.celerity, any_forward, up)?;
        if let Some(name) = &self.nearest {
            let Some(body) = bodies.iter().find(|b| b.name == *name) else {
                let known: Vec<_> = bodies.iter().map(|b| format!("'{}'", b.name)).collect();
                return Err(ViewError::NoSuchBody { name: name.clone(), known: known.join(", ") });
            };
            observer = body
                .motion
                .seen_passed(body.centre(), &observer, passed)
                .map_err(|_| ViewError::NeverPasses(name.clone()))?;
        }
        let forward = match self.aim {
            Aim::Forward(forward) => forward,
            Aim::LookAt(point) => {
                if point == observer.event().position() {
                    return Err(ViewError::LooksAtItself);
                }
                let seen = ApparentMap::new(&Motion::at_rest(point), &observer).see(DVec3::ZERO).position;
                let [right, up, ahead] = observer.axes();
                right * seen.x + up * seen.y + ahead * seen.z
            }
        };
        Ok(Camera { observer: Tetrad::new(observer.event(), self.celerity, forward, self.up)?, lens })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_moving_camera_sees_what_it_looks_at_in_the_middle() {
        let view = View {
            event: Event::new(2.0, 1.0, -3.0, 0.5),
            celerity: Celerity::new(DVec3::new(1.5, 0.7, -0.4)).unwrap(),
            aim: Aim::LookAt(DVec3::new(4.0, 2.0, 1.0)),
            ..View::default()
        };
        let camera = view.camera(&[]).unwrap();
        let map = ApparentMap::new(&Motion::at_rest(DVec3::new(4.0, 2.0, 1.0)), &camera.observer);
        let seen = map.see(DVec3::ZERO).position.normalize();
        assert!((seen - DVec3::Z).length() < 1e-14, "{seen}");
    }

    #[test]
    fn time_moves_the_camera_along_its_world_line() {
        let celerity = Celerity::from_beta(DVec3::X * 0.6).unwrap();
        let mut view = View { event: Event::new(1.0, 0.0, 2.0, 0.0), celerity, ..View::default() };
        view.set_time(11.0).unwrap();
        assert!((view.event - Event::new(11.0, 6.0, 2.0, 0.0)).xyz().length() < 1e-14);
        assert!(view.set_time(f64::NAN).is_err());
    }
}
