use std::f64::consts::PI;

/// The angle by which light passing a hole of mass 1 that does not rotate is turned, from its impact parameter: exact,
/// by elliptic integrals. Infinite at and below the critical 3√3, where it is captured.
///
/// With the perihelion r₀, b² = r₀³/(r₀ − 2), Q² = (r₀ − 2)(r₀ + 6) and k² = (Q − r₀ + 6)/2Q it is
/// 4√(r₀/Q)(K(k) − F(φ, k)) − π, sin² φ = (Q − r₀ + 2)/(Q − r₀ + 6).
///
/// Source: C. Darwin, Proc. R. Soc. A 249 (1959) 180.
pub fn schwarzschild_deflection(impact: f64) -> f64 {
    let critical = 27f64.sqrt();
    if impact <= critical {
        return f64::INFINITY;
    }
    // r³ − b²r + 2b² = 0 by the cosine of a third.
    let third = (-critical / impact).acos() / 3.0;
    let perihelion = 2.0 / 3f64.sqrt() * impact * third.cos();
    let q = ((perihelion - 2.0) * (perihelion + 6.0)).sqrt();
    // Q − r₀, of which far out little is left, without a difference.
    let ahead = (4.0 * perihelion - 12.0) / (q + perihelion);
    let (k2, sine2) = ((ahead + 6.0) / (2.0 * q), (ahead + 2.0) / (ahead + 6.0));
    let whole = carlson_rf([0.0, 1.0 - k2, 1.0]);
    let part = sine2.sqrt() * carlson_rf([1.0 - sine2, 1.0 - k2 * sine2, 1.0]);
    4.0 * (perihelion / q).sqrt() * (whole - part) - PI
}

/// Carlson's symmetric integral of the first kind, ½∫₀^∞ dt/√((t + x)(t + y)(t + z)), by duplication to rounding.
///
/// Source: B. C. Carlson, Numer. Algorithms 10 (1995) 13.
fn carlson_rf(mut at: [f64; 3]) -> f64 {
    loop {
        let mean = (at[0] + at[1] + at[2]) / 3.0;
        let [x, y, z] = at.map(|v| 1.0 - v / mean);
        // The series' first term left out is of the sixth order.
        if x.abs().max(y.abs()).max(z.abs()) < 1e-3 {
            let (e2, e3) = (x * y - z * z, x * y * z);
            return (1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0 - 3.0 * e2 * e3 / 44.0) / mean.sqrt();
        }
        let [x, y, z] = at.map(f64::sqrt);
        let shift = x * y + y * z + z * x;
        at = at.map(|v| 0.25 * (v + shift));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_is_turned_as_by_twenty_digits() {
        let text = include_str!("../../crates/geodesic/tests/reference/curved.json");
        let all: serde_json::Value = serde_json::from_str(text).unwrap();
        let number =
            |v: &serde_json::Value| v.as_str().map_or_else(|| v.as_f64(), |s| s.parse().ok()).unwrap();
        let rows = all["schwarzschild_deflection"].as_array().unwrap();
        assert!(rows.len() > 5);
        for row in rows {
            let (b, expected) = (number(&row["b"]), number(&row["deflection"]));
            // 16 roundings of angles up to π; and near the critical b, what one in b's last digit becomes.
            let bound = 16.0 * f64::EPSILON * (PI + b / (b - 27f64.sqrt()));
            let found = schwarzschild_deflection(b);
            assert!((found - expected).abs() < bound, "b {b}: {found} for {expected}, bound {bound:e}");
        }
        assert_eq!(schwarzschild_deflection(5.0), f64::INFINITY);
    }

    #[test]
    fn carlson_knows_the_simple_cases() {
        // R_F(x, x, x) = 1/√x; R_F(0, 1, 1) = π/2.
        assert!((carlson_rf([4.0; 3]) - 0.5).abs() < 1e-16);
        assert!((carlson_rf([0.0, 1.0, 1.0]) - 0.5 * PI).abs() < 4e-16);
        // Lemniscate: R_F(0, 1, 2) = Γ(1/4)²/(4√(2π)), Carlson's own table.
        assert!((carlson_rf([0.0, 1.0, 2.0]) - 1.311_028_777_146_059_8).abs() < 4e-16);
    }
}
