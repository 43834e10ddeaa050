use crate::scene::Gloss;
use glam::DVec3;
use std::f64::consts::PI;

/// What of the light from one direction a surface reflects into another, times the cosine of incidence: three factors,
/// for the three colours. `base` is the colour of even reflection. All vectors are unit vectors of the rest frame.
pub(crate) fn reflected(
    base: [f32; 3],
    gloss: &Gloss,
    normal: DVec3,
    to_light: DVec3,
    to_eye: DVec3,
) -> [f64; 3] {
    reflected_by(true, base, gloss, normal, to_light, to_eye)
}

/// As [`reflected`], without the one direction of a mirror.
pub(crate) fn scattered(
    base: [f32; 3],
    gloss: &Gloss,
    normal: DVec3,
    to_light: DVec3,
    to_eye: DVec3,
) -> [f64; 3] {
    reflected_by(!gloss.is_mirror(), base, gloss, normal, to_light, to_eye)
}

/// Evenly, and by the lobe if that counts.
#[inline]
fn reflected_by(
    lobe: bool,
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
    if gloss.is_even() {
        return base.map(|b| b * cosine / PI);
    }
    // Grazing views divide by it.
    let cos_eye = normal.dot(to_eye).max(1e-4);
    let half = (to_light + to_eye).normalize_or(normal);
    let square = alpha(gloss) * alpha(gloss);
    let distribution = if lobe { distribution(gloss, normal.dot(half)) } else { 0.0 };
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

/// A direction light may come from, chosen by chance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chosen {
    /// Unit vector of the rest frame.
    pub to_light: DVec3,
    /// What is reflected of light from there, times the cosine, over the density of the choice.
    pub factors: [f64; 3],
    /// The density, by solid angle; none of a mirror's one direction.
    pub density: Option<f64>,
}

/// How often, of all choices, the lobe is chosen.
fn lobe_share(base: [f32; 3], gloss: &Gloss) -> f64 {
    if gloss.is_even() {
        return 0.0;
    }
    let most = |of: &dyn Fn(f64) -> f64| base.iter().map(|b| of(f64::from(*b))).fold(0.0, f64::max);
    let lobe = most(&|b| at_right_angles(b, gloss));
    let even = (1.0 - f64::from(gloss.metallic)) * most(&|b| b);
    if even <= 0.0 { 1.0 } else { (lobe / (lobe + even)).clamp(0.1, 0.9) }
}

/// Chooses a direction by three numbers between 0 and 1; none where nothing is reflected.
pub(crate) fn choose(
    base: [f32; 3],
    gloss: &Gloss,
    normal: DVec3,
    to_eye: DVec3,
    [which, u, v]: [f64; 3],
) -> Option<Chosen> {
    let (x, y) = normal.any_orthonormal_pair();
    let around = |cosine: f64| {
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        let phi = std::f64::consts::TAU * v;
        x * (sine * phi.cos()) + y * (sine * phi.sin()) + normal * cosine
    };
    let share = lobe_share(base, gloss);
    if which >= share {
        let to_light = around((1.0 - u).sqrt());
        return chosen(base, gloss, normal, to_light, to_eye);
    }
    if gloss.is_mirror() {
        let cosine = normal.dot(to_eye).max(0.0);
        let to_light = 2.0 * normal.dot(to_eye) * normal - to_eye;
        let grazing = (1.0 - cosine).powi(5);
        let factors = base.map(|b| {
            let upright = at_right_angles(f64::from(b), gloss);
            (upright + (1.0 - upright) * grazing) / share
        });
        return (normal.dot(to_light) > 0.0).then_some(Chosen { to_light, factors, density: None });
    }
    let square = alpha(gloss) * alpha(gloss);
    let half = around(((1.0 - u) / (1.0 + (square - 1.0) * u)).sqrt());
    let to_light = 2.0 * half.dot(to_eye) * half - to_eye;
    chosen(base, gloss, normal, to_light, to_eye)
}

/// The direction, with what is reflected from there, however it came to be chosen.
fn chosen(base: [f32; 3], gloss: &Gloss, normal: DVec3, to_light: DVec3, to_eye: DVec3) -> Option<Chosen> {
    let density = density(base, gloss, normal, to_light, to_eye);
    let factors = scattered(base, gloss, normal, to_light, to_eye).map(|f| f / density);
    (density > 0.0 && factors.iter().all(|f| f.is_finite())).then_some(Chosen {
        to_light,
        factors,
        density: Some(density),
    })
}

/// The density with which [`choose`] chooses a direction, by solid angle; a mirror's one direction left out.
pub(crate) fn density(base: [f32; 3], gloss: &Gloss, normal: DVec3, to_light: DVec3, to_eye: DVec3) -> f64 {
    let cosine = normal.dot(to_light);
    if cosine <= 0.0 {
        return 0.0;
    }
    let share = lobe_share(base, gloss);
    let even = (1.0 - share) * cosine / PI;
    if share == 0.0 || gloss.is_mirror() {
        return even;
    }
    let half = (to_light + to_eye).normalize_or(normal);
    let cos_half = normal.dot(half);
    even + share * distribution(gloss, cos_half) * cos_half / (4.0 * to_eye.dot(half)).max(1e-9)
}

fn alpha(gloss: &Gloss) -> f64 {
    f64::from(gloss.roughness * gloss.roughness).max(1e-3)
}

/// Of the microfacets' normals.
fn distribution(gloss: &Gloss, cos_half: f64) -> f64 {
    let square = alpha(gloss) * alpha(gloss);
    let spread = cos_half * cos_half * (square - 1.0) + 1.0;
    square / (PI * spread * spread)
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

    /// Directions chosen by chance give, on average, what a sum over all directions gives; their densities add up to how
    /// often one above the surface is chosen.
    #[test]
    fn choices_are_right_on_average() {
        for gloss in [
            Gloss::default(),
            Gloss { reflectance: 0.04, roughness: 0.5, metallic: 0.0 },
            Gloss { reflectance: 0.04, roughness: 0.7, metallic: 1.0 },
        ] {
            let base = [0.8, 0.5, 0.1];
            let to_eye = DVec3::new(0.6, 0.0, 0.8);
            // Light that is brighter on one side.
            let light = |to: DVec3| 1.0 + 0.9 * to.x;
            let n = 300;
            let (mut sum, mut whole) = ([0.0; 3], 0.0);
            for i in 0..n {
                let z = (f64::from(i) + 0.5) / f64::from(n);
                for j in 0..n {
                    let phi = std::f64::consts::TAU * (f64::from(j) + 0.5) / f64::from(n);
                    let rho = (1.0 - z * z).sqrt();
                    let to = DVec3::new(rho * phi.cos(), rho * phi.sin(), z);
                    let here = reflected(base, &gloss, DVec3::Z, to, to_eye);
                    sum = [0, 1, 2].map(|c| sum[c] + here[c] * light(to));
                    whole += density(base, &gloss, DVec3::Z, to, to_eye);
                }
            }
            let step = std::f64::consts::TAU / f64::from(n * n);
            let (sum, whole) = (sum.map(|s| s * step), whole * step);
            let m = 60;
            let (mut mean, mut above) = ([0.0; 3], 0.0);
            let place = |i: i32| (f64::from(i) + 0.5) / f64::from(m);
            for (i, j, k) in (0..m).flat_map(|i| (0..m).flat_map(move |j| (0..m).map(move |k| (i, j, k)))) {
                let by = [place(i), place(j), place(k)];
                if let Some(chosen) = choose(base, &gloss, DVec3::Z, to_eye, by) {
                    assert!((chosen.to_light.length() - 1.0).abs() < 1e-12);
                    mean = [0, 1, 2].map(|c| mean[c] + chosen.factors[c] * light(chosen.to_light));
                    above += 1.0;
                }
            }
            let all = f64::from(m * m * m);
            // Sums over squares and cubes of directions: good to a few parts in a thousand.
            assert!((above / all / whole - 1.0).abs() < 0.01, "{gloss:?} {above} {whole}");
            for c in 0..3 {
                assert!((mean[c] / all / sum[c] - 1.0).abs() < 0.01, "{gloss:?} {mean:?} {sum:?}");
            }
        }
    }

    #[test]
    fn a_mirror_has_one_direction() {
        let gloss = Gloss { reflectance: 0.04, roughness: 0.0, metallic: 1.0 };
        let to_eye = DVec3::new(0.6, 0.0, 0.8);
        let chosen = choose([0.9; 3], &gloss, DVec3::Z, to_eye, [0.5; 3]).unwrap();
        assert_eq!(chosen.density, None);
        assert!((chosen.to_light - DVec3::new(-0.6, 0.0, 0.8)).length() < 1e-15);
        // Schlick 1994.
        let expected = f64::from(0.9f32) + (1.0 - f64::from(0.9f32)) * 0.2f64.powi(5);
        assert!((chosen.factors[0] - expected).abs() < 1e-12);
        assert_eq!(scattered([0.9; 3], &gloss, DVec3::Z, DVec3::Z, to_eye), [0.0; 3]);
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
