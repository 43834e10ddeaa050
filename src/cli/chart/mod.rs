mod files;
mod geodesics;
mod table;

use super::Fault;
use super::report::ReportFlags;
use clap::Args;
use files::Files;
use serde_json::{Value, json};
use std::path::PathBuf;
use table::Table;
use terrell::figure::Figure;
use terrell::measure::GeodesicSweep;

/// Speed against accuracy, measured and drawn
#[derive(Args)]
#[command(after_help = "Examples:
  terrell chart --geodesics -o docs/images/geodesics")]
pub struct Chart {
    /// Light past black holes instead: integrators, tolerances, chords, against the closed form
    #[arg(long, required = true)]
    geodesics: bool,
    /// A .svg, .png, .csv or .json file; without ending all four, in a folder chart.svg and so on [default: chart, or
    /// geodesics]
    #[arg(short, long, value_name = "PATH")]
    output: Option<PathBuf>,
    /// Each is timed so often, all in turn [default: 11]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    repeats: Option<u32>,
    /// Less of everything, to have a look in seconds
    #[arg(long)]
    quick: bool,
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
        let name = "geodesics";
        let files = Files::of(&self.output.clone().unwrap_or_else(|| name.into()), name)?;
        let read: Vec<PathBuf> = Vec::new();
        files.check(&self.report, &read)?;
        let Charted { figure, table, about, mut said, notes } = self.geodesics()?;
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
}
