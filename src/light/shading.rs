use super::SeenShading;
use super::incidence::{Incidence, NearLight};
use super::tables::{TableInfo, Tables};
use crate::color::Coloring;
use crate::relativity::Motion;
use crate::scene::{EmissionLaw, Gloss, Light, Material, Scene};
use crate::spectrum::{DopplerTable, Response, RowTable, Spectrum, SpectrumError};
use std::sync::Arc;
use terrell_geodesic::Tetrad;

/// How the surfaces of a scene shine and are lit, each body in its own rest frame: made once a scene.
///
/// Nothing here depends on where the observer is, only, by the range of its tables, on how fast. Tables are shared
/// between all that have the same spectrum.
#[derive(Clone, Debug)]
pub struct Shading {
    pub(super) coloring: Coloring,
    pub(super) doppler_at: DopplerAt,
    pub(super) lights: Vec<SceneLight>,
    pub(super) bodies: Vec<BodyShading>,
    pub(super) sky: Option<MaterialShading>,
    tables: Vec<TableInfo>,
}

/// Where the Doppler factor is worked out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum DopplerAt {
    /// Exactly, in every pixel: it depends on the direction alone.
    #[default]
    Pixel,
    /// At the vertices that are drawn, and interpolated between, as the paper has it (section 2.2.1).
    Vertex,
}

#[derive(Clone, Debug)]
pub(super) struct SceneLight {
    pub light: Light,
    /// Linear sRGB unshifted; without spectra, what its colour is multiplied by.
    pub color: [f32; 3],
    /// Of its spectrum; see [`Spectrum::scale`].
    pub scale: f64,
}

#[derive(Clone, Debug)]
pub(super) struct BodyShading {
    motion: Motion,
    pub materials: Vec<MaterialShading>,
    /// One a light.
    pub incidences: Vec<Incidence>,
}

#[derive(Clone, Debug)]
pub(super) struct MaterialShading {
    pub lit: bool,
    pub law: EmissionLaw,
    pub gloss: Gloss,
    /// How much it shines, by luminance or by radiance as its spectrum says.
    pub strength: f32,
    pub spectrum: Spectrum,
    /// Of its spectrum; see [`Spectrum::scale`].
    pub scale: f64,
    /// Unshifted colours of what shines in red, green and blue; none where these are themselves.
    pub unshifted: Option<[f32; 9]>,
    /// Of what it shines with.
    pub own: Option<Arc<DopplerTable>>,
    /// Of what it reflects, one a light; empty without colours of spectra.
    pub reflected: Vec<Arc<RowTable>>,
}

/// How far |ln D| goes in tables for curved spacetime, where it has no bound: near a horizon D goes to 0 and to infinity.
/// What is shifted to the red so far has long been dark.
const CURVED_RANGE: f64 = 12.0;

/// A spectrum that cannot be, and whose it is.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{name}: {source}")]
pub struct ShadingError {
    /// Whose.
    pub name: String,
    /// Why.
    pub source: SpectrumError,
}

/// Colours unshifted in light of a spectrum; none where they are themselves.
fn unshifted(spectrum: &Spectrum) -> Result<Option<[f32; 9]>, SpectrumError> {
    if *spectrum == (Spectrum { beyond: spectrum.beyond, ..Spectrum::default() }) {
        return Ok(None);
    }
    let [r, g, b] = Response::of_own(spectrum)?.matrix(1.0, 1.0).map(|c| c.map(|v| v as f32));
    Ok(Some([r[0], r[1], r[2], g[0], g[1], g[2], b[0], b[1], b[2]]))
}

/// The colour `own` by such a matrix.
pub(super) fn times(matrix: &Option<[f32; 9]>, own: [f32; 3]) -> [f32; 3] {
    match matrix {
        None => own,
        Some(m) => [0, 1, 2].map(|i| m[i] * own[0] + m[3 + i] * own[1] + m[6 + i] * own[2]),
    }
}

impl Shading {
    /// Of a scene as these observers see it, who may be at rest or fast.
    ///
    /// # Errors
    /// If a spectrum cannot be.
    pub fn new<'a>(
        scene: &Scene,
        observers: impl IntoIterator<Item = &'a Tetrad>,
        coloring: Coloring,
    ) -> Result<Self, ShadingError> {
        let observers = observers.into_iter().map(|o| o.celerity().rapidity()).fold(0.0, f64::max);
        let bodies = scene.bodies.iter().map(|b| b.motion.celerity.rapidity()).fold(0.0, f64::max);
        let curved = if scene.spacetime.is_curved() { CURVED_RANGE } else { 0.0 };
        Self::within(scene, bodies + observers + curved, coloring)
    }

    /// Of a scene whose bodies have relative rapidities of at most `range` to whoever looks.
    ///
    /// # Errors
    /// If a spectrum cannot be.
    pub fn within(scene: &Scene, range: f64, coloring: Coloring) -> Result<Self, ShadingError> {
        let mut tables = Tables::new(range);
        let plain = [Material::default()];
        let lights = scene
            .lights
            .iter()
            .map(|light| {
                let fault = |source| ShadingError { name: format!("light '{}'", light.name), source };
                let color = times(&unshifted(&light.spectrum).map_err(fault)?, light.color);
                let color = if coloring == Coloring::Bolometric {
                    // As much as its spectrum says, whatever of it is seen.
                    light.color.map(|v| v * light.spectrum.strength.value() as f32)
                } else {
                    color.map(|v| v.max(0.0))
                };
                let scale = light.spectrum.scale().map_err(fault)?;
                Ok(SceneLight { light: light.clone(), color, scale })
            })
            .collect::<Result<Vec<_>, ShadingError>>()?;
        let mut bodies = Vec::with_capacity(scene.bodies.len());
        for body in &scene.bodies {
            let incidences: Vec<_> =
                lights.iter().map(|light| Incidence::new(&light.light, &body.motion)).collect();
            let materials = if body.mesh.materials.is_empty() { &plain[..] } else { &body.mesh.materials };
            let materials = materials
                .iter()
                .map(|material| {
                    let fault = |source| ShadingError { name: format!("body '{}'", body.name), source };
                    let lit = material.is_lit(!lights.is_empty());
                    let spectral = coloring == Coloring::Spectral;
                    let shines = !lit || material.emission != [0.0; 3];
                    let own = (spectral && shines).then(|| tables.own(&material.spectrum));
                    let mut reflected = Vec::new();
                    if spectral && lit {
                        for (light, incidence) in lights.iter().zip(&incidences) {
                            let beyond = material.spectrum.beyond;
                            let table = tables.reflected(&light.light, &body.motion, incidence, beyond);
                            reflected.push(table.map_err(fault)?);
                        }
                    }
                    Ok(MaterialShading {
                        lit,
                        law: material.law,
                        gloss: material.gloss,
                        strength: material.spectrum.strength.value() as f32,
                        spectrum: material.spectrum.clone(),
                        scale: material.spectrum.scale().map_err(fault)?,
                        unshifted: unshifted(&material.spectrum).map_err(fault)?,
                        own: own.transpose().map_err(fault)?,
                        reflected,
                    })
                })
                .collect::<Result<_, ShadingError>>()?;
            bodies.push(BodyShading { motion: body.motion, materials, incidences });
        }
        let sky = scene.sky.as_ref().map(|sky| {
            let own = (coloring == Coloring::Spectral).then(|| tables.own(&sky.spectrum));
            Ok(MaterialShading {
                lit: false,
                law: EmissionLaw::default(),
                gloss: Gloss::default(),
                strength: sky.spectrum.strength.value() as f32,
                spectrum: sky.spectrum.clone(),
                scale: sky.spectrum.scale()?,
                unshifted: unshifted(&sky.spectrum)?,
                own: own.transpose()?,
                reflected: Vec::new(),
            })
        });
        let sky = sky.transpose().map_err(|source| ShadingError { name: "the sky".into(), source })?;
        let tables = tables.infos;
        Ok(Self { coloring, doppler_at: DopplerAt::default(), lights, bodies, sky, tables })
    }

    /// The same with the Doppler factor worked out elsewhere.
    #[must_use]
    pub fn with_doppler_at(self, doppler_at: DopplerAt) -> Self {
        Self { doppler_at, ..self }
    }

    /// What a pixel shows.
    pub fn coloring(&self) -> Coloring {
        self.coloring
    }

    /// The tables of colours, for reports.
    pub fn tables(&self) -> &[TableInfo] {
        &self.tables
    }

    /// For one moment of an observer.
    pub fn seen_by(&self, observer: &Tetrad) -> SeenShading<'_> {
        let near = |body: &BodyShading| {
            let light = |l: &SceneLight| NearLight::new(&l.light, &body.motion, observer);
            self.lights.iter().map(light).collect()
        };
        SeenShading::new(self, self.bodies.iter().map(near).collect())
    }
}

/// Whether there are lights that something can stand in the way of, and surfaces that reflect them.
pub fn has_shadows(scene: &Scene) -> bool {
    let lit = |m: &Material| m.is_lit(true);
    let is_lit = |b: &crate::scene::Body| b.mesh.materials.is_empty() || b.mesh.materials.iter().any(lit);
    scene.lights.iter().any(|l| l.kind.casts_shadows()) && scene.bodies.iter().any(is_lit)
}
