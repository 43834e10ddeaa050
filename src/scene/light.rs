use crate::relativity::Motion;
use crate::spectrum::Spectrum;
use glam::DVec3;

/// What lights a scene from outside its surfaces.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// What the scene or the file calls it.
    pub name: String,
    /// Of what kind it is, and where, in its rest frame.
    pub kind: LightKind,
    /// Linear sRGB: a filter before it.
    pub color: [f32; 3],
    /// Its light before the filter, in its rest frame.
    pub spectrum: Spectrum,
    /// How much of that: at infinity, irradiance of what faces it; of a point or a spot, radiant intensity; ambient,
    /// radiance. An irradiance of π, or a radiance of 1, makes a white matt surface at rest as bright as white.
    pub strength: f64,
    /// How it moves; of what is at infinity or everywhere, in which frame it is as it is said to be.
    pub motion: Motion,
}

/// Kinds of [`Light`]s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// At infinity: its light goes this way.
    Distant {
        /// Unit vector.
        direction: DVec3,
    },
    /// It shines in all directions.
    Point {
        /// Where.
        position: DVec3,
    },
    /// It shines into a cone.
    Spot {
        /// Where.
        position: DVec3,
        /// The cone's axis, a unit vector.
        direction: DVec3,
        /// Angles from the axis, radians, where it begins to darken and where it is dark.
        cone: [f32; 2],
    },
    /// The same from all directions, as within a cloud or a bath of radiation.
    Ambient,
}

impl LightKind {
    /// Whether there is a place it shines from, so that things stand between.
    pub fn is_near(&self) -> bool {
        matches!(self, Self::Point { .. } | Self::Spot { .. })
    }

    /// Whether it comes from one direction, so that things stand in its way.
    pub fn casts_shadows(&self) -> bool {
        !matches!(self, Self::Ambient)
    }
}

impl std::fmt::Display for LightKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Distant { .. } => "distant",
            Self::Point { .. } => "point",
            Self::Spot { .. } => "spot",
            Self::Ambient => "ambient",
        })
    }
}
