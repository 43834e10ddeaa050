use super::shipped;
use crate::figure::{Axis, Figure, Panel, Point, Series};
use crate::measure::{Measured, Sweep, SweepPoint, usual_ways};
use crate::plan::MOST_GAMMA;
use crate::relativity::{ApparentMap, Motion};
use crate::render::{Options, Raster};
use crate::teach::lecture::Lecture;
use crate::teach::plate::{Plate, TeachError};
use crate::tone::Development;
use glam::DVec3;
use terrell_geodesic::{Celerity, Event, Tetrad};

const SIZE: [u32; 2] = [320, 180];

/// Pictures timed of each way.
const REPEATS: u32 = 9;

/// Pixels.
const TOLERANCES: [f64; 5] = [4.0, 1.0, 0.25, 0.0625, 0.015625];

pub(super) fn lecture() -> Result<Lecture, TeachError> {
    let mut lecture = Lecture::default();
    let l = &mut lecture;
    l.text(
        "One picture can be drawn in several ways. A way has two prices: the time it takes, and how far off it is. Neither says anything without the other, so \
         both are measured, of every way, and drawn against each other. What lies to the lower left of all else is what to use; a way that is both slower and \
         further off than another is of no use, however clever.",
    );
    let points = sweep()?;
    l.plates([Plate::figure(
        "chart",
        "The cube at 0.9c, 320×180. To the left: nearer to what rays see; below: quicker. Each point of “apparent” is a tolerance.",
        chart(&points),
    )]);
    l.heading("What a tolerance costs");
    l.text(
        "Apparent shading moves corners to where they are seen and draws flat triangles between them, which are cut until they are nowhere further from the curved \
         shape than the tolerance. An edge that is cut in two is off by a quarter: so four times the accuracy takes twice the pieces of an edge, and up to four times those of a face.",
    );
    let mut rows = Vec::new();
    for (point, measured) in measured(&points, "apparent") {
        let tolerance = point.way.options.tolerance;
        let name = |what: &str| format!("{what} at {tolerance} px");
        let edges = measured.edges.map_or(f64::NAN, |edges| edges.worst);
        rows.push([
            format!("{tolerance}"),
            l.fixed(name("pieces"), measured.pieces as f64, 0),
            l.fixed(name("edges off"), edges, 4),
            l.fixed(name("wrong pixels"), measured.wrong_pixels() as f64, 0),
            l.fixed(name("milliseconds"), milliseconds(measured), 1),
        ]);
    }
    l.table(["tolerance (px)", "pieces", "edges off (px)", "pixels that differ", "ms a picture"], rows);
    let mut wrong = Vec::new();
    for series in ["uncut", "exact"] {
        for (_, measured) in measured(&points, series) {
            let off = l.fixed(format!("wrong pixels, {series}"), measured.wrong_pixels() as f64, 0);
            wrong.push((off, l.fixed(format!("milliseconds, {series}"), milliseconds(measured), 1)));
        }
    }
    let [(uncut, uncut_time), (exact, exact_time)] = &wrong[..] else { return Ok(lecture) };
    l.text(format!(
        "Pixels that differ are those that see another body or another face than a ray through their middle does; the picture has {} of them. Without any cuts they are {uncut}, in \
         {uncut_time} ms. Exact shading, which moves nothing and asks every pixel which triangle it sees in the sky of its rest frame, has {exact}, in {exact_time} ms: it \
         does more work for a pixel and none for pieces. Times are of the machine that made this page, the medians of up to {REPEATS} pictures each, and \
         not to be taken for more than their ratios.",
        SIZE[0] * SIZE[1]
    ));
    l.heading("Where a formula fails");
    l.text(
        "Accuracy is not only a matter of how much one computes. Eq. 1, as it is printed, subtracts βr′ from x′. Of what lies straight behind what is left is r′(1 − β), a \
         part 1/2γ² of either: so many digits are gone. Written with r′ − x′ and 1 − β worked out for themselves, nothing is lost. Listed is how many \
         digits of x are right for a point that has flown past the observer and goes straight away, of the sixteen (or seven) that there are.",
    );
    let mut rows = Vec::new();
    for gamma in [10.0, 1e3, 1e5, 1e7] {
        let (printed, single, stable) = digits(gamma)?;
        rows.push([
            crate::drawing::number::significant(gamma, 1),
            l.fixed(format!("digits of Eq. 1 in f32, γ = {gamma}"), single, 1),
            l.fixed(format!("digits of Eq. 1 in f64, γ = {gamma}"), printed, 1),
            l.fixed(format!("digits of what is used, γ = {gamma}"), stable, 1),
        ]);
    }
    l.table(["γ", "Eq. 1, f32", "Eq. 1, f64", "as it is used, f64"], rows);
    let most = l.fixed("γ up to which lines of sight have digits", MOST_GAMMA, 0);
    l.text(format!(
        "Every method has such an edge somewhere. Lines of sight of neighbouring pixels become one number in the rest frame when γ is above some {most}: there the program does not take \
         exact shading, but cuts shapes, which keeps its digits. A method is trusted only where its error has been mapped."
    ));
    l.attempt("terrell chart cube --quick -o chart", "this chart of any scene, with its numbers as CSV");
    l.attempt("terrell chart --stability --quick -o maps", "maps of where each method fails");
    l.attempt("terrell explain gate --gamma 1e6", "what is chosen where lines of sight lose digits, and why");
    let answer = l.fixed("answer: pieces, by a 64th of the tolerance", 64f64.sqrt(), 0);
    l.ask(
        "A rod is seen as a hyperbola. How many times the pieces does it take to have it 64 times as exact?",
        format!("What a chord is off by goes with the square of its length: √64 = {answer} times."),
    );
    Ok(lecture)
}

fn sweep() -> Result<Vec<SweepPoint>, TeachError> {
    let mut shot = shipped("cube", 0.9)?;
    shot.scene.view.size = SIZE;
    let camera = shot.scene.camera()?;
    let options = Options { coloring: shot.coloring, ..Options::default() };
    let mut ways = usual_ways(&options, &TOLERANCES, &[], &[1]);
    ways.retain(|way| way.options.raster == Raster::Cpu && way.series != "f32 vertices");
    let sweep = Sweep { scene: &shot.scene, camera: &camera, ways, reference_samples: 1, repeats: REPEATS };
    Ok(sweep.run(&options, |_| Ok(Development::default()), || ())?)
}

fn measured<'a>(
    points: &'a [SweepPoint],
    series: &str,
) -> impl Iterator<Item = (&'a SweepPoint, &'a Measured)> {
    let of = points.iter().filter(move |point| point.way.series == series);
    of.filter_map(|point| Some((point, point.measured.as_ref().ok()?)))
}

fn milliseconds(measured: &Measured) -> f64 {
    measured.frame.as_ref().map_or(f64::NAN, |times| 1e3 * times.seconds()[0])
}

fn chart(points: &[SweepPoint]) -> Figure {
    let series = ["apparent", "uncut", "exact", "trace"].map(|series| {
        let of = measured(points, series).filter_map(|(point, measured)| {
            let label = if series == "apparent" {
                format!("{} px", point.way.options.tolerance)
            } else {
                String::new()
            };
            Some(Point { x: point.displacement()?, y: milliseconds(measured), label, ..Point::default() })
        });
        Series::points(series, of.collect())
    });
    let panel = Panel {
        x: Axis::log("worst displacement (px)").with_zero("none"),
        y: Axis::log("ms a picture"),
        series: series.into(),
        ..Panel::default()
    };
    Figure { rows: vec![vec![panel]], panel_size: [560.0, 360.0], ..Figure::default() }
}

/// How many digits of x are right of a point that goes straight away, 0.7 from its body's origin, by Eq. 1 as it is
/// printed in f64 and f32, and as it is used.
fn digits(gamma: f64) -> Result<(f64, f64, f64), TeachError> {
    const PLACE: f64 = 0.7;
    let beta = (1.0 - 1.0 / (gamma * gamma)).sqrt();
    // γ(1 − β), without a difference.
    let truth = PLACE / (gamma * (1.0 + beta));
    // Digits of what is off by nothing are all there are.
    let right = |x: f64, least: f64| -((x / truth - 1.0).abs().max(least)).log10().min(0.0);
    let printed = gamma * (PLACE - beta * PLACE);
    let (gamma32, beta32, place32) = (gamma as f32, beta as f32, PLACE as f32);
    let single = f64::from(gamma32 * (place32 - beta32 * place32));
    let motion = Motion { celerity: Celerity::from_gamma(gamma, DVec3::X)?, origin: Event::origin() };
    let map = ApparentMap::new(&motion, &Tetrad::of_world(Event::origin()));
    let stable = map.see(DVec3::X * PLACE).position.x;
    let (half, half32) = (0.5 * f64::EPSILON, 0.5 * f64::from(f32::EPSILON));
    Ok((right(printed, half), right(single, half32), right(stable, half)))
}
