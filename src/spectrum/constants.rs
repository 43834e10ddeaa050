//! Constants of nature and of colorimetry, as of 2026-11.

/// Planck constant, J s (SI 2019, exact).
pub(super) const PLANCK: f64 = 6.626_070_15e-34;
/// Speed of light, m/s (exact).
pub(super) const LIGHT: f64 = 299_792_458.0;
/// Boltzmann constant, J/K (SI 2019, exact).
pub(super) const BOLTZMANN: f64 = 1.380_649e-23;
/// Luminous efficacy of 540 THz, lm/W (SI 2019, exact).
pub(super) const EFFICACY: f64 = 683.0;
/// Stefan–Boltzmann constant, W/m²/K⁴: 2π⁵k⁴/(15h³c²).
pub(super) const STEFAN_BOLTZMANN: f64 = 5.670_374_419_184_43e-8;

/// Chromaticities of the sRGB primaries (IEC 61966-2-1, Rec. 709).
pub(super) const PRIMARIES: [[f64; 2]; 3] = [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]];
/// Chromaticity of its white, D65.
pub(super) const WHITE: [f64; 2] = [0.3127, 0.3290];
