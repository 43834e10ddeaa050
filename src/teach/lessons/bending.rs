use crate::figure::{Axis, Figure, Panel, Series, Stroke};
use crate::measure::schwarzschild_deflection;
use crate::scene::builtin_scene;
use crate::teach::lecture::Lecture;
use crate::teach::plate::{Plate, Shot, TeachError};
use terrell_geodesic::{Accuracy, Curved, DistantCamera, End, KerrSchild, Segment, Spacetime};

pub(super) fn lecture() -> Result<Lecture, TeachError> {
    let mut lecture = Lecture::default();
    let l = &mut lecture;
    l.text(
        "Near a heavy mass light does not run straight. Then there is no map from a point to where it is seen, as there may be several; but rays can still be \
         followed, and a tracer need not know of curvature. The paper’s idea (Section 3.4): whatever knows the spacetime hands the tracer short straight pieces.",
    );
    let hole = KerrSchild::schwarzschild(1.0)?;
    let critical = l.fixed("critical b", 27f64.sqrt(), 4);
    l.plates([Plate::figure(
        "rays",
        format!("Rays past a black hole of mass 1 (black: its horizon at 2; dashed: light can circle at 3), from the right. Those that would pass nearer than {critical} end in it."),
        rays(&hole)?,
    )]);
    l.heading("How much");
    l.text("Far away a ray at the distance b is bent by 4M/b, Einstein’s value; near the hole by more, and without bound where b comes to 3√3 M.");
    let mut rows = Vec::new();
    for b in [100.0, 30.0, 10.0, 6.0, 5.3, 5.2] {
        let traced = deflection(&hole, b)?;
        rows.push([
            format!("{b}"),
            l.fixed(format!("deflection at b = {b}, traced, degrees"), traced.to_degrees(), 3),
            l.fixed(
                format!("deflection at b = {b}, closed form, degrees"),
                schwarzschild_deflection(b).to_degrees(),
                3,
            ),
            l.fixed(format!("4M/b at b = {b}, degrees"), (4.0 / b).to_degrees(), 3),
        ]);
    }
    l.table(["b/M", "traced (°)", "closed form (°)", "4M/b (°)"], rows);
    // Ends are one more than pieces.
    let count = |sagitta: f64| Ok::<_, TeachError>((chords(&hole, sagitta)?.len() - 1) as f64);
    let (coarse, fine) =
        (l.fixed("pieces to 0.1 M", count(0.1)?, 0), l.fixed("pieces to 0.001 M", count(0.001)?, 0));
    l.text(format!(
        "Rays with b below 3√3 M = {critical} M are caught: so large is the black disc that is seen. The ray with b = 6 M, cut so that its pieces are nowhere further than 0.1 M from \
         it, takes {coarse}; to 0.001 M {fine}."
    ));
    l.plates([Plate::figure(
        "segments",
        format!("That ray near the hole (black: its horizon), from the right: pieces to 0.1 M, {coarse} with those farther off, a dot where one ends and the next begins; dashed: those to 0.001 M, which look smooth. Where it is bent most, pieces are shortest."),
        segments(&hole)?,
    )]);
    l.heading("What it looks like");
    let scene = builtin_scene("blackhole")?.scene();
    let mut without = scene.clone();
    without.spacetime = crate::scene::Spacetime::Flat;
    let shot = |scene| {
        let mut shot = Shot::new(scene);
        shot.samples = 1;
        shot
    };
    l.plates([
        Plate::shot("without", "A globe and three cubes before a checkered sky.", shot(without)),
        Plate::shot("hole", "The same around a rotating black hole: the globe behind it is seen around it, twice; the sky is wrapped around.", shot(scene)),
    ]);
    l.heading("Einstein’s ring");
    l.text(
        "What is exactly behind the hole has no reason to be seen on one side of it rather than on another: it is seen all around, as a ring. Far from the hole its radius is the angle \
         √(4M d/(D(D + d))), D the way from the camera to the hole and d that from there to what is behind.",
    );
    let mut rows = Vec::new();
    for distance in [1000.0, 100.0, 22.0f64] {
        let name = |what: &str| format!("{what} from {distance} M, degrees");
        let far = (2.0 / distance).sqrt();
        rows.push([
            super::whole(distance),
            l.fixed(name("ring, traced,"), ring(&hole, distance)?.to_degrees(), 3),
            l.fixed(name("ring, far away,"), far.to_degrees(), 3),
        ]);
    }
    l.table(["D = d (M)", "traced (°)", "far away (°)"], rows);
    let mut behind = builtin_scene("blackhole")?.scene();
    behind.spacetime = crate::scene::Spacetime::Kerr(hole);
    behind.bodies.retain(|body| body.name == "globe");
    let camera = behind.view.event.position();
    behind.bodies[0].motion = crate::relativity::Motion::at_rest(-0.7 * camera);
    l.plates([Plate::shot(
        "ring",
        "The globe exactly behind a hole that does not rotate, 15 M beyond it: a ring, and within it another, thin one, of light that goes once around the hole.",
        shot(behind),
    )]);
    l.attempt("terrell render blackhole", "the second picture, larger");
    l.attempt("terrell scenes blackhole > mine.toml", "a scene to change: mass, spin, camera");
    l.attempt("terrell chart --geodesics --quick -o rays", "what following rays costs, and how exact it is");
    let answer = l.fixed(
        "answer: deflection at the sun’s edge, arc seconds",
        (4.0 * 1.4766 / 695_700.0f64).to_degrees() * 3600.0,
        2,
    );
    l.ask(
        "The sun’s mass is 1.4766 km in these units, and its radius 695 700 km. By how much is light bent that grazes it?",
        format!("4M/b = 4 · 1.4766/695 700 = {answer} seconds of arc, as was seen in 1919."),
    );
    Ok(lecture)
}

/// How far a ray from far away at an impact parameter is turned on its way to the sky.
fn deflection(hole: &KerrSchild, b: f64) -> Result<f64, TeachError> {
    let camera = DistantCamera::at_infinity(*hole, std::f64::consts::FRAC_PI_2)?;
    let (event, k) = camera.ray(b, 0.0)?;
    let space = Curved::new(*hole).with(Accuracy::new(1e-12, 0.01));
    let before = far_direction(&camera)?;
    Ok(match space.ray(event, k).follow() {
        End::Sky { wave_vector } => {
            let n = wave_vector.xyz().normalize();
            let turned = before.cross(n).length().atan2(before.dot(n));
            // How often it goes around the hole before cannot be told from where it comes from.
            let turns = (0..4).map(|k| std::f64::consts::TAU * f64::from(k));
            let all = turns.flat_map(|whole| [whole + turned, whole - turned]);
            let off = |angle: &f64| (angle - schwarzschild_deflection(b)).abs();
            all.min_by(|x, y| off(x).total_cmp(&off(y))).unwrap_or(turned)
        }
        _ => f64::INFINITY,
    })
}

/// The angle from the hole at which a static camera at a distance sees what is as far behind it.
fn ring(hole: &KerrSchild, distance: f64) -> Result<f64, TeachError> {
    let camera = DistantCamera::at_distance(*hole, std::f64::consts::FRAC_PI_2, distance)?;
    let space = Curved::new(*hole).with(Accuracy::new(1e-10, 1e-4));
    // How far behind the hole a ray of an impact parameter comes to the axis; ever farther with the parameter.
    let crosses = |b: f64| -> Result<f64, TeachError> {
        let (event, k) = camera.ray(b, 0.0)?;
        for Segment { start, direction, length, .. } in space.ray(event, k) {
            let (from, along) = (start.position(), direction.xyz());
            let at = -from.y / along.y;
            if at > 0.0 && at <= length && from.x + at * along.x < 0.0 {
                return Ok(-(from.x + at * along.x));
            }
        }
        Ok(f64::INFINITY)
    };
    let (mut low, mut high) = (27f64.sqrt() * 1.001, 3.0 * distance.sqrt() + 6.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if crosses(middle)? < distance { low = middle } else { high = middle }
    }
    // Of a static camera (J. L. Synge 1966).
    Ok((low / distance * (1.0 - 2.0 / distance).sqrt()).asin())
}

/// The direction of rays of a camera far away.
fn far_direction(camera: &DistantCamera) -> Result<glam::DVec3, TeachError> {
    let (_, k) = camera.ray(1e9, 0.0)?;
    Ok(k.xyz().normalize())
}

/// The ends of the pieces into which the ray at 6 M is cut; the last leads to the sky, and is cut off.
fn chords(hole: &KerrSchild, sagitta: f64) -> Result<Vec<[f64; 2]>, TeachError> {
    let (event, k) = DistantCamera::at_distance(*hole, std::f64::consts::FRAC_PI_2, 100.0)?.ray(6.0, 0.0)?;
    let (mut ends, mut last) = (Vec::new(), None);
    for Segment { start, direction, length, .. } in
        Curved::new(*hole).with(Accuracy::new(1e-9, sagitta)).ray(event, k)
    {
        let p = start.position();
        ends.push([p.x, p.y]);
        let end = p + direction.xyz() * length.min(60.0);
        last = Some([end.x, end.y]);
    }
    ends.extend(last);
    Ok(ends)
}

/// Points of a circle around the hole.
fn circle(radius: f64) -> impl Iterator<Item = [f64; 2]> {
    (0..=180).map(move |i| {
        let (sine, cosine) = (f64::from(i) * 2.0).to_radians().sin_cos();
        [radius * cosine, radius * sine]
    })
}

/// Of one ray.
fn segments(hole: &KerrSchild) -> Result<Figure, TeachError> {
    let pieces = Series {
        marked: true,
        ink: Some([20, 80, 160]),
        ..Series::line("pieces to 0.1 M", chords(hole, 0.1)?)
    };
    let fine = Series::line("to 0.001 M", chords(hole, 0.001)?);
    let fine = Series { stroke: Stroke::Dashed, ink: Some([190, 60, 30]), ..fine };
    let horizon = Series { ink: Some([30; 3]), ..Series::line("", circle(hole.horizon())) };
    let panel = Panel {
        x: Axis::linear("x/M").from_to(-12.0, 12.0),
        y: Axis::linear("y/M").from_to(-9.0, 9.0),
        series: vec![horizon, pieces, fine],
        ..Panel::default()
    };
    Ok(Figure { rows: vec![vec![panel]], panel_size: [560.0, 420.0], ..Figure::default() })
}

fn rays(hole: &KerrSchild) -> Result<Figure, TeachError> {
    let camera = DistantCamera::at_distance(*hole, std::f64::consts::FRAC_PI_2, 40.0)?;
    let space = Curved::new(*hole).with(Accuracy::new(1e-8, 0.01));
    let mut series = Vec::new();
    for b in [-12.0, -9.0, -7.0, -6.0, -5.3, -4.0, -2.0, 0.0, 2.0, 4.0, 5.3, 6.0, 7.0, 9.0, 12.0] {
        let (event, k) = camera.ray(b, 0.0)?;
        let mut points = Vec::new();
        for Segment { start, direction, length, .. } in space.ray(event, k) {
            let p = start.position();
            points.push([p.x, p.y]);
            let end = p + direction.xyz() * length.min(60.0);
            points.push([end.x, end.y]);
        }
        let ink = if f64::abs(b) < 27f64.sqrt() { [190, 60, 30] } else { [20, 80, 160] };
        series.push(Series { ink: Some(ink), ..Series::line("", points) });
    }
    // Above the rays.
    for (radius, stroke) in [(hole.horizon(), Stroke::Line), (3.0, Stroke::Dashed)] {
        series.push(Series { ink: Some([0; 3]), stroke, ..Series::line("", circle(radius)) });
    }
    let panel = Panel {
        x: Axis::linear("x/M").from_to(-20.0, 20.0),
        y: Axis::linear("y/M").from_to(-15.0, 15.0),
        series,
        ..Panel::default()
    };
    Ok(Figure { rows: vec![vec![panel]], panel_size: [560.0, 420.0], ..Figure::default() })
}
