use super::{own, passing};
use crate::apparent::{Field, Rod};
use crate::figure::{Axis, Figure, Panel, Series, Stroke};
use crate::relativity::ApparentMap;
use crate::scene::{Lens, Projection};
use crate::teach::lecture::Lecture;
use crate::teach::plate::{Plate, TeachError};
use glam::DVec3;

const SPEEDS: [f64; 3] = [0.5, 0.9, 0.99];

pub(super) fn lecture() -> Result<Lecture, TeachError> {
    let mut lecture = Lecture::default();
    let l = &mut lecture;
    l.text(
        "Let a point of a body be x′ ahead of the observer and ρ beside the line of flight, measured in the *body’s* rest frame at the \
         event of looking; its distance there is r′ = √(x′² + ρ²). The light now arriving left it r′ earlier. One Lorentz \
         transformation of that event gives where it is seen:",
    );
    l.formula("x = γ (x′ − β r′),   ρ = ρ′          (Eq. 1)");
    l.text(
        "That is all of the geometry of this course: contraction and the delay of light in one line. Distances across the motion \
         stay as they are; along it, everything is moved by how far away it is.",
    );
    l.formula("(x − γ x′)² = γ² β² (x′² + ρ²)          (Eq. 2)");
    l.text(
        "For a straight rod across the motion x′ is the same for all of it, and Eq. 2 is a hyperbola: the rod is seen bent, its far \
         ends swept back. (The equation has two branches; the other one is where light going *out* would meet the rod.) A rod \
         along the motion stays straight.",
    );
    let figure = Figure {
        rows: vec![
            [0.0, SPEEDS[0]].map(hyperbolas).into_iter().collect::<Result<_, _>>()?,
            [SPEEDS[1], SPEEDS[2]].map(hyperbolas).into_iter().collect::<Result<_, _>>()?,
        ],
        panel_size: [300.0, 300.0],
        ..Figure::default()
    };
    l.plates([Plate::figure(
        "hyperbolas",
        "Five rods across the motion, two lengths apart at rest, with the observer at the dot. Dashed: asymptotes of the fourth. Those \
         that come (left) are drawn apart, those that go (right) are crowded together. So that all five are there, the lower two have \
         smaller scales along the motion.",
        figure,
    )]);
    let mut rows = Vec::new();
    for beta in SPEEDS {
        let map = passing(beta)?;
        let apex = |x: f64| map.see(DVec3::X * x).position.x.abs();
        let far = map.see(DVec3::new(0.0, 1e6, 0.0)).position;
        rows.push([
            format!("{beta}"),
            l.fixed(format!("stretch of what comes at {beta}"), apex(-1.0), 3),
            l.fixed(format!("squeeze of what goes at {beta}"), apex(1.0), 3),
            l.fixed(format!("lean of a far rod at {beta}, degrees"), (-far.x).atan2(far.y).to_degrees(), 2),
        ]);
    }
    l.table(["β", "1 ahead, coming, is seen at", "1 behind, going, at", "far ends lean back by (°)"], rows);
    l.text(
        "On the line of flight itself r′ = |x′|, and Eq. 1 is a plain factor: what comes is stretched by √((1 + β)/(1 − β)), what goes is \
         squeezed by the same factor. Far ends of a rod lean back by the angle whose tangent is γβ, which is arcsin β: you will \
         meet it again where a cube seems to turn.",
    );
    l.heading("How many straight pieces make a hyperbola");
    l.text(
        "Polygons have straight edges, so a picture of polygons must cut them. The error of a piece grows with the square of its length, so that \
         a tolerance four times as fine takes twice the pieces. Counted, for a rod four long at a distance of 2, passing at 0.95c before a \
         camera of 1000 pixels:",
    );
    let (map, field) = before_a_camera()?;
    let rod = Rod { from: DVec3::new(0.0, 0.0, -4.0), to: DVec3::new(0.0, 0.0, 4.0) };
    let rows = [1.0, 0.25, 0.0625].map(|tolerance| {
        let pieces = rod.polyline(&map, &field, tolerance).len() - 1;
        [format!("{tolerance}"), l.fixed(format!("pieces at {tolerance} px"), pieces as f64, 0)]
    });
    l.table(["tolerance, pixels", "pieces"], rows);
    l.text(
        "terrell’s usual method avoids the question: it asks for every pixel which triangle its line of sight meets in the body’s rest \
         frame, where edges are straight.",
    );
    let told = "Such masts at 0.95c, measured as far apart, when the middle of the third looks to be abreast; the first, far to the left, is \
                out of view. Upright rods are hyperbolas; the short ones, along the motion, stay straight.";
    l.plates([
        Plate::shot("mast_rest", "Five masts of rods at rest, 4 apart.", own(&masts(), 0.0)?),
        Plate::shot("mast", told, own(&masts(), 0.95)?),
    ]);
    l.attempt("terrell render lattice --color geometry --edges", "rods in all three directions");
    l.attempt("terrell render lattice --color geometry --beta 0.99 --edges", "the same, faster");
    l.attempt("terrell transform cube --beta 0.95 -o bent.glb", "a bent cube, for Blender");
    let map = passing(0.8)?;
    let [ahead, behind] = [-3.0, 3.0].map(|x| map.see(DVec3::new(x, 4.0, 0.0)).position.x);
    let (ahead, behind) = (l.fixed("answer: coming", ahead, 3), l.fixed("answer: going", behind, 3));
    l.ask(
        "At 0.8c, where along the motion is a point seen that is 4 beside the line of flight and, in the body’s frame, 3 before it reaches \
         you? And one 3 past you?",
        format!(
            "γ = 5/3 and r′ = 5, so x = 5/3 · (−3 − 4) = {ahead} and 5/3 · (3 − 4) = {behind}: the second is past you and still seen \
             coming. `terrell locate --beta 0.8,0,0 -3,4,0 3,4,0` agrees."
        ),
    );
    Ok(lecture)
}

/// Masts one behind the other: long rods across the motion, short ones along it.
fn masts() -> String {
    let mut toml = r#"
[camera]
position = [0, 0, 0]
forward = [0, 1, 0]
fov_deg = 110
nearest = "mast 3"
"#
    .to_owned();
    // As measured, at every speed.
    for (i, x) in [-8, -4, 0, 4, 8].into_iter().enumerate() {
        toml += &format!(
            r#"
[[body]]
name = "mast {}"
mesh = "lattice"
position = [{x}, 5, 0]
rotation = {{ axis = [0, 1, 0], angle_deg = 90 }}
velocity = [0.95, 0, 0]
"#,
            i + 1
        );
    }
    toml
}

fn before_a_camera() -> Result<(ApparentMap, Field), TeachError> {
    use crate::relativity::Motion;
    use terrell_geodesic::{Celerity, Event, Tetrad};
    let motion =
        Motion { celerity: Celerity::from_beta(DVec3::X * 0.95)?, origin: Event::new(-2.0, 0.0, 2.0, 0.0) };
    let camera = Tetrad::new(Event::origin(), Celerity::at_rest(), DVec3::Y, DVec3::Z)?;
    let lens = Lens::new(Projection::Pinhole, 90.0, 1000, 1000)?;
    Ok((ApparentMap::new(&motion, &camera), Field::new(&lens)))
}

fn hyperbolas(beta: f64) -> Result<Panel, TeachError> {
    let map = passing(beta)?;
    let ink = [20, 80, 160];
    let rod = |x: f64| {
        let seen = (-60..=60).map(|i| {
            let at = map.see(DVec3::new(x, f64::from(i) / 10.0, 0.0)).position;
            [at.x, at.y]
        });
        Series { ink: Some(ink), ..Series::line("", seen) }
    };
    let mut series: Vec<Series> = [-4.0, -2.0, 0.0, 2.0, 4.0].map(rod).into();
    if beta > 0.0 {
        // Of the rod at x′ = 2: they meet at γx′.
        let (meet, slope) = (2.0 * map.gamma(), map.speed());
        let ends = [[meet - 6.0 * slope, -6.0], [meet, 0.0], [meet - 6.0 * slope, 6.0]];
        series.push(Series { stroke: Stroke::Dashed, ink: Some([150; 3]), ..Series::line("", ends) });
    }
    // The first is seen at −4γ(1 + β) on the line of flight.
    let left = match beta {
        b if b < 0.6 => -12.0,
        b if b < 0.95 => -24.0,
        _ => -72.0,
    };
    let observer = crate::figure::Point::default();
    series.push(Series { ink: Some([30; 3]), ..Series::points("", vec![observer]) });
    Ok(Panel {
        title: format!("β = {beta}"),
        x: Axis::linear("x, along the motion").from_to(left, 6.0),
        y: Axis::linear("ρ, across").from_to(-6.0, 6.0),
        series,
        ..Panel::default()
    })
}
