//! How light is turned into colour.

use std::sync::LazyLock;

/// What a pixel shows of the light it receives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Coloring {
    /// What the eye sees: spectra shifted and beamed (Nollert et al. 2000, Eq. 3 and 5).
    #[default]
    Spectral,
    /// Every spectrum taken for flat in ν, the paper's simplest: colours stay, brightness goes with D³.
    Flat,
    /// Radiance over all wavelengths, grey: it goes with D⁴. Unshifted it is the strength of the spectrum, as that says it (by
    /// radiance or by luminance), times the luminance of the colour before it.
    Bolometric,
    /// Without Doppler shift and beaming: surfaces' own colours (the paper's Figs. 2, 3); lights, if there are any, from
    /// where the surfaces meet them.
    Geometry,
    /// The Doppler factor in false colour: white at D = 1, through blue to violet where it rises to 32,
    /// through red to black-red where it falls to 1/32.
    Doppler,
}

impl Coloring {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Spectral, Self::Flat, Self::Bolometric, Self::Geometry, Self::Doppler];

    /// Whether brightness goes with the shift, so that a picture needs an exposure.
    pub fn is_beamed(self) -> bool {
        matches!(self, Self::Spectral | Self::Flat | Self::Bolometric)
    }
}

impl std::fmt::Display for Coloring {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Spectral => "spectral",
            Self::Flat => "flat",
            Self::Bolometric => "bolometric",
            Self::Geometry => "geometry",
            Self::Doppler => "doppler",
        })
    }
}

/// Octaves of D either way that false colour spans.
pub const OCTAVES: f64 = 5.0;

/// log₂D over [`OCTAVES`] and the linear sRGB colour there.
pub(crate) const SCALE: [(f64, [f32; 3]); 9] = [
    (-1.0, [0.05, 0.0, 0.0]),
    (-0.6, [0.35, 0.0, 0.01]),
    (-0.3, [0.9, 0.05, 0.02]),
    (-0.1, [1.0, 0.5, 0.25]),
    (0.0, [0.9, 0.9, 0.9]),
    (0.1, [0.4, 0.75, 1.0]),
    (0.3, [0.05, 0.25, 1.0]),
    (0.6, [0.15, 0.02, 0.6]),
    (1.0, [0.1, 0.0, 0.15]),
];

/// Linear sRGB that stands for a Doppler factor.
pub fn false_color(doppler: f64) -> [f32; 3] {
    let at = (doppler.log2() / OCTAVES).clamp(-1.0, 1.0);
    let above = SCALE.iter().position(|(stop, _)| at <= *stop).unwrap_or(SCALE.len() - 1).max(1);
    let ((from, a), (to, b)) = (SCALE[above - 1], SCALE[above]);
    let t = ((at - from) / (to - from)) as f32;
    [0, 1, 2].map(|i| a[i] + t * (b[i] - a[i]))
}

/// The linear value of an 8-bit sRGB component (IEC 61966-2-1).
pub fn linear(encoded: u8) -> f32 {
    linear_of(f32::from(encoded) / 255.0)
}

/// The linear value of an sRGB component between 0 and 1 (IEC 61966-2-1).
pub fn linear_of(v: f32) -> f32 {
    if v <= 0.040_45 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}

/// The 8-bit sRGB component of a linear value, clipped to 0 … 1; 0 for NaN.
pub fn encoded(linear: f32) -> u8 {
    ENCODING.of(linear)
}

/// [`encoded`] for many.
///
/// # Panics
/// If the slices differ in length.
pub(crate) fn encode(linear: &[f32], encoded: &mut [u8]) {
    assert_eq!(linear.len(), encoded.len());
    let encoding = &*ENCODING;
    for (linear, encoded) in linear.iter().zip(encoded) {
        *encoded = encoding.of(*linear);
    }
}

fn encoded_by_formula(linear: f32) -> u8 {
    // A cast of NaN is 0.
    let v = linear.clamp(0.0, 1.0);
    let encoded = if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 };
    (255.0 * encoded + 0.5) as u8
}

/// The formula as a table, as exact and many times as fast. For every 128th of an octave, in which at most one code begins:
/// the code before that in the upper 16 bits, and in the lower what, added to the lower 16 bits of a number, is carried into
/// them if it has got there.
struct Encoding([u32; 2048]);

/// Below it everything is code 0.
const DARKEST: f32 = 1.0 / 8192.0;

static ENCODING: LazyLock<Encoding> = LazyLock::new(|| {
    // Bits of positive floats are in the order of their values.
    let code = |bits: u32| u32::from(encoded_by_formula(f32::from_bits(bits)));
    let part = |step: u32| {
        let start = DARKEST.to_bits() + (step << 16);
        let (mut low, mut high) = (0, 1 << 16);
        // How far into it the code is the same as at its beginning.
        while low < high {
            let middle = (low + high) / 2;
            if code(start + middle) > code(start) { high = middle } else { low = middle + 1 }
        }
        (code(start) << 16) + ((1 << 16) - low)
    };
    let steps = (1f32.to_bits() - DARKEST.to_bits()) >> 16;
    Encoding(std::array::from_fn(|step| part((step as u32).min(steps))))
});

impl Encoding {
    #[inline(always)]
    fn of(&self, linear: f32) -> u8 {
        // NaN is as dark as can be.
        let v = if linear > DARKEST { linear } else { DARKEST };
        let v = if v < 1.0 { v } else { 1.0 };
        let place = v.to_bits() - DARKEST.to_bits();
        let part = self.0[(place >> 16) as usize % self.0.len()];
        ((part + (place & 0xffff)) >> 16) as u8
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blue_comes_towards_us_and_red_goes_away() {
        let at = false_color;
        assert_eq!(at(1.0), [0.9; 3]);
        assert!(at(2.0)[2] > 2.0 * at(2.0)[0]);
        assert!(at(0.5)[0] > 2.0 * at(0.5)[2]);
        assert_eq!(at(1e9), at(32.0));
        assert_eq!(at(1e-9), at(1.0 / 32.0));
    }

    #[test]
    fn srgb_there_and_back() {
        for v in 0..=255u8 {
            assert_eq!(encoded(linear(v)), v);
        }
        assert_eq!(encoded(f32::NAN), 0);
        assert_eq!(encoded(7.0), 255);
        assert_eq!(encoded(-1.0), 0);
        // The table is the formula, to the bit.
        for bits in (0..0x4000_0000u32).step_by(97) {
            let v = f32::from_bits(bits);
            assert_eq!(encoded(v), encoded_by_formula(v), "{v}");
        }
    }
}
