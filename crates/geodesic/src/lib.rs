//! Light in spacetime: what lies between an observer and the things seen.
//!
//! This crate knows events, four-vectors, Lorentz maps and tetrads, and turns "an event and the direction
//! light came from" into the straight segments that light followed. It knows no meshes and no pixels.
//!
//! # Conventions
//!
//! * c = 1; metric signature −+++; components are ordered (t, x, y, z).
//! * Velocity is stored as [`Celerity`] u = γβ, because β near 1 has already lost its digits.
//! * A wave vector here points *back along the light*: K = (−1, n) for an observer who sees the light coming
//!   from the unit direction n. Boosted without renormalising, it keeps one affine parameter in all frames.
//! * Frames are types: `Lorentz<Observer, Rest>` takes rest-frame components to the observer's and will not
//!   compile the other way round.
//!
//! ```compile_fail
//! use terrell_geodesic::{Celerity, Event, Lorentz, Observer, Rest, World};
//! let world_from_rest = Lorentz::<World, Rest>::boost(&Celerity::at_rest());
//! let seen = Event::<Observer>::new(0.0, 1.0, 0.0, 0.0);
//! let _ = world_from_rest * seen.coordinates(); // an observer's event is not a rest-frame event
//! ```
//!
//! # Curved spacetime
//!
//! G = c = 1. Any spacetime is described by one of
//!
//! * its metric g alone, written once over any [`Number`] ([`Metric`], [`Curved::metric`]);
//! * the second derivative ẍ(x, ẋ) alone ([`Curved::second_derivative`]);
//! * a law of motion written out by hand ([`Law`]), as [`KerrSchild`] is for black holes.
//!
//! ```
//! use glam::DVec3;
//! use terrell_geodesic::{Curved, End, Event, LocalFrame, Ray, Spacetime, static_observer};
//!
//! let hole = Curved::kerr(1.0, 0.9)?;
//! let event = Event::new(0.0, 20.0, 0.0, 0.0);
//! let observer = static_observer(&hole, event)?;
//! let frame = LocalFrame::new(&hole, event, observer, -DVec3::X, DVec3::Z)?;
//! let mut ray = hole.ray(event, frame.seen_from(DVec3::new(0.4, 0.0, 0.9165).normalize()));
//! for segment in ray.by_ref() {
//!     // straight to 0.01 M; what it meets is found to the tolerance by `ray.at(s)`
//!     assert!(segment.length > 0.0);
//! }
//! assert!(matches!(ray.end(), Some(End::Sky { .. })));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | equation | where |
//! |---|---|
//! | ẍ^μ = −Γ^μ_αβ ẋ^α ẋ^β (Nollert et al. 2000, Eq. 6) | [`BySecondDerivative`]; as Hamilton's equations [`ByMetric`] |
//! | f(v + dε) = f(v) + f′(v) dε | [`Dual`] |
//! | g = η + f l l | [`KerrSchild`] |
//! | y′ = f(y), orders 8 and 5 | [`Method`] |
//! | sagitta ≈ h²\|x″\|/8, kept below ε | [`LightRay`], [`Accuracy`] |
//! | k = −u + n in an observer's frame | [`LocalFrame`] |
//! | L = −α sin ι, Q = β² + (α² − a²) cos² ι (section 3.3) | [`DistantCamera`] |
//! | w″ = ½W′(w), N″ = −(L² + Q + 2a²N_z²)N + a²N_z ẑ | [`KerrSky`] |
//!
//! # Reading order
//!
//! [`Real`] (the numbers) → [`Wide`] (twice the digits) → [`Event`], [`FourVector`] → [`Celerity`] →
//! [`Lorentz`] → [`Tetrad`] → [`Spacetime`], [`Segment`], [`Ray`], [`End`] → [`Flat`].
//!
//! Then what is curved: [`Number`], [`Dual`] → [`Metric`] → [`Law`] → [`Method`] → [`LightRay`] → [`Curved`] →
//! [`LocalFrame`]. Then black holes: [`KerrSchild`], [`BoyerLindquist`], [`DistantCamera`], [`KerrSky`].

mod boyer_lindquist;
mod celerity;
mod curved;
mod distant_camera;
mod dual;
mod event;
mod flat;
mod frame;
mod kerr_observers;
mod kerr_schild;
mod kerr_sky;
mod law;
mod local_frame;
mod lorentz;
mod metric;
mod mino;
mod number;
mod ray;
mod real;
mod runge_kutta;
mod spacetime;
mod tensor;
mod tetrad;
mod wide;

pub use boyer_lindquist::BoyerLindquist;
pub use celerity::{Celerity, CelerityError};
pub use curved::{Accuracy, Curved};
pub use distant_camera::{DistantCamera, DistantCameraError};
pub use dual::Dual;
pub use event::{Event, FourVector};
pub use flat::Flat;
pub use frame::{Lamp, Observer, Rest, World};
pub use kerr_observers::Sense;
pub use kerr_schild::{KerrError, KerrSchild};
pub use kerr_sky::KerrSky;
pub use law::{ByMetric, BySecondDerivative, Law};
pub use local_frame::{FrameError, LocalFrame, moving_observer, static_observer};
pub use lorentz::Lorentz;
pub use metric::{Metric, Minkowski, Stop, minkowski};
pub use number::Number;
pub use ray::LightRay;
pub use real::Real;
pub use runge_kutta::Method;
pub use spacetime::{End, Monitor, Ray, Segment, Spacetime};
pub use tetrad::{Tetrad, TetradError};
pub use wide::Wide;
