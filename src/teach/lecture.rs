use super::plate::Plate;
use crate::drawing::number;

/// What a lesson has to say, its numbers worked out.
///
/// Texts are paragraphs with `*emphasis*` and `` `code` ``.
#[derive(Debug, Default)]
pub struct Lecture {
    /// In this order.
    pub parts: Vec<Part>,
    /// Every number that is told, by name.
    pub numbers: Vec<Number>,
    /// What to try next.
    pub tries: Vec<Try>,
    /// What to ask oneself.
    pub question: Question,
}

/// A piece of a lecture.
#[derive(Debug)]
pub enum Part {
    /// Above what follows.
    Heading(String),
    /// A paragraph.
    Text(String),
    /// On a line of its own.
    Formula(String),
    /// Numbers side by side.
    Table(Table),
    /// What there is to see, side by side.
    Plates(Vec<Plate>),
}

/// A number worked out.
#[derive(Clone, Debug, PartialEq)]
pub struct Number {
    /// What it is.
    pub name: String,
    /// In the units that the name says, if any.
    pub value: f64,
}

/// Cells in rows beneath heads.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Table {
    /// Of columns.
    pub head: Vec<String>,
    /// As long as the head, each.
    pub rows: Vec<Vec<String>>,
}

/// A command to try.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Try {
    /// As it is typed.
    pub command: String,
    /// What it shows.
    pub shows: String,
}

/// A question whose answer is computed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Question {
    /// What is asked.
    pub text: String,
    /// What is right, and why.
    pub answer: String,
}

impl Lecture {
    /// Adds a heading.
    pub(super) fn heading(&mut self, text: &str) {
        self.parts.push(Part::Heading(text.to_owned()));
    }

    /// Adds a paragraph.
    pub(super) fn text(&mut self, text: impl Into<String>) {
        self.parts.push(Part::Text(text.into()));
    }

    /// Adds a formula.
    pub(super) fn formula(&mut self, text: &str) {
        self.parts.push(Part::Formula(text.to_owned()));
    }

    /// Adds a table.
    pub(super) fn table<const N: usize>(
        &mut self,
        head: [&str; N],
        rows: impl IntoIterator<Item = [String; N]>,
    ) {
        let rows = rows.into_iter().map(Vec::from).collect();
        self.parts.push(Part::Table(Table { head: head.map(str::to_owned).into(), rows }));
    }

    /// Adds what there is to see.
    pub(super) fn plates(&mut self, plates: impl Into<Vec<Plate>>) {
        self.parts.push(Part::Plates(plates.into()));
    }

    /// Keeps a number that is told; as text with so many decimals.
    pub(super) fn fixed(&mut self, name: impl Into<String>, value: f64, decimals: usize) -> String {
        self.numbers.push(Number { name: name.into(), value });
        number::fixed(value, decimals)
    }

    /// Keeps a number that is told; as text with so many digits.
    pub(super) fn digits(&mut self, name: impl Into<String>, value: f64, digits: usize) -> String {
        self.numbers.push(Number { name: name.into(), value });
        number::significant(value, digits)
    }

    /// Adds a command to try.
    pub(super) fn attempt(&mut self, command: &str, shows: &str) {
        self.tries.push(Try { command: command.to_owned(), shows: shows.to_owned() });
    }

    /// Asks.
    pub(super) fn ask(&mut self, text: impl Into<String>, answer: impl Into<String>) {
        self.question = Question { text: text.into(), answer: answer.into() };
    }

    /// A number that is told.
    pub fn number(&self, name: &str) -> Option<f64> {
        self.numbers.iter().find(|number| number.name == name).map(|number| number.value)
    }

    /// What there is to see, all of it.
    pub fn all_plates(&self) -> impl Iterator<Item = &Plate> {
        self.parts.iter().flat_map(|part| match part {
            Part::Plates(plates) => plates.as_slice(),
            _ => &[],
        })
    }
}
