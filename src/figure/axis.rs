use crate::drawing::number::{fixed, significant, superscript};

/// How numbers lie along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Scale {
    /// Evenly.
    #[default]
    Linear,
    /// By their logarithms.
    Log,
}

/// One side of a panel.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Axis {
    /// What is measured, and in which units.
    pub label: String,
    /// How numbers lie along it.
    pub scale: Scale,
    /// From where to where it goes; if not said, around what is shown.
    pub range: Option<[f64; 2]>,
    /// On a logarithmic axis: what is written where numbers that are 0 are drawn, apart from all others. If not said they
    /// are left out.
    pub zero: Option<String>,
    /// Where marks are, and what is written there, if anything is; if there are none, they are at round numbers.
    pub marks: Vec<(f64, Option<String>)>,
}

impl Axis {
    /// An even one.
    pub fn linear(label: impl Into<String>) -> Self {
        Self { label: label.into(), ..Self::default() }
    }

    /// A logarithmic one.
    pub fn log(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Log, ..Self::default() }
    }

    /// With these ends.
    pub fn from_to(self, from: f64, to: f64) -> Self {
        Self { range: Some([from, to]), ..self }
    }

    /// With marks at these places.
    pub fn with_marks(self, marks: impl IntoIterator<Item = (f64, Option<String>)>) -> Self {
        Self { marks: marks.into_iter().collect(), ..self }
    }

    /// With a place for numbers that are 0.
    pub fn with_zero(self, text: impl Into<String>) -> Self {
        Self { zero: Some(text.into()), ..self }
    }
}

impl Scale {
    /// Where a number is; none if it is nowhere.
    pub(super) fn of(self, value: f64) -> Option<f64> {
        match self {
            Self::Linear => value.is_finite().then_some(value),
            Self::Log => (value > 0.0 && value.is_finite()).then(|| value.log10()),
        }
    }
}

/// An axis along pixels.
#[derive(Clone, Debug)]
pub(super) struct Ruler {
    scale: Scale,
    /// In units of the scale.
    ends: [f64; 2],
    /// Pixels.
    pixels: [f64; 2],
    /// Pixel where 0 is, on a logarithmic axis, and what is written there.
    pub zero: Option<(f64, String)>,
    /// Those that were asked for.
    marks: Vec<(f64, Option<String>)>,
}

/// A mark on an axis.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    pub at: f64,
    /// None between those that matter.
    pub text: Option<String>,
}

/// What is left for zeros beside the rest of a logarithmic axis, pixels.
const ZERO_BAND: f64 = 30.0;

impl Ruler {
    /// For an axis on which these numbers are shown, from one pixel to another.
    pub fn new(axis: &Axis, values: impl Iterator<Item = f64> + Clone, [from, to]: [f64; 2]) -> Self {
        let known = axis.range.and_then(|[a, b]| Some([axis.scale.of(a)?, axis.scale.of(b)?]));
        let ends = known.unwrap_or_else(|| {
            let shown = values.clone().filter_map(|v| axis.scale.of(v));
            let [low, high] =
                shown.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(v), b.max(v)]);
            match (axis.scale, low <= high) {
                (_, false) => [0.0, 1.0],
                (Scale::Log, true) => {
                    let room = (0.06 * (high - low)).max(0.12);
                    [low - room, high + room]
                }
                (Scale::Linear, true) if low == high => {
                    let room = if low == 0.0 { 1.0 } else { 0.5 * low.abs() };
                    [low - room, high + room]
                }
                (Scale::Linear, true) => [low - 0.05 * (high - low), high + 0.05 * (high - low)],
            }
        });
        let has_zeros = axis.scale == Scale::Log && values.clone().any(|v| v == 0.0);
        let zero = axis.zero.clone().filter(|_| has_zeros);
        let toward = (to - from).signum();
        let pixels = [if zero.is_some() { from + ZERO_BAND * toward } else { from }, to];
        Self {
            scale: axis.scale,
            ends,
            pixels,
            zero: zero.map(|text| (from + 0.4 * ZERO_BAND * toward, text)),
            marks: axis.marks.clone(),
        }
    }

    /// The pixel of a number; none if the axis has no place for it. It may lie beyond the ends.
    pub fn at(&self, value: f64) -> Option<f64> {
        match &self.zero {
            Some((at, _)) if value == 0.0 => Some(*at),
            _ => self.scale.of(value).map(|v| self.pixel(v)),
        }
    }

    fn pixel(&self, v: f64) -> f64 {
        let [a, b] = self.ends;
        self.pixels[0] + (v - a) / (b - a) * (self.pixels[1] - self.pixels[0])
    }

    /// Where the axis begins, apart from zeros.
    pub fn start(&self) -> f64 {
        self.pixels[0]
    }

    /// The marks, in order.
    pub fn ticks(&self) -> Vec<Tick> {
        if !self.marks.is_empty() {
            let tick = |(value, text): &(f64, Option<String>)| {
                Some(Tick { at: self.at(*value)?, text: text.clone() })
            };
            return self.marks.iter().filter_map(tick).collect();
        }
        match self.scale {
            Scale::Linear => self.even_ticks(),
            Scale::Log => self.log_ticks(),
        }
    }

    fn even_ticks(&self) -> Vec<Tick> {
        let [low, high] = [self.ends[0].min(self.ends[1]), self.ends[0].max(self.ends[1])];
        let count = ((self.pixels[1] - self.pixels[0]).abs() / 70.0).clamp(2.0, 8.0);
        let rough = (high - low) / count;
        let power = 10f64.powf(rough.log10().floor());
        let step =
            [1.0, 2.0, 5.0, 10.0].map(|m| m * power).into_iter().find(|s| *s >= rough).unwrap_or(rough);
        let decimals = (-(1.001 * step).log10().floor()).clamp(0.0, 12.0) as usize;
        let [first, last] = [(low / step - 1e-9).ceil(), (high / step + 1e-9).floor()];
        let text = |v: f64| {
            let plain = v == 0.0 || (1e-4..1e6).contains(&high.abs().max(low.abs()));
            if plain { fixed(v, decimals) } else { significant(v, 4) }
        };
        // Ends so large that steps vanish beside them have no marks but themselves.
        let steps = (last - first).clamp(0.0, 20.0) as u32;
        let values = (0..=steps).map(|i| (first + f64::from(i)) * step);
        values.map(|v| Tick { at: self.pixel(v), text: Some(text(v)) }).collect()
    }

    fn log_ticks(&self) -> Vec<Tick> {
        let [low, high] = [self.ends[0].min(self.ends[1]), self.ends[0].max(self.ends[1])];
        let decades = high - low;
        let room = (self.pixels[1] - self.pixels[0]).abs() / decades;
        // Decades between written ones, where they are narrow; what is written within them, where they are wide.
        let every =
            [1, 2, 3, 5, 10, 20, 50].into_iter().find(|n| f64::from(*n) * room >= 34.0).unwrap_or(100);
        let written: &[i32] = match decades {
            d if d < 0.7 => &[2, 3, 4, 5, 6, 7, 8, 9],
            d if d < 2.2 => &[2, 5],
            _ => &[],
        };
        let mut ticks = Vec::new();
        for decade in low.floor() as i32..=high.ceil() as i32 {
            for digit in 1..=9 {
                let place = f64::from(decade) + f64::from(digit).log10();
                let fine = digit > 1 && room < 20.0;
                if fine || !(low - 1e-9..=high + 1e-9).contains(&place) {
                    continue;
                }
                let text = if digit == 1 && decade.rem_euclid(every) == 0 {
                    Some(if written.is_empty() {
                        power_of_ten(decade)
                    } else {
                        significant(10f64.powi(decade), 1)
                    })
                } else {
                    written.contains(&digit).then(|| significant(f64::from(digit) * 10f64.powi(decade), 1))
                };
                ticks.push(Tick { at: self.pixel(place), text });
            }
        }
        ticks
    }
}

/// 10 to a power, as people write it.
pub fn power_of_ten(exponent: i32) -> String {
    match exponent {
        0 => "1".to_owned(),
        1 => "10".to_owned(),
        _ => format!("10{}", superscript(exponent)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(axis: &Axis, values: &[f64]) -> Vec<String> {
        let ruler = Ruler::new(axis, values.iter().copied(), [400.0, 0.0]);
        ruler.ticks().into_iter().filter_map(|t| t.text).collect()
    }

    #[test]
    fn powers_of_ten_are_raised() {
        assert_eq!(
            written(&Axis::log("").from_to(1e-3, 1e2), &[]),
            ["10⁻³", "10⁻²", "10⁻¹", "1", "10", "10²"]
        );
        // Sixteen decades in 400 pixels: every second.
        assert_eq!(written(&Axis::log("").from_to(1e-16, 1.0), &[]).len(), 9);
        assert_eq!(written(&Axis::log(""), &[15.0, 70.0]), ["20", "50"]);
    }

    #[test]
    fn even_steps_are_of_one_two_or_five() {
        assert_eq!(
            written(&Axis::linear("").from_to(0.0, 1.0), &[]),
            ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]
        );
        assert_eq!(written(&Axis::linear("").from_to(-90.0, 90.0), &[]), ["−50", "0", "50"]);
    }

    #[test]
    fn marks_are_where_they_are_asked_for() {
        let axis = Axis::linear("").from_to(0.0, 2.0).with_marks([(0.5, Some("here".into())), (1.5, None)]);
        let ticks = Ruler::new(&axis, std::iter::empty(), [0.0, 200.0]).ticks();
        assert_eq!(ticks, [Tick { at: 50.0, text: Some("here".into()) }, Tick { at: 150.0, text: None }]);
    }

    #[test]
    fn zeros_have_a_place_below_all_others() {
        let axis = Axis::log("").with_zero("0");
        let ruler = Ruler::new(&axis, [0.0, 0.1, 10.0].into_iter(), [400.0, 0.0]);
        let at = [0.0, 0.1, 10.0].map(|v| ruler.at(v).unwrap());
        assert!(at[0] > ruler.start() && ruler.start() > at[1] && at[1] > at[2] && at[2] > 0.0, "{at:?}");
        assert_eq!([ruler.at(-1.0), ruler.at(f64::NAN), ruler.at(f64::INFINITY)], [None; 3]);
        let without = Ruler::new(&Axis::log(""), [0.0, 0.1].into_iter(), [400.0, 0.0]);
        assert_eq!(without.at(0.0), None);
    }
}
