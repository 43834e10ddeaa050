use super::basis::{Beyond, reflectances};
use super::observer::{VISIBLE_NM, matching, matching_at, rgb_from_xyz};
use super::shape::{SIGMA, Shape, Spectrum, SpectrumError};
use super::tabulated::Tabulated;
use glam::DVec3;

/// Columns: the linear sRGB seen of a surface that is red, green, blue.
pub type Matrix = [[f64; 3]; 3];

/// What is seen of surfaces in the light of one spectrum, or that shine with it themselves, under any shifts.
#[derive(Clone, Debug)]
pub struct Response<'a> {
    spectrum: &'a Spectrum,
    /// The source's own colour: a filter before it.
    color: [f64; 3],
    /// What is assumed of surfaces outside the visible.
    beyond: Beyond,
    scale: f64,
    /// Every which nanometre is looked at.
    stride: usize,
}

/// Nanometres between those that are looked at.
const COARSE: usize = 3;

impl<'a> Response<'a> {
    /// Of a source behind a filter of a colour (1, 1, 1 for none), and surfaces of which `beyond` is assumed.
    ///
    /// # Errors
    /// If the spectrum cannot be.
    pub fn new(spectrum: &'a Spectrum, color: [f32; 3], beyond: Beyond) -> Result<Self, SpectrumError> {
        Ok(Self { spectrum, color: color.map(f64::from), beyond, scale: spectrum.scale()?, stride: 1 })
    }

    /// The same by sums over every third nanometre where the spectrum is smooth, good to 10⁻⁴: for tables of tables.
    #[must_use]
    pub fn coarse(self) -> Self {
        let smooth = !matches!(self.spectrum.shape, Shape::Line { .. } | Shape::Tabulated(_));
        Self { stride: if smooth { COARSE } else { 1 }, ..self }
    }

    /// Of surfaces that shine with the spectrum themselves.
    ///
    /// # Errors
    /// If the spectrum cannot be.
    pub fn of_own(spectrum: &'a Spectrum) -> Result<Self, SpectrumError> {
        Self::new(spectrum, [1.0; 3], spectrum.beyond)
    }

    /// Light of the source that reaches surfaces with the Doppler factor `lamp` (1 where they shine themselves), is
    /// reflected by them (or shone through their colour), and seen at `doppler`.
    ///
    /// By radiance: D⁵ I_λ for both shifts together. A rectangle sum over 360 … 830 nm as it is seen; lines are summed
    /// over their own profile, and tables from corner to corner.
    pub fn matrix(&self, lamp: f64, doppler: f64) -> Matrix {
        let Spectrum { shape, beyond, .. } = self.spectrum;
        let mut columns = [DVec3::ZERO; 3];
        let whole = lamp * doppler;
        if let Shape::Line { .. } = shape {
            let columns = [0, 1, 2].map(|i| {
                of_line(shape, lamp, doppler, |nm| self.filter(nm * lamp) * reflectances(nm, self.beyond)[i])
            });
            return columns.map(|xyz| (rgb_from_xyz(xyz) * self.scale).to_array());
        }
        let mut add = |nm: f64, light: f64, xyz: DVec3| {
            let light = light * self.filter(nm * whole);
            if light != 0.0 {
                for (column, share) in columns.iter_mut().zip(reflectances(nm * doppler, self.beyond)) {
                    *column += xyz * (light * share);
                }
            }
        };
        match shape {
            Shape::Tabulated(table) => of_table(table, *beyond, whole, &mut add),
            _ => {
                for (nm, xyz) in matching().step_by(self.stride) {
                    add(nm, self.stride as f64 * shape.at(nm * whole, *beyond), xyz);
                }
            }
        }
        let scale = self.scale * whole.powi(5);
        columns.map(|xyz| (rgb_from_xyz(xyz) * scale).to_array())
    }

    /// What the source's colour lets through.
    fn filter(&self, nm: f64) -> f64 {
        if self.color == [1.0; 3] && self.spectrum.beyond != Beyond::Dark {
            return 1.0;
        }
        let parts = reflectances(nm, self.spectrum.beyond);
        parts.iter().zip(self.color).map(|(part, color)| part * color).sum()
    }
}

/// Sums over a table as it is seen, shifted by `whole`: by Simpson's rule between all its corners and all nanometres. `add`
/// takes a wavelength as seen, light there times its share of nanometres, and the colour-matching functions.
pub(super) fn of_table(table: &Tabulated, beyond: Beyond, whole: f64, add: &mut impl FnMut(f64, f64, DVec3)) {
    let [first, last] = VISIBLE_NM;
    let mut corners: Vec<f64> = table.wavelengths(first * whole, last * whole).map(|nm| nm / whole).collect();
    corners.extend(matching().map(|(nm, _)| nm));
    corners.sort_unstable_by(f64::total_cmp);
    for ends in corners.windows(2) {
        let width = ends[1] - ends[0];
        let middle = 0.5 * (ends[0] + ends[1]);
        let light = [ends[0], middle, ends[1]].map(|nm| table.at(nm * whole, beyond));
        if width > 0.0 && light != [0.0; 3] {
            for ((nm, light), share) in [ends[0], middle, ends[1]].into_iter().zip(light).zip([1.0, 4.0, 1.0])
            {
                add(nm, light * share * width / 6.0, matching_at(nm));
            }
        }
    }
}

/// XYZ of a line by its own profile: the radiance of every part of it goes with D⁴. `filter` by wavelength at the
/// surface.
pub(crate) fn of_line(shape: &Shape, lamp: f64, doppler: f64, filter: impl Fn(f64) -> f64) -> DVec3 {
    let Shape::Line { centre_nm, width_nm } = shape else { return DVec3::ZERO };
    // Of a Gaussian a sum with steps of less than half its standard deviation is exact to 1e-8.
    const STEPS: i32 = 64;
    const REACH: f64 = 4.5;
    let (sigma, whole) = (width_nm * SIGMA, lamp * doppler);
    let step = REACH / f64::from(STEPS);
    let sum: DVec3 = (-STEPS..=STEPS)
        .map(|i| {
            let off = f64::from(i) * step;
            let source_nm = centre_nm + off * sigma;
            let height = (-0.5 * off * off).exp() * filter(source_nm / lamp);
            matching_at(source_nm / whole) * height
        })
        .sum();
    sum * (step * sigma * whole.powi(4))
}
