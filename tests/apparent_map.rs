//! The apparent map against values of 60-digit arithmetic.

mod common;

use common::{cases, points, vec3};
use glam::DVec3;
use serde_json::Value;
use terrell::geodesic::{Celerity, Event, FourVector, Tetrad, Wide};
use terrell::relativity::{ApparentMap, MapLane, Motion, Points, PointsMut};

/// Half a unit in the last place of f64, relative: what a rounded input is off by at most.
const ULP_HALF: f64 = f64::EPSILON / 2.0;

fn map_of(row: &Value) -> ApparentMap {
    let event = |key: &str| {
        let v: Vec<f64> = row[key].as_array().unwrap().iter().map(|c| c.as_f64().unwrap()).collect();
        Event::new(v[0], v[1], v[2], v[3])
    };
    let motion = Motion { celerity: Celerity::new(vec3(&row["u"])).unwrap(), origin: event("A") };
    ApparentMap::new(&motion, &Tetrad::of_world(event("O")))
}

/// A point as every path of the map sees it: one by one, in the instructions every x86-64 has, and in those this
/// processor has.
fn seen_by_all_paths<R: MapLane>(
    map: &ApparentMap,
    x: [R; 3],
    zero: R,
    single: ([R; 3], R, R),
) -> Vec<([R; 3], R, R)> {
    let mut out = vec![single];
    for base in [true, false] {
        let mut seen = [[zero]; 5];
        let [a, b, c, d, e] = &mut seen;
        let rest = Points { x: &x[..1], y: &x[1..2], z: &x[2..] };
        let to = PointsMut { x: a, y: b, z: c, distance: d, doppler: e };
        if base {
            map.see_all_base(rest, to)
        } else {
            map.see_all(rest, to)
        }
        out.push(([seen[0][0], seen[1][0], seen[2][0]], seen[3][0], seen[4][0]));
    }
    out
}

/// The promise: 5·10⁻¹⁶ of the distance, times the conditioning of the input where that exceeds 1.
#[test]
fn f64_is_within_5e_16_times_the_conditioning() {
    let mut worst = 0f64;
    for row in points() {
        let (map, x) = (map_of(&row), vec3(&row["x_rest"]));
        let sight = map.see(x);
        let single = (sight.position.to_array(), sight.distance, sight.doppler);
        let r = row["r"].as_f64().unwrap();
        let d = row["D"].as_f64().unwrap();
        let condition = row["condition"].as_f64().unwrap().max(1.0);
        for (position, distance, doppler) in seen_by_all_paths(&map, x.to_array(), 0.0, single) {
            let error = (DVec3::from_array(position) - vec3(&row["apparent"])).length() / r;
            worst = worst.max(error / condition);
            assert!(error <= 5e-16 * condition, "{}: {error:e} at conditioning {condition}", row["kind"]);
            assert!((doppler / d - 1.0).abs() <= 1e-15 * condition, "{}", row["kind"]);
            assert!((distance / r - 1.0).abs() <= 5e-16 * condition, "{}", row["kind"]);
        }
    }
    println!("worst f64 error over r, per conditioning: {worst:e}");
}

#[test]
fn f32_is_within_3e_7_times_the_conditioning() {
    let mut worst = 0f64;
    for row in points() {
        let x = vec3(&row["x_f32"]).as_vec3().to_array();
        let map = map_of(&row);
        let r = row["r_f32"].as_f64().unwrap();
        let condition = row["condition"].as_f64().unwrap().max(1.0);
        for (position, distance, doppler) in seen_by_all_paths(&map, x, 0.0, map.see_f32(x)) {
            let error =
                (DVec3::from_array(position.map(f64::from)) - vec3(&row["apparent_f32"])).length() / r;
            worst = worst.max(error / condition);
            assert!(error <= 3e-7 * condition, "{}: {error:e} at conditioning {condition}", row["kind"]);
            assert!((f64::from(distance) / r - 1.0).abs() <= 3e-7 * condition);
            assert!((f64::from(doppler) / row["D_f32"].as_f64().unwrap() - 1.0).abs() <= 6e-7 * condition);
        }
    }
    println!("worst f32 error over r, per conditioning: {worst:e}");
}

/// The independent reference's own points; its `cond_1ulp` is the effect of moving every input one unit in
/// the last place, so conditioning is that over half a unit.
#[test]
fn the_independent_reference_agrees() {
    let mut worst = 0f64;
    for row in cases()["points"].as_array().unwrap() {
        let map = map_of(row);
        let sight = map.see(vec3(&row["x_rest"]));
        let r = row["r"].as_f64().unwrap();
        let error = (sight.position - vec3(&row["apparent"])).length() / r;
        let condition = (row["cond_1ulp"].as_f64().unwrap() / (2.0 * ULP_HALF)).max(1.0);
        worst = worst.max(error / condition);
        assert!(error <= 5e-16 * condition, "{}: {error:e}, {condition}", row["i"]);
        assert!((sight.doppler / row["D"].as_f64().unwrap() - 1.0).abs() <= 1e-15 * condition);
        let towards = map.doppler_towards(sight.position / sight.distance);
        // The direction itself is rounded, which D feels up to γ times where it changes fastest.
        let feels =
            1.0 + map.speed() * sight.doppler * (1.0 - sight.cos_theta_observer.powi(2)).max(0.0).sqrt();
        assert!((towards / sight.doppler - 1.0).abs() <= 1e-15 * condition * feels);
    }
    println!("worst error over r, per conditioning: {worst:e}");
}

#[test]
fn a_moving_camera_sees_through_two_boosts_and_the_wigner_rotation() {
    for row in cases()["moving_camera"]["rows"].as_array().unwrap() {
        let event = |key: &str| {
            let v: Vec<f64> = row[key].as_array().unwrap().iter().map(|c| c.as_f64().unwrap()).collect();
            Event::new(v[0], v[1], v[2], v[3])
        };
        let motion = Motion {
            celerity: Celerity::new(vec3(&row["object_u_world"])).unwrap(),
            origin: event("object_A_world"),
        };
        // right, up, forward = right, forward × … is left-handed for x, y, z; look along z with y up: right = −x.
        let celerity = Celerity::new(vec3(&row["camera_u_world"])).unwrap();
        let observer = Tetrad::new(event("camera_event_world"), celerity, DVec3::Z, DVec3::Y).unwrap();
        let sight = ApparentMap::new(&motion, &observer).see(vec3(&row["x_rest"]));
        let in_axes = sight.position * DVec3::new(-1.0, 1.0, 1.0);
        let expected = vec3(&row["apparent_camera"]);
        let error = (in_axes - expected).length() / expected.length();
        // γ of these rows is below 11 and offsets below 20 lengths: conditioning below 100.
        assert!(error < 100.0 * f64::EPSILON, "{error:e}");
        assert!((sight.doppler / row["D"].as_f64().unwrap() - 1.0).abs() < 100.0 * f64::EPSILON);
        let whole = observer.observer_from_world::<Wide>() * motion.world_from_rest::<Wide>();
        assert!((whole.gamma().high / row["relative_gamma"].as_f64().unwrap() - 1.0).abs() < 1e-15);
    }
}

#[test]
fn vectors_and_scalars_agree_and_so_do_base_and_avx2() {
    let rows = points();
    let row = &rows[30];
    let map = map_of(row);
    let n = 103;
    let coordinate = |k: f64| (0..n).map(|i| ((i as f64 + k) * 0.7).sin() * 3.0).collect::<Vec<f64>>();
    let (x, y, z) = (coordinate(0.0), coordinate(31.0), coordinate(77.0));
    let fill = |base: bool| {
        let mut out = vec![vec![0.0; n]; 5];
        let [a, b, c, d, e] = &mut out[..] else { unreachable!() };
        let seen = PointsMut { x: a, y: b, z: c, distance: d, doppler: e };
        let rest = Points { x: &x, y: &y, z: &z };
        if base {
            map.see_all_base(rest, seen)
        } else {
            map.see_all(rest, seen)
        }
        out
    };
    let (base, fast) = (fill(true), fill(false));
    for i in 0..n {
        let sight = map.see(DVec3::new(x[i], y[i], z[i]));
        for out in [&base, &fast] {
            let position = DVec3::new(out[0][i], out[1][i], out[2][i]);
            assert!((position - sight.position).length() <= 5e-16 * 2.0 * sight.distance);
            assert!((out[3][i] / sight.distance - 1.0).abs() <= 1e-15);
            assert!((out[4][i] / sight.doppler - 1.0).abs() <= 1e-15);
        }
    }
}

/// Eq. 2's curve: the physical branch of the hyperbola, against the reference and by its own equation.
#[test]
fn a_straight_rod_is_seen_as_the_hyperbola_of_eq_2() {
    for row in cases()["hyperbola"]["rows"].as_array().unwrap() {
        let number = |key: &str| row[key].as_f64().unwrap();
        let celerity = Celerity::from_beta(DVec3::X * number("beta")).unwrap();
        let map = ApparentMap::new(
            &Motion { celerity, origin: Event::origin() },
            &Tetrad::of_world(Event::origin()),
        );
        let sight = map.see(DVec3::new(number("x_rest"), number("rho"), 0.0));
        // β is rounded; γ feels that γ² times.
        let off = 4.0 * f64::EPSILON * celerity.gamma().powi(2) * number("r");
        assert!((sight.position.x - number("x")).abs() <= off);
        assert_eq!(sight.position.y, number("rho"));
        // (x/γ − x′)² − β²(x′² + ρ²) = 0 with x′: (x − γx′)² = γ²β²(x′² + ρ²)
        let (gamma, speed) = (celerity.gamma(), celerity.magnitude());
        let (x_rest, rho) = (number("x_rest"), number("rho"));
        let residual =
            (sight.position.x - gamma * x_rest).powi(2) - speed * speed * (x_rest * x_rest + rho * rho);
        assert!(residual.abs() <= 16.0 * f64::EPSILON * (gamma * sight.distance).powi(2).max(1.0));
        assert!(sight.position.x <= gamma * x_rest, "the other branch is the future light cone");
    }
}

#[test]
fn the_inverse_leads_back() {
    for row in points() {
        let map = map_of(&row);
        let x_rest = vec3(&row["x_rest"]);
        let sight = map.see(x_rest);
        let (back, again) = map.unsee(sight.position);
        // One rounding of the apparent position turns its direction by ε: D ε in the rest sky, and D itself by
        // γβ D sin θ ε.
        let sin = (1.0 - sight.cos_theta_observer.powi(2)).max(0.0).sqrt();
        let feels = 1.0 + sight.doppler + map.speed() * sight.doppler * sin;
        let off = (back - x_rest).length() / (sight.rest_distance + x_rest.length());
        assert!(off <= 8.0 * f64::EPSILON * feels, "{}: {off:e}, D {}", row["kind"], sight.doppler);
        assert!((again.doppler / sight.doppler - 1.0).abs() <= 8.0 * f64::EPSILON * feels);
    }
}

/// Fig. 2 as data: the corners of the cube and every sampled point of its edges.
#[test]
fn the_cube_of_fig_2_is_where_the_reference_sees_it() {
    for row in cases()["fig2_cube"]["rows"].as_array().unwrap() {
        let celerity = Celerity::from_beta(DVec3::X * row["beta"].as_f64().unwrap()).unwrap();
        let offset: Vec<f64> =
            row["object_offset"].as_array().unwrap().iter().map(|c| c.as_f64().unwrap()).collect();
        let motion = Motion { celerity, origin: Event::new(offset[0], offset[1], offset[2], offset[3]) };
        let map = ApparentMap::new(&motion, &Tetrad::of_world(Event::origin()));
        let corners = row["corners"].as_array().unwrap();
        for corner in corners {
            let sight = map.see(vec3(&corner["x_rest"]));
            assert!((sight.position - vec3(&corner["apparent"])).length() < 1e-13);
            assert!((sight.doppler - corner["D"].as_f64().unwrap()).abs() < 1e-13);
        }
        for edge in row["edges"].as_array().unwrap() {
            let end = |i: usize| vec3(&corners[edge["v"][i].as_u64().unwrap() as usize]["x_rest"]);
            for (t, seen) in edge["t"].as_array().unwrap().iter().zip(edge["apparent"].as_array().unwrap()) {
                let sight = map.see(end(0).lerp(end(1), t.as_f64().unwrap()));
                assert!((sight.position - vec3(seen)).length() < 1e-13);
            }
        }
    }
}

/// A small cube seen abreast projects like one turned by arcsin β (Figs. 4, 5).
#[test]
fn a_distant_cube_seen_abreast_is_turned_by_arcsin_beta() {
    for (beta, degrees) in [(0.5, 30.0), (0.9, 64.16), (0.99, 81.89)] {
        let celerity = Celerity::from_beta(DVec3::X * beta).unwrap();
        let distance = 1e5;
        let start = Motion { celerity, origin: Event::new(17.0, 4.0, distance, 0.0) };
        let observer = start.seen_abreast(DVec3::ZERO, &Tetrad::of_world(Event::origin())).unwrap();
        let map = ApparentMap::new(&start, &observer);
        let centre = map.see(DVec3::ZERO).position;
        assert!(centre.x.abs() < 1e-9 * distance, "seen abreast");
        // Depth (y) seen as width: sin of the angle. Length (x) seen as width: cos.
        let depth = map.see(DVec3::Y * 0.5).position.x - map.see(DVec3::Y * -0.5).position.x;
        let length = map.see(DVec3::X * 0.5).position.x - map.see(DVec3::X * -0.5).position.x;
        let angle = (-depth).atan2(length);
        assert!((angle - f64::asin(beta)).abs() < 1e-4, "cube's size over its distance is 1e-5");
        assert!((angle.to_degrees() - degrees).abs() < 0.01);
    }
}

/// A sphere's outline is a circle on the sky at every speed (Penrose 1959).
#[test]
fn the_outline_of_a_sphere_is_a_circle() {
    for row in cases()["sphere_outline"]["rows"].as_array().unwrap() {
        let celerity = match row["beta"].as_f64() {
            Some(beta) => Celerity::from_beta(DVec3::X * beta).unwrap(),
            None => Celerity::new(vec3(&row["u"])).unwrap(),
        };
        let map = ApparentMap::new(
            &Motion { celerity, origin: Event::origin() },
            &Tetrad::of_world(Event::origin()),
        );
        let (centre, radius) = (vec3(&row["centre_rest"]), row["radius"].as_f64().unwrap());
        let distance = centre.length();
        // Points where lines of sight graze the sphere in the rest frame.
        let (along, across) = (centre / distance, (distance * distance - radius * radius).sqrt());
        let (e1, e2) = along.any_orthonormal_pair();
        let outline_centre = vec3(&row["outline_centre"]);
        let expected = row["outline_angular_radius_deg"].as_f64().unwrap().to_radians();
        for i in 0..24 {
            let angle = f64::from(i) * std::f64::consts::TAU / 24.0;
            let side = e1 * angle.cos() + e2 * angle.sin();
            let grazing = along * (across * across / distance) + side * (radius * across / distance);
            let n = map.see(grazing).position.normalize();
            let off = n.cross(outline_centre).length().atan2(n.dot(outline_centre)) - expected;
            // The file's angles carry 15 digits.
            assert!(off.abs() < 1e-12, "{off:e}");
        }
    }
}

/// Eq. 4's values, and Eq. 3 in both frames' angles.
#[test]
fn doppler_factors_of_eq_3_and_4() {
    for (beta, ahead, behind) in [(0.6, 2.0, 0.5), (0.95, 6.245, 0.1601), (0.99, 14.11, 0.0709)] {
        let celerity = Celerity::from_beta(DVec3::X * beta).unwrap();
        let map = ApparentMap::new(
            &Motion { celerity, origin: Event::origin() },
            &Tetrad::of_world(Event::origin()),
        );
        let rounding = 5e-4 * ahead; // the paper prints four digits
        assert!((map.doppler_towards(-DVec3::X) - ahead).abs() < rounding);
        assert!((map.doppler_towards(DVec3::X) - behind).abs() < rounding);
        for i in 0..=36 {
            let theta = f64::from(i) * 5f64.to_radians();
            let sight = map.see(DVec3::new(theta.cos(), theta.sin(), 0.0));
            let gamma = celerity.gamma();
            let by_rest_angle = gamma * (1.0 - beta * sight.cos_theta_rest);
            let by_observer_angle = 1.0 / (gamma * (1.0 + beta * sight.cos_theta_observer));
            assert!((by_rest_angle / sight.doppler - 1.0).abs() < 1e-13);
            assert!((by_observer_angle / sight.doppler - 1.0).abs() < 1e-13);
        }
    }
}

#[test]
fn the_doppler_factor_of_a_direction_is_good_at_every_gamma() {
    // Looking back at a receding body and ahead at an approaching one, γ to 1e9.
    for gamma in [1.0, 1.0 + 1e-12, 10.0, 1e3, 1e6, 1e9] {
        let celerity = Celerity::from_gamma(gamma, DVec3::X).unwrap();
        let map = ApparentMap::new(
            &Motion { celerity, origin: Event::origin() },
            &Tetrad::of_world(Event::origin()),
        );
        let k = celerity.gamma() + celerity.magnitude();
        assert!((map.doppler_towards(-DVec3::X) / k - 1.0).abs() < 4e-16);
        assert!((map.doppler_towards(DVec3::X) * k - 1.0).abs() < 4e-16);
        assert!((map.doppler_towards(DVec3::Y) * celerity.gamma() - 1.0).abs() < 4e-16);
    }
}

/// The same picture from the tracer's side: D = 1/|K′ᵗ| for the boosted wave vector.
#[test]
fn the_boosted_wave_vector_tells_the_same_doppler_factor() {
    let celerity = Celerity::new(DVec3::new(1.0, -2.0, 0.5)).unwrap();
    let motion = Motion { celerity, origin: Event::origin() };
    let map = ApparentMap::new(&motion, &Tetrad::of_world(Event::origin()));
    let rest_from_world = motion.world_from_rest::<f64>().inverse();
    for i in 0..50 {
        let n = DVec3::new((i as f64).sin(), (2.3 * i as f64).cos(), (0.7 * i as f64).sin()).normalize();
        let k = rest_from_world * FourVector::seen_from(n);
        assert!((map.doppler_towards(n) * k.t.abs() - 1.0).abs() < 1e-14);
    }
}

/// Where a point is asked to appear, there it appears: before, abreast and beyond, at any speed, camera moving or not.
#[test]
fn a_point_appears_as_far_beyond_abreast_as_asked() {
    let camera = Celerity::new(DVec3::new(0.3, -0.8, 0.1)).unwrap();
    for celerity in [DVec3::X * 1e-6, DVec3::new(0.5, 0.2, 0.0), DVec3::new(-3.0, 1.0, 30.0)] {
        let celerity = Celerity::new(celerity).unwrap();
        let motion = Motion { celerity, origin: Event::new(3.0, 1.0, -2.0, 0.5) };
        let x_rest = DVec3::new(0.4, 0.1, -0.3);
        for observer in [Celerity::at_rest(), camera] {
            let observer = Tetrad::new(Event::new(1.0, 0.0, 5.0, 2.0), observer, DVec3::Y, DVec3::Z).unwrap();
            for passed in [-7.0, 0.0, 0.01, 20.0] {
                let map = ApparentMap::new(&motion, &motion.seen_passed(x_rest, &observer, passed).unwrap());
                let seen = map.see(x_rest).position;
                // The event is f64: its rounding over β.
                let tolerance = 1e-12 * (1.0 + 1.0 / map.speed()) * (1.0 + seen.length());
                assert!((seen.dot(map.axis_observer()) - passed).abs() < tolerance, "{passed} {seen}");
            }
        }
    }
}
