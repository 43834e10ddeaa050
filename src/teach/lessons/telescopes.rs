use super::passing;
use crate::figure::{Axis, Figure, INKS, Panel, Point, Series, Stroke};
use crate::spectrum::{Beyond, Shape};
use crate::teach::lecture::Lecture;
use crate::teach::plate::{Plate, TeachError};
use glam::DVec3;
use std::f64::consts::PI;

const BETA: f64 = 0.9;
/// Of the ball, km.
const SIZE: f64 = 10.0;
/// That are to be told apart across it.
const ELEMENTS: f64 = 10.0;
/// Of the light that is looked at.
const NANOMETRES: f64 = 550.0;
/// Speed of light, km/s (exact).
const LIGHT: f64 = 299_792.458;
/// Planck constant, J s (exact).
const PLANCK: f64 = 6.626_070_15e-34;
/// Astronomical unit, km (exact).
const AU: f64 = 149_597_870.7;
/// Kilometres, too.
const PARSEC: f64 = 648_000.0 / PI * AU;
/// Julian, seconds.
const YEAR: f64 = 365.25 * 86_400.0;
/// Diameters, km.
const EARTH: f64 = 12_742.0;
const SUN: f64 = 1.3914e6;
const SUN_KELVIN: f64 = 5772.0;

const PROXIMA: f64 = 1.30 * PARSEC;
const GALAXY: f64 = 8e3 * PARSEC;
/// Where the ball is seen, and how far away that is, km.
const PLACES: [(&str, f64); 6] = [
    ("the moon", 384_400.0),
    ("the sun", AU),
    ("Neptune", 30.07 * AU),
    ("Proxima Centauri", PROXIMA),
    ("the Galaxy’s centre", GALAXY),
    ("Andromeda", 780e3 * PARSEC),
];

pub(super) fn lecture() -> Result<Lecture, TeachError> {
    let mut lecture = Lecture::default();
    let l = &mut lecture;
    l.text(
        "All pictures of this course are computed. Could one be photographed? The paper’s Table 1 asks for the telescope that \
         would see relativistic motion. Its numbers are not repeated here: these are worked out anew, from what is said to be \
         assumed. The body is a ball of 10 km, as balls look round at every speed.",
    );
    l.formula("A = 1.22 λ N d / s");
    l.text(
        "A is the aperture, λ the wavelength that arrives, d the way that the light has gone, s = 10 km the ball’s size, and N \
         how many elements are to be told apart across it. 1.22 λ/A is Rayleigh’s criterion for a round aperture. Assumed are \
         λ = 550 nm, N = 10, and neither air nor flaws of the mirror. The library measures lengths by the time that light \
         takes for them, c = 1; here they are metres and kilometres, and c is 299 792.458 km/s.",
    );
    let mut rows = Vec::new();
    for (place, distance) in PLACES {
        let (time, unit) = lasting(2.0 * distance / (BETA * LIGHT));
        let aperture = aperture(NANOMETRES, distance, SIZE);
        let time = l.digits(format!("passing as far as {place}, {unit}"), time, 3);
        rows.push([
            place.to_owned(),
            l.digits(format!("distance of {place}, km"), distance, 4),
            l.digits(format!("aperture as far as {place}, metres"), aperture, 3),
            format!("{time} {unit}"),
        ]);
    }
    l.table(["as far as", "distance (km)", "aperture (m)", "at 0.9c it passes in"], rows);
    let earths = aperture(NANOMETRES, PROXIMA, SIZE) / (1e3 * EARTH);
    let earths = l.digits("aperture as far as Proxima Centauri, Earth’s diameters", earths, 3);
    let ways = aperture(NANOMETRES, GALAXY, SIZE) / (1e3 * AU);
    let ways = l.digits("aperture as far as the Galaxy’s centre, ways to the sun", ways, 3);
    l.text(format!(
        "As far away as the moon an amateur’s mirror does it, as the sun one of a hundred metres. As far as the nearest star \
         it is {earths} times as wide as the Earth, as the centre of the Galaxy {ways} times as wide as the way to the sun. \
         The last column is how long the ball is seen from 45° before abreast to 45° beyond, 2d/(βc): among the planets it \
         is gone within hours, and at the centre of the Galaxy nobody lives to see it pass.",
    ));
    l.plates([Plate::figure(
        "apertures",
        "Apertures for ten elements across, at 550 nm. Dashed: the largest mirrors; the longest way between the Very Large \
         Telescope’s four, which together tell apart what one of that width does; the Earth’s diameter.",
        apertures(),
    )]);
    let earth = aperture(NANOMETRES, PROXIMA, EARTH) / 1e3;
    let earth = l.digits("aperture for an Earth as far as Proxima Centauri, km", earth, 3);
    let sun = aperture(NANOMETRES, PROXIMA, SUN);
    let sun = l.digits("aperture for a sun as far as Proxima Centauri, metres", sun, 3);
    let radio = l.digits("radio dishes around the Earth, as a mirror of km", EARTH * NANOMETRES / 1.3e6, 3);
    l.text(format!(
        "What is larger is seen from further: as far as the nearest star an Earth takes {earth} km, a sun {sun} m. Radio \
         telescopes all around the Earth have been used as one, at 1.3 mm. That tells apart as much as {radio} km at 550 nm, \
         but only of what shines at 1.3 mm, and is not in the plot.",
    ));
    l.heading("What relativity adds");
    l.text(
        "The wavelength that counts is the one that arrives, λ = λ′/D (here D is the Doppler factor). In the light that the \
         ball sends out at λ′ = 550 nm a smaller telescope does when it comes, by 1/D, and only a larger one when it goes. As \
         far away as the sun:",
    );
    let mut rows = Vec::new();
    for beta in [0.5, 0.9, 0.99] {
        let map = passing(beta)?;
        let mut told = |way: &str, at: DVec3| {
            let arriving = NANOMETRES / map.see(at).doppler;
            let aperture = aperture(arriving, AU, SIZE);
            let arriving = l.fixed(format!("550 nm arrive {way} at {beta}, nm"), arriving, 1);
            [arriving, l.digits(format!("aperture for that {way} at {beta}, metres"), aperture, 3)]
        };
        let [blue, small] = told("coming", DVec3::NEG_X);
        let [red, large] = told("going", DVec3::X);
        rows.push([format!("{beta}"), blue, small, red, large]);
    }
    l.table(["β", "coming: λ (nm)", "aperture (m)", "going: λ (nm)", "aperture (m)"], rows);
    let sent = NANOMETRES * passing(BETA)?.see(DVec3::NEG_X).doppler;
    let sent = l.fixed("seen at 550 nm coming at 0.9, sent at, nm", sent, 0);
    l.text(format!(
        "That is not won for eyes: what comes at 0.9c does so in ultraviolet light, which air does not let through. Who looks \
         at 550 nm needs the aperture of a ball at rest, and sees by light that was sent out in the infrared, at {sent} nm.",
    ));
    l.heading("How long, and by how much light");
    let exposure = SIZE / (ELEMENTS * BETA * LIGHT);
    let crossing = l.digits("time for its own size at 0.9c, microseconds", ELEMENTS * exposure * 1e6, 3);
    let short = l.digits("exposure at 0.9c, microseconds", exposure * 1e6, 3);
    let turning = l.fixed(
        "turning with it as far as the moon, degrees a second",
        (BETA * LIGHT / PLACES[0].1).to_degrees(),
        0,
    );
    l.text(format!(
        "At 0.9c the ball moves by its own size in {crossing} µs. Seen abreast it is smeared by more than an element if the \
         exposure is longer than s/(N β c) = {short} µs, at whatever distance; or the telescope has to turn with it, as far \
         away as the moon by {turning}° a second. An element of the width a = s/N sends into an aperture that is just large \
         enough, in the time t,"
    ));
    l.formula("L (a/d)² (π A²/4) t = L (π/4) (1.22 λ)² t");
    let whole = |kelvin: f64| photons(kelvin) * PI / 4.0 * (1.22e-9 * NANOMETRES).powi(2) * exposure;
    let cooler = SUN_KELVIN * passing(BETA)?.doppler_towards(DVec3::Y);
    let bright = l.digits("photons of an element at rest, millions", whole(SUN_KELVIN) / 1e6, 3);
    let dim = l.digits("photons of an element abreast at 0.9c, thousands", whole(cooler) / 1e3, 3);
    let cooler = l.fixed("temperature seen abreast at 0.9c, kelvin", cooler, 0);
    l.text(format!(
        "photons, if L is how many come from its surface by second, area and solid angle. The distance is gone: the telescope \
         is larger by as much as the light is thinner. If the surface shines as a black body like the sun (5772 K), and all \
         light from 500 to 600 nm is counted without loss, that is {bright} million photons for light that is not shifted. Of \
         the ball seen abreast, where D = 1/γ makes it one of {cooler} K, it is {dim} thousand. A picture takes less."
    ));
    l.heading("What is seen of it");
    l.text(
        "So as far as the sun there are such telescopes, or could be, if only there were the ball: nothing of its size is known \
         there at such a speed. What is as fast is far away, such as the jets that leave the surroundings of black holes, but \
         these are light years long. They follow their own light so closely that they seem to move across the sky faster than \
         light, and that is seen.",
    );
    l.formula("β_app = β sin θ / (1 − β cos θ)");
    let mut rows = Vec::new();
    for beta in [0.9, 0.99, 0.999f64] {
        let mut from = |degrees: f64| {
            let seen = seen_across(beta, degrees.to_radians());
            l.digits(format!("seen across at {beta} from {degrees}°"), seen, 4)
        };
        let [aside, oblique, ahead] = [90.0, 20.0, 5.0].map(&mut from);
        let best = beta.acos();
        let most = l.digits(format!("seen across at {beta} at most"), seen_across(beta, best), 4);
        let best = l.fixed(format!("seen across most at {beta} from, degrees"), best.to_degrees(), 2);
        rows.push([format!("{beta}"), aside, oblique, ahead, most, best]);
    }
    l.table(["β", "θ = 90°", "θ = 20°", "θ = 5°", "most: γβ", "at cos θ = β (°)"], rows);
    let gamma = l.fixed("least γ of what is seen at 6c", 37f64.sqrt(), 2);
    let beta = l.fixed("least β of what is seen at 6c", 6.0 / 37f64.sqrt(), 4);
    let angle = 2.0 * (1.0 / 6.0f64).atan();
    let angle = l.fixed("largest θ of what is seen at 6c, degrees", angle.to_degrees(), 1);
    let apart = 1.22e-9 * NANOMETRES / 2.4 * 16e6 * PARSEC / (LIGHT * YEAR);
    let years = l.fixed("time for that at 6c, years", apart / 6.0, 1);
    let apart = l.fixed("what Hubble tells apart in M 87, light years", apart, 1);
    l.text(format!(
        "θ is the angle between the motion and the direction to us. The Hubble telescope has seen knots in the jet of the \
         galaxy M 87 move at 6c. Whatever θ is, that takes γ ≥ √(1 + 6²) = {gamma}, which is β = {beta}, and β_app is never \
         more than cot(θ/2), so the jet points to us within {angle}°. A mirror of 2.4 m tells apart {apart} light years there \
         (16 Mpc away, at 550 nm): at 6c that is a matter of {years} years."
    ));
    l.text(
        "Jets show the speed, but they have no edges that could be seen to turn or to bend. At such speeds no telescope shows \
         what becomes of *shapes*: that has to be computed.",
    );
    l.attempt(
        "terrell render cube --beta 0.9 --size 25x14 --color geometry",
        "a cube of some ten elements across, as such a telescope sees it: is it turned?",
    );
    l.attempt(
        "terrell locate --beta 0.9,0,0 --inverse -1,0,0 0,1,0 1,0,0",
        "D of what is seen ahead, abreast and behind: wavelengths arrive divided by it",
    );
    let seen = l.fixed("try: seen to move at 0.8c from cos θ = 0.8", 0.8 / (1.0 - 0.8 * 0.8), 2);
    let across = l.fixed("try: across the line of sight", seen_across(0.8, 0.8f64.acos()), 2);
    l.attempt(
        "terrell locate --beta 0.8,0,0 --offset=-1000,-800,600,0 --observer 1,0,0,0 0,0,0",
        &format!(
            "a knot at 0.8c, which a unit of time before was seen at x = −800: it seems to have moved by {seen}, and by \
             {across} across the line of sight, where light moves by 1"
        ),
    );
    let d = passing(0.8)?.see(DVec3::NEG_X).doppler;
    let metres = l.fixed("answer: aperture, metres", aperture(NANOMETRES / d, AU, SIZE), 1);
    let arriving = l.fixed("answer: arriving at, nm", NANOMETRES / d, 0);
    let d = l.fixed("answer: D ahead at 0.8c", d, 0);
    l.ask(
        "The ball comes straight at you at 0.8c, as far away as the sun, and shines at 550 nm in its own frame. Which aperture \
         tells apart ten elements across it in that light, and what is it like on the ground?",
        format!(
            "D is {d}, so the light arrives at {arriving} nm and {metres} m are enough, a third of what is needed at rest. On \
             the ground it is dark: air does not let such light through."
        ),
    );
    Ok(lecture)
}

/// How wide a telescope has to be, metres, for light that arrives with a wavelength; distance and size in one unit.
fn aperture(nanometres: f64, distance: f64, size: f64) -> f64 {
    1.22e-9 * nanometres * ELEMENTS * distance / size
}

/// A time in the unit that people use.
fn lasting(seconds: f64) -> (f64, &'static str) {
    match seconds {
        s if s < 60.0 => (s, "seconds"),
        s if s < 3600.0 => (s / 60.0, "minutes"),
        s if s < YEAR => (s / 3600.0, "hours"),
        s => (s / YEAR, "years"),
    }
}

/// Photons from a black body from 500 to 600 nm, by second, square metre and steradian.
fn photons(kelvin: f64) -> f64 {
    let body = Shape::BlackBody { kelvin };
    // Watts by metre of wavelength, over a nanometre, by photon.
    let within = |nm: f64| body.at(nm, Beyond::Dark) * 1e-9 * (nm * 1e-9) / (PLANCK * LIGHT * 1e3);
    (500..600).map(|nm| within(f64::from(nm) + 0.5)).sum()
}

/// How fast what moves at an angle to the line of sight, which leads to the observer, is seen to move across it.
fn seen_across(beta: f64, angle: f64) -> f64 {
    beta * angle.sin() / (1.0 - beta * angle.cos())
}

fn apertures() -> Figure {
    const ENDS: [f64; 2] = [1e5, 1e20];
    let at = |distance: f64, size: f64| [distance, aperture(NANOMETRES, distance, size)];
    let point = |[x, y]: [f64; 2], label: &str| Point { x, y, label: label.into(), ..Point::default() };
    let ball = PLACES.map(|(place, distance)| point(at(distance, SIZE), place));
    let mut series = vec![Series {
        points: ball.into(),
        marked: true,
        ink: Some(INKS[0]),
        ..Series::line("a ball of 10 km", [])
    }];
    for (name, label, size, ink) in [
        ("as large as the Earth", "an Earth", EARTH, INKS[2]),
        ("as large as the sun", "a sun", SUN, INKS[1]),
    ] {
        // Named on the line, too, for who sees no colours.
        let points =
            [(ENDS[0], ""), (1e12, label), (ENDS[1], "")].map(|(far, label)| point(at(far, size), label));
        let line = Series::line(name, []);
        series.push(Series { points: points.into(), ink: Some(ink), ..line });
    }
    // Each is named where there is room.
    for (name, metres, there) in
        [("10 m", 10.0, 1e18), ("130 m", 130.0, 1e18), ("the Earth’s diameter", 1e3 * EARTH, 1e8)]
    {
        let points =
            vec![point([ENDS[0], metres], ""), point([there, metres], name), point([ENDS[1], metres], "")];
        let (stroke, ink) = (Stroke::Dashed, Some([120; 3]));
        series.push(Series { points, stroke, ink, ..Series::default() });
    }
    let panel = Panel {
        x: Axis::log("distance (km)").from_to(ENDS[0], ENDS[1]),
        y: Axis::log("aperture (m)").from_to(1e-2, 1e14),
        series,
        ..Panel::default()
    };
    Figure { rows: vec![vec![panel]], panel_size: [600.0, 420.0], ..Figure::default() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::relativity::{ApparentMap, Motion};
    use terrell_geodesic::{Celerity, Event, Tetrad};

    /// Of the map from what is to what is seen, at two moments.
    #[test]
    fn what_is_seen_moves_as_fast_across() {
        for beta in [0.5, 0.9] {
            for degrees in [20.0, 60.0, 90.0, 150.0f64] {
                let (sine, cosine) = degrees.to_radians().sin_cos();
                let towards = DVec3::new(-cosine, sine, 0.0);
                let celerity = Celerity::from_beta(DVec3::X * beta).unwrap();
                let motion = Motion { celerity, origin: Event::at(-1.0, towards) };
                let seen = |t: f64| {
                    let observer = Tetrad::of_world(Event::at(t, DVec3::ZERO));
                    ApparentMap::new(&motion, &observer).see(DVec3::ZERO).position
                };
                let step = 1e-5;
                let velocity = (seen(step) - seen(-step)) / (2.0 * step);
                let across = velocity.reject_from_normalized(towards).length();
                let expected = seen_across(beta, degrees.to_radians());
                // Central differences: the square of the step times derivatives up to 10⁵.
                assert!((across - expected).abs() < 1e-5, "{beta} {degrees}: {across} {expected}");
            }
        }
    }
}
