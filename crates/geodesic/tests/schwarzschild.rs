//! Rays of a hole that does not rotate, against values known to 20 digits.

mod common;

use common::{
    capture_boundary, crossings, end_of, looking_inwards, number, reference, refine_turn, rows, sky,
    total_turn,
};
use glam::DVec3;
use terrell_geodesic::{
    Accuracy, Curved, DistantCamera, End, Event, FourVector, KerrSchild, KerrSky, LocalFrame, Spacetime,
    World, static_observer,
};

fn hole() -> Curved<KerrSchild> {
    Curved::kerr(1.0, 0.0).unwrap().with(Accuracy::new(1e-12, 0.02))
}

/// The ray of impact parameter `b` from a camera infinitely far along +x.
fn from_infinity(b: f64) -> (Event<World>, FourVector<World>) {
    let hole = KerrSchild::schwarzschild(1.0).unwrap();
    DistantCamera::at_infinity(hole, 90f64.to_radians()).unwrap().ray(b, 0.0).unwrap()
}

#[test]
fn light_is_deflected() {
    let critical = number(&reference("schwarzschild_critical")["b_c"]);
    for row in rows(&reference("schwarzschild_deflection")) {
        let (b, expected) = (number(&row["b"]), number(&row["deflection"]));
        let (event, k) = from_infinity(b);
        let space = hole();
        let (rough, end) = total_turn(&mut space.ray(event, k));
        let found = refine_turn(-DVec3::X, sky(end), rough);
        // 1e-9 of the value; the unit of a direction's last digits; and what an error of b of 1e-13 becomes,
        // b dα/db being b/(b − b_c) near the critical one.
        let bound = 1e-9 * expected + 2e-12 + 1e-13 * b / (b - critical) * 5.0;
        assert!((found - expected).abs() < bound, "b {b}: {found} for {expected}, bound {bound:e}");
        let [end] = KerrSky::new(*space.law(), 1e-13).trace(&[(event, k)])[..] else { panic!("one ray") };
        let lanes = refine_turn(-DVec3::X, sky(end), rough);
        assert!((lanes - expected).abs() < bound, "b {b} in lanes: {lanes} for {expected}");
    }
}

#[test]
fn light_within_the_critical_impact_parameter_is_captured() {
    let expected = number(&reference("schwarzschild_critical")["b_c"]);
    for space in [hole(), hole().with(Accuracy::new(1e-10, 0.02))] {
        let found = capture_boundary(4.0, 6.0, |b| {
            let (event, k) = from_infinity(b);
            end_of(&space, event, k)
        });
        assert!((found / expected - 1.0).abs() < 1e-9, "{found} for {expected}");
    }
}

/// The frame's z axis is forward, towards the hole.
fn towards(angle: f64) -> DVec3 {
    DVec3::new(angle.sin(), 0.0, angle.cos())
}

#[test]
fn the_shadow_of_those_who_rest_and_those_who_fall() {
    let space = hole();
    for row in rows(&reference("schwarzschild_shadow_angle")) {
        let event = Event::new(0.0, number(&row["r"]), 0.0, 0.0);
        if row.get("rain_only").is_some() {
            assert!(space.law().rain(event).is_err(), "inside of the horizon");
            continue;
        }
        let observers =
            [("static", static_observer(&space, event).unwrap()), ("rain", space.law().rain(event).unwrap())];
        for (name, u) in observers {
            let frame = looking_inwards(&space, event, u);
            let expected = number(&row[format!("{name}_half_angle")]);
            let found = capture_boundary(0.5 * expected, 0.5 * (expected + std::f64::consts::PI), |angle| {
                end_of(&space, event, frame.seen_from(towards(angle)))
            });
            // Who is fast in these coordinates has a frame of large components, rounded.
            let bound = 1e-9 + 4.0 * f64::EPSILON * u.t * u.t;
            assert!((found - expected).abs() < bound, "{name} at {event:?}: {found} for {expected}");
        }
    }
}

#[test]
fn light_is_delayed() {
    let space = hole();
    for row in rows(&reference("schwarzschild_time_delay")) {
        let (r1, r2, b) = (number(&row["r1"]), number(&row["r2"]), number(&row["b"]));
        let camera = DistantCamera::at_distance(*space.law(), 90f64.to_radians(), r1).unwrap();
        let (event, k) = camera.ray(b, 0.0).unwrap();
        let radius = |event: Event<World>| event.position().length();
        // Short of r2 by a millionth where the ray starts there, so that it passes twice in any case.
        let skip = if r1 == r2 { 1e-6 } else { 0.0 };
        let mut ray = space.ray(event, k);
        let hits = crossings(&mut ray, 2, |event| radius(event) - r2 * (1.0 - skip));
        let start = space.law().to_boyer_lindquist(event);
        let end = space.law().to_boyer_lindquist(hits[1].0);
        // The rest of the way by dt/dr and dφ/dr at r2; what is left of the second order is 1e-12 b²/r.
        let last = r2 * skip;
        let slope = 1.0 / (1.0 - (1.0 - 2.0 / r2) * b * b / (r2 * r2)).sqrt();
        let t = start.t - end.t + last * slope / (1.0 - 2.0 / r2);
        let phi = (end.phi - start.phi).rem_euclid(std::f64::consts::TAU) + last * slope * b / (r2 * r2);
        let (expected_t, expected_phi) = (number(&row["t_coord"]), number(&row["sweep_angle"]));
        assert!((t / expected_t - 1.0).abs() < 1e-9, "{t} for {expected_t} in {row}");
        assert!((phi / expected_phi - 1.0).abs() < 1e-9, "{phi} for {expected_phi} in {row}");
    }
}

#[test]
fn a_source_right_behind_the_hole_is_a_ring() {
    let space = hole();
    for row in rows(&reference("einstein_ring")) {
        let (r_obs, r_src, theta) =
            (number(&row["r_obs"]), number(&row["r_src"]), number(&row["theta_exact"]));
        let event = Event::new(0.0, r_obs, 0.0, 0.0);
        let frame = looking_inwards(&space, event, static_observer(&space, event).unwrap());
        let seen_at = |theta: f64| {
            let mut ray = space.ray(event, frame.seen_from(towards(theta)));
            // The last time it is there.
            let hits = crossings(&mut ray, 2, |event| event.position().length() - r_src * (1.0 + 1e-14));
            let place = hits.last().unwrap().0.position();
            // How far past the line through the hole.
            place.y.atan2(-place.x)
        };
        // The ring's radius follows from where the light of it started, by one step of Newton.
        let h = 1e-5 * theta;
        let slope = (seen_at(theta + h) - seen_at(theta - h)) / (2.0 * h);
        let off = seen_at(theta) / slope;
        assert!((off / theta).abs() < 1e-9, "{off:e} of {theta} in {row}");
    }
}

#[test]
fn light_from_a_star_is_bent() {
    let space = hole();
    for star in rows(&reference("ns_bending")) {
        let event = Event::new(0.0, number(&star["R"]), 0.0, 0.0);
        let frame =
            LocalFrame::new(&space, event, static_observer(&space, event).unwrap(), DVec3::X, DVec3::Z)
                .unwrap();
        for row in rows(&star["rows"]) {
            let (alpha, expected) = (number(&row["alpha_deg"]).to_radians(), number(&row["psi"]));
            // Followed backwards it is the mirror image of the light that leaves.
            let end = end_of(&space, event, frame.seen_from(towards(alpha)));
            let found = DVec3::X.angle_between(sky(end));
            assert!((found - expected).abs() < 1e-9, "R {} α {alpha}: {found} for {expected}", star["R"]);
        }
    }
}

#[test]
fn those_who_fall_see_the_sky_shrink_ahead() {
    let space = hole();
    for block in rows(&reference("schwarzschild_rain_aberration")) {
        let event = Event::new(0.0, number(&block["r"]), 0.0, 0.0);
        let rest = looking_inwards(&space, event, static_observer(&space, event).unwrap());
        let rain = looking_inwards(&space, event, space.law().rain(event).unwrap());
        let gamma = -space.product(event, rest.four_velocity(), rain.four_velocity());
        let speed = (1.0 - 1.0 / (gamma * gamma)).sqrt();
        assert!((speed - number(&block["v_rain"])).abs() < 1e-13);
        for row in rows(&block["rows"]) {
            let k = rest.seen_from(towards(number(&row["static_deg"]).to_radians()));
            let seen = rain.components(&space, k);
            let angle = seen.space[0].atan2(seen.space[2]).abs().to_degrees();
            assert!((angle - number(&row["rain_deg"])).abs() < 1e-10, "{angle} {row}");
            let shift = -seen.t;
            assert!((shift / number(&row["nu_rain_over_static"]) - 1.0).abs() < 1e-12, "{shift} {row}");
            // What comes from the sky tells its frequency there.
            if let End::Sky { wave_vector } = end_of(&space, event, k) {
                let shift = shift / wave_vector.t.abs();
                assert!((shift / number(&row["nu_rain_over_inf"]) - 1.0).abs() < 1e-10, "{shift} {row}");
            }
        }
    }
}

/// Lengths have no scale of their own.
#[test]
fn a_hole_of_any_mass_is_the_same_hole() {
    let turn = |mass: f64| {
        let space = Curved::kerr(mass, 0.6 * mass).unwrap();
        let camera = DistantCamera::at_distance(*space.law(), 1.0, 30.0 * mass).unwrap();
        let (event, k) = camera.ray(7.0 * mass, 2.0 * mass).unwrap();
        let mut ray = space.ray(event, k * 1e3);
        let segments = ray.by_ref().count();
        let End::Sky { wave_vector } = terrell_geodesic::Ray::end(&ray).unwrap() else {
            panic!("it escapes")
        };
        (wave_vector, segments)
    };
    let (one, segments) = turn(1.0);
    for mass in [1e-9, 3.7, 1e12] {
        let (other, count) = turn(mass);
        // The same steps are taken, to rounding.
        assert!((one - other).xyz().length() < 1e-9 * one.xyz().length(), "{one:?} {other:?}");
        assert_eq!(segments, count);
    }
}
