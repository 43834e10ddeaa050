//! How light is turned into colour.

/// What a pixel shows of the light it receives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Coloring {
    /// The surfaces' own colours, self-luminous, without Doppler shift and beaming (the paper's Figs. 2, 3).
    #[default]
    Geometry,
    /// The Doppler factor in false colour: white at D = 1, through blue to violet where it rises to 32,
    /// through red to black-red where it falls to 1/32.
    Doppler,
}

/// Octaves of D either way that false colour spans.
const OCTAVES: f64 = 5.0;

/// log₂D over [`OCTAVES`] and the linear sRGB colour there.
const SCALE: [(f64, [f32; 3]); 9] = [
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

impl Coloring {
    /// Linear sRGB seen of a surface with the colour `own` under the Doppler factor `doppler`.
    pub fn light(self, own: [f32; 3], doppler: f64) -> [f32; 3] {
        match self {
            Self::Geometry => own,
            Self::Doppler => false_color(doppler),
        }
    }
}

fn false_color(doppler: f64) -> [f32; 3] {
    let at = (doppler.log2() / OCTAVES).clamp(-1.0, 1.0);
    let above = SCALE.iter().position(|(stop, _)| at <= *stop).unwrap_or(SCALE.len() - 1).max(1);
    let ((from, a), (to, b)) = (SCALE[above - 1], SCALE[above]);
    let t = ((at - from) / (to - from)) as f32;
    [0, 1, 2].map(|i| a[i] + t * (b[i] - a[i]))
}

/// The linear value of an 8-bit sRGB component (IEC 61966-2-1).
pub fn linear(encoded: u8) -> f32 {
    let v = f32::from(encoded) / 255.0;
    if v <= 0.040_45 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}

/// The 8-bit sRGB component of a linear value, clipped to 0 … 1; 0 for NaN.
pub fn encoded(linear: f32) -> u8 {
    // A cast of NaN is 0.
    let v = linear.clamp(0.0, 1.0);
    let encoded = if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 };
    (255.0 * encoded + 0.5) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blue_comes_towards_us_and_red_goes_away() {
        let at = |d| Coloring::Doppler.light([0.0; 3], d);
        assert_eq!(at(1.0), [0.9; 3]);
        assert!(at(2.0)[2] > 2.0 * at(2.0)[0]);
        assert!(at(0.5)[0] > 2.0 * at(0.5)[2]);
        assert_eq!(at(1e9), at(32.0));
        assert_eq!(at(1e-9), at(1.0 / 32.0));
        assert_eq!(Coloring::Geometry.light([0.1, 0.2, 0.3], 7.0), [0.1, 0.2, 0.3]);
    }

    #[test]
    fn srgb_there_and_back() {
        for v in 0..=255u8 {
            assert_eq!(encoded(linear(v)), v);
        }
        assert_eq!(encoded(f32::NAN), 0);
        assert_eq!(encoded(7.0), 255);
        assert_eq!(encoded(-1.0), 0);
    }
}
