use super::Scene;
use terrell_geodesic::{KerrSchild, Sense};

/// The spacetime a scene lies in.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Spacetime {
    /// Without gravity.
    #[default]
    Flat,
    /// Around a black hole at the origin, its axis along z. The scene's coordinates are Cartesian Kerr–Schild ones, in
    /// which bodies keep their shapes and move uniformly.
    Kerr(KerrSchild),
}

impl Spacetime {
    /// Whether light is bent.
    pub fn is_curved(&self) -> bool {
        *self != Self::Flat
    }
}

impl std::fmt::Display for Spacetime {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Flat => f.write_str("flat spacetime"),
            Self::Kerr(hole) if hole.spin() == 0.0 => {
                write!(f, "Schwarzschild spacetime (M = {:?})", hole.mass())
            }
            Self::Kerr(hole) => {
                write!(f, "Kerr spacetime (M = {:?}, a = {} M)", hole.mass(), hole.spin() / hole.mass())
            }
        }
    }
}

/// How a camera is there: what it does at its event, or how far away it is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Stance {
    /// It has its velocity, in coordinates; without one it rests.
    #[default]
    Moving,
    /// It has no angular momentum, and is dragged around by the hole.
    Zamo,
    /// It goes around the hole on a circular orbit in the equatorial plane.
    Circular(Sense),
    /// It falls freely, from rest at infinity.
    Rain,
    /// It is infinitely far away, and looks at the hole (Nollert et al. 2000, section 3.3).
    Infinity {
        /// Angle of the line of sight from the hole's axis, degrees.
        inclination_deg: f64,
        /// Where it is around the axis, degrees from +x towards +y.
        azimuth_deg: f64,
        /// What the picture's height spans, as a length at the hole.
        height: f64,
    },
}

/// What a scene has that its spacetime does not.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SpacetimeError {
    /// Lights.
    #[error(
        "in curved spacetime the ways from lights to surfaces are not solved for, so nothing can be lit; take '{0}' away, and let surfaces shine by themselves"
    )]
    Light(String),
    /// Surfaces that reflect.
    #[error(
        "in curved spacetime light is not followed from surface to surface, and '{0}' has a surface that only reflects; make it luminous"
    )]
    Reflects(String),
    /// The moment at which something is seen abreast.
    #[error(
        "in curved spacetime nothing is seen just once, and not abreast; give a time instead of 'nearest {0}'"
    )]
    Nearest(String),
    /// An animation within a body.
    #[error(
        "'{0}' is animated within itself, which only flat spacetime has; stop it with an animation rate of 0"
    )]
    Animated(String),
    /// An observer that only black holes have.
    #[error("in flat spacetime a camera just has a velocity; give one, or add a [spacetime]")]
    Stance,
}

impl Scene {
    /// Checks that the scene has nothing its spacetime cannot have.
    ///
    /// # Errors
    /// Naming the first there is.
    pub fn check_spacetime(&self) -> Result<(), SpacetimeError> {
        if !self.spacetime.is_curved() {
            return if self.view.stance == Stance::Moving { Ok(()) } else { Err(SpacetimeError::Stance) };
        }
        if let Some(light) = self.lights.first() {
            return Err(SpacetimeError::Light(light.name.clone()));
        }
        let reflects =
            |b: &&super::Body| b.mesh.materials.iter().any(|m| m.is_lit(false) && m.emission == [0.0; 3]);
        if let Some(body) = self.bodies.iter().find(reflects) {
            return Err(SpacetimeError::Reflects(body.name.clone()));
        }
        if let Some(name) = &self.view.nearest {
            return Err(SpacetimeError::Nearest(name.clone()));
        }
        let moving = |b: &&super::Body| b.clip.as_ref().is_some_and(|clip| clip.rate != 0.0);
        match self.bodies.iter().find(moving) {
            Some(body) => Err(SpacetimeError::Animated(body.name.clone())),
            None => Ok(()),
        }
    }

    /// Which bodies reach into a horizon at the time of the camera, for people to read.
    pub fn horizon_notes(&self) -> Vec<String> {
        let Spacetime::Kerr(hole) = self.spacetime else { return Vec::new() };
        let reaches = |body: &&super::Body| {
            let (mesh, motion) = (&body.mesh, &body.motion);
            let now = motion.at_time(self.view.event.t());
            (0..mesh.vertex_count())
                .any(|v| hole.radius(now(mesh.vertex(v as u32)).to_array()) <= hole.horizon())
        };
        let note = |body: &super::Body| {
            let what = if body.motion.celerity.moves() {
                "at the time of the picture, crossing it"
            } else {
                "where nothing can rest"
            };
            format!("'{}' reaches into the horizon, {what}; what is inside is not seen", body.name)
        };
        self.bodies.iter().filter(reaches).map(note).collect()
    }
}
