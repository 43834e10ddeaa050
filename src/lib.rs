//! See relativistic motion: any mesh as it *looks* at any speed.
//!
//! The light that arrives at one moment left a moving body at different times, so the body looks sheared,
//! stretched and turned. This crate finds what each pixel sees by testing triangles, uncut, in the sky of their rest
//! frame; or it moves each vertex to where it is seen, cuts straight edges so that they become the hyperbolas they look like,
//! to a stated pixel error, and draws the result, or hands it to other programs.
//!
//! ```
//! use terrell::{render, scene, tone};
//!
//! let mut scene = scene::builtin_scenes()[0].scene(); // the cube of Fig. 2, at 0.9c
//! scene.view.size = [320, 240];
//! let camera = scene.camera()?;
//! let (film, _) = render::render(&scene, &camera, &render::Options::default(), |_| ())?;
//! let tone = tone::Tone::Filmic;
//! let development = tone::Development { ev: tone.metered(film.color.iter().copied()), tone };
//! let mut png = Vec::new();
//! terrell::picture::write_png(&film, &development, &mut png)?;
//! assert!(png.starts_with(b"\x89PNG"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Equations
//!
//! "The paper" is Nollert, Kraus and Ruder, *Visualization in Curved Spacetimes: I* (2000).
//!
//! | | where | what |
//! |---|---|---|
//! | Eq. 1 | [`relativity::ApparentMap`] | apparent position, x = γ(x′ − βr′), and its inverse |
//! | Eq. 2 | [`apparent::Rod`], [`apparent::Arc`] | straight rods are seen as hyperbolas |
//! | Eq. 3, 4 | [`relativity::Sight::doppler`], [`relativity::ApparentMap::doppler_towards`] | Doppler factor |
//! | Eq. 5 | [`spectrum::Response`], [`light::Shading`] | I_ν/ν³ is invariant: spectra and colours under a shift |
//! | section 2.2.3 | [`light::SeenShading::radiance`] | lights, aberrated, in each body's rest frame |
//! | section 2.2.4 | [`trace::Tracer`] | shadows and reflections by rays, with light travel time |
//! | section 2.1.2 | [`relativity::ApparentMap::unsee`], [`detectors::seen_from`] | from pictures back to shapes; these from aside |
//! | beyond it | [`trace::Tracer::exact`] | triangles tested pixel by pixel, nothing cut |
//! | Eq. 6 | [`geodesic::BySecondDerivative`], [`geodesic::ByMetric`] | geodesics, by their second derivative or by the metric |
//! | Fig. 7 | [`geodesic::Spacetime`] | what hands straight segments to whoever looks |
//!
//! # Conventions
//!
//! * c = 1. Velocities are stored as celerity u = γβ ([`geodesic::Celerity`]).
//! * *World*: where a scene places things. *Rest*: one a body, in which its mesh is static. *Observer*: the
//!   camera's, its event as origin, x right, y up, z forward. Names say which: `x_rest`, `axis_observer`.
//! * X_world = L(celerity) · X_rest + origin for a body; see [`relativity::Motion`].
//! * D = ν_observed/ν_emitted: above 1 approaching and blue. θ always says its frame.
//! * Spacetime arithmetic is f64, with 32 digits for what is formed once a body; the film is f32.
//! * Colours are linear sRGB (Rec. 709 primaries, D65 white). Light is radiance in units of the film's white: luminance 1.
//!
//! # Reading order
//!
//! [`geodesic`] (events, Lorentz maps, observers) → [`relativity`] (the map) → [`scene`] (what is there) →
//! [`apparent`] (what it looks like), [`spectrum`] and [`light`] (what it shines with) → [`plan`] (how it is drawn; [`explanation`] says why, [`outlook`] what is to be seen) → [`raster`], or [`trace`] → [`film`] →
//! [`exposure`], [`tone`] → [`drawing`] → [`picture`]; [`mod@render`] runs them in turn. [`measure`] says how far two
//! films are apart, [`figure`] draws what was measured, [`teach`] tells what is to be learnt of it all. [`mod@transform`] instead makes a [`export::Model`] for other programs of what there is and how it looks.

pub mod apparent;
pub mod color;
pub mod detectors;
pub mod drawing;
pub mod explanation;
pub mod export;
pub mod exposure;
pub mod figure;
pub mod film;
pub mod light;
pub mod measure;
pub mod outlook;
pub mod picture;
pub mod plan;
mod processor;
pub mod raster;
pub mod relativity;
pub mod render;
pub mod scene;
pub mod spectrum;
pub mod teach;
pub mod tone;
pub mod trace;
pub mod transform;

pub use terrell_geodesic as geodesic;

/// The examples of the library guide.
#[cfg(doctest)]
#[doc = include_str!("../docs/library.md")]
mod guide {}
