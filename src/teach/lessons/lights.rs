use super::passing;
use crate::color::Coloring;
use crate::exposure::Exposure;
use crate::scene::{Scene, builtin_scene, shapes};
use crate::teach::lecture::Lecture;
use crate::teach::plate::{Plate, Shot, TeachError};
use crate::tone::Tone;
use glam::DVec3;
use std::sync::Arc;

pub(super) fn lecture() -> Result<Lecture, TeachError> {
    let mut lecture = Lecture::default();
    let l = &mut lecture;
    l.text(
        "Where does the sun shine on a ball that moves? What counts is the ball’s own frame: its surface is at rest there, its normal is what it is, and a matt surface scatters \
         as it does at rest. In that frame the sunlight comes from elsewhere, with another frequency and another strength. So a light is transformed into the frame of \
         each surface, the surface is lit there as ever, and what it reflects is seen like light of its own.",
    );
    l.plates([
        Plate::shot("balls", "Four equal white balls at 0, 0.5c, 0.9c, 0.99c, lit by one sun at the right, rising; without shift and beaming.", Shot::new(plain()?)),
        Plate::shot("chequer", "The same balls with a chequer, which shows how they seem to be turned.", Shot::new(sunlit()?)),
        Plate::shot("log", "The white ones with shift and beaming, by the logarithm of brightness: of the fastest a thin crescent is left.", {
            let mut shot = Shot::new(plain()?).colored(Coloring::Spectral);
            // The fourth is to be seen, though the first is all but white.
            (shot.tone, shot.exposure) = (Some(Tone::Log), Some(Exposure::Fixed(2.0)));
            shot
        }),
    ]);
    l.text(
        "The faster the ball, the more its front is lit: in its own frame the sun has moved forward. The camera sees ever more of its back. What is both lit and seen \
         becomes a crescent.",
    );
    l.heading("Where the light comes from");
    l.formula("cos ι′ = (cos ι + β) / (1 + β cos ι)");
    l.text("ι is the angle between the motion and the direction to a distant light, in the frame where the light is given; ι′ the same in the moving body’s frame.");
    let (mut rows, mut cone) = (Vec::new(), String::new());
    for beta in [0.5, 0.9, 0.99] {
        let at = |degrees: f64| -> Result<f64, TeachError> {
            let (sine, cosine) = degrees.to_radians().sin_cos();
            // Who moves along x sees what rests pass the other way.
            let seen = passing(-beta)?.see(DVec3::new(cosine, sine, 0.0)).position;
            Ok(seen.y.atan2(seen.x).to_degrees())
        };
        // What is told last is of the fastest.
        cone = l.fixed(format!("light from 90° at {beta}, degrees"), at(90.0)?, 2);
        rows.push([
            format!("{beta}"),
            l.fixed(format!("light from 45° at {beta}, degrees"), at(45.0)?, 2),
            cone.clone(),
            l.fixed(format!("light from 135° at {beta}, degrees"), at(135.0)?, 2),
        ]);
    }
    l.table(["β", "from 45°", "from 90°", "from 135°"], rows);
    // Of D² over all directions at rest, which is the energy of light from all around, how much is ahead.
    let ahead = |beta: f64| (1.0 + beta + beta * beta / 3.0) / (2.0 + 2.0 / 3.0 * beta * beta);
    let share = l.fixed("energy of starlight from within that at 0.99, percent", 100.0 * ahead(0.99), 1);
    l.text(format!(
        "The column of 90° is arccos β: half of the sky, and all that comes from it, is gathered within that angle of straight ahead. At 0.99c half of the stars are within \
         {cone}° of it, and {share} % of the energy of their light comes from there, if they are spread evenly over the sky at rest: a ball in the light of all the stars is \
         lit nearly from the front alone."
    ));
    l.text(
        "The *C-ship* of J. Walker’s pages (Fourmilab) flies ever faster. A table there says from where, aboard, light comes that at rest comes from 45° off straight ahead, and by \
         how much it is shifted to the blue. For its four speeds, worked out anew:",
    );
    let mut rows = Vec::new();
    for beta in C_SHIP {
        let map = passing(-beta)?;
        let seen = map.see(DVec3::new(1.0, 1.0, 0.0));
        let angle = seen.position.y.atan2(seen.position.x).to_degrees();
        rows.push([
            format!("{beta:.4}"),
            l.fixed(format!("C-ship: 1/γ at {beta:.4}"), 1.0 / map.gamma(), 5),
            l.digits(format!("C-ship: light from 45° at {beta:.4}, degrees"), angle, 3),
            l.fixed(format!("C-ship: D of it at {beta:.4}"), seen.doppler, 2),
        ]);
    }
    l.table(["β of the C-ship", "1/γ", "from 45°", "D"], rows);
    l.heading("How strong it is");
    let mut rows = Vec::new();
    for beta in [0.5, 0.9, 0.99] {
        let map = passing(-beta)?;
        let d = |at: DVec3| map.see(at).doppler;
        let mut told = |name: &str, at: DVec3| {
            let d = d(at);
            let factor = l.fixed(format!("D of light from {name} at {beta}"), d, 4);
            [factor, l.digits(format!("power of light from {name} at {beta}"), d * d, 4)]
        };
        let [ahead, power_ahead] = told("ahead", DVec3::X);
        let [aside, power_aside] = told("90°", DVec3::Y);
        rows.push([format!("{beta}"), ahead, power_ahead, aside, power_aside]);
    }
    l.table(["β", "from ahead: D", "power", "from 90°: D", "power"], rows);
    l.text(
        "A surface that faces a distant light gets D² times the power, one factor for each photon’s energy, one for how many arrive in a second. Even light from the side is \
         stronger, by γ². What the surface sends on is then seen with the D of the surface itself, which may well undo it.",
    );
    l.attempt("terrell render sunlit --color geometry", "the second picture, larger");
    l.attempt("terrell render sunlit --tone log --legend", "its light as it is seen, by logarithms");
    l.attempt("terrell render box", "lit by a body in motion, with reflections");
    let seen = passing(-0.8)?.see(DVec3::Y).position;
    let angle = l.fixed("answer: light from the side at 0.8c, degrees", seen.y.atan2(seen.x).to_degrees(), 2);
    l.ask(
        "A ship flies at 0.8c at right angles to the sunlight. From which direction is it lit, in its own frame?",
        format!("arccos 0.8 = {angle}° from straight ahead."),
    );
    Ok(lecture)
}

/// Speeds of J. Walker's C-ship.
const C_SHIP: [f64; 4] = [0.28047668, 0.69861917, 0.96523621, 0.9996484];

fn sunlit() -> Result<Scene, TeachError> {
    Ok(builtin_scene("sunlit")?.scene())
}

/// Without a chequer, in which one does not see where light ends.
fn plain() -> Result<Scene, TeachError> {
    let mut scene = sunlit()?;
    let ball = Arc::new(shapes::ball());
    for body in &mut scene.bodies {
        body.mesh = ball.clone();
    }
    Ok(scene)
}
