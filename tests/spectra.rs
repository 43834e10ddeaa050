//! Spectra, their shifts and their tables, against an independent reference and closed forms.

mod common;

use common::cases;
use glam::DVec3;
use std::sync::Arc;
use terrell::spectrum::{
    Beyond, DopplerTable, Matrix, Response, Shape, Spectrum, Strength, Tabulated, XYZ_FROM_RGB,
    xyz_of_black_body,
};

fn response(spectrum: &Spectrum) -> Response<'_> {
    Response::of_own(spectrum).unwrap()
}

/// What is seen of a white surface.
fn white(matrix: &Matrix) -> DVec3 {
    matrix.iter().map(|c| DVec3::from_array(*c)).sum()
}

#[test]
fn black_bodies_are_those_of_the_reference() {
    let cases = cases();
    for row in cases["blackbody"]["rows"].as_array().unwrap() {
        let doppler = row["D"].as_f64().unwrap();
        let expected = common::vec3(&row["XYZ"]);
        let xyz = xyz_of_black_body(6000.0 * doppler);
        // The reference has 16 digits; constants of nature are exact in both.
        assert!(((xyz - expected) / expected).abs().max_element() < 1e-6, "{doppler}: {xyz} {expected}");
        // Shifted by the general way it is the same, relative to the luminance unshifted.
        let spectrum = Spectrum::of(Shape::BlackBody { kelvin: 6000.0 });
        let rgb = white(&response(&spectrum).matrix(1.0, doppler));
        let expected = common::vec3(&row["linear_srgb"]);
        assert!((rgb - expected).length() < 1e-6 * expected.length(), "{doppler}: {rgb} {expected}");
        let table = DopplerTable::new(1.2, |d| response(&spectrum).matrix(1.0, d));
        if doppler.ln().abs() <= 1.2 {
            let seen = DVec3::from_array(table.color(doppler.ln(), [1.0; 3]).map(f64::from));
            let bound = 3.0 * DopplerTable::ERROR * expected.abs().max_element();
            assert!((seen - expected).abs().max_element() < bound, "{doppler}: {seen} {expected}");
        }
    }
}

#[test]
fn a_black_body_seen_shifted_is_a_hotter_or_colder_one() {
    let strength = Strength::Luminance(1.0);
    for kelvin in [900.0, 3000.0, 6000.0, 20_000.0] {
        let spectrum = Spectrum { shape: Shape::BlackBody { kelvin }, strength, beyond: Beyond::Grey };
        for doppler in [0.2, 0.5, 0.97, 1.0, 1.7, 4.36, 14.1] {
            let rgb = white(&response(&spectrum).matrix(1.0, doppler));
            let xyz = *XYZ_FROM_RGB * rgb;
            let expected = xyz_of_black_body(kelvin * doppler) / xyz_of_black_body(kelvin).y;
            // Rounding of sums of 471 terms, through the matrix to sRGB and back.
            assert!((xyz - expected).length() < 1e-12 * expected.length(), "{kelvin} {doppler}");
        }
    }
}

/// Brightness goes with D^(3 − α) for I_ν ∝ ν^α: D³ for one flat in ν.
#[test]
fn power_laws_have_their_exponents() {
    for exponent in [0.0, 1.0, -1.0, -2.0, 2.5] {
        let spectrum = Spectrum::of(Shape::PowerLaw { exponent });
        let at = |doppler: f64| white(&response(&spectrum).matrix(1.0, doppler));
        for doppler in [0.1f64, 0.5, 2.0, 9.0] {
            let expected = at(1.0) * doppler.powf(3.0 - exponent);
            assert!((at(doppler) - expected).length() < 1e-12 * expected.length(), "{exponent} {doppler}");
        }
        // Approaching over receding at 0.6c.
        if exponent == 0.0 {
            let ratio = at(2.0) / at(0.5);
            assert!((ratio - DVec3::splat(64.0)).length() < 1e-10, "{ratio}");
        }
    }
}

/// Over all wavelengths, by numerical integration of the spectrum as it is seen: radiance goes with D⁴, photons with
/// D³, and what is seen at one wavelength of a spectrum flat in λ with D⁵.
#[test]
fn radiance_photons_and_one_wavelength_have_their_exponents() {
    let shape = Shape::BlackBody { kelvin: 5000.0 };
    // I_λ(λ) = D⁵ I′_λ(Dλ), summed over λ, with and without λ (photons have an energy of 1/λ).
    let sums = |doppler: f64| {
        let mut sums = [0.0; 2];
        let steps = 40_000;
        for i in 0..steps {
            // By ln λ, from 10 nm to 1 mm: beyond there is less than 1e-7 of it.
            let x = (10f64).ln() + (1e5f64).ln() * (f64::from(i) + 0.5) / f64::from(steps);
            let nm = x.exp();
            let seen = doppler.powi(5) * shape.at(nm * doppler, Beyond::Grey) * nm;
            sums[0] += seen;
            sums[1] += seen * nm;
        }
        sums
    };
    let rest = sums(1.0);
    for doppler in [0.5, 2.0, 3.0] {
        let seen = sums(doppler);
        assert!((seen[0] / rest[0] / doppler.powi(4) - 1.0).abs() < 1e-6, "{doppler}");
        assert!((seen[1] / rest[1] / doppler.powi(3) - 1.0).abs() < 1e-5, "{doppler}");
    }
    // Flat in λ is ν⁻².
    let spectrum = Spectrum::of(Shape::PowerLaw { exponent: -2.0 });
    let at = |doppler: f64| white(&response(&spectrum).matrix(1.0, doppler));
    assert!((at(2.0) / at(1.0) / 32.0 - DVec3::ONE).length() < 1e-12);
}

#[test]
fn colours_unshifted_are_themselves() {
    for beyond in [Beyond::Grey, Beyond::Edge, Beyond::Dark] {
        let spectrum = Spectrum { beyond, ..Spectrum::default() };
        let matrix = response(&spectrum).matrix(1.0, 1.0);
        for (i, column) in matrix.iter().enumerate() {
            for (j, v) in column.iter().enumerate() {
                let expected = f64::from(u8::from(i == j));
                // The reflectances have 12 digits.
                assert!((v - expected).abs() < 1e-9, "{matrix:?}");
            }
        }
    }
}

#[test]
fn a_line_leaves_the_visible() {
    let line = Spectrum::of(Shape::Line { centre_nm: 589.0, width_nm: 2.0 });
    let at = |doppler: f64| white(&response(&line).matrix(1.0, doppler));
    // Yellow unshifted: red and green, no blue; its luminance is that of its wavelength.
    let xyz = *XYZ_FROM_RGB * at(1.0);
    // ȳ(589 nm) = 0.7696 in the standard's table.
    assert!((xyz.y - 0.7696).abs() < 1e-3, "{xyz}");
    // Seen at 555 nm the eye is most sensitive to it, and it is brighter by D⁴.
    let doppler: f64 = 589.0 / 555.0;
    let xyz = *XYZ_FROM_RGB * at(doppler);
    assert!((xyz.y / doppler.powi(4) - 1.0).abs() < 1e-3, "{xyz}");
    // Infrared or ultraviolet: nothing.
    assert!(at(589.0 / 850.0).length() < 1e-6);
    assert!(at(589.0 / 330.0).length() < 1e-3);
    assert!(at(589.0 / 250.0).length() < 1e-6);
    // Between, by a table: to its error, or to that of a thousandth of the greatest nearby.
    let table = DopplerTable::new(1.0, |d| response(&line).matrix(1.0, d));
    assert!(table.error() <= DopplerTable::ERROR, "{}", table.error());
    for i in 0..2000 {
        let x = -1.0 + f64::from(i) * 0.001;
        let (seen, exact) = (table.color(x, [1.0; 3]), at(x.exp()));
        let off = (DVec3::from_array(seen.map(f64::from)) - exact).abs().max_element();
        assert!(off <= 3.0 * DopplerTable::ERROR * exact.abs().max_element() + 3e-7, "{x} {seen:?} {exact}");
    }
}

/// The table against what it stands for, at places that are no nodes, over wide ranges. A cubic may be off by more at
/// other places than the middles that were looked at, but hardly by three times as much.
#[test]
fn tables_keep_their_error() {
    let green = Tabulated::parse("400,0\n500,0.2\n510,1\n520,0.9\n530,0.1\n700,0", "lamp").unwrap();
    let shapes = [
        Shape::White,
        Shape::BlackBody { kelvin: 2000.0 },
        Shape::FLAT,
        Shape::PowerLaw { exponent: -3.0 },
        Shape::Line { centre_nm: 656.3, width_nm: 20.0 },
        Shape::Tabulated(Arc::new(green)),
    ];
    for shape in shapes {
        for range in [0.3, 1.5, 3.0, 8.0] {
            let spectrum = Spectrum::of(shape.clone());
            let response = response(&spectrum);
            let table = DopplerTable::new(range, |d| response.matrix(1.0, d));
            // The corners of a table of measured values are corners of the colours.
            let most = if matches!(shape, Shape::Tabulated(_)) { 1e-3 } else { DopplerTable::ERROR };
            assert!(table.error() <= most, "{shape:?} {range}: {}", table.error());
            for i in 0..400 {
                let x = range * (2.0 * (f64::from(i) + 0.317) / 400.0 - 1.0);
                let exact = response.matrix(1.0, x.exp());
                let near =
                    [-0.6f64, -0.3, 0.0, 0.3, 0.6].map(|d| greatest(&response.matrix(1.0, (x + d).exp())));
                let bound = 3.0 * most * greatest(&exact) + 3e-7 * near.into_iter().fold(0.0, f64::max);
                for (k, seen) in table.at(x).into_iter().enumerate() {
                    let off = (f64::from(seen) - exact[k / 3][k % 3]).abs();
                    assert!(off <= bound, "{shape:?} {range} at {x}: {off:e} of {:e}", greatest(&exact));
                }
            }
        }
    }
}

/// Features finer than a nanometre count for what they are, wherever they lie.
#[test]
fn fine_tables_have_the_luminance_they_are_given() {
    for centre in [589.0, 588.5, 588.77] {
        let csv = format!("{},0\n{centre},1\n{},0\n", centre - 0.05, centre + 0.05);
        let table = Tabulated::parse(&csv, "line").unwrap();
        let spectrum = Spectrum::of(Shape::Tabulated(Arc::new(table)));
        let xyz = *XYZ_FROM_RGB * white(&response(&spectrum).matrix(1.0, 1.0));
        assert!((xyz.y - 1.0).abs() < 1e-9, "{centre}: {xyz}");
        // The same as a narrow line of that luminance.
        let strength = Strength::Luminance(1.0);
        let shape = Shape::Line { centre_nm: centre, width_nm: 0.05 };
        let line = Spectrum { shape, strength, beyond: Beyond::Grey };
        for doppler in [0.93, 1.0, 1.08] {
            let [a, b] = [&spectrum, &line].map(|s| white(&response(s).matrix(1.0, doppler)));
            assert!((a - b).length() < 1e-4 * b.length(), "{centre} {doppler}: {a} {b}");
        }
    }
}

fn greatest(matrix: &Matrix) -> f64 {
    matrix.iter().flatten().fold(0.0, |a: f64, v| a.max(v.abs()))
}

/// At γ of a billion, too, a table is what its spectrum is: powers, the tail of Rayleigh and Jeans, nothing of a line.
#[test]
fn tables_reach_a_billion() {
    let flat = Spectrum::of(Shape::FLAT);
    let table = DopplerTable::new(30.0, |d| response(&flat).matrix(1.0, d));
    let rest = table.color(0.0, [1.0; 3])[1];
    for x in [-12.0, 12.0, 21.0] {
        let seen = table.color(x, [1.0; 3])[1] / rest;
        assert!((f64::from(seen).ln() - 3.0 * x).abs() < 1e-3, "{x} {seen}");
    }
    // A black body far in the tail of Rayleigh and Jeans: I_ν ∝ ν².
    let white = Spectrum::default();
    let table = DopplerTable::new(30.0, |d| response(&white).matrix(1.0, d));
    let (a, b) = (table.color(15.0, [1.0; 3])[0], table.color(16.0, [1.0; 3])[0]);
    assert!((f64::from(b / a).ln() - 1.0).abs() < 1e-3, "{a} {b}");
    for (kelvin, doppler) in [(2.725, 2e6), (300.0, 1e6), (1e9, 1e-5)] {
        let strength = Strength::Radiance(1.0);
        let spectrum = Spectrum { shape: Shape::BlackBody { kelvin }, strength, beyond: Beyond::Grey };
        let table = DopplerTable::new(15.0, |d| response(&spectrum).matrix(1.0, d));
        let (seen, exact) =
            (table.color(f64::ln(doppler), [1.0; 3]), self::white(&response(&spectrum).matrix(1.0, doppler)));
        let off = (DVec3::from_array(seen.map(f64::from)) - exact).abs().max_element();
        assert!(off < 1e-3 * exact.max_element(), "{kelvin} {doppler}: {seen:?} {exact}");
    }
    let line = Spectrum::of(Shape::Line { centre_nm: 1e6, width_nm: 1e4 });
    let table = DopplerTable::new(11.0, |d| response(&line).matrix(1.0, d));
    assert!(table.color(f64::ln(1e6 / 550.0), [1.0; 3])[1] > 1e3);
    assert_eq!(table.color(f64::ln(1e6 / 50.0), [1.0; 3]), [0.0; 3]);
    // So steep that 32-bit numbers end: as bright as can be, of the right colour.
    let steep = Spectrum::of(Shape::PowerLaw { exponent: -10.0 });
    let table = DopplerTable::new(9.0, |d| response(&steep).matrix(1.0, d));
    let seen = table.color(f64::ln(900.0), [1.0; 3]);
    assert!(seen[0] > 1e34 && seen[0] > seen[1] && seen[1] > seen[2] && seen[2] > 0.0, "{seen:?}");
    for x in [-21.5, 21.5, f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
        assert!(table.color(x, [1.0; 3]).iter().all(|v| v.is_finite()), "{x}");
    }
}
