use super::table::Table;
use super::{Charted, front_of, join};
use crate::cli::Fault;
use crate::cli::look::DevelopFlags;
use crate::cli::progress::progress_bar;
use crate::cli::summary;
use serde_json::{Value, json};
use terrell::figure::{Axis, Figure, Panel, Point, Series, Stroke, power_of_ten};
use terrell::light::DopplerAt;
use terrell::measure::{
    Displacement, Measured, Sweep, SweepPoint, SweepWay, Times, Vertices, pareto_front, usual_ways,
};
use terrell::plan::{Method, has_reflections};
use terrell::relativity::ApparentMap;
use terrell::render::{Options, Raster};
use terrell::scene::{Camera, Scene};

/// What is swept, of every case.
pub struct Ways {
    pub options: Options,
    pub tolerances: Vec<f64>,
    /// Those at which the painter and Doppler factors at vertices are drawn.
    pub few_tolerances: Vec<f64>,
    pub samples: Vec<u32>,
    pub reference_samples: u32,
    /// Series that are drawn; none of all.
    pub series: Vec<&'static str>,
    pub repeats: u32,
}

/// A scene at one speed and one size.
pub struct Case {
    pub scene: Scene,
    pub camera: Camera,
}

const COLUMNS: &[&str] = &[
    "scene",
    "beta",
    "gamma",
    "width",
    "height",
    "series",
    "method",
    "raster",
    "tolerance_px",
    "samples",
    "doppler_at",
    "precision",
    "triangles",
    "pieces",
    "prepare_ms",
    "frame_ms_median",
    "frame_ms_lower_quartile",
    "frame_ms_upper_quartile",
    "frame_ms_least",
    "frame_ms_most",
    "runs",
    "edge_displacement_px_worst",
    "edge_displacement_px_rms",
    "pixels_beyond_their_face",
    "beyond_face_px_worst",
    "beyond_face_px_rms",
    "displacement_px_worst",
    "silhouette_pixels",
    "silhouette_pixels_beyond_a_pixel",
    "edge_pixels",
    "edge_pixels_beyond_a_pixel",
    "light_same_rays_rms_relative",
    "light_same_face_worst_over_peak",
    "light_rms_relative",
    "light_worst_over_peak",
    "flip_mean",
    "flip_worst",
    "pareto_displacement",
    "pareto_light_same_rays",
    "pareto_light",
    "failed",
];

/// What is charted over the time, in a panel of its own.
struct Charting {
    what: &'static str,
    label: &'static str,
    /// None of what it is not charted of.
    of: fn(&SweepPoint) -> Option<f64>,
}

const ERRORS: [Charting; 3] = [
    Charting { what: "outlines", label: "worst displacement, px", of: displacement },
    Charting { what: "light, against the same rays", label: "relative RMS of light", of: light_of_same_rays },
    Charting { what: "light, against many rays a pixel", label: "relative RMS of light", of: light },
];

/// Where the Doppler factor is worked out moves no outline.
fn displacement(point: &SweepPoint) -> Option<f64> {
    point.displacement().filter(|_| point.way.options.doppler_at == DopplerAt::Pixel)
}

/// Of pictures that are of one ray a pixel, too.
fn light_of_same_rays(point: &SweepPoint) -> Option<f64> {
    let is_one = point.way.options.samples == 1 && point.way.vertices != Vertices::CutF32;
    point.measured.as_ref().ok().filter(|_| is_one).map(|m| m.seen.radiance.relative_rms)
}

fn light(point: &SweepPoint) -> Option<f64> {
    let is_timed = point.way.vertices != Vertices::CutF32;
    point.measured.as_ref().ok().filter(|_| is_timed).map(|m| m.light.radiance.relative_rms)
}

/// Below that an error is one of rounding, and drawn as none.
const ROUNDING: f64 = 1e-6;

/// Measures and draws all ways on all cases.
pub fn chart(cases: &[Case], ways: &Ways, develop: &DevelopFlags, quiet: bool) -> Result<Charted, Fault> {
    let all: Vec<SweepWay> = usual_ways(&ways.options, &ways.tolerances, &ways.few_tolerances, &ways.samples)
        .into_iter()
        .filter(|way| ways.series.contains(&way.series))
        .collect();
    let timed = all.iter().filter(|way| way.vertices != Vertices::CutF32).count();
    let bar = progress_bar(cases.len() * timed * (ways.repeats as usize + 1), "pictures", quiet);
    let (mut table, mut rows) = (Table::new(COLUMNS), Vec::new());
    let (mut said, mut notes, mut any) = (String::new(), Vec::new(), false);
    for (number, case) in cases.iter().enumerate() {
        let Case { scene, camera } = case;
        let sweep = Sweep {
            scene,
            camera,
            ways: all.clone(),
            reference_samples: ways.reference_samples,
            repeats: ways.repeats,
        };
        let coloring = ways.options.coloring;
        let (exposure, tone) = (develop.exposure(coloring, scene), develop.tone(coloring));
        let develop = |film: &_| exposure.of_picture(tone, scene, camera, &ways.options, film);
        let points = sweep.run(&ways.options, develop, || bar.inc(1))?;
        bar.set_position(((number + 1) * timed * (ways.repeats as usize + 1)) as u64);
        let fronts = ERRORS.each_ref().map(|error| front(&points, error.of));
        for (i, point) in points.iter().enumerate() {
            table.push(row(case, point, [0, 1, 2].map(|e| fronts[e].contains(&i))));
        }
        let panels = ERRORS.iter().zip(&fronts).map(|(error, front)| panel(error, &points, front));
        let mut panels: Vec<Panel> = panels.collect();
        panels[0].title = format!("{}: {}", case.title(), panels[0].title);
        rows.push(panels);
        said.push_str(&said_of(case, &points, &fronts[0]));
        if has_reflections(scene) {
            notes.push(format!("{}: light of surfaces on each other is left out", scene.name));
        }
        any |= points.iter().any(|point| point.measured.is_ok());
        let failed = points.iter().filter_map(|p| Some((p.way.series, p.measured.as_ref().err()?)));
        for (series, why) in failed {
            let note = format!("{}: {series} is missing: {why}", case.title());
            if !notes.contains(&note) {
                notes.push(note);
            }
        }
    }
    bar.finish_and_clear();
    if !any {
        return Err(notes.join("; ").into());
    }
    let about = json!({
        "color": ways.options.coloring.to_string(),
        "reference": "ray tracing",
        "reference_samples": ways.reference_samples,
        "repeats": ways.repeats,
        "threads": rayon::current_num_threads(),
    });
    let figure = Figure {
        title: "Speed and accuracy of the ways to draw a scene".into(),
        subtitle: vec![subtitle(ways)],
        rows,
        panel_size: if cases.len() > 2 { [300.0, 210.0] } else { [330.0, 300.0] },
        notes: notes.clone(),
    };
    Ok(Charted { figure, table, about, said, notes })
}

fn subtitle(ways: &Ways) -> String {
    format!(
        "Times of a picture on {} threads, without preparation and encoding: medians of up to {} interleaved runs and their \
         quartiles. Numbers at points: tolerance in pixels; n×: samples a pixel, elsewhere 1. Errors against ray tracing: of \
         outlines against the exact images of edges; of light against one ray through each pixel's centre, and against {} \
         rays a pixel. Filled, on thick grey: nothing measured is faster and more accurate.",
        rayon::current_num_threads(),
        ways.repeats,
        ways.reference_samples
    )
}

impl Case {
    /// β and γ of what moves fastest relative to the camera.
    fn fastest(&self) -> (f64, f64) {
        let maps = self.scene.bodies.iter().map(|body| ApparentMap::new(&body.motion, &self.camera.observer));
        let speeds = maps.map(|map| (map.speed() / map.gamma(), map.gamma()));
        speeds.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0.0, 1.0))
    }

    fn size(&self) -> [u32; 2] {
        [self.camera.lens.width(), self.camera.lens.height()]
    }

    fn title(&self) -> String {
        let ([width, height], (beta, gamma)) = (self.size(), self.fastest());
        // As near to light speed as that γ says more.
        let speed =
            if gamma < 100.0 { format!("{}c", (1e4 * beta).round() / 1e4) } else { format!("γ {gamma:.4}") };
        format!("{}, {speed}, {width}×{height}", self.scene.name)
    }
}

/// Milliseconds: median, quartiles, least and most.
fn milliseconds(measured: &Measured) -> Option<[f64; 5]> {
    Some(measured.frame.as_ref()?.seconds().map(|time| 1e3 * time))
}

/// Where a point is, with its other times: none if it is not there, or was not timed.
fn place(point: &SweepPoint, error: fn(&SweepPoint) -> Option<f64>) -> Option<([f64; 5], f64)> {
    Some((milliseconds(point.measured.as_ref().ok()?)?, drawn(error(point)?)))
}

/// The points nothing timed is better than.
fn front(points: &[SweepPoint], error: fn(&SweepPoint) -> Option<f64>) -> Vec<usize> {
    let cost = |point| place(point, error).map_or([f64::NAN; 2], |([x, ..], y)| [x, y]);
    pareto_front(&points.iter().map(cost).collect::<Vec<_>>())
}

fn drawn(error: f64) -> f64 {
    if error < ROUNDING { 0.0 } else { error }
}

fn row(case: &Case, point: &SweepPoint, is_best: [bool; 3]) -> [Value; COLUMNS.len()] {
    let (Options { method, raster, tolerance, samples, doppler_at, .. }, [width, height]) =
        (&point.way.options, case.size());
    let (beta, gamma) = case.fastest();
    let is_apparent = *method == Method::Apparent;
    let is_cut = is_apparent && point.way.vertices != Vertices::Linear;
    let measured = point.measured.as_ref().ok();
    let number = |of: &dyn Fn(&Measured) -> Option<f64>| json!(measured.and_then(of));
    let count = |of: &dyn Fn(&Measured) -> usize| json!(measured.map(of));
    let time = |i: usize| number(&|m| milliseconds(m).map(|times| times[i]));
    let edges = |of: fn(&Displacement) -> f64| number(&|m| m.edges.as_ref().map(of));
    let wrong = |of: &dyn Fn(&Measured) -> Option<usize>| json!(measured.and_then(of));
    let silhouette = |m: &Measured| m.seen.silhouette.clone();
    let other_face = |m: &Measured| m.seen.edges.clone();
    [
        json!(case.scene.name),
        json!(beta),
        json!(gamma),
        json!(width),
        json!(height),
        json!(point.way.series),
        json!(method.to_string()),
        json!((*method != Method::Trace).then(|| summary::raster(*raster, *raster == Raster::Wgpu))),
        json!(is_cut.then_some(tolerance)),
        json!(samples),
        json!(summary::doppler_at(*doppler_at)),
        json!(if point.way.vertices == Vertices::CutF32 || *raster == Raster::Wgpu { "f32" } else { "f64" }),
        json!(case.scene.triangle_count()),
        count(&|m| m.pieces),
        number(&|m| Some(1e3 * m.preparation.as_secs_f64())),
        time(0),
        time(1),
        time(2),
        time(3),
        time(4),
        json!(measured.and_then(|m| m.frame.as_ref()).map(Times::runs)),
        edges(|d| d.worst),
        edges(|d| d.rms),
        number(&|m| Some(m.beyond.measured)),
        number(&|m| Some(m.beyond.worst)),
        number(&|m| Some(m.beyond.rms)),
        json!(point.displacement()),
        wrong(&|m| silhouette(m).map(|d| d.pixels)),
        wrong(&|m| silhouette(m).map(|d| d.beyond)),
        wrong(&|m| other_face(m).map(|d| d.pixels)),
        wrong(&|m| other_face(m).map(|d| d.beyond)),
        number(&|m| Some(m.seen.radiance.relative_rms)),
        number(&|m| m.seen.radiance_same_face.map(|light| light.worst)),
        number(&|m| Some(m.light.radiance.relative_rms)),
        number(&|m| Some(m.light.radiance.worst)),
        number(&|m| Some(m.perceived.mean)),
        number(&|m| Some(m.perceived.worst)),
        json!(is_best[0]),
        json!(is_best[1]),
        json!(is_best[2]),
        json!(point.measured.as_ref().err()),
    ]
}

/// What is written at a point.
fn label(way: &SweepWay) -> String {
    let Options { method, tolerance, samples, .. } = way.options;
    match (method, way.vertices) {
        (Method::Apparent, Vertices::Linear) => String::new(),
        // Every second, where they halve: 4, 1, 1/4, 1/16.
        (Method::Apparent, _)
            if tolerance.log2().rem_euclid(2.0) != 0.0 && tolerance.log2().fract() == 0.0 =>
        {
            String::new()
        }
        (Method::Apparent, _) => fraction(tolerance),
        _ if samples == 1 => String::new(),
        _ => format!("{samples}×"),
    }
}

/// 1/16 rather than 0.0625.
fn fraction(value: f64) -> String {
    let inverse = 1.0 / value;
    if value < 1.0 && inverse.fract() == 0.0 { format!("1/{inverse}") } else { format!("{value}") }
}

fn panel(error: &Charting, points: &[SweepPoint], front: &[usize]) -> Panel {
    let place = |point: &SweepPoint| place(point, error.of);
    let at = |i: usize| place(&points[i]).map_or([f64::NAN; 2], |([x, ..], y)| [x, y]);
    let mut series = vec![front_of(front, at)];
    for (i, point) in points.iter().enumerate() {
        let Some(([x, low, high, ..], y)) = place(point) else { continue };
        let (name, hollow) = (point.way.series, !front.contains(&i));
        let point =
            Point { x, y, x_spread: Some([low, high]), label: label(&point.way), hollow, ..Point::default() };
        join(&mut series, name, point);
    }
    let times = points.iter().filter_map(place).map(|([x, ..], _)| x);
    let [from, to] = times.fold([f64::INFINITY, 0.0], |[a, b], x| [f64::min(a, x), f64::max(b, x)]);
    let of_f32 = points.iter().filter(|p| p.way.vertices == Vertices::CutF32);
    for y in of_f32.filter_map(error.of) {
        let level = Series::line("f32 vertices", [[from, y], [to, y]]);
        series.push(Series { stroke: Stroke::Dashed, ink: Some([90; 3]), ..level });
    }
    Panel {
        title: error.what.into(),
        x: Axis::log("time of a picture, ms"),
        y: Axis::log(error.label).with_zero(format!("<{}", power_of_ten(ROUNDING.log10().round() as i32))),
        series,
        ..Panel::default()
    }
}

fn said_of(case: &Case, points: &[SweepPoint], front: &[usize]) -> String {
    let mut said = format!("{}\n", case.title());
    said.push_str("                 ms a picture   quartiles        prepared | px worst  edges rms | wrong px | light RMS  many samples    FLIP\n");
    for (i, point) in points.iter().enumerate() {
        let way = &point.way;
        let detail = match (way.options.method, way.vertices) {
            (Method::Apparent, Vertices::Linear) => String::new(),
            (Method::Apparent, _) => fraction(way.options.tolerance),
            _ => format!("{}×", way.options.samples),
        };
        let name = format!("{} {detail}", way.series);
        let mark = if front.contains(&i) { '*' } else { ' ' };
        match &point.measured {
            Err(why) => said.push_str(&format!("{mark} {name:20} {why}\n")),
            Ok(m) => {
                let times = milliseconds(m).map_or_else(
                    || format!("{:>10} {:>19}", "–", ""),
                    |[median, low, high, ..]| format!("{median:10.2} {low:9.2} …{high:8.2}"),
                );
                said.push_str(&format!(
                    "{mark} {name:20} {times} {:9.2} | {:8.1e} {:>9} | {:8} | {:9.1e} {:13.1e} {:7.4}\n",
                    1e3 * m.preparation.as_secs_f64(),
                    point.displacement().unwrap_or(0.0),
                    m.edges.map_or_else(|| "–".into(), |edges| format!("{:.1e}", edges.rms)),
                    m.wrong_pixels(),
                    m.seen.radiance.relative_rms,
                    m.light.radiance.relative_rms,
                    m.perceived.mean,
                ));
            }
        }
    }
    said.push('\n');
    said
}
