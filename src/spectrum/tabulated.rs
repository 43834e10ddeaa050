use super::basis::Beyond;

/// Spectral radiance by wavelength, as measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Tabulated {
    /// What the file is called.
    pub name: String,
    /// Nanometres, increasing, and values, in any unit proportional to W/m²/sr/nm.
    points: Vec<[f64; 2]>,
}

/// Why a table is no spectrum.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TabulatedError {
    /// A line that is not two numbers.
    #[error("line {line}: '{text}' is not of the form nm,value")]
    Line {
        /// Counted from 1.
        line: usize,
        /// What stands there.
        text: String,
    },
    /// A wavelength or a value that cannot be.
    #[error(
        "line {line}: {nm},{value}: wavelengths must be above 0 and rise from line to line, values must not be negative"
    )]
    Value {
        /// Counted from 1.
        line: usize,
        /// The wavelength there.
        nm: f64,
        /// The value there.
        value: f64,
    },
    /// Less than two lines, or nothing but zeros.
    #[error("a spectrum needs at least two lines of the form nm,value, and one value above 0")]
    Empty,
}

impl Tabulated {
    /// From CSV: a wavelength in nanometres and a value a line; comments begin with #, and a first line of words is
    /// left out.
    ///
    /// # Errors
    /// On lines that are no numbers, wavelengths that do not rise, negative values, an empty table.
    pub fn parse(csv: &str, name: &str) -> Result<Self, TabulatedError> {
        let mut points: Vec<[f64; 2]> = Vec::new();
        let mut header = true;
        for (index, text) in csv.trim_start_matches('\u{feff}').lines().enumerate() {
            let (line, text) = (index + 1, text.trim());
            if text.is_empty() || text.starts_with('#') {
                continue;
            }
            let fields: Vec<Option<f64>> =
                text.split([',', ';', '\t']).map(|v| v.trim().parse().ok()).collect();
            let first = std::mem::take(&mut header);
            let [Some(nm), Some(value)] = fields[..] else {
                // Words, not damaged numbers.
                let words = text.starts_with(|c: char| c.is_alphabetic());
                if first && words && fields.iter().all(Option::is_none) {
                    continue;
                }
                return Err(TabulatedError::Line { line, text: text.chars().take(60).collect() });
            };
            let rises = points.last().is_none_or(|last| nm > last[0]);
            let possible = nm > 0.0 && nm < 1e12 && (0.0..1e30).contains(&value);
            if !rises || !possible {
                return Err(TabulatedError::Value { line, nm, value });
            }
            points.push([nm, value]);
        }
        let greatest = points.iter().map(|p| p[1]).fold(0.0, f64::max);
        if points.len() < 2 || greatest == 0.0 {
            return Err(TabulatedError::Empty);
        }
        // Only ratios count; others could leave the range of numbers.
        points.iter_mut().for_each(|p| p[1] /= greatest);
        Ok(Self { name: name.to_owned(), points })
    }

    /// The value at a wavelength, by straight lines; the greatest of the table is 1.
    pub fn at(&self, nm: f64, beyond: Beyond) -> f64 {
        let next = self.points.partition_point(|p| p[0] < nm);
        let edge = |value: f64| if beyond == Beyond::Edge { value } else { 0.0 };
        match (next.checked_sub(1).map(|i| self.points[i]), self.points.get(next)) {
            (Some([a, from]), Some([b, to])) => from + (to - from) * (nm - a) / (b - a),
            (None, Some([b, to])) => {
                if nm == *b {
                    *to
                } else {
                    edge(*to)
                }
            }
            (Some([_, last]), None) => edge(last),
            (None, None) => 0.0,
        }
    }

    /// The sum over all wavelengths of the table.
    pub fn integral(&self) -> f64 {
        self.points.windows(2).map(|p| 0.5 * (p[0][1] + p[1][1]) * (p[1][0] - p[0][0])).sum()
    }

    /// The wavelengths of the table between two others.
    pub(super) fn wavelengths(&self, from: f64, to: f64) -> impl Iterator<Item = f64> {
        let start = self.points.partition_point(|p| p[0] < from);
        self.points[start..].iter().map(|p| p[0]).take_while(move |nm| *nm <= to)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_read_and_faults_named() {
        let table = Tabulated::parse("nm,value\n# lamp\n400, 1\n500,4\n 600;0\n", "t").unwrap();
        assert_eq!(table.at(450.0, Beyond::Grey), 0.625);
        assert_eq!(table.at(400.0, Beyond::Grey), 0.25);
        assert_eq!(table.at(399.0, Beyond::Grey), 0.0);
        assert_eq!(table.at(399.0, Beyond::Edge), 0.25);
        assert_eq!(table.integral(), 112.5);
        let faint = Tabulated::parse("400,1e-302\n500,4e-302\n600,0\n", "t").unwrap();
        assert_eq!(faint.points, table.points);
        for (text, part) in [
            ("400,1\nabc,2\n", "line 2: 'abc,2'"),
            ("400,1\n300,2\n", "line 2"),
            ("400,1\n500,-2\n", "line 2"),
            ("400,1\n500,nan\n", "line 2"),
            ("400,1\n", "two lines"),
            ("400,0\n500,0\n", "above 0"),
            ("", "two lines"),
            ("400,1,2\n", "line 1"),
        ] {
            let message = Tabulated::parse(text, "t").unwrap_err().to_string();
            assert!(message.contains(part), "{text}: {message}");
        }
    }
}
