use super::constants::{EFFICACY, PRIMARIES, WHITE};
use super::cubic::cubic;
use super::shape::planck;
use glam::{DMat3, DVec3};
use std::sync::LazyLock;

/// First and last wavelength of the colour-matching functions, nanometres; outside nothing is seen.
pub(super) const VISIBLE_NM: [f64; 2] = [360.0, 830.0];

/// How many wavelengths there are, one a nanometre.
pub(super) const LINES: usize = 471;

/// x̄, ȳ, z̄ of the CIE 1931 standard observer (2°) from 360 to 830 nm by 1 nm.
static MATCHING: LazyLock<Vec<DVec3>> = LazyLock::new(|| {
    include_str!("../../assets/color/cie1931_2deg_1nm.csv")
        .lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| {
            let mut values = line.split(',').skip(1).map(|v| v.parse().expect("a number"));
            let mut next = || values.next().expect("three numbers a line");
            DVec3::new(next(), next(), next())
        })
        .collect()
});

/// Wavelengths and colour-matching functions.
pub(super) fn matching() -> impl Iterator<Item = (f64, DVec3)> {
    MATCHING.iter().enumerate().map(|(i, xyz)| (VISIBLE_NM[0] + i as f64, *xyz))
}

/// x̄, ȳ, z̄ at a wavelength, by a cubic between the nanometres.
///
/// Beyond the table's ends, where they are at most 6·10⁻⁴, they fade by a tenth a nanometre, about as they do there, and
/// more, until after a hundred they are gone: a line that leaves the visible is not switched off.
pub(crate) fn matching_at(nm: f64) -> DVec3 {
    let place = nm - VISIBLE_NM[0];
    let away = (-place).max(place - (LINES - 1) as f64);
    if away > 0.0 {
        let edge = if place < 0.0 { MATCHING[0] } else { MATCHING[LINES - 1] };
        return edge * (-0.1 * away).exp() * (1.0 - away / 100.0).max(0.0).powi(3);
    }
    let low = (place as usize).clamp(1, LINES - 3);
    let weights = cubic(place - low as f64);
    weights.iter().zip(&MATCHING[low - 1..low + 3]).map(|(w, xyz)| *xyz * *w).sum()
}

fn from_chromaticity([x, y]: [f64; 2]) -> DVec3 {
    DVec3::new(x / y, 1.0, (1.0 - x - y) / y)
}

/// CIE XYZ of linear sRGB, Y = 1 for white: from the chromaticities of its primaries and of D65, to full precision.
pub static XYZ_FROM_RGB: LazyLock<DMat3> = LazyLock::new(|| {
    let [r, g, b] = PRIMARIES.map(from_chromaticity);
    let primaries = DMat3::from_cols(r, g, b);
    let scale = primaries.inverse() * from_chromaticity(WHITE);
    DMat3::from_cols(r * scale.x, g * scale.y, b * scale.z)
});

static RGB_FROM_XYZ: LazyLock<DMat3> = LazyLock::new(|| XYZ_FROM_RGB.inverse());

/// Linear sRGB (D65 white, no adaptation) of CIE XYZ; negative where sRGB does not have the colour.
pub fn rgb_from_xyz(xyz: DVec3) -> DVec3 {
    *RGB_FROM_XYZ * xyz
}

/// Luminance Y of linear sRGB.
pub fn luminance(rgb: [f32; 3]) -> f32 {
    // The second row of XYZ_FROM_RGB, to f32.
    0.212_639 * rgb[0] + 0.715_168_7 * rgb[1] + 0.072_192_32 * rgb[2]
}

/// XYZ in cd/m² (Y is luminance) of a black body of that temperature: 683 lm/W times the sum over 360 … 830 nm, one
/// line a nanometre.
///
/// Seen at a Doppler factor D it is the black body of D times the temperature, in every respect.
pub fn xyz_of_black_body(kelvin: f64) -> DVec3 {
    EFFICACY * 1e-9 * matching().map(|(nm, xyz)| xyz * planck(nm, kelvin)).sum::<DVec3>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_is_white() {
        assert_eq!(MATCHING.len(), LINES);
        let white = rgb_from_xyz(from_chromaticity(WHITE));
        assert!((white - DVec3::ONE).length() < 1e-14, "{white}");
        let y = XYZ_FROM_RGB.row(1);
        let rgb = [0.2, 0.5, 0.9];
        let exact = y.dot(DVec3::from_array(rgb.map(f64::from)));
        assert!((f64::from(luminance(rgb)) - exact).abs() < 1e-6);
        assert!((matching_at(350.0) / MATCHING[0] - DVec3::splat((-1f64).exp() * 0.729)).length() < 1e-12);
        assert_eq!(matching_at(259.0), DVec3::ZERO);
        assert_eq!(matching_at(f64::INFINITY), DVec3::ZERO);
        assert_eq!(matching_at(830.0), MATCHING[470]);
        assert_eq!(matching_at(500.0), MATCHING[140]);
        // The curves bend by less than that over a nanometre.
        assert!((matching_at(555.5) - 0.5 * (MATCHING[195] + MATCHING[196])).length() < 1e-3);
    }
}
