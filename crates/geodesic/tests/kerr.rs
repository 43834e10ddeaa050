//! Rays of rotating black holes against reference values, and against each other.

mod common;

use common::{capture_boundary, crossings, end_of, number, principal, reference, rows, sky};
use glam::DVec3;
use terrell_geodesic::{
    Accuracy, BoyerLindquist, ByMetric, Curved, DistantCamera, End, Event, KerrSchild, KerrSky, Law,
    LocalFrame, Method, Ray, Sense, Spacetime, static_observer,
};

const TIGHT: Accuracy = Accuracy {
    method: Method::Dop853,
    tolerance: 1e-12,
    sagitta: 0.05,
    lag: 5.0,
    steps: 10_000,
    drift: 1e-8,
};

/// Radius, azimuth and time of every equatorial crossing of the 24 rays, and the Keplerian redshift there.
fn check_hits<L: Law>(space: impl Fn(KerrSchild) -> Curved<L>, tolerance: f64) {
    let block = reference("kerr_equatorial_hits");
    assert_eq!(rows(&block).len(), 24);
    for row in rows(&block) {
        let hole = KerrSchild::new(1.0, number(&row["a"])).unwrap();
        let inclination = number(&row["theta_obs_deg"]).to_radians();
        let (alpha, beta) = (number(&row["alpha"]), number(&row["beta"]));
        let camera = DistantCamera::at_distance(hole, inclination, number(&row["r_obs"])).unwrap();
        let (event, k) = camera.ray(alpha, beta).unwrap();
        let space = space(hole);
        let mut ray = space.ray(event, k);
        let expected = rows(&row["crossings"]);
        let found = crossings(&mut ray, expected.len(), |event| event.position().z);
        assert_eq!(found.len(), expected.len(), "{row}");
        for ((hit, k), expected) in found.into_iter().zip(expected) {
            let at = hole.to_boyer_lindquist(hit);
            let (r, dt) = (number(&expected["r"]), number(&expected["dt"]));
            let off = (at.r / r - 1.0).abs();
            assert!(off < tolerance, "a {} α {alpha} β {beta}: r {} for {r}, {off:e}", row["a"], at.r);
            // t and φ of Boyer and Lindquist run away logarithmically at the horizon: there their own
            // conditioning is r/(r − r₊).
            let conditioning = r / (r - hole.horizon());
            let off = (-at.t - dt).abs() / dt;
            assert!(off < tolerance * conditioning, "dt {} for {dt}, {off:e}", -at.t);
            let turn = principal(-at.phi - number(&expected["dphi"])).abs();
            // The azimuth turns by π at the axis, which this ray crosses only for α = 0.
            assert!(turn < 10.0 * tolerance * conditioning, "dphi off by {turn:e} in {row}");
            if let Some(g) = expected.get("g_keplerian").filter(|g| !g.is_null()) {
                let disc = hole.circular(hit, Sense::Prograde).unwrap();
                // Frequencies are in units of that at infinity, so g = 1/(k·u).
                let off = (1.0 / space.product(hit, k, disc) / number(g) - 1.0).abs();
                assert!(off < 10.0 * tolerance, "g off by {off:e} in {row}");
            }
        }
        if row["captured"].as_bool().unwrap() {
            assert_eq!(ray.by_ref().count().min(1), 1);
            assert_eq!(ray.end(), Some(End::Horizon));
        }
    }
}

#[test]
fn equatorial_hits_by_hand() {
    check_hits(|hole| Curved::new(hole).with(TIGHT), 1e-9);
}

#[test]
fn equatorial_hits_by_the_metric_alone() {
    check_hits(|hole| Curved::metric(hole).with(TIGHT), 1e-9);
}

#[test]
fn equatorial_hits_by_dopri5() {
    check_hits(|hole| Curved::new(hole).with(Accuracy { method: Method::Dopri5, ..TIGHT }), 1e-9);
}

/// In each of these one ray at the edge turns π/γ more for every e-fold nearer, so bisecting is well conditioned.
#[test]
fn the_shadow_has_the_critical_curve_for_its_edge() {
    for curve in rows(&reference("kerr_critical_curve")) {
        let hole = KerrSchild::new(1.0, number(&curve["a"])).unwrap();
        let camera =
            DistantCamera::at_infinity(hole, number(&curve["inclination_deg"]).to_radians()).unwrap();
        let space = Curved::new(hole).with(Accuracy { tolerance: 1e-11, ..TIGHT });
        let sky = KerrSky::new(hole, 1e-12);
        for point in rows(&curve["points"]).iter().step_by(5) {
            let (alpha, beta) = (number(&point["alpha"]), number(&point["beta"]));
            // Along the ray from a point within the shadow that lies near its middle.
            let middle = 0.5 * (number(&curve["alpha_min"]) + number(&curve["alpha_max"]));
            let at = |scale: f64| camera.ray(middle + scale * (alpha - middle), scale * beta).unwrap();
            let followed = capture_boundary(0.8, 1.2, |scale| {
                let (event, k) = at(scale);
                end_of(&space, event, k)
            });
            let in_lanes = capture_boundary(0.8, 1.2, |scale| sky.trace(&[at(scale)])[0]);
            // Size of the shadow ~ 5, tolerance 1e-11, and one digit for the fifteen steps near the orbit.
            assert!((followed - 1.0).abs() < 1e-9, "{point}: {:e}", followed - 1.0);
            assert!((in_lanes - 1.0).abs() < 1e-10, "{point}: {:e}", in_lanes - 1.0);
        }
    }
}

/// E, L_z and Carter's Q of a wave vector.
fn constants(
    hole: &KerrSchild,
    at: Event<terrell_geodesic::World>,
    k: terrell_geodesic::FourVector<terrell_geodesic::World>,
) -> [f64; 3] {
    let space = Curved::new(*hole);
    let place = at.position();
    let a = hole.spin();
    let unit = |i: usize| {
        let mut e = [0.0; 4];
        e[i] = 1.0;
        e.into()
    };
    let p: Vec<f64> = (0..4).map(|i| space.product(at, k, unit(i))).collect();
    let energy = p[0];
    let around = place.x * p[2] - place.y * p[1];
    let r = hole.radius(place.to_array());
    // p_θ from p = p_r dr + p_θ dθ + p_φ dφ′ at fixed r and φ′, where ∂(x, y)/∂θ = (x, y) cot θ.
    let sine = place.x.hypot(place.y) / r.hypot(a);
    let cosine = place.z / r;
    let p_theta = (place.x * p[1] + place.y * p[2]) * cosine / sine - r * sine * p[3];
    let carter =
        p_theta * p_theta + cosine * cosine * (around * around / (sine * sine) - a * a * energy * energy);
    [energy, around, carter]
}

#[test]
fn energy_angular_momentum_and_carters_constant_are_kept_all_along() {
    for spin in [0.5, 0.94, 1.0] {
        let hole = KerrSchild::new(1.0, spin).unwrap();
        let camera = DistantCamera::at_distance(hole, 1.1, 60.0).unwrap();
        for space in
            [Curved::new(hole).with(TIGHT), Curved::new(hole).with(Accuracy { tolerance: 1e-10, ..TIGHT })]
        {
            for (alpha, beta) in [(6.0, 3.0), (-2.5, 4.5), (3.0, -7.0), (-2.0, 1.0)] {
                let (event, k) = camera.ray(alpha, beta).unwrap();
                let first = constants(&hole, event, k);
                let (l, q) = (
                    -alpha * 1.1f64.sin(),
                    beta * beta + (alpha * alpha - spin * spin) * 1.1f64.cos().powi(2),
                );
                // What the camera promises: E = 1, −L and Q of the light, to rounding of r² p_θ ~ 60.
                for (found, expected) in first.into_iter().zip([1.0, -l, q]) {
                    assert!((found - expected).abs() < 1e-10 * (1.0 + q.abs()), "{first:?} {l} {q}");
                }
                let mut ray = space.ray(event, k);
                let mut last = 0.0;
                while let Some(segment) = ray.next() {
                    if segment.length.is_infinite() {
                        break;
                    }
                    for part in [0.0, 0.3, 0.7, 1.0] {
                        let (at, k) = ray.at(segment.from + part * segment.length);
                        if at.position().length() > 100.0 {
                            // Q there is a difference of terms that grow like r².
                            continue;
                        }
                        let now = constants(&hole, at, k);
                        for i in 0..3 {
                            let off = (now[i] - first[i]).abs() / (1.0 + first[2].abs());
                            // The continuation is of one order less than the step.
                            assert!(off < 100.0 * space.accuracy().tolerance, "{i} {off:e}");
                        }
                    }
                    last = segment.to();
                }
                assert!(last > 50.0, "the ray came near the hole");
                assert!(!ray.end().unwrap().is_failure());
                assert!(ray.monitor().drift < 100.0 * space.accuracy().tolerance);
            }
        }
    }
}

/// Kerr–Schild in lanes, by hand and by the metric are three ways to the same sky.
#[test]
fn lanes_and_single_rays_see_the_same_sky() {
    for (spin, inclination) in
        [(0.0, 1.0), (0.9, 1.3), (-0.7, 0.4), (1.0, 1.5), (0.998, 0.0), (0.6, std::f64::consts::PI)]
    {
        let hole = KerrSchild::new(2.0, 2.0 * spin).unwrap();
        let space = Curved::new(hole).with(TIGHT);
        for camera in [
            DistantCamera::at_distance(hole, inclination, 40.0).unwrap(),
            DistantCamera::at_infinity(hole, inclination).unwrap(),
        ] {
            let places: Vec<_> = (0..15 * 15 - 2)
                .map(|i| {
                    let (i, j) = (i % 15, i / 15);
                    let (alpha, beta) = (2.0 * (f64::from(i) - 7.0) + 0.1, 2.0 * (f64::from(j) - 7.0) + 0.2);
                    (alpha, beta)
                })
                .collect();
            let seen_at = |shift: f64| -> Vec<_> {
                let shifted = |&(alpha, beta): &(f64, f64)| {
                    let (event, k) = camera.ray(alpha + shift, beta + shift).unwrap();
                    (event, k * 3.0)
                };
                places.iter().map(shifted).collect()
            };
            let rays = seen_at(0.0);
            let sky = KerrSky::new(hole, 1e-12);
            let lanes = sky.trace(&rays);
            let baseline = sky.trace_baseline(&rays);
            let beside = sky.trace(&seen_at(1e-6));
            let mut escaped = 0;
            for (i, &(event, k)) in rays.iter().enumerate() {
                let followed = end_of(&space, event, k);
                let (End::Sky { wave_vector: a }, End::Sky { wave_vector: b }, End::Sky { wave_vector: c }) =
                    (lanes[i], followed, baseline[i])
                else {
                    let all = [lanes[i], followed, baseline[i]];
                    assert_eq!(all, [End::Horizon; 3], "spin {spin} ι {inclination}");
                    continue;
                };
                escaped += 1;
                let off = (a - b).xyz().length().max((a.t - b.t).abs());
                // A hundred steps' errors of 1e-12, times how much the ray magnifies them.
                let magnified = match beside[i] {
                    End::Sky { wave_vector } => (wave_vector - a).xyz().length() / 1e-6,
                    _ => 1e6,
                };
                let bound = 1e-10 * (3.0 + magnified);
                assert!(off < bound, "spin {spin} ι {inclination}: {off:e} {bound:e} {a:?} {b:?}");
                assert!((a - c).xyz().length() < bound);
            }
            assert!((100..223).contains(&escaped), "{escaped} of them escape");
        }
    }
}

#[test]
fn without_rotation_it_is_the_hole_that_does_not_rotate() {
    let still = KerrSchild::schwarzschild(1.0).unwrap();
    let slow = KerrSchild::new(1.0, 1e-10).unwrap();
    for (alpha, beta) in [(6.0, 1.0), (0.0, 8.0), (-5.0, -3.0)] {
        let ends = [still, slow].map(|hole| {
            let (event, k) = DistantCamera::at_infinity(hole, 1.0).unwrap().ray(alpha, beta).unwrap();
            sky(end_of(&Curved::new(hole).with(TIGHT), event, k))
        });
        // Frame dragging turns rays by 4aM/b², and by ten times that near the orbit of light.
        assert!((ends[0] - ends[1]).length() < 3e-10, "{ends:?}");
        assert!((ends[0] - ends[1]).length() > 1e-12, "a spin is a spin");
    }
}

/// The camera on the axis sees a picture symmetric about it.
#[test]
fn from_the_axis_all_directions_are_alike() {
    let hole = KerrSchild::new(1.0, 0.9).unwrap();
    let space = Curved::new(hole).with(TIGHT);
    let event = Event::new(0.0, 0.0, 0.0, 20.0);
    let u = static_observer(&space, event).unwrap();
    assert!((hole.zamo(event).unwrap() - u).xyz().length() < 1e-15);
    let frame = LocalFrame::new(&space, event, u, -DVec3::Z, DVec3::X).unwrap();
    let mut first = None;
    for turn in 0..7 {
        let (sine, cosine) = f64::from(turn).sin_cos();
        let n = DVec3::new(0.4 * cosine, 0.4 * sine, (1.0f64 - 0.16).sqrt());
        let seen = sky(end_of(&space, event, frame.seen_from(n)));
        let height = *first.get_or_insert(seen.z);
        assert!((seen.z - height).abs() < 1e-10, "{seen} {height}");
    }
    // Straight down the axis, where Boyer and Lindquist have their pole.
    assert_eq!(end_of(&space, event, frame.seen_from(DVec3::Z)), End::Horizon);
    let up = sky(end_of(&space, event, frame.seen_from(-DVec3::Z)));
    assert!((up - DVec3::Z).length() < 1e-12);
}

#[test]
fn the_extreme_hole_is_seen_and_more_is_refused() {
    let hole = KerrSchild::new(1.0, 1.0).unwrap();
    let camera = DistantCamera::at_infinity(hole, 90f64.to_radians()).unwrap();
    let space = Curved::new(hole);
    // The edges in the equatorial plane: −7 and 2 (Bardeen 1973). Between them black, outside of them sky.
    for (alpha, captured) in [(-1.9, true), (-2.1, false), (6.99, true), (7.01, false), (0.0, true)] {
        let (event, k) = camera.ray(alpha, 0.3e-6).unwrap();
        let mut ray = space.ray(event, k);
        assert_eq!(ray.follow() == End::Horizon, captured, "α = {alpha}");
        assert!(ray.monitor().steps < 200, "{:?}", ray.monitor());
    }
    assert!(Curved::kerr(1.0, 1.0 + 1e-12).is_err());
    assert!(Curved::kerr(3.0, -3.1).is_err());
}

#[test]
fn in_the_ergosphere_those_who_move_along_see() {
    let hole = KerrSchild::new(1.0, 0.95).unwrap();
    let space = Curved::new(hole).with(TIGHT);
    let at = BoyerLindquist { t: 0.0, r: 1.6, theta: 1.4, phi: 0.7 };
    let event = hole.from_boyer_lindquist(at);
    assert!(static_observer(&space, event).is_err());
    let u = hole.zamo(event).unwrap();
    let frame = LocalFrame::new(&space, event, u, event.position(), DVec3::Z).unwrap();
    let (mut black, mut bright) = (0, 0);
    for i in 0..12 {
        for j in 0..12 {
            let (theta, phi) = (0.26 * f64::from(i) + 0.1, 0.52 * f64::from(j));
            let n = DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos());
            match end_of(&space, event, frame.seen_from(n)) {
                End::Horizon => black += 1,
                End::Sky { .. } => bright += 1,
                other => panic!("the ray {other}"),
            }
        }
    }
    assert!(black > 20 && bright > 20, "{black} {bright}");
}

/// The observers the black hole singles out, by what defines them.
#[test]
fn observers_are_who_they_are_said_to_be() {
    for spin in [0.0, 0.9, -0.9, 1.0] {
        let hole = KerrSchild::new(1.0, spin).unwrap();
        let space = Curved::new(hole);
        for (r, theta, phi) in [(2.5, 1.0, 0.3), (9.0, 2.0, -2.0), (400.0, 0.2, 1.0)] {
            let event = hole.from_boyer_lindquist(BoyerLindquist { t: 0.0, r, theta, phi });
            let place = event.position();
            let around = [0.0, -place.y, place.x, 0.0].into();
            let time = [1.0, 0.0, 0.0, 0.0].into();
            let zamo = hole.zamo(event).unwrap();
            // Angular momentum of size r.
            assert!(space.product(event, zamo, around).abs() < 1e-12 * r);
            let rain = hole.rain(event).unwrap();
            assert!((space.product(event, rain, time) + 1.0).abs() < 1e-13);
            assert!(space.product(event, rain, around).abs() < 1e-12 * r);
            assert!(rain.xyz().dot(place) < 0.0, "it falls");
            for u in [zamo, rain] {
                assert!((space.product(event, u, u) + 1.0).abs() < 1e-12);
            }
        }
    }
    for block in rows(&reference("kerr_circular_redshift")) {
        let hole = KerrSchild::new(1.0, number(&block["a"])).unwrap();
        for row in rows(&block["rows"]) {
            let at =
                BoyerLindquist { t: 0.0, r: number(&row["r"]), theta: std::f64::consts::FRAC_PI_2, phi: 1.0 };
            let event = hole.from_boyer_lindquist(at);
            let u = hole.circular(event, Sense::Prograde).unwrap();
            let omega = u.xyz().length() / event.position().length() / u.t;
            assert!((omega / number(&row["Omega"]) - 1.0).abs() < 1e-13);
            assert!((u.t / number(&row["u_t"]) - 1.0).abs() < 1e-12);
            let zamo = hole.zamo(event).unwrap();
            let gamma = -Curved::new(hole).product(event, u, zamo);
            let speed = (1.0 - 1.0 / (gamma * gamma)).sqrt();
            assert!((speed - number(&row["zamo_speed"])).abs() < 1e-11, "{speed} {row}");
        }
    }
    // No circular orbit within that of light.
    let hole = KerrSchild::schwarzschild(1.0).unwrap();
    assert!(hole.circular(Event::new(0.0, 2.9, 0.0, 0.0), Sense::Prograde).is_err());
    assert!(hole.circular(Event::new(0.0, 9.0, 0.0, 1.0), Sense::Prograde).is_err());
    assert!(hole.rain(Event::new(0.0, 1.0, 0.0, 0.0)).is_err());
}

/// A hand-written law of motion and the dual numbers take the same steps.
#[test]
fn by_hand_and_by_the_metric_the_work_is_the_same() {
    let hole = KerrSchild::new(1.0, 0.9).unwrap();
    let (event, k) = DistantCamera::at_distance(hole, 1.0, 50.0).unwrap().ray(8.0, 2.0).unwrap();
    let (by_hand, by_metric) = (Curved::new(hole), Curved::new(ByMetric(hole)));
    let (mut a, mut b) = (by_hand.ray(event, k), by_metric.ray(event, k));
    let (a_end, b_end) = (a.follow(), b.follow());
    assert!((sky(a_end) - sky(b_end)).length() < 1e-12);
    assert_eq!(a.monitor().steps, b.monitor().steps);
}

#[test]
fn rays_that_are_none_are_told_in_lanes_too() {
    let hole = KerrSchild::new(1.0, 0.9).unwrap();
    let sky = KerrSky::new(hole, 1e-8);
    assert_eq!(sky.trace(&[]), []);
    let (event, k) = DistantCamera::at_distance(hole, 1.0, 30.0).unwrap().ray(9.0, 1.0).unwrap();
    let inside = Event::new(0.0, 0.9, 0.9, 0.1);
    let rays = [
        (event, k),
        (event, k * f64::NAN),
        (inside, k),
        // To the future, at rest, and not null.
        (event, -k),
        (event, [-1.0, 0.0, 0.0, 0.0].into()),
        (event, k + [-0.1, 0.0, 0.0, 0.0].into()),
        (event, k),
    ];
    for ends in [sky.trace(&rays), sky.trace_baseline(&rays)] {
        assert!(matches!(ends[0], End::Sky { .. }));
        assert_eq!(ends[1], End::NotANumber);
        assert_eq!(ends[2], End::Horizon);
        assert_eq!(ends[3..6], [End::Drift; 3]);
        // In another pack, with other company.
        let (End::Sky { wave_vector: a }, End::Sky { wave_vector: b }) = (ends[0], ends[6]) else { panic!() };
        assert!((a - b).xyz().length() < 1e-7);
    }
    // Tolerances that are none end in a flag, not for ever.
    for tolerance in [0.0, f64::NAN, -1.0] {
        assert!(KerrSky::new(hole, tolerance).trace(&rays[..1])[0].is_failure());
    }
}

#[test]
fn distant_cameras_that_cannot_be_are_refused() {
    let hole = KerrSchild::new(1.0, 0.5).unwrap();
    for inclination in [-0.1, 3.2, f64::NAN] {
        assert!(DistantCamera::at_infinity(hole, inclination).is_err());
    }
    for distance in [1.0, -5.0, f64::NAN] {
        assert!(DistantCamera::at_distance(hole, 1.0, distance).is_err());
    }
    let camera = DistantCamera::at_distance(hole, 1.0, 10.0).unwrap();
    assert!(camera.ray(20.0, 0.0).is_err(), "such light passes farther out");
    assert!(camera.ray(f64::NAN, 0.0).is_err());
    assert!(camera.ray(3.0, 0.0).is_ok());
}

#[test]
fn accuracies_that_are_none_end_in_a_flag() {
    let hole = KerrSchild::new(1.0, 0.5).unwrap();
    let (event, k) = DistantCamera::at_distance(hole, 1.0, 30.0).unwrap().ray(9.0, 1.0).unwrap();
    let usual = Accuracy::new(1e-8, 0.01);
    for accuracy in [
        Accuracy { tolerance: 0.0, ..usual },
        Accuracy { tolerance: f64::NAN, ..usual },
        Accuracy { tolerance: -1.0, ..usual },
        Accuracy { sagitta: 0.0, ..usual },
        Accuracy { sagitta: f64::NAN, ..usual },
        Accuracy { steps: 3, ..usual },
        Accuracy { drift: 0.0, ..usual },
    ] {
        let space = Curved::new(hole).with(accuracy);
        let mut ray = space.ray(event, k);
        assert!(ray.by_ref().count() < 10_000);
        assert!(ray.end().unwrap().is_failure(), "{accuracy:?}: {:?}", ray.end());
    }
}
