//! The text of a scene file: values out of it, and faults told by line and key.

use super::tables::Vector;
use crate::scene::velocity::Velocity;
use glam::DVec3;
use std::path::{Path, PathBuf};
use terrell_geodesic::{Celerity, Event};
use toml::Spanned;

/// Why a scene cannot be read: where, what, and what to try.
#[derive(Debug)]
pub struct SceneError {
    path: PathBuf,
    line: Option<usize>,
    message: String,
}

impl std::fmt::Display for SceneError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.path.display())?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        write!(f, ": {}", self.message)
    }
}

impl std::error::Error for SceneError {}

/// How fast and which way, in any of the ways a file may say it.
pub(super) struct VelocityKeys<'a> {
    pub velocity: &'a Option<Vector>,
    pub celerity: &'a Option<Vector>,
    pub beta: &'a Option<Spanned<f64>>,
    pub gamma: &'a Option<Spanned<f64>>,
    pub rapidity: &'a Option<Spanned<f64>>,
    pub direction: &'a Option<Vector>,
}

impl VelocityKeys<'_> {
    /// Where the value of a key stands.
    fn place(&self, key: &str) -> Option<usize> {
        let start = |v: &Spanned<f64>| v.span().start;
        let place = |v: &Vector| v.span().start;
        match key {
            "velocity" => self.velocity.as_ref().map(place),
            "celerity" => self.celerity.as_ref().map(place),
            "beta" => self.beta.as_ref().map(start),
            "gamma" => self.gamma.as_ref().map(start),
            "rapidity" => self.rapidity.as_ref().map(start),
            _ => self.direction.as_ref().map(place),
        }
    }
}

/// The velocity keys of a table: cameras and bodies have the same ones.
macro_rules! velocity_keys {
    ($table:expr) => {
        VelocityKeys {
            velocity: &$table.velocity,
            celerity: &$table.celerity,
            beta: &$table.beta,
            gamma: &$table.gamma,
            rapidity: &$table.rapidity,
            direction: &$table.direction,
        }
    };
}
pub(super) use velocity_keys;

pub(super) struct Source<'a> {
    pub text: &'a str,
    pub path: &'a Path,
}

impl Source<'_> {
    pub fn fault(&self, at: Option<usize>, message: impl Into<String>) -> SceneError {
        let line = at.map(|at| {
            1 + self.text.as_bytes()[..at.min(self.text.len())].iter().filter(|&&b| b == b'\n').count()
        });
        SceneError { path: self.path.to_owned(), line, message: message.into() }
    }

    pub fn line_at(&self, at: usize) -> &str {
        let at = at.min(self.text.len());
        let start = self.text.as_bytes()[..at].iter().rposition(|&b| b == b'\n').map_or(0, |i| i + 1);
        self.text.get(start..).and_then(|rest| rest.lines().next()).unwrap_or_default()
    }

    pub fn at<T>(&self, place: &Spanned<T>, message: impl std::fmt::Display) -> SceneError {
        self.fault(Some(place.span().start), message.to_string())
    }

    pub fn finite(&self, key: &str, value: &Spanned<f64>) -> Result<f64, SceneError> {
        let v = *value.get_ref();
        if v.is_finite() { Ok(v) } else { Err(self.at(value, format!("{key} = {v} is not finite"))) }
    }

    pub fn vector(&self, key: &str, value: &Vector) -> Result<DVec3, SceneError> {
        let v = DVec3::from_array(*value.get_ref());
        // What is larger has no digits left for a picture.
        if v.is_finite() && v.abs().max_element() < 1e100 {
            Ok(v)
        } else {
            Err(self.at(value, format!("{key} = [{}, {}, {}] is not finite or beyond 1e100", v.x, v.y, v.z)))
        }
    }

    pub fn event(
        &self,
        time: &Option<Spanned<f64>>,
        position: &Option<Vector>,
    ) -> Result<Event<terrell_geodesic::World>, SceneError> {
        let t = time.as_ref().map_or(Ok(0.0), |t| self.finite("time", t))?;
        let x = position.as_ref().map_or(Ok(DVec3::ZERO), |p| self.vector("position", p))?;
        Ok(Event::at(t, x))
    }

    pub fn celerity(&self, keys: &VelocityKeys<'_>) -> Result<Celerity, SceneError> {
        let vector = |v: &Vector| DVec3::from_array(*v.get_ref());
        let number = |v: &Spanned<f64>| *v.get_ref();
        let velocity = Velocity {
            velocity: keys.velocity.as_ref().map(vector),
            celerity: keys.celerity.as_ref().map(vector),
            beta: keys.beta.as_ref().map(number),
            gamma: keys.gamma.as_ref().map(number),
            rapidity: keys.rapidity.as_ref().map(number),
            direction: keys.direction.as_ref().map(|d| self.vector("direction", d)).transpose()?,
        };
        let told = velocity.told().map_err(|e| self.fault(keys.place(e.key), e.message))?;
        Ok(told.unwrap_or(Celerity::at_rest()))
    }
}

/// The nearest of the names, if near enough to be what was meant.
fn nearest<'a>(word: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // What is longer is no slip of the pen, and comparing it would take memory as the product of the lengths.
    const LONGEST: usize = 200;
    names
        .into_iter()
        .filter(|name| word.len().max(name.len()) <= LONGEST)
        .map(|name| (strsim::damerau_levenshtein(word, name), name))
        .min()
        .filter(|(distance, name)| *distance <= 1 + name.len() / 3)
        .map(|(_, name)| name)
}

/// A hint at the nearest of the names, or at all of them.
pub(crate) fn did_you_mean<'a>(word: &str, names: impl IntoIterator<Item = &'a str> + Clone) -> String {
    match nearest(word, names.clone()) {
        Some(name) => format!("did you mean '{name}'?"),
        None => match names.into_iter().collect::<Vec<_>>().join(", ") {
            none if none.is_empty() => "there is none".to_owned(),
            known => format!("known: {known}"),
        },
    }
}

/// The parser's own message in the words of the file: with the key of its line, and the nearest known one.
pub(super) fn explain(message: &str, line: &str) -> String {
    let message = message.lines().next().unwrap_or_default();
    let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    if let ("unknown field", Some((unknown, known))) =
        (message.get(..13).unwrap_or_default(), quoted.split_first())
    {
        return format!("unknown key '{unknown}'; {}", did_you_mean(unknown, known.iter().copied()));
    }
    if line.trim_start().starts_with('[') && message.starts_with("invalid type: map, expected a sequence") {
        return "bodies and lights are lists: write [[body]] and [[light]], with two brackets".to_owned();
    }
    let message = match message.split_once("untagged enum ") {
        Some((_, "Name")) => "needs a name in quotes or a number",
        Some((_, "Scale")) => "needs one number or three",
        Some((_, "Color")) => "needs [r, g, b] or \"#rrggbb\"",
        _ => message,
    };
    match line.split_once('=') {
        Some((key, _)) => format!("{}: {message}", key.trim()),
        None => message.to_owned(),
    }
}
