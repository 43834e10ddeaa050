use super::Chart;
use super::files::Files;
use super::table::Table;
use crate::cli::Fault;
use crate::cli::progress::progress_bar;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use terrell::figure::{Axis, Figure, HeatMap, Panel, Scale, Series, Stroke};
use terrell::measure::stability::{self, Map, Planner, Resolution, SHEETS, Sheet};

const COLUMNS: &[&str] = &[
    "sheet",
    "map",
    "x_is",
    "x",
    "y_is",
    "y",
    "error_is",
    "error",
    "fails_above",
    "fails",
    "conditioning",
    "planner",
];

/// How a sheet looks: maps in a row, the size of one, the errors of the first and the last colour.
fn look(sheet: &str) -> (usize, [f64; 2], [f64; 2]) {
    match sheet {
        "place" => (4, [250.0, 260.0], [1e-17, 1.0]),
        "sight" => (3, [330.0, 230.0], [1e-3, 1e2]),
        "cutting" => (2, [380.0, 260.0], [1e-2, 1e3]),
        "painter" => (2, [380.0, 240.0], [1e-5, 1.0]),
        "vertices" => (3, [330.0, 260.0], [1e-7, 1.0]),
        _ => (2, [380.0, 260.0], [1e-14, 1.0]),
    }
}

impl Chart {
    /// Measures all maps, and draws them sheet by sheet.
    pub(super) fn stability(&self) -> Result<(), Fault> {
        let files = files(self.output.as_deref().unwrap_or("stability".as_ref()))?;
        let read: Vec<PathBuf> = Vec::new();
        files.iter().try_for_each(|(_, files)| files.check(&self.report, &read))?;
        let resolution = if self.quick { Resolution::Quick } else { Resolution::Usual };
        let bar = progress_bar(SHEETS.len(), "sheets", self.report.quiet);
        let sheets: Vec<Vec<Map>> = SHEETS
            .iter()
            .map(|sheet| {
                let maps = sheet.maps(resolution);
                bar.inc(1);
                maps
            })
            .collect();
        bar.finish_and_clear();
        let mut table = Table::new(COLUMNS);
        let maps = || sheets.iter().flatten();
        maps().for_each(|map| push(&mut table, map));
        let told = json!({
            "terrell": env!("CARGO_PKG_VERSION"),
            "chart": "stability",
            "quick": self.quick,
            "maps": maps().map(told).collect::<Vec<_>>(),
        });
        let figures: Vec<Figure> =
            SHEETS.iter().zip(&sheets).map(|(sheet, maps)| figure(sheet, maps)).collect();
        let mut pending = Vec::new();
        for (sheet, files) in &files {
            // What is no picture has all of them.
            let figure = &figures[sheet.unwrap_or(0)];
            pending.extend(files.prepare(figure, &table, &told)?);
        }
        self.report.finish(pending, &read, &told)?;
        let names: Vec<String> = files.iter().map(|(_, files)| files.to_string()).collect();
        self.report.tell(&format!("{}{}\n", said(&sheets), names.join(", ")), &told)
    }
}

/// What is written where; of which sheet, if it is a picture.
fn files(output: &Path) -> Result<Vec<(Option<usize>, Files)>, Fault> {
    let ending = output.extension().filter(|_| !output.is_dir()).map(|e| e.to_string_lossy().to_lowercase());
    let stem = if output.is_dir() { output.join("stability") } else { output.with_extension("") };
    let endings = match &ending {
        None => vec!["svg", "png", "csv", "json"],
        Some(ending) => vec![ending.as_str()],
    };
    let mut files = Vec::new();
    for ending in endings {
        if !["svg", "png"].contains(&ending) {
            files.push((None, Files::of(&stem.with_extension(ending), "stability")?));
            continue;
        }
        for (number, sheet) in SHEETS.iter().enumerate() {
            let mut name = stem.file_name().unwrap_or_default().to_owned();
            name.push(format!("_{}.{ending}", sheet.name));
            files.push((Some(number), Files::of(&stem.with_file_name(name), "stability")?));
        }
    }
    Ok(files)
}

fn push(table: &mut Table, map: &Map) {
    let value = |axis: &stability::Axis, i: usize| match &axis.words {
        Some(words) => json!(words[i]),
        None => json!(axis.values[i]),
    };
    for row in 0..map.y.len() {
        for column in 0..map.x.len() {
            let cell = map.cell(column, row);
            table.push([
                json!(map.sheet),
                json!(map.name),
                json!(map.x.name),
                value(&map.x, column),
                json!(map.y.name),
                value(&map.y, row),
                json!(map.quantity),
                error(map.errors[cell]),
                json!(map.tolerance),
                json!(map.fails(cell)),
                json!(map.conditioning.as_ref().map(|all| all[cell])),
                json!(map.planner[cell].word()),
            ]);
        }
    }
}

/// JSON knows no infinity.
fn error(value: f64) -> Value {
    if value.is_finite() { json!(value) } else { json!("inf") }
}

fn told(map: &Map) -> Value {
    let axis =
        |axis: &stability::Axis| json!({ "is": axis.name, "values": axis.values, "words": axis.words });
    json!({
        "sheet": map.sheet,
        "name": map.name,
        "title": map.title,
        "x": axis(&map.x),
        "y": axis(&map.y),
        "error_is": map.quantity,
        "fails_above": map.tolerance,
        "failing_cells": map.failures(),
        "worst_where_taken": map.worst(&[Planner::Enters]).map(error),
        "failing_cells_the_planner_enters": map.faults(),
        "words": map.words,
    })
}

/// Sheet by sheet: how many cells fail, and how far off is what is taken.
fn said(sheets: &[Vec<Map>]) -> String {
    let mut said = String::new();
    for (sheet, maps) in SHEETS.iter().zip(sheets) {
        said.push_str(&format!("{}\n", sheet.title));
        for map in maps {
            let taken = map.worst(&[Planner::Enters]);
            let taken =
                taken.map_or("never taken".to_owned(), |worst| format!("taken, off by {worst:.0e} at most"));
            let (fail, all) = (map.failures(), map.errors.len());
            said.push_str(&format!("  {:<46} {fail:4} of {all:4} cells fail; {taken}\n", map.title));
        }
    }
    let faults: Vec<String> = sheets.iter().flatten().flat_map(Map::faults).collect();
    for fault in &faults {
        said.push_str(&format!("note: fails where it is taken: {fault}\n"));
    }
    said
}

fn figure(sheet: &Sheet, maps: &[Map]) -> Figure {
    let (across, panel_size, colors) = look(sheet.name);
    let panels: Vec<Panel> =
        maps.iter().enumerate().map(|(i, map)| panel(map, i % across == 0, colors)).collect();
    let hatched =
        maps.first().map_or(String::new(), |map| format!("Hatched: the error exceeds {}. ", map.limit()));
    let warns = maps.iter().any(|map| map.planner.contains(&Planner::Warns));
    let warned = if warns {
        " In yellow, dashed: only where nothing else can be done, and a note says that it fails."
    } else {
        ""
    };
    let subtitle =
        format!("{hatched}Framed in green: what is done there if nothing else is asked for.{warned}");
    Figure {
        title: sheet.title.into(),
        subtitle: vec![subtitle],
        rows: panels.chunks(across).map(<[Panel]>::to_vec).collect(),
        panel_size,
        notes: Vec::new(),
    }
}

fn panel(map: &Map, first: bool, range: [f64; 2]) -> Panel {
    let sides = [map.x.len() as f64, map.y.len() as f64];
    let heat = HeatMap {
        label: map.quantity.into(),
        scale: Scale::Log,
        range: Some(range),
        x: [0.0, sides[0]],
        y: [0.0, sides[1]],
        columns: map.x.len(),
        values: map.errors.clone(),
    };
    // Long words are written once a row of panels.
    let is_written = first || map.y.words.is_none();
    let name = if is_written { map.y.name } else { "" };
    Panel {
        title: map.title.clone(),
        x: Axis::linear(map.x.name).from_to(0.0, sides[0]).with_marks(marks(&map.x, true)),
        y: Axis::linear(name).from_to(0.0, sides[1]).with_marks(marks(&map.y, is_written)),
        map: Some(heat),
        series: [hatching(map), frame(map, Planner::Warns), frame(map, Planner::Enters)]
            .into_iter()
            .flatten()
            .collect(),
        notes: vec![map.words.clone()],
    }
}

/// Marks in the middles of cells.
fn marks(axis: &stability::Axis, is_written: bool) -> Vec<(f64, Option<String>)> {
    let is_decade = |v: f64| v > 0.0 && (v.log10() - v.log10().round()).abs() < 1e-9;
    let all = axis.words.is_some() || axis.len() <= 13 || axis.values.iter().any(|v| *v <= 0.0);
    let mark = |i: usize| {
        (i as f64 + 0.5, (is_written && (all || is_decade(axis.values[i]))).then(|| axis.label(i)))
    };
    (0..axis.len()).map(mark).collect()
}

/// What parts lines of one series.
const GAP: [f64; 2] = [f64::NAN; 2];

/// A stroke across every cell that fails.
fn hatching(map: &Map) -> Option<Series> {
    let failing = (0..map.errors.len()).filter(|cell| map.fails(*cell));
    let stroke = |cell: usize| {
        let (x, y) = ((cell % map.x.len()) as f64, (cell / map.x.len()) as f64);
        [[x, y], [x + 1.0, y + 1.0], GAP]
    };
    let points: Vec<[f64; 2]> = failing.flat_map(stroke).collect();
    (!points.is_empty()).then(|| Series { ink: Some([0, 165, 215]), ..Series::line("fails", points) })
}

/// A line around the cells in which the planner does something.
fn frame(map: &Map, planner: Planner) -> Option<Series> {
    let (columns, rows) = (map.x.len(), map.y.len());
    let is_in = |x: Option<usize>, y: Option<usize>| {
        let inside = x.zip(y).filter(|(x, y)| *x < columns && *y < rows);
        inside.is_some_and(|(x, y)| map.planner[map.cell(x, y)] == planner)
    };
    let mut points: Vec<[f64; 2]> = Vec::new();
    for y in 0..=rows {
        for x in 0..=columns {
            let (left, below) = (x.checked_sub(1), y.checked_sub(1));
            let [u, v] = [x as f64, y as f64];
            if is_in(Some(x), Some(y)) != is_in(Some(x), below) {
                points.extend([[u, v], [u + 1.0, v], GAP]);
            }
            if is_in(Some(x), Some(y)) != is_in(left, Some(y)) {
                points.extend([[u, v], [u, v + 1.0], GAP]);
            }
        }
    }
    let (name, stroke, ink) = match planner {
        Planner::Enters => ("taken", Stroke::Line, [70, 215, 90]),
        Planner::Warns => ("taken only with a note", Stroke::Dashed, [240, 220, 60]),
        Planner::Avoids => return None,
    };
    (!points.is_empty()).then(|| Series { stroke, ink: Some(ink), ..Series::line(name, points) })
}
