//! Tables of colours under shifts, each made once.

use super::ambient::Bath;
use super::incidence::{Incidence, rapidity};
use crate::relativity::Motion;
use crate::scene::Light;
use crate::spectrum::{Beyond, DopplerTable, Matrix, Response, RowTable, Spectrum, SpectrumError};
use std::sync::Arc;

/// What a table of colours is of, and how good it is.
#[derive(Clone, Debug, PartialEq)]
pub struct TableInfo {
    /// The spectrum, in words.
    pub spectrum: String,
    /// What is assumed of colours outside the visible.
    pub beyond: Beyond,
    /// How many matrices it has.
    pub nodes: usize,
    /// The greatest error between them, of the greatest number there.
    pub error: f64,
}

/// Of what a table is.
#[derive(Clone, Debug, PartialEq)]
struct Key {
    spectrum: Spectrum,
    color: [f32; 3],
    beyond: Beyond,
    way: Way,
}

/// How light reaches surfaces; numbers as their bits, so that equal is equal.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Way {
    Distant(u64),
    Near(u64),
    Ambient(u64),
}

/// Tables made so far.
#[derive(Default)]
pub(super) struct Tables {
    /// How far |ln D| goes.
    range: f64,
    own: Vec<(Spectrum, Arc<DopplerTable>)>,
    reflected: Vec<(Key, Arc<RowTable>)>,
    pub infos: Vec<TableInfo>,
}

impl Tables {
    /// For |ln D| up to `range`.
    pub fn new(range: f64) -> Self {
        Self { range, ..Self::default() }
    }

    /// Of what surfaces shine with.
    pub fn own(&mut self, spectrum: &Spectrum) -> Result<Arc<DopplerTable>, SpectrumError> {
        if let Some((_, table)) = self.own.iter().find(|(known, _)| known == spectrum) {
            return Ok(table.clone());
        }
        let response = Response::of_own(spectrum)?;
        let table = Arc::new(DopplerTable::new(self.range, |d| response.matrix(1.0, d)));
        self.own.push((spectrum.clone(), table.clone()));
        self.infos.push(TableInfo {
            spectrum: spectrum.shape.describe(),
            beyond: spectrum.beyond,
            nodes: table.nodes(),
            error: table.error(),
        });
        Ok(table)
    }

    /// Of what surfaces of a body reflect of a light.
    pub fn reflected(
        &mut self,
        light: &Light,
        body: &Motion,
        incidence: &Incidence,
        beyond: Beyond,
    ) -> Result<Arc<RowTable>, SpectrumError> {
        let rapidity = rapidity(&light.motion, body);
        let way = match incidence {
            Incidence::Distant { doppler, .. } => Way::Distant(doppler.to_bits()),
            Incidence::Near => Way::Near(rapidity.to_bits()),
            Incidence::Ambient { .. } => Way::Ambient(rapidity.to_bits()),
        };
        let key = Key { spectrum: light.spectrum.clone(), color: light.color, beyond, way };
        if let Some((_, table)) = self.reflected.iter().find(|(known, _)| *known == key) {
            return Ok(table.clone());
        }
        let response = Response::new(&light.spectrum, light.color, beyond)?;
        let (range, coarse) = (self.range, response.clone().coarse());
        let table = match incidence {
            Incidence::Distant { doppler, .. } => {
                RowTable::single(DopplerTable::new(range, |d| response.matrix(*doppler, d)))
            }
            Incidence::Near => RowTable::by_lamp(rapidity, range, ROWS, |lamp, d| coarse.matrix(lamp, d)),
            Incidence::Ambient { .. } => {
                bath_table(&Bath::new(rapidity), range, |lamp, d| coarse.matrix(lamp, d))
            }
        };
        let table = Arc::new(table);
        self.reflected.push((key, table.clone()));
        self.infos.push(TableInfo {
            spectrum: format!("{} of the light '{}'", light.spectrum.shape.describe(), light.name),
            beyond,
            nodes: table.nodes(),
            error: table.error(),
        });
        Ok(table)
    }
}

/// Rows of tables by the lamp's shift, for every e-fold: what surfaces reflect changes over a tenth of that. Sums of many do
/// with a quarter.
const ROWS: f64 = 64.0;

/// Steps of cos ψ.
const ANGLES: usize = 128;

/// By cos ψ: sums over rings of what comes with one shift.
fn bath_table(bath: &Bath, range: f64, matrix: impl Fn(f64, f64) -> Matrix + Sync) -> RowTable {
    if bath.is_still() {
        let around = |d: f64| matrix(1.0, d).map(|column| column.map(|v| v * std::f64::consts::PI));
        return RowTable::single(DopplerTable::new(range, around));
    }
    // Finer than the eye tells wavelengths apart, so that lines are no rings.
    let rings = bath.rings(((2.0 * bath.rapidity() / 0.01) as usize).clamp(64, 2000) & !1);
    let shifted = RowTable::by_lamp(bath.rapidity(), range, 0.25 * ROWS, &matrix);
    let cosine = |i: usize| 2.0 * i as f64 / ANGLES as f64 - 1.0;
    let shares: Vec<Vec<f64>> =
        rings.iter().map(|ring| (0..=ANGLES).map(|i| ring.share(cosine(i))).collect()).collect();
    let rows = |x: f64| {
        let mut sums = vec![[0.0; 9]; ANGLES + 1];
        for (ring, shares) in rings.iter().zip(&shares) {
            let values = shifted.at(ring.doppler.ln(), x).map(f64::from);
            for (sum, share) in sums.iter_mut().zip(shares).filter(|(_, share)| **share > 0.0) {
                *sum = std::array::from_fn(|k| sum[k] + share * values[k]);
            }
        }
        sums
    };
    RowTable::by_angle(ANGLES + 1, range, rings[0].doppler.ln(), matrix, rows)
}
