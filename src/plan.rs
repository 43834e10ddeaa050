//! Which method a scene needs.

use crate::light::has_shadows;
use crate::scene::Scene;

/// How what a pixel sees is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Method {
    /// Bodies are moved to where they are seen, cut, and drawn as polygons (Nollert et al. 2000, section 2): fast. There
    /// are no shadows, and no sky.
    #[default]
    Apparent,
    /// Rays are followed back in time ([`crate::trace`]): with shadows, before the sky, in curved spacetime too.
    Trace,
}

impl std::fmt::Display for Method {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Apparent => "apparent",
            Self::Trace => "trace",
        })
    }
}

/// The cheapest method that is right for a scene, and why.
pub fn cheapest(scene: &Scene) -> (Method, &'static str) {
    if scene.spacetime.is_curved() {
        (Method::Trace, "spacetime is curved")
    } else if has_shadows(scene) {
        (Method::Trace, "lights cast shadows")
    } else if scene.sky.is_some() {
        (Method::Trace, "there is a sky")
    } else {
        (Method::Apparent, "nothing casts shadows")
    }
}
