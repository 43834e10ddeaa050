use super::SeenShading;
use super::incidence::Incidence;
use super::logarithm::{ln, logarithms};
use super::points::{POINTS, Points, Ways, numbers};
use super::seen::{beamed, finite};
use super::shading::{MaterialShading, SceneLight};
use crate::color::Coloring;
use crate::spectrum::NearRows;
use glam::{Vec3, Vec3A, Vec4};
use std::f64::consts::PI;

/// What reaches [`Points`] from one light, if nothing is in the way, as surfaces without gloss reflect it.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(crate) struct Arrivals {
    /// What the colour is multiplied by.
    pub amounts: [f64; POINTS],
    /// Place between the rows of a table of what is reflected.
    pub rows: [f64; POINTS],
}

impl Default for Arrivals {
    fn default() -> Self {
        Self { amounts: [0.0; POINTS], rows: [0.0; POINTS] }
    }
}

/// A material that reflects without gloss, in one point or many.
#[derive(Clone, Copy)]
pub(crate) struct Diffuse<'a> {
    coloring: Coloring,
    lights: &'a [SceneLight],
    material: &'a MaterialShading,
}

impl<'a> SeenShading<'a> {
    /// What reaches points of a body from a light along the `ways` there: all else stays as it is. With AVX2 if `vectors` and
    /// there is such.
    pub(crate) fn arrivals(
        &self,
        (body, light): (usize, usize),
        points: &Points,
        ways: &Ways,
        arrivals: &mut Arrivals,
        vectors: bool,
    ) {
        if let Incidence::Ambient { axis, irradiance, .. } = self.incidence(body, light) {
            let radiance = self.strength(light);
            for i in numbers(points.mask) {
                let cos_psi = axis.dot(points.normal(i).normalize_or_zero());
                let amount = match self.coloring() {
                    Coloring::Spectral => 1.0,
                    Coloring::Flat => irradiance.at(cos_psi)[0],
                    Coloring::Bolometric => irradiance.at(cos_psi)[1],
                    Coloring::Geometry | Coloring::Doppler => PI,
                };
                (arrivals.amounts[i], arrivals.rows[i]) = (radiance * amount / PI, cos_psi);
            }
            return;
        }
        let mut rows = [0.0; POINTS];
        if self.coloring() == Coloring::Spectral {
            let one = ways.dopplers[0];
            // Of a light from infinity, or a lamp that does not move.
            if ways.dopplers.iter().all(|doppler| *doppler == one) {
                rows.fill(ln(one));
            } else {
                logarithms(&ways.dopplers, &mut rows, vectors);
            }
        }
        arrivals.reach(self.coloring(), points, ways, &rows, vectors);
    }

    /// Of a material that reflects without gloss, all there is to know.
    pub(crate) fn diffuse(&self, body: usize, material: usize) -> Option<Diffuse<'a>> {
        let (coloring, lights) = (self.coloring(), self.scene_lights());
        let material = self.material(body, material);
        let is_diffuse = coloring != Coloring::Doppler && material.lit && material.gloss.is_even();
        is_diffuse.then_some(Diffuse { coloring, lights, material })
    }
}

impl Arrivals {
    /// At one of them.
    #[inline]
    pub fn at(&self, i: usize) -> [f64; 2] {
        [self.amounts[i], self.rows[i]]
    }

    fn reach(
        &mut self,
        coloring: Coloring,
        points: &Points,
        ways: &Ways,
        rows: &[f64; POINTS],
        vectors: bool,
    ) {
        #[cfg(target_arch = "x86_64")]
        if vectors && crate::processor::has_avx2() {
            // SAFETY: the processor has both.
            unsafe { self.reach_avx2(coloring, points, ways, rows) };
            return;
        }
        let _ = vectors;
        self.reach_with(coloring, points, ways, rows);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,fma")]
    fn reach_avx2(&mut self, coloring: Coloring, points: &Points, ways: &Ways, rows: &[f64; POINTS]) {
        self.reach_with(coloring, points, ways, rows);
    }

    /// From one direction each, in a loop of plain arithmetic, which compilers make vectors of: E′_ν = D E_ν. Radiance goes
    /// with D³, but from an angle smaller by D².
    #[inline(always)]
    fn reach_with(&mut self, coloring: Coloring, points: &Points, ways: &Ways, rows: &[f64; POINTS]) {
        let ([_, x, y, z], [a, b, c]) = (&ways.backs, &points.normals);
        let mut amounts = [0.0; POINTS];
        for (i, amount) in amounts.iter_mut().enumerate() {
            let lengths = (x[i] * x[i] + y[i] * y[i] + z[i] * z[i]).sqrt()
                * (a[i] * a[i] + b[i] * b[i] + c[i] * c[i]).sqrt();
            let cosine = (a[i] * x[i] + b[i] * y[i] + c[i] * z[i]) / lengths;
            *amount = ways.irradiances[i] * cosine * (1.0 / PI);
        }
        let lamps = &ways.dopplers;
        match coloring {
            Coloring::Spectral => (0..POINTS).for_each(|i| amounts[i] /= lamps[i] * lamps[i]),
            Coloring::Flat => (0..POINTS).for_each(|i| amounts[i] *= lamps[i]),
            Coloring::Bolometric => (0..POINTS).for_each(|i| amounts[i] *= lamps[i] * lamps[i]),
            Coloring::Geometry | Coloring::Doppler => {}
        }
        for i in 0..POINTS {
            let is = points.mask >> i & 1 == 1;
            // Also nothing where something is no number.
            let amount = if (amounts[i] > 0.0) & (amounts[i] < f64::INFINITY) { amounts[i] } else { 0.0 };
            self.amounts[i] = if is { amount } else { self.amounts[i] };
            self.rows[i] = if is { rows[i] } else { self.rows[i] };
        }
    }
}

/// Amounts that f32 holds.
const TINY: f64 = 1e-30;
const HUGE: f64 = 1e30;

impl Diffuse<'_> {
    /// Linear sRGB radiance, in units of the film's white, of a surface of a colour that is seen at a Doppler factor, whose
    /// logarithm matters only for spectra: of each light, what [`Arrivals::at`] has where it reaches it. `kept` is kept a light,
    /// if all of the surface has that colour.
    #[inline(never)]
    pub fn radiance(
        &self,
        arrives: impl Fn(usize) -> Option<[f64; 2]>,
        [doppler, logarithm]: [f64; 2],
        base: [f32; 3],
        mut kept: Option<&mut [NearRows]>,
    ) -> Vec3A {
        let mut sum = Vec4::ZERO;
        for (light, of) in self.lights.iter().enumerate() {
            let Some([amount, row]) = arrives(light).filter(|[amount, _]| *amount > 0.0) else { continue };
            let color = match self.coloring {
                Coloring::Spectral => {
                    let Some(table) = self.material.reflected.get(light) else { continue };
                    match kept.as_mut().and_then(|kept| kept.get_mut(light)) {
                        Some(near) => table.color_near(row, logarithm, base, near),
                        None => table.color_near(row, logarithm, base, &mut NearRows::default()),
                    }
                }
                coloring => {
                    let unshifted = [0, 1, 2].map(|i| base[i] * of.color[i]);
                    Vec3::from_array(beamed(coloring, doppler, unshifted)).extend(0.0)
                }
            };
            // In f32, unless the amount itself might be beyond it.
            sum += if (TINY..HUGE).contains(&amount) {
                color * amount as f32
            } else {
                (color.as_dvec4() * amount).as_vec4()
            };
        }
        let light = Vec3A::from_vec4(sum);
        // Nearly always, and told at once.
        let is_usual = light.abs().cmplt(Vec3A::splat(HUGE as f32)).all();
        if is_usual { light } else { finite(light.to_array()).into() }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Shading;
    use super::super::points::tests::{facets, lit, place};
    use super::*;
    use crate::scene::{Colors, Light, Material, Surface, shapes};
    use terrell_geodesic::{Event, Tetrad};

    /// All together, with and without vectors, against one by one, whatever a pixel shows: lamps and bodies in motion and at
    /// rest, spots, light from infinity and from everywhere; with what was kept and without.
    #[test]
    fn points_are_lit_as_one_by_one() {
        let mut mesh = shapes::sphere(2);
        mesh.materials = vec![Material { surface: Surface::Lit, ..Material::default() }];
        let mut scene = lit(mesh, [1.0, 2.0, -0.5, 2.0, 0.0]);
        let dark = Light { strength: 0.0, ..scene.lights[1].clone() };
        scene.lights.push(dark);
        let observer = Tetrad::of_world(Event::origin());
        let mesh = &scene.bodies[0].mesh;
        let base = [0.7, 0.2, 0.5];
        let (mut points, mut ways) = (Points::default(), Ways::default());
        for coloring in [Coloring::Spectral, Coloring::Flat, Coloring::Bolometric, Coloring::Geometry] {
            let shading = Shading::new(&scene, [&observer], coloring).unwrap();
            let seen = shading.seen_by(&observer);
            let diffuse = seen.diffuse(0, 0).unwrap();
            let mut kept = vec![NearRows::default(); 6];
            let mut count = [0; 5];
            points.mask = 0;
            let facets = facets(mesh, 0..POINTS);
            // The others' events are no numbers.
            points.events = [[f64::NAN; POINTS]; 4];
            for (i, (facet, at)) in facets.iter().enumerate().filter(|(i, _)| i % 7 != 3) {
                place(&mut points, i, facet, *at, 3.0);
            }
            for (light, vectors) in (0..5).flat_map(|l| [(l, false), (l, true)]) {
                let mut arrivals = Arrivals { amounts: [-1.0; POINTS], ..Arrivals::default() };
                seen.ways(0, light, &points, &mut ways, vectors);
                seen.arrivals((0, light), &points, &ways, &mut arrivals, vectors);
                for (i, (facet, at)) in facets.iter().enumerate() {
                    if i % 7 == 3 {
                        assert_eq!(arrivals.amounts[i], -1.0, "only of points there are");
                        continue;
                    }
                    let doppler = 0.3 + 0.05 * i as f64;
                    let colors = || Colors { base, ..Colors::default() };
                    let expected = seen.radiance_with_shadows(
                        0,
                        0,
                        doppler,
                        colors,
                        || facet.point(*at),
                        |other| other == light,
                    );
                    let arrives = |other| (other == light).then(|| arrivals.at(i));
                    for kept in [None, Some(&mut kept[..])] {
                        let got = diffuse.radiance(arrives, [doppler, doppler.ln()], base, kept);
                        for (got, expected) in got.to_array().into_iter().zip(expected) {
                            // A few roundings of f32, and where colours cancel those of what is cancelled.
                            let off = (got - expected).abs();
                            assert!(
                                off < 2e-6 * expected.abs() + 1e-9,
                                "{coloring:?} {light} {got} {expected}"
                            );
                        }
                    }
                    count[light] += usize::from(expected != [0.0; 3]);
                }
            }
            assert!(count.iter().all(|n| *n > 10), "{count:?}");
            // A lamp that is out gives nothing, whatever was asked before, and elsewhere.
            points.mask = !0;
            let mut arrivals = Arrivals::default();
            seen.ways(0, 5, &points, &mut ways, true);
            seen.arrivals((0, 5), &points, &ways, &mut arrivals, true);
            assert_eq!(arrivals.amounts, [0.0; POINTS]);
        }
    }
}
