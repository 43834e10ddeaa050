use super::basis::Beyond;
use super::constants::{BOLTZMANN, LIGHT, PLANCK, STEFAN_BOLTZMANN};
use super::observer::matching;
use super::tabulated::Tabulated;
use std::sync::Arc;

/// The light of a source in its rest frame: how it is spread over wavelengths, and how much of it there is.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// How it is spread.
    pub shape: Shape,
    /// How much there is.
    pub strength: Strength,
    /// What is assumed outside the visible of the colours it is filtered by.
    pub beyond: Beyond,
}

/// How light is spread over wavelengths.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// The white of linear sRGB, D65: a black body of 6549 K with a little more green, outside the visible, too.
    White,
    /// A black body.
    BlackBody {
        /// Temperature.
        kelvin: f64,
    },
    /// I_ν ∝ ν^exponent; 0 is flat in ν, the paper's simplest.
    PowerLaw {
        /// α of ν^α.
        exponent: f64,
    },
    /// One line.
    Line {
        /// Its middle.
        centre_nm: f64,
        /// Its full width at half its height; its profile is a Gaussian by wavelength.
        width_nm: f64,
    },
    /// As measured.
    Tabulated(Arc<Tabulated>),
}

/// How much light a spectrum has, in the units of the film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Strength {
    /// Luminance (CIE Y) unshifted: 1 is that of the film's white.
    Luminance(f64),
    /// Radiance over all wavelengths, in units of which 1 at 555 nm has luminance 1: for what is not seen unshifted.
    Radiance(f64),
}

impl Strength {
    /// The number, whatever it counts.
    pub fn value(self) -> f64 {
        match self {
            Self::Luminance(v) | Self::Radiance(v) => v,
        }
    }
}

/// A spectrum that cannot be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SpectrumError {
    /// A number that cannot be.
    #[error("{what} = {value} cannot be: it must lie between {least} and {most}")]
    Value {
        /// Which.
        what: &'static str,
        /// What was given.
        value: f64,
        /// The least there can be.
        least: f64,
        /// The most.
        most: f64,
    },
    /// Nothing of it is seen unshifted.
    #[error(
        "unshifted it is not seen (are wavelengths in nanometres?), so it has no luminance; say its radiance instead"
    )]
    NotSeen,
    /// Over all wavelengths there is no end of it.
    #[error("its radiance over all wavelengths is infinite; say its luminance instead")]
    Infinite,
}

impl Default for Spectrum {
    fn default() -> Self {
        Self { shape: Shape::White, strength: Strength::Luminance(1.0), beyond: Beyond::default() }
    }
}

/// Spectral radiance of a black body, W/m²/sr/m, at a wavelength in nanometres.
pub(super) fn planck(nm: f64, kelvin: f64) -> f64 {
    let metres = nm * 1e-9;
    let x = PLANCK * LIGHT / (metres * BOLTZMANN * kelvin);
    let square = metres * metres;
    // The same to rounding, and faster, where nothing cancels.
    let below = if x > 0.1 { x.exp() - 1.0 } else { x.exp_m1() };
    2.0 * PLANCK * LIGHT * LIGHT / (square * square * metres * below)
}

/// Temperature of the white's black body, how much more green, where, and how wide: found by
/// assets/color/make_basis.py so that its colour is D65's to 15 digits.
const WHITE_KELVIN: f64 = 6549.341498798749;
const WHITE_GREEN: f64 = 0.07685235921879185;
const WHITE_GREEN_NM: f64 = 540.0;
const WHITE_GREEN_WIDTH_NM: f64 = 50.0;

impl Shape {
    /// Flat in ν.
    pub const FLAT: Self = Self::PowerLaw { exponent: 0.0 };

    /// Spectral radiance by wavelength, to a factor.
    pub fn at(&self, nm: f64, beyond: Beyond) -> f64 {
        match self {
            Self::White => {
                let off = (nm - WHITE_GREEN_NM) / WHITE_GREEN_WIDTH_NM;
                let green = if off.abs() < 9.0 { WHITE_GREEN * (-0.5 * off * off).exp() } else { 0.0 };
                planck(nm, WHITE_KELVIN) * (1.0 + green)
            }
            Self::BlackBody { kelvin } => planck(nm, *kelvin),
            // By wavelength dν is dλ/λ².
            Self::PowerLaw { exponent } => (nm / 555.0).powf(-exponent - 2.0),
            Self::Line { centre_nm, width_nm } => {
                let off = (nm - centre_nm) / (width_nm * SIGMA);
                (-0.5 * off * off).exp()
            }
            Self::Tabulated(table) => table.at(nm, beyond),
        }
    }

    /// Over all wavelengths, in the unit of [`at`](Self::at) times nanometres; none where it is infinite.
    fn integral(&self, beyond: Beyond) -> Option<f64> {
        match self {
            // The green adds its Gaussian, whose curvature over it is below 1e-3 of the whole.
            Self::White => Some((100..40_000).map(|nm| self.at(f64::from(nm), beyond)).sum()),
            Self::BlackBody { kelvin } => {
                Some(STEFAN_BOLTZMANN * kelvin.powi(4) / std::f64::consts::PI * 1e9)
            }
            Self::PowerLaw { .. } => None,
            Self::Line { width_nm, .. } => Some(width_nm * SIGMA * std::f64::consts::TAU.sqrt()),
            Self::Tabulated(table) => (beyond != Beyond::Edge).then(|| table.integral()),
        }
    }

    /// What it is called in reports.
    pub fn describe(&self) -> String {
        match self {
            Self::White => "white".into(),
            Self::BlackBody { kelvin } => format!("black body of {kelvin} K"),
            Self::PowerLaw { exponent: 0.0 } => "flat".into(),
            Self::PowerLaw { exponent } => format!("power law, exponent {exponent}"),
            Self::Line { centre_nm, width_nm } => format!("line at {centre_nm} nm, {width_nm} nm wide"),
            Self::Tabulated(table) => format!("table {}", table.name),
        }
    }
}

/// Standard deviation of a Gaussian over its full width at half its height.
pub(super) const SIGMA: f64 = 0.424_660_900_144_009_5;

impl Spectrum {
    /// A shape of luminance 1; a line, which may be out of sight, of radiance 1.
    pub fn of(shape: Shape) -> Self {
        let strength = match shape {
            Shape::Line { .. } => Strength::Radiance(1.0),
            _ => Strength::Luminance(1.0),
        };
        Self { shape, strength, ..Self::default() }
    }

    /// What [`Shape::at`] is to be multiplied by, so that sums over the colour-matching functions, a nanometre each,
    /// are in units of the film.
    ///
    /// # Errors
    /// If numbers are out of range, or the strength has no meaning for the shape.
    pub fn scale(&self) -> Result<f64, SpectrumError> {
        let within = |what, value: f64, least: f64, most: f64| {
            if (least..=most).contains(&value) {
                Ok(())
            } else {
                Err(SpectrumError::Value { what, value, least, most })
            }
        };
        match &self.shape {
            Shape::BlackBody { kelvin } => within("blackbody_k", *kelvin, 0.1, 1e12)?,
            Shape::PowerLaw { exponent } => within("power_law", *exponent, -20.0, 20.0)?,
            Shape::Line { centre_nm, width_nm } => {
                within("line_nm", *centre_nm, 1e-3, 1e9)?;
                within("width_nm", *width_nm, 1e-6 * centre_nm, 0.3 * centre_nm)?;
            }
            Shape::White | Shape::Tabulated(_) => {}
        }
        match self.strength {
            Strength::Luminance(luminance) => {
                within("luminance", luminance, 0.0, 1e12)?;
                let unit: f64 = match &self.shape {
                    // A line may be finer than a nanometre.
                    Shape::Line { .. } => super::response::of_line(&self.shape, 1.0, 1.0, |_| 1.0).y,
                    Shape::Tabulated(table) => {
                        let mut sum = 0.0;
                        super::response::of_table(table, self.beyond, 1.0, &mut |_, light, xyz| {
                            sum += light * xyz.y;
                        });
                        sum
                    }
                    shape => matching().map(|(nm, xyz)| xyz.y * shape.at(nm, self.beyond)).sum(),
                };
                // Of a black body at room temperature a part in 10¹⁹ is seen.
                let whole = match &self.shape {
                    Shape::White => 0.0,
                    shape => shape.integral(self.beyond).unwrap_or(0.0),
                };
                if unit > 1e-12 * whole && unit > 0.0 && unit.is_finite() {
                    Ok(luminance / unit)
                } else {
                    Err(SpectrumError::NotSeen)
                }
            }
            Strength::Radiance(radiance) => {
                within("radiance", radiance, 0.0, 1e12)?;
                let whole = self.shape.integral(self.beyond).ok_or(SpectrumError::Infinite)?;
                Ok(radiance / whole)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_is_refused() {
        let scale = |shape| Spectrum::of(shape).scale();
        assert!(scale(Shape::BlackBody { kelvin: -3.0 }).is_err());
        assert!(scale(Shape::BlackBody { kelvin: f64::NAN }).is_err());
        assert_eq!(scale(Shape::BlackBody { kelvin: 2.7 }), Err(SpectrumError::NotSeen));
        assert!(scale(Shape::Line { centre_nm: 1e4, width_nm: 10.0 }).is_ok());
        assert!(scale(Shape::Line { centre_nm: 500.0, width_nm: 0.0 }).is_err());
        let strength = Strength::Radiance(1.0);
        let flat = Spectrum { shape: Shape::FLAT, strength, ..Spectrum::default() };
        assert_eq!(flat.scale(), Err(SpectrumError::Infinite));
        let cold = Spectrum { shape: Shape::BlackBody { kelvin: 2.7 }, ..flat };
        assert!(cold.scale().is_ok());
    }

    /// The integrals against sums of the shapes themselves.
    #[test]
    fn radiance_is_the_sum_over_all_wavelengths() {
        for shape in [
            Shape::BlackBody { kelvin: 6000.0 },
            Shape::Line { centre_nm: 600.0, width_nm: 5.0 },
            Shape::White,
        ] {
            let sum: f64 =
                (0..2_000_000).map(|i| shape.at(50.0 + 0.1 * f64::from(i), Beyond::Grey) * 0.1).sum();
            let integral = shape.integral(Beyond::Grey).unwrap();
            // The tail beyond 40 µm and 200 µm is below 1e-4.
            assert!((sum / integral - 1.0).abs() < 2e-4, "{shape:?} {sum} {integral}");
        }
    }
}
