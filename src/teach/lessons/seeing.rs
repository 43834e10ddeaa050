use super::cube::{ABOVE, chequered};
use super::{own, passing};
use crate::drawing::number;
use crate::figure::{Axis, Figure, Panel, Point, Series, Stroke};
use crate::teach::lecture::Lecture;
use crate::teach::plate::{Plate, Reel, Shot, TeachError};
use glam::{DVec2, DVec3};
use std::sync::Arc;
use terrell_geodesic::Celerity;

const BETA: f64 = 0.9;
/// How far away what passes does.
const AWAY: f64 = 3.0;

/// A cube of edge 1 whose middle appears abreast in the middle of the picture, tipped towards who looks.
fn scene() -> String {
    format!(
        r#"
[camera]
position = [0, 0, 0]
forward = [0, 1, 0]
fov_deg = 30
nearest = "cube"

[[body]]
name = "cube"
mesh = "cube"
position = [0, {AWAY}, 0]
velocity = [{BETA}, 0, 0]
rotation = {{ axis = [1, 0, 0], angle_deg = {ABOVE} }}
"#
    )
}

pub(super) fn lecture() -> Result<Lecture, TeachError> {
    let mut lecture = Lecture::default();
    let gamma = Celerity::from_beta(DVec3::X * BETA)?.gamma();
    let l = &mut lecture;
    let measured = l.fixed("length measured", 1.0 / gamma, 3);
    l.text(format!(
        "A rod of length 1 flies along its own direction at 0.9c. There are two honest answers to “how long is it now?”. \
         Whoever *measures* it marks where its two ends are at one moment of their own clocks, with helpers along the way, \
         and finds 1/γ = {measured}. Whoever *looks* receives light that arrives at one moment; but light from the far end \
         has been on its way for longer, and left when that end was elsewhere."
    ));
    let rod = |middle: f64| -> Result<f64, TeachError> {
        let map = passing(BETA)?;
        let end = |by: f64| map.see(DVec3::X * (middle + by)).position.x;
        Ok(end(0.5) - end(-0.5))
    };
    let delayed = |coming: f64| 1.0 / (1.0 - coming * BETA);
    let rods = [("coming", rod(-5.0)?, 1.0), ("going", rod(5.0)?, -1.0)];
    let rows = rods.map(|(name, seen, coming)| {
        [
            name.to_owned(),
            l.fixed(format!("rod {name}, measured"), 1.0 / gamma, 3),
            l.fixed(format!("rod {name}, delay alone"), delayed(coming), 3),
            l.fixed(format!("rod {name}, seen"), seen, 3),
        ]
    });
    l.table(["rod of length 1 at 0.9c", "measured", "delay of light alone", "seen"], rows);
    let panels = rods
        .map(|(name, seen, coming)| {
            let lengths = [1.0, 1.0 / gamma, delayed(coming), seen];
            let names = ["at rest", "measured", "delay alone", "seen"];
            let most = lengths.into_iter().fold(0.0, f64::max);
            rod_panel(name, &names.into_iter().zip(lengths).collect::<Vec<_>>(), most)
        })
        .into();
    l.plates([Plate::figure(
        "rod",
        "The rod, coming and going, around its middle. Mind the scales.",
        Figure { rows: vec![panels], panel_size: [320.0, 150.0], ..Figure::default() },
    )]);
    l.text(
        "The table’s middle column is what one would see if nothing were contracted and light only took its time, as physicists before \
         1905 could have worked out. What is seen is both at once: contraction and delay. A rod that comes looks *longer* \
         than at rest. Contraction is real, but it is not what an eye or a camera sees.",
    );
    l.heading("From above");
    l.text(format!(
        "The same for a square whose edge is 1, passing at a distance of {AWAY}. The picture is taken when its middle *looks* to be \
         abreast. Where it then *is*, it has long passed: light from there is still to come."
    ));
    let ahead = l.fixed("middle is ahead of where it is seen by", BETA * AWAY, 2);
    l.plates([Plate::figure(
        "plan",
        format!(
            "The square as it is (measured, at the right: {ahead} further on), as light's delay alone would show it, and as it is seen: \
             its back is in view."
        ),
        plan(),
    )]);
    l.text(
        "In the film, light is made faster and slower by the turn of a knob. With infinitely fast light one sees what is measured; as \
         light slows down to its true speed, the square falls back to where it looks to be, and is sheared: far corners are seen \
         as they were longer ago, and so further back.",
    );
    let turned = |figure: fn(f64) -> Figure| {
        Reel::of_figures(73, 24.0, move |i| {
            let turn = i as f64 / 72.0 * std::f64::consts::TAU;
            figure(0.5 - 0.5 * turn.cos())
        })
    };
    l.plates([
        Plate::reel(
            "knob",
            "From what is measured to what is seen: the delay of light, from none to all of it, and back.",
            turned(knob),
        ),
        Plate::reel("rod_knob", "The same of the rod, coming and going.", turned(rod_knob)),
    ]);
    l.heading("Gamow’s error");
    let far = 1000.0;
    let map = passing(BETA)?;
    let centre = DVec3::new(gamma * BETA * far, far, 0.0);
    let angle = |x: f64, y: f64| {
        let at = map.see(centre + DVec3::new(x, y, 0.0)).position;
        far * at.x / at.y
    };
    let near = l.fixed("near side of a small cube", angle(0.5, -0.5) - angle(-0.5, -0.5), 3);
    let back = l.fixed("back of a small cube", angle(-0.5, -0.5) - angle(-0.5, 0.5), 3);
    l.text(format!(
        "In Gamow’s book Mr Tompkins sees a cyclist in a town where light is slow, and sees him flattened. That is what would be \
         measured. Far away and abreast the near side of a cube is indeed seen {near} wide, but beside it its back is seen, {back} \
         wide, which nobody could see of a flattened cube. The sum of the squares is 1: the cube looks turned, not flattened."
    ));
    let rest = chequered(own(&scene(), 0.0)?);
    let seen = chequered(own(&scene(), BETA)?);
    let plate = |name: &str, caption: &str, shot: Shot| Plate::shot(name, caption, shot);
    l.plates([
        plate("rest", &format!("At rest, from {ABOVE}° above."), rest.clone()),
        plate(
            "flattened",
            "As Gamow had it drawn: contracted, and that is all.",
            stretched(rest, 1.0 / gamma),
        ),
        // So long in its own frame that it is measured to be as long as at rest.
        plate("delayed", "As light’s delay alone would show it at 0.9c.", stretched(seen.clone(), gamma)),
        plate("seen", "As it is seen at 0.9c: turned, its yellow back in view.", seen),
    ]);
    l.attempt("terrell render cube --color geometry", "the cube as it is seen, plain, on a level with you");
    l.attempt("terrell animate cube --color geometry --beside-standard", "a film of it, beside slow motion");
    l.attempt("terrell locate --beta 0.9,0,0 -5,0,0 5,0,0", "where points are seen, as numbers");
    let beta = 0.6;
    let map = passing(beta)?;
    let end = |by: f64| map.see(DVec3::X * (-5.0 + by)).position.x;
    let [measured, seen] = [(1.0 - beta * beta).sqrt(), end(0.5) - end(-0.5)];
    let (measured, seen) =
        (l.fixed("answer: measured at 0.6c", measured, 2), l.fixed("answer: seen at 0.6c", seen, 2));
    l.ask(
        "A rod of length 1 comes straight towards you at 0.6c. How long do you measure it to be, and how long does it look?",
        format!(
            "Measured: √(1 − 0.36) = {measured}. Seen: √((1 + 0.6)/(1 − 0.6)) = {seen}, twice its length at rest. \
             `terrell locate --beta 0.6,0,0 -5,0,0 -4,0,0` says where both ends are seen."
        ),
    );
    Ok(lecture)
}

/// A rod by lengths that it has, with their names, from above down; there is room for the greatest.
fn rod_panel(title: &str, lengths: &[(&str, f64)], most: f64) -> Panel {
    let row = |i: usize| (lengths.len() - i) as f64;
    let series = lengths.iter().enumerate().map(|(i, (_, length))| {
        let ends = [-0.5, 0.5].map(|end| Point { x: end * length, y: row(i), ..Point::default() });
        let mut rod = Series { stroke: Stroke::Line, ink: Some([30; 3]), ..Series::points("", ends.into()) };
        rod.points[1].label = number::fixed(*length, 3);
        rod
    });
    let names = lengths.iter().enumerate().map(|(i, (name, _))| (row(i), Some((*name).to_owned())));
    Panel {
        title: title.to_owned(),
        x: Axis::linear("along the motion").from_to(-0.7 * most, 0.7 * most),
        y: Axis::linear("").from_to(0.4, row(0) + 0.6).with_marks(names),
        series: series.collect(),
        ..Panel::default()
    }
}

/// The rod as it is seen by how slow light is: light from its far end left that much earlier.
fn rod_knob(slowness: f64) -> Figure {
    let seen = |coming: f64| contracted() / (1.0 - coming * BETA * slowness);
    let most = contracted() / (1.0 - BETA);
    let panel = rod_panel("", &[("coming", seen(1.0)), ("going", seen(-1.0))], most);
    Figure {
        title: delay(slowness),
        rows: vec![vec![panel]],
        panel_size: [560.0, 120.0],
        ..Figure::default()
    }
}

fn delay(slowness: f64) -> String {
    format!("light’s delay: {:.0} %", 100.0 * slowness)
}

/// Of a side of the square.
const PARTS: usize = 24;

/// A square's outline in its rest frame, around its middle.
fn square() -> impl Iterator<Item = DVec2> {
    let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5)];
    let corners = corners.map(|(x, y)| DVec2::new(x, y));
    let sides: Vec<_> = corners.windows(2).map(|pair| (pair[0], pair[1])).collect();
    sides.into_iter().flat_map(|(a, b)| (0..=PARTS).map(move |i| a.lerp(b, i as f64 / PARTS as f64)))
}

/// Where a point is seen that moves along x at β and is at `x` now, `y` away, if light moves at 1/`slowness`: where
/// it was when the light left, x + β·slowness·r = x now.
fn seen(x: f64, y: f64, slowness: f64) -> f64 {
    let b = BETA * slowness;
    (x - b * (x * x + (1.0 - b * b) * y * y).sqrt()) / (1.0 - b * b)
}

/// The square by how long things are that move, and how slow light is.
fn outline(length: f64, slowness: f64) -> Vec<[f64; 2]> {
    let point = |p: DVec2| [seen(BETA * AWAY + length * p.x, AWAY + p.y, slowness), AWAY + p.y];
    square().map(point).collect()
}

fn contracted() -> f64 {
    (1.0 - BETA * BETA).sqrt()
}

fn panel(series: Vec<Series>) -> Panel {
    Panel {
        x: Axis::linear("along the motion").from_to(-2.5, 4.5),
        y: Axis::linear("away from who looks").from_to(-0.3, 4.2),
        series,
        ..Panel::default()
    }
}

fn observer() -> Series {
    let eye = Point { label: "who looks".into(), ..Point::default() };
    Series { ink: Some([30; 3]), ..Series::points("", vec![eye]) }
}

fn plan() -> Figure {
    let dashed = |series: Series| Series { stroke: Stroke::Dashed, ..series };
    // With its name in the middle of its near side, of its right, of its far or of its left.
    let named = |side: usize, mut series: Series| {
        series.points[side * (PARTS + 1) + PARTS / 2].label.clone_from(&series.name);
        series
    };
    let at_rest = square().map(|p| [p.x, AWAY + p.y]);
    let series = vec![
        named(1, dashed(Series::line("at rest", at_rest))),
        named(2, Series::line("measured", outline(contracted(), 0.0))),
        named(3, dashed(Series::line("delay alone", outline(1.0, 1.0)))),
        named(0, Series::line("seen", outline(contracted(), 1.0))),
        observer(),
    ];
    Figure { rows: vec![vec![panel(series)]], panel_size: [560.0, 360.0], ..Figure::default() }
}

fn knob(slowness: f64) -> Figure {
    let series = vec![
        Series { stroke: Stroke::Dashed, ..Series::line("measured", outline(contracted(), 0.0)) },
        Series::line("seen", outline(contracted(), slowness)),
        observer(),
    ];
    Figure {
        title: delay(slowness),
        rows: vec![vec![panel(series)]],
        panel_size: [560.0, 360.0],
        ..Figure::default()
    }
}

/// The scene with all its bodies made so many times as long along x.
fn stretched(mut shot: Shot, factor: f64) -> Shot {
    for body in &mut shot.scene.bodies {
        let mesh = Arc::make_mut(&mut body.mesh);
        mesh.x.iter_mut().for_each(|x| *x *= factor);
    }
    shot
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_of_the_delay_is_the_apparent_map() {
        let map = passing(BETA).unwrap();
        let gamma = 1.0 / contracted();
        for (x, y) in [(2.7, 3.0), (-4.0, 1.0), (0.3, 2.5), (9.0, 0.1)] {
            let by_map = map.see(DVec3::new(gamma * x, y, 0.0)).position;
            assert!((by_map.x - seen(x, y, 1.0)).abs() < 1e-12 && (by_map.y - y).abs() < 1e-12);
            assert_eq!(seen(x, y, 0.0), x);
        }
        // The rod, whose light comes along it.
        for (x, coming) in [(-5.0, 1.0), (5.0, -1.0)] {
            let length = seen(x + 0.5 / gamma, 0.0, 1.0) - seen(x - 0.5 / gamma, 0.0, 1.0);
            assert!((length - contracted() / (1.0 - coming * BETA)).abs() < 1e-12, "{coming}");
        }
        // Its middle looks to be abreast.
        assert!(seen(BETA * AWAY, AWAY, 1.0).abs() < 1e-12);
    }
}
