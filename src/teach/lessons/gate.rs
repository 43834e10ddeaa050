use super::shipped;
use crate::figure::{Axis, Figure, Panel, Series, Stroke};
use crate::relativity::{ApparentMap, Motion};
use crate::scene::builtin_scene;
use crate::teach::lecture::Lecture;
use crate::teach::plate::{Plate, Shot, TeachError};
use glam::DVec3;
use terrell_geodesic::{Celerity, Event, Tetrad};

const BETA: f64 = 0.99;

pub(super) fn lecture() -> Result<Lecture, TeachError> {
    let mut lecture = Lecture::default();
    let l = &mut lecture;
    l.text(
        "Now the camera flies, through a gate at rest, at 0.99c. Only relative motion matters, so Eq. 1 holds as before; in the camera’s frame it is \
         the gate that moves.",
    );
    let at = |name: &str, caption: &str, x: f64| -> Result<Plate, TeachError> {
        let mut shot = shipped("gate", BETA)?;
        shot.scene.view.set_time(x / BETA)?;
        Ok(Plate::shot(name, caption, shot))
    };
    let mut rest = Shot::new(builtin_scene("gate")?.scene());
    rest.scene.view.celerity = Celerity::at_rest();
    l.plates([
        Plate::shot("rest", "From the same place, at rest: between the rows of columns.", rest),
        at(
            "inside",
            "At 0.99c: the whole gate, the columns beside the camera included, is seen ahead.",
            0.0,
        )?,
    ]);
    l.text(
        "Flying fast, one sees what is beside and even behind in front: directions are aberrated towards the direction of flight. The gate seems to be \
         *still ahead* when the camera is in its middle, and seems to recede at first when the camera starts to move faster.",
    );
    l.formula("cos θ = (cos θ′ + β) / (1 + β cos θ′)");
    let map = flying(BETA)?;
    let angle = |p: DVec3| {
        let at = map.see(p).position;
        at.y.hypot(at.z).atan2(at.x).to_degrees()
    };
    let mut rows = Vec::new();
    for (name, p) in [
        ("10 m ahead, 3 m aside", DVec3::new(10.0, 3.0, 0.0)),
        ("just beside, 3 m away", DVec3::new(0.0, 3.0, 0.0)),
        ("10 m behind, 3 m aside", DVec3::new(-10.0, 3.0, 0.0)),
        ("20 m behind, 3 m aside", DVec3::new(-20.0, 3.0, 0.0)),
        ("30 m behind, 3 m aside", DVec3::new(-30.0, 3.0, 0.0)),
    ] {
        let at_rest = p.y.atan2(p.x).to_degrees();
        rows.push([
            name.to_owned(),
            l.fixed(format!("{name}, at rest, degrees"), at_rest, 1),
            l.fixed(format!("{name}, at 0.99c, degrees"), angle(p), 1),
        ]);
    }
    l.table(["a point", "direction at rest (°)", "at 0.99c (°)"], rows);
    l.heading("What is right and what is wrong about “seeing its back from inside”");
    let limit = l.fixed("ahead if nearer behind than, per metre aside", map.speed(), 3);
    l.text(format!(
        "It is often said that one sees the back of the gate while still inside. That is not so: *whether* a surface is visible does not depend on \
         speed, since light that reaches the camera reaches anyone else who is there at that moment, and who stands inside sees no backs. Backs come into view \
         beyond the exit, at every speed. What speed changes is *where* they are seen. A point ρ aside and d behind is seen ahead as \
         long as d < βγρ, at 0.99c {limit} ρ: so beyond the exit, the gate’s back is seen in front, and the gate still seems to be around the camera."
    ));
    l.plates([Plate::figure(
        "aberration",
        "Where a direction is seen that is at θ′ for who is at rest there: nearly all of the sky gathers ahead.",
        aberration()?,
    )]);
    let (mut out, mut back) = (shipped("gate", BETA)?, Shot::new(builtin_scene("gate_back")?.scene()));
    out.scene.view.set_time(out.scene.view.event.t() + 12.0 / BETA)?;
    back.samples = 4;
    let further = out.scene.view.event.position().x - builtin_scene("gate")?.scene().view.event.position().x;
    let further = l.fixed("further on than within the gate, metres", further, 0);
    let past = back.scene.view.event.position().x - back.scene.bodies[0].motion.origin.position().x;
    let looks = l.fixed(
        "looking back, the gate looks to be at, metres",
        map.see(DVec3::X * -past).position.length(),
        0,
    );
    let past = l.fixed("looking back, past the gate by, metres", past, 0);
    l.plates([
        Plate::shot("beyond", format!("{further} m further, beyond the exit: now its back is seen, and still ahead."), out),
        Plate::shot(
            "back",
            format!("Looking back, when the camera is {past} m past the gate, as the gate has it: it looks to be {looks} m behind."),
            back,
        ),
    ]);
    let reel = shipped("gate", BETA)?.reel(96, 24.0)?;
    l.plates([Plate::reel("film", "The flight, by the camera’s clock.", reel)]);
    l.attempt("terrell animate gate --color geometry --beside-standard", "the flight beside slow motion");
    l.attempt(
        "terrell render gate --color geometry --camera panorama --size 1600x800",
        "everything around the camera",
    );
    l.attempt("terrell render gate --time 15", "later; with its light as it is seen");
    let map = flying(0.6)?;
    let at = map.see(DVec3::new(0.0, 3.0, 0.0)).position;
    let seen = l.fixed("answer: beside at 0.6c, degrees", at.y.atan2(at.x).to_degrees(), 2);
    l.ask(
        "Flying at 0.6c, in which direction do you see what is just beside you?",
        format!("cos θ = β: {seen}° from straight ahead."),
    );
    Ok(lecture)
}

/// What a camera that flies along x sees of things at rest, at the moment it is at their origin.
fn flying(beta: f64) -> Result<ApparentMap, TeachError> {
    // The same as what passes the other way.
    let motion = Motion { celerity: Celerity::from_beta(DVec3::NEG_X * beta)?, origin: Event::origin() };
    Ok(ApparentMap::new(&motion, &Tetrad::of_world(Event::origin())))
}

fn aberration() -> Result<Figure, TeachError> {
    let mut series = Vec::new();
    for beta in [0.0, 0.5, 0.9, 0.99] {
        let map = flying(beta)?;
        let seen = (0..=180).map(|degrees| {
            let (sine, cosine) = f64::from(degrees).to_radians().sin_cos();
            let at = map.see(DVec3::new(cosine, sine, 0.0)).position;
            [f64::from(degrees), at.y.atan2(at.x).to_degrees()]
        });
        let mut line = Series::line(format!("β = {beta}"), seen);
        // Named where they are far apart, for who sees no colours.
        line.points[120].label.clone_from(&line.name);
        series.push(if beta == 0.0 {
            Series { stroke: Stroke::Dashed, ink: Some([150; 3]), ..line }
        } else {
            line
        });
    }
    let axis = |label: &str| {
        Axis::linear(label).from_to(0.0, 180.0).with_marks((0..=6).map(|i| {
            let degrees = 30 * i;
            (f64::from(degrees), Some(degrees.to_string()))
        }))
    };
    let panel = Panel {
        x: axis("direction at rest θ′ (°)"),
        y: axis("direction seen θ (°)"),
        series,
        ..Panel::default()
    };
    Ok(Figure { rows: vec![vec![panel]], panel_size: [420.0, 360.0], ..Figure::default() })
}
