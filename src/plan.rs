//! Which method a scene needs.

use crate::color::Coloring;
use crate::light::{DopplerAt, has_shadows};
use crate::scene::{Body, Camera, EmissionLaw, Material, Projection, Scene};

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
pub fn greatest_gamma(scene: &Scene) -> f64 {
    let camera = &scene.view.celerity;
    let relative = |body: &Body| body.motion.celerity.relative_gamma(camera);
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

/// Graphics processors work in single precision. For bodies and cameras that move relative to each other with up to this γ
/// they see what the CPU sees. Distance, Doppler factor and colour are good to 10⁻⁴ up to [`MOST_GAMMA`], but the differences
/// of surfaces one behind the other go with 1/γ of the way to them, and at 10⁴ a window a centimetre before its wall is
/// no longer told from it; `docs/gpu.md` has what was measured.
pub const MOST_GAMMA_ON_GPU: f64 = 1e3;

/// Directions of wide lenses are told apart in single precision where there are up to so many pixels a radian.
const MOST_FOCAL_ON_GPU: f64 = 3e4;

/// Why a graphics processor does not draw what these cameras see of a scene, if it does not.
pub fn not_on_gpu(
    scene: &Scene,
    cameras: &[&Camera],
    method: Method,
    coloring: Coloring,
    doppler_at: DopplerAt,
) -> Option<&'static str> {
    let bodies = || scene.bodies.iter();
    let materials = || bodies().flat_map(|body| &body.mesh.materials);
    let gamma =
        |camera: &Camera, body: &Body| body.motion.celerity.relative_gamma(&camera.observer.celerity());
    let is_narrow = |camera: &&Camera| {
        let lens = camera.lens;
        lens.projection() != Projection::Pinhole && lens.focal().max_element() > MOST_FOCAL_ON_GPU
    };
    let colored = coloring != Coloring::Doppler;
    let is_lit =
        |body: &Body| body.mesh.materials.is_empty() || body.mesh.materials.iter().any(|m| m.is_lit(true));
    let smooth = |body: &Body| {
        !body.mesh.normals.is_empty() && body.mesh.materials.iter().any(|m| m.law != EmissionLaw::Isotropic)
    };
    if method == Method::Trace {
        Some("rays are traced on the CPU")
    } else if scene.sky.is_some() && method == Method::Exact {
        Some("a sky is drawn on the CPU")
    } else if colored && !scene.lights.is_empty() && bodies().any(is_lit) {
        Some("what lights shine on is drawn on the CPU")
    } else if colored && materials().any(Material::is_textured) {
        Some("textures are drawn on the CPU")
    } else if colored && bodies().any(smooth) {
        Some("laws of emission on smooth normals are worked out on the CPU")
    } else if doppler_at == DopplerAt::Vertex {
        Some("Doppler factors of vertices are worked out on the CPU")
    } else if cameras.iter().any(is_narrow) {
        Some("the field of view is too narrow for single precision")
    } else if cameras.iter().any(|c| bodies().any(|b| gamma(c, b) > MOST_GAMMA_ON_GPU)) {
        Some("γ is too large for single precision")
    } else {
        None
    }
}

/// Opening a graphics processor and compiling for it takes tenths of a second, drawing so many samples on two cores about one.
const OPENING: u64 = 1 << 25;

/// How many samples pictures by these cameras have in all.
pub fn samples_to_draw(cameras: &[&Camera], samples: u32) -> u64 {
    let pixels = |camera: &&Camera| u64::from(camera.lens.width()) * u64::from(camera.lens.height());
    cameras.iter().map(pixels).sum::<u64>().saturating_mul(samples.into())
}

/// Whether so many pictures by these cameras are enough work to look for a graphics processor.
pub fn is_worth_a_gpu(cameras: &[&Camera], samples: u32) -> bool {
    samples_to_draw(cameras, samples) > OPENING
}
