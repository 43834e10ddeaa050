use super::{passing, shipped};
use crate::color::Coloring;
use crate::exposure::Exposure;
use crate::figure::{Axis, Figure, Panel, Series, Stroke};
use crate::teach::lecture::Lecture;
use crate::teach::plate::{Plate, TeachError};
use crate::tone::Tone;
use glam::DVec3;

pub(super) fn lecture() -> Result<Lecture, TeachError> {
    let mut lecture = Lecture::default();
    let l = &mut lecture;
    l.text(
        "Brightness changes even more than colour. What does not depend on who looks is the number of photons in a cell of phase space, and so the \
         intensity at a frequency over the cube of the frequency:",
    );
    l.formula("I_ν / ν³ = const          (Eq. 5)");
    l.text("How many powers of D a picture gets depends on what is counted, and on the spectrum:");
    l.table(
        ["what is seen", "goes with"],
        [
            ["intensity at one frequency, of a spectrum flat in ν".to_owned(), "D³".to_owned()],
            ["the same of a spectrum ν^α".to_owned(), "D^(3−α)".to_owned()],
            ["photons in all, from a given direction".to_owned(), "D³".to_owned()],
            ["energy over all frequencies".to_owned(), "D⁴".to_owned()],
            ["intensity by wavelength".to_owned(), "D⁵".to_owned()],
            ["a black body: one of temperature D·T, nothing else".to_owned(), "(D⁴ in all)".to_owned()],
        ],
    );
    let ratio = |beta: f64, power: i32| -> Result<f64, TeachError> {
        let map = passing(beta)?;
        Ok((map.see(DVec3::NEG_X).doppler / map.see(DVec3::X).doppler).powi(power))
    };
    let paper = l.fixed("coming over going at 0.6c, third power", ratio(0.6, 3)?, 0);
    l.text(format!(
        "The paper’s example: at 0.6c what comes is (2.0/0.5)³ = {paper} times as bright as the same thing going. With other exponents and speeds:"
    ));
    let mut rows = Vec::new();
    for beta in [0.3, 0.6, 0.9, 0.99] {
        let mut power = |n: i32| -> Result<String, TeachError> {
            Ok(l.digits(format!("coming over going at {beta}, D^{n}"), ratio(beta, n)?, 3))
        };
        rows.push([format!("{beta}"), power(3)?, power(4)?, power(5)?]);
    }
    l.table(["coming over going at β", "D³", "D⁴", "D⁵"], rows);
    l.heading("The beam");
    l.text(
        "A lamp that shines alike in all directions in its own frame is a searchlight for those it passes: half of its photons go forward within the angle \
         whose cosine is β. The curves show the energy it sends into each direction, which goes with D³: each photon has D times its energy, and a patch of the \
         sky gets D² times as many of them.",
    );
    let rows = [0.5, 0.9, 0.99, 0.999].map(|beta| -> Result<_, TeachError> {
        // A ray at right angles in its own frame, of light that goes out.
        let at = passing(-beta)?.see(DVec3::Y).position;
        let half = at.y.atan2(at.x);
        let energy = energy_within(beta, half);
        Ok([
            format!("{beta}"),
            l.fixed(format!("half the photons within at {beta}, degrees"), half.to_degrees(), 2),
            l.fixed(format!("energy in it at {beta}, percent"), 100.0 * energy, 1),
        ])
    });
    let rows = rows.into_iter().collect::<Result<Vec<_>, _>>()?;
    l.table(["β", "half the photons within (°)", "which carry of the energy (%)"], rows);
    l.plates([Plate::figure(
        "beam",
        "Energy that a lamp sends into each direction (D³), by that to which it sends most; it moves to the right.",
        beam()?,
    )]);
    let sent = l.fixed("sent backward over forward at 0.3, D³", ratio(0.3, -3)?, 3);
    let arriving = l.fixed("arriving from going over coming at 0.3, D⁴", ratio(0.3, -4)?, 3);
    l.text(format!(
        "This is what leaves the lamp, with no regard to when it arrives. Who receives it gets it in a time that is shorter by D as well, so that power as it \
         arrives, and with it brightness, goes with D⁴, as in the table above. At 0.3c a lamp sends {sent} times as much energy backward as forward; \
         of its power {arriving} times as much arrives when it goes as when it comes."
    ));
    l.heading("What a screen can show");
    let stops = ratio(0.9, 4)?.log2();
    let stops = l.fixed("octaves between coming and going at 0.9c, D⁴", stops, 1);
    l.text(format!(
        "A screen shows perhaps eight octaves of brightness, a film ten, eyes twenty once they are used to it. At 0.9c coming and going are {stops} octaves \
         apart (D⁴). So every picture with brightness in it has been exposed for something, and says for what: of these, taken of the same light, \
         each is right and none is complete."
    ));
    let hot =
        |name: &str, caption: &str, beta: f64, tone: Tone, exposure: Exposure| -> Result<Plate, TeachError> {
            let mut shot = shipped("hot", beta)?.colored(Coloring::Spectral);
            (shot.tone, shot.exposure) = (Some(tone), Some(exposure));
            Ok(Plate::shot(name, caption, shot))
        };
    l.plates([
        hot("rest", "Metal that glows at 4500 K, at rest.", 0.0, Tone::Filmic, Exposure::Auto)?,
        hot(
            "as_rest",
            "At 0.9c, exposed as at rest: burnt out where it comes.",
            0.9,
            Tone::Filmic,
            Exposure::Rest,
        )?,
        hot("auto", "Exposed for its bright side.", 0.9, Tone::Filmic, Exposure::Auto)?,
        hot("log", "By the logarithm: twelve octaves.", 0.9, Tone::Log, Exposure::Auto)?,
    ]);
    l.attempt("terrell render hot --tone log --legend", "the last picture, with its scale");
    l.attempt("terrell render gate --exposure rest", "the gate at 0.99c, exposed as at rest");
    l.attempt("terrell render lattice --color bolometric", "D⁴, grey");
    let ratio = l.fixed("answer: coming over going at 0.8c, bolometric", ratio(0.8, 4)?, 0);
    l.ask(
        "A grey body glows evenly. At 0.8c, how many times as much energy does each part of its image bring when it comes as when it goes?",
        format!("D is 3 and 1/3, so (3/(1/3))⁴ = 9⁴ = {ratio}."),
    );
    Ok(lecture)
}

/// What of a lamp's energy goes within an angle of its motion: its share per solid angle is D³/(4πγ), with
/// D = 1/(γ(1 − β cos α)), which is integrated in closed form.
fn energy_within(beta: f64, angle: f64) -> f64 {
    let gamma2 = 1.0 / ((1.0 - beta) * (1.0 + beta));
    let integral = |cosine: f64| 1.0 / (2.0 * beta * (1.0 - beta * cosine).powi(2));
    (integral(1.0) - integral(angle.cos())) / (2.0 * gamma2 * gamma2)
}

fn beam() -> Result<Figure, TeachError> {
    let mut series = Vec::new();
    // With degrees from the motion at which curves have their names.
    for (beta, named, stroke) in [
        (0.0, 60, Stroke::Line),
        (0.3, 50, Stroke::Dashed),
        (0.6, 35, Stroke::Line),
        (0.9, 12, Stroke::Dashed),
    ] {
        let map = passing(beta)?;
        let d = |cosine: f64, sine: f64| map.doppler_towards(DVec3::new(-cosine, sine, 0.0));
        let most = d(1.0, 0.0).powi(3);
        let curve = (0..=720).map(|i| {
            let (sine, cosine) = (f64::from(i) / 2.0).to_radians().sin_cos();
            let share = d(cosine, sine.abs()).powi(3) / most;
            [share * cosine, share * sine]
        });
        let mut curve = Series { stroke, ..Series::line(format!("β = {beta}"), curve) };
        curve.points[2 * named].label.clone_from(&curve.name);
        series.push(curve);
    }
    let panel = Panel {
        x: Axis::linear("along the motion").from_to(-1.1, 1.1),
        y: Axis::linear("across").from_to(-1.1, 1.1),
        series,
        ..Panel::default()
    };
    Ok(Figure { rows: vec![vec![panel]], panel_size: [360.0, 360.0], ..Figure::default() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_of_the_energy_goes_somewhere() {
        for beta in [0.1, 0.5, 0.9, 0.999] {
            let all = energy_within(beta, std::f64::consts::PI);
            assert!((all - 1.0).abs() < 1e-12, "{beta} {all}");
        }
        let beta = 0.6;
        let (steps, half) = (200_000, std::f64::consts::FRAC_PI_4);
        let gamma = 1.25f64;
        let sum: f64 = (0..steps)
            .map(|i| {
                let a = half * (f64::from(i) + 0.5) / f64::from(steps);
                a.sin() * (gamma * (1.0 - beta * a.cos())).powi(-3)
            })
            .sum();
        let numeric = sum * half / f64::from(steps) / (2.0 * gamma);
        // Midpoints: second order of 4e-6.
        assert!((energy_within(beta, half) - numeric).abs() < 1e-9);
    }
}
