use super::{Lens, Projection, Spacetime, Stance, View};
use glam::{DVec2, DVec3};
use terrell_geodesic::{
    Curved, DistantCamera, DistantCameraError, Event, FourVector, FrameError, KerrSchild, LocalFrame, Sense,
    Tetrad, World, moving_observer, static_observer,
};

/// Who looks in curved spacetime: what [`Tetrad`] is in flat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Eye {
    /// At an event, with a frame of its own.
    Near(LocalFrame),
    /// Infinitely far away.
    Distant(DistantEye),
}

/// A camera infinitely far away from a black hole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DistantEye {
    camera: DistantCamera,
    inclination: f64,
    azimuth: f64,
    /// Retarded time.
    time: f64,
    /// Of the picture, as a length at the hole.
    height: f64,
}

/// Why there is no such camera.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EyeError {
    /// Nobody can be there, or not so.
    #[error("the camera cannot be there: {source}{remedy}")]
    Frame {
        /// Why.
        source: FrameError,
        /// Which observers can be there.
        remedy: String,
    },
    /// Not so from infinity.
    #[error(transparent)]
    Distant(#[from] DistantCameraError),
    /// A picture of no height.
    #[error("a camera at infinity needs a height above 0, a length at the hole; {0} is none")]
    Height(f64),
    /// Angles, where there are none.
    #[error(
        "a camera at infinity has a height, and no field of view in degrees; leave out fov_deg and --fov"
    )]
    Field,
    /// A lens for the whole sky.
    #[error("a camera at infinity is a pinhole; a {0} needs a camera that is near")]
    Projection(Projection),
}

impl Eye {
    /// The camera of a view where it is `observer` by flat spacetime's rules; none in flat spacetime itself.
    ///
    /// Its axes are those it would have there: turned out of the observer's space by nothing but the boost.
    ///
    /// # Errors
    /// If nobody can be there, or not with that motion.
    pub fn new(spacetime: &Spacetime, view: &View, observer: &Tetrad) -> Result<Option<Self>, EyeError> {
        let Spacetime::Kerr(hole) = spacetime else { return Ok(None) };
        if let Stance::Infinity { inclination_deg, azimuth_deg, height } = view.stance {
            if !(height > 0.0 && height.is_finite()) {
                return Err(EyeError::Height(height));
            }
            if view.projection != Projection::Pinhole {
                return Err(EyeError::Projection(view.projection));
            }
            if view.fov_deg.is_some() {
                return Err(EyeError::Field);
            }
            let inclination = inclination_deg.to_radians();
            let camera = DistantCamera::at_infinity(*hole, inclination)?;
            let (azimuth, time) = (azimuth_deg.to_radians(), view.event.t());
            return Ok(Some(Self::Distant(DistantEye { camera, inclination, azimuth, time, height })));
        }
        let space = Curved::new(*hole);
        let event = observer.event();
        let velocity = four_velocity(hole, view.stance, observer);
        let frame = velocity.and_then(|velocity| {
            let [_, up, forward] = observer.axes().map(|axis| contracted(axis, observer));
            LocalFrame::new(&space, event, velocity, forward, up)
        });
        let frame = frame.map_err(|source| EyeError::Frame { source, remedy: remedy(hole, observer) })?;
        Ok(Some(Self::Near(frame)))
    }

    /// The ray seen at a point of the picture, back along the light, as the observer sees it with frequency 1; none beyond
    /// the edge of a fisheye's sky.
    pub fn ray(&self, lens: &Lens, pixel: DVec2) -> Option<(Event<World>, FourVector<World>)> {
        match self {
            Self::Near(frame) => {
                let direction = lens.direction(pixel)?.normalize();
                Some((frame.event(), frame.seen_from(direction)))
            }
            Self::Distant(eye) => {
                let at = (pixel - lens.middle()) * (eye.height / f64::from(lens.height()));
                let (event, k) = eye.camera.ray(at.x, -at.y).ok()?;
                let place = Event::at(event.t() + eye.time, eye.turned(event.position()));
                Some((place, FourVector::from_parts(k.t, eye.turned(k.xyz()))))
            }
        }
    }

    /// The distance told of what a ray meets at its affine parameter `s`: that itself, which is r in flat spacetime; from
    /// infinity, how far beyond the hole.
    pub fn distance(&self, start: Event<World>, s: f64) -> f64 {
        match self {
            Self::Near(_) => s,
            Self::Distant(eye) => {
                let (sine, cosine) = eye.inclination.sin_cos();
                s - start.position().dot(eye.turned(DVec3::new(sine, 0.0, cosine)))
            }
        }
    }
}

impl DistantEye {
    fn turned(&self, v: DVec3) -> DVec3 {
        let (sine, cosine) = self.azimuth.sin_cos();
        DVec3::new(v.x * cosine - v.y * sine, v.x * sine + v.y * cosine, v.z)
    }
}

/// The direction at one coordinate time of which the observer's space has the axis: shorter along the motion by γ.
fn contracted(axis: DVec3, observer: &Tetrad) -> DVec3 {
    let celerity = observer.celerity();
    match celerity.direction() {
        Some(along) => axis + along * (axis.dot(along) * (1.0 / celerity.gamma() - 1.0)),
        None => axis,
    }
}

fn four_velocity(
    hole: &KerrSchild,
    stance: Stance,
    observer: &Tetrad,
) -> Result<FourVector<World>, FrameError> {
    let (space, event) = (Curved::new(*hole), observer.event());
    match stance {
        Stance::Moving if observer.celerity().moves() => {
            moving_observer(&space, event, observer.celerity().beta())
        }
        Stance::Moving | Stance::Infinity { .. } => static_observer(&space, event),
        Stance::Zamo => hole.zamo(event),
        Stance::Circular(sense) => hole.circular(event, sense),
        Stance::Rain => hole.rain(event),
    }
}

/// Which observers can be at an event, in words.
fn remedy(hole: &KerrSchild, observer: &Tetrad) -> String {
    let resting = Tetrad::of_world(observer.event());
    let all = [
        ("static", Stance::Moving),
        ("zamo", Stance::Zamo),
        ("circular", Stance::Circular(Sense::Prograde)),
        ("retrograde", Stance::Circular(Sense::Retrograde)),
        ("rain", Stance::Rain),
    ];
    let can = all.iter().filter(|(_, stance)| four_velocity(hole, *stance, &resting).is_ok());
    let names: Vec<_> = can.map(|(name, _)| format!("\"{name}\"")).collect();
    match names.len() {
        0 => format!(
            "; the horizon reaches {:.4} from the axis, and {:.4} along it",
            hole.horizon().hypot(hole.spin()),
            hole.horizon()
        ),
        _ => format!("; there the observer can be {}", names.join(", ")),
    }
}
