use super::cubic::cubic;
use super::response::Matrix;
use rayon::prelude::*;

/// A matrix of colours by the logarithm of the Doppler factor: columns for red, green, blue, nine numbers.
///
/// Nodes are evenly spaced, D = 1 among them, and values between them are those of the cubic through the four nearest. How
/// many there are is decided by the error itself: they are doubled until, in the middle between any two, nothing is
/// off by more than [`ERROR`](Self::ERROR) of the greatest number there (or of a thousandth of the greatest within an
/// octave, as where a line goes out of sight).
#[derive(Clone, Debug)]
pub struct DopplerTable {
    /// ln D of the second node; the first and the last are there for the cubic.
    start: f64,
    inverse_step: f64,
    nodes: Vec<Node>,
    /// Powers of D with which it goes on below and above.
    ends: [f64; 2],
    error: f64,
}

/// How far |ln D| goes in a table; beyond, spectra are the powers they tend to.
const FARTHEST: f64 = 8.0;

/// The most nodes on either side of D = 1.
const MOST: usize = 4096;

/// Steps per unit of ln D that are tried first.
const FIRST: f64 = 16.0;

/// What is less, of the greatest within an octave, need not be exact.
const VANISHING: f64 = 1e-3;

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
}

/// Weights of the four nodes around a place between the second and the third.
#[inline]
fn weights(t: f64) -> [f32; 4] {
    cubic(t).map(|w| w as f32)
}

fn flat(matrix: &Matrix) -> [f64; 9] {
    let [r, g, b] = matrix;
    [r[0], r[1], r[2], g[0], g[1], g[2], b[0], b[1], b[2]]
}

/// Columns, with room for four numbers each.
type Node = [[f32; 4]; 3];

fn node(values: &[f64; 9]) -> Node {
    std::array::from_fn(|i| std::array::from_fn(|k| if k < 3 { values[3 * i + k] as f32 } else { 0.0 }))
}

fn greatest(values: &[f64; 9]) -> f64 {
    values.iter().fold(0.0, |a, v| a.max(v.abs()))
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
            let node = node(&exact(0.0));
            return Self { start: 0.0, inverse_step: 0.0, nodes: vec![node; 4], ends: [0.0; 2], error: 0.0 };
        }
        let range = range.min(FARTHEST);
        let side = ((range * FIRST).ceil() as usize).max(2);
        let mut grid = Grid { step: range / side as f64, side };
        let mut nodes: Vec<[f64; 9]> = grid.places().map(exact).collect();
        loop {
            let middle = |i: usize| exact((i as f64 - grid.side as f64 + 0.5) * grid.step);
            let middles: Vec<[f64; 9]> = (0..2 * grid.side).into_par_iter().map(middle).collect();
            let sizes: Vec<f64> = nodes.iter().map(greatest).collect();
            let octave = (std::f64::consts::LN_2 / grid.step) as usize;
            let off = |(i, exact): (usize, &[f64; 9])| {
                let w = cubic(0.5);
                let between = |k: usize| (0..4).map(|j| w[j] * nodes[i + j][k]).sum::<f64>();
                let off = (0..9).map(|k| (between(k) - exact[k]).abs()).fold(0.0, f64::max);
                let near = &sizes[i.saturating_sub(octave)..(i + octave).min(sizes.len())];
                let near = near.iter().copied().fold(0.0, f64::max);
                // Where all has vanished it is right.
                if off == 0.0 { 0.0 } else { off / greatest(exact).max(VANISHING * near) }
            };
            let error = middles.iter().enumerate().map(off).fold(0.0, f64::max);
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
        let power = |last: usize, before: usize| {
            let (a, b) = (greatest(&nodes[before]), greatest(&nodes[last]));
            let sign = if last > before { 1.0 } else { -1.0 };
            let power = sign * (b / a).ln() / grid.step;
            // What has all but vanished, a line out of sight, say, does not come back.
            if power.is_finite() { power.clamp(-60.0, 60.0) } else { 0.0 }
        };
        let last = nodes.len() - 1;
        let ends = [power(0, 1), power(last, last - 1)];
        let nodes = nodes.iter().map(node).collect();
        Self { start: -(grid.side as f64) * grid.step, inverse_step: 1.0 / grid.step, nodes, ends, error }
    }

    /// A table with nodes at the same places, whose error is taken for the same.
    pub fn alike(&self, exact: impl Fn(f64) -> Matrix + Sync) -> Self {
        let side = (self.nodes.len() - 3) / 2;
        if self.inverse_step == 0.0 {
            return Self::new(0.0, exact);
        }
        let grid = Grid { step: 1.0 / self.inverse_step, side };
        let nodes: Vec<[f64; 9]> = grid.places().map(|x| flat(&exact(x.exp()))).collect();
        Self::of_nodes(grid, &nodes, self.error)
    }

    /// The nine numbers at ln D: columns for red, green and blue.
    pub fn at(&self, ln_doppler: f64) -> [f32; 9] {
        let [r, g, b] =
            [0, 1, 2].map(|i| self.color(ln_doppler, std::array::from_fn(|k| f32::from(u8::from(k == i)))));
        [r[0], r[1], r[2], g[0], g[1], g[2], b[0], b[1], b[2]]
    }

    /// The colour seen at ln D of a surface of the colour `own`.
    #[inline]
    pub fn color(&self, ln_doppler: f64, own: [f32; 3]) -> [f32; 3] {
        let last = (self.nodes.len() - 3) as f64;
        let place = (ln_doppler - self.start) * self.inverse_step;
        let within = place.max(0.0).min(last);
        let low = (within as usize).min(self.nodes.len() - 4);
        let w = weights(within - low as f64);
        // Four at a time.
        let mut sum = [0.0; 4];
        for (node, w) in self.nodes[low..low + 4].iter().zip(w) {
            for (column, own) in node.iter().zip(own) {
                let factor = w * own;
                sum = std::array::from_fn(|k| sum[k] + factor * column[k]);
            }
        }
        let mut out = [sum[0], sum[1], sum[2]];
        if place != within {
            self.go_on(&mut out, (place - within) / self.inverse_step);
        }
        out
    }

    #[cold]
    fn go_on(&self, values: &mut [f32; 3], beyond: f64) {
        let power = self.ends[usize::from(beyond > 0.0)];
        if beyond.is_finite() {
            // Spectra that fall steeply on either side are dark beyond.
            let factor = (power * beyond).min(80.0).exp() as f32;
            *values = values.map(|v| v * factor);
        }
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

/// Doppler tables by a second quantity, a cubic between the four nearest.
#[derive(Clone, Debug)]
pub struct RowTable {
    start: f64,
    inverse_step: f64,
    /// One beyond each end; or one alone.
    rows: Vec<DopplerTable>,
}

/// The most nodes on either side of D = 1 in tables of which there are many.
const MOST_IN_ROWS: usize = 512;

/// Light shifted farther to the red than this, by ln D, does not count.
const DARKEST: f64 = -2.5;

/// Rows per unit of ln D of the lamp, and the most there are.
const ROWS: f64 = 32.0;
const MOST_ROWS: f64 = 160.0;

impl RowTable {
    /// The error between nodes that is accepted in tables of which there are many.
    pub const ERROR: f64 = 1e-3;

    /// One row, whatever the second quantity.
    pub fn single(row: DopplerTable) -> Self {
        Self { start: 0.0, inverse_step: 0.0, rows: vec![row] }
    }

    /// For light that reaches surfaces with |ln D| up to `lamp_range`, and is seen with |ln D| up to `range`; `exact` by
    /// the two Doppler factors.
    pub fn by_lamp(lamp_range: f64, range: f64, exact: impl Fn(f64, f64) -> Matrix + Sync) -> Self {
        let lamp_range = lamp_range.min(FARTHEST);
        if lamp_range < 1e-12 {
            return Self::single(DopplerTable::new(range, |d| exact(1.0, d)));
        }
        let model = Self::model(-lamp_range, range, &exact);
        let row = |lamp: f64| model.alike(|d| exact(lamp.exp(), d));
        let count = (2.0 * lamp_range * ROWS).ceil().clamp(4.0, MOST_ROWS) as usize;
        Self::evenly([-lamp_range, lamp_range], count, row)
    }

    /// A table whose nodes serve for many, of light that comes with no less than the given ln D: the reddest needs the
    /// most, as long as there is any.
    pub fn model(reddest: f64, range: f64, exact: impl Fn(f64, f64) -> Matrix + Sync) -> DopplerTable {
        let lamp = reddest.max(DARKEST).exp();
        DopplerTable::within(range, MOST_IN_ROWS, RowTable::ERROR, |d| exact(lamp, d))
    }

    /// `count` rows, at least two, from the first place to the last; `row` makes one.
    pub fn evenly([first, last]: [f64; 2], count: usize, row: impl Fn(f64) -> DopplerTable + Sync) -> Self {
        let step = (last - first) / (count - 1) as f64;
        let place = |i: usize| first + (i as f64 - 1.0) * step;
        let rows = (0..count + 2).into_par_iter().map(|i| row(place(i))).collect();
        Self { start: first, inverse_step: 1.0 / step, rows }
    }

    /// The colour seen at ln D of a surface of the colour `own`, in the row at `place`.
    #[inline]
    pub fn color(&self, place: f64, ln_doppler: f64, own: [f32; 3]) -> [f32; 3] {
        if let [row] = &self.rows[..] {
            return row.color(ln_doppler, own);
        }
        let last = (self.rows.len() - 3) as f64;
        // NaN becomes the first.
        let within = ((place - self.start) * self.inverse_step).max(0.0).min(last);
        let low = (within as usize).min(self.rows.len() - 4);
        let w = weights(within - low as f64);
        let mut sum = [0.0; 3];
        for (row, w) in self.rows[low..low + 4].iter().zip(w) {
            let color = row.color(ln_doppler, own);
            sum = [0, 1, 2].map(|i| sum[i] + w * color[i]);
        }
        sum
    }

    /// How many nodes all rows have.
    pub fn nodes(&self) -> usize {
        self.rows.iter().map(DopplerTable::nodes).sum()
    }

    /// The greatest error between the nodes of a row, of the greatest number there.
    pub fn error(&self) -> f64 {
        self.rows.iter().map(DopplerTable::error).fold(0.0, f64::max)
    }
}
