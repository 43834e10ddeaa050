use super::axis::Scale;
use super::page::Ink;
use flip_rs::MAGMA;

/// A number everywhere in a panel, as a colour.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct HeatMap {
    /// What the number is, and its units.
    pub label: String,
    /// How numbers lie along the colours.
    pub scale: Scale,
    /// The numbers of the first and the last colour; beyond them colours stay. If not said, the least and the greatest.
    pub range: Option<[f64; 2]>,
    /// Along x, from where the first cell begins to where the last ends; cells are alike in the axis's own scale.
    pub x: [f64; 2],
    /// Along y.
    pub y: [f64; 2],
    /// How many cells there are along x.
    pub columns: usize,
    /// Row by row, from the least y up; NaN where there is no number, which is left white.
    pub values: Vec<f64>,
}

/// Where there is no number.
const NOTHING: Ink = [255; 3];

impl HeatMap {
    /// The numbers of the first and the last colour, in units of the scale.
    pub(super) fn ends(&self) -> [f64; 2] {
        let known = self.range.and_then(|[a, b]| Some([self.scale.of(a)?, self.scale.of(b)?]));
        known.unwrap_or_else(|| {
            let shown = self.values.iter().filter_map(|v| self.scale.of(*v));
            let [low, high] =
                shown.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(v), b.max(v)]);
            if low < high {
                [low, high]
            } else if low == high {
                [low - 0.5, low + 0.5]
            } else {
                [0.0, 1.0]
            }
        })
    }

    /// As for an axis beside the colours.
    pub(super) fn range_of_colors(&self) -> [f64; 2] {
        self.ends().map(|v| if self.scale == Scale::Log { 10f64.powf(v) } else { v })
    }

    /// The colours, row by row from the top.
    pub(super) fn colors(&self) -> Vec<Ink> {
        let [low, high] = self.ends();
        let color = |value: f64| match self.scale.of(value) {
            Some(v) => shade((v - low) / (high - low)),
            None if value.is_nan() => NOTHING,
            // What has no logarithm is less than all that has; what is infinite is more than all that is not.
            None => shade(if value > 0.0 { 1.0 } else { 0.0 }),
        };
        let rows = self.values.chunks_exact(self.columns.max(1)).rev();
        rows.flat_map(|row| row.iter().map(|v| color(*v))).collect()
    }
}

/// From nearly black at 0 through violet and orange to nearly white at 1 (the colour map Magma of S. van der Walt and
/// N. Smith, 2015).
pub(super) fn shade(at: f64) -> Ink {
    MAGMA[(255.0 * at.clamp(0.0, 1.0)) as usize].map(|v| (255.0 * v + 0.5) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_go_with_the_logarithm_and_rows_from_the_top() {
        let map = HeatMap {
            scale: Scale::Log,
            columns: 2,
            values: vec![1e-4, 1.0, f64::NAN, 0.0, 1e-2, f64::INFINITY],
            ..HeatMap::default()
        };
        assert_eq!(map.ends(), [-4.0, 0.0]);
        let [middle, infinite, nothing, zero, least, most] = map.colors()[..] else { panic!() };
        assert_eq!([infinite, most], [shade(1.0); 2]);
        assert_eq!([zero, least], [shade(0.0); 2]);
        assert_eq!((nothing, middle), (NOTHING, shade(0.5)));
    }
}
