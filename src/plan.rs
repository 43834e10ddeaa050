//! Which method a scene needs.

use crate::color::Coloring;
use crate::light::has_shadows;
use crate::scene::{Body, Material, Scene};

/// How what a pixel sees is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Method {
    /// Triangles are tested pixel by pixel in the sky of their rest frame, uncut, where they may be seen: exact and fast.
    /// Shadows are found by rays from what is seen; surfaces do not light each other. For γ up to [`MOST_GAMMA`].
    #[default]
    Exact,
    /// Bodies are moved to where they are seen, cut, and drawn as polygons (Nollert et al. 2000, section 2), to a tolerance.
    /// There are no shadows, and no sky.
    Apparent,
    /// Rays are followed back in time ([`crate::trace`]): with light of surfaces on each other, in curved spacetime too. For
    /// γ up to [`MOST_GAMMA`].
    Trace,
}

impl std::fmt::Display for Method {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Exact => "exact",
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

/// Whether polygons alone show all there is: without shadows, light of surfaces on each other, a sky or bent light.
pub fn is_of_polygons(scene: &Scene) -> bool {
    !scene.spacetime.is_curved() && scene.sky.is_none() && !has_reflections(scene) && !has_shadows(scene)
}

/// Lines of sight have digits for bodies and cameras that move relative to each other with up to this γ: with more, what
/// lies beside each other on the picture is one direction in the rest frame, to f64.
pub const MOST_GAMMA: f64 = 1e5;

/// The greatest γ with which a body and the camera, as it is before a moment is chosen, move relative to each other.
fn greatest_gamma(scene: &Scene) -> f64 {
    let camera = &scene.view.celerity;
    let relative = |body: &Body| {
        let body = &body.motion.celerity;
        body.gamma() * camera.gamma() - body.vector().dot(camera.vector())
    };
    scene.bodies.iter().map(relative).fold(1.0, f64::max)
}

/// Whether a method follows lines of sight that have too few digits for a scene: shapes are off by pixels then.
pub fn lacks_digits(scene: &Scene, method: Method) -> bool {
    method != Method::Apparent && !scene.spacetime.is_curved() && greatest_gamma(scene) > MOST_GAMMA
}

/// The cheapest method that is right for a scene, and why.
pub fn cheapest(scene: &Scene, coloring: Coloring) -> (Method, &'static str) {
    if scene.spacetime.is_curved() {
        (Method::Trace, "spacetime is curved")
    } else if greatest_gamma(scene) > MOST_GAMMA && (is_of_polygons(scene) || coloring == Coloring::Doppler) {
        (Method::Apparent, "γ is above 10⁵, where lines of sight lose digits")
    } else if coloring == Coloring::Doppler {
        (Method::Exact, "the Doppler factor needs no light")
    } else if has_reflections(scene) {
        (Method::Trace, "surfaces light each other")
    } else if has_shadows(scene) {
        (Method::Exact, "shadows need rays from what is seen only")
    } else {
        (Method::Exact, "nothing casts shadows")
    }
}
