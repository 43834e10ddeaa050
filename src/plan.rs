//! Which method a scene needs.

use crate::color::Coloring;
use crate::light::has_shadows;
use crate::scene::{Material, Scene};

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

/// Reflections followed, if surfaces light each other and nothing else is said: later ones add little.
pub const USUAL_BOUNCES: u32 = 4;

/// Samples of a pixel then.
pub const USUAL_PATHS: u32 = 64;

/// Whether what surfaces throw on each other is what is to be seen: mirrors, or surfaces that reflect where others shine.
pub fn has_reflections(scene: &Scene) -> bool {
    if scene.spacetime.is_curved() {
        // Not followed there.
        return false;
    }
    let lights = !scene.lights.is_empty();
    let plain = [Material::default()];
    let materials = || {
        scene.bodies.iter().flat_map(|body| match &body.mesh.materials[..] {
            [] => &plain[..],
            materials => materials,
        })
    };
    let shines = |m: &Material| !m.is_lit(lights) || m.emission != [0.0; 3];
    let mirrors = |m: &Material| m.is_lit(lights) && m.gloss.is_mirror() && m.gloss.metallic > 0.0;
    materials().any(mirrors) || (materials().any(|m| m.is_lit(lights)) && materials().any(shines))
}

/// The cheapest method that is right for a scene, and why.
pub fn cheapest(scene: &Scene, coloring: Coloring) -> (Method, &'static str) {
    if scene.spacetime.is_curved() {
        (Method::Trace, "spacetime is curved")
    } else if coloring == Coloring::Doppler && scene.sky.is_none() {
        (Method::Apparent, "the Doppler factor needs no light")
    } else if has_reflections(scene) {
        (Method::Trace, "surfaces light each other")
    } else if has_shadows(scene) {
        (Method::Trace, "lights cast shadows")
    } else if scene.sky.is_some() {
        (Method::Trace, "there is a sky")
    } else {
        (Method::Apparent, "nothing casts shadows")
    }
}
