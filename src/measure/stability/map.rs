use crate::color::Coloring;
use crate::drawing::number::{significant, superscript};
use crate::plan::{Method, cheapest};
use crate::scene::Scene;
use rayon::prelude::*;

/// One side of a [`Map`].
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// What it counts, with its unit.
    pub name: &'static str,
    /// Of every column, from the left, or row, from the bottom.
    pub values: Vec<f64>,
    /// The values in words, where numbers do not tell what they are.
    pub words: Option<Vec<&'static str>>,
}

impl Axis {
    /// Of numbers.
    pub fn of(name: &'static str, values: impl Into<Vec<f64>>) -> Self {
        Self { name, values: values.into(), words: None }
    }

    /// Of places that are not numbers; their values are their numbers in the list.
    pub fn named(name: &'static str, words: Vec<&'static str>) -> Self {
        Self { name, values: (0..words.len()).map(|i| i as f64).collect(), words: Some(words) }
    }

    /// How many values there are.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// A value as it is written: in words, or as a number.
    pub fn label(&self, index: usize) -> String {
        match &self.words {
            Some(words) => words[index].to_owned(),
            None => number(self.values[index]),
        }
    }
}

/// Something of every cell of a map, row by row from below, on all cores.
pub(super) fn cells<X: Sync, Y: Sync, T: Send>(x: &[X], y: &[Y], of: impl Fn(&X, &Y) -> T + Sync) -> Vec<T> {
    let cell = |i: usize| of(&x[i % x.len()], &y[i / x.len()]);
    (0..x.len() * y.len()).into_par_iter().map(cell).collect()
}

/// A number of two digits as people write it: "0.25", "10⁻⁸", "3.2·10⁵".
pub(super) fn number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || (0.01..1e3).contains(&size) {
        return significant(value, 4);
    }
    // In steps of two digits there is no 9.96 that becomes 10.0.
    let rounded: f64 = format!("{value:.1e}").parse().unwrap_or(value);
    let exponent = rounded.abs().log10().floor() as i32;
    match significant(rounded / 10f64.powi(exponent), 2).as_str() {
        "1" => format!("10{}", superscript(exponent)),
        digits => format!("{digits}·10{}", superscript(exponent)),
    }
}

/// What the planner, or what is set where nothing is asked for, does in a cell of a [`Map`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Planner {
    /// This way to compute is not taken there.
    Avoids,
    /// It is taken only by who asks for what has no other, and a note says so.
    Warns,
    /// It is taken.
    Enters,
}

impl Planner {
    /// What is done with a scene, where a method is in question that needs nothing else.
    pub(super) fn of(scene: &Scene, method: Method) -> Self {
        if cheapest(scene, Coloring::Spectral).0 == method { Self::Enters } else { Self::Avoids }
    }
}

/// The error of one way to compute something, over two things it depends on.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// Of the sheet it is on.
    pub sheet: &'static str,
    /// Of it alone, fit for the name of a file.
    pub name: String,
    /// What is computed, and how.
    pub title: String,
    /// From left to right.
    pub x: Axis,
    /// From below to above.
    pub y: Axis,
    /// What the errors are, with their unit.
    pub quantity: &'static str,
    /// A larger error is a failure.
    pub tolerance: f64,
    /// Row by row from below, from the left; infinite where nothing right came of it.
    pub errors: Vec<f64>,
    /// What a relative change of the least exact input makes of itself, where the errors were divided by that; at least 1.
    pub conditioning: Option<Vec<f64>>,
    /// What the planner does in every cell.
    pub planner: Vec<Planner>,
    /// What fails where, and what is done about it.
    pub words: String,
}

impl Map {
    /// The number of a cell in the lists.
    pub fn cell(&self, column: usize, row: usize) -> usize {
        row * self.x.len() + column
    }

    /// The tolerance as it is written.
    pub fn limit(&self) -> String {
        number(self.tolerance)
    }

    /// Whether a cell fails.
    pub fn fails(&self, cell: usize) -> bool {
        let error = self.errors[cell];
        error.is_nan() || error > self.tolerance
    }

    /// How many cells fail.
    pub fn failures(&self) -> usize {
        (0..self.errors.len()).filter(|&cell| self.fails(cell)).count()
    }

    /// Failing cells that are entered without a word: faults of the planner, as "column, row" in the axes' values.
    pub fn faults(&self) -> Vec<String> {
        let cells =
            (0..self.errors.len()).filter(|&cell| self.fails(cell) && self.planner[cell] == Planner::Enters);
        let told = |cell: usize| {
            let (column, row) = (cell % self.x.len(), cell / self.x.len());
            format!(
                "{} {}, {} {}: {}",
                self.x.name,
                self.x.label(column),
                self.y.name,
                self.y.label(row),
                number(self.errors[cell])
            )
        };
        cells.map(told).collect()
    }

    /// The greatest error among the cells the planner does one of these things in.
    pub fn worst(&self, planner: &[Planner]) -> Option<f64> {
        let cells =
            self.errors.iter().zip(&self.planner).filter(|(_, p)| planner.contains(p)).map(|(e, _)| *e);
        cells.reduce(f64::max)
    }
}

impl Planner {
    /// "avoids", "warns", "enters".
    pub fn word(self) -> &'static str {
        match self {
            Self::Avoids => "avoids",
            Self::Warns => "warns",
            Self::Enters => "enters",
        }
    }
}
