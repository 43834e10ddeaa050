//! Lessons: every number they tell is that of a closed form, of the paper, or of tables others have made.

use std::collections::HashSet;
use terrell::teach::{Lecture, What, lesson, lessons, told};

/// √((1 + β)/(1 − β)).
fn ahead(beta: f64) -> f64 {
    ((1.0 + beta) / (1.0 - beta)).sqrt()
}

fn gamma(beta: f64) -> f64 {
    1.0 / ((1.0 - beta) * (1.0 + beta)).sqrt()
}

/// All of a lesson's numbers are these, to a relative tolerance each; none is left out.
fn tells(name: &str, expected: &[(String, f64, f64)]) {
    tells_like(&lesson(name).unwrap().lecture().unwrap(), name, expected);
}

/// As [`tells`], of a lecture made before: what is measured differs from one to the next.
fn tells_like(lecture: &Lecture, name: &str, expected: &[(String, f64, f64)]) {
    let told: HashSet<&str> = lecture.numbers.iter().map(|n| n.name.as_str()).collect();
    assert_eq!(told.len(), lecture.numbers.len(), "{name} has two numbers of one name");
    for (number, value, tolerance) in expected {
        let found = lecture.number(number).unwrap_or_else(|| panic!("{name} tells no '{number}'"));
        let off = (found - value).abs() / value.abs().max(1.0);
        assert!(off <= *tolerance, "{name}: '{number}' is {found}, not {value}");
    }
    let known: HashSet<&str> = expected.iter().map(|(number, ..)| number.as_str()).collect();
    let unknown: Vec<_> = told.difference(&known).collect();
    assert!(unknown.is_empty(), "{name}: untested {unknown:?}");
}

/// Of closed forms, to rounding.
const ROUNDING: f64 = 1e-12;

fn exact(name: impl Into<String>, value: f64) -> (String, f64, f64) {
    (name.into(), value, ROUNDING)
}

#[test]
fn seeing() {
    let (b, g) = (0.9, gamma(0.9));
    tells(
        "seeing",
        &[
            exact("length measured", 1.0 / g),
            exact("rod coming, measured", 1.0 / g),
            exact("rod going, measured", 1.0 / g),
            exact("rod coming, delay alone", 10.0),
            exact("rod going, delay alone", 1.0 / 1.9),
            exact("rod coming, seen", ahead(b)),
            exact("rod going, seen", 1.0 / ahead(b)),
            exact("middle is ahead of where it is seen by", 2.7),
            // A thousand lengths away perspective is a thousandth.
            ("near side of a small cube".into(), 1.0 / g, 1e-3),
            ("back of a small cube".into(), b, 1e-3),
            exact("answer: measured at 0.6c", 0.8),
            exact("answer: seen at 0.6c", 2.0),
        ],
    );
}

#[test]
fn rods() {
    let mut expected = vec![exact("answer: coming", -35.0 / 3.0), exact("answer: going", -5.0 / 3.0)];
    for beta in [0.5, 0.9, 0.99f64] {
        expected.push(exact(format!("stretch of what comes at {beta}"), ahead(beta)));
        expected.push(exact(format!("squeeze of what goes at {beta}"), 1.0 / ahead(beta)));
        expected.push(exact(format!("lean of a far rod at {beta}, degrees"), beta.asin().to_degrees()));
    }
    // A quarter of the tolerance takes twice the pieces, but for whole numbers.
    let lecture = lesson("rods").unwrap().lecture().unwrap();
    let mut last = None;
    for tolerance in ["1", "0.25", "0.0625"] {
        let name = format!("pieces at {tolerance} px");
        let pieces = lecture.number(&name).unwrap();
        if let Some(last) = last {
            assert!((pieces - 2.0 * last as f64).abs() <= 4.0, "{tolerance}: {pieces} after {last}");
        }
        last = Some(pieces as u32);
        expected.push(exact(name, pieces));
    }
    // All five rods come to the line of flight within each panel.
    let plate = lecture.all_plates().find(|plate| plate.name == "hyperbolas").unwrap();
    let What::Figure(figure) = &plate.what else { panic!("no figure") };
    for (panel, beta) in figure.rows.iter().flatten().zip([0.0, 0.5, 0.9, 0.99f64]) {
        let [left, right] = panel.x.range.unwrap();
        for x in [-4.0, -2.0, 0.0, 2.0, 4.0f64] {
            let seen = gamma(beta) * (x - beta * x.abs());
            let is_it = |p: &terrell::figure::Point| p.y == 0.0 && (p.x - seen).abs() < 1e-9;
            assert!(left < seen && seen < right, "{beta} {x}");
            assert!(panel.series.iter().any(|series| series.points.iter().any(is_it)), "{beta} {x}");
        }
    }
    tells("rods", &expected);
}

#[test]
fn the_lattice() {
    let mut expected = vec![
        exact("first ball that is seen behind, 0.99c", 0.99 * gamma(0.99)),
        // That is behind the last of them, and three are at 1, 2 and 4.
        exact("balls that are seen coming, 0.99c", 7.0),
        exact("balls that are past", 3.0),
        exact("answer: ball that is abreast at 0.6c", 0.0),
        exact("answer: x′ of that ball", 0.75),
    ];
    for beta in [0.5, 0.9, 0.99] {
        for x in [-4.0, -2.0, -1.0, 0.0, 1.0, 2.0, 4.0f64] {
            // Eq. 1.
            let seen = gamma(beta) * (x - beta * x.hypot(1.0));
            expected.push(exact(format!("ball at {x}, {beta}c"), seen));
        }
    }
    tells("lattice", &expected);
}

#[test]
fn the_cube() {
    let mut expected = Vec::new();
    for (beta, turn) in [(0.5, 30.0), (0.9, 64.16), (0.99, 81.89f64)] {
        expected.push((format!("near side at {beta}"), 1.0 / gamma(beta), 1e-3));
        expected.push((format!("back at {beta}"), beta, 1e-3));
        // Two digits are given, and perspective is a thousandth of a radian.
        expected.push((format!("turn at {beta}, degrees"), turn, 1e-3));
        let sine = beta * gamma(beta);
        expected.push(exact(format!("arcsin of {beta}, degrees"), sine.atan().to_degrees()));
    }
    expected.push(("answer: near side at 0.8c".into(), 0.6, 1e-3));
    expected.push(("answer: back at 0.8c".into(), 0.8, 1e-3));
    expected.push(exact("answer: arcsin of 0.8, degrees", (4.0f64 / 3.0).atan().to_degrees()));
    for beta in [0.5, 0.9, 0.99] {
        let mut last = 0.0;
        for distance in [100.0, 30.0, 10.0, 3.0, 1.5] {
            let mut worst = 0f64;
            for corner in 0..8 {
                let [x, y, z] = [1, 2, 4].map(|bit| if corner & bit == 0 { -0.5 } else { 0.5f64 });
                // Eq. 1, and the cube turned by the angle; both in a picture at the distance of their middle.
                let (along, away) = (gamma(beta) * beta * distance + x, distance + y);
                let seen = gamma(beta) * (along - beta * (along * along + away * away + z * z).sqrt());
                let (sine, cosine) = beta.asin().sin_cos();
                let (turned, deep) = (cosine * x - sine * y, distance + sine * x + cosine * y);
                let apart = [seen / away - turned / deep, z / away - z / deep];
                worst = worst.max(distance * apart[0].hypot(apart[1]));
            }
            // It grows as they come nearer.
            assert!(worst > last, "{beta} {distance}");
            last = worst;
            // What is seen loses a few digits far away.
            expected.push((format!("misfit at {distance} and {beta}"), worst, 1e-10));
        }
    }
    tells("cube", &expected);
}

#[test]
fn the_gate() {
    let mut expected = vec![
        exact("ahead if nearer behind than, per metre aside", 0.99 * gamma(0.99)),
        exact("answer: beside at 0.6c, degrees", 0.6f64.acos().to_degrees()),
        exact("further on than within the gate, metres", 12.0),
        exact("looking back, past the gate by, metres", 340.0),
        exact("looking back, the gate looks to be at, metres", 340.0 / ahead(0.99)),
    ];
    for (name, x) in [
        ("10 m ahead, 3 m aside", 10.0),
        ("just beside, 3 m away", 0.0),
        ("10 m behind, 3 m aside", -10.0),
        ("20 m behind, 3 m aside", -20.0),
        ("30 m behind, 3 m aside", -30.0f64),
    ] {
        let cosine = x / x.hypot(3.0);
        let seen = (cosine + 0.99) / (1.0 + 0.99 * cosine);
        expected.push((format!("{name}, at rest, degrees"), cosine.acos().to_degrees(), 1e-12));
        // The cosine loses digits beside the axis.
        expected.push((format!("{name}, at 0.99c, degrees"), seen.acos().to_degrees(), 1e-10));
    }
    tells("gate", &expected);
}

#[test]
fn doppler() {
    let mut expected = vec![
        exact("answer: D ahead at 0.8c", 3.0),
        exact("answer: D behind at 0.8c", 1.0 / 3.0),
        exact("sun coming at 0.5c, kelvin", 5772.0 * 3f64.sqrt()),
        exact("sun going at 0.5c, kelvin", 5772.0 / 3f64.sqrt()),
    ];
    for beta in [0.6, 0.9, 0.95, 0.99] {
        expected.push(exact(format!("D ahead at {beta}"), ahead(beta)));
        expected.push(exact(format!("D behind at {beta}"), 1.0 / ahead(beta)));
        expected.push(exact(format!("D at θ′ = 90° at {beta}"), gamma(beta)));
        expected.push(exact(format!("D at θ = 90° at {beta}"), 1.0 / gamma(beta)));
    }
    // The fly-through table of J. Walker's C-ship, as it is printed.
    for (beta, angle, d) in [("0.2805", 34.5, 1.25), ("0.6986", 19.8, 2.09), ("0.9652", 6.31, 6.44)] {
        expected.push((format!("45° is seen at, β = {beta}, degrees"), angle, 2e-3));
        expected.push((format!("D there, β = {beta}"), d, 3e-3));
    }
    for (short, beta) in [("0.2805", 0.28047668), ("0.6986", 0.69861917), ("0.9652", 0.96523621)] {
        let angle = ((1.0 - 1.0 / gamma(beta)) / beta).acos();
        expected.push(exact(format!("D = 1 at, β = {short}, degrees"), angle.to_degrees()));
    }
    for (line, nanometres) in
        [("sodium, 589.0 nm", 589.0), ("hydrogen Hα, 656.3 nm", 656.3), ("hydrogen Hβ, 486.1 nm", 486.1)]
    {
        let lecture = lesson("doppler").unwrap().lecture().unwrap();
        let speed = |what: &str| lecture.number(&format!("{line} {what} at β")).unwrap();
        let (blue, red) = (speed("ultraviolet when coming"), speed("infrared when going"));
        // At that speed it is at the end of what eyes see.
        assert!(
            (nanometres / ahead(blue) - 380.0).abs() < 1e-9 && (nanometres * ahead(red) - 750.0).abs() < 1e-9
        );
        expected.push(exact(format!("{line} ultraviolet when coming at β"), blue));
        expected.push(exact(format!("{line} infrared when going at β"), red));
    }
    tells("doppler", &expected);
}

#[test]
fn the_searchlight() {
    let mut expected = vec![
        // The paper's own figure.
        exact("coming over going at 0.6c, third power", 64.0),
        exact("octaves between coming and going at 0.9c, D⁴", 8.0 * ahead(0.9).log2()),
        exact("sent backward over forward at 0.3, D³", (7.0f64 / 13.0).powi(3)),
        exact("arriving from going over coming at 0.3, D⁴", (7.0f64 / 13.0).powi(4)),
        exact("answer: coming over going at 0.8c, bolometric", 6561.0),
    ];
    for beta in [0.3, 0.6, 0.9, 0.99] {
        for n in [3, 4, 5] {
            expected.push(exact(format!("coming over going at {beta}, D^{n}"), ahead(beta).powi(2 * n)));
        }
    }
    for beta in [0.5, 0.9, 0.99, 0.999f64] {
        expected.push(exact(format!("half the photons within at {beta}, degrees"), beta.acos().to_degrees()));
        expected.push(exact(format!("energy in it at {beta}, percent"), 25.0 * (2.0 + beta)));
    }
    tells("searchlight", &expected);
}

#[test]
fn shadows() {
    let (lamp, height, beta) = (4.0, 1.1, 0.8);
    let at = |sine: f64| lamp / ((lamp - height) / beta + height * sine);
    // The least of when it is seen, looked for by steps.
    let seen = |x: f64| {
        let way = x.hypot(lamp - height);
        x / beta + way * height / (lamp - height) + 14.0 - x * lamp / (lamp - height)
    };
    let first =
        (0..400_000).map(|i| f64::from(i) * 1e-5).min_by(|a, b| seen(*a).total_cmp(&seen(*b))).unwrap();
    let lever = lamp / (lamp - height);
    let lecture = lesson("shadows").unwrap().lecture().unwrap();
    for image in ["image that goes away, one later", "image that comes, one later"] {
        let place = lecture.number(image).unwrap();
        assert!((seen(place / lever) - seen(first) - 1.0).abs() < 1e-8, "{image}: {place}");
    }
    let image = |name: &str| exact(name, lecture.number(name).unwrap());
    tells(
        "shadows",
        &[
            exact("speed of the shadow beneath the lamp", at(0.0)),
            exact("speed of the shadow far before", at(-1.0)),
            exact("speed of the shadow far beyond", at(1.0)),
            ("where the shadow is first seen".into(), first * lever, 1e-4),
            ("when the shadow is first seen".into(), seen(first), 1e-9),
            image("image that goes away, one later"),
            image("image that comes, one later"),
            exact("answer: speed beneath a lamp at 2", 1.2),
        ],
    );
}

#[test]
fn the_observer() {
    let mut expected = vec![exact("answer: x′ of what is seen abreast", 3.0)];
    let (beta, g) = (0.9, gamma(0.9));
    for (x, rho) in [(-3.0, 1.0), (0.0, 1.0), (2.0, 1.0), (5.0f64, 3.0f64)] {
        let r = x.hypot(rho);
        expected.push(exact(format!("({x}, {rho}) is seen at x"), g * (x - beta * r)));
        expected.push(exact(format!("({x}, {rho}) is seen from a distance"), g * (r - beta * x)));
        expected.push(exact(format!("({x}, {rho}) is taken back to x"), x));
    }
    tells("observer", &expected);
}

#[test]
fn the_sphere() {
    let mut expected = vec![exact("answer: radius at rest, degrees", (1.0 / 3.0f64).asin().to_degrees())];
    let cosine = (8.0f64 / 9.0).sqrt();
    for beta in [0.0, 0.5, 0.9, 0.99] {
        let (g, u) = (gamma(beta), gamma(beta) * beta);
        // The plane of the cone is boosted as a four-vector.
        let radius = (g * cosine / (1.0 + (u * cosine).powi(2)).sqrt()).acos();
        let off = u.atan() - (u * cosine).atan();
        expected.push(exact(format!("off the circle at {beta}, radians"), 0.0));
        expected.push(exact(format!("radius of the circle at {beta}, degrees"), radius.to_degrees()));
        expected.push(exact(format!("middle off the circle’s at {beta}, degrees"), off.to_degrees()));
    }
    tells("sphere", &expected);
}

#[test]
fn fields_of_view() {
    // By central differences over 10⁻⁴, to the square of that times derivatives up to 100.
    let near = |name: String, value: f64| (name, value, 1e-6);
    let mut expected = vec![near("answer: pinhole at 60°, along over across".into(), 2.0)];
    for degrees in [30.0, 45.0, 60.0f64] {
        let (theta, cosine) = (degrees.to_radians(), degrees.to_radians().cos());
        expected.push(near(format!("pinhole along at {degrees}°"), 1.0 / (cosine * cosine)));
        expected.push(near(format!("pinhole across at {degrees}°"), 1.0 / cosine));
        expected.push(near(format!("fisheye along at {degrees}°"), 1.0));
        expected.push(near(format!("fisheye across at {degrees}°"), theta / theta.sin()));
    }
    let d = gamma(0.9) * 1.45;
    expected.push(near("aberration shrinks along by".into(), 1.0 / d));
    expected.push(near("aberration shrinks across by".into(), 1.0 / d));
    expected.push(exact("one over D there", 1.0 / d));
    tells("fields", &expected);
}

#[test]
fn lights() {
    let mut expected =
        vec![exact("answer: light from the side at 0.8c, degrees", 0.8f64.acos().to_degrees())];
    // D⁴ over the directions of the ball's frame, from cosines of β to 1, as a part of all.
    let share = {
        let cubed = |cosine: f64| (1.0 - 0.99 * cosine).powi(-3);
        (cubed(1.0) - cubed(0.99)) / (cubed(1.0) - cubed(-1.0))
    };
    expected.push((
        "energy of starlight from within that at 0.99, percent".into(),
        100.0 * share,
        // 1 − β loses digits.
        1e-11,
    ));
    // The fly-through table of J. Walker's C-ship, as it is printed.
    let lecture = lesson("lights").unwrap().lecture().unwrap();
    for (short, beta, angle, d) in [
        ("0.2805", 0.28047668, 34.5, 1.25),
        ("0.6986", 0.69861917, 19.8, 2.09),
        ("0.9652", 0.96523621, 6.31, 6.44),
        ("0.9996", 0.9996484, 0.629, 64.37f64),
    ] {
        let names = ["light from 45°", "D of it"].map(|what| format!("C-ship: {what} at {short}"));
        let [told, shift] = [format!("{}, degrees", names[0]), names[1].clone()];
        for (name, printed, half) in
            [(&told, angle, if angle > 10.0 { 0.05 } else { 0.005 }), (&shift, d, 0.005f64)]
        {
            assert!((lecture.number(name).unwrap() - printed).abs() <= half, "{name}");
        }
        assert!((lecture.number(&told).unwrap() - angle).abs() < 1e-3 || angle > 1.0);
        // Half of the angle has a tangent that is divided by the shift of what is straight ahead.
        let half = (22.5f64.to_radians().tan() / ahead(beta)).atan();
        expected.push((told, 2.0 * half.to_degrees(), 1e-11));
        expected.push((shift, gamma(beta) * (1.0 + beta * 0.5f64.sqrt()), ROUNDING));
        expected.push(exact(format!("C-ship: 1/γ at {short}"), 1.0 / gamma(beta)));
    }
    for beta in [0.5, 0.9, 0.99] {
        for degrees in [45.0, 90.0, 135.0f64] {
            let cosine = degrees.to_radians().cos();
            let seen = ((cosine + beta) / (1.0 + beta * cosine)).acos();
            expected.push((format!("light from {degrees}° at {beta}, degrees"), seen.to_degrees(), 1e-11));
        }
        for (name, d) in [("ahead", ahead(beta)), ("90°", gamma(beta))] {
            expected.push(exact(format!("D of light from {name} at {beta}"), d));
            expected.push(exact(format!("power of light from {name} at {beta}"), d * d));
        }
    }
    tells("lights", &expected);
}

#[test]
fn telescopes() {
    const PI: f64 = std::f64::consts::PI;
    // Kilometres and seconds.
    let (light, au, year) = (299_792.458, 149_597_870.7, 365.25 * 86_400.0);
    let parsec = au * 648_000.0 / PI;
    // Rayleigh’s criterion, ten elements across; metres for kilometres.
    let aperture = |nanometres: f64, distance: f64, size: f64| 12.2 * nanometres * 1e-9 * distance / size;
    let star = |size: f64| aperture(550.0, 1.30 * parsec, size);
    let hubble = 1.22 * 550e-9 / 2.4 * 16e6 * parsec / (light * year);
    let turning = 0.9 * light / 384_400.0 * 180.0 / PI;
    let (galaxy, earth) = (aperture(550.0, 8e3 * parsec, 10.0), 12_742.0);
    let mut expected = vec![
        exact("aperture as far as Proxima Centauri, Earth’s diameters", star(10.0) / earth / 1e3),
        exact("aperture as far as the Galaxy’s centre, ways to the sun", galaxy / au / 1e3),
        exact("aperture for an Earth as far as Proxima Centauri, km", star(earth) / 1e3),
        exact("aperture for a sun as far as Proxima Centauri, metres", star(2.0 * 695_700.0)),
        exact("radio dishes around the Earth, as a mirror of km", earth * 550e-9 / 1.3e-3),
        exact("seen at 550 nm coming at 0.9, sent at, nm", 550.0 * ahead(0.9)),
        exact("time for its own size at 0.9c, microseconds", 10e6 / (0.9 * light)),
        exact("exposure at 0.9c, microseconds", 1e6 / (0.9 * light)),
        exact("turning with it as far as the moon, degrees a second", turning),
        exact("temperature seen abreast at 0.9c, kelvin", 5772.0 / gamma(0.9)),
        // As its discoverers say it: γ of 6 at least, within 19° of the line of sight.
        ("least γ of what is seen at 6c".into(), 6.0, 0.02),
        exact("least β of what is seen at 6c", (1.0 - 1.0 / 37.0f64).sqrt()),
        ("largest θ of what is seen at 6c, degrees".into(), 19.0, 0.01),
        exact("what Hubble tells apart in M 87, light years", hubble),
        exact("time for that at 6c, years", hubble / 6.0),
        exact("try: seen to move at 0.8c from cos θ = 0.8", 20.0 / 9.0),
        exact("try: across the line of sight", 4.0 / 3.0),
        exact("answer: D ahead at 0.8c", 3.0),
        exact("answer: arriving at, nm", 550.0 / 3.0),
        exact("answer: aperture, metres", aperture(550.0, au, 10.0) / 3.0),
    ];
    for (place, distance, unit, seconds) in [
        ("the moon", 384_400.0, "seconds", 1.0),
        ("the sun", au, "minutes", 60.0),
        ("Neptune", 30.07 * au, "hours", 3600.0),
        ("Proxima Centauri", 1.30 * parsec, "years", year),
        ("the Galaxy’s centre", 8_000.0 * parsec, "years", year),
        ("Andromeda", 0.78e6 * parsec, "years", year),
    ] {
        expected.push(exact(format!("distance of {place}, km"), distance));
        expected.push(exact(format!("aperture as far as {place}, metres"), aperture(550.0, distance, 10.0)));
        let time = 2.0 * distance / (0.9 * light);
        expected.push(exact(format!("passing as far as {place}, {unit}"), time / seconds));
    }
    for beta in [0.5, 0.9, 0.99] {
        for (way, d) in [("coming", ahead(beta)), ("going", 1.0 / ahead(beta))] {
            let metres = aperture(550.0, au, 10.0) / d;
            expected.push(exact(format!("550 nm arrive {way} at {beta}, nm"), 550.0 / d));
            expected.push(exact(format!("aperture for that {way} at {beta}, metres"), metres));
        }
    }
    for beta in [0.9, 0.99, 0.999f64] {
        for degrees in [90.0, 20.0, 5.0f64] {
            let (sine, cosine) = degrees.to_radians().sin_cos();
            let seen = beta * sine / (1.0 - beta * cosine);
            expected.push(exact(format!("seen across at {beta} from {degrees}°"), seen));
        }
        expected.push(exact(format!("seen across at {beta} at most"), gamma(beta) * beta));
        let angle = (1.0 / (gamma(beta) * beta)).atan();
        expected.push(exact(format!("seen across most at {beta} from, degrees"), angle.to_degrees()));
    }
    // Photons of a black body: 2c/a³ times the integral of x²/(eˣ − 1) over x = a/λ, a = hc/(kT), term by term.
    let photons = |kelvin: f64| {
        let a = 6.626_070_15e-34 * light * 1e3 / (1.380_649e-23 * kelvin);
        let beyond = |x: f64| -> f64 {
            let term = |n: f64| (-n * x).exp() * (x * x / n + 2.0 * x / (n * n) + 2.0 / (n * n * n));
            (1..40).map(|n| term(f64::from(n))).sum()
        };
        2.0 * light * 1e3 / a.powi(3) * (beyond(a / 600e-9) - beyond(a / 500e-9))
    };
    let whole = |kelvin: f64| photons(kelvin) * PI / 4.0 * (1.22 * 550e-9f64).powi(2) / (0.9 * light);
    // Sums by a nanometre: to a 24th of its square times slopes up to a hundredth.
    let summed = |name: &str, value: f64| (name.to_owned(), value, 1e-5);
    expected.push(summed("photons of an element at rest, millions", whole(5772.0) / 1e6));
    let cooler = 5772.0 / gamma(0.9);
    expected.push(summed("photons of an element abreast at 0.9c, thousands", whole(cooler) / 1e3));
    tells("telescopes", &expected);
}

#[test]
fn speed() {
    let lecture = lesson("speed").unwrap().lecture().unwrap();
    let number = |name: &str| lecture.number(name).unwrap();
    let mut expected = vec![
        exact("wrong pixels, exact", 0.0),
        exact("γ up to which lines of sight have digits", 1e5),
        exact("answer: pieces, by a 64th of the tolerance", 8.0),
    ];
    let measured = |name: String| (name.clone(), number(&name), ROUNDING);
    let mut before = None;
    for tolerance in [4.0, 1.0, 0.25, 0.0625, 0.015625] {
        let of = |what: &str| format!("{what} at {tolerance} px");
        let (pieces, wrong) = (number(&of("pieces")), number(&of("wrong pixels")));
        // What cutting keeps to, and f64 adds nothing to that can be seen.
        assert!(number(&of("edges off")) <= tolerance, "{tolerance}");
        if let Some((more, worse)) = before {
            // Edges alone would be twice as many, faces alone four times.
            assert!(pieces >= more && pieces <= 4.2 * more, "{tolerance}: {more} {pieces}");
            assert!(wrong <= worse, "{tolerance}: {worse} {wrong}");
        }
        before = Some((pieces, wrong));
        assert!(number(&of("milliseconds")) > 0.0);
        expected
            .extend(["pieces", "edges off", "wrong pixels", "milliseconds"].map(|what| measured(of(what))));
    }
    for series in ["uncut", "exact"] {
        assert!(number(&format!("milliseconds, {series}")) > 0.0);
        expected.push(measured(format!("milliseconds, {series}")));
    }
    assert!(number("wrong pixels, uncut") > number("wrong pixels at 4 px"));
    expected.push(measured("wrong pixels, uncut".into()));
    for gamma in [10.0, 1e3, 1e5, 1e7f64] {
        let digits = |how: &str| number(&format!("digits of {how}, γ = {gamma}"));
        // β is off by up to half a unit, βr′ by another: as parts of 1 − β they are 2γ² of that.
        for (how, epsilon) in [("Eq. 1 in f64", f64::EPSILON), ("Eq. 1 in f32", f32::EPSILON.into())] {
            let least = -(2.5 * gamma * gamma * epsilon).log10();
            assert!(digits(how) >= least.max(0.0), "{how}, {gamma}: {} {least}", digits(how));
            // By luck a few more than that.
            assert!(digits(how) <= least.max(0.0) + 2.5, "{how}, {gamma}: {} {least}", digits(how));
        }
        assert!(digits("what is used") > 15.0);
        let all = ["Eq. 1 in f64", "Eq. 1 in f32", "what is used"];
        expected.extend(all.map(|how| measured(format!("digits of {how}, γ = {gamma}"))));
    }
    tells_like(&lecture, "speed", &expected);
}

#[test]
fn bending() {
    let lecture = lesson("bending").unwrap().lecture().unwrap();
    let number = |name: &str| lecture.number(name).unwrap();
    let mut expected = vec![
        exact("critical b", 3.0 * 3f64.sqrt()),
        // Eddington's figure, as it is printed.
        ("answer: deflection at the sun’s edge, arc seconds".into(), 1.75, 1e-3),
    ];
    for b in [100.0, 30.0, 10.0, 6.0, 5.3, 5.2f64] {
        let traced = number(&format!("deflection at b = {b}, traced, degrees"));
        let closed = number(&format!("deflection at b = {b}, closed form, degrees"));
        // Steps are followed to 10⁻¹²; beside the critical ray errors grow by a hundred.
        assert!((traced / closed - 1.0).abs() < 1e-8, "{b}: {traced} {closed}");
        expected.push(exact(format!("deflection at b = {b}, traced, degrees"), traced));
        expected.push(exact(format!("deflection at b = {b}, closed form, degrees"), closed));
        expected.push(exact(format!("4M/b at b = {b}, degrees"), (4.0 / b).to_degrees()));
    }
    for distance in [1000.0, 100.0, 22.0f64] {
        let far = (2.0 / distance).sqrt();
        expected.push(exact(format!("ring, far away, from {distance} M, degrees"), far.to_degrees()));
        let name = format!("ring, traced, from {distance} M, degrees");
        let traced = number(&name).to_radians();
        // Light is bent by 4M/b + 15πM²/4b² + 128M³/3b³: what that adds to the ring, and what is left.
        let second = far + 15.0 * std::f64::consts::PI / (32.0 * distance);
        let left = 2.0 / distance;
        assert!((traced / second - 1.0).abs() < left + 0.3 * far * far, "{distance}: {traced} {second}");
        expected.push(exact(name, traced.to_degrees()));
    }
    let (coarse, fine) = (number("pieces to 0.1 M"), number("pieces to 0.001 M"));
    // As one over the root of the sagitta, but for whole numbers and the straight ends.
    assert!((5.0..15.0).contains(&(fine / coarse)), "{coarse} {fine}");
    expected.push(exact("pieces to 0.1 M", coarse));
    expected.push(exact("pieces to 0.001 M", fine));
    // The figure shows as many, whose ends are on the ray and whose middles are nearly.
    let plate = lecture.all_plates().find(|plate| plate.name == "segments").unwrap();
    let What::Figure(figure) = &plate.what else { panic!("no figure") };
    let series = &figure.rows[0][0].series;
    let ends = |marked: bool| -> Vec<[f64; 2]> {
        let named = series.iter().find(|s| s.marked == marked && !s.name.is_empty()).unwrap();
        named.points.iter().map(|p| [p.x, p.y]).collect()
    };
    let (pieces, ray) = (ends(true), ends(false));
    assert!(pieces.len() - 1 == coarse as usize && ray.len() - 1 == fine as usize);
    let off = |[x, y]: [f64; 2]| {
        let to = |pair: &[[f64; 2]]| {
            let ([a, b], [c, d]) = (pair[0], [pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]]);
            let at = (((x - a) * c + (y - b) * d) / (c * c + d * d)).clamp(0.0, 1.0);
            (a + at * c - x).hypot(b + at * d - y)
        };
        ray.windows(2).map(to).fold(f64::INFINITY, f64::min)
    };
    let near = |p: &[f64; 2]| p[0].hypot(p[1]) < 30.0;
    assert!(pieces.iter().filter(|p| near(p)).all(|p| off(*p) < 0.002));
    let middles = pieces.windows(2).filter(|pair| pair.iter().all(near));
    let most =
        middles.map(|p| off([0.5 * (p[0][0] + p[1][0]), 0.5 * (p[0][1] + p[1][1])])).fold(0.0, f64::max);
    assert!((0.03..0.102).contains(&most), "{most}");
    tells("bending", &expected);
}

#[test]
fn lessons_are_whole() {
    for lesson in lessons() {
        let lecture = lesson.lecture().unwrap();
        assert!((2..=3).contains(&lecture.tries.len()), "{}", lesson.name);
        assert!(!lecture.question.text.is_empty() && !lecture.question.answer.is_empty());
        let names: Vec<_> = lecture.all_plates().map(|plate| &plate.name).collect();
        assert_eq!(names.len(), names.iter().collect::<HashSet<_>>().len(), "{}", lesson.name);
        for plate in lecture.all_plates() {
            if let What::Shot(shot) = &plate.what {
                assert!(shot.scene.camera().is_ok(), "{} {}", lesson.name, plate.name);
            }
        }
        let text = told(lesson, &lecture, 84, false, None);
        // Commands and tables are not broken.
        let prose = |line: &&str| !line.starts_with("  ");
        assert!(text.lines().filter(prose).all(|line| line.chars().count() <= 84), "{text}");
        assert!(!text.contains('\x1b') && !text.contains("NaN") && !text.contains(" inf "), "{text}");
    }
}
