use super::table::Table;
use super::{Charted, front_of, join};
use crate::cli::Fault;
use crate::cli::progress::progress_bar;
use serde_json::{Value, json};
use terrell::figure::{Axis, Figure, Panel, Point, Series, power_of_ten};
use terrell::geodesic::Method;
use terrell::measure::{GeodesicPoint, GeodesicSweep, pareto_front};

const COLUMNS: &[&str] = &[
    "spin",
    "law",
    "integrator",
    "tolerance",
    "sagitta_m",
    "us_per_ray_median",
    "us_per_ray_lower_quartile",
    "us_per_ray_upper_quartile",
    "us_per_ray_least",
    "us_per_ray_most",
    "chords_per_ray",
    "deflection_error_rad_worst",
    "deflection_error_rad_rms",
    "chord_error_m_worst",
    "chord_error_m_rms",
    "rays_lost",
    "pareto",
];

/// Measures and draws all ways of following light past black holes.
pub fn chart(sweep: &GeodesicSweep, quiet: bool) -> Result<Charted, Fault> {
    let bar = progress_bar(0, "runs", quiet);
    let points = sweep.run(|all| {
        bar.set_length(all as u64);
        bar.inc(1);
    });
    bar.finish_and_clear();
    let mut table = Table::new(COLUMNS);
    let (mut rows, mut said) = ([Vec::new(), Vec::new()], String::new());
    for &spin in &sweep.spins {
        for (with_chords, panels) in [false, true].into_iter().zip(&mut rows) {
            let of_panel: Vec<&GeodesicPoint> =
                points.iter().filter(|p| p.spin == spin && p.sagitta.is_some() == with_chords).collect();
            let costs: Vec<[f64; 2]> = of_panel.iter().map(|p| [microseconds(p)[0], p.worst]).collect();
            let front = pareto_front(&costs);
            for (i, point) in of_panel.iter().enumerate() {
                table.push(row(point, front.contains(&i)));
            }
            if !with_chords {
                said.push_str(&said_of(spin, &front, &of_panel));
            }
            panels.push(panel(spin, &of_panel, &front, with_chords));
        }
    }
    let about = json!({
        "rays": sweep.rays,
        "impact_parameters_m": [GeodesicSweep::NEAREST, GeodesicSweep::FARTHEST],
        "chord_tolerance": GeodesicSweep::CHORD_TOLERANCE,
        "repeats": sweep.repeats,
        "threads": 1,
    });
    let subtitle = format!(
        "{} rays of impact parameters {} to {} M from infinity; one thread; medians of {} interleaved runs and their quartiles. Labels: the tolerance of a step; ε of chords. Thick grey: nothing measured is faster and more accurate.",
        sweep.rays,
        GeodesicSweep::NEAREST,
        GeodesicSweep::FARTHEST,
        sweep.repeats,
    );
    let figure = Figure {
        title: "Light past black holes: speed and accuracy".into(),
        subtitle: vec![subtitle],
        rows: rows.into_iter().filter(|row| !row.is_empty()).collect(),
        ..Figure::default()
    };
    Ok(Charted { figure, table, about, said, notes: Vec::new() })
}

/// Median, quartiles, least and most of a ray.
fn microseconds(point: &GeodesicPoint) -> [f64; 5] {
    point.times.seconds().map(|time| 1e6 * time)
}

fn integrator(method: Method) -> &'static str {
    match method {
        Method::Dop853 => "DOP853",
        Method::Dopri5 => "DOPRI5",
    }
}

fn row(point: &GeodesicPoint, is_best: bool) -> [Value; COLUMNS.len()] {
    let [median, low, high, least, most] = microseconds(point).map(|time| json!(time));
    let error = |of_chords: bool, value: f64| {
        if point.sagitta.is_some() == of_chords { json!(value) } else { Value::Null }
    };
    [
        json!(point.spin),
        json!(point.law),
        json!(integrator(point.method)),
        json!(point.tolerance),
        json!(point.sagitta),
        median,
        low,
        high,
        least,
        most,
        json!(point.chords),
        error(false, point.worst),
        error(false, point.rms),
        error(true, point.worst),
        error(true, point.rms),
        json!(point.lost),
        json!(is_best),
    ]
}

fn panel(spin: f64, points: &[&GeodesicPoint], front: &[usize], with_chords: bool) -> Panel {
    let mut series: Vec<Series> = vec![front_of(front, |i| [microseconds(points[i])[0], points[i].worst])];
    for (i, point) in points.iter().enumerate() {
        let name = format!("{}, {}", point.law, integrator(point.method));
        let [x, low, high, ..] = microseconds(point);
        let label = point.sagitta.map_or_else(
            || power_of_ten(point.tolerance.log10().round() as i32),
            |sagitta| format!("{sagitta}"),
        );
        let hollow = !front.contains(&i);
        let point =
            Point { x, y: point.worst, x_spread: Some([low, high]), label, hollow, ..Point::default() };
        join(&mut series, name, point);
    }
    let hole = if spin == 0.0 { "Schwarzschild".to_owned() } else { format!("Kerr, a = {spin} M") };
    let (title, error) = match (with_chords, spin == 0.0) {
        (true, _) => (format!("{hole}: chords along rays of 10⁻⁸"), "worst distance of ray and chord, M"),
        (false, true) => (format!("{hole}: against the closed form"), "worst error of the deflection, rad"),
        (false, false) => (format!("{hole}: against other equations"), "worst error on the sky, rad"),
    };
    Panel {
        title,
        x: Axis::log("time of a ray, µs"),
        y: Axis::log(error).with_zero("0"),
        series,
        ..Panel::default()
    }
}

fn said_of(spin: f64, front: &[usize], points: &[&GeodesicPoint]) -> String {
    let mut said = format!("spin {spin}: the front of speed and accuracy\n");
    for &i in front {
        let point = points[i];
        said.push_str(&format!(
            "  {:9.2} µs a ray, off by {:.1e} rad at most: {}, {} to {:e}\n",
            microseconds(point)[0],
            point.worst,
            point.law,
            integrator(point.method),
            point.tolerance
        ));
    }
    said
}
