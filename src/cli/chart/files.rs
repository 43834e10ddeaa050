use super::table::Table;
use crate::cli::Fault;
use crate::cli::report::{ReportFlags, check_target};
use serde_json::Value;
use std::io::Write;
use std::path::{Path, PathBuf};
use terrell::figure::Figure;
use terrell::picture::{self, Pending};

/// What a chart is written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Svg,
    Png,
    Csv,
    Json,
}

const FORMATS: [(&str, Format); 4] =
    [("svg", Format::Svg), ("png", Format::Png), ("csv", Format::Csv), ("json", Format::Json)];

/// Pixels of a PNG for one of the page: sharp on screens of today.
const SCALE: f64 = 2.0;

/// Where a chart goes.
pub struct Files(Vec<(PathBuf, Format)>);

impl Files {
    /// By the name's ending; without one all four, in a folder by `name`.
    pub fn of(output: &Path, name: &str) -> Result<Self, Fault> {
        if let Some(ending) = output.extension().filter(|_| !output.is_dir()) {
            let known = FORMATS.iter().find(|(known, _)| ending.eq_ignore_ascii_case(known));
            let (_, format) = known.ok_or_else(|| {
                let ending = ending.to_string_lossy();
                format!(
                    "{}: unknown chart format '.{ending}'; write to a .svg, .png, .csv or .json file, or leave the ending \
                     out for all four",
                    output.display()
                )
            })?;
            return Ok(Self(vec![(output.to_owned(), *format)]));
        }
        let stem = if output.is_dir() { output.join(name) } else { output.to_owned() };
        Ok(Self(FORMATS.map(|(ending, format)| (stem.with_extension(ending), format)).into()))
    }

    /// Before the work: whether they can be written, and are none of what was read.
    pub fn check(&self, report: &ReportFlags, read: &[PathBuf]) -> Result<(), Fault> {
        self.0.iter().try_for_each(|(path, _)| {
            check_target(path)?;
            report.check(path, read)
        })
    }

    /// Writes them, to be finished.
    pub fn prepare(&self, figure: &Figure, table: &Table, told: &Value) -> Result<Vec<Pending>, Fault> {
        let page = figure.page();
        let write = |(path, format): &(PathBuf, Format)| {
            Ok(match format {
                Format::Svg => picture::prepare(path, |to| to.write_all(page.svg().as_bytes()))?,
                Format::Csv => picture::prepare(path, |to| to.write_all(table.csv().as_bytes()))?,
                Format::Json => picture::prepare(path, |to| writeln!(to, "{told:#}"))?,
                Format::Png => {
                    let png = page.png(SCALE);
                    let png = png.ok_or("the chart is too large to be painted; write an .svg")?;
                    picture::prepare(path, |to| to.write_all(&png))?
                }
            })
        };
        self.0.iter().map(write).collect()
    }
}

impl std::fmt::Display for Files {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let names: Vec<String> = self.0.iter().map(|(path, _)| path.display().to_string()).collect();
        f.write_str(&names.join(", "))
    }
}
