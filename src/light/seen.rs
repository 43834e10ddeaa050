use super::ambient::Irradiance;
use super::incidence::{Incidence, NearLight};
use super::logarithm::ln;
use super::shading::{MaterialShading, SceneLight, times};
use super::{DopplerAt, Point, Shading, Source, gloss};
use crate::color::{Coloring, false_color};
use crate::scene::{Colors, EmissionLaw, Gloss, LightKind};
use crate::spectrum::{Beyond, DopplerTable, Near, Spectrum, luminance};
use glam::DVec3;
#[cfg(feature = "gpu")]
use std::sync::Arc;
use terrell_geodesic::{FourVector, Rest};

/// The way light came to a point of a surface, backwards.
#[derive(Clone, Copy, Debug)]
pub struct Approach {
    /// A null vector in the surface's rest frame, into the past: from the surface's event to the lamp's, or, for light
    /// from infinity, to where it came from.
    pub back: FourVector<Rest>,
    /// Whether it ends there.
    pub ends: bool,
}

/// Light that reaches a point.
pub(crate) struct Lighting<'a> {
    /// Where it comes from, a unit vector in the surface's rest frame.
    pub to_light: DVec3,
    /// ν at the surface over ν of the light.
    pub doppler: f64,
    spectrum: &'a Spectrum,
    /// As what there is of it: radiance times a solid angle, or radiance if it shines from everywhere.
    scale: f64,
    /// Without spectra, that, too.
    color: [f64; 3],
}

impl Lighting<'_> {
    /// As a source on a surface that is seen at a Doppler factor.
    pub fn source(&self, doppler: f64) -> Source<'_> {
        Source {
            spectrum: self.spectrum,
            scale: self.scale,
            color: self.color,
            unshifted: &None,
            strength: 1.0,
            doppler: self.doppler * doppler,
        }
    }
}

/// A material, as light meets it.
#[derive(Clone, Copy)]
pub(crate) struct SurfaceLight<'a> {
    coloring: Coloring,
    material: &'a MaterialShading,
}

impl<'a> SurfaceLight<'a> {
    /// Whether it reflects.
    pub fn is_lit(&self) -> bool {
        self.material.lit
    }

    pub fn gloss(&self) -> &'a Gloss {
        &self.material.gloss
    }

    /// What it shines with: unshifted colours where they are not themselves, the table of what is seen of it where there is
    /// one, how strong it is, and how that depends on direction.
    #[cfg(feature = "gpu")]
    pub fn shining(&self) -> (Option<[f32; 9]>, Option<&'a Arc<DopplerTable>>, f32, EmissionLaw) {
        let MaterialShading { unshifted, own, strength, law, .. } = self.material;
        (*unshifted, own.as_ref(), *strength, *law)
    }

    /// What is assumed of its colours outside the visible.
    pub fn beyond(&self) -> Beyond {
        self.material.spectrum.beyond
    }

    /// What it shines with, in a direction at this cosine to its normal, as a source that is seen at a Doppler factor; none
    /// if it does not.
    pub fn source(&self, colors: Colors, cosine: f64, doppler: f64) -> Option<Source<'a>> {
        let material = self.material;
        let own = if material.lit { colors.emission } else { colors.sum() };
        if own == [0.0; 3] || self.coloring == Coloring::Doppler {
            return None;
        }
        let law = material.law.factor(cosine);
        Some(Source {
            spectrum: &material.spectrum,
            scale: material.scale,
            color: own.map(|c| f64::from(c) * law),
            unshifted: &material.unshifted,
            strength: f64::from(material.strength),
            doppler,
        })
    }
}

/// A surface that shines by itself, alike in all directions, in one colour.
#[derive(Clone, Copy)]
pub(crate) struct Glow<'a> {
    coloring: Coloring,
    shift: Shift<'a>,
}

/// How what it shines with depends on the Doppler factor.
#[derive(Clone, Copy)]
enum Shift<'a> {
    /// By a table, and where that was looked at last.
    Table { table: &'a DopplerTable, own: [f32; 3], near: Near },
    /// By a power of it, from what there is without.
    Power([f32; 3]),
}

impl<'a> Shift<'a> {
    #[inline]
    fn new(material: &'a MaterialShading, coloring: Coloring, own: [f32; 3]) -> Self {
        match (&material.own, coloring) {
            (Some(table), Coloring::Spectral) => Self::Table { table, own, near: Near::default() },
            (_, Coloring::Bolometric) => Self::Power(own.map(|v| v * material.strength)),
            _ => Self::Power(times(&material.unshifted, own)),
        }
    }

    #[inline]
    fn at(&mut self, coloring: Coloring, doppler: f64, logarithm: impl FnOnce() -> f64) -> [f32; 3] {
        match self {
            Self::Table { table, own, near } => table.color_near(logarithm(), *own, near),
            Self::Power(unshifted) => beamed(coloring, doppler, *unshifted),
        }
    }
}

impl Glow<'_> {
    /// What of it is seen at a Doppler factor; its logarithm matters only for spectra.
    #[inline]
    pub fn radiance(&mut self, doppler: f64, logarithm: f64) -> [f32; 3] {
        finite(self.shift.at(self.coloring, doppler, || logarithm))
    }
}

/// A [`Shading`] as one observer sees it at one moment.
#[derive(Clone, Debug)]
pub struct SeenShading<'a> {
    shading: &'a Shading,
    /// By body and light.
    near: Vec<Vec<Option<NearLight>>>,
}

impl<'a> SeenShading<'a> {
    pub(super) fn new(shading: &'a Shading, near: Vec<Vec<Option<NearLight>>>) -> Self {
        Self { shading, near }
    }

    /// Where the Doppler factor is to be worked out.
    pub fn doppler_at(&self) -> DopplerAt {
        self.shading.doppler_at
    }

    /// How many lights there are.
    pub fn lights(&self) -> usize {
        self.shading.lights.len()
    }

    /// How a light reaches a body.
    pub(super) fn incidence(&self, body: usize, light: usize) -> &Incidence {
        &self.shading.bodies[body].incidences[light]
    }

    /// That of a light at a place, at this moment.
    pub(super) fn near(&self, body: usize, light: usize) -> Option<&NearLight> {
        self.near[body][light].as_ref()
    }

    /// How strong a light is.
    pub(super) fn strength(&self, light: usize) -> f64 {
        self.shading.lights[light].light.strength
    }

    /// All lights.
    pub(super) fn scene_lights(&self) -> &'a [SceneLight] {
        &self.shading.lights
    }

    /// A material of a body, by their numbers.
    pub(super) fn material(&self, body: usize, material: usize) -> &'a MaterialShading {
        &self.shading.bodies[body].materials[material]
    }

    /// Whether a light shines from everywhere.
    pub(crate) fn is_ambient(&self, light: usize) -> bool {
        matches!(self.shading.lights[light].light.kind, LightKind::Ambient)
    }

    /// What a pixel shows.
    pub fn coloring(&self) -> Coloring {
        self.shading.coloring
    }

    /// Whether a material of a body reflects light.
    pub fn is_lit(&self, body: usize, material: usize) -> bool {
        self.shading.bodies[body].materials[material].lit
    }

    /// The way back from a point of a body to a light; none where it does not shine onto the surface's side that is
    /// seen, or comes from everywhere.
    pub fn approach(&self, body: usize, light: usize, point: &Point) -> Option<Approach> {
        let (back, ends) = match &self.shading.bodies[body].incidences[light] {
            Incidence::Distant { to_light, .. } => (FourVector::seen_from(*to_light), false),
            Incidence::Near => {
                let near = self.near[body][light].as_ref()?;
                let arrival = near.at(&self.shading.lights[light].light, point)?;
                (arrival.back, arrival.irradiance > 0.0)
            }
            Incidence::Ambient { .. } => return None,
        };
        let reaches =
            point.normal.dot(back.xyz()) > 0.0 && (ends || !self.shading.lights[light].light.kind.is_near());
        reaches.then_some(Approach { back, ends })
    }

    /// Linear sRGB radiance, in units of the film's white, of a point of a body that is seen with the Doppler factor
    /// `doppler`: its material by number, its colours and its place, which are asked for only if they matter. There are no
    /// shadows.
    #[inline]
    pub fn radiance(
        &self,
        body: usize,
        material: usize,
        doppler: f64,
        colors: impl FnOnce() -> Colors,
        point: impl FnOnce() -> Point,
    ) -> [f32; 3] {
        self.radiance_with_shadows(body, material, doppler, colors, point, |_| true)
    }

    /// As [`radiance`](Self::radiance), with shadows: `reaches` says whether a light's way to the point is free.
    #[inline]
    pub fn radiance_with_shadows(
        &self,
        body: usize,
        material: usize,
        doppler: f64,
        colors: impl FnOnce() -> Colors,
        point: impl FnOnce() -> Point,
        reaches: impl Fn(usize) -> bool,
    ) -> [f32; 3] {
        let coloring = self.shading.coloring;
        if coloring == Coloring::Doppler {
            return finite(false_color(doppler));
        }
        let colors = colors();
        let material = self.material(body, material);
        if material.is_even() {
            return finite(material.shines(coloring, doppler, colors.sum()));
        }
        finite(self.at_point(body, material, doppler, colors, &point(), reaches))
    }

    /// Of a material that shines by itself, and alike in all directions, all there is to know.
    #[inline]
    pub(crate) fn glow(&self, body: usize, material: usize, colors: &Colors) -> Option<Glow<'a>> {
        let coloring = self.shading.coloring;
        let material = self.material(body, material);
        let even = coloring != Coloring::Doppler && material.is_even();
        even.then(|| Glow { coloring, shift: Shift::new(material, coloring, colors.sum()) })
    }

    /// Linear sRGB radiance, in units of the film's white, of a sky of a colour that is seen with a Doppler factor; of none,
    /// black.
    pub fn sky(&self, doppler: f64, color: [f32; 3]) -> [f32; 3] {
        match (&self.shading.sky, self.shading.coloring) {
            (None, _) => [0.0; 3],
            (_, Coloring::Doppler) => finite(false_color(doppler)),
            (Some(sky), coloring) => finite(sky.shines(coloring, doppler, color)),
        }
    }

    /// The sky in a colour, as a source that is seen with a Doppler factor; none if it is black, or is not there.
    pub(crate) fn sky_source(&self, color: [f32; 3], doppler: f64) -> Option<Source<'_>> {
        let sky = self.shading.sky.as_ref()?;
        (color != [0.0; 3] && self.shading.coloring != Coloring::Doppler).then(|| Source {
            spectrum: &sky.spectrum,
            scale: sky.scale,
            color: color.map(f64::from),
            unshifted: &sky.unshifted,
            strength: f64::from(sky.strength),
            doppler,
        })
    }

    /// A material of a body, for those who follow light further.
    pub(crate) fn surface(&self, body: usize, material: usize) -> SurfaceLight<'a> {
        SurfaceLight { coloring: self.shading.coloring, material: self.material(body, material) }
    }

    /// Light of one of the lights that reaches a point, if its way is free; of one that shines from everywhere, that from
    /// the direction `to_light`.
    pub(crate) fn arriving(
        &self,
        body: usize,
        light: usize,
        point: &Point,
        to_light: Option<DVec3>,
    ) -> Option<Lighting<'a>> {
        let SceneLight { light: of, scale, color } = &self.shading.lights[light];
        let (to_light, lamp, amount) = match (&self.shading.bodies[body].incidences[light], to_light) {
            (Incidence::Distant { to_light, doppler }, None) => (*to_light, *doppler, of.strength),
            (Incidence::Near, None) => {
                let arrival = self.near[body][light].as_ref()?.at(of, point)?;
                (arrival.to_light, arrival.doppler, arrival.irradiance)
            }
            // Radiance, not irradiance.
            (Incidence::Ambient { axis, rapidity, .. }, Some(to)) => {
                let (gamma, speed) = (rapidity.cosh(), rapidity.sinh());
                (to, 1.0 / (gamma - speed * axis.dot(to)), of.strength)
            }
            _ => return None,
        };
        let geometry = self.shading.coloring == Coloring::Geometry;
        let amount = match self.shading.bodies[body].incidences[light] {
            Incidence::Ambient { .. } => amount,
            // Radiance goes with D³, but from an angle smaller by D².
            _ if !geometry => amount / (lamp * lamp),
            _ => amount,
        };
        let spectral = self.shading.coloring == Coloring::Spectral;
        let (scale, color) = match spectral {
            true => (scale * amount, of.color.map(f64::from)),
            false => (1.0, color.map(|c| f64::from(c) * amount)),
        };
        Some(Lighting { to_light, doppler: lamp, spectrum: &of.spectrum, scale, color })
    }

    fn at_point(
        &self,
        body: usize,
        material: &MaterialShading,
        doppler: f64,
        colors: Colors,
        point: &Point,
        reaches: impl Fn(usize) -> bool,
    ) -> [f32; 3] {
        let coloring = self.shading.coloring;
        let shines = if material.lit { colors.emission } else { colors.sum() };
        let mut sum = [0.0; 3];
        if shines != [0.0; 3] {
            let law = material.law.factor(point.normal.dot(point.to_eye));
            sum = material.shines(coloring, doppler, shines).map(|v| v * law as f32);
        }
        if material.lit {
            for index in (0..self.lights()).filter(|&light| reaches(light)) {
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
        let SceneLight { light, color, .. } = &self.shading.lights[index];
        let lobe = |to_light| gloss::reflected(base, &material.gloss, point.normal, to_light, point.to_eye);
        let arriving = match &self.shading.bodies[body].incidences[index] {
            Incidence::Distant { to_light, doppler: lamp } => {
                Some(Arriving::at(*lamp, light.strength, lobe(*to_light)))
            }
            Incidence::Near => self.near[body][index]
                .as_ref()
                .and_then(|near| near.at(light, point))
                .map(|arrival| Arriving::at(arrival.doppler, arrival.irradiance, lobe(arrival.to_light))),
            Incidence::Ambient { axis, irradiance, .. } => Some(Arriving::around(
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
            row: ln(lamp),
        }
    }

    fn around(cos_psi: f64, radiance: f64, irradiance: &Irradiance, gloss: &Gloss, base: [f32; 3]) -> Self {
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
    /// Whether it only shines by itself, and alike in all directions.
    #[inline]
    fn is_even(&self) -> bool {
        !self.lit && self.law == EmissionLaw::Isotropic
    }

    /// What is seen of the surface's own light of the colour `own`.
    #[inline]
    fn shines(&self, coloring: Coloring, doppler: f64, own: [f32; 3]) -> [f32; 3] {
        Shift::new(self, coloring, own).at(coloring, doppler, || ln(doppler))
    }
}

/// Beaming without colour: I_ν/ν³ is invariant (Nollert et al. 2000, Eq. 5), so a spectrum flat in ν is D³ times as
/// bright, and all frequencies together D⁴.
#[inline]
pub(super) fn beamed(coloring: Coloring, doppler: f64, unshifted: [f32; 3]) -> [f32; 3] {
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
pub(super) fn finite(color: [f32; 3]) -> [f32; 3] {
    const MOST: f32 = 1e35;
    // NaN is 0.
    color.map(|v| if v.is_nan() { 0.0 } else { v.clamp(-MOST, MOST) })
}
