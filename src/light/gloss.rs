use crate::scene::Gloss;
use glam::DVec3;
use std::f64::consts::PI;

/// What of the light from one direction a surface reflects into another, times the cosine of incidence: three factors,
/// for the three colours. `base` is the colour of even reflection. All vectors are unit vectors of the rest frame.
pub(super) fn reflected(
    base: [f32; 3],
    gloss: &Gloss,
    normal: DVec3,
    to_light: DVec3,
    to_eye: DVec3,
) -> [f64; 3] {
    let cosine = normal.dot(to_light);
    if cosine <= 0.0 {
        return [0.0; 3];
    }
    let base = base.map(f64::from);
    let metallic = f64::from(gloss.metallic);
    if gloss.reflectance == 0.0 && metallic == 0.0 {
        return base.map(|b| b * cosine / PI);
    }
    // Grazing views divide by it.
    let cos_eye = normal.dot(to_eye).max(1e-4);
    let half = (to_light + to_eye).normalize_or(normal);
    let alpha = f64::from(gloss.roughness * gloss.roughness).max(1e-3);
    let square = alpha * alpha;
    let cos_half = normal.dot(half);
    let spread = cos_half * cos_half * (square - 1.0) + 1.0;
    let distribution = square / (PI * spread * spread);
    let hidden = |c: f64| (square + (1.0 - square) * c * c).sqrt();
    let visibility = 0.5 / (cosine * hidden(cos_eye) + cos_eye * hidden(cosine));
    let grazing = (1.0 - to_eye.dot(half).clamp(0.0, 1.0)).powi(5);
    base.map(|b| {
        let upright = at_right_angles(b, gloss);
        let fresnel = upright + (1.0 - upright) * grazing;
        let even = (1.0 - metallic) * (1.0 - fresnel) * b / PI;
        (even + fresnel * distribution * visibility) * cosine
    })
}

fn at_right_angles(base: f64, gloss: &Gloss) -> f64 {
    let metallic = f64::from(gloss.metallic);
    f64::from(gloss.reflectance) * (1.0 - metallic) + base * metallic
}

/// What of light that comes from everywhere is reflected, the gloss taken for even.
pub(super) fn albedo(base: [f32; 3], gloss: &Gloss) -> [f64; 3] {
    let metallic = f64::from(gloss.metallic);
    base.map(f64::from).map(|b| {
        let upright = at_right_angles(b, gloss);
        (1.0 - metallic) * (1.0 - upright) * b + upright
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No surface gives back more than it gets, whatever its gloss; without gloss just its albedo.
    #[test]
    fn reflection_keeps_energy() {
        for gloss in [
            Gloss::default(),
            Gloss { reflectance: 0.04, roughness: 0.4, metallic: 0.0 },
            Gloss { reflectance: 0.04, roughness: 0.9, metallic: 1.0 },
            Gloss { reflectance: 1.0, roughness: 0.25, metallic: 0.0 },
        ] {
            for eye in [0.1f64, 0.5, 1.2] {
                let to_eye = DVec3::new(eye.sin(), 0.0, eye.cos());
                let n = 400;
                let mut sum = 0.0;
                for i in 0..n {
                    // Evenly over the half sky: by z and the azimuth.
                    let z = (f64::from(i) + 0.5) / f64::from(n);
                    for j in 0..n {
                        let phi = std::f64::consts::TAU * (f64::from(j) + 0.5) / f64::from(n);
                        let rho = (1.0 - z * z).sqrt();
                        let light = DVec3::new(rho * phi.cos(), rho * phi.sin(), z);
                        sum += reflected([0.8; 3], &gloss, DVec3::Z, light, to_eye)[0];
                    }
                }
                sum *= std::f64::consts::TAU / f64::from(n * n);
                assert!(sum < 1.005, "{gloss:?} {eye}: {sum}");
                if gloss == Gloss::default() {
                    assert!((sum - 0.8).abs() < 1e-4, "{sum}");
                }
            }
        }
    }

    #[test]
    fn gloss_is_brightest_where_a_mirror_would_be() {
        let gloss = Gloss { reflectance: 0.04, roughness: 0.2, metallic: 0.0 };
        let to_eye = DVec3::new(0.6, 0.0, 0.8);
        let at = |x: f64| {
            reflected([0.0; 3], &gloss, DVec3::Z, DVec3::new(x, 0.0, (1.0 - x * x).sqrt()), to_eye)[0]
        };
        assert!(at(-0.6) > 10.0 * at(-0.3) && at(-0.6) > 10.0 * at(0.6));
        assert_eq!(reflected([1.0; 3], &gloss, DVec3::Z, -DVec3::Z, to_eye), [0.0; 3]);
    }
}
