use super::ambient::Bath;
use super::incidence::{Incidence, NearLight, rapidity};
use super::{ambient, gloss};
use crate::color::{Coloring, false_color};
use crate::relativity::Motion;
use crate::scene::{Colors, EmissionLaw, Gloss, Light, Material, Scene};
use crate::spectrum::{Beyond, DopplerTable, Response, RowTable, Spectrum, SpectrumError, luminance};
use glam::DVec3;
use std::sync::Arc;
use terrell_geodesic::Tetrad;

/// How the surfaces of a scene shine and are lit, each body in its own rest frame: made once a scene.
///
/// Nothing here depends on where the observer is, only, by the range of its tables, on how fast. Tables are shared
/// between all that have the same spectrum.
#[derive(Clone, Debug)]
pub struct Shading {
    coloring: Coloring,
    doppler_at: DopplerAt,
    lights: Vec<SceneLight>,
    bodies: Vec<BodyShading>,
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
struct SceneLight {
    light: Light,
    /// Linear sRGB unshifted.
    color: [f32; 3],
}

#[derive(Clone, Debug)]
struct BodyShading {
    motion: Motion,
    materials: Vec<MaterialShading>,
    /// One a light.
    incidences: Vec<Incidence>,
}

#[derive(Clone, Debug)]
struct MaterialShading {
    lit: bool,
    law: EmissionLaw,
    gloss: Gloss,
    /// Unshifted colours of what shines in red, green and blue; none where these are themselves.
    unshifted: Option<[f32; 9]>,
    /// Of what it shines with.
    own: Option<Arc<DopplerTable>>,
    /// Of what it reflects, one a light; empty without colours of spectra.
    reflected: Vec<Arc<RowTable>>,
}

/// What a table of colours is of, and how good it is.
#[derive(Clone, Debug, PartialEq)]
pub struct TableInfo {
    /// The spectrum, in words.
    pub spectrum: String,
    /// What is assumed of colours outside the visible.
    pub beyond: Beyond,
    /// How many matrices it has.
    pub nodes: usize,
    /// The greatest error between them, of the greatest number there.
    pub error: f64,
}

/// A spectrum that cannot be, and whose it is.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{name}: {source}")]
pub struct ShadingError {
    /// Whose.
    pub name: String,
    /// Why.
    pub source: SpectrumError,
}

/// A point of a surface in its body's rest frame. All vectors but `offset` are unit vectors.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// From the observer's event to it, in space; as long ago as it is far away.
    pub offset: DVec3,
    /// The surface's normal, on the side the observer sees.
    pub normal: DVec3,
}

impl Point {
    /// A point whose mesh has the normal `normal`, on a surface that lies square to `facing`: both are turned so that the
    /// observer sees the surface's side they are on.
    pub fn new(offset: DVec3, facing: DVec3, normal: DVec3) -> Self {
        let facing = if facing.dot(offset) > 0.0 { -facing } else { facing };
        let normal = if normal.dot(facing) < 0.0 { -normal } else { normal };
        Self { offset, normal: normal.normalize_or(facing.normalize_or(DVec3::Z)) }
    }

    /// The direction the light leaves in.
    fn to_eye(self) -> DVec3 {
        -self.offset.normalize_or(DVec3::Z)
    }
}

/// Of what a table is.
#[derive(Clone, Debug, PartialEq)]
struct Key {
    spectrum: Spectrum,
    color: [f32; 3],
    beyond: Beyond,
    way: Way,
}

/// How light reaches surfaces; numbers as their bits, so that equal is equal.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Way {
    Distant(u64),
    Near(u64),
    Ambient(u64),
}

/// Tables made so far.
#[derive(Default)]
struct Tables {
    /// How far |ln D| goes.
    range: f64,
    own: Vec<(Spectrum, Arc<DopplerTable>)>,
    reflected: Vec<(Key, Arc<RowTable>)>,
    infos: Vec<TableInfo>,
}

impl Tables {
    fn own(&mut self, spectrum: &Spectrum) -> Result<Arc<DopplerTable>, SpectrumError> {
        if let Some((_, table)) = self.own.iter().find(|(known, _)| known == spectrum) {
            return Ok(table.clone());
        }
        let response = Response::of_own(spectrum)?;
        let table = Arc::new(DopplerTable::new(self.range, |d| response.matrix(1.0, d)));
        self.own.push((spectrum.clone(), table.clone()));
        self.infos.push(TableInfo {
            spectrum: spectrum.shape.describe(),
            beyond: spectrum.beyond,
            nodes: table.nodes(),
            error: table.error(),
        });
        Ok(table)
    }

    fn reflected(
        &mut self,
        light: &Light,
        body: &Motion,
        incidence: &Incidence,
        beyond: Beyond,
    ) -> Result<Arc<RowTable>, SpectrumError> {
        let rapidity = rapidity(&light.motion, body);
        let way = match incidence {
            Incidence::Distant { doppler, .. } => Way::Distant(doppler.to_bits()),
            Incidence::Near => Way::Near(rapidity.to_bits()),
            Incidence::Ambient { .. } => Way::Ambient(rapidity.to_bits()),
        };
        let key = Key { spectrum: light.spectrum.clone(), color: light.color, beyond, way };
        if let Some((_, table)) = self.reflected.iter().find(|(known, _)| *known == key) {
            return Ok(table.clone());
        }
        let response = Response::new(&light.spectrum, light.color, beyond)?;
        let (range, coarse) = (self.range, response.clone().coarse());
        let table = match incidence {
            Incidence::Distant { doppler, .. } => {
                RowTable::single(DopplerTable::new(range, |d| response.matrix(*doppler, d)))
            }
            Incidence::Near => RowTable::by_lamp(rapidity, range, |lamp, d| coarse.matrix(lamp, d)),
            Incidence::Ambient { .. } => {
                bath_table(&Bath::new(rapidity), range, |lamp, d| coarse.matrix(lamp, d))
            }
        };
        let table = Arc::new(table);
        self.reflected.push((key, table.clone()));
        self.infos.push(TableInfo {
            spectrum: format!("{} of the light '{}'", light.spectrum.shape.describe(), light.name),
            beyond,
            nodes: table.nodes(),
            error: table.error(),
        });
        Ok(table)
    }
}

/// By cos ψ: sums over rings of what comes with one shift.
fn bath_table(
    bath: &Bath,
    range: f64,
    matrix: impl Fn(f64, f64) -> crate::spectrum::Matrix + Sync,
) -> RowTable {
    if bath.is_still() {
        let around = |d: f64| matrix(1.0, d).map(|column| column.map(|v| v * std::f64::consts::PI));
        return RowTable::single(DopplerTable::new(range, around));
    }
    let rings = bath.rings(64);
    let model = RowTable::model(rings[0].doppler.ln(), range, &matrix);
    let shifted: Vec<DopplerTable> =
        rings.iter().map(|ring| model.alike(|d| matrix(ring.doppler, d))).collect();
    let row = |cos_psi: f64| {
        let shares: Vec<f64> = rings.iter().map(|ring| ring.share(cos_psi.clamp(-1.0, 1.0))).collect();
        model.alike(|d| {
            let mut sum = [[0.0; 3]; 3];
            for (table, share) in shifted.iter().zip(&shares) {
                for (k, v) in table.at(d.ln()).into_iter().enumerate() {
                    sum[k / 3][k % 3] += share * f64::from(v);
                }
            }
            sum
        })
    };
    RowTable::evenly([-1.0, 1.0], 33, row)
}

/// Colours unshifted in light of a spectrum; none where they are themselves.
fn unshifted(spectrum: &Spectrum) -> Result<Option<[f32; 9]>, SpectrumError> {
    if *spectrum == (Spectrum { beyond: spectrum.beyond, ..Spectrum::default() }) {
        return Ok(None);
    }
    let [r, g, b] = Response::of_own(spectrum)?.matrix(1.0, 1.0).map(|c| c.map(|v| v as f32));
    Ok(Some([r[0], r[1], r[2], g[0], g[1], g[2], b[0], b[1], b[2]]))
}

fn times(matrix: &Option<[f32; 9]>, own: [f32; 3]) -> [f32; 3] {
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
        Self::within(scene, bodies + observers, coloring)
    }

    /// Of a scene whose bodies have relative rapidities of at most `range` to whoever looks.
    ///
    /// # Errors
    /// If a spectrum cannot be.
    pub fn within(scene: &Scene, range: f64, coloring: Coloring) -> Result<Self, ShadingError> {
        let mut tables = Tables { range, ..Tables::default() };
        let plain = [Material::default()];
        let lights = scene
            .lights
            .iter()
            .map(|light| {
                let fault = |source| ShadingError { name: format!("light '{}'", light.name), source };
                let color = times(&unshifted(&light.spectrum).map_err(fault)?, light.color);
                Ok(SceneLight { light: light.clone(), color: color.map(|v| v.max(0.0)) })
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
                        unshifted: unshifted(&material.spectrum).map_err(fault)?,
                        own: own.transpose().map_err(fault)?,
                        reflected,
                    })
                })
                .collect::<Result<_, ShadingError>>()?;
            bodies.push(BodyShading { motion: body.motion, materials, incidences });
        }
        Ok(Self { coloring, doppler_at: DopplerAt::default(), lights, bodies, tables: tables.infos })
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
        SeenShading { shading: self, near: self.bodies.iter().map(near).collect() }
    }
}

/// A [`Shading`] as one observer sees it at one moment.
#[derive(Clone, Debug)]
pub struct SeenShading<'a> {
    shading: &'a Shading,
    /// By body and light.
    near: Vec<Vec<Option<NearLight>>>,
}

impl SeenShading<'_> {
    /// Where the Doppler factor is to be worked out.
    pub fn doppler_at(&self) -> DopplerAt {
        self.shading.doppler_at
    }

    /// Linear sRGB radiance, in units of the film's white, of a point of a body that is seen with the Doppler factor
    /// `doppler`: its material by number, its colours and its place, which are asked for only if they matter.
    #[inline]
    pub fn radiance(
        &self,
        body: usize,
        material: usize,
        doppler: f64,
        colors: impl FnOnce() -> Colors,
        point: impl FnOnce() -> Point,
    ) -> [f32; 3] {
        let coloring = self.shading.coloring;
        if coloring == Coloring::Doppler {
            return finite(false_color(doppler));
        }
        let material = &self.shading.bodies[body].materials[material];
        let colors = colors();
        if !material.lit && material.law == EmissionLaw::Isotropic {
            return finite(material.shines(coloring, doppler, colors.sum()));
        }
        finite(self.at_point(body, material, doppler, colors, &point()))
    }

    fn at_point(
        &self,
        body: usize,
        material: &MaterialShading,
        doppler: f64,
        colors: Colors,
        point: &Point,
    ) -> [f32; 3] {
        let coloring = self.shading.coloring;
        let shines = if material.lit { colors.emission } else { colors.sum() };
        let mut sum = [0.0; 3];
        if shines != [0.0; 3] {
            let law = material.law.factor(point.normal.dot(point.to_eye()));
            sum = material.shines(coloring, doppler, shines).map(|v| v * law as f32);
        }
        if material.lit {
            for index in 0..self.shading.lights.len() {
                let more = self.reflected(body, material, index, doppler, colors.base, point);
                sum = [0, 1, 2].map(|i| sum[i] + more[i]);
            }
        }
        sum
    }

    /// Light of one of the lights, reflected.
    fn reflected(
        &self,
        body: usize,
        material: &MaterialShading,
        index: usize,
        doppler: f64,
        base: [f32; 3],
        point: &Point,
    ) -> [f32; 3] {
        let SceneLight { light, color } = &self.shading.lights[index];
        let lobe = |to_light| gloss::reflected(base, &material.gloss, point.normal, to_light, point.to_eye());
        let arriving = match &self.shading.bodies[body].incidences[index] {
            Incidence::Distant { to_light, doppler: lamp } => {
                Some(Arriving::at(*lamp, light.strength, lobe(*to_light)))
            }
            Incidence::Near => self.near[body][index]
                .as_ref()
                .and_then(|near| near.at(light, point))
                .map(|arrival| Arriving::at(arrival.doppler, arrival.irradiance, lobe(arrival.to_light))),
            Incidence::Ambient { axis, irradiance } => Some(Arriving::around(
                axis.dot(point.normal),
                light.strength,
                irradiance,
                &material.gloss,
                base,
            )),
        };
        let Some(arriving) = arriving.filter(|a| a.factors != [0.0; 3]) else { return [0.0; 3] };
        match self.shading.coloring {
            Coloring::Spectral => {
                let Some(table) = material.reflected.get(index) else { return [0.0; 3] };
                let own = arriving.factors.map(|v| v as f32);
                let seen = table.color(arriving.row, ln(doppler), own);
                seen.map(|v| (f64::from(v) * arriving.spectral) as f32)
            }
            coloring => {
                let own = [0, 1, 2].map(|i| (arriving.factors[i] * f64::from(color[i])) as f32);
                let strength = match coloring {
                    Coloring::Flat => arriving.flat,
                    Coloring::Bolometric => arriving.bolometric,
                    _ => arriving.unshifted,
                };
                let seen = beamed(coloring, doppler, own);
                seen.map(|v| (f64::from(v) * strength) as f32)
            }
        }
    }
}

/// Light that reaches a surface and is reflected: colour factors, and how strong it is by what is counted.
struct Arriving {
    factors: [f64; 3],
    /// As if there were no shift.
    unshifted: f64,
    /// Frequency by frequency, of spectra flat in ν.
    flat: f64,
    /// Over all frequencies.
    bolometric: f64,
    /// What the table's radiance is to be multiplied by.
    spectral: f64,
    /// Place in the table.
    row: f64,
}

impl Arriving {
    /// From one direction: E′_ν = D E_ν. Radiance goes with D³, but from an angle smaller by D².
    fn at(lamp: f64, irradiance: f64, factors: [f64; 3]) -> Self {
        let square = lamp * lamp;
        Self {
            factors,
            unshifted: irradiance,
            flat: irradiance * lamp,
            bolometric: irradiance * square,
            spectral: irradiance / square,
            row: lamp.ln(),
        }
    }

    fn around(
        cos_psi: f64,
        radiance: f64,
        irradiance: &ambient::Irradiance,
        gloss: &Gloss,
        base: [f32; 3],
    ) -> Self {
        use std::f64::consts::PI;
        let [flat, bolometric] = irradiance.at(cos_psi);
        Self {
            factors: gloss::albedo(base, gloss).map(|v| v / PI),
            unshifted: radiance * PI,
            flat: radiance * flat,
            bolometric: radiance * bolometric,
            spectral: radiance,
            row: cos_psi,
        }
    }
}

impl MaterialShading {
    /// What is seen of the surface's own light of the colour `own`.
    #[inline]
    fn shines(&self, coloring: Coloring, doppler: f64, own: [f32; 3]) -> [f32; 3] {
        match (&self.own, coloring) {
            (Some(table), Coloring::Spectral) => table.color(ln(doppler), own),
            _ => beamed(coloring, doppler, times(&self.unshifted, own)),
        }
    }
}

/// Of a Doppler factor, as exact as tables need: a few 10⁻⁷.
#[inline]
fn ln(doppler: f64) -> f64 {
    f64::from((doppler as f32).ln())
}

/// Beaming without colour: I_ν/ν³ is invariant (Nollert et al. 2000, Eq. 5), so a spectrum flat in ν is D³ times as
/// bright, and all frequencies together D⁴.
#[inline]
fn beamed(coloring: Coloring, doppler: f64, unshifted: [f32; 3]) -> [f32; 3] {
    match coloring {
        Coloring::Flat => {
            let cube = (doppler * doppler * doppler) as f32;
            unshifted.map(|v| v * cube)
        }
        Coloring::Bolometric => [luminance(unshifted) * (doppler * doppler).powi(2) as f32; 3],
        Coloring::Geometry | Coloring::Spectral | Coloring::Doppler => unshifted,
    }
}

/// What can be averaged and written.
#[inline]
fn finite(color: [f32; 3]) -> [f32; 3] {
    const MOST: f32 = 1e35;
    // NaN becomes the least, and is taken out first.
    color.map(|v| if v.is_nan() { 0.0 } else { v.clamp(-MOST, MOST) })
}

/// Whether lights stand somewhere, so that what they light has shadows, which are not drawn.
pub fn has_near_lights(scene: &Scene) -> bool {
    let lit = |m: &Material| m.is_lit(true);
    let is_lit = |b: &crate::scene::Body| b.mesh.materials.is_empty() || b.mesh.materials.iter().any(lit);
    scene.lights.iter().any(|l| l.kind.is_near()) && scene.bodies.iter().any(is_lit)
}
