//! Metrics and laws of motion as a user would write them: g alone, or the second derivative alone; and those that
//! are wrong, which have to be told and never to be drawn.

#![allow(clippy::needless_range_loop, reason = "indices of tensors")]

mod common;

use common::{capture_boundary, crossings, end_of, null_to_past, number, reference, rows, sky};
use glam::DVec3;
use terrell_geodesic::{
    Accuracy, BySecondDerivative, Celerity, Curved, DistantCamera, End, Event, FourVector, KerrSchild,
    Lorentz, Metric, Number, Ray, Rest, Spacetime, Stop, World, minkowski,
};

const TIGHT: f64 = 1e-12;

fn tight<M: Metric>(metric: M) -> Curved<terrell_geodesic::ByMetric<M>> {
    Curved::metric(metric).with(Accuracy::new(TIGHT, 0.05))
}

/// The wormhole of Ellis with throat 1 in Cartesian coordinates in which space is conformally flat:
/// areal radius ρ + 1/(4ρ); the other side is ρ < 1/2.
struct Ellis;

impl Metric for Ellis {
    fn covariant<S: Number>(&self, [_, x, y, z]: [S; 4]) -> [[S; 4]; 4] {
        let factor = (S::from(0.25) / (x * x + y * y + z * z) + 1.0).squared();
        let mut g = minkowski::<S>();
        for i in 1..4 {
            g[i][i] = factor;
        }
        g
    }

    fn stop(&self, [_, x, y, z]: [f64; 4]) -> Option<Stop> {
        (x * x + y * y + z * z < 0.01).then_some(Stop::Edge)
    }
}

#[test]
fn a_wormhole_bends_light_and_lets_it_through() {
    let space = tight(Ellis);
    let from = |b: f64| {
        // So that L/E = n y is b, n the root of the factor before dx².
        let event = Event::new(0.0, 1e5, b / (1.0 + 0.25 / (1e10 + b * b)), 0.0);
        end_of(&space, event, null_to_past(&space, event, -DVec3::X))
    };
    for row in rows(&reference("ellis_wormhole_deflection")) {
        let (b, expected) = (number(&row["b_over_throat"]), number(&row["deflection"]));
        let found = sky(from(b));
        let angle = (-DVec3::X).angle_between(found);
        // Deflections up to 2π; only the last of the angle's digits know of the half-turns.
        let found = [angle, std::f64::consts::TAU - angle]
            .into_iter()
            .min_by(|a, b| (a - expected).abs().total_cmp(&(b - expected).abs()))
            .unwrap();
        // Thirty steps' errors of 1e-12; and as the deflection grows like ln(b − 1), an error of b of 1e-12 becomes
        // one of 1e-12/(b − 1).
        let bound = 1e-9 * expected + 3e-11 + 1e-12 / (b - 1.0);
        assert!((found - expected).abs() < bound, "b {b}: {found} for {expected}");
    }
    assert_eq!(from(0.99), End::Edge, "it comes from the other side");
}

/// A charged hole in the outgoing Kerr–Schild form.
struct Charged(f64);

impl Metric for Charged {
    fn covariant<S: Number>(&self, [_, x, y, z]: [S; 4]) -> [[S; 4]; 4] {
        let r2 = x * x + y * y + z * z;
        let r = r2.sqrt();
        let f = S::from(2.0) / r - S::from(self.0 * self.0) / r2;
        let l = [S::from(1.0), -x / r, -y / r, -z / r];
        let mut g = minkowski::<S>();
        for i in 0..4 {
            for j in 0..4 {
                g[i][j] = g[i][j] + f * l[i] * l[j];
            }
        }
        g
    }

    fn stop(&self, [_, x, y, z]: [f64; 4]) -> Option<Stop> {
        let horizon = 1.0 + (1.0 - self.0 * self.0).sqrt();
        (DVec3::new(x, y, z).length() < 1.000001 * horizon).then_some(Stop::Horizon)
    }
}

#[test]
fn a_charge_makes_the_shadow_smaller() {
    for row in rows(&reference("reissner_nordstrom_critical")) {
        let space = tight(Charged(number(&row["Q"])));
        // Radial distance 1e4, and the impact parameter from the constants of motion, L = x p_y − y p_x and p_t.
        let expected = number(&row["b_c"]);
        let found = capture_boundary(0.9, 1.1, |scale| {
            let event = Event::new(0.0, 1e4, 0.0, 0.0);
            let b = scale * expected;
            // Null with L/E = b by bisection over the direction.
            let impact = |sine: f64| {
                let direction = DVec3::new(-(1.0 - sine * sine).sqrt(), sine, 0.0);
                let k = null_to_past(&space, event, direction);
                let across = space.product(event, k, FourVector::new(0.0, 0.0, 1.0, 0.0));
                (1e4 * across / space.product(event, k, FourVector::new(1.0, 0.0, 0.0, 0.0)), k)
            };
            let (mut low, mut high) = (0.0, 1e-2);
            for _ in 0..80 {
                let middle = 0.5 * (low + high);
                if impact(middle).0 < b { low = middle } else { high = middle }
            }
            end_of(&space, event, impact(0.5 * (low + high)).1)
        });
        assert!((found - 1.0).abs() < 1e-9, "{:e} in {row}", found - 1.0);
    }
}

/// −dt² + a(t)² dx²: expanding space in comoving coordinates.
struct Expanding<F>(F);

trait Growth: Sync {
    fn factor<S: Number>(&self, t: S) -> S;
}

struct DeSitter;
struct EinsteinDeSitter;

impl Growth for DeSitter {
    fn factor<S: Number>(&self, t: S) -> S {
        (t * 0.1).exp()
    }
}

impl Growth for EinsteinDeSitter {
    fn factor<S: Number>(&self, t: S) -> S {
        t.powf(2.0 / 3.0)
    }
}

impl<F: Growth> Metric for Expanding<F> {
    fn covariant<S: Number>(&self, [t, ..]: [S; 4]) -> [[S; 4]; 4] {
        let mut g = minkowski::<S>();
        for i in 1..4 {
            g[i][i] = self.0.factor(t).squared();
        }
        g
    }

    fn stop(&self, [t, ..]: [f64; 4]) -> Option<Stop> {
        (!(-12.0..2.0).contains(&t)).then_some(Stop::Edge)
    }
}

fn check_expansion<F: Growth>(growth: F, now: f64, then: f64, sample: &serde_json::Value) {
    let space = tight(Expanding(growth));
    let here = DVec3::new(5.0, -3.0, 1.0);
    let event = Event::at(now, here);
    let n = DVec3::new(0.48, 0.6, 0.64);
    // a = 1 now, so that the wave vector is that of flat spacetime.
    let mut ray = space.ray(event, FourVector::seen_from(n));
    let (emitted, k) = crossings(&mut ray, 1, |event| event.t() - then)[0];
    let way = emitted.position() - here;
    assert!((way.length() / number(&sample["chi"]) - 1.0).abs() < 1e-9, "{way} {sample}");
    assert!(way.normalize().dot(n) > 1.0 - 1e-12, "straight");
    assert!((k.t.abs() / number(&sample["one_plus_z"]) - 1.0).abs() < 1e-9, "{k:?} {sample}");
}

#[test]
fn light_is_stretched_while_space_expands() {
    let block = reference("time_dependent_closed_forms");
    check_expansion(DeSitter, 0.0, -10.0, &block["sample"][0]);
    check_expansion(EinsteinDeSitter, 1.0, 0.1, &block["sample"][1]);
    // Nothing is at the big bang, and nobody is told otherwise.
    let space = tight(Expanding(EinsteinDeSitter));
    let end = end_of(&space, Event::new(1.0, 0.0, 0.0, 0.0), FourVector::seen_from(DVec3::X));
    assert!(end.is_failure(), "{end:?}");
}

/// Gödel's rotating universe (a = 1/2) in Cartesian coordinates that are smooth on the axis.
struct Goedel;

impl Metric for Goedel {
    fn covariant<S: Number>(&self, [_, x, y, _]: [S; 4]) -> [[S; 4]; 4] {
        let u = x * x + y * y;
        // sinh² r = u Σ (4u)ⁿ⁻¹ 2/(2n)!, and (sinh² r − u)/u² from the same sum.
        let (mut whole, mut rest) = (S::from(0.0), S::from(0.0));
        let mut term = S::from(1.0);
        for n in 1..20 {
            whole = whole + term;
            let next = term * u * (4.0 / f64::from((2 * n + 1) * (2 * n + 2)));
            rest = rest + term * (4.0 / f64::from((2 * n + 1) * (2 * n + 2)));
            term = next;
        }
        // dr² + dz² + sinh² r dφ² − sinh⁴ r dφ² + 2√2 sinh² r dφ dt − dt², with r² dφ = x dy − y dx.
        let around = rest - whole * whole;
        let mut g = minkowski::<S>();
        g[1][1] = y * y * around + 1.0;
        g[2][2] = x * x * around + 1.0;
        g[1][2] = -(x * y * around);
        g[0][1] = -(y * whole * 2f64.sqrt());
        g[0][2] = x * whole * 2f64.sqrt();
        g
    }

    fn stop(&self, [t, ..]: [f64; 4]) -> Option<Stop> {
        (t < -20.0).then_some(Stop::Edge)
    }
}

#[test]
fn in_goedels_universe_light_comes_back_to_the_axis() {
    let expected = number(&reference("time_dependent_closed_forms")["godel_rmax"]);
    let space = tight(Goedel);
    for angle in [0.0f64, 2.0] {
        let n = DVec3::new(angle.cos(), angle.sin(), 0.0);
        let mut ray = space.ray(Event::origin(), FourVector::seen_from(n));
        let mut farthest = 0.0f64;
        let mut nearest_after = f64::INFINITY;
        while let Some(segment) = ray.next() {
            for part in 0..200 {
                let at = ray.at(segment.from + segment.length * f64::from(part) / 200.0).0;
                farthest = farthest.max(at.position().length());
                if at.t() < -2.0 {
                    nearest_after = nearest_after.min(at.position().length());
                }
            }
        }
        // Sampled every ~1e-3 of a circle of radius ~1, of which the farthest point is missed by 1e-7 at most.
        assert!((farthest - expected).abs() < 1e-6, "{farthest} for {expected}");
        assert!(farthest < expected + 1e-9);
        assert!(nearest_after < 0.01, "{nearest_after}");
        assert_eq!(ray.end(), Some(End::Edge));
    }
}

/// A hole that flies past: Kerr–Schild pulled back through a boost. Nothing in it rests or is symmetric.
struct Flying {
    hole: KerrSchild,
    rest_from_world: [[f64; 4]; 4],
}

impl Flying {
    fn new(hole: KerrSchild, celerity: &Celerity) -> Self {
        let rest_from_world = Lorentz::<World, Rest>::boost(celerity).inverse().rows();
        Self { hole, rest_from_world }
    }

    fn rest<S: Number>(&self, x: [S; 4]) -> [S; 4] {
        self.rest_from_world.map(|row| x[0] * row[0] + x[1] * row[1] + x[2] * row[2] + x[3] * row[3])
    }
}

impl Metric for Flying {
    fn covariant<S: Number>(&self, x: [S; 4]) -> [[S; 4]; 4] {
        let g = self.hole.covariant(self.rest(x));
        let l = &self.rest_from_world;
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let mut sum = S::from(0.0);
                for a in 0..4 {
                    for b in 0..4 {
                        sum = sum + g[a.min(b)][a.max(b)] * (l[a][i] * l[b][j]);
                    }
                }
                sum
            })
        })
    }

    fn stop(&self, x: [f64; 4]) -> Option<Stop> {
        Metric::stop(&self.hole, self.rest(x))
    }
}

#[test]
fn a_flying_hole_is_the_resting_one_boosted() {
    let hole = KerrSchild::new(1.0, 0.8).unwrap();
    let celerity = Celerity::from_beta(DVec3::new(0.3, -0.4, 0.2)).unwrap();
    let world_from_rest = Lorentz::<World, Rest>::boost(&celerity);
    let flying = tight(Flying::new(hole, &celerity));
    let resting = Curved::new(hole).with(Accuracy::new(TIGHT, 0.05));
    let camera = DistantCamera::at_distance(hole, 1.2, 25.0).unwrap();
    let boosted = |v: FourVector<World>| world_from_rest * FourVector::<Rest>::from(<[f64; 4]>::from(v));
    let (mut seen, mut black) = (0, 0);
    for (alpha, beta) in [(7.0, 1.0), (-4.0, 4.0), (0.5, -8.0), (3.0, 0.0), (-1.0, 2.0), (-12.0, 5.0)] {
        let (event, k) = camera.ray(alpha, beta).unwrap();
        let there = Event::<World>::origin() + boosted(event.coordinates());
        match (end_of(&resting, event, k), end_of(&flying, there, boosted(k))) {
            (End::Sky { wave_vector }, End::Sky { wave_vector: found }) => {
                let off = boosted(wave_vector) - found;
                // Far away the frequency is known to relative order (M/r)².
                assert!(off.xyz().length() < 1e-9 && off.t.abs() < 1e-9, "{off:?}");
                seen += 1;
            }
            (a, b) => {
                assert!(a == End::Horizon && b == a, "{a:?} {b:?}");
                black += 1;
            }
        }
    }
    assert_eq!((seen, black), (4, 2));
}

/// Flat spacetime in coordinates that curve, shear and run unevenly: T = t + ⅕ sin(x + ½ t), X = x + ⅕ sin y + ⅒ t…
struct Odd;

impl Odd {
    fn flat<S: Number>(&self, [t, x, y, z]: [S; 4]) -> [S; 4] {
        [
            t + (x + t * 0.5).sin() * 0.2,
            x + y.sin() * 0.2 + t * 0.1,
            y + (z * 0.7).cos() * 0.3,
            z + (x * y * 0.1).sin() * 0.1,
        ]
    }
}

impl Metric for Odd {
    fn covariant<S: Number>(&self, [t, x, y, z]: [S; 4]) -> [[S; 4]; 4] {
        let (zero, one) = (S::from(0.0), S::from(1.0));
        let wave = (x + t * 0.5).cos() * 0.2;
        let twist = (x * y * 0.1).cos() * 0.01;
        let jacobian = [
            [wave * 0.5 + 1.0, wave, zero, zero],
            [S::from(0.1), one, y.cos() * 0.2, zero],
            [zero, zero, one, (z * 0.7).sin() * -0.21],
            [zero, y * twist, x * twist, one],
        ];
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let sum = |k: usize| jacobian[k][i] * jacobian[k][j];
                sum(1) + sum(2) + sum(3) - sum(0)
            })
        })
    }

    fn stop(&self, [_, x, y, z]: [f64; 4]) -> Option<Stop> {
        (DVec3::new(x, y, z).length() > 12.0).then_some(Stop::Edge)
    }
}

#[test]
fn flat_spacetime_in_odd_coordinates_is_flat() {
    let space = tight(Odd);
    let event = Event::new(0.3, 0.5, -1.0, 2.0);
    let k = null_to_past(&space, event, DVec3::new(0.6, 0.64, -0.48));
    let flat = |event: Event<World>| DVec3::from_slice(&Odd.flat(event.coordinates().into())[1..]);
    let first = flat(event);
    let mut ray = space.ray(event, k);
    let mut direction = None;
    while let Some(segment) = ray.next() {
        let here = flat(ray.at(segment.to()).0) - first;
        let direction = *direction.get_or_insert(here.normalize());
        assert!(here.cross(direction).length() < 1e-9, "{here} off {direction}");
    }
    assert!(direction.is_some());
    assert_eq!(ray.end(), Some(End::Edge));
}

/// ẍ for light around a mass 1 in Schwarzschild's own coordinates: in space the whole of it is −3 L² x/r⁵.
fn schwarzschild([_, x, y, z]: [f64; 4], [kt, a, b, c]: [f64; 4]) -> [f64; 4] {
    let (place, k) = (DVec3::new(x, y, z), DVec3::new(a, b, c));
    let r = place.length();
    let pull = place * (-3.0 * place.cross(k).length_squared() / r.powi(5));
    let time = -2.0 / (r * r) * place.dot(k) / r * kt / (1.0 - 2.0 / r);
    [time, pull.x, pull.y, pull.z]
}

#[test]
fn a_second_derivative_alone_bends_light_as_the_metric_does() {
    let by_metric = tight(KerrSchild::schwarzschild(1.0).unwrap());
    let alone = Curved::second_derivative(schwarzschild).with(Accuracy::new(TIGHT, 0.05));
    for (b, captured) in [(5.3, false), (8.0, false), (30.0, false), (4.0, true)] {
        let event = Event::new(0.0, 40.0, b, 0.0);
        let k = null_to_past(&by_metric, event, -DVec3::X);
        let expected = end_of(&by_metric, event, k);
        // The paths are the same in both charts; time is another, and starts out as −g_tμ k^μ tells.
        let energy = by_metric.product(event, k, FourVector::new(1.0, 0.0, 0.0, 0.0));
        let r = event.position().length();
        let k = FourVector::from_parts(-energy / (1.0 - 2.0 / r), k.xyz());
        let end = end_of(&alone, event, k);
        if captured {
            // Nobody has told it of a horizon: it runs into the centre, and says so.
            assert_eq!(expected, End::Horizon);
            assert!(end.is_failure(), "{end:?}");
        } else {
            assert!((sky(expected) - sky(end)).length() < 1e-9, "b {b}");
        }
    }
    // Told of one by a metric, it stops there.
    let told = BySecondDerivative::new(schwarzschild).with_metric(Told);
    let event = Event::new(0.0, 40.0, 4.0, 0.0);
    let k = null_to_past(&Curved::metric(Told), event, -DVec3::X);
    assert_eq!(end_of(&Curved::new(told), event, k), End::Horizon);
}

/// Schwarzschild in Schwarzschild's coordinates, Cartesian: −(1 − 2/r) dt² + dx² + (2/(r − 2)) dr².
struct Told;

impl Metric for Told {
    fn covariant<S: Number>(&self, [_, x, y, z]: [S; 4]) -> [[S; 4]; 4] {
        let r = (x * x + y * y + z * z).sqrt();
        let n = [x / r, y / r, z / r];
        let stretch = S::from(2.0) / (r - 2.0);
        let mut g = minkowski::<S>();
        g[0][0] = S::from(2.0) / r - 1.0;
        for i in 0..3 {
            for j in 0..3 {
                g[i + 1][j + 1] = g[i + 1][j + 1] + stretch * n[i] * n[j];
            }
        }
        g
    }

    fn stop(&self, [_, x, y, z]: [f64; 4]) -> Option<Stop> {
        (DVec3::new(x, y, z).length() < 2.01).then_some(Stop::Horizon)
    }
}

/// Any metric by a function of the values, for those that are wrong.
struct Wrong<F>(F);

impl<F: Fn([f64; 4]) -> [f64; 4] + Sync> Metric for Wrong<F> {
    fn covariant<S: Number>(&self, x: [S; 4]) -> [[S; 4]; 4] {
        let diagonal = (self.0)(x.map(S::value));
        std::array::from_fn(|i| std::array::from_fn(|j| S::from(if i == j { diagonal[i] } else { 0.0 })))
    }
}

#[test]
fn what_is_no_metric_is_told() {
    let start = Event::new(0.0, 5.0, 0.0, 0.0);
    let k = FourVector::seen_from(-DVec3::X);
    let end = |diagonal: fn([f64; 4]) -> [f64; 4]| {
        let space = Curved::metric(Wrong(diagonal));
        let mut ray = space.ray(start, k);
        // Neither panics nor goes on for ever, whether followed or cut into segments.
        assert!(ray.by_ref().count() < 100_000);
        let end = ray.end().unwrap();
        assert_eq!(end_of(&space, start, k), end);
        assert!(end.is_failure());
        end
    };
    assert_eq!(end(|_| [0.0; 4]), End::SingularMetric);
    assert_eq!(end(|_| [1.0; 4]), End::SingularMetric);
    assert_eq!(end(|_| [-1.0, -1.0, 1.0, 1.0]), End::SingularMetric);
    assert_eq!(end(|_| [1.0, -1.0, -1.0, -1.0]), End::SingularMetric, "the signature is −+++");
    assert_eq!(end(|_| [-1.0, -1.0, -1.0, 1.0]), End::SingularMetric);
    assert_eq!(end(|_| [-1.0, 1.0, f64::NAN, 1.0]), End::NotANumber);
    assert_eq!(end(|_| [f64::NEG_INFINITY, 1.0, 1.0, 1.0]), End::NotANumber);
    // Fine where the ray starts, and no longer on its way.
    assert_eq!(end(|x| if x[1] > 2.0 { [-1.0, 1.0, 1.0, 1.0] } else { [1.0; 4] }), End::SingularMetric);
    assert_eq!(end(|x| if x[1] > 2.0 { [-1.0, 1.0, 1.0, 1.0] } else { [f64::NAN; 4] }), End::NotANumber);
}

#[test]
fn what_is_no_law_of_motion_is_told() {
    let start = Event::new(0.0, 5.0, 0.0, 0.0);
    let k = FourVector::seen_from(-DVec3::X);
    let nan = Curved::second_derivative(|x: [f64; 4], _| if x[1] > 1.0 { [0.0; 4] } else { [f64::NAN; 4] });
    assert!(end_of(&nan, start, k).is_failure());
    // Around for ever.
    let circle = Curved::second_derivative(|_, k: [f64; 4]| [0.0, -k[2], k[1], 0.0]);
    assert_eq!(end_of(&circle, start, k), End::StepLimit);
    // Faster and faster, which no metric it is said to have allows.
    let off = BySecondDerivative::new(|_, k: [f64; 4]| [0.0, k[1], 0.0, 0.0]).with_metric(minkowski_metric());
    assert_eq!(end_of(&Curved::new(off), start, k), End::Drift);
    // Wave vectors that are none.
    let space = Curved::kerr(1.0, 0.5).unwrap();
    for k in [
        FourVector::new(0.0, 0.0, 0.0, 0.0),
        FourVector::new(-1.0, f64::NAN, 0.0, 0.0),
        FourVector::new(-1.0, f64::INFINITY, 0.0, 0.0),
    ] {
        let mut ray = space.ray(start, k);
        assert_eq!(ray.next(), None);
        assert_eq!(ray.end(), Some(End::NotANumber));
        let _ = ray.at(0.0);
    }
    // A camera inside of the horizon sees nothing that this chart describes.
    let mut ray = space.ray(Event::new(0.0, 0.5, 0.5, 0.5), k);
    assert_eq!(ray.next(), None);
    assert_eq!(ray.end(), Some(End::Horizon));
}

fn minkowski_metric() -> terrell_geodesic::Minkowski {
    terrell_geodesic::Minkowski
}
