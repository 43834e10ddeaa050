use super::{passing, shipped};
use crate::color::Coloring;
use crate::figure::{Axis, Figure, Panel, Series, Stroke};
use crate::teach::lecture::Lecture;
use crate::teach::plate::{Plate, TeachError};
use glam::DVec3;

const SPEEDS: [f64; 4] = [0.6, 0.9, 0.95, 0.99];
/// What eyes see, nanometres.
const VISIBLE: [f64; 2] = [380.0, 750.0];

pub(super) fn lecture() -> Result<Lecture, TeachError> {
    let mut lecture = Lecture::default();
    let l = &mut lecture;
    l.text(
        "The same Lorentz transformation that tells where a point is seen tells in which colour. Light of frequency ν₀ in the body’s frame arrives \
         with ν = D ν₀, and D is the ratio of two distances, that which is seen and that in the body’s frame:",
    );
    l.formula("D = ν/ν₀ = r/r′");
    l.heading("Two angles");
    l.text(
        "The paper writes it with the angle θ between the motion and the line of sight (Eq. 3). There are two such angles, one in each frame, and each \
         has its own formula. θ′ is measured in the body’s frame, θ in the observer’s; both are 0 where the body moves straight away.",
    );
    l.formula("D = γ (1 − β cos θ′) = 1 / (γ (1 + β cos θ))");
    let rows = SPEEDS.map(|beta| -> Result<_, TeachError> {
        let map = passing(beta)?;
        let d = |at: DVec3| map.see(at).doppler;
        Ok([
            format!("{beta}"),
            l.fixed(format!("D ahead at {beta}"), d(DVec3::NEG_X), 4),
            l.fixed(format!("D behind at {beta}"), d(DVec3::X), 4),
            l.fixed(format!("D at θ′ = 90° at {beta}"), d(DVec3::Y), 4),
            l.fixed(format!("D at θ = 90° at {beta}"), map.doppler_towards(DVec3::Y), 4),
        ])
    });
    let rows = rows.into_iter().collect::<Result<Vec<_>, _>>()?;
    l.table(["β", "coming (Eq. 4)", "going (Eq. 4)", "θ′ = 90°: γ", "θ = 90°: 1/γ"], rows);
    l.text(
        "Straight ahead and behind both formulas agree with Eq. 4, √((1 ± β)/(1 ∓ β)). At right angles they differ by γ²: what *is* at right angles \
         in its own frame is seen in blue light, from ahead; what is *seen* at right angles is red, because its clocks go slow. Mixing up the two \
         is the commonest mistake in this business.",
    );
    l.plates([Plate::figure(
        "angles",
        "D by the direction in which something is seen. Above 1 it is shifted to the blue. The faster, the larger is the part of the sky in which \
         things are shifted to the red, although they are still coming.",
        angles()?,
    )]);
    l.text(
        "Things can come closer and yet be red: D = 1 is not at 90° but ahead of it. The speeds are three of the table of J. Walker’s *C-ship* (Fourmilab), which lesson *Lights \
         and aberration* has whole.",
    );
    let rows = [0.28047668, 0.69861917, 0.96523621].map(|beta| -> Result<_, TeachError> {
        let map = passing(beta)?;
        let at = map.see(DVec3::new(-1.0, 1.0, 0.0));
        Ok([
            format!("{beta:.4}"),
            l.fixed(
                format!("45° is seen at, β = {beta:.4}, degrees"),
                at.position.y.atan2(-at.position.x).to_degrees(),
                2,
            ),
            l.fixed(format!("D there, β = {beta:.4}"), at.doppler, 2),
            l.fixed(format!("D = 1 at, β = {beta:.4}, degrees"), no_shift(beta).to_degrees(), 1),
        ])
    });
    let rows = rows.into_iter().collect::<Result<Vec<_>, _>>()?;
    l.table(["β", "45° at rest is seen at (°)", "D there", "no shift at (°) from ahead"], rows);
    l.heading("Colours");
    l.text(format!(
        "Eyes see from about {} to {} nm. A single line leaves that range at a speed that is easily worked out from D = λ₀/λ:",
        VISIBLE[0], VISIBLE[1]
    ));
    let speed_for = |d: f64| (d * d - 1.0) / (d * d + 1.0);
    let rows =
        [("sodium, 589.0 nm", 589.0), ("hydrogen Hα, 656.3 nm", 656.3), ("hydrogen Hβ, 486.1 nm", 486.1)]
            .map(|(name, line)| {
                [
                    name.to_owned(),
                    l.fixed(format!("{name} ultraviolet when coming at β"), speed_for(line / VISIBLE[0]), 3),
                    l.fixed(format!("{name} infrared when going at β"), -speed_for(line / VISIBLE[1]), 3),
                ]
            });
    l.table(["line", "coming: gone at β", "going: gone at β"], rows);
    let map = passing(0.5)?;
    let [blue, red] = [DVec3::NEG_X, DVec3::X].map(|at| 5772.0 * map.see(at).doppler);
    let (blue, red) =
        (l.fixed("sun coming at 0.5c, kelvin", blue, 0), l.fixed("sun going at 0.5c, kelvin", red, 0));
    l.text(format!(
        "A hot body is kinder: seen with D, a black body of temperature T looks exactly like one of temperature D·T. The sun (5772 K) would look like one \
         of {blue} K coming at 0.5c, bluish white, and like one of {red} K going, orange. What things look like whose spectra do reach into the \
         infrared or ultraviolet, at high speed, depends on light no eye sees at rest: a picture has to assume something."
    ));
    let lattice = |name: &str, caption: &str, beta: f64, coloring: Coloring| -> Result<Plate, TeachError> {
        Ok(Plate::shot(name, caption, shipped("lattice", beta)?.colored(coloring)))
    };
    l.plates([
        lattice("geometry", "A lattice at 0.9c, its shape alone.", 0.9, Coloring::Geometry)?,
        lattice("factor", "D in false colour: white 1, blue above, red below.", 0.9, Coloring::Doppler)?,
        lattice("rest", "With its light, at rest.", 0.0, Coloring::Spectral)?,
        lattice(
            "spectral",
            "With its light, at 0.9c: spectra shifted and brightened.",
            0.9,
            Coloring::Spectral,
        )?,
    ]);
    l.attempt("terrell render gate --color doppler --legend", "D over the whole picture, with its scale");
    l.attempt("terrell render hot --beta 0.5", "glowing metal, coming and going");
    l.attempt("terrell locate --beta 0.9,0,0 -1,1,0 1,1,0", "D of single points, with both angles");
    let map = passing(0.8)?;
    let (ahead, behind) = (map.see(DVec3::NEG_X).doppler, map.see(DVec3::X).doppler);
    let (ahead, behind) =
        (l.fixed("answer: D ahead at 0.8c", ahead, 4), l.fixed("answer: D behind at 0.8c", behind, 4));
    l.ask(
        "What are D ahead and behind at 0.8c, and what do you notice about their product?",
        format!("{ahead} and {behind}: √(1.8/0.2) = 3 and 1/3. Their product is 1 at every speed."),
    );
    Ok(lecture)
}

/// The angle from straight ahead at which light is not shifted: D = 1/(γ(1 − β cos α)) = 1.
fn no_shift(beta: f64) -> f64 {
    let gamma = 1.0 / ((1.0 - beta) * (1.0 + beta)).sqrt();
    ((1.0 - 1.0 / gamma) / beta).acos()
}

fn angles() -> Result<Figure, TeachError> {
    let mut series = Vec::new();
    for beta in [0.5, 0.9, 0.99] {
        let map = passing(beta)?;
        let d = (0..=180).map(|degrees| {
            let (sine, cosine) = f64::from(degrees).to_radians().sin_cos();
            [f64::from(degrees), map.doppler_towards(DVec3::new(-cosine, sine, 0.0))]
        });
        let mut line = Series::line(format!("β = {beta}"), d);
        // Named where they are far apart, for who sees no colours.
        line.points[150].label.clone_from(&line.name);
        series.push(line);
    }
    let one = [[0.0, 1.0], [180.0, 1.0]];
    series.push(Series { stroke: Stroke::Dashed, ink: Some([120; 3]), ..Series::line("", one) });
    let marks = (0..=6).map(|i| (f64::from(30 * i), Some((30 * i).to_string())));
    let panel = Panel {
        x: Axis::linear("direction seen, from straight ahead (°)").from_to(0.0, 180.0).with_marks(marks),
        y: Axis::log("Doppler factor D"),
        series,
        ..Panel::default()
    };
    Ok(Figure { rows: vec![vec![panel]], panel_size: [520.0, 340.0], ..Figure::default() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_is_not_shifted_there() {
        for beta in [0.1, 0.5, 0.9, 0.999] {
            let (sine, cosine) = no_shift(beta).sin_cos();
            let d = passing(beta).unwrap().doppler_towards(DVec3::new(-cosine, sine, 0.0));
            // D is divided by differences as small as 1 − β.
            assert!((d - 1.0).abs() < 1e-12, "{beta} {d}");
        }
    }
}
