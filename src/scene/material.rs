use super::Texture;
use crate::spectrum::Spectrum;

/// What a surface is made of, shared by any number of triangles. Colours are linear sRGB.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// What the file calls it; may be empty.
    pub name: String,
    /// Colour of the surface itself, times [`Paint`](super::Paint): of its own light where it is luminous, of what it
    /// reflects where it is lit.
    pub base_color: [f32; 3],
    /// Times this, where there is one.
    pub base_texture: Option<Texture>,
    /// Light the surface gives off besides.
    pub emission: [f32; 3],
    /// Times this, where there is one.
    pub emission_texture: Option<Texture>,
    /// Where its light comes from.
    pub surface: Surface,
    /// The light it gives off, before its colours.
    pub spectrum: Spectrum,
    /// How that depends on direction.
    pub law: EmissionLaw,
    /// How it reflects lights besides evenly.
    pub gloss: Gloss,
    /// Whether it is seen from the front only.
    pub one_sided: bool,
}

/// Where a surface's light comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Surface {
    /// From lights, if the scene has any, else from itself.
    #[default]
    Auto,
    /// From itself, whatever lights there are.
    Luminous,
    /// From lights: without them it is dark.
    Lit,
}

/// Radiance by the cosine of the angle between the surface's normal and the direction the light leaves in, in the
/// surface's rest frame.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum EmissionLaw {
    /// The same in all directions, as a black body's and as of snow: what J. H. Lambert found matt surfaces to do.
    #[default]
    Isotropic,
    /// Going with a power of the cosine.
    Cosine {
        /// 1 is Lambert's cosine in the radiance itself.
        power: f64,
    },
    /// As of stars: 1 − a(1 − μ) − b(1 − μ)².
    LimbDarkening {
        /// a and b.
        coefficients: [f64; 2],
    },
}

impl EmissionLaw {
    /// The factor at a cosine.
    #[inline]
    pub fn factor(&self, cosine: f64) -> f64 {
        match *self {
            Self::Isotropic => 1.0,
            Self::Cosine { power } => cosine.clamp(0.0, 1.0).powf(power),
            Self::LimbDarkening { coefficients: [a, b] } => {
                let less = 1.0 - cosine.clamp(0.0, 1.0);
                (1.0 - a * less - b * less * less).max(0.0)
            }
        }
    }
}

/// A glossy lobe beside the even (Lambert) reflection: microfacets as of B. Walter et al., *Microfacet models for
/// refraction through rough surfaces* (2007), with the Fresnel reflection of C. Schlick (1994); the model of glTF 2.0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gloss {
    /// What is reflected by the surface at right angles, white; 0.04 for glass and plastics, 0 for none.
    pub reflectance: f32,
    /// 0 smooth, 1 rough.
    pub roughness: f32,
    /// 1 for a metal, which reflects in its own colour and has no even reflection.
    pub metallic: f32,
}

impl Gloss {
    /// Smoother, the lobe is one direction where paths are traced.
    const MIRROR: f32 = 0.03;

    /// Whether there is no lobe.
    pub fn is_even(&self) -> bool {
        self.reflectance == 0.0 && self.metallic == 0.0
    }

    /// Whether it is as smooth as a mirror.
    pub fn is_mirror(&self) -> bool {
        self.roughness <= Self::MIRROR
    }
}

impl Default for Gloss {
    fn default() -> Self {
        Self { reflectance: 0.0, roughness: 0.5, metallic: 0.0 }
    }
}

impl Default for Material {
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: [1.0; 3],
            base_texture: None,
            emission: [0.0; 3],
            emission_texture: None,
            surface: Surface::default(),
            spectrum: Spectrum::default(),
            law: EmissionLaw::default(),
            gloss: Gloss::default(),
            one_sided: false,
        }
    }
}

/// The two colours of a point of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Colors {
    /// Of its own light where it is luminous, of what it reflects where it is lit.
    pub base: [f32; 3],
    /// Given off besides.
    pub emission: [f32; 3],
}

impl Colors {
    /// Of a surface that is luminous.
    #[inline]
    pub fn sum(self) -> [f32; 3] {
        [0, 1, 2].map(|i| self.base[i] + self.emission[i])
    }
}

impl Material {
    /// Whether a texture is on it.
    #[inline]
    pub fn is_textured(&self) -> bool {
        self.base_texture.is_some() || self.emission_texture.is_some()
    }

    /// Whether it reflects light in a scene that has lights, or has none.
    pub fn is_lit(&self, lights: bool) -> bool {
        match self.surface {
            Surface::Auto => lights,
            Surface::Luminous => false,
            Surface::Lit => true,
        }
    }

    /// The surface's colours where its paint is `paint`; `look` gives a texture's colour there.
    #[inline]
    pub fn colors(&self, paint: [f32; 3], look: impl Fn(&Texture) -> [f32; 3]) -> Colors {
        let times = |a: [f32; 3], b: [f32; 3]| [0, 1, 2].map(|i| a[i] * b[i]);
        let textured =
            |color, texture: &Option<Texture>| texture.as_ref().map_or(color, |t| times(color, look(t)));
        let base = times(paint, textured(self.base_color, &self.base_texture));
        let dark = self.emission == [0.0; 3];
        let emission = if dark { [0.0; 3] } else { textured(self.emission, &self.emission_texture) };
        Colors { base, emission }
    }

    /// The colour of what shines by itself.
    #[inline]
    pub fn color(&self, paint: [f32; 3], look: impl Fn(&Texture) -> [f32; 3]) -> [f32; 3] {
        self.colors(paint, look).sum()
    }

    /// Whether all its numbers are such.
    pub(super) fn is_finite(&self) -> bool {
        let Gloss { reflectance, roughness, metallic } = self.gloss;
        let gloss = [reflectance, roughness, metallic];
        self.base_color.iter().chain(&self.emission).chain(&gloss).all(|v| v.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn emission_laws_are_what_they_say() {
        assert_eq!(EmissionLaw::Isotropic.factor(0.1), 1.0);
        assert_eq!(EmissionLaw::Cosine { power: 1.0 }.factor(0.3), 0.3);
        assert_eq!(EmissionLaw::Cosine { power: 2.0 }.factor(-0.3), 0.0);
        let sun = EmissionLaw::LimbDarkening { coefficients: [0.6, 0.0] };
        assert_eq!((sun.factor(1.0), sun.factor(0.0)), (1.0, 0.4));
        // Its mean over a disc, against the closed form 1 − a/3 − b/6.
        let law = EmissionLaw::LimbDarkening { coefficients: [0.5, 0.2] };
        let steps = 100_000;
        let mean: f64 = (0..steps)
            .map(|i| {
                let square = (f64::from(i) + 0.5) / f64::from(steps);
                law.factor((1.0 - square).sqrt()) / f64::from(steps)
            })
            .sum();
        assert!((mean - (1.0 - 0.5 / 3.0 - 0.2 / 6.0)).abs() < 1e-6, "{mean}");
    }
}
