//! What motion does to sight: one boost gives the apparent position, the distance and the Doppler factor.

mod apparent_map;
mod kernel;
mod motion;

pub use apparent_map::{ApparentMap, BoostedSight, MapLane, RestSky, Sight};
pub use kernel::{Lane, Points, PointsMut};
pub use motion::{Motion, NeverAbreast};
