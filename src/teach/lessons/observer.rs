use super::passing;
use crate::figure::{Axis, Figure, Panel, Point, Series, Stroke};
use crate::relativity::ApparentMap;
use crate::teach::lecture::Lecture;
use crate::teach::plate::{Plate, TeachError};
use glam::DVec3;

const BETA: f64 = 0.9;

pub(super) fn lecture() -> Result<Lecture, TeachError> {
    let mut lecture = Lecture::default();
    let l = &mut lecture;
    l.text(
        "What is seen is not what is. But nothing is lost: who knows the speed of a thing, and how far away each of its points looks (with two eyes, \
         say), can work out its true shape. The paper calls that the intelligent observer. Eq. 1 is solved for the body’s own frame:",
    );
    l.formula("x′ = γ (x + β r),   ρ′ = ρ,   r² = x² + ρ²");
    l.text(
        "It is the same equation with the other sign: the map from what is to what is seen, and the one back, are Lorentz transformations of the event at \
         which the light left, to and fro.",
    );
    let map = passing(BETA)?;
    l.plates([Plate::figure(
        "back",
        "Left: corners of a cross as they are seen at 0.9c. Right: put through the inverse map, in the body’s frame: straight and square again.",
        Figure { rows: vec![vec![seen_panel(&map), true_panel(&map)]], panel_size: [320.0, 320.0], ..Figure::default() },
    )]);
    let mut rows = Vec::new();
    for (x, rho) in [(-3.0, 1.0), (0.0, 1.0), (2.0, 1.0), (5.0, 3.0)] {
        let there = DVec3::new(x, rho, 0.0);
        let seen = map.see(there).position;
        let (back, _) = map.unsee(seen);
        rows.push([
            format!("({}, {})", super::whole(x), super::whole(rho)),
            l.fixed(format!("({x}, {rho}) is seen at x"), seen.x, 4),
            l.fixed(format!("({x}, {rho}) is seen from a distance"), seen.length(), 4),
            l.fixed(format!("({x}, {rho}) is taken back to x"), back.x, 4),
        ]);
    }
    l.table(["a point (x′, ρ′)", "seen at x", "seen at distance r", "back: x′"], rows);
    l.text(
        "Without the distance there is no way back from a single eye: a small cube that is turned and one that moves send the same rays. Then only \
         colours tell: the moving one is shifted.",
    );
    l.attempt("terrell locate --beta 0.9,0,0 -3,1,0", "where a point is seen, as numbers");
    l.attempt("terrell locate --help", "and back: from what is seen to what is");
    let map = passing(0.6)?;
    let (back, _) = map.unsee(DVec3::new(0.0, 4.0, 0.0));
    let x = l.fixed("answer: x′ of what is seen abreast", back.x, 2);
    l.ask(
        "At 0.6c a point is seen exactly abreast, 4 away. Where is it in the body’s frame, measured from you at that moment?",
        format!("x′ = γ (0 + 0.6 · 4) = 1.25 · 2.4 = {x} ahead: past you, though its light arrives from abreast."),
    );
    Ok(lecture)
}

/// A cross of two bars around a point of the rest frame, as lines.
fn cross() -> Vec<Vec<DVec3>> {
    let middle = DVec3::new(2.0, 2.5, 0.0);
    let bar = |a: [f64; 2], b: [f64; 2]| {
        let at = |p: [f64; 2]| middle + DVec3::new(p[0], p[1], 0.0);
        (0..=40).map(|i| at(a).lerp(at(b), f64::from(i) / 40.0)).collect()
    };
    let corners = [
        [-0.4, -1.5],
        [0.4, -1.5],
        [0.4, -0.4],
        [1.5, -0.4],
        [1.5, 0.4],
        [0.4, 0.4],
        [0.4, 1.5],
        [-0.4, 1.5],
        [-0.4, 0.4],
        [-1.5, 0.4],
        [-1.5, -0.4],
        [-0.4, -0.4],
        [-0.4, -1.5],
    ];
    corners.windows(2).map(|side| bar(side[0], side[1])).collect()
}

fn panel(title: &str, lines: impl Iterator<Item = Vec<[f64; 2]>>, range: [f64; 2]) -> Panel {
    let ink = [20, 80, 160];
    let mut series: Vec<Series> =
        lines.map(|line| Series { ink: Some(ink), stroke: Stroke::Line, ..Series::line("", line) }).collect();
    series.push(Series {
        ink: Some([30; 3]),
        ..Series::points("", vec![Point { label: "who looks".into(), ..Point::default() }])
    });
    Panel {
        title: title.into(),
        x: Axis::linear("along the motion").from_to(range[0], range[1]),
        y: Axis::linear("across").from_to(-0.5, 5.0),
        series,
        ..Panel::default()
    }
}

fn seen_panel(map: &ApparentMap) -> Panel {
    let seen = |p: &DVec3| map.see(*p).position;
    panel(
        "as it is seen",
        cross().into_iter().map(move |bar| bar.iter().map(|p| [seen(p).x, seen(p).y]).collect()),
        [-5.5, 1.5],
    )
}

fn true_panel(map: &ApparentMap) -> Panel {
    let back = |p: &DVec3| map.unsee(map.see(*p).position).0;
    panel(
        "taken back",
        cross().into_iter().map(move |bar| bar.iter().map(|p| [back(p).x, back(p).y]).collect()),
        [-0.5, 6.5],
    )
}
