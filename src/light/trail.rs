use super::shading::times;
use crate::color::Coloring;
use crate::spectrum::{Beyond, Shape, Spectrum, matching_at, of_line, reflectances, rgb_from_xyz};
use glam::DVec3;

/// Wavelengths a path is looked at.
const WAVELENGTHS: usize = 24;

/// First and last, nanometres, as they are seen.
const SEEN_NM: [f64; 2] = [360.0, 830.0];

/// What light meets on its way to the observer, from the observer on: surfaces that reflect it, each seen at a Doppler
/// factor of its own.
///
/// Spectra are not colours: what two surfaces leave of a third's light depends on every wavelength at each of them.
/// So light is followed at some wavelengths, as they are *seen*: chosen by chance, one in each of as many parts of the
/// visible, so that their mean is right. On a surface seen at D the light of the wavelength λ has λ·D; a spectrum emitted
/// is seen as D⁵ I_λ(λ·D), and lines, which no choice would meet, by their own profile.
#[derive(Clone, Debug)]
pub(crate) struct Trail {
    coloring: Coloring,
    surfaces: Vec<Reflection>,
    wavelengths: [f64; WAVELENGTHS],
}

#[derive(Clone, Copy, Debug)]
struct Reflection {
    /// From the surface to the observer.
    doppler: f64,
    /// What is reflected of red, green and blue.
    factors: [f64; 3],
    beyond: Beyond,
}

/// Light where it begins.
pub(crate) struct Source<'a> {
    pub spectrum: &'a Spectrum,
    /// See [`Spectrum::scale`].
    pub scale: f64,
    /// A filter before it, or the surface's own colour.
    pub color: [f64; 3],
    /// Without spectra, what its colour is multiplied by.
    pub unshifted: &'a Option<[f32; 9]>,
    /// How much of it there is for [`Coloring::Bolometric`], over all wavelengths.
    pub strength: f64,
    /// From there to the observer.
    pub doppler: f64,
}

impl Trail {
    /// Of light nothing has reflected yet; `random` is between 0 and 1.
    pub fn new(coloring: Coloring, random: f64) -> Self {
        let part = (SEEN_NM[1] - SEEN_NM[0]) / WAVELENGTHS as f64;
        let wavelengths = std::array::from_fn(|i| SEEN_NM[0] + part * (i as f64 + random));
        Self { coloring, surfaces: Vec::new(), wavelengths }
    }

    /// Meets a surface that is seen at a Doppler factor, and reflects these factors of red, green and blue.
    pub fn meets(&mut self, doppler: f64, factors: [f64; 3], beyond: Beyond) {
        self.surfaces.push(Reflection { doppler, factors, beyond });
    }

    /// Leaves the surface met last.
    pub fn leave(&mut self) {
        self.surfaces.pop();
    }

    /// How much is left of light of the colour white, about.
    pub fn strength(&self) -> f64 {
        self.surfaces.iter().map(|s| s.factors.into_iter().fold(0.0, f64::max)).product()
    }

    /// Linear sRGB of a source's light after all that, as it is seen.
    pub fn seen(&self, source: &Source<'_>) -> [f64; 3] {
        let whole = source.doppler;
        if self.coloring == Coloring::Spectral {
            let xyz = self.spectral(source);
            return (rgb_from_xyz(xyz) * source.scale).to_array();
        }
        let own = match self.coloring {
            Coloring::Bolometric => source.color.map(|c| c * source.strength),
            _ => times(source.unshifted, source.color.map(|c| c as f32)).map(|c| f64::from(c.max(0.0))),
        };
        let left = |i: usize| own[i] * self.surfaces.iter().map(|s| s.factors[i]).product::<f64>();
        let left = [left(0), left(1), left(2)];
        match self.coloring {
            Coloring::Flat => left.map(|v| v * whole.powi(3)),
            Coloring::Bolometric => {
                [f64::from(crate::spectrum::luminance(left.map(|v| v as f32))) * whole.powi(4); 3]
            }
            _ => left,
        }
    }

    fn spectral(&self, source: &Source<'_>) -> DVec3 {
        let (whole, Spectrum { shape, beyond, .. }) = (source.doppler, source.spectrum);
        let left = |seen_nm: f64| {
            let own = share(source.color, seen_nm * whole, *beyond);
            self.surfaces.iter().fold(own, |l, s| l * share(s.factors, seen_nm * s.doppler, s.beyond))
        };
        if let Shape::Line { .. } = shape {
            return of_line(shape, 1.0, whole, |nm| left(nm / whole));
        }
        let part = (SEEN_NM[1] - SEEN_NM[0]) / WAVELENGTHS as f64;
        let sum: DVec3 = self
            .wavelengths
            .iter()
            .map(|&nm| matching_at(nm) * (shape.at(nm * whole, *beyond) * left(nm)))
            .sum();
        sum * (part * whole.powi(5))
    }
}

/// What a colour leaves of light of a wavelength.
fn share(color: [f64; 3], nm: f64, beyond: Beyond) -> f64 {
    if color[0] == color[1] && color[1] == color[2] && beyond != Beyond::Dark {
        return color[0];
    }
    reflectances(nm, beyond).iter().zip(color).map(|(part, color)| part * color).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::{Response, Strength};

    fn source<'a>(spectrum: &'a Spectrum, color: [f64; 3], doppler: f64) -> Source<'a> {
        let scale = spectrum.scale().unwrap();
        Source { spectrum, scale, color, unshifted: &None, strength: 1.0, doppler }
    }

    /// A source and one surface, against the exact sums.
    #[test]
    fn one_reflection_is_that_of_a_response() {
        for shape in [
            Shape::White,
            Shape::BlackBody { kelvin: 4000.0 },
            Shape::Line { centre_nm: 560.0, width_nm: 10.0 },
        ] {
            let spectrum = Spectrum { strength: Strength::Radiance(1.0), ..Spectrum::of(shape) };
            for (lamp, doppler) in [(1.0, 1.0), (1.2, 0.9), (0.7, 1.6)] {
                let color = [0.9, 0.4, 0.2];
                let response = Response::new(&spectrum, color, Beyond::Grey).unwrap();
                let matrix = response.matrix(lamp, doppler);
                let factors = [0.3, 0.6, 0.1];
                let expected = [0, 1, 2].map(|c| (0..3).map(|i| matrix[i][c] * factors[i]).sum::<f64>());
                let n = 200;
                let mut mean = [0.0; 3];
                for k in 0..n {
                    let mut trail = Trail::new(Coloring::Spectral, (f64::from(k) + 0.5) / f64::from(n));
                    trail.meets(doppler, factors, Beyond::Grey);
                    let seen = trail.seen(&source(&spectrum, color.map(f64::from), lamp * doppler));
                    mean = [0, 1, 2].map(|c| mean[c] + seen[c] / f64::from(n));
                }
                let peak = expected.iter().fold(0.0f64, |a, b| a.max(b.abs()));
                for c in 0..3 {
                    // Both are sums over wavelengths, a tenth of a nanometre and one apart.
                    assert!((mean[c] - expected[c]).abs() < 1e-3 * peak, "{mean:?} {expected:?}");
                }
            }
        }
    }

    #[test]
    fn without_spectra_colours_multiply() {
        let spectrum = Spectrum::default();
        for (coloring, power) in [(Coloring::Flat, 3), (Coloring::Geometry, 0)] {
            let mut trail = Trail::new(coloring, 0.5);
            trail.meets(1.5, [0.5, 0.2, 1.0], Beyond::Grey);
            trail.meets(2.0, [0.5, 0.5, 0.5], Beyond::Grey);
            let seen = trail.seen(&source(&spectrum, [1.0, 1.0, 0.5], 2.0));
            let expected = [0.25, 0.1, 0.25].map(|v| v * 2f64.powi(power));
            for c in 0..3 {
                assert!((seen[c] - expected[c]).abs() < 1e-7, "{seen:?}");
            }
            trail.leave();
            assert_eq!(trail.strength(), 1.0);
        }
    }
}
