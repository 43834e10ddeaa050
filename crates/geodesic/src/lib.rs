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
//! # Reading order
//!
//! [`Real`] (the numbers) → [`Wide`] (twice the digits) → [`Event`], [`FourVector`] → [`Celerity`] →
//! [`Lorentz`] → [`Tetrad`] → [`Spacetime`], [`Flat`].

mod celerity;
mod event;
mod flat;
mod frame;
mod lorentz;
mod real;
mod spacetime;
mod tetrad;
mod wide;

pub use celerity::{Celerity, CelerityError};
pub use event::{Event, FourVector};
pub use flat::Flat;
pub use frame::{Lamp, Observer, Rest, World};
pub use lorentz::Lorentz;
pub use real::Real;
pub use spacetime::{Segment, Spacetime};
pub use tetrad::{Tetrad, TetradError};
pub use wide::Wide;
