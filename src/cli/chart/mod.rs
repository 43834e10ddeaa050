mod files;
mod geodesics;
mod scenes;
mod stability;
mod table;

use super::Fault;
use super::look::{ColorFlag, DevelopFlags, MomentFlags};
use super::report::ReportFlags;
use super::source;
use super::values::{count, number, size};
use clap::Args;
use files::Files;
use glam::DVec3;
use scenes::{Case, Ways};
use serde_json::{Value, json};
use std::path::PathBuf;
use table::Table;
use terrell::figure::{Figure, Point, Series, Stroke};
use terrell::geodesic::Celerity;
use terrell::measure::{GeodesicSweep, ON_GPU, series_names};
use terrell::plan::is_of_polygons;
use terrell::render::{Options, has_gpu};
use terrell::scene::{Choice, Scene, Speed, builtin_scenes};

/// Speed against accuracy, measured and drawn: every method, or every way to follow light past a black hole
///
/// Draws scenes by every method at several tolerances, times all in turn, and measures how far outlines are displaced
/// (in pixels, against the exact images of edges), which pixels see something else than rays do, and how far light is off
/// (relative RMS, FLIP). The chart has a row a scene, speed and size. Points on the thick grey line are the ones nothing
/// measured is faster and more accurate than.
#[derive(Args)]
#[command(after_help = "Examples:
  terrell chart                                         every scene of glowing surfaces, to chart.svg, .png, .csv, .json
  terrell chart gate --beta 0.5,0.9,0.99 -o gate.svg
  terrell chart statue.glb --beta 0.9 --size 320x180,1280x720 -o statue
  terrell chart cube --methods exact,apparent --tolerance 1,1/4 --repeats 31
  terrell chart --geodesics -o docs/images/geodesics    integrators past black holes
  terrell chart --stability -o docs/images/stability    where each method fails")]
pub struct Chart {
    /// Scenes: names, .toml files or meshes [default: those that ship in which no surface is lit]
    #[arg(value_name = "SCENE", conflicts_with = "geodesics")]
    scenes: Vec<String>,
    /// Light past black holes instead: integrators, tolerances, chords, against the closed form
    #[arg(long, conflicts_with_all = ["beta", "tolerance", "size", "samples", "methods", "time", "when"])]
    geodesics: bool,
    /// Where each method fails instead: maps of measured errors, and what is done there; six pictures
    #[arg(
        long,
        conflicts_with_all =
            ["scenes", "geodesics", "beta", "tolerance", "size", "samples", "methods", "repeats", "time", "when"]
    )]
    stability: bool,
    /// A .svg, .png, .csv or .json file; without ending all four, in a folder chart.svg and so on [default: chart,
    /// geodesics or stability]
    #[arg(short, long, value_name = "PATH")]
    output: Option<PathBuf>,
    /// Speeds over c of what moves in a scene, each a row [default: the scene's own]
    #[arg(long, value_name = "β,…", value_delimiter = ',', value_parser = number)]
    beta: Vec<f64>,
    /// Tolerances of apparent shading, pixels [default: 4,2,1,1/2,1/4,1/8,1/16; of the painter and Doppler factors at vertices
    /// every second]
    #[arg(long, value_name = "PX,…", value_delimiter = ',', value_parser = fraction)]
    tolerance: Vec<f64>,
    /// Samples a pixel of exact shading and rays [default: 1,4,16]
    #[arg(long, value_name = "N,…", value_delimiter = ',', value_parser = count)]
    samples: Vec<u32>,
    /// Sizes, each a row [default: 640x360]
    #[arg(long, value_name = "WxH,…", value_delimiter = ',', value_parser = size)]
    size: Vec<[u32; 2]>,
    /// Which series: exact, trace, apparent, painter, uncut, 'D at vertices', 'f32 vertices', 'GPU exact', 'GPU apparent'
    /// [default: all; the last two if there is a graphics processor that is more than a program on the CPU]
    #[arg(long, value_name = "A,B,…", value_delimiter = ',', value_parser = series)]
    methods: Vec<&'static str>,
    /// Each is timed so often, all in turn [default: 5; of geodesics 11]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    repeats: Option<u32>,
    /// Less of everything, to have a look in seconds
    #[arg(long)]
    quick: bool,
    /// What a pixel shows
    #[arg(long, value_enum, default_value = "spectral")]
    color: ColorFlag,
    #[command(flatten)]
    develop: DevelopFlags,
    #[command(flatten)]
    moment: MomentFlags,
    #[command(flatten)]
    report: ReportFlags,
}

/// What was measured, drawn.
struct Charted {
    figure: Figure,
    table: Table,
    /// What holds for all of it.
    about: Value,
    /// What people are told.
    said: String,
    notes: Vec<String>,
}

impl Chart {
    pub fn run(self) -> Result<(), Fault> {
        if self.stability {
            return self.stability();
        }
        let name = if self.geodesics { "geodesics" } else { "chart" };
        let files = Files::of(&self.output.clone().unwrap_or_else(|| name.into()), name)?;
        let cases = if self.geodesics { Vec::new() } else { self.cases()? };
        let read: Vec<PathBuf> = cases.iter().flat_map(|case| case.scene.files.clone()).collect();
        files.check(&self.report, &read)?;
        let charted = if self.geodesics { self.geodesics() } else { self.scenes(&cases) };
        let Charted { figure, table, about, mut said, notes } = charted?;
        let told = json!({
            "terrell": env!("CARGO_PKG_VERSION"),
            "chart": name,
            "about": about,
            "points": table.told(),
            "notes": notes,
        });
        self.report.finish(files.prepare(&figure, &table, &told)?, &read, &told)?;
        for note in &notes {
            said.push_str(&format!("note: {note}\n"));
        }
        self.report.tell(&format!("{said}{files}\n"), &told)
    }

    fn geodesics(&self) -> Result<Charted, Fault> {
        let mut sweep = GeodesicSweep::default();
        if self.quick {
            sweep.tolerances = vec![1e-4, 1e-8, 1e-12];
            sweep.sagittas = vec![0.1, 0.01];
            (sweep.rays, sweep.repeats) = (16, 3);
        }
        sweep.repeats = self.repeats.unwrap_or(sweep.repeats);
        geodesics::chart(&sweep, self.report.quiet)
    }

    fn scenes(&self, cases: &[Case]) -> Result<Charted, Fault> {
        let or =
            |given: &Vec<f64>, usual: &[f64]| if given.is_empty() { usual.to_vec() } else { given.clone() };
        let quick = self.quick;
        let few: &[f64] = if quick { &[1.0, 0.25] } else { &[4.0, 1.0, 0.25, 0.0625] };
        let tolerances = if quick { few } else { &[4.0, 2.0, 1.0, 0.5, 0.25, 0.125, 0.0625] };
        let samples: &[u32] = if quick { &[1] } else { &[1, 4, 16] };
        let ways = Ways {
            options: Options { coloring: self.color.coloring(), ..Options::default() },
            tolerances: or(&self.tolerance, tolerances),
            few_tolerances: or(&self.tolerance, few),
            samples: if self.samples.is_empty() { samples.to_vec() } else { self.samples.clone() },
            reference_samples: if quick { 16 } else { 64 },
            series: self.series(),
            repeats: self.repeats.unwrap_or(if quick { 3 } else { 5 }),
        };
        scenes::chart(cases, &ways, &self.develop, self.report.quiet)
    }

    /// Those asked for, or all there can be.
    fn series(&self) -> Vec<&'static str> {
        if !self.methods.is_empty() {
            return self.methods.clone();
        }
        let has_gpu = has_gpu();
        series_names().into_iter().filter(|name| has_gpu || !ON_GPU.contains(name)).collect()
    }

    /// Every scene at every speed and size.
    fn cases(&self) -> Result<Vec<Case>, Fault> {
        let shipped = builtin_scenes().iter().filter(|scene| is_of_polygons(&scene.scene()));
        let names: Vec<&str> = match &self.scenes[..] {
            [] => shipped.map(|scene| scene.name).collect(),
            scenes => scenes.iter().map(String::as_str).collect(),
        };
        let speed = |beta: &f64| {
            Ok::<_, Fault>(Some(Speed::Along(Celerity::from_beta(DVec3::X * *beta)?.vector().x)))
        };
        let speeds = match &self.beta[..] {
            [] => vec![None],
            betas => betas.iter().map(speed).collect::<Result<_, _>>()?,
        };
        let usual = if self.quick { [160, 90] } else { [640, 360] };
        let sizes = if self.size.is_empty() { vec![usual] } else { self.size.clone() };
        let mut cases = Vec::new();
        for name in names {
            for speed in &speeds {
                for &size in &sizes {
                    cases.push(self.case(name, *speed, size)?);
                }
            }
        }
        Ok(cases)
    }

    fn case(&self, name: &str, speed: Option<Speed>, size: [u32; 2]) -> Result<Case, Fault> {
        let mut scene: Scene = source::open(name, speed, &Choice::default(), None, |view| view.size = size)?;
        if scene.spacetime.is_curved() {
            let why =
                "in curved spacetime rays are the only method, and there is nothing to compare them with";
            return Err(
                format!("'{}': {why}; --geodesics charts how light is followed there", scene.name).into()
            );
        }
        self.moment.set(&mut scene)?;
        let camera = scene.camera()?;
        Ok(Case { scene, camera })
    }
}

/// Adds a point to the line of its name, which it begins where there is none.
fn join(series: &mut Vec<Series>, name: impl Into<String>, point: Point) {
    let name = name.into();
    match series.iter_mut().find(|series| series.name == name) {
        Some(series) => series.points.push(point),
        None => series.push(Series { stroke: Stroke::Line, ..Series::points(name, vec![point]) }),
    }
}

/// The line of the best.
fn front_of(front: &[usize], place: impl Fn(usize) -> [f64; 2]) -> Series {
    Series { stroke: Stroke::Front, ..Series::line("Pareto front", front.iter().map(|&i| place(i))) }
}

/// A series by its name.
fn series(text: &str) -> Result<&'static str, String> {
    let names = series_names();
    let known = names.iter().find(|name| **name == text.trim()).copied();
    known.ok_or_else(|| format!("'{}' is no series; there is {}", text.trim(), names.join(", ")))
}

/// A number above 0, or 1 over one.
fn fraction(text: &str) -> Result<f64, String> {
    let value = match text.trim().split_once('/') {
        Some((over, under)) => number(over)? / number(under)?,
        None => number(text)?,
    };
    if value > 0.0 && value.is_finite() {
        Ok(value)
    } else {
        Err(format!("'{}' is not above 0 px", text.trim()))
    }
}
