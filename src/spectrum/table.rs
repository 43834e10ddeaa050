use super::cubic::cubic;
use super::response::Matrix;
use glam::Vec4;
use rayon::prelude::*;

/// A matrix of colours by the logarithm of the Doppler factor: columns for red, green, blue, nine numbers.
///
/// Nodes are evenly spaced, D = 1 among them, and values between them are those of the cubic through the four nearest. How
/// many there are is decided by the error itself: they are doubled until, in the middle between any two, nothing is
/// off by more than [`ERROR`](Self::ERROR) of the greatest number there, or of a thousandth of the greatest within an
/// octave, as where a line goes out of sight, or of 10⁻²⁰ of white. There are at most 8192 on either side of D = 1;
/// [`error`](Self::error) says what was reached.
#[derive(Clone, Debug)]
pub struct DopplerTable {
    /// ln D of the second node; the first and the last are there for the cubic.
    start: f64,
    inverse_step: f64,
    nodes: Vec<Node>,
    error: f64,
}

/// Four nodes of a table times one colour, as the cubic through them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Near {
    /// The number of the first.
    low: usize,
    /// Of the powers of how many steps beyond the second.
    powers: [Vec4; 4],
}

impl Default for Near {
    /// None.
    fn default() -> Self {
        Self { low: usize::MAX, powers: [Vec4::ZERO; 4] }
    }
}

impl Near {
    #[inline(never)]
    fn new(low: usize, nodes: &[Node], own: [f32; 3]) -> Self {
        let color = |i: usize| {
            let [r, g, b] = nodes[i].map(Vec4::from_array);
            // So that differences do not leave f32.
            (r * own[0] + g * own[1] + b * own[2]).clamp(Vec4::splat(-1e36), Vec4::splat(1e36))
        };
        let [a, b, c, d] = [color(0), color(1), color(2), color(3)];
        const SIXTH: f32 = 1.0 / 6.0;
        let second = 0.5 * (a + c) - b;
        let third = SIXTH * (d - a) + 0.5 * (b - c);
        Self { low, powers: [b, c - b - second - third, second, third] }
    }

    #[inline]
    fn at(&self, t: f32) -> Vec4 {
        let [one, first, second, third] = self.powers;
        one + t * (first + t * (second + t * third))
    }
}

/// Rows of a table times one colour, as [`Near`] keeps each.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NearRows {
    /// The number of the first.
    low: usize,
    rows: [Near; 4],
}

impl Default for NearRows {
    /// None.
    fn default() -> Self {
        Self { low: usize::MAX, rows: [Near::default(); 4] }
    }
}

/// How far |ln D| goes in any table: γ of a billion.
const FARTHEST: f64 = 22.0;

/// The most nodes on either side of D = 1.
const MOST: usize = 8192;

/// Steps per unit of ln D that are tried first.
const FIRST: f64 = 16.0;

/// What is less, of the greatest within an octave, need not be exact.
const VANISHING: f64 = 1e-3;

/// What is less need not be exact, either: no exposure shows it.
const DARK: f64 = 1e-20;

/// Brighter light is as bright: colours are kept, and can be averaged.
const BRIGHTEST: f64 = 1e35;

/// Spacing of nodes.
#[derive(Clone, Copy, Debug)]
struct Grid {
    step: f64,
    /// On either side of ln D = 0.
    side: usize,
}

impl Grid {
    /// Every ln D, with one more beyond each end.
    fn places(self) -> impl IndexedParallelIterator<Item = f64> {
        (0..2 * self.side + 3).into_par_iter().map(move |i| (i as f64 - (self.side + 1) as f64) * self.step)
    }

    /// Nodes within an octave.
    fn octave(self) -> usize {
        (std::f64::consts::LN_2 / self.step) as usize
    }
}

/// Weights of the four nodes around a place between the second and the third.
#[inline]
fn weights(t: f64) -> [f32; 4] {
    cubic(t).map(|w| w as f32)
}

fn flat(matrix: &Matrix) -> [f64; 9] {
    let [r, g, b] = matrix;
    let all = [r[0], r[1], r[2], g[0], g[1], g[2], b[0], b[1], b[2]];
    let most = greatest(&all);
    if most > BRIGHTEST { all.map(|v| v * (BRIGHTEST / most)) } else { all }
}

/// Columns, with room for four numbers each.
type Node = [[f32; 4]; 3];

fn node(values: &[f64; 9]) -> Node {
    std::array::from_fn(|i| std::array::from_fn(|k| if k < 3 { values[3 * i + k] as f32 } else { 0.0 }))
}

fn greatest(values: &[f64; 9]) -> f64 {
    values.iter().fold(0.0, |a, v| a.max(v.abs()))
}

/// The greatest difference, of what has to be exact; `near` are the greatest numbers around.
fn off(got: &[f64; 9], exact: &[f64; 9], near: &[f64]) -> f64 {
    let off = (0..9).map(|k| (got[k] - exact[k]).abs()).fold(0.0, f64::max);
    let near = near.iter().copied().fold(0.0, f64::max);
    off / greatest(exact).max(VANISHING * near).max(DARK)
}

fn around(i: usize, reach: usize, all: &[f64]) -> &[f64] {
    &all[i.saturating_sub(reach)..(i + reach).min(all.len())]
}

impl DopplerTable {
    /// The greatest error between nodes that is accepted, of the greatest number there.
    pub const ERROR: f64 = 1e-4;

    /// A table of `exact` for |ln D| up to `range`.
    pub fn new(range: f64, exact: impl Fn(f64) -> Matrix + Sync) -> Self {
        Self::within(range, MOST, Self::ERROR, exact)
    }

    /// As [`new`](Self::new), with at most so many nodes on either side of D = 1, and an error of its own.
    fn within(range: f64, most_nodes: usize, accepted: f64, exact: impl Fn(f64) -> Matrix + Sync) -> Self {
        let exact = |x: f64| flat(&exact(x.exp()));
        if range.is_nan() || range < 1e-15 {
            return Self { start: 0.0, inverse_step: 0.0, nodes: vec![node(&exact(0.0)); 4], error: 0.0 };
        }
        let range = range.min(FARTHEST);
        let side = ((range * FIRST).ceil() as usize).max(2);
        let mut grid = Grid { step: range / side as f64, side };
        let mut nodes: Vec<[f64; 9]> = grid.places().map(exact).collect();
        loop {
            let middle = |i: usize| exact((i as f64 - grid.side as f64 + 0.5) * grid.step);
            let middles: Vec<[f64; 9]> = (0..2 * grid.side).into_par_iter().map(middle).collect();
            let sizes: Vec<f64> = nodes.iter().map(greatest).collect();
            let w = cubic(0.5);
            let error = middles.iter().enumerate().map(|(i, exact)| {
                let between = std::array::from_fn(|k| (0..4).map(|j| w[j] * nodes[i + j][k]).sum());
                off(&between, exact, around(i, grid.octave(), &sizes))
            });
            let error = error.fold(0.0, f64::max);
            if error <= accepted || 2 * grid.side > most_nodes {
                return Self::of_nodes(grid, &nodes, error);
            }
            // All there were, those between them, and one beyond each end.
            let finer = Grid { step: 0.5 * grid.step, side: 2 * grid.side };
            let beyond = (finer.side + 1) as f64 * finer.step;
            let mut all = vec![exact(-beyond)];
            for (i, node) in nodes[1..nodes.len() - 1].iter().enumerate() {
                all.push(*node);
                all.extend(middles.get(i));
            }
            all.push(exact(beyond));
            (grid, nodes) = (finer, all);
        }
    }

    fn of_nodes(grid: Grid, nodes: &[[f64; 9]], error: f64) -> Self {
        let nodes = nodes.iter().map(node).collect();
        Self { start: -(grid.side as f64) * grid.step, inverse_step: 1.0 / grid.step, nodes, error }
    }

    fn grid(&self) -> Grid {
        Grid { step: 1.0 / self.inverse_step, side: (self.nodes.len() - 3) / 2 }
    }

    /// A table with nodes at the same places; its error is not looked at.
    fn alike(&self, exact: impl Fn(f64) -> Matrix + Sync) -> Self {
        if self.inverse_step == 0.0 {
            return Self::new(0.0, exact);
        }
        let nodes: Vec<[f64; 9]> = self.grid().places().map(|x| flat(&exact(x.exp()))).collect();
        Self::of_nodes(self.grid(), &nodes, self.error)
    }

    /// How many steps beyond the second of four nodes, and the number of the first. Beyond its ends a table stays as it is
    /// there.
    #[inline]
    fn place(&self, ln_doppler: f64) -> (f64, usize) {
        // There are not many, and small integers are the quicker ones.
        let last = self.nodes.len() as i32 - 3;
        let place = (ln_doppler - self.start) * self.inverse_step;
        // NaN becomes the first.
        let within = place.max(0.0).min(f64::from(last));
        let low = (within as i32).min(last - 1);
        (within - f64::from(low), low as usize)
    }

    /// The nine numbers at ln D: columns for red, green and blue.
    pub fn at(&self, ln_doppler: f64) -> [f32; 9] {
        let (t, low) = self.place(ln_doppler);
        let w = weights(t);
        let nodes = &self.nodes[low..low + 4];
        std::array::from_fn(|k| nodes.iter().zip(w).map(|(node, w)| w * node[k / 3][k % 3]).sum())
    }

    /// The colour seen at ln D of a surface of the colour `own`.
    #[inline]
    pub fn color(&self, ln_doppler: f64, own: [f32; 3]) -> [f32; 3] {
        self.color_near(ln_doppler, own, &mut Near::default())
    }

    /// The same, of a surface of one colour asked over and over: what is `near` is kept for the next time.
    #[inline]
    pub(crate) fn color_near(&self, ln_doppler: f64, own: [f32; 3], near: &mut Near) -> [f32; 3] {
        self.vector_near(ln_doppler, own, near).truncate().to_array()
    }

    #[inline]
    fn vector_near(&self, ln_doppler: f64, own: [f32; 3], near: &mut Near) -> Vec4 {
        let (t, low) = self.place(ln_doppler);
        if near.low != low {
            *near = Near::new(low, &self.nodes[low..low + 4], own);
        }
        near.at(t as f32)
    }

    /// ln D of the second node, nodes a unit of ln D, and three columns a node.
    #[cfg(feature = "gpu")]
    pub(crate) fn columns(&self) -> (f64, f64, &[[f32; 4]]) {
        (self.start, self.inverse_step, self.nodes.as_flattened())
    }

    /// How many nodes there are.
    pub fn nodes(&self) -> usize {
        self.nodes.len()
    }

    /// The greatest error between nodes, of the greatest number there.
    pub fn error(&self) -> f64 {
        self.error
    }
}

/// Doppler tables by a second quantity.
#[derive(Clone, Debug)]
pub struct RowTable {
    start: f64,
    inverse_step: f64,
    rows: Vec<DopplerTable>,
    between: Between,
    error: f64,
}

/// What lies between rows.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Between {
    /// Nothing: there is one.
    One,
    /// By the shift of the lamp: a cubic through four, one row beyond each end. Columns are by both shifts together: what
    /// is seen of a spectrum stands still in them, and all that changes from row to row is what the surface reflects.
    Lamps,
    /// Straight lines: nothing becomes negative.
    Lines,
}

/// The most nodes on either side of D = 1 in tables of which there are many.
const MOST_IN_ROWS: usize = 1024;

/// The most rows by lamps there are.
const MOST_ROWS: f64 = 256.0;

/// Light shifted farther to the red than this, by ln D, does not decide how fine tables are.
const DARKEST: f64 = -2.5;

impl RowTable {
    /// The error between nodes that is accepted in tables of which there are many.
    pub const ERROR: f64 = 1e-3;

    /// One row, whatever the second quantity.
    pub fn single(row: DopplerTable) -> Self {
        let error = row.error;
        Self { start: 0.0, inverse_step: 0.0, rows: vec![row], between: Between::One, error }
    }

    /// For light that reaches surfaces with |ln D| up to `lamp_range`, and is seen with |ln D| up to `range`; `exact` by
    /// the two Doppler factors, `rows` are for every e-fold of the lamp's.
    pub fn by_lamp(
        lamp_range: f64,
        range: f64,
        rows: f64,
        exact: impl Fn(f64, f64) -> Matrix + Sync,
    ) -> Self {
        let lamp_range = lamp_range.min(FARTHEST);
        if lamp_range < 1e-12 {
            return Self::single(DopplerTable::new(range, |d| exact(1.0, d)));
        }
        let by_both = |lamp: f64, both: f64| exact(lamp.exp(), both / lamp.exp());
        let model = DopplerTable::within(range + lamp_range, MOST_IN_ROWS, Self::ERROR, |d| by_both(0.0, d));
        let count = (2.0 * lamp_range * rows).ceil().clamp(4.0, MOST_ROWS) as usize;
        let step = 2.0 * lamp_range / (count - 1) as f64;
        let place = |i: f64| -lamp_range + (i - 1.0) * step;
        let row = |i: usize| model.alike(|both| by_both(place(i as f64), both));
        let rows = (0..count + 2).into_par_iter().map(row).collect();
        let mut out =
            Self { start: -lamp_range, inverse_step: 1.0 / step, rows, between: Between::Lamps, error: 0.0 };
        // In the middle between some of the rows.
        let sampled = (1..count).step_by(count.div_ceil(12));
        let error = sampled.map(|i| {
            let lamp = place(i as f64 + 0.5);
            let grid = model.grid();
            let exact: Vec<(f64, [f64; 9])> =
                grid.places().map(|x| (x, flat(&by_both(lamp, x.exp())))).collect();
            let sizes: Vec<f64> = exact.iter().map(|(_, v)| greatest(v)).collect();
            let seen = exact.iter().enumerate().map(|(k, (x, exact))| {
                off(&out.at(lamp, x - lamp).map(f64::from), exact, around(k, grid.octave(), &sizes))
            });
            seen.fold(0.0, f64::max)
        });
        out.error = error.fold(model.error, f64::max);
        out
    }

    /// For what `count` rows with evenly spaced places from −1 to 1 say: `rows` gives all of them at a Doppler factor. How
    /// fine it is in D is decided by `model`, for light that comes with no less than the given ln D.
    pub fn by_angle(
        count: usize,
        range: f64,
        reddest: f64,
        model: impl Fn(f64, f64) -> Matrix + Sync,
        rows: impl Fn(f64) -> Vec<[f64; 9]> + Sync,
    ) -> Self {
        let lamp = reddest.max(DARKEST).exp();
        let model = DopplerTable::within(range, MOST_IN_ROWS, Self::ERROR, |d| model(lamp, d));
        let places: Vec<f64> = match model.inverse_step {
            0.0 => vec![0.0; 4],
            _ => model.grid().places().collect(),
        };
        let all: Vec<Vec<[f64; 9]>> = places.into_par_iter().map(&rows).collect();
        let row = |i: usize| DopplerTable {
            nodes: all.iter().map(|rows| node(&rows[i])).collect(),
            ..model.clone()
        };
        // A straight line is off by an eighth of the second difference.
        let bent = |rows: &Vec<[f64; 9]>| {
            let most = rows.iter().map(greatest).fold(DARK, f64::max);
            let second = |w: &[[f64; 9]]| {
                (0..9).map(|k| (w[0][k] - 2.0 * w[1][k] + w[2][k]).abs()).fold(0.0, f64::max) / 8.0
            };
            rows.windows(3).map(second).fold(0.0, f64::max) / most
        };
        let error = all.iter().map(bent).fold(model.error, f64::max);
        let inverse_step = 0.5 * (count - 1) as f64;
        let rows = (0..count).map(row).collect();
        Self { start: -1.0, inverse_step, rows, between: Between::Lines, error }
    }

    /// Rows around a place with their weights, the number of the first, and where to look in them.
    #[inline(always)]
    fn place(&self, place: f64, ln_doppler: f64) -> ([f32; 4], usize, &[DopplerTable], f64) {
        // NaN becomes the first.
        let place = |last: usize| ((place - self.start) * self.inverse_step).max(0.0).min(last as f64);
        match self.between {
            Between::One => ([1.0, 0.0, 0.0, 0.0], 0, &self.rows, ln_doppler),
            Between::Lamps => {
                let within = place(self.rows.len() - 3);
                let low = (within as usize).min(self.rows.len() - 4);
                let lamp = self.start + within / self.inverse_step;
                (weights(within - low as f64), low, &self.rows[low..low + 4], ln_doppler + lamp)
            }
            Between::Lines => {
                let within = place(self.rows.len() - 1);
                let low = (within as usize).min(self.rows.len() - 2);
                let t = (within - low as f64) as f32;
                ([1.0 - t, t, 0.0, 0.0], low, &self.rows[low..low + 2], ln_doppler)
            }
        }
    }

    /// The nine numbers at a place and ln D.
    pub fn at(&self, place: f64, ln_doppler: f64) -> [f32; 9] {
        let (weights, _, rows, column) = self.place(place, ln_doppler);
        let mut sum = [0.0; 9];
        for (row, w) in rows.iter().zip(weights) {
            let values = row.at(column);
            sum = std::array::from_fn(|k| sum[k] + w * values[k]);
        }
        sum
    }

    /// The colour seen at ln D of a surface of the colour `own`, at a place between the rows.
    #[inline]
    pub fn color(&self, place: f64, ln_doppler: f64, own: [f32; 3]) -> [f32; 3] {
        self.color_near(place, ln_doppler, own, &mut NearRows::default()).truncate().to_array()
    }

    /// The same and a number more, of a surface of one colour asked over and over: what is `near` is kept for the next time.
    #[inline]
    pub(crate) fn color_near(&self, place: f64, ln_doppler: f64, own: [f32; 3], near: &mut NearRows) -> Vec4 {
        match self.between {
            Between::One => self.rows[0].vector_near(ln_doppler, own, &mut near.rows[0]),
            _ => self.color_between(place, ln_doppler, own, near),
        }
    }

    fn color_between(&self, place: f64, ln_doppler: f64, own: [f32; 3], near: &mut NearRows) -> Vec4 {
        let (weights, low, rows, column) = self.place(place, ln_doppler);
        if near.low != low {
            *near = NearRows { low, ..NearRows::default() };
        }
        let mut sum = Vec4::ZERO;
        for ((row, w), near) in rows.iter().zip(weights).zip(&mut near.rows) {
            sum += w * row.vector_near(column, own, near);
        }
        sum
    }

    /// How many nodes all rows have.
    pub fn nodes(&self) -> usize {
        self.rows.iter().map(DopplerTable::nodes).sum()
    }

    /// The greatest error found between nodes and between rows, of the greatest number there.
    pub fn error(&self) -> f64 {
        self.error
    }
}
