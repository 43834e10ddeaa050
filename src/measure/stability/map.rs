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

/// A number as short as it can be: "1e-9", "0.25", "3200".
fn number(value: f64) -> String {
    let size = value.abs();
    if size != 0.0 && !(1e-3..1e5).contains(&size) {
        format!("{value:.1e}").replace(".0e", "e")
    } else {
        format!("{value}")
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
                "{} {}, {} {}: {:e}",
                self.x.name,
                self.x.label(column),
                self.y.name,
                self.y.label(row),
                self.errors[cell]
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
